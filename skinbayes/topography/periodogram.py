"""The squared amplitudes of a map, mode by mode."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.topography.height_map import HeightMap, LineProfile
from skinbayes.topography.windows import window_values


class Periodogram(NamedTuple):
    """Power spectrum of a map at each of its modes, in the convention of the paper (Eq. 1), folded to positive wavevectors.

    The mean square height is the sum of ``count * (forward + backward) / 2`` times ``cell``.

    Attributes
    ----------
    forward : m^4, shape ``(M//2 + 1, N//2 + 1)``, of modes (q_y, q_x)
    backward : the same of modes (−q_y, q_x)
    wavevector_x, wavevector_y : 1/m, shapes ``(N//2 + 1,)``, ``(M//2 + 1,)``
    count_x, count_y : modes of the whole plane that each column and row stands for, 1 or 2
    cell : area of the plane of wavevectors that belongs to a mode, 1/m²
    window : its name
    """

    forward: FloatArray
    backward: FloatArray
    wavevector_x: FloatArray
    wavevector_y: FloatArray
    count_x: FloatArray
    count_y: FloatArray
    cell: float
    window: str

    @property
    def largest(self) -> float:
        """Radius of the largest circle in the plane of wavevectors, the smaller Nyquist wavevector, 1/m."""
        return float(min(self.wavevector_x[-1], self.wavevector_y[-1]))


def map_periodogram(surface: HeightMap, window: str) -> Periodogram:
    """Squared amplitudes of a map without undefined pixels; the window is a product of one along each axis."""
    from scipy import fft

    height = surface.height
    if np.isnan(height).any():
        raise InputError(
            "the map has undefined pixels; expected a map whose undefined pixels are filled or cut away"
        )
    rows, columns = height.shape
    tapered = height - height.mean()
    if window != "none":
        tapered *= window_values(window, columns)
        tapered *= window_values(window, rows)[:, None]
    amplitude = fft.rfft2(tapered, overwrite_x=True)
    # area of a pixel squared over area of the map and (2π)²
    scale = surface.pixel_size_x * surface.pixel_size_y / (rows * columns) / (2 * np.pi) ** 2
    power = np.square(amplitude.real)
    power += np.square(amplitude.imag)
    power *= scale
    half = rows // 2 + 1
    backward = np.empty((half, power.shape[1]))
    backward[0] = power[0]
    backward[1:] = power[: rows - half : -1]
    q_x, count_x = _axis(columns, surface.pixel_size_x)
    q_y, count_y = _axis(rows, surface.pixel_size_y)
    return Periodogram(power[:half], backward, q_x, q_y, count_x, count_y, float(q_x[1] * q_y[1]), window)


def line_periodogram(line: LineProfile, window: str) -> tuple[FloatArray, FloatArray]:
    """Wavevectors > 0 below that of Nyquist (1/m) and the two-sided one-dimensional power spectrum of a line there (m^3)."""
    if np.isnan(line.height).any():
        raise InputError("the line has undefined pixels; expected one whose undefined pixels are filled")
    height = line.height - line.height.mean()
    amplitude = np.fft.rfft(height * window_values(window, height.size))
    power = np.square(np.abs(amplitude)) * (line.pixel_size / height.size / (2 * np.pi))
    wavevector, _ = _axis(height.size, line.pixel_size)
    inner = slice(1, (height.size + 1) // 2)
    return wavevector[inner], np.asarray(power[inner], dtype=np.float64)


def _axis(pixels: int, size: float) -> tuple[FloatArray, FloatArray]:
    """Wavevectors from 0 to that of Nyquist, 1/m, and how many of −q and q each stands for."""
    wavevector: FloatArray = np.arange(pixels // 2 + 1, dtype=np.float64) * (2 * np.pi / (pixels * size))
    count = np.full(wavevector.size, 2.0)
    count[0] = 1.0
    if pixels % 2 == 0:
        count[-1] = 1.0
    return wavevector, count
