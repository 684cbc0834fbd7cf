"""Many measured flow curves at once, as tables of even steps of ln shear rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from skinbayes.arrays import ArrayLike, BoolArray, FloatArray, IndexArray
from skinbayes.errors import InputError
from skinbayes.lubrication.rheology import FlowCurve

_CELLS = 512  # of each curve; ln η between the points of a measured curve then differs by less than 1e-5


@dataclass(frozen=True, eq=False, kw_only=True)
class LiquidRows:
    """The liquid of each of N rows, by its measured flow curve.

    Attributes
    ----------
    liquid : which of the L curves belongs to a row, shape ``(N,)``
    lowest, highest : ln of the smallest and largest measured shear rate, in 1/s, of each row, shape ``(N,)``
    least, most : ln of the smallest and largest viscosity, in Pa s, of each row, shape ``(N,)``
    steps_per_unit : cells of the table per unit of ln shear rate, dimensionless, shape ``(N,)``
    falling : the measured shear stress η γ̇ of the liquid falls somewhere, boolean, shape ``(N,)``
    start : first cell of each row, shape ``(N,)``
    cubics : coefficients of ln η by the place in a cell, 0 … 1, lowest first, dimensionless, each of shape ``(cells,)``
    """

    liquid: IndexArray
    lowest: FloatArray
    highest: FloatArray
    least: FloatArray
    most: FloatArray
    steps_per_unit: FloatArray
    falling: BoolArray
    start: IndexArray
    cubics: tuple[FloatArray, FloatArray, FloatArray, FloatArray]

    def log_viscosity(self, log_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln η (η in Pa s) and d ln η/d ln γ̇ at ln γ̇ (γ̇ in 1/s) of shape ``(..., N)``.

        Outside the measured shear rates the viscosity is that at the nearer end, and the slope 0.
        """
        position = (log_rate - self.lowest) * self.steps_per_unit
        held = np.minimum(np.maximum(position, 0.0), float(_CELLS))
        cell = np.where(np.isnan(held), 0.0, held).astype(np.intp)  # the place in it stays nan
        np.minimum(cell, _CELLS - 1, out=cell)
        place = held - cell
        cell += self.start
        level, linear, square, cube = (part.take(cell) for part in self.cubics)
        value = level + place * (linear + place * (square + place * cube))
        slope = (linear + place * (2 * square + place * (3 * cube))) * self.steps_per_unit
        return value, np.where(held == position, slope, 0.0)

    def at(self, rows: IndexArray) -> LiquidRows:
        """The liquids of some rows, by their numbers."""
        by_row = ("liquid", "lowest", "highest", "least", "most", "steps_per_unit", "falling", "start")
        return replace(self, **{name: getattr(self, name).take(rows) for name in by_row})

    def measured(self, shear_rate: ArrayLike) -> BoolArray:
        """Where shear rates (1/s, shape ``(..., N)``) lie within those that were measured."""
        with np.errstate(invalid="ignore", divide="ignore"):
            log_rate = np.log(np.asarray(shear_rate, dtype=np.float64))
        return np.asarray((log_rate >= self.lowest - 1e-12) & (log_rate <= self.highest + 1e-12))


def liquid_rows(flow_curves: Sequence[FlowCurve]) -> LiquidRows:
    """Tabulate the flow curves of rows, each curve once: cubics on 512 cells of ln shear rate (as Fig. 21 of the paper).

    Parameters
    ----------
    flow_curves : the curve of each row, shape ``(N,)``; rows of one liquid share one object

    Returns
    -------
    rows : `LiquidRows`

    Raises
    ------
    InputError
        if there is no row

    Notes
    -----
    Between the points the tabulated viscosity is that of `FlowCurve.viscosity` to 1e-4 of itself.

    References
    ----------
    Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980) 238, doi 10.1137/0717021 (monotone interpolation).

    Examples
    --------
    >>> import numpy as np
    >>> rows = liquid_rows([FlowCurve([1.0, 10.0, 100.0], [2.0, 1.0, 0.5])] * 2)
    >>> print(np.exp(rows.log_viscosity(np.log([3.0, 1000.0]))[0]).round(4))
    [1.4368 0.5   ]
    """
    if not flow_curves:
        raise InputError("A table of flow curves needs the curve of at least one row, but there is none.")
    different = list({id(curve): curve for curve in flow_curves}.values())
    where = {id(curve): place for place, curve in enumerate(different)}
    liquid = np.array([where[id(curve)] for curve in flow_curves], dtype=np.intp)
    ends = np.log([curve.shear_rate_range for curve in different])
    cubics, extremes, falling = [], [], []
    for curve, (low, high) in zip(different, ends.tolist(), strict=True):
        rate = np.linspace(low, high, _CELLS + 1)
        relative, slope = curve.relative(np.exp(np.clip(rate, low + 1e-12, high - 1e-12)))
        value, step = np.log(relative * curve.low_shear_viscosity), slope * (high - low) / _CELLS
        rise = np.diff(value)
        cubics.append(
            [value[:-1], step[:-1], 3 * rise - 2 * step[:-1] - step[1:], step[:-1] + step[1:] - 2 * rise]
        )
        extremes.append([value.min(), value.max()])
        falling.append(bool(slope.min() <= -1))
    flat = np.concatenate([np.array(part) for part in cubics], axis=1)
    least, most = np.array(extremes).T
    return LiquidRows(
        liquid=liquid,
        lowest=ends[liquid, 0],
        highest=ends[liquid, 1],
        least=least[liquid],
        most=most[liquid],
        steps_per_unit=(_CELLS / (ends[:, 1] - ends[:, 0]))[liquid],
        falling=np.array(falling)[liquid],
        start=liquid * _CELLS,
        cubics=(flat[0], flat[1], flat[2], flat[3]),
    )
