"""How much a surface differs from direction to direction: C(q, φ), its second harmonic, and the principal slopes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.topography.area_spectrum import usual_window
from skinbayes.topography.bins import BINS_PER_DECADE, bin_of, bins_of_sums, independent_area_modes
from skinbayes.topography.height_map import HeightMap
from skinbayes.topography.periodogram import Periodogram, map_periodogram
from skinbayes.topography.windows import Window

SECTORS = 12
"""Directions of C(q, φ), 15° each."""

BY_CHANCE = 0.05
"""Probability with which an isotropic surface has a larger degree than ``degree_by_chance``."""


class DirectionalSpectrum(NamedTuple):
    """A power spectrum by direction. Angles are of the wavevector, from the rows of the map towards rising row numbers.

    Ridges, furrows and scratches run at right angles to the direction of their wavevector.

    Attributes
    ----------
    wavevector : of each bin, 1/m, shape ``(K,)``
    angle : of each sector, rad, shape ``(A,)``, 0 to π
    power_spectral_density : C(q, φ), m^4, shape ``(K, A)``; nan where a sector has no mode
    degree : of each bin, 0 (isotropic) to 1 (all in one direction), dimensionless, shape ``(K,)``
    direction : of the strongest waves of each bin, rad, shape ``(K,)``, 0 to π
    degree_by_chance : which an isotropic Gaussian surface exceeds in 5 % of maps, dimensionless, shape ``(K,)``
    slope_degree : of the mean square slopes in the two principal directions, (s₁² − s₂²)/(s₁² + s₂²), in the band, dimensionless
    slope_direction : in which the slope is largest, rad
    slope_degree_by_chance : dimensionless
    """

    wavevector: FloatArray
    angle: FloatArray
    power_spectral_density: FloatArray
    degree: FloatArray
    direction: FloatArray
    degree_by_chance: FloatArray
    slope_degree: float
    slope_direction: float
    slope_degree_by_chance: float


def directional_spectrum(
    surface: HeightMap,
    *,
    window: Window | None = None,
    bins_per_decade: int = BINS_PER_DECADE,
    wavevector_min: float = 0.0,
    wavevector_max: float = np.inf,
) -> DirectionalSpectrum:
    """Power spectrum of a map by direction, C(q, φ), with a degree and a direction for each bin and for the slopes.

    ``degree exp(2iφ) = ⟨C exp(2iφ)⟩/⟨C⟩ − ⟨exp(2iφ)⟩`` over the modes of a bin: 0 for an isotropic surface on any field, 1 for a
    grating on a square one. The slopes are ``s² = ∫ q² C d²q`` along the principal axes of their tensor, over the band.

    Parameters
    ----------
    surface : map without trend and undefined pixels, heights in m
    window : ``"hann"``, ``"blackman"`` or ``"none"``; Hann's if omitted, none of a periodic map
    bins_per_decade : of wavevectors, dimensionless
    wavevector_min, wavevector_max : band of the slopes, 1/m

    Returns
    -------
    spectrum : `DirectionalSpectrum`

    References
    ----------
    Longuet-Higgins, Phil. Trans. R. Soc. A 249 (1957) 321, Sect. 2.2, doi 10.1098/rsta.1957.0002, on the principal slopes.

    Examples
    --------
    >>> import numpy as np
    >>> x, y = np.arange(64), np.arange(64)[:, None]
    >>> grating = HeightMap(np.sin(2 * np.pi * (8 * x + 8 * y) / 64), pixel_size_x=1.0, pixel_size_y=1.0, periodic=True)
    >>> found = directional_spectrum(grating)
    >>> round(found.slope_degree, 6), round(float(np.degrees(found.slope_direction)), 3)
    (1.0, 45.0)
    """
    periodogram = map_periodogram(surface, usual_window(surface) if window is None else window)
    return directional_spectrum_of(periodogram, bins_per_decade, wavevector_min, wavevector_max)


def directional_spectrum_of(
    found: Periodogram, per_decade: int, wavevector_min: float = 0.0, wavevector_max: float = np.inf
) -> DirectionalSpectrum:
    """The same of a periodogram that is there already."""
    largest = found.largest * (1 - 1e-12)
    first = int(bin_of(np.array([min(found.wavevector_x[1], found.wavevector_y[1])]), per_decade)[0])
    size = int(bin_of(np.array([largest]), per_decade)[0]) - first + 1
    sums = [np.zeros(size) for _ in range(4)]
    harmonic, bare = np.zeros(size, dtype=complex), np.zeros(size)
    sector_power, sector_count = np.zeros(size * SECTORS), np.zeros(size * SECTORS)
    tensor, slopes = 0j, np.zeros(size)
    block = max(1, 2**20 // found.wavevector_x.size)
    for start in range(0, found.wavevector_y.size, block):
        rows = slice(start, start + block)
        q_y, q_x = np.broadcast_arrays(found.wavevector_y[rows][:, None], found.wavevector_x)
        q2 = np.square(q_y) + np.square(q_x)
        inside = (q2 > 0) & (q2 <= largest**2)
        q2, q_x, q_y = q2[inside], q_x[inside], q_y[inside]
        half = 0.5 * (found.count_y[rows][:, None] * found.count_x)[inside]
        forward, backward = half * found.forward[rows][inside], half * found.backward[rows][inside]
        both = forward + backward
        log_q = 0.5 * np.log(q2)
        index = np.floor(log_q * (per_decade / np.log(10)) + 1e-9).astype(np.intp) - first
        cos = (np.square(q_x) - np.square(q_y)) / q2
        sin = 2 * q_x * q_y / q2
        turned = both * cos, (forward - backward) * sin
        for sum_, weights in zip(
            sums, (2 * half, both, 2 * half * log_q, 2 * half * np.square(log_q)), strict=True
        ):
            sum_ += np.bincount(index, weights, size)
        harmonic += np.bincount(index, turned[0], size) + 1j * np.bincount(index, turned[1], size)
        bare += np.bincount(index, 2 * half * cos, size)
        band = (q2 >= wavevector_min**2) & (q2 <= wavevector_max**2)
        tensor += np.sum((q2 * turned[0])[band]) + 1j * np.sum((q2 * turned[1])[band])
        slopes += np.bincount(index[band], (q2 * both)[band], size)
        angle = np.arctan2(q_y, q_x)
        for power, phi in ((forward, angle), (backward, np.pi - angle)):
            # a wavevector and its negative are one wave: φ and φ + π
            sector = np.floor(phi * (SECTORS / np.pi) + 0.5).astype(np.intp) % SECTORS
            place = index * SECTORS + sector
            sector_power += np.bincount(place, power, size * SECTORS)
            sector_count += np.bincount(place, half, size * SECTORS)
    bins = bins_of_sums(first, sums)
    full = bins.number - first
    independent = independent_area_modes(found, bins, per_decade)
    relative = harmonic[full] / np.maximum(bins.power * bins.modes, 1e-300) - bare[full] / bins.modes
    with np.errstate(invalid="ignore", divide="ignore"):
        by_sector = (sector_power / sector_count).reshape(size, SECTORS)[full]
    total = slopes.sum()
    # both parts of ⟨C exp(2iφ)⟩/⟨C⟩ have the variance 1/(2 modes): its modulus is a Rayleigh variable
    chance = np.sqrt(-np.log(BY_CHANCE) / independent)
    shares = slopes[full] / total if total else np.zeros(full.size)
    return DirectionalSpectrum(
        np.exp(bins.log_wavevector),
        np.arange(SECTORS) * np.pi / SECTORS,
        by_sector,
        np.minimum(np.abs(relative), 1.0),
        (np.angle(relative) / 2) % np.pi,
        np.minimum(chance, 1.0),
        float(abs(tensor) / total) if total else 0.0,
        float((np.angle(tensor) / 2) % np.pi),
        float(min(1.0, np.sqrt(np.sum(np.square(shares * chance))))),
    )
