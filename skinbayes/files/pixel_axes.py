"""The axes of a digitised figure: from pixels to values, and what an uncertain pixel means for a value."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, log, log10
from typing import Any

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError

_SMALLEST_SINE = 0.01  # of the angle between the axes: below, they are parallel to the eye


@dataclass(frozen=True, eq=False)
class PixelAxes:
    """Affine map from pixels to the two coordinates of a figure; the coordinate of a logarithmic axis is log10.

    Attributes
    ----------
    matrix : coordinates per pixel, shape ``(2, 2)``: rows are abscissa and ordinate, columns are x and y of pixels
    origin : coordinates of the pixel (0, 0), shape ``(2,)``
    logarithmic : whether abscissa and ordinate are logarithmic
    """

    matrix: FloatArray
    origin: FloatArray
    logarithmic: tuple[bool, bool]

    @classmethod
    def from_points(
        cls,
        pixels: ArrayLike,
        values: tuple[float, float, float, float],
        logarithmic: tuple[bool, bool] = (False, False),
        *,
        straight: bool = False,
    ) -> PixelAxes:
        """Calibrate from two points on each axis.

        Going from the first to the second point of an axis changes its own coordinate by the difference of their
        values and leaves the other coordinate alone. The two conditions fix the four numbers of the matrix, for axes
        that are turned or sheared in the picture as well.

        Parameters
        ----------
        pixels : the points X1, X2, Y1, Y2 in pixels, shape ``(4, 2)``
        values : of the abscissa at X1 and X2, of the ordinate at Y1 and Y2, in the units of the axes
        logarithmic : whether abscissa and ordinate are logarithmic
        straight : ignore a small tilt: each coordinate follows one direction of the pixels only

        Raises
        ------
        InputError
            for two values that are equal or, on a logarithmic axis, not positive; for axes that are parallel or have
            no length

        Examples
        --------
        A linear abscissa with 100 pixels from 0 to 5, and an ordinate with 50 pixels for each decade, upwards:

        >>> axes = PixelAxes.from_points([(10, 200), (110, 200), (10, 200), (10, 100)], (0, 5, 0.1, 10), (False, True))
        >>> axes.values([[60, 150]])
        array([[2.5, 1. ]])
        """
        points = np.asarray(pixels, dtype=float)
        coordinates = [_coordinate(value, logarithmic[i // 2], i) for i, value in enumerate(values)]
        steps = np.array([coordinates[1] - coordinates[0], coordinates[3] - coordinates[2]])
        for name, step in zip(("abscissa", "ordinate"), steps, strict=True):
            if step == 0.0 or not isfinite(step):
                same = "the same value" if step == 0.0 else "values too far apart for a number"
                raise InputError(f"the two calibration points of the {name} have {same}")
        along = np.column_stack([points[1] - points[0], points[3] - points[2]])
        with np.errstate(over="ignore", invalid="ignore"):  # pixels beyond all numbers span nothing
            lengths = np.hypot(along[0], along[1])
            determinant = along[0, 0] * along[1, 1] - along[0, 1] * along[1, 0]
            spanned = abs(determinant) > _SMALLEST_SINE * lengths[0] * lengths[1]
        if not spanned:
            raise InputError(
                "the calibration points do not span two axes; expected X1, X2 apart and Y1, Y2 apart"
            )
        matrix = steps[:, np.newaxis] * np.linalg.inv(along)
        if straight:
            upright = abs(matrix[0, 0] * matrix[1, 1]) > abs(matrix[0, 1] * matrix[1, 0])
            kept = np.eye(2) if upright else np.eye(2)[::-1]
            matrix = np.zeros((2, 2))
            matrix[kept == 1.0] = steps / along.T[kept == 1.0]
        starts = np.array([coordinates[0], coordinates[2]])
        origin = starts - np.array([matrix[0] @ points[0], matrix[1] @ points[2]])
        return cls(matrix, origin, logarithmic)

    def values(self, pixels: ArrayLike) -> FloatArray:
        """Values at pixels.

        Parameters
        ----------
        pixels : x and y, shape ``(N, 2)``

        Returns
        -------
        numpy.ndarray
            abscissa and ordinate in the units of the axes, shape ``(N, 2)``
        """
        with np.errstate(over="ignore", invalid="ignore"):  # refused where quantities are checked
            result = np.asarray(pixels, dtype=float) @ self.matrix.T + self.origin
            return np.where(self.logarithmic, 10.0**result, result)

    def reading_error(self, values: ArrayLike, pixel_error: float) -> FloatArray:
        """Standard deviation of values from that of the pixels.

        Errors of both pixel coordinates are independent and of the same size s, so a coordinate has the standard
        deviation s √(a² + b²) with a and b its change per pixel in x and y. On a logarithmic axis that of the value is
        ln 10 times the value times it: a constant relative error.

        Parameters
        ----------
        values : abscissa and ordinate in the units of the axes, shape ``(N, 2)``
        pixel_error : standard deviation of a pixel coordinate, pixels

        Returns
        -------
        numpy.ndarray
            standard deviations in the units of the axes, shape ``(N, 2)``

        Examples
        --------
        >>> axes = PixelAxes.from_points([(10, 200), (110, 200), (10, 200), (10, 100)], (0, 5, 0.1, 10), (False, True))
        >>> axes.reading_error([[2.5, 1.0]], 1.0).round(6)
        array([[0.05    , 0.046052]])
        """
        coordinate = pixel_error * np.hypot(self.matrix[:, 0], self.matrix[:, 1])
        numbers = np.asarray(values, dtype=float)
        relative = log(10.0) * coordinate * np.abs(numbers)
        return np.where(self.logarithmic, relative, np.broadcast_to(coordinate, numbers.shape))

    def pixels_apart(self, pixels: ArrayLike, stored: ArrayLike) -> float:
        """Largest distance, in pixels along one axis, between values computed here and values stored with the points.

        Parameters
        ----------
        pixels : x and y, shape ``(N, 2)``
        stored : abscissa and ordinate in the units of the axes, shape ``(N, 2)``
        """
        found: Any = np.array([self.values(pixels), np.asarray(stored, dtype=float)])
        with np.errstate(all="ignore"):  # what is no number is infinitely far away
            coordinates = np.where(self.logarithmic, np.log10(found), found)
            apart = np.abs(coordinates[0] - coordinates[1]) / np.hypot(self.matrix[:, 0], self.matrix[:, 1])
        return float(np.nan_to_num(apart, nan=np.inf).max())


def _coordinate(value: float, logarithmic: bool, position: int) -> float:
    if not logarithmic:
        return value
    if value <= 0.0:
        name = ("X1", "X2", "Y1", "Y2")[position]
        raise InputError(
            f"calibration point {name} has the value {value:g}; expected > 0 on a logarithmic axis"
        )
    return log10(value)
