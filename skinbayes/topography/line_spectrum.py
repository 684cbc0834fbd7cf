"""From lines to the one-dimensional spectrum, and from that to the isotropic one of the surface."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

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
    is made of straight lines through neighbours, as near as the noise allows. ``independent_modes`` contain the error of each
    bin, through the curve that of the others, and what a curve half as close would change, which is the error of rounding
    off a bend. Where C1D is flat, below a roll-off, lines hardly tell C: the bins up to the last one whose error is larger
    than half of its value are left out. Valid for isotropic surfaces only: lines cannot tell whether one is.

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
    log_q, log_c = np.log(q), np.log(power)
    best: tuple[float, FloatArray, FloatArray] | None = None
    for closeness in _CLOSENESS:
        level = local_power_law(log_q, power, modes, width=closeness).level
        first = _first_possible(log_q, level)
        if first is None:
            continue
        here, wider = (
            _transformed(log_q, log_c, modes, width, first) for width in (closeness, 2 * closeness)
        )
        variance = _variance(log_q, log_c, modes, closeness, first) + np.square(wider - here)
        variance[~np.isfinite(variance)] = np.inf
        worth = float(np.sum(np.log(np.minimum(variance, 1.0))))
        if best is None or worth < best[0]:
            best = worth, here, variance
    # below a bin that is not known nothing is
    known = (
        slice(0)
        if best is None
        else slice(int(np.max(np.flatnonzero(best[2] >= MOST_ERROR**2), initial=-1)) + 1, None)
    )
    if best is None:
        raise InputError(
            "no isotropic surface has lines of this spectrum: it rises with the wavevector in the band. Expected a band without "
            "that, or a map"
        )
    if q[known].size < 4:
        raise InputError(
            f"lines tell C(q) within a factor of {1 + MOST_ERROR:g} in {q[known].size} of {q.size} bins; expected at least 4: "
            "measure longer lines, take fewer bins a decade, or a band beyond the roll-off"
        )
    return MeasuredSpectrum(
        q[known],
        power_spectral_density=np.exp(best[1][known]),
        independent_modes=1 / best[2][known],
        wavevector_min=max(profile.wavevector_min, float(q[known][0]) * (1 - 1e-9) if known.start else 0.0),
        wavevector_max=profile.wavevector_max,
        source=source,
    )


MOST_ERROR = 0.5
"""Relative standard error of C(q) from lines up to which a bin is used."""

_CLOSENESS = tuple(share * NEIGHBOURHOOD for share in (0.25, 0.5, 1.0, 2.0))


def _first_possible(log_q: FloatArray, level: FloatArray) -> int | None:
    """First bin from which on a smooth curve is that of lines of an isotropic surface; None if there is none."""
    for first in range(log_q.size - 3):
        try:
            TabulatedSpectrum.from_profile(np.exp(log_q[first:]), np.exp(level[first:]))
        except InputError:
            continue
        return first
    return None


def _transformed(
    log_q: FloatArray, log_c: FloatArray, modes: FloatArray, width: float, first: int
) -> FloatArray:
    """ln C from ln C1D, see `isotropic_spectrum`; nan below the bin ``first``, and everywhere if there is no such surface."""
    level = local_power_law(log_q, np.exp(log_c), modes, width=width).level
    found = np.full(log_q.size, np.nan)
    with suppress(InputError):
        table = TabulatedSpectrum.from_profile(np.exp(log_q[first:]), np.exp(level[first:]))
        found[first:] = log_c[first:] + np.log(table.node_power) - level[first:]
    return found


def _variance(
    log_q: FloatArray, log_c: FloatArray, modes: FloatArray, width: float, first: int
) -> FloatArray:
    """Variance of each ln C from those of all ln C1D, to first order."""
    step = 1e-3 / np.sqrt(modes)
    here = _transformed(log_q, log_c, modes, width, first)
    total = np.zeros(log_c.size)
    for i in range(log_c.size):
        moved = log_c.copy()
        moved[i] += step[i]
        total += np.square((_transformed(log_q, moved, modes, width, first) - here) / step[i]) / modes[i]
    return total
