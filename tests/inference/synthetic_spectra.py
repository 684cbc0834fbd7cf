"""Synthetic maps and their spectra: a plain radial average, which shares no code with the package."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from skinbayes.roughness import SelfAffineSpectrum
from skinbayes.topography import HeightMap, MeasuredSpectrum, random_surface


def radial_average(surface: HeightMap, bins_per_decade: int = 16) -> MeasuredSpectrum:
    """Power spectrum of a periodic square map, C = |∫h exp(−iqx)d²x|²/((2π)² A), averaged over rings of wavevectors."""
    size, pixel = surface.height.shape[0], surface.pixel_size_x
    transform = np.fft.fft2(surface.height - surface.height.mean()) * pixel**2
    power = np.abs(transform) ** 2 / ((2 * np.pi) ** 2 * (size * pixel) ** 2)
    axis = 2 * np.pi * np.fft.fftfreq(size, pixel)
    q = np.hypot(axis, axis[:, None]).ravel()
    low, high = 2 * np.pi / (size * pixel) * 0.999, np.pi / pixel
    edges = np.geomspace(low, high, int(bins_per_decade * np.log10(high / low)) + 1)
    ring = np.digitize(q, edges) - 1
    inside = (ring >= 0) & (ring < len(edges) - 1)
    count = np.bincount(ring[inside])
    some = count > 0
    mean = np.bincount(ring[inside], power.ravel()[inside])[some] / count[some]
    centre = np.exp(np.bincount(ring[inside], np.log(q[inside]))[some] / count[some])
    return MeasuredSpectrum(
        centre,
        power_spectral_density=mean,
        independent_modes=count[some] / 2,  # heights are real: half of the ordinates repeat the others
        wavevector_min=low,
        wavevector_max=high,
        source="synthetic, random phases",
    )


def made_up_surface(rng: np.random.Generator, seed: int, size: int = 256, pixel: float = 2e-6):
    """A random surface of random parameters: the parameters, and its map."""
    first = 2 * np.pi / (size * pixel) * 0.999
    truth = {
        "rms_height": 10 ** rng.uniform(-6.5, -5),
        "hurst_exponent": rng.uniform(0.4, 0.95),
        "wavevector_rolloff": first * 10 ** rng.uniform(0.3, 0.9),
    }
    spectrum = SelfAffineSpectrum(**truth, wavevector_min=first, wavevector_max=10 ** rng.uniform(7.5, 9.5))
    return truth, spectrum, random_surface(spectrum, shape=(size, size), pixel_size=pixel, seed=seed)


def map_of(
    power: Callable[[np.ndarray], np.ndarray], *, seed: int, size: int = 256, pixel: float = 2e-6
) -> HeightMap:
    """One period of random waves of a power spectrum C(q), m^4, q in 1/m."""
    q = 2 * np.pi * np.hypot(np.fft.fftfreq(size, pixel)[:, None], np.fft.rfftfreq(size, pixel))
    q[0, 0] = q[0, 1]
    waves = np.fft.rfft2(np.random.default_rng(seed).standard_normal((size, size)))
    waves[0, 0] = 0.0
    height = np.fft.irfft2(waves * np.sqrt(power(q)) * 2 * np.pi / pixel, s=(size, size))
    return HeightMap(height, pixel_size_x=pixel, pixel_size_y=pixel, periodic=True)
