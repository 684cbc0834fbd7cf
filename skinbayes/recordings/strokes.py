"""Strokes of a recording: from reversals of the position, from the speed, or from the sign of the tangential force."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.recordings.recording import Recording, Rules

MOST_POINTS = 200_000
"""Points in which reversals are looked for; of more the means of neighbours."""

REVERSAL = 0.2
"""Share of the range of positions that a reversal goes back, unless a length is stated."""

AT_REST = 0.02
"""Share of a stroke at each end in which it does not count as moving."""

SLOW = 0.3
"""Share of the usual speed, or of half the range of the force, that separates strokes."""

MOST_BETWEEN = 0.25
"""Largest share of samples between the two levels of a force that reverses."""


@dataclass(frozen=True)
class Stroke:
    """One stroke.

    Attributes
    ----------
    start, stop : samples from the reversal before to that after it
    moving_start, moving_stop : samples in which it slides
    direction : 1 forward, −1 backward
    length : way, m; nan where it is not known
    """

    start: int
    stop: int
    moving_start: int
    moving_stop: int
    direction: int
    length: float


def way_of(recording: Recording) -> FloatArray | None:
    """Position, or the integral of the speed where only that is known, m, shape ``(n,)``; None without either."""
    if recording.position is not None:
        return _without_gaps(recording.position)
    if recording.sliding_speed is None:
        return None
    speed = _without_gaps(recording.sliding_speed)
    steps = 0.5 * (speed[1:] + speed[:-1]) * np.diff(recording.time)
    return np.concatenate(([0.0], np.cumsum(steps)))


def find_strokes(recording: Recording, rules: Rules) -> list[Stroke]:
    """Strokes in the order of time.

    The position reverses where it goes back by more than ``minimum_length`` (a fifth of its range if none is stated); a speed
    with sign is integrated and treated so, one without is cut where it is below 30 % of its 95 % quantile. A tangential force
    reverses where it leaves the middle of its range (5 to 95 %) by 30 % of half of it, on the other side than before.

    Raises
    ------
    InputError
        if there is no stroke by this rule, or nothing that tells strokes was recorded
    """
    source = rules.strokes_from or (
        "position"
        if recording.position is not None
        else "sliding_speed"
        if recording.sliding_speed is not None
        else "tangential_force"
    )
    if source == "whole":
        found = [Stroke(0, recording.time.size, 0, recording.time.size, 1, float("nan"))]
    elif source == "tangential_force":
        found = _of_force(recording)
    else:
        found = _of_motion(recording, source, rules)
    long_enough = [
        one
        for one in found
        if recording.time[one.moving_stop - 1] - recording.time[one.moving_start] >= rules.minimum_duration
    ]
    if not long_enough:
        raise InputError(
            f"{recording.name}: none of {len(found)} strokes lasts {rules.minimum_duration:g} s; state a shorter "
            "minimum_duration under [strokes] of the recipe"
        )
    return long_enough


def _of_motion(recording: Recording, source: str, rules: Rules) -> list[Stroke]:
    if getattr(recording, source) is None:
        raise InputError(f"{recording.name}: no {source} was recorded, from which strokes should be found")
    if source == "sliding_speed":
        assert recording.sliding_speed is not None
        low, high = np.nanquantile(recording.sliding_speed, (0.02, 0.98))
        if not low < -0.2 * high < 0 and not high > -0.2 * low > 0:
            return _of_unsigned_speed(recording, rules)
    way = way_of(recording) if source == "sliding_speed" else _without_gaps(getattr(recording, source))
    assert way is not None
    low, high = np.quantile(way, (0.002, 0.998))
    back = rules.minimum_length or REVERSAL * (high - low)
    turns = _reversals(way, back) if back > 0 else []
    if len(turns) < 2:
        raise InputError(
            f"{recording.name}: no stroke found: the {source.replace('_', ' ')} goes from {low:.4g} m to {high:.4g} m and never "
            f"further than {back:.4g} m one way. Expected a minimum_length under [strokes] of the recipe that strokes exceed, "
            'or from = "whole"'
        )
    return [_stroke(way, start, stop) for start, stop in itertools.pairwise(turns)]


def _stroke(way: FloatArray, start: int, stop: int) -> Stroke:
    """A stroke between two reversals; it moves from where it has left its beginning to where it reaches its end."""
    length = way[stop] - way[start]
    share = (way[start : stop + 1] - way[start]) / length
    begin = int(np.flatnonzero(share <= AT_REST)[-1]) if share.size > 2 else 0
    reached = np.flatnonzero(share[begin:] >= 1 - AT_REST)
    end = begin + (int(reached[0]) if reached.size else share.size - 1)
    return Stroke(
        start, stop + 1, start + begin, start + end + 1, 1 if length > 0 else -1, float(abs(length))
    )


def _reversals(way: FloatArray, back: float) -> list[int]:
    """Samples at which the way turns by more than ``back``, with the first and the last extreme; less than two if none does."""
    block = -(-way.size // MOST_POINTS)
    whole = way.size // block * block
    points = way[:whole].reshape(-1, block).mean(axis=1).tolist()
    found: list[int] = []
    low = high = 0
    towards = 0
    for i, x in enumerate(points):
        if x > points[high]:
            high = i
        if x < points[low]:
            low = i
        if towards >= 0 and points[high] - x > back:
            found.append(high)
            towards, low, high = -1, i, i
        elif towards <= 0 and x - points[low] > back:
            found.append(low)
            towards, low, high = 1, i, i
    if towards:
        found.append(high if towards > 0 else low)
    return [min(i * block + block // 2, way.size - 1) for i in found]


def _of_unsigned_speed(recording: Recording, rules: Rules) -> list[Stroke]:
    speed = np.abs(_without_gaps(np.asarray(recording.sliding_speed)))
    usual = float(np.quantile(speed, 0.95))
    sign = 1 if np.nanmedian(np.asarray(recording.sliding_speed)) >= 0 else -1
    runs = _runs(speed > SLOW * usual) if usual > 0 else []
    steps = np.append(np.diff(recording.time), 0.0)
    found = []
    end_before = 0
    for begin, end in runs:
        way = float(speed[begin:end] @ steps[begin:end])
        if end - begin > 3 and way > (rules.minimum_length or 0.0):
            found.append(Stroke(end_before, end, begin, end, sign, way))
        end_before = end
    typical = np.median([one.length for one in found]) if found else 0.0
    found = [one for one in found if one.length >= REVERSAL * typical]
    if not found:
        raise InputError(
            f"{recording.name}: no stroke found: the sliding speed, 95 % of it below {usual:.4g} m/s, is never above 30 % of "
            "that for long enough"
        )
    return found


def _of_force(recording: Recording) -> list[Stroke]:
    force = _without_gaps(recording.tangential_force)
    low, high = np.quantile(force, (0.05, 0.95))
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    state = np.where(force > middle + SLOW * half, 1, np.where(force < middle - SLOW * half, -1, 0))
    between = float(np.mean(state == 0))
    if not half > 0 or between > MOST_BETWEEN:
        raise InputError(
            f"{recording.name}: no stroke found: the tangential force does not change between two levels ({100 * between:.0f} % "
            f"of the samples are near the middle of its range from {low:.4g} N to {high:.4g} N). Expected a position or a "
            'sliding_speed among the [columns] of the recipe, or from = "whole" under [strokes]'
        )
    last = np.maximum.accumulate(np.where(state != 0, np.arange(state.size), 0))
    held = state[last]
    held[: int(np.argmax(state != 0))] = state[int(np.argmax(state != 0))]
    edges = np.concatenate(([0], np.flatnonzero(np.diff(held)) + 1, [held.size]))
    durations = np.diff(edges)
    long = durations >= SLOW * np.median(durations[durations >= 0.1 * durations.max()])
    return [
        Stroke(int(begin), int(end), int(begin), int(end), int(held[begin]), float("nan"))
        for begin, end, kept in zip(edges[:-1], edges[1:], long, strict=True)
        if kept
    ]


def _runs(inside: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Begin and end of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], inside, [False])).astype(np.int8)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def _without_gaps(values: FloatArray) -> FloatArray:
    """Missing values interpolated, to find strokes only."""
    missing = np.isnan(values)
    if not missing.any() or missing.all():
        return values
    there = np.flatnonzero(~missing)
    return np.interp(np.arange(values.size), there, values[there])
