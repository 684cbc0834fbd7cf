"""From a recording to friction of its strokes."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.recordings.memory import Memory, error_of_mean, memory_of
from skinbayes.recordings.periodicity import in_cycles, period_of
from skinbayes.recordings.quality import at_the_end, useless
from skinbayes.recordings.ramp import load_bins
from skinbayes.recordings.recording import Recording, Rules
from skinbayes.recordings.rows import FrictionRow, ReducedRecording, preview_of
from skinbayes.recordings.static import static_peak
from skinbayes.recordings.steady import steady_part
from skinbayes.recordings.strokes import Stroke, find_strokes, way_of
from skinbayes.recordings.trend import StrokeTrend, stroke_trend
from skinbayes.recordings.zeros import AS_RECORDED, ForceZero, zero_at_rest, zero_of_directions

INCOMPLETE = 0.5
"""Length of a stroke, of the median of all, below which it is not complete."""

UNEVEN = 0.2
"""Standard deviation of the times between samples, in their mean, above which they are called uneven."""


@dataclass(frozen=True, eq=False)
class _Forces:
    """Forces without their zeros, the tangential one positive against forward sliding, N; way, m; smallest steps, N."""

    tangential: FloatArray
    normal: FloatArray
    way: FloatArray | None
    step: float


def reduce_recording(recording: Recording, rules: Rules) -> ReducedRecording:
    """Friction of each stroke of a recording with its error, and what is to be said of the recording.

    The friction coefficient is that of the steady parts: F̄/N̄, or the mean of F/N, with F the tangential force against sliding,
    its sign such that friction is positive in most strokes. Its error is that of the mean of (F − μN)/N̄ (or of F/N), which has
    the memory that all strokes of the recording show together (`memory_of`, `error_of_mean`); where friction repeats itself, as
    in stick and slip, means of whole cycles take the place of samples.

    Parameters
    ----------
    recording : forces in time
    rules : how strokes are found and friction is taken

    Returns
    -------
    ReducedRecording

    Raises
    ------
    InputError
        if no stroke is found, none can be used, or a zero cannot be determined
    """
    normal_raw = np.broadcast_to(recording.normal_force, recording.time.shape)
    recording = replace(recording, saturated=_saturated(recording))
    strokes, way = find_strokes(recording, rules), way_of(recording)
    normal_zero = (
        _at_rest(recording, normal_raw, rules, "normal force") if rules.normal_zero == "rest" else AS_RECORDED
    )
    normal = normal_raw - normal_zero.value
    parts = [steady_part(one, rules, recording.time, way, recording.tangential_force) for one in strokes]
    load = _typical_load(normal, parts)
    rows = [
        _judged(recording, number, one, part, rules, normal, load)
        for number, (one, part) in enumerate(zip(strokes, parts, strict=True), 1)
    ]
    rows = _without_incomplete(rows, strokes)
    _require_some(recording.name, rows)  # before the zero, which would lack both directions
    try:
        zero = _tangential_zero(recording, rows, rules, normal)
    except InputError as error:
        if why := _reasons(rows):
            raise InputError(f"{error}. Left out were: {why}") from None
        raise
    if rules.ramp_edges:
        rows = [cut for row in rows for cut in load_bins(row, normal, rules.ramp_edges)]
    good = [row for row in rows if not row.left_out]
    against = sum(row.direction * _mean(recording.tangential_force - zero.value, row) for row in good)
    sign = 1.0 if against >= 0 else -1.0
    forces = _Forces(
        sign * (recording.tangential_force - zero.value),
        normal,
        way,
        _smallest_step(recording.tangential_force),
    )
    friction = {id(row): _coefficient(*_of_row(row, forces), rules) for row in good}
    residuals = [series for _, series in friction.values()]
    period = period_of(residuals)
    cycle = 1 if np.isnan(period) else round(period)
    memory = memory_of([in_cycles(one, cycle) for one in residuals])
    rows = [
        row if row.left_out else _measured(row, recording, forces, *friction[id(row)], memory, cycle)
        for row in rows
    ]
    rows = [row if row.left_out else _with_zero_error(row, zero, normal_zero) for row in rows]
    found = ReducedRecording(
        name=recording.name,
        samples=recording.time.size,
        duration=float(recording.time[-1] - recording.time[0]),
        interval=recording.interval,
        rows=tuple(_asked(row, rules) for row in rows),
        tangential_zero=zero,
        normal_zero=normal_zero,
        memory=memory.samples * cycle * recording.interval,
        period=period * recording.interval,
        trend=None,
        preview=preview_of(recording, forces.tangential, normal, way),
        times={
            sample: float(recording.time[min(sample, recording.time.size - 1)])
            for row in rows
            for sample in (row.start, row.begin, row.end, row.stop)
        },
        notes=_notes(recording),
    )
    _require_some(recording.name, found.rows)
    return replace(found, trend=_trend(found, rules))


def _require_some(name: str, rows: Sequence[FrictionRow]) -> None:
    if all(row.left_out for row in rows):
        raise InputError(f"{name}: none of {len(rows)} strokes can be used: {_reasons(rows)}")


def _reasons(rows: Sequence[FrictionRow]) -> str:
    """Why strokes were left out, with how many of them; the first few reasons."""
    found = Counter(re.sub(r" \([^)]*\)", "", row.left_out) for row in rows if row.left_out)
    return "; ".join(
        f"{count} strokes, {why}" if count > 1 else f"1 stroke, {why}" for why, count in found.most_common(4)
    )


def _at_rest(recording: Recording, force: FloatArray, rules: Rules, name: str) -> ForceZero:
    if rules.rest is None:
        raise InputError(f"{recording.name}: the zero of the {name} is that at rest, but no rest is stated")
    return zero_at_rest(recording, force, rules.rest, name)


def _saturated(recording: Recording) -> NDArray[np.bool_]:
    found = at_the_end(recording.tangential_force)
    if recording.normal_force.ndim:
        found = found | at_the_end(recording.normal_force)
    return found if recording.saturated is None else found | recording.saturated


def _typical_load(normal: FloatArray, parts: list[tuple[int, int]]) -> float:
    loads = [float(np.nanmean(normal[a:b])) for a, b in parts if np.isfinite(normal[a:b]).any()]
    return float(np.median(loads)) if loads else 0.0


def _judged(
    recording: Recording, number: int, stroke: Stroke, part: tuple[int, int], rules: Rules, normal: FloatArray, load: float,
) -> FrictionRow:  # fmt: skip
    begin, end = part
    row = FrictionRow(number, stroke.direction, stroke.start, begin, end, stroke.stop)
    if number <= rules.skip_first:
        return replace(row, left_out=f"one of the first {rules.skip_first} strokes", by_recipe=True)
    return replace(row, left_out=useless(recording, begin, end, normal, load, rules.minimum_normal_force))


def _without_incomplete(rows: list[FrictionRow], strokes: list[Stroke]) -> list[FrictionRow]:
    lengths = np.array([one.length for one in strokes])
    if np.isnan(lengths).all():
        return rows
    typical = float(np.nanmedian(lengths))
    return [
        replace(row, left_out=f"a stroke of {1e3 * length:.3g} mm, where others have {1e3 * typical:.3g} mm")
        if not row.left_out and length < INCOMPLETE * typical
        else row
        for row, length in zip(rows, lengths.tolist(), strict=True)
    ]


def _tangential_zero(
    recording: Recording, rows: list[FrictionRow], rules: Rules, normal: FloatArray
) -> ForceZero:
    force = recording.tangential_force
    if rules.tangential_zero == "rest":
        return _at_rest(recording, force, rules, "tangential force")
    if rules.tangential_zero == "as recorded":
        return AS_RECORDED
    good = [row for row in rows if not row.left_out]
    means = np.array([(_mean(force, row), _mean(normal, row), row.direction) for row in good]).reshape(-1, 3)
    return zero_of_directions(recording.name, means[:, 0], means[:, 1], means[:, 2])


def _mean(values: FloatArray, row: FrictionRow) -> float:
    return float(np.nanmean(values[row.begin : row.end]))


def _smallest_step(force: FloatArray) -> float:
    known = np.unique(force[np.isfinite(force)])
    return float(np.diff(known).min()) if known.size > 1 else 0.0


def _of_row(row: FrictionRow, forces: _Forces) -> tuple[FloatArray, FloatArray]:
    """Friction force and normal force of the samples of a row that have both, N."""
    friction = row.direction * forces.tangential[row.begin : row.end]
    load = forces.normal[row.begin : row.end]
    known = np.isfinite(friction) & np.isfinite(load)
    return friction[known], load[known]


def _coefficient(friction: FloatArray, load: FloatArray, rules: Rules) -> tuple[float, FloatArray]:
    """Friction coefficient and the series whose mean error is its error."""
    if rules.friction == "mean of ratios":
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(load > 0, friction / load, np.nan)
        ratio = ratio[np.isfinite(ratio)]
        return float(ratio.mean()), ratio - ratio.mean()
    coefficient = float(friction.mean() / load.mean())
    return coefficient, (friction - coefficient * load) / load.mean()


def _measured(
    row: FrictionRow, recording: Recording, forces: _Forces, coefficient: float, residuals: FloatArray, memory: Memory,
    cycle: int,
) -> FrictionRow:  # fmt: skip
    friction, load = _of_row(row, forces)
    if not coefficient > 0:
        return replace(
            row, left_out=f"a tangential force along the sliding (friction coefficient {coefficient:.3g})"
        )
    mean_load = float(load.mean())
    error = error_of_mean(in_cycles(residuals, cycle), memory, step=forces.step / mean_load)
    of_load = error_of_mean(in_cycles(load - mean_load, cycle), memory)
    quantities = {
        name: _mean_of_known(values[row.begin : row.end] if values.ndim else values)
        for name, values in recording.quantities.items()
    }
    if lacking := next((name for name, value in quantities.items() if value != value), ""):
        return replace(row, left_out=f"no value of {lacking} in the steady part")
    x = np.linspace(-0.5, 0.5, residuals.size)
    part = slice(row.begin, row.end)
    missing = row.end - row.begin - friction.size
    static, remark = (
        (float("nan"), "") if row.load_bin else static_peak(row, recording, forces.tangential, forces.normal)
    )
    notes = [f"{missing} samples without value"] if missing else []
    if error.effective_samples < 5:
        notes.append(f"only {error.effective_samples:.2g} independent samples")
    return replace(
        row,
        time=float(recording.time[part].mean()),
        friction_coefficient=coefficient,
        own_error=error.standard_error,
        scatter=float(residuals.std()),
        samples=residuals.size,
        effective_samples=error.effective_samples,
        static_friction_coefficient=static,
        change=float((x @ residuals) / (x @ x)),
        normal_force=mean_load,
        normal_force_error=of_load.standard_error,
        normal_force_scatter=float(load.std()),
        sliding_speed=_speed(recording, forces.way, part),
        quantities=quantities,
        labels={
            **recording.labels,
            **{name: labels[code[(row.begin + row.end) // 2]] for name, (labels, code) in recording.changing.items()},
        },
        notes=(*notes, *([remark] if remark else [])),
    )  # fmt: skip


def _mean_of_known(values: FloatArray) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else float("nan")


def _speed(recording: Recording, way: FloatArray | None, part: slice) -> float:
    if recording.sliding_speed is not None:
        values = recording.sliding_speed[part] if recording.sliding_speed.ndim else recording.sliding_speed
        return float(np.abs(np.nanmean(values)))
    if way is None:
        return float("nan")
    time = recording.time[part]
    return float(abs(way[part][-1] - way[part][0]) / (time[-1] - time[0]))


def _with_zero_error(row: FrictionRow, zero: ForceZero, normal_zero: ForceZero) -> FrictionRow:
    of_load = row.friction_coefficient * normal_zero.standard_error / row.normal_force
    return replace(row, zero_error=zero.standard_error / row.normal_force, load_error=of_load)


def _asked(row: FrictionRow, rules: Rules) -> FrictionRow:
    wanted = {"both": row.direction, "forward": 1, "backward": -1}[rules.directions]
    if row.left_out or row.direction == wanted:
        return row
    return replace(row, left_out=f"not {rules.directions}", by_recipe=True)


def _notes(recording: Recording) -> tuple[str, ...]:
    steps = np.diff(recording.time)
    if np.std(steps) > UNEVEN * np.mean(steps):
        return (
            f"times between samples scatter by {100 * np.std(steps) / np.mean(steps):.0f} % of their mean, and means are over "
            "samples",
        )
    return ()


def _trend(found: ReducedRecording, rules: Rules) -> StrokeTrend | None:
    used = found.used
    if rules.ramp_edges:
        return None
    return stroke_trend(
        np.array([float(row.stroke) for row in used]),
        np.array([row.friction_coefficient for row in used]),
        np.array([row.standard_error for row in used]),
    )
