"""What an instrument measured: heights on a rectangle of pixels, or along a line."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError

LEAST_PIXELS = 8
"""Pixels along each side, at least: a spectrum of fewer has no band."""


@dataclass(frozen=True, eq=False)
class HeightMap:
    """Heights of a surface on a rectangle of pixels.

    Attributes
    ----------
    height : m, shape ``(M, N)``, row by row; nan where the instrument saw nothing
    pixel_size_x : distance of neighbours in a row, m
    pixel_size_y : distance of rows, m
    periodic : whether the surface goes on at each edge as it begins at the opposite one
    steps : what was done to the heights since they were read, in words with numbers

    Raises
    ------
    InputError
        if ``height`` has another shape than two axes of at least 8 pixels, holds infinities or nothing that is defined, or
        a pixel has no size

    Examples
    --------
    >>> import numpy as np
    >>> x = np.arange(64) * 1e-6
    >>> wave = HeightMap(1e-7 * np.sin(2 * np.pi * x / 16e-6) * np.ones((32, 1)), pixel_size_x=1e-6, pixel_size_y=1e-6)
    >>> wave.height.shape, f"{wave.size_x:.2e} m"
    ((32, 64), '6.40e-05 m')
    """

    height: FloatArray
    _: KW_ONLY
    pixel_size_x: float
    pixel_size_y: float
    periodic: bool = False
    steps: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "height", _checked(self.height, 2))
        for name in ("pixel_size_x", "pixel_size_y"):
            _check_size(name, getattr(self, name))

    @property
    def size_x(self) -> float:
        """Length of a row, m."""
        return self.height.shape[1] * self.pixel_size_x

    @property
    def size_y(self) -> float:
        """Length of a column, m."""
        return self.height.shape[0] * self.pixel_size_y


@dataclass(frozen=True, eq=False)
class LineProfile:
    """Heights along a straight line, at equal distances.

    Attributes
    ----------
    height : m, shape ``(N,)``; nan where the instrument saw nothing
    pixel_size : distance of neighbours, m
    periodic : whether the line goes on at its end as it begins
    steps : what was done to the heights since they were read, in words with numbers

    Raises
    ------
    InputError
        if ``height`` is no list of at least 8 heights, holds infinities or nothing that is defined, or ``pixel_size`` is no
        length

    Examples
    --------
    >>> import numpy as np
    >>> LineProfile(np.zeros(16), pixel_size=1e-6).size
    1.6e-05
    """

    height: FloatArray
    _: KW_ONLY
    pixel_size: float
    periodic: bool = False
    steps: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "height", _checked(self.height, 1))
        _check_size("pixel_size", self.pixel_size)

    @property
    def size(self) -> float:
        """Length of the line, m."""
        return self.height.size * self.pixel_size


def _checked(height: FloatArray, axes: int) -> FloatArray:
    heights = np.asarray(height, dtype=np.float64)
    kind = "a map" if axes == 2 else "a line"
    if heights.ndim != axes or min(heights.shape) < LEAST_PIXELS:
        shape = " × ".join(map(str, heights.shape)) or "a single number"
        raise InputError(f"the heights of {kind} have the shape {shape}; expected {axes} "
                         f"{'axes' if axes == 2 else 'axis'} of at least {LEAST_PIXELS} pixels")  # fmt: skip
    if np.isinf(heights).any():
        raise InputError(
            f"the heights of {kind} hold infinities; expected numbers in m, nan where nothing was seen"
        )
    if np.isnan(heights).all():
        raise InputError(f"none of the {heights.size} pixels of {kind} has a height; expected numbers in m")
    heights = heights.view()
    heights.flags.writeable = False  # steps are pure: nobody changes a map that others hold
    return heights


def _check_size(name: str, size: float) -> None:
    if not 0 < size < np.inf:
        raise InputError(f"{name} is {size:g} m; expected a finite length > 0 m")
