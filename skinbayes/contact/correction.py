"""Yang–Persson correction of the stress variance.

Persson's diffusion equation spreads the stress as if contact were complete. The correction lets every step of
wavevector act with a weight between γ and 1 that depends on the contact area reached:
``dV_eff = [γ + (1 − γ)A²] dV``, A = erf(p0/√V_eff). The variables separate, so V_eff/p0² is a function of
V/p0² and γ alone: ``V/p0² = Φ(V_eff/p0²)``, ``Φ(y) = ∫_0^y dy′/[γ + (1 − γ) erf²(1/√y′)]``.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.special import erf

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.roughness._rules import gauss_unit

IndexArray: TypeAlias = NDArray[np.intp]

AREA_CORRECTION = 0.42
"""γ of the Yang–Persson correction, dimensionless: the one place where its usual value is stated."""

_CACHED = 16  # tables of this many values of γ are kept

# Knots in ln y. Below the first, A = 1 to 1e-12 and Φ(y) = y. In the middle Φ is integrated cell by cell. Beyond, where
# A² = 4/(πy) to 2/(3y), Φ is elementary and the knots may thin out. Past the last one V_eff = γV to 1e-20.
_STEP, _CELLS = 0.125, 140
_MIDDLE = -3.25 + _STEP * np.arange(_CELLS + 1)
_KNOTS = np.concatenate([_MIDDLE, _MIDDLE[-1] + _STEP * np.cumsum(1.06 ** np.arange(1, 53))])
_KNOT_Y = np.exp(_KNOTS)
_KNOT_AREA_SQUARED = np.square(erf(np.exp(-_KNOTS / 2)))
_POINTS, _POINT_WEIGHTS = gauss_unit(3)
_CELL_Y = np.exp(_MIDDLE[:-1] + _STEP * _POINTS[:, None])
_CELL_AREA_SQUARED = np.square(erf(1 / np.sqrt(_CELL_Y)))
_CELL_MEASURE = _STEP * _POINT_WEIGHTS[:, None] * _CELL_Y


class _Table(NamedTuple):
    """ln Φ at the knots and dln y/dln Φ there, shapes ``(G, knots)`` for G values of γ."""

    log_phi: FloatArray
    slope: FloatArray


def _table(gamma: FloatArray) -> _Table:
    """The table for each γ of shape ``(G,)``; row by row the same numbers as for one γ alone."""
    g = gamma[:, None]
    phi = np.empty((gamma.size, _KNOTS.size))
    cells = sum(m / (g + (1 - g) * a) for m, a in zip(_CELL_MEASURE, _CELL_AREA_SQUARED, strict=True))
    phi[:, 0] = _KNOT_Y[0]
    phi[:, 1 : _CELLS + 1] = _KNOT_Y[0] + np.cumsum(cells, axis=-1)
    # ∫ dy/(γ + b/y) = [γ(y − Y) − b ln((γy + b)/(γY + b))]/γ² with b = 4(1 − γ)/π
    b, start = 4 / np.pi * (1 - g), _KNOT_Y[_CELLS]
    rise = g * (_KNOT_Y[_CELLS + 1 :] - start)
    phi[:, _CELLS + 1 :] = phi[:, [_CELLS]] + (rise - b * np.log1p(rise / (g * start + b))) / np.square(g)
    return _Table(np.log(phi), phi * (g + (1 - g) * _KNOT_AREA_SQUARED) / _KNOT_Y)


@lru_cache(maxsize=_CACHED)
def _single_table(gamma: float) -> _Table:
    return _table(np.array([gamma]))


def corrected_stress_variance(
    nominal_pressure: ArrayLike, variance: ArrayLike, area_correction: ArrayLike = AREA_CORRECTION
) -> FloatArray:
    """Stress variance V_eff with the Yang–Persson correction, to be used in place of V in Eq. 2 of the paper.

    Solves ``V/p0² = ∫_0^(V_eff/p0²) dy/[γ + (1 − γ) erf²(1/√y)]``. V_eff = V while contact is complete, V_eff
    → γV when it is small.

    Parameters
    ----------
    nominal_pressure : p0, Pa, ≥ 0, any shape
    variance : V of `stress_variance`, Pa², ≥ 0, broadcasts
    area_correction : γ, dimensionless, 0 < γ ≤ 1, broadcasts; 1 gives V itself

    Returns
    -------
    corrected_variance : Pa², broadcast shape; nan where an argument is impossible

    Notes
    -----
    Relative error below 1e-7 for γ ≥ 0.01, for any V/p0². A scalar γ is tabulated once; an array of γ is
    tabulated for each member, with the same result to the last bit.

    References
    ----------
    Yang & Persson, J. Phys.: Condens. Matter 20 (2008) 215214, doi 10.1088/0953-8984/20/21/215214.

    Examples
    --------
    >>> print(f"{corrected_stress_variance(6830.0, 3.36644e14):.5e}")
    1.41392e+14
    """
    pressure, width, gamma = (
        np.asarray(x, dtype=np.float64) for x in (nominal_pressure, variance, area_correction)
    )
    with np.errstate(all="ignore"):
        pressure = np.where(pressure >= 0, pressure, np.nan)
        width = np.where(width >= 0, width, np.nan)
        gamma = np.where((gamma > 0) & (gamma <= 1), gamma, np.nan)
        ratio = width / np.square(pressure)
        shape = np.broadcast_shapes(ratio.shape, gamma.shape)
        if gamma.size == 1:
            distinct, member = gamma.reshape(-1), np.zeros(shape, dtype=np.intp).reshape(-1)
        else:
            distinct, which = np.unique(gamma, return_inverse=True)
            member = np.broadcast_to(which.reshape(gamma.shape), shape).reshape(-1)
        share = _share(np.broadcast_to(ratio, shape).reshape(-1), distinct, member)
        return np.asarray(width * share.reshape(shape))[()]


def _share(ratio: FloatArray, distinct: FloatArray, member: IndexArray) -> FloatArray:
    """V_eff/V for ``ratio`` = V/p0², shape ``(M,)``, where element i has the γ ``distinct[member[i]]``."""
    log_ratio = np.log(ratio)
    if distinct.size == 1:
        log_phi, slope = (part[0] for part in _single_table(float(distinct[0])))
        cell = _inner(np.searchsorted(log_phi, log_ratio, side="right") - 1)
        left, right, left_slope, right_slope = log_phi[cell], log_phi[cell + 1], slope[cell], slope[cell + 1]
    else:
        log_phi, slope = _table(distinct)
        cell = _inner(np.count_nonzero(log_phi[member] <= log_ratio[:, None], axis=-1) - 1)
        left, right = log_phi[member, cell], log_phi[member, cell + 1]
        left_slope, right_slope = slope[member, cell], slope[member, cell + 1]
    # cubic Hermite interpolation of ln y over ln Φ
    width = right - left
    w = (log_ratio - left) / width
    curved = w * (1 - w) * width * ((1 - w) * left_slope - w * right_slope)
    knot = _KNOTS[cell]
    log_y = knot + (_KNOTS[cell + 1] - knot) * (w * w * (3 - 2 * w)) + curved
    gamma = distinct[member]
    share = np.where(ratio <= _KNOT_Y[0], 1.0, np.exp(log_y - log_ratio))
    share = np.where(ratio >= _KNOT_Y[-1] / gamma, gamma, share)
    return np.where(gamma == 1, 1.0, share + 0.0 * gamma)


def _inner(cell: IndexArray) -> IndexArray:
    return np.clip(cell, 0, _KNOTS.size - 2)
