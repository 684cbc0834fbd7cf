"""From the spectrum of straight profiles to that of the surface: the inverse Abel transform."""

from __future__ import annotations

import numpy as np
from scipy.special import beta, betainc

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.roughness._rules import gauss_unit

_NODES, _WEIGHTS = gauss_unit(8)
_WIDEST = 0.5  # widest sub-cell in ln q


def isotropic_from_profile(wavevector: FloatArray, profile_power: FloatArray) -> FloatArray:
    """C(q) at the nodes of a one-dimensional spectrum C1D(q), see `TabulatedSpectrum.from_profile`.

    Parameters
    ----------
    wavevector : 1/m, shape ``(K,)``, strictly increasing
    profile_power : C1D, m^3, shape ``(K,)``, > 0

    Returns
    -------
    power : C, m^4, shape ``(K,)``

    Raises
    ------
    InputError
        if C1D rises between the last two nodes, or C would not be positive
    """
    log_q = np.log(wavevector)
    exponent = np.diff(np.log(profile_power)) / np.diff(log_q)
    if exponent[-1] >= 0:
        raise InputError(
            f"profile_power rises from {profile_power[-2]:g} m^3 to {profile_power[-1]:g} m^3 at its end, but must "
            "fall there: it is continued beyond the table by its last power law."
        )
    pieces = np.ceil(np.diff(log_q) / _WIDEST).astype(int)
    power = np.empty_like(wavevector)
    for i, q in enumerate(wavevector):
        power[i] = (
            _table_part(q, i, wavevector, profile_power, exponent, pieces)
            + _tail(q, wavevector, profile_power, exponent)
        ) / np.pi
    wrong = np.flatnonzero(power <= 0)
    if wrong.size:
        raise InputError(
            f"No isotropic surface has this profile_power: its two-dimensional spectrum would be negative at "
            f"{wavevector[wrong[0]]:g} 1/m. Average a noisy spectrum over bands of wavevectors first."
        )
    return power


def _table_part(
    q: float,
    first: int,
    wavevector: FloatArray,
    profile_power: FloatArray,
    exponent: FloatArray,
    pieces: FloatArray,
) -> float:
    """``−∫ C1D′(k)/sqrt(k² − q²) dk`` from node ``first`` (at q) to the last; k = q cosh t cancels the root."""
    total = 0.0
    for j in range(first, exponent.size):
        ends = np.geomspace(wavevector[j], wavevector[j + 1], int(pieces[j]) + 1)
        t = np.arccosh(np.maximum(ends / q, 1.0))
        k = q * np.cosh(t[:-1, None] + np.diff(t)[:, None] * _NODES)
        slope = -exponent[j] * profile_power[j] / k * (k / wavevector[j]) ** exponent[j]
        total += float(np.sum(slope * _WEIGHTS * np.diff(t)[:, None]))
    return total


def _tail(q: float, wavevector: FloatArray, profile_power: FloatArray, exponent: FloatArray) -> float:
    """The same from the last node on, where C1D ∝ k^−b: an incomplete beta function of (q/q_last)²."""
    b, last = -exponent[-1], wavevector[-1]
    half = (b + 1) / 2
    incomplete = betainc(half, 0.5, (q / last) ** 2) * beta(half, 0.5)
    return float(b * profile_power[-1] * (last / q) ** b / q * incomplete / 2)
