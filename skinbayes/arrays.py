"""Array types shared by all modules."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray: TypeAlias = NDArray[np.float64]
"""A NumPy array of 64-bit floats."""

__all__ = ["ArrayLike", "FloatArray", "arrays"]


def arrays(*values: ArrayLike) -> list[FloatArray]:
    """The values as arrays of 64-bit floats."""
    return [np.asarray(value, dtype=np.float64) for value in values]
