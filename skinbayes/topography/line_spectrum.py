"""From lines to the one-dimensional spectrum, and from that to the isotropic one of the surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.special import psi

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.roughness import TabulatedSpectrum
from skinbayes.topography.band import Band, reliable_band
from skinbayes.topography.bins import (
    NEIGHBOURHOOD,
    at_power_law,
    averaged,
    bin_of,
    independent_line_modes,
    local_power_law,
)
from skinbayes.topography.height_map import LineProfile
from skinbayes.topography.measured_spectrum import MeasuredSpectrum
from skinbayes.topography.periodogram import line_periodogram
from skinbayes.topography.windows import Window, spread_of_modes

LINE_BINS_PER_DECADE = 10
"""Of a spectrum of lines, unless one asks for another number: a line has few modes."""


class ProfileSpectrum(NamedTuple):
    """One-dimensional power spectrum of lines, two-sided: ``⟨h²⟩ = 2 ∫_0^∞ C1D dq``.

    Attributes
    ----------
    wavevector : of each bin, 1/m, shape ``(K,)``
    power : C1D, m^3, shape ``(K,)``
    independent_modes : dimensionless, shape ``(K,)``
    wavevector_min, wavevector_max : reliable wavevectors, 1/m
    """

    wavevector: FloatArray
    power: FloatArray
    independent_modes: FloatArray
    wavevector_min: float
    wavevector_max: float


def line_spectrum(
    lines: LineProfile | Sequence[LineProfile],
    *,
    window: Window | None = None,
    bins_per_decade: int = LINE_BINS_PER_DECADE,
    band: Band | None = None,
) -> ProfileSpectrum:
    """One-dimensional power spectrum of one line, or the mean over several of one surface.

    ``C1D(q) = |Σ w h exp(−iqx)|² Δx²/(2π L ⟨w²⟩)``, the mean over the modes of all lines in a bin, corrected as in
    `area_spectrum`.

    Parameters
    ----------
    lines : without trend and undefined pixels, heights in m; several may differ in length and pixel size
    window : ``"hann"``, ``"blackman"`` or ``"none"``; Hann's if omitted, none of periodic lines
    bins_per_decade : of wavevectors, dimensionless
    band : the reliable wavevectors; those of all lines together if omitted

    Returns
    -------
    spectrum : `ProfileSpectrum`

    Raises
    ------
    InputError
        if there is no line, undefined pixels, or no roughness

    References
    ----------
    Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, Eq. 2 and following, doi 10.1088/2051-672X/aa51f8.

    Examples
    --------
    >>> import numpy as np
    >>> height = 1e-9 * np.random.default_rng(1).standard_normal(4096)  # white: C1D = h²Δx/2π
    >>> found = line_spectrum(LineProfile(height, pixel_size=1e-6, periodic=True))
    >>> print(f"{found.power[-2] / (1e-24 / (2 * np.pi)):.2f} ± {found.independent_modes[-2] ** -0.5:.2f}")
    0.95 ± 0.05
    """
    lines = [lines] if isinstance(lines, LineProfile) else list(lines)
    if not lines:
        raise InputError("no lines; expected at least one")
    all_q, all_power, smears, taken = [], [], [], set()
    for line in lines:
        name: Window = ("none" if line.periodic else "hann") if window is None else window
        q, power = line_periodogram(line, name)
        all_q.append(q)
        all_power.append(power)
        taken.add(name)
        smears.append((spread_of_modes(name) * float(q[0]) ** 2, power.size))
    q, power = np.concatenate(all_q), np.concatenate(all_power)
    bins = averaged(bin_of(q, bins_per_decade), power, np.log(q), np.ones(q.size))
    if not bins.power.all():
        raise InputError("all heights are the same, or a straight line: there is no roughness")
    # modes of different lines are independent, those of one are correlated over some steps
    per_line = [independent_line_modes(bins.modes / len(lines), name) * len(lines) for name in taken]
    independent = np.min(per_line, axis=0)
    smear = sum(value * count for value, count in smears) / sum(count for _, count in smears)
    found = at_power_law(bins, independent, smear=smear, dimensions=1)
    bands = [reliable_band(line) for line in lines] if band is None else [band]
    return ProfileSpectrum(
        *found,
        min(one.wavevector_min for one in bands),
        max(one.wavevector_max for one in bands),
    )


def isotropic_spectrum(profile: ProfileSpectrum, source: str = "") -> MeasuredSpectrum:
    """The isotropic spectrum C(q) of the surface whose straight lines have a one-dimensional spectrum.

    ``C(q) = −(1/π) ∫_q^∞ C1D′(k)/sqrt(k² − q²) dk`` (the inverse Abel transform, see `TabulatedSpectrum.from_profile`) of a
    smooth curve through C1D, times the measured over the smooth C1D: the transform of noise itself would be noise. The curve
    is made of straight lines through neighbours within a quarter of a decade, or two or four times that if no surface has
    such lines. Values keep the scatter of the lines; the error of the local exponent is added to it. Valid for isotropic
    surfaces only: the lines cannot tell whether one is.

    Parameters
    ----------
    profile : `ProfileSpectrum`, C1D in m^3
    source : where the lines are from, for people

    Returns
    -------
    spectrum : `MeasuredSpectrum`, C in m^4, of the bins in the reliable band

    Raises
    ------
    InputError
        if fewer than 4 bins are reliable, or no isotropic surface has such lines

    References
    ----------
    Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, Eq. 15 and following, doi 10.1088/2051-672X/aa51f8.

    Examples
    --------
    >>> import numpy as np
    >>> q = np.geomspace(1e4, 1e6, 20)
    >>> lines = ProfileSpectrum(q, 1e-12 * (q / 1e4) ** -3, np.full(20, 1e6), 1e4, 1e6)  # C1D ∝ q^−3: C = (2/π) C1D/q
    >>> print(f"{isotropic_spectrum(lines).power_spectral_density[3] / (2 / np.pi * lines.power[3] / q[3]):.4f}")
    1.0000
    """
    used = (profile.wavevector >= profile.wavevector_min) & (profile.wavevector <= profile.wavevector_max)
    if np.count_nonzero(used) < 4:
        raise InputError(f"{np.count_nonzero(used)} bins of the lines are reliable; expected at least 4")
    q, power, modes = profile.wavevector[used], profile.power[used], profile.independent_modes[used]
    failed: InputError | None = None
    for width in (NEIGHBOURHOOD, 2 * NEIGHBOURHOOD, 4 * NEIGHBOURHOOD):
        curve = local_power_law(np.log(q), power, modes, width=width)
        smooth = np.exp(curve.level)
        try:
            ratio = TabulatedSpectrum.from_profile(q, smooth).node_power / smooth
        except InputError as error:
            failed = error
            continue
        # of a power law ratio ∝ β B((β + 1)/2, 1/2)
        beta = np.maximum(curve.exponent, 0.2)
        change = 1 / beta + 0.5 * (psi((beta + 1) / 2) - psi(beta / 2 + 1))
        return MeasuredSpectrum(
            q,
            power_spectral_density=power * ratio,
            independent_modes=1 / (1 / modes + np.square(change) * curve.variance),
            wavevector_min=profile.wavevector_min,
            wavevector_max=profile.wavevector_max,
            source=source,
        )
    raise InputError(f"the spectrum of the lines is that of no isotropic surface: {failed}")
