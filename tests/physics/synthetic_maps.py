"""Random surfaces of known spectrum, made here so that nothing of what is tested makes them."""

from __future__ import annotations

import numpy as np

from skinbayes.topography import HeightMap


def power(q: np.ndarray, *, hurst: float = 0.8, rolloff: float = 1e5, plateau: float = 1e-24) -> np.ndarray:
    """C(q), m^4: a plateau and a power law."""
    return plateau * np.maximum(np.asarray(q) / rolloff, 1.0) ** (-2 - 2 * hurst)


def periodic_map(seed: int, shape: tuple[int, int] = (256, 256), pixel: tuple[float, float] = (1e-6, 1e-6), *,
                 stretch: float = 1.0, angle: float = 0.0, **spectrum: float) -> HeightMap:  # fmt: skip
    """White noise through the root of the spectrum; heights of unit variance have C = ΔxΔy/(2π)².

    ``stretch`` makes waves along ``angle`` shorter and those across longer by this factor.
    """
    rows, columns = shape
    q_x = 2 * np.pi * np.fft.rfftfreq(columns, pixel[0])
    q_y = 2 * np.pi * np.fft.fftfreq(rows, pixel[1])[:, None]
    along, across = q_x * np.cos(angle) + q_y * np.sin(angle), -q_x * np.sin(angle) + q_y * np.cos(angle)
    c = power(np.hypot(along / stretch, across * stretch), **spectrum)
    c[0, 0] = 0.0
    noise = np.fft.rfft2(np.random.default_rng(seed).standard_normal(shape))
    height = np.fft.irfft2(noise * np.sqrt(c * (2 * np.pi) ** 2 / (pixel[0] * pixel[1])), s=shape)
    return HeightMap(height, pixel_size_x=pixel[0], pixel_size_y=pixel[1], periodic=True)


def cut(surface: HeightMap, rows: int, columns: int) -> HeightMap:
    """A corner of a periodic map, which is not periodic."""
    return HeightMap(
        surface.height[:rows, :columns], pixel_size_x=surface.pixel_size_x, pixel_size_y=surface.pixel_size_y
    )


def deviations(spectrum, true=power) -> np.ndarray:
    """(C/C_true − 1) in standard errors, of the reliable bins."""
    used = spectrum.reliable
    expected = true(spectrum.wavevector[used])
    return (spectrum.power_spectral_density[used] / expected - 1) * np.sqrt(spectrum.independent_modes[used])
