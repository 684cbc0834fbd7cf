"""Between the spectrum of straight profiles and that of the surface: the Abel transform and its inverse."""

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
    pieces = np.maximum(np.ceil(np.diff(log_q) / _WIDEST), 1).astype(int)
    ends = [
        np.geomspace(a, b, n + 1)[:-1] for a, b, n in zip(wavevector, wavevector[1:], pieces, strict=False)
    ]
    edges, cell = np.append(np.concatenate(ends), wavevector[-1]), np.repeat(np.arange(pieces.size), pieces)
    power = np.empty_like(wavevector)
    for i, q in enumerate(wavevector):
        above = cell >= i
        # −∫ C1D′(k)/sqrt(k² − q²) dk, with k = q cosh t to cancel the root
        t = np.arccosh(np.maximum(edges[np.append(above, True)] / q, 1.0))
        k = q * np.cosh(t[:-1, None] + np.diff(t)[:, None] * _NODES)
        j = cell[above][:, None]
        slope = -exponent[j] * profile_power[j] / k * (k / wavevector[j]) ** exponent[j]
        inside = float(np.sum(slope * _WEIGHTS * np.diff(t)[:, None]))
        power[i] = (inside + _tail(q, wavevector[-1], profile_power[-1], -exponent[-1])) / np.pi
    wrong = np.flatnonzero(power <= 0)
    if wrong.size:
        raise InputError(
            f"No isotropic surface has this profile_power: its two-dimensional spectrum would be negative at "
            f"{wavevector[wrong[0]]:g} 1/m. Average a noisy spectrum over bands of wavevectors first."
        )
    return power


def _tail(q: float, last: float, last_power: float, b: float) -> float:
    """The same integral from the last node on, where C1D ∝ k^−b: an incomplete beta function of (q/last)²."""
    half = (b + 1) / 2
    incomplete = betainc(half, 0.5, (q / last) ** 2) * beta(half, 0.5)
    return float(b * last_power * (last / q) ** b / q * incomplete / 2)


def profile_from_isotropic(
    nodes: FloatArray, exponent: FloatArray, power: FloatArray, q: FloatArray
) -> FloatArray:
    """C1D(q) of an isotropic spectrum that is a power law between nodes and zero outside of them.

    ``2 ∫_q^∞ k C(k)/sqrt(k² − q²) dk``, with k = q cosh t on pieces of at most half a unit of ln k.

    Parameters
    ----------
    nodes : 1/m, shape ``(K,)``
    exponent : dln C/dln q of each cell, shape ``(K − 1,)``
    power : C at the first node of each cell, m^4, shape ``(K − 1,)``
    q : wavevectors of profiles, 1/m, shape ``(n,)``, > 0

    Returns
    -------
    profile_power : m^3, shape ``(n,)``
    """
    pieces = np.maximum(np.ceil(np.diff(np.log(nodes)) / _WIDEST), 1).astype(int)
    ends = [np.geomspace(a, b, n + 1)[:-1] for a, b, n in zip(nodes, nodes[1:], pieces, strict=False)]
    edges, cell = np.append(np.concatenate(ends), nodes[-1]), np.repeat(np.arange(pieces.size), pieces)
    found = np.empty(q.shape)
    for i, one in enumerate(q):
        t = np.arccosh(np.maximum(edges / one, 1.0))
        k = one * np.cosh(t[:-1, None] + np.diff(t)[:, None] * _NODES)
        values = power[cell][:, None] * (k / nodes[cell][:, None]) ** exponent[cell][:, None]
        found[i] = 2 * np.sum(k * values * _WEIGHTS * np.diff(t)[:, None])
    return found
