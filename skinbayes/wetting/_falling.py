"""Roots between two places, for each member of a batch on its own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize.elementwise import find_root

from skinbayes.arrays import FloatArray, IndexArray

_CLOSE = 1e-13  # of the bracket


def falling_root(
    function: Callable[[FloatArray], FloatArray], low: FloatArray, high: FloatArray, enough: float = 0.0
) -> FloatArray:
    """Where a function falls through zero between ``low`` and ``high``, all of one shape.

    Until the value is ``enough`` or less, or the place known to 1e-13 of the bracket. Without a change of sign the root is
    the end towards which the function points; where the function is nan at an end, so is the root.
    """
    left, right = function(low), function(high)
    end = np.where(left > 0, high, low) + 0.0 * (left + right)
    width, everywhere = high - low, low.copy()

    def at(fraction: FloatArray, members: IndexArray) -> FloatArray:
        # the function is one of the whole batch: members that are done stay where they are
        everywhere.flat[members] = low.flat[members] + fraction * width.flat[members]
        return function(everywhere).flat[members]

    members = np.arange(low.size).reshape(low.shape)
    tolerances = {"xatol": _CLOSE, "xrtol": 0.0, "fatol": enough, "frtol": 0.0}
    found = find_root(at, (np.zeros(low.shape), np.ones(low.shape)), args=(members,), tolerances=tolerances)
    return np.where((left > 0) & (right <= 0), low + found.x * width, end)
