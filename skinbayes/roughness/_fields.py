"""How the frozen types hold their numbers."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import TypeAlias, TypeVar

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray

Floats: TypeAlias = "float | FloatArray"
"""A float or an array of floats: what a field of a frozen type may be given and will hold."""


Result = TypeVar("Result")

_REMEMBERED = 16  # results of as many different arguments


def as_field(value: ArrayLike) -> FloatArray:
    """``value`` as 64-bit floats; a scalar becomes a NumPy scalar."""
    return np.asarray(value, dtype=np.float64)[()]


def hold_floats(numbers: object) -> None:
    """Make every field of a frozen dataclass of numbers one of 64-bit floats."""
    held = vars(numbers)
    held.update([(name, as_field(value)) for name, value in held.items()])


_NEW_AXES = ((...,), (..., None), (..., None, None))


def with_axes(value: Floats, count: int) -> FloatArray:
    """``value`` with ``count`` (0 to 2) new last axes, so that it broadcasts against ``count`` axes of wavevectors."""
    return np.asarray(value)[_NEW_AXES[count]]


def remembering_numbers(function: Callable[..., Result]) -> Callable[..., Result]:
    """A pure function of arrays that keeps its results for single numbers, such as those that a sampler leaves fixed.

    Results have the shapes that ``function`` gives; an array of several numbers is computed anew at each call.
    """

    @lru_cache(maxsize=_REMEMBERED)
    def of_numbers(axes: int, *numbers: float) -> Result:
        return function(*(np.full((1,) * axes, number)[()] for number in numbers))

    def of_arrays(*arrays: FloatArray) -> Result:
        axes = 0
        for array in arrays:
            if array.size != 1:
                return function(*arrays)
            axes = max(axes, array.ndim)
        return of_numbers(axes, *[array.item() for array in arrays])

    return of_arrays
