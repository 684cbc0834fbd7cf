"""Synthetic surfaces: random ones of a given power spectrum, isotropic or stretched, with or without ridges."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.roughness.spectrum import PowerSpectrum, SelfAffineSpectrum
from skinbayes.roughness.validation import validate_spectrum
from skinbayes.topography.height_map import HeightMap


class Anisotropy(NamedTuple):
    """How roughness is stretched.

    Attributes
    ----------
    ratio : length of features along ``angle`` over that across, dimensionless, > 0
    angle : direction of the long features, rad, from the x axis (second axis of the map) towards y
    """

    ratio: float
    angle: float = 0.0


class Ridges(NamedTuple):
    """Parallel ridges such as those of a finger pad: flat tops, flat valleys, and flanks that are half a cosine.

    Attributes
    ----------
    spacing : distance from ridge to ridge, m
    height : from valley to top, m
    width : of a ridge at half of its height, m, less than ``spacing``
    flank : width of one flank, m; half of the narrower of ridge and valley if None
    angle : direction of the ridges, rad, from the x axis towards y
    """

    spacing: float
    height: float
    width: float
    flank: float | None = None
    angle: float = 0.0


def random_surface(
    spectrum: PowerSpectrum,
    *,
    shape: tuple[int, int],
    pixel_size: float,
    seed: int,
    amplitudes: Literal["gaussian", "exact"] = "gaussian",
    anisotropy: Anisotropy | None = None,
    ridges: Ridges | None = None,
) -> HeightMap:
    """A synthetic surface of a given power spectrum: plane waves of random phase, periodic.

    ``h(x) = Σ_q a_q exp(iq·x)`` over the wavevectors of the grid, with ``⟨|a_q|²⟩ = C(q) (2π)²/A`` for a map of area A: the
    sum form of ``⟨h²⟩ = ∫ C d²q`` (Eq. 1 of the paper).

    Parameters
    ----------
    spectrum : C in m^4, scalar parameters
    shape : rows and columns of the map, ``(M, N)``
    pixel_size : m, the same along both axes
    seed : non-negative integer, dimensionless; one seed gives one surface
    amplitudes : ``"gaussian"``, as those of a random Gaussian surface: heights and moments scatter from seed to seed and
        periodogram ordinates are exponentially distributed; or ``"exact"``, each wave has its mean amplitude, so that rms height
        and slope are the same for all seeds
    anisotropy : stretches wavelengths by √ratio along its angle and shrinks them across; the rms height stays
    ridges : added to the roughness

    Returns
    -------
    HeightMap
        Heights in m, of mean zero, ``periodic`` unless ridges do not fit the map.

    Raises
    ------
    InputError
        A spectrum, shape, pixel, ratio or ridge that cannot be, or no wave of the spectrum fits on the grid.

    Notes
    -----
    The map has the part of the spectrum between its own longest wave, 2π over its side, and π over the pixel. Its mean square
    height and slope are sums over waves, ``Σ C(q) (2π)²/A``; they differ from the integrals of `roughness.spectral_moment` the
    less, the more waves lie below q_r and q1. With the side of the map eight wavelengths of q0, q_r = 3 q0 and q1 a quarter of
    π over the pixel, the rms height is 1.1e-3 and the slope 9e-5 off.

    References
    ----------
    Persson et al., J. Phys.: Condens. Matter 17 (2005) R1, doi 10.1088/0953-8984/17/1/R01.

    Examples
    --------
    >>> from skinbayes.roughness import SelfAffineSpectrum
    >>> spectrum = SelfAffineSpectrum(rms_height=5e-6, hurst_exponent=0.8, wavevector_min=5e4, wavevector_rolloff=1.5e5,
    ...     wavevector_max=1e6)
    >>> surface = random_surface(spectrum, shape=(512, 512), pixel_size=2e-6, seed=1, amplitudes="exact")
    >>> print(f"{surface.height.std():.2e}")
    5.00e-06
    """
    _check(shape, pixel_size, anisotropy, ridges)
    if isinstance(spectrum, SelfAffineSpectrum):
        validate_spectrum(spectrum)
    rows, columns = shape
    qx = np.asarray(2 * np.pi * np.fft.rfftfreq(columns, pixel_size), dtype=np.float64)
    qy = np.asarray(2 * np.pi * np.fft.fftfreq(rows, pixel_size)[:, None], dtype=np.float64)
    area = rows * columns * pixel_size**2
    along, across, stretch = _stretched(qx, qy, anisotropy)
    felt = np.hypot(along * stretch, across / stretch)
    # below Nyquist in every direction alike: the corners of the grid would give the map a direction
    resolved = np.hypot(qx, qy) <= np.pi / pixel_size
    power = np.where(resolved & (felt > 0), spectrum.power(felt), 0.0)
    if not power.any():
        raise InputError(
            f"no wave of the spectrum, {float(spectrum.wavevector_min):g} to {float(spectrum.wavevector_max):g} 1/m, fits on a "
            f"map with waves from {2 * np.pi / (max(shape) * pixel_size):g} to {np.pi / pixel_size:g} 1/m; expected another "
            "pixel_size or shape"
        )
    # the transform of white noise has the symmetry of real heights, also at its self-conjugate places
    wave = np.fft.rfft2(np.random.default_rng(seed).standard_normal(shape))
    if amplitudes == "exact":
        wave *= np.sqrt(rows * columns) / np.abs(wave)
    height = np.fft.irfft2(wave * np.sqrt(power * (rows * columns) * (2 * np.pi) ** 2 / area), s=shape)
    step = f"synthetic: random phases, {amplitudes} amplitudes, seed {seed}"
    if ridges is None:
        return HeightMap(
            height, pixel_size_x=pixel_size, pixel_size_y=pixel_size, periodic=True, steps=(step,)
        )
    profile, fits = _ridged(shape, pixel_size, ridges)
    return HeightMap(
        height + profile,
        pixel_size_x=pixel_size,
        pixel_size_y=pixel_size,
        periodic=fits,
        steps=(step, "synthetic: ridges"),
    )


def _stretched(
    qx: FloatArray, qy: FloatArray, anisotropy: Anisotropy | None
) -> tuple[FloatArray, FloatArray, float]:
    """Wavevectors along and across the stretching, and its factor."""
    ratio, angle = anisotropy or (1.0, 0.0)
    cosine, sine = np.cos(angle), np.sin(angle)
    return qx * cosine + qy * sine, qy * cosine - qx * sine, float(np.sqrt(ratio))


def _ridged(shape: tuple[int, int], pixel_size: float, ridges: Ridges) -> tuple[FloatArray, bool]:
    """Heights of the ridges, of mean zero, and whether they go on over the edges of the map."""
    y, x = (np.arange(count) * pixel_size for count in shape)
    sine, cosine = np.sin(ridges.angle), np.cos(ridges.angle)
    across = y[:, None] * cosine - x * sine
    flank = _flank(ridges)
    # distance from the middle of the nearest ridge
    distance = np.abs((across / ridges.spacing + 0.5) % 1.0 - 0.5) * ridges.spacing
    down = np.clip((distance - ridges.width / 2) / flank + 0.5, 0.0, 1.0)
    height = ridges.height * (1 + np.cos(np.pi * down)) / 2
    periods = [
        count * pixel_size * abs(part) / ridges.spacing
        for count, part in ((shape[0], cosine), (shape[1], sine))
    ]
    return height - height.mean(), bool(np.allclose(periods, np.round(periods), atol=1e-6))


def _flank(ridges: Ridges) -> float:
    narrow = min(ridges.width, ridges.spacing - ridges.width)
    return narrow / 2 if ridges.flank is None else ridges.flank


def _check(
    shape: tuple[int, int], pixel_size: float, anisotropy: Anisotropy | None, ridges: Ridges | None
) -> None:
    if len(shape) != 2 or min(shape) < 2:
        raise InputError(f"shape is {shape}, but must be two numbers of pixels, at least 2 each.")
    if not (np.isfinite(pixel_size) and pixel_size > 0):
        raise InputError(f"pixel_size is {pixel_size:g} m, but must be a finite number > 0 m.")
    if anisotropy is not None and not (np.isfinite(anisotropy.ratio) and anisotropy.ratio > 0):
        raise InputError(f"anisotropy.ratio is {anisotropy.ratio:g}, but must be a finite number > 0.")
    if ridges is None:
        return
    if not 0 < ridges.width < ridges.spacing < np.inf:
        raise InputError(
            f"ridges have a width of {ridges.width:g} m and a spacing of {ridges.spacing:g} m, but the width must be > 0 m and "
            "less than the spacing."
        )
    if not (np.isfinite(ridges.height) and ridges.height > 0):
        raise InputError(f"ridges.height is {ridges.height:g} m, but must be a finite number > 0 m.")
    most = min(ridges.width, ridges.spacing - ridges.width)
    if not 0 < _flank(ridges) <= most:
        raise InputError(
            f"ridges.flank is {_flank(ridges):g} m, but must be > 0 m and at most {most:g} m, the narrower of ridge and valley."
        )
