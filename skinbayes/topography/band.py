"""Between which wavevectors the spectrum of a map is that of the surface, and by which rule."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.errors import InputError
from skinbayes.topography.height_map import HeightMap, LineProfile

FEWEST_WAVES = 3.0
"""Waves on the shorter side of a field from which on the spectrum of a map with edges is used: there Hann's window and the
removal of a trend leave its mean right within 10 %, also if it goes on rising to longer waves."""

PIXELS_PER_WAVE = 4.0
"""Pixels along the shortest wave that is used: half of the wavevector of Nyquist. There a power law of exponent −3.6 gains 4 %
from shorter waves that pass for longer ones, and pixels that average over their area lose 10 to 19 %."""

TIP_SHARE = 0.5
"""Share of the curvature of a tip up to which valleys may be curved before it no longer follows them: Sanner et al. (2022)."""


class Band(NamedTuple):
    """Reliable wavevectors.

    Attributes
    ----------
    wavevector_min, wavevector_max : 1/m
    lower, upper : by which rule, in words
    """

    wavevector_min: float
    wavevector_max: float
    lower: str
    upper: str


def reliable_band(
    surface: HeightMap | LineProfile, *, tip_radius: float | None = None, resolution: float | None = None
) -> Band:
    """Reliable wavevectors of a prepared map or line.

    - Long waves: 3 waves on the shorter side (1 of a periodic map), ``q ≥ 2π·3/L``, as the window and the removal of tilt and
      curvature spoil longer ones.
    - Short waves: 4 pixels a wave, ``q ≤ π/(2Δ)``, half of the wavevector of Nyquist.
    - Instruments that image: ``q ≤ 2π/λ`` with λ the ``resolution``, the shortest wavelength that they pass (the lateral period
      limit, where the transfer has fallen to a half).
    - Tips of radius R: ``q ≤ 2π/λ`` with λ the length of the shortest stencil of three points on which no second difference of
      heights is below ``−1/(2R)``: a tip does not follow sharper valleys, and its own shape is seen in place of sharper peaks.

    Parameters
    ----------
    surface : map or line without undefined pixels, heights in m
    tip_radius : of a stylus or probe, m
    resolution : shortest wavelength that the instrument passes, m

    Returns
    -------
    band : `Band`

    Raises
    ------
    InputError
        if no wavevector is left

    References
    ----------
    Sanner, Nöhring, Thimons, Jacobs & Pastewka, Appl. Surf. Sci. Adv. 7 (2022) 100190, Sect. 3,
    doi 10.1016/j.apsadv.2021.100190.

    Examples
    --------
    >>> import numpy as np
    >>> line = LineProfile(np.sin(np.arange(1000.0)), pixel_size=1e-6)
    >>> band = reliable_band(line, resolution=10e-6)
    >>> print(f"{band.wavevector_min:.4g} to {band.wavevector_max:.4g}, {band.upper}")
    1.885e+04 to 6.283e+05, resolution of the instrument
    """
    if isinstance(surface, HeightMap):
        side, pixel = (
            min(surface.size_x, surface.size_y),
            max(surface.pixel_size_x, surface.pixel_size_y),
        )
        longest = max(surface.size_x, surface.size_y)
    else:
        side, pixel, longest = surface.size, surface.pixel_size, surface.size
    low = (
        (2 * np.pi / longest, "one wave on the periodic field")
        if surface.periodic
        else (2 * np.pi * FEWEST_WAVES / side, f"{FEWEST_WAVES:g} waves on the field")
    )
    high = [(2 * np.pi / (PIXELS_PER_WAVE * pixel), f"{PIXELS_PER_WAVE:g} pixels a wave")]
    if resolution is not None:
        high.append((2 * np.pi / resolution, "resolution of the instrument"))
    if tip_radius is not None:
        high.append((_tip_limit(surface, tip_radius), f"tip of radius {tip_radius:.3g} m"))
    top = min(high)
    if top[0] <= low[0]:
        raise InputError(
            f"no reliable wavevector is left: {low[0]:.3g} 1/m ({low[1]}) is not below {top[0]:.3g} 1/m ({top[1]})"
        )
    return Band(float(low[0]), float(top[0]), low[1], top[1])


def _tip_limit(surface: HeightMap | LineProfile, radius: float) -> float:
    """Largest wavevector at which a tip follows the valleys, 1/m."""
    if not 0 < radius < np.inf:
        raise InputError(f"tip_radius is {radius:g} m; expected a finite length > 0 m")
    axes = (
        [(surface.height, surface.pixel_size)]
        if isinstance(surface, LineProfile)
        else [(surface.height, surface.pixel_size_x), (surface.height.T, surface.pixel_size_y)]
    )
    longest = np.inf
    for height, pixel in axes:
        half = 1
        while 2 * half < height.shape[-1]:
            curved = height[..., 2 * half :] - 2 * height[..., half:-half] + height[..., : -2 * half]
            if curved.min() >= -TIP_SHARE / radius * (half * pixel) ** 2:
                break
            half = max(half + 1, int(half * 1.1))
        longest = min(longest, 2 * np.pi / (2 * half * pixel))
    return float(longest)
