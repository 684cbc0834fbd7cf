"""Ridges of finger pads: spacing, height and width from a map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import optimize

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.topography.height_map import HeightMap

FEWEST_RIDGES = 4
"""Ridges that a map must have across for their spacing to be told from roughness."""

HARMONICS = 6
"""Waves of which the profile of a ridge is made when spacing and direction are refined."""

PIXELS = 20_000
"""Pixels at most by which spacing and direction are refined."""

BINS = 60
"""Parts of a spacing in which heights are averaged."""

TILES = 4
"""Pieces along each side of the map whose differences give the standard errors."""

LEAST_EXPLAINED = 0.1
"""Share of the variance of heights that ridges must explain."""


@dataclass(frozen=True, kw_only=True)
class MeasuredRidges:
    """Parallel ridges on a map; standard errors are those of the mean over the map, from the scatter between its pieces.

    Attributes
    ----------
    spacing, spacing_standard_error : distance from ridge to ridge, m
    height, height_standard_error : from valleys to tops, medians of both, m
    width, width_standard_error : of a ridge at half of its height, m
    angle : direction of the ridges, rad, from the x axis (second axis of the map) towards y, from −π/2 to π/2
    explained : share of the variance of heights that straight ridges of one spacing explain, dimensionless
    """

    spacing: float
    spacing_standard_error: float
    height: float
    height_standard_error: float
    width: float
    width_standard_error: float
    angle: float
    explained: float

    @property
    def area_share(self) -> float:
        """Area of the tops over that of the map, ``width/spacing``, dimensionless."""
        return self.width / self.spacing


def measure_ridges(surface: HeightMap) -> MeasuredRidges:
    """Spacing, height and width of parallel ridges.

    The strongest wave of the map is the first guess; spacing and direction are those that let a periodic profile of six harmonics
    explain most of the variance. Height and width come from the mean profile: half way between the medians of what lies above and
    below half way between its highest and lowest point.

    Parameters
    ----------
    surface : levelled map of at least four straight ridges, heights in m; undefined pixels are left out

    Returns
    -------
    MeasuredRidges
        Lengths in m, angle in rad, with standard errors.

    Raises
    ------
    InputError
        Fewer than four ridges across the map, or ridges that explain less than a tenth of the variance of heights.

    Notes
    -----
    For maps of skin or its replicas, such as those of Sect. 2 of the paper. Ridges that bend over the map are averaged to
    lower and wider ones; take a part on which they are straight. Tilt and curvature have to be taken off before.

    References
    ----------
    Adams et al., J. R. Soc. Interface 10 (2013) 20120467, doi 10.1098/rsif.2012.0467, on what ridges do to friction; the
    definitions of height and width are this package's own.

    Examples
    --------
    >>> from skinbayes.roughness import SelfAffineSpectrum
    >>> from skinbayes.topography import Ridges, random_surface
    >>> rough = SelfAffineSpectrum(rms_height=2e-6, hurst_exponent=0.8, wavevector_min=2e4, wavevector_rolloff=4e4,
    ...     wavevector_max=1e9)
    >>> ridged = random_surface(rough, shape=(256, 256), pixel_size=20e-6, seed=1, ridges=Ridges(0.5e-3, 50e-6, 0.3e-3))
    >>> found = measure_ridges(ridged)
    >>> print(f"{found.spacing:.1e} {found.height:.1e} {found.width:.1e}")
    5.0e-04 5.0e-05 3.0e-04
    """
    height = np.asarray(surface.height, dtype=float)
    known = np.isfinite(height)
    height = np.where(known, height - height[known].mean(), 0.0)
    x: FloatArray = np.asarray(np.arange(height.shape[1]) * surface.pixel_size_x, dtype=np.float64)
    y: FloatArray = np.asarray(np.arange(height.shape[0])[:, None] * surface.pixel_size_y, dtype=np.float64)
    qx, qy = _strongest(surface, height)
    qx, qy = _refined(x, y, height, known, (qx, qy))
    q = float(np.hypot(qx, qy))
    phase = (x * qx + y * qy) / (2 * np.pi)
    fit = _profile(phase[known], height[known])
    explained = 1 - float(np.mean(np.square(height[known] - fit)) / np.mean(np.square(height[known])))
    if explained < LEAST_EXPLAINED:
        raise InputError(
            f"straight ridges explain {explained:.0%} of the variance of heights; expected at least {LEAST_EXPLAINED:.0%}: a "
            "levelled map with parallel ridges, or a part of one on which they are straight"
        )
    spacing = 2 * np.pi / q
    tall, share = _shape(phase[known], height[known])
    pieces: FloatArray = np.array(_of_pieces(x, y, height, known, (qx, qy)), dtype=np.float64)
    errors = pieces.std(axis=0, ddof=1) / np.sqrt(len(pieces)) if len(pieces) > 1 else np.full(3, np.nan)
    angle = float(np.arctan2(qx, -qy))
    angle = (angle + np.pi / 2) % np.pi - np.pi / 2
    return MeasuredRidges(
        spacing=spacing,
        spacing_standard_error=float(errors[0]),
        height=tall,
        height_standard_error=float(errors[1]),
        width=share * spacing,
        width_standard_error=float(errors[2]),
        angle=angle,
        explained=explained,
    )


def _strongest(surface: HeightMap, height: FloatArray) -> tuple[float, float]:
    """Wavevector of the strongest wave of which a few fit on the map, 1/m; ridges stand out of the ring of their own size."""
    rows, columns = height.shape
    window = np.hanning(rows)[:, None] * np.hanning(columns)
    power = np.abs(np.fft.rfft2(height * window)) ** 2
    qx = 2 * np.pi * np.fft.rfftfreq(columns, surface.pixel_size_x)
    qy = 2 * np.pi * np.fft.fftfreq(rows, surface.pixel_size_y)[:, None]
    waves = np.hypot(qx * surface.size_x, qy * surface.size_y) / (2 * np.pi)
    q = np.hypot(qx, qy)
    nyquist = np.pi / max(surface.pixel_size_x, surface.pixel_size_y)
    allowed = (waves >= FEWEST_RIDGES) & (q <= nyquist / 4)
    if not allowed.any():
        raise InputError(f"the map is too small for {FEWEST_RIDGES} ridges of at least eight pixels each")
    place = np.unravel_index(np.argmax(np.where(allowed, power, 0.0)), power.shape)
    return float(qx[place[1]]), float(qy[place[0], 0])


def _profile(phase: FloatArray, height: FloatArray) -> FloatArray:
    """The periodic profile of six harmonics at each pixel."""
    angles = 2 * np.pi * np.arange(1, HARMONICS + 1) * phase[:, None]
    design = np.concatenate([np.ones((len(phase), 1)), np.cos(angles), np.sin(angles)], axis=1)
    return np.asarray(design @ np.linalg.solve(design.T @ design, design.T @ height))


def _strength(phase: FloatArray, height: FloatArray) -> float:
    """Mean square height of six harmonics, as if they were orthogonal over the pixels."""
    wave = np.exp(-2j * np.pi * phase)
    harmonic, total = np.ones_like(wave), 0.0
    for _ in range(HARMONICS):
        harmonic = harmonic * wave
        total += 2 * float(np.abs(np.mean(height * harmonic)) ** 2)
    return total


def _refined(
    x: FloatArray, y: FloatArray, height: FloatArray, known: FloatArray, start: tuple[float, float]
) -> tuple[float, float]:
    """The wavevector whose harmonics are strongest, near a first guess."""
    # pixels at random: regular ones would take short waves for long ones
    places = np.random.default_rng(0).permutation(np.flatnonzero(known))[:PIXELS]
    row, column = np.unravel_index(places, height.shape)
    values, across = height[row, column], (x[column], y[row, 0])
    size = np.array([np.ptp(part) for part in across])

    def weakness(waves: FloatArray) -> float:
        return -_strength(waves[0] / size[0] * across[0] + waves[1] / size[1] * across[1], values)

    guess = np.array(start) * size / (2 * np.pi)
    simplex = guess + np.array([[0.0, 0.0], [0.4, 0.0], [0.0, 0.4]])
    options = {"initial_simplex": simplex, "xatol": 1e-4, "fatol": 0.0, "maxiter": 120}
    found = optimize.minimize(weakness, guess, method="Nelder-Mead", options=options).x
    qx, qy = 2 * np.pi * found / size
    return float(qx), float(qy)


def _shape(phase: FloatArray, height: FloatArray) -> tuple[float, float]:
    """Height of the mean profile, and the share of it that is above half of that."""
    part = np.minimum(((phase % 1.0) * BINS).astype(int), BINS - 1)
    count = np.bincount(part, minlength=BINS)
    mean = np.bincount(part, height, minlength=BINS)[count > 0] / count[count > 0]
    middle = (mean.max() + mean.min()) / 2
    low, high = np.median(mean[mean <= middle]), np.median(mean[mean > middle])
    # straight between the middles of neighbouring bins
    fine = np.interp(np.arange(0, len(mean), 0.01), np.arange(len(mean) + 1), np.append(mean, mean[0]))
    return float(high - low), float(np.mean(fine > (low + high) / 2))


def _of_pieces(
    x: FloatArray, y: FloatArray, height: FloatArray, known: FloatArray, q: tuple[float, float]
) -> list[tuple[float, float, float]]:
    """Spacing, height and width of pieces of the map, each along the common direction."""
    size = float(np.hypot(*q))
    direction = q[0] / size, q[1] / size
    found = []
    for rows in np.array_split(np.arange(height.shape[0]), TILES):
        for columns in np.array_split(np.arange(height.shape[1]), TILES):
            inside = known[np.ix_(rows, columns)]
            place = (x[columns] * direction[0] + y[rows] * direction[1])[inside]
            values = height[np.ix_(rows, columns)][inside]
            if len(values) < 20 * HARMONICS or np.ptp(place) * size < 2 * np.pi:
                continue

            def weakness(factor: float, place: FloatArray = place, values: FloatArray = values) -> float:
                return -_strength(place * size * factor / (2 * np.pi), values - values.mean())

            reach = min(0.1, np.pi / (np.ptp(place) * size))
            factor = optimize.minimize_scalar(weakness, bounds=(1 - reach, 1 + reach), method="bounded").x
            tall, share = _shape(place * size * factor / (2 * np.pi), values)
            spacing = 2 * np.pi / (size * factor)
            found.append((spacing, tall, share * spacing))
    return found
