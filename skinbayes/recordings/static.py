"""The static peak: the largest friction before the steady part of a stroke."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.recordings.recording import Recording
from skinbayes.recordings.rows import FrictionRow

SHORT = 200
"""Parts of a stroke, over one of which the peak is averaged."""

STANDS_OUT = 0.95
"""Quantile of the same running ratio in the steady part that a peak exceeds."""


def static_peak(
    row: FrictionRow, recording: Recording, tangential: FloatArray, normal: FloatArray
) -> tuple[float, str]:
    """Largest ratio of the running means of both forces, each over a 200th of the stroke, between reversal and steady part.

    It is nan where it does not exceed 95 % of the same ratio in the steady part; what prevented it is said.

    Parameters
    ----------
    row : the stroke
    recording : to see where sensors were at their end
    tangential, normal : forces without their zeros, N, shape ``(n,)``
    """
    from scipy.ndimage import uniform_filter1d

    width = max(1, (row.stop - row.start) // SHORT)
    if row.begin - row.start < 2 * width or recording.saturated is None:
        return float("nan"), ""
    part = slice(row.start, row.end)
    force, load = row.direction * tangential[part], normal[part]
    before = row.begin - row.start
    if recording.saturated[part][:before].any():
        return float("nan"), "no static peak, a sensor was at the end of its range"
    if not (np.isfinite(force[:before]).all() and np.isfinite(load[:before]).all()):
        return float("nan"), "no static peak, values are missing before the steady part"
    force, load = (uniform_filter1d(np.nan_to_num(one), width, mode="nearest") for one in (force, load))
    loaded = load > 0.5 * load[before:].mean()
    if not loaded[:before].any():
        return float("nan"), ""
    ratio = np.where(loaded, force / np.where(loaded, load, 1.0), -np.inf)
    peak = float(ratio[:before].max())
    return (peak, "") if peak > np.quantile(ratio[before:], STANDS_OUT) else (float("nan"), "")
