"""Roots between two places, for each member of a batch on its own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from skinbayes.arrays import FloatArray

_STEPS = 60
_CLOSE = 1e-13  # of the bracket; a step that short is the last


def falling_root(
    function: Callable[[FloatArray], FloatArray], low: FloatArray, high: FloatArray, enough: float = 0.0
) -> FloatArray:
    """Where a function falls through zero between ``low`` and ``high``, all of one shape.

    False position, the end that stays halved (Illinois), every fourth step a bisection; until the value is ``enough`` or less, or
    the step a part in 1e13 of the bracket. Without a change of sign the root is the end towards which the function points; where
    the function is nan at an end, so is the root.
    """
    left, right = function(low), function(high)
    close = _CLOSE * (high - low)
    root = np.where(left > 0, high, low) + 0.0 * (left + right)
    active = (left > 0) & (right <= 0)
    stayed = np.zeros(low.shape, dtype=np.int8)  # which end stayed in the step before
    for step in range(_STEPS):
        if not active.any():
            break
        fraction = 0.5 if step % 4 == 3 else left / (left - right)
        root = np.where(active, low + fraction * (high - low), root)
        value = function(root)
        active = active & (np.abs(value) > enough) & (np.minimum(root - low, high - root) > close)
        up, down = active & (value > 0), active & ~(value > 0)
        right = np.where(up & (stayed > 0), right / 2, right)
        left = np.where(down & (stayed < 0), left / 2, left)
        low, left = np.where(up, root, low), np.where(up, value, left)
        high, right = np.where(down, root, high), np.where(down, value, right)
        stayed = np.where(up, 1, np.where(down, -1, stayed)).astype(np.int8)
    return root
