"""Array types shared by all modules."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray: TypeAlias = NDArray[np.float64]
"""A NumPy array of 64-bit floats."""

ComplexArray: TypeAlias = NDArray[np.complex128]
"""A NumPy array of complex numbers of two 64-bit floats."""

BoolArray: TypeAlias = NDArray[np.bool_]
"""A NumPy array of truth values."""

IndexArray: TypeAlias = NDArray[np.intp]
"""A NumPy array of places in another one."""

__all__ = ["ArrayLike", "BoolArray", "ComplexArray", "FloatArray", "IndexArray", "floats"]


def floats(*values: ArrayLike) -> tuple[FloatArray, ...]:
    """Each of some values as an array of 64-bit floats."""
    return tuple(np.asarray(value, dtype=np.float64) for value in values)
