"""What makes a stroke useless or doubtful: sensors at their end, gaps, a load that is not there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.recordings.recording import Recording

FEWEST_AT_END, LONGEST_RUN = 16, 4
"""Samples that have one extreme value, and of them in a row, where a sensor has reached its end."""

MOST_MISSING = 0.05
"""Share of missing values in a steady part that is passed over with a note."""

LONGEST_GAP = 5.0
"""Time between samples, in that which is usual, that is a gap."""

LEAST_LOAD = 0.05
"""Normal force, of the median of all strokes, that is a load."""

UNLOADED = 0.05
"""Share of samples without load in a steady part that is too much."""


def at_the_end(values: FloatArray) -> NDArray[np.bool_]:
    """Which samples have the largest or smallest value of all, if a sensor seems to end there, shape ``(n,)``.

    It does if at least 16 samples have that value, 4 of them in a row, and more than twice as many as have the next one.

    Examples
    --------
    >>> force = np.minimum(np.sin(np.arange(200) / 10), 0.9)
    >>> int(at_the_end(force).sum()), int(at_the_end(np.sin(np.arange(200) / 10)).sum())
    (27, 0)
    """
    found = np.zeros(values.shape, dtype=bool)
    known = values[np.isfinite(values)]
    if known.size < 10 * FEWEST_AT_END or np.ptp(known) == 0:
        return found
    for extreme, inner in ((known.max(), known < known.max()), (known.min(), known > known.min())):
        at_end = values == extreme
        if at_end.sum() < FEWEST_AT_END or not inner.any():
            continue
        next_one = known[inner].max() if extreme == known.max() else known[inner].min()
        edges = np.flatnonzero(np.diff(np.concatenate(([False], at_end, [False])).astype(np.int8)))
        if at_end.sum() > 2 * np.sum(known == next_one) and np.max(edges[1::2] - edges[::2]) >= LONGEST_RUN:
            found |= at_end
    return found


def useless(
    recording: Recording, begin: int, end: int, normal: FloatArray, typical_load: float, minimum: float
) -> str:
    """Why no friction can be taken from a part of a recording, in words; empty if it can.

    Parameters
    ----------
    recording : forces and times
    begin, end : the part, as samples
    normal : normal force without its zero, N, shape ``(n,)``
    typical_load : median over all strokes, N
    minimum : stated least normal force, N
    """
    force, load = recording.tangential_force[begin:end], normal[begin:end]
    if end - begin < 8:
        return f"{end - begin} samples in the steady part, at least 8 are needed"
    missing = ~(np.isfinite(force) & np.isfinite(load))
    if missing.mean() > MOST_MISSING:
        where = recording.line(begin + int(missing.argmax()))
        return f"{100 * missing.mean():.0f} % of the steady part without value (from line {where})"
    steps = np.diff(recording.time[begin:end])
    if steps.max() > LONGEST_GAP * recording.interval:
        where = recording.line(begin + int(steps.argmax()) + 1)
        return f"a gap of {steps.max():.3g} s in time (line {where})"
    known = load[~missing]
    if not known.mean() > 0 or np.mean(known <= 0) > UNLOADED or known.mean() < LEAST_LOAD * typical_load:
        return f"a normal force near zero ({known.mean():.3g} N)"
    if known.mean() < minimum:
        return f"a normal force of {known.mean():.3g} N, less than the stated {minimum:.3g} N"
    if recording.saturated is not None and recording.saturated[begin:end].any():
        first = begin + int(recording.saturated[begin:end].argmax())
        return f"a force at the end of its sensor's range (from line {recording.line(first)})"
    for name, (labels, code) in recording.changing.items():
        here = np.unique(code[begin:end])
        if here.size > 1:
            return f"{name} changes from '{labels[here[0]]}' to '{labels[here[1]]}' in the steady part"
    return ""
