"""One spectrum of several maps: places and magnifications together, with what they disagree by."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.special import polygamma, psi

from skinbayes.arrays import BoolArray, FloatArray, IndexArray
from skinbayes.errors import InputError
from skinbayes.topography.bins import bin_of, local_power_law
from skinbayes.topography.measured_spectrum import MeasuredSpectrum

MERGED_BINS_PER_DECADE = 16


class MergedSpectrum(NamedTuple):
    """Spectra of several maps as one.

    Attributes
    ----------
    spectrum : `MeasuredSpectrum`; ``independent_modes`` are fewer than those of the maps where these disagree
    scatter : standard deviation of ln C between maps beyond what their modes explain, dimensionless; nan if no wavevector is
        covered by two maps
    maps : number of those that cover each bin, dimensionless, shape ``(K,)``
    level : mean of ln C of each map over that of the merged spectrum, dimensionless, shape ``(number of maps,)``
    """

    spectrum: MeasuredSpectrum
    scatter: float
    maps: FloatArray
    level: FloatArray


def merge_spectra(
    spectra: Sequence[MeasuredSpectrum], *, bins_per_decade: int = MERGED_BINS_PER_DECADE
) -> MergedSpectrum:
    """Merge the reliable bands of several spectra; their disagreement is kept as an uncertainty.

    In each bin the mean of C with weights ``1/(τ² + 1/n)``, n the independent modes of a map and τ the scatter between maps; its
    ``independent_modes`` are the sum of these weights. τ² is the excess of the weighted squares of ln C about their mean
    over what the modes explain, all bins together. The scatter applies also where one map alone covers a bin. It moves
    neighbouring bins of a map together, which independent bins do not show; and that of few maps is itself hardly known.

    Parameters
    ----------
    spectra : of the maps of one kind of surface
    bins_per_decade : of the merged spectrum, dimensionless

    Returns
    -------
    merged : `MergedSpectrum`, C in m^4

    Raises
    ------
    InputError
        if there is no spectrum, or one has no reliable bin

    References
    ----------
    DerSimonian & Laird, Control. Clin. Trials 7 (1986) 177, Eq. 8 (their estimate of τ² of each bin, pooled),
    doi 10.1016/0197-2456(86)90046-2.

    Examples
    --------
    >>> import numpy as np
    >>> q = np.geomspace(1e4, 1e6, 33)
    >>> one, other = (MeasuredSpectrum(q, power_spectral_density=c * 1e-10 * q**-2.0, independent_modes=np.full(33, 400.0),
    ...     wavevector_min=1e4, wavevector_max=1e6) for c in (0.8, 1.2))
    >>> both = merge_spectra([one, other])
    >>> print(f"{both.spectrum.power_spectral_density[5] / (1e-10 * both.spectrum.wavevector[5] ** -2):.2f} ± {both.scatter:.2f}")
    1.00 ± 0.28
    """
    if not spectra:
        raise InputError("no spectra; expected at least one")
    found = [_shares(spectrum, bins_per_decade) for spectrum in spectra]
    first = min(int(one.number[0]) for one in found)
    size = max(int(one.number[-1]) for one in found) - first + 1
    modes, log_q, log_c = (np.zeros((len(found), size)) for _ in range(3))
    exponent = np.zeros((len(found), size))
    for row, one in enumerate(found):
        place = one.number - first
        modes[row, place], log_q[row, place] = one.modes, one.log_q
        log_c[row, place], exponent[row, place] = one.log_c, one.exponent
    covered = modes > 0
    full = covered.any(axis=0)
    covered = covered[:, full]
    modes, log_q, log_c, exponent = (a[:, full] for a in (modes, log_q, log_c, exponent))
    centre = np.sum(modes * log_q, axis=0) / modes.sum(axis=0)
    log_c = np.where(covered, log_c + exponent * (log_q - centre), 0.0)
    scatter = _scatter(log_c, np.where(covered, modes, 1.0), covered)
    variance = 0.0 if np.isnan(scatter) else scatter**2
    weights = np.where(covered, 1 / (variance + 1 / np.where(covered, modes, 1.0)), 0.0)
    together = weights.sum(axis=0)
    power = np.sum(weights * np.where(covered, np.exp(log_c), 0.0), axis=0) / together
    apart = np.where(covered, log_c - np.log(power), 0.0)
    level = np.sum(weights * apart, axis=1) / np.maximum(weights.sum(axis=1), 1e-300)
    merged = MeasuredSpectrum(
        np.exp(centre),
        power_spectral_density=power,
        independent_modes=together,
        wavevector_min=min(one.wavevector_min for one in spectra),
        wavevector_max=max(one.wavevector_max for one in spectra),
        source=" + ".join(one.source for one in spectra if one.source),
    )
    return MergedSpectrum(merged, scatter, covered.sum(axis=0).astype(float), level)


class _Share(NamedTuple):
    """A spectrum on the grid of the merged one."""

    number: IndexArray
    modes: FloatArray
    log_q: FloatArray
    log_c: FloatArray
    exponent: FloatArray


def _shares(spectrum: MeasuredSpectrum, per_decade: int) -> _Share:
    used = spectrum.reliable
    if not used.any():
        name = f"{spectrum.source}: " if spectrum.source else ""
        raise InputError(
            f"{name}no bin lies in the reliable band, {spectrum.wavevector_min:.3g} to {spectrum.wavevector_max:.3g} 1/m"
        )
    q, power, modes = (
        values[used]
        for values in (spectrum.wavevector, spectrum.power_spectral_density, spectrum.independent_modes)
    )
    exponent = local_power_law(np.log(q), power, modes).exponent
    index = bin_of(q, per_decade)
    kept, place = np.unique(index, return_inverse=True)
    total = np.bincount(place, modes).astype(np.float64)

    def mean(values: FloatArray) -> FloatArray:
        return np.bincount(place, modes * values) / total

    log_q = mean(np.log(q))
    # bins of the map within one of the merged spectrum go to its centre before they are averaged
    power = power * np.exp(exponent * (np.log(q) - log_q[place]))
    return _Share(kept, total, log_q, np.log(mean(power)), mean(exponent))


def _scatter(log_c: FloatArray, modes: FloatArray, covered: BoolArray) -> float:
    """Standard deviation between maps; nan where no bin is covered twice."""
    twice = covered.sum(axis=0) > 1
    if not twice.any():
        return float("nan")
    # the mean of n exponential variables: ψ(n) − ln n below the logarithm of its mean, variance ψ′(n)
    value = log_c - (psi(modes) - np.log(modes))
    weight = np.where(covered, 1 / polygamma(1, modes), 0.0)[:, twice]
    total = weight.sum(axis=0)
    centre = np.sum(weight * value[:, twice], axis=0) / total
    squares = float(np.sum(weight * np.square(value[:, twice] - centre)))
    freedom = float(np.sum(covered[:, twice].sum(axis=0) - 1))
    scale = float(np.sum(total - np.sum(np.square(weight), axis=0) / total))
    return float(np.sqrt(max(0.0, (squares - freedom) / scale)))
