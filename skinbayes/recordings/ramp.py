"""Load ramps: a stroke cut into bins of normal force."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.recordings.rows import FrictionRow

SMOOTHED = 50
"""Parts of a steady part, over one of which the load is averaged before it is sorted into bins."""

FEWEST_SAMPLES = 16
"""A shorter stay in a bin is no row."""


def load_bins(row: FrictionRow, normal: FloatArray, edges: tuple[float, ...]) -> list[FrictionRow]:
    """Rows for each stay of the load between two edges within the steady part of a stroke.

    The load is sorted into bins after a running mean over a 50th of the steady part, so that noise about an edge does not cut
    the bin to pieces. Stays of fewer than 16 samples, as at the end of a ramp, and loads outside of all edges are no rows.

    Parameters
    ----------
    row : a stroke
    normal : normal force without its zero, N, shape ``(n,)``
    edges : increasing, N
    """
    from scipy.ndimage import uniform_filter1d

    if row.left_out:
        return [row]
    load = np.nan_to_num(normal[row.begin : row.end])
    smooth = uniform_filter1d(load, max(1, load.size // SMOOTHED), mode="nearest")
    which = np.searchsorted(np.asarray(edges), smooth, side="right")
    which[which == len(edges)] = 0
    cuts = np.concatenate(([0], np.flatnonzero(np.diff(which)) + 1, [which.size]))
    found = [
        replace(row, begin=row.begin + int(a), end=row.begin + int(b), load_bin=int(which[a]))
        for a, b in itertools.pairwise(cuts)
        if which[a] and b - a >= FEWEST_SAMPLES
    ]
    return found or [
        replace(
            row,
            left_out=f"a load from {load.min():.3g} N to {load.max():.3g} N, outside of all bins",
            by_recipe=True,
        )
    ]
