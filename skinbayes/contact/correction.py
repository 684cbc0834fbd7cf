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

# Φ is tabulated over ln y from _FIRST to _LAST. Below, A = 1 to 1e-12 and Φ(y) = y; above, A² = 4/(πy) to
# 2/(3y).
_FIRST, _LAST, _CELLS = -3.25, 14.25, 280
_CACHED = 16  # tables of this many values of γ are kept
_STEP = (_LAST - _FIRST) / _CELLS
_KNOTS = _FIRST + _STEP * np.arange(_CELLS + 1)
_Y_FIRST, _Y_LAST = float(np.exp(_FIRST)), float(np.exp(_LAST))
_POINTS, _POINT_WEIGHTS = gauss_unit(3)
_CELL_Y = np.exp(_KNOTS[:-1, None] + _STEP * _POINTS)
_CELL_AREA_SQUARED = np.square(erf(1 / np.sqrt(_CELL_Y)))
_CELL_MEASURE = _STEP * _POINT_WEIGHTS * _CELL_Y
_KNOT_AREA_SQUARED = np.square(erf(np.exp(-_KNOTS / 2)))
_KNOT_Y = np.exp(_KNOTS)


class _Table(NamedTuple):
    """ln Φ at the knots and dln y/dln Φ there, shapes ``(G, knots)`` for G values of γ."""

    log_phi: FloatArray
    slope: FloatArray


def _table(gamma: FloatArray) -> _Table:
    """The table for each γ of shape ``(G,)``; row by row the same numbers as for one γ alone."""
    g = gamma[:, None, None]
    cells = (_CELL_MEASURE / (g + (1 - g) * _CELL_AREA_SQUARED)).sum(axis=-1)
    phi = np.concatenate([np.full((gamma.size, 1), _Y_FIRST), _Y_FIRST + np.cumsum(cells, axis=-1)], axis=-1)
    g = gamma[:, None]
    slope = phi * (g + (1 - g) * _KNOT_AREA_SQUARED) / _KNOT_Y
    return _Table(np.log(phi), slope)


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
    if distinct.size <= _CACHED:
        tables = [_single_table(value) for value in distinct.tolist()]
        table = (
            tables[0]
            if len(tables) == 1
            else _Table(*(np.concatenate(parts) for parts in zip(*tables, strict=True)))
        )
    else:
        table = _table(distinct)
    gamma = distinct[member]
    log_ratio = np.log(ratio)
    if distinct.size == 1:
        cell = np.searchsorted(table.log_phi[0], log_ratio, side="right") - 1
    else:
        cell = np.count_nonzero(table.log_phi[member] <= log_ratio[:, None], axis=-1) - 1
    cell = np.clip(cell, 0, _CELLS - 1)
    # cubic Hermite interpolation of ln y over ln Φ
    left, right = table.log_phi[member, cell], table.log_phi[member, cell + 1]
    width = right - left
    w = (log_ratio - left) / width
    curved = w * (1 - w) * width * ((1 - w) * table.slope[member, cell] - w * table.slope[member, cell + 1])
    log_y = _FIRST + _STEP * (cell + w * w * (3 - 2 * w)) + curved
    share = np.exp(log_y - log_ratio)
    last = np.exp(table.log_phi[member, -1])
    beyond = np.flatnonzero((ratio > last) & np.isfinite(ratio))
    if beyond.size:
        share[beyond] = _solve_beyond(ratio[beyond] - last[beyond], gamma[beyond]) / ratio[beyond]
    share = np.where(ratio <= _Y_FIRST, 1.0, share)
    share = np.where(np.isinf(ratio), gamma, share)
    return np.where(gamma == 1, 1.0, share + 0.0 * gamma + 0.0 * np.where(np.isnan(ratio), np.nan, 0.0))


def _solve_beyond(excess: FloatArray, gamma: FloatArray) -> FloatArray:
    """y with Φ(y) = Φ(Y) + ``excess`` beyond the last knot Y, where A² = 4/(πy) makes Φ elementary.

    ``Φ(y) − Φ(Y) = [γ(y − Y) − b ln((γy + b)/(γY + b))]/γ²`` with b = 4(1 − γ)/π is convex: Newton from a
    lower bound. Each element stops by itself, so that its value does not depend on its neighbours.
    """
    b = 4 * (1 - gamma) / np.pi
    y = np.maximum(_Y_LAST + gamma * excess, np.sqrt(_Y_LAST**2 + 2 * b * excess))
    active = np.arange(y.size)
    for _ in range(40):
        g, b_active, now = gamma[active], b[active], y[active]
        rise = g * (now - _Y_LAST)
        phi = (rise - b_active * np.log1p(rise / (g * _Y_LAST + b_active))) / (g * g)
        step = (excess[active] - phi) * (g + b_active / now)
        y[active] = now + step
        active = active[np.abs(step) > 1e-9 * now]
        if not active.size:
            break
    return y
