"""One row for several strokes: the two directions of a cycle, a recording, a session, a person."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.recordings.memory import FEWEST_SAMPLES, error_of_mean, memory_of, widening
from skinbayes.recordings.rows import FrictionRow


def paired(rows: Sequence[FrictionRow]) -> list[FrictionRow]:
    """Each forward stroke with the backward one after it, or the other way round; strokes without a partner are left out.

    The friction coefficient of two is the sum of their friction forces over that of their normal forces, in which the zero of
    the tangential force cancels.
    """
    found, waiting = [], list(rows)
    while len(waiting) > 1:
        first, second = waiting[:2]
        if (
            first.direction * second.direction < 0
            and second.stroke == first.stroke + 1
            and first.load_bin == second.load_bin
        ):
            weights = np.array([first.normal_force, second.normal_force])
            found.append(_joined([first, second], weights / weights.sum(), between=False))
            del waiting[:2]
        else:
            del waiting[0]
    return found


def averaged(rows: Sequence[FrictionRow], recordings: Sequence[int]) -> FrictionRow:
    """The mean of strokes that belong together.

    Its error is the larger one of two: what the errors of the strokes make, and what their scatter makes – with the memory from
    stroke to stroke if there are at least eight, with Student's t otherwise.

    Parameters
    ----------
    rows : strokes in the order of time
    recordings : number of the recording of each, whose strokes share their zero
    """
    return _joined(rows, np.full(len(rows), 1.0 / len(rows)), between=True, recordings=recordings)


def _joined(
    rows: Sequence[FrictionRow], weights: FloatArray, between: bool, recordings: Sequence[int] = ()
) -> FrictionRow:
    values = np.array([row.friction_coefficient for row in rows])
    coefficient = float(weights @ values)
    own = float(np.sqrt(np.sum((weights * np.array([row.own_error for row in rows])) ** 2)))
    if between and len(rows) > 1:
        own = max(own, _error_between(values))
    tangential = np.array([row.direction * row.zero_error for row in rows]) * weights
    normal = np.array([row.load_error for row in rows]) * weights
    of = np.asarray(recordings if len(recordings) else np.zeros(len(rows)))
    shared = [(tangential[of == one].sum(), normal[of == one].sum()) for one in np.unique(of)]
    labels = {
        name: label
        for name, label in rows[0].labels.items()
        if all(row.labels.get(name) == label for row in rows)
    }
    directions = {row.direction for row in rows}

    def mean(name: str) -> float:
        each = np.array([getattr(row, name) for row in rows])
        return float(np.nanmean(each)) if np.isfinite(each).any() else float("nan")

    return replace(
        rows[0],
        direction=directions.pop() if len(directions) == 1 else 0,
        end=rows[-1].end,
        stop=rows[-1].stop,
        time=mean("time"),
        friction_coefficient=coefficient,
        own_error=own,
        zero_error=float(np.sqrt(sum(t**2 for t, _ in shared))),
        load_error=float(np.sqrt(sum(n**2 for _, n in shared))),
        scatter=mean("scatter"),
        samples=sum(row.samples for row in rows),
        effective_samples=sum(row.effective_samples for row in rows),
        static_friction_coefficient=mean("static_friction_coefficient"),
        change=mean("change"),
        normal_force=mean("normal_force"),
        normal_force_error=float(np.sqrt(np.sum((weights * np.array([row.normal_force_error for row in rows])) ** 2))),
        normal_force_scatter=mean("normal_force_scatter"),
        sliding_speed=mean("sliding_speed"),
        quantities={name: float(np.mean([row.quantities[name] for row in rows])) for name in rows[0].quantities},
        labels=labels,
        notes=tuple(dict.fromkeys(note for row in rows for note in row.notes)),
        strokes=len(rows),
    )  # fmt: skip


def _error_between(values: FloatArray) -> float:
    """Standard error of the mean from the scatter of strokes, to be used as that of a normal distribution."""
    if values.size >= 2 * FEWEST_SAMPLES:
        return error_of_mean(values, memory_of([values])).standard_error
    return widening(values.size - 1) * float(np.std(values, ddof=1) / np.sqrt(values.size))
