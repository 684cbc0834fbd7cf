"""How the frozen types hold their numbers."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray

Floats: TypeAlias = "float | FloatArray"
"""A float or an array of floats: what a field of a frozen type may be given and will hold."""


def as_field(value: ArrayLike) -> FloatArray:
    """``value`` as 64-bit floats; a scalar becomes a NumPy scalar."""
    return np.asarray(value, dtype=np.float64)[()]


def with_axes(value: Floats, count: int) -> FloatArray:
    """``value`` with ``count`` new last axes, so that it broadcasts against ``count`` axes of wavevectors."""
    array = np.asarray(value)
    return array.reshape(array.shape + (1,) * count)
