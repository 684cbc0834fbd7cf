"""Yang–Persson correction of the width of the stress distribution.

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

from skinbayes.arrays import ArrayLike, FloatArray, floats
from skinbayes.roughness._rules import gauss_unit

IndexArray: TypeAlias = NDArray[np.intp]

AREA_CORRECTION = 0.42
"""γ of the Yang–Persson correction, dimensionless: the one place where its usual value is stated."""

_CACHED = 16  # tables of this many values of γ are kept
_MANY = 500  # elements whose cells are looked up in a guide: a search by halves is quicker for few, and slow for many in no order

# Knots in ln y. Below the first, A = 1 to 1e-12 and Φ(y) = y. In the middle Φ is integrated cell by cell.
# Beyond, where A² = 4/(πy) to 2/(3y), Φ is elementary and the knots may thin out. Past the last one V_eff =
# γV to 1e-20.
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
    """Cubic Hermite interpolation of ln y over ln Φ for G values of γ.

    Attributes
    ----------
    log_phi : ln Φ at the knots, shape ``(G, knots)``
    cells : where the cell from each knot begins, its width, and the coefficients of its cubic, shape ``(6, G, knots)``; the last
        knot has the cell before it
    """

    log_phi: FloatArray
    cells: FloatArray


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
    log_phi, slope = np.log(phi), phi * (g + (1 - g) * _KNOT_AREA_SQUARED) / _KNOT_Y
    width, rise = np.diff(log_phi), np.diff(_KNOTS)
    left, right = width * slope[:, :-1], width * slope[:, 1:]
    knots = np.broadcast_to(_KNOTS[:-1], width.shape)
    cubic = knots, left, 3 * rise - 2 * left - right, left + right - 2 * rise
    cells = np.stack([log_phi[:, :-1], width, *cubic])
    return _Table(log_phi, np.concatenate([cells, cells[..., -1:]], axis=-1))


class _Guide(NamedTuple):
    """Where to look for the cell of ln Φ: equal steps with at most one knot each, and the cell that each begins in.

    Attributes
    ----------
    start, per_unit : left end of the first step; steps per unit of ln Φ
    cell : of each step
    upper : knot at the right end of each cell; infinite for the last
    """

    start: float
    per_unit: float
    cell: IndexArray
    upper: FloatArray

    @classmethod
    def of(cls, log_phi: FloatArray) -> _Guide:
        """The guide of increasing knots."""
        step = float(np.diff(log_phi).min()) / 2
        # half a step early, so that no rounding puts a value beyond the knot that it is held against
        edges = log_phi[0] + step * (np.arange(int((log_phi[-1] - log_phi[0]) / step) + 2) - 0.5)
        upper = np.append(log_phi[1:], np.inf)
        return cls(float(log_phi[0]), 1.0 / step, log_phi[1:].searchsorted(edges, side="right"), upper)

    def find(self, values: FloatArray) -> IndexArray:
        """Number of knots but the first that are not above each value; any number for NaN."""
        step = ((values - self.start) * self.per_unit).astype(np.intp)
        cell = self.cell.take(step, mode="clip")
        return np.asarray(cell + (self.upper.take(cell) <= values))


@lru_cache(maxsize=_CACHED)
def _single_table(gamma: float) -> tuple[FloatArray, FloatArray, _Guide]:
    log_phi, cells = _table(np.array([gamma]))
    return log_phi[0], np.ascontiguousarray(cells[:, 0]), _Guide.of(log_phi[0])


def corrected_twice_stress_variance(
    nominal_pressure: ArrayLike,
    twice_stress_variance: ArrayLike,
    *,
    area_correction: ArrayLike = AREA_CORRECTION,
) -> FloatArray:
    """Twice the stress variance, V_eff, with the Yang–Persson correction, to be used in place of V in Eq. 2 of the paper.

    Solves ``V/p0² = ∫_0^(V_eff/p0²) dy/[γ + (1 − γ) erf²(1/√y)]``. V_eff = V while contact is complete, V_eff
    → γV when it is small.

    Parameters
    ----------
    nominal_pressure : p0, Pa, ≥ 0, any shape
    twice_stress_variance : V of `twice_stress_variance`, Pa², ≥ 0, broadcasts
    area_correction : γ, dimensionless, 0 < γ ≤ 1, broadcasts; 1 gives V itself

    Returns
    -------
    corrected_twice_stress_variance : Pa², broadcast shape; nan where an argument is impossible

    Notes
    -----
    Relative error below 3e-7 for γ ≥ 1e-5 and any V/p0² (1e-5 for γ = 1e-9). A single γ is tabulated once and
    then costs half a microsecond an element; an array of γ is tabulated at every call, with the same result
    to the last bit.

    References
    ----------
    Yang & Persson, J. Phys.: Condens. Matter 20 (2008) 215214, doi 10.1088/0953-8984/20/21/215214.

    Examples
    --------
    >>> print(f"{corrected_twice_stress_variance(6830.0, 3.36644e14):.5e}")
    1.41392e+14
    """
    with np.errstate(all="ignore"):
        return corrected(*floats(nominal_pressure, twice_stress_variance, area_correction))


def corrected(pressure: FloatArray, width: FloatArray, gamma: FloatArray) -> FloatArray:
    """`corrected_twice_stress_variance` of arrays; silences no warnings."""
    ratio = width / np.square(np.where(pressure >= 0.0, pressure, np.nan))
    unclear = np.isnan(ratio)
    if np.count_nonzero(unclear):
        # squares that under- or overflow: contact is complete without roughness, and vanishes under an infinite one
        known = unclear & (pressure >= 0) & (pressure < np.inf) & (width >= 0)
        ratio = np.where(known, np.where(width > 0, np.inf, 0.0), ratio)
    if gamma.size == 1:
        fraction = _fraction_of_one(ratio, gamma.item())
        return np.asarray(width * fraction.reshape((1,) * (gamma.ndim - ratio.ndim) + ratio.shape))[()]
    ratio, gamma = np.broadcast_arrays(ratio, gamma)
    distinct, member = np.unique(gamma.reshape(-1), return_inverse=True)
    fraction = _fraction_of_many(ratio.reshape(-1), distinct, member.reshape(-1))
    return np.asarray(width * fraction.reshape(ratio.shape))[()]


def _fraction_of_one(ratio: FloatArray, gamma: float) -> FloatArray:
    """V_eff/V for ``ratio`` = V/p0² of any shape and one γ."""
    if not 0 < gamma <= 1:
        return np.full(ratio.shape, np.nan)
    if gamma == 1:
        return np.where(np.isnan(ratio), np.nan, 1.0)
    log_phi, cells, guide = _single_table(gamma)
    # in full contact V_eff = V, under a vanishing load V_eff = γV: both are the ends of the table
    log_ratio = np.minimum(np.maximum(np.log(ratio), log_phi[0]), log_phi[-1])
    many = log_ratio.size > _MANY
    cell = guide.find(log_ratio) if many else log_phi[1:].searchsorted(log_ratio, side="right")
    return _interpolate(log_ratio, cells.take(cell, axis=1))


def _fraction_of_many(ratio: FloatArray, distinct: FloatArray, member: IndexArray) -> FloatArray:
    """The same, bit for bit, of shape ``(M,)`` where element i has the γ ``distinct[member[i]]``."""
    log_phi, cells = _table(distinct)
    log_ratio = np.minimum(np.maximum(np.log(ratio), log_phi[member, 0]), log_phi[member, -1])
    cell = np.count_nonzero(log_phi[member, 1:] <= log_ratio[:, None], axis=-1)
    fraction = _interpolate(log_ratio, cells[:, member, cell])
    gamma = distinct[member]
    fraction = np.where(gamma == 1, np.where(np.isnan(ratio), np.nan, 1.0), fraction)
    return np.where((gamma > 0) & (gamma <= 1), fraction, np.nan)


def _interpolate(log_ratio: FloatArray, cell: FloatArray) -> FloatArray:
    """V_eff/V by cubic interpolation of ln y over ln Φ; ``cell`` is that of `_Table` for each element."""
    start, width, c0, c1, c2, c3 = cell
    w = (log_ratio - start) / width
    return np.asarray(np.exp(c0 + w * (c1 + w * (c2 + w * c3)) - log_ratio))
