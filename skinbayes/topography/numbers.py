"""rms height, slope and area of a map itself, without its spectrum."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.topography.height_map import HeightMap, LineProfile


class SurfaceNumbers(NamedTuple):
    """What a map has, counted pixel by pixel.

    Attributes
    ----------
    rms_height : about its mean, m
    rms_slope : of the gradient's magnitude from differences of neighbours, dimensionless; of a line √2 times that along it, which
        is the same if the surface is isotropic
    total_area_ratio : area of the triangles between pixels over the nominal one, dimensionless; nan of a line
    skewness : of the heights, dimensionless; negative where furrows are deeper than ridges are high
    kurtosis : of the heights, dimensionless; 3 of a Gaussian surface
    """

    rms_height: float
    rms_slope: float
    total_area_ratio: float
    skewness: float
    kurtosis: float


def surface_numbers(surface: HeightMap | LineProfile) -> SurfaceNumbers:
    """Rms height, slope, area and shape of the heights of a map or line.

    ``⟨h²⟩``, ``⟨(Δ_x h/Δx)² + (Δ_y h/Δy)²⟩`` with differences between neighbours, and the area of two triangles in each square of
    four pixels, halved over both diagonals. Undefined pixels, and what borders on them, are left out. Differences pass
    ``sinc²(qΔ/2)`` of the mean square slope of a wave: 41 % at the wavevector of Nyquist.

    Parameters
    ----------
    surface : map or line without trend, heights in m

    Returns
    -------
    numbers : `SurfaceNumbers`

    References
    ----------
    ISO 25178-2 (2021), Sect. 4 names them Sq, Sdq, Sdr + 1, Ssk, Sku; their relation to spectra is Eq. 6 and following of
    doi 10.1088/2051-672X/aa51f8.

    Examples
    --------
    >>> import numpy as np
    >>> plane = HeightMap(np.arange(16.0) * np.ones((16, 1)), pixel_size_x=1.0, pixel_size_y=1.0)
    >>> found = surface_numbers(plane)
    >>> round(found.rms_slope, 12), round(found.total_area_ratio, 6)
    (1.0, 1.414214)
    """
    height = surface.height
    mean = float(np.nanmean(height))
    squares = np.square(height - mean)
    variance = float(np.nanmean(squares))
    if variance > 0:
        skewness = float(np.nanmean(squares * (height - mean))) / variance**1.5
        kurtosis = float(np.nanmean(np.square(squares))) / variance**2
    else:
        skewness = kurtosis = float("nan")
    if isinstance(surface, LineProfile):
        along = _mean_square(np.diff(height), surface.pixel_size)
        return SurfaceNumbers(
            float(np.sqrt(variance)), float(np.sqrt(2 * along)), float("nan"), skewness, kurtosis
        )
    del squares
    slope = _mean_square(np.diff(height, axis=1), surface.pixel_size_x)
    slope += _mean_square(np.diff(height, axis=0), surface.pixel_size_y)
    return SurfaceNumbers(
        float(np.sqrt(variance)), float(np.sqrt(slope)), _area_ratio(surface), skewness, kurtosis
    )


def _mean_square(difference: FloatArray, size: float) -> float:
    return float(np.nanmean(np.square(difference, out=difference))) / size**2


def _area_ratio(surface: HeightMap) -> float:
    """Mean of sqrt(1 + slope²) over the triangles of both ways to halve each square of pixels, in blocks of rows."""
    total, count = 0.0, 0
    height, d_x, d_y = surface.height, surface.pixel_size_x, surface.pixel_size_y
    for start in range(0, height.shape[0] - 1, 256):
        rows = height[start : start + 257]
        along, across = np.square(np.diff(rows, axis=1) / d_x), np.square(np.diff(rows, axis=0) / d_y)
        # a triangle has one edge along and one across
        for x in (along[:-1], along[1:]):
            for y in (across[:, :-1], across[:, 1:]):
                area = np.sqrt(1 + x + y)
                total += float(np.nansum(area))
                count += int(np.count_nonzero(~np.isnan(area)))
    return total / count if count else float("nan")
