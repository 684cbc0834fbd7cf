"""Capillary bridges of a flat batch of skins against the film, each skin solved at a few Kelvin lengths at once.

At a given Kelvin length d the pressure is the root of ``p = p0 + (γ_w Σcos θ/d) F(d; p)`` that is continuous from p0 as d falls
from infinity. Along the curve everything is smooth in ``z = ln(1 + d0/d)``, which is 0 where the gap is flooded, so that
Chebyshev polynomials in z carry the curve, and a film is found on it by Newton steps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray, IndexArray
from skinbayes.emulation.chebyshev import clenshaw, coefficients, lobatto, series
from skinbayes.wetting._family import GapFamily, gap_family
from skinbayes.wetting._gaps import GapSource
from skinbayes.wetting._roots import smallest_root

TERMS = {"gaussian": 32, "sharp": 96}  # Kelvin lengths of a curve; sharp gaps make it bumpy
_BLOCK = 8192  # of a block that is solved at a time
_REACH, _MARGIN = 0.75, 0.97
REFERENCE = 3.0  # d0 in units of the mean separation at p0
_MODERATE = 4  # longest of the spans below for curves whose ends are given
_SPANS = ((0.55, 7), (0.8, 8), (1.4, 12), (2.2, 20), (4.0, 35), (8.0, 75))
"""Span of ln p and how many pressures interpolate it to 1e-4 or better."""


class Curve(NamedTuple):
    """Solved bridges of B skins.

    Attributes
    ----------
    reference : d0, m, shape ``(B,)``
    end : largest z, dimensionless, shape ``(B,)``
    nodes : ln film (m) at the nodes of z, shape ``(B, M)``
    parts : Chebyshev coefficients in z of ln film (m), ln p (Pa), ln F and ln ū (m), shape ``(B, M, 4)``, or of the first two
    """

    reference: FloatArray
    end: FloatArray
    nodes: FloatArray
    parts: FloatArray

    def select(self, rows: BoolArray) -> Curve:
        """The curves of some skins."""
        return Curve(self.reference[rows], self.end[rows], self.nodes[rows], self.parts[rows])

    def flooded(self) -> FloatArray:
        """The film at which the gap is full, m, shape ``(B,)``."""
        return self.reference / REFERENCE

    def along(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln film (m) and ln p (Pa) at z of shape ``(B, F)``, each of that shape."""
        values = series(self.parts[..., :2], 2 * z / self.end[:, None] - 1)
        return values[..., 0], values[..., 1]

    def at(self, film: FloatArray) -> tuple[FloatArray, list[FloatArray]]:
        """z, and ``ln p, ln F, ln ū`` as far as they are known, at films (m) of shape ``(B, F)``, each of that shape."""
        z = self.place(film)
        values = series(self.parts[..., 1:], 2 * z / self.end[:, None] - 1)
        return z, list(np.moveaxis(values, -1, 0))

    def place(self, film: FloatArray) -> FloatArray:
        """z at films (m) of shape ``(B, F)``, of that shape; nan for films beyond the end of a curve."""
        target = np.log(film)
        count = self.nodes.shape[1]
        # the film falls as z grows, apart from folds at nanometres, where the first crossing is taken; start on the chord
        cell = np.clip((self.nodes[:, None, :] <= target[..., None]).argmax(axis=-1), 1, count - 1)
        places = 2 * lobatto(count) - 1
        low, high = places[cell - 1], places[cell]
        upper, lower = (np.take_along_axis(self.nodes, c, axis=1) for c in (cell - 1, cell))
        target = np.where(target > self.nodes.min(axis=1, keepdims=True) - 1e-9, target, np.nan)
        t = low + (high - low) * np.clip((upper - target) / (upper - lower), 0.0, 1.0)
        active = np.ones(target.shape, dtype=bool)
        for _ in range(40):
            value, rise = clenshaw(self.parts[..., 0], t)
            value -= target
            low, high = np.where(value > 0, t, low), np.where(value <= 0, t, high)
            step = value / rise
            # a step that short is right even where rounding puts it just outside the bracket
            last = np.abs(step) <= 1e-7
            newton = last | ((t - step > low) & (t - step < high))
            t = np.where(active, np.where(newton, t - step, (low + high) / 2), t)
            active = active & ~last
            if not active.any():
                break
        return np.where(np.isnan(target), np.nan, (t + 1) / 2 * self.end[:, None])


def solve_curve(
    source: GapSource,
    pressure: FloatArray,
    wetting_tension: FloatArray,
    separation: FloatArray,
    thinnest: FloatArray,
    last: FloatArray | None = None,
    whole: bool = False,
) -> Curve:
    """Curves from the flooded gap down to the film ``thinnest`` (m), all of shape ``(B,)``; separation is ū(p0), m.

    Where the capillary pressure grows so fast that there is no such film, the curve ends at a thicker one. If ``last`` is given
    curves end at these z instead, and are nan where the capillary pressure is many times the load. Of ``whole`` curves
    those are nan that do not come to the thinnest film.
    """
    thinnest = thinnest.copy()
    count, gaps = pressure.size, TERMS[source.closure]
    curve = Curve(
        REFERENCE * separation,
        np.zeros(count),
        np.full((count, gaps), np.nan),
        np.full((count, gaps, 4), np.nan),
    )
    # how far up the pressures go, in units of wetting tension/ū(p0), and how small the gaps are
    reach, margin = np.full(count, _REACH), np.full(count, _MARGIN)
    todo = np.flatnonzero(np.isfinite(pressure * wetting_tension * separation * thinnest) & (separation > 0))
    for _ in range(100):
        span = np.log1p(reach[todo] * wetting_tension[todo] / separation[todo] / pressure[todo]) + 1e-3
        need = np.searchsorted([s for s, _ in _SPANS], span)
        if last is not None:
            moderate = need <= _MODERATE
            todo, span, need = todo[moderate], span[moderate], need[moderate]
        again = [np.empty(0, dtype=np.intp)]
        for group in np.unique(need):
            if group == len(_SPANS):  # pressures out of reach: do with a curve that ends earlier
                rows = todo[need == group]
                if whole:
                    continue
                thinnest[rows] *= 4
                reach[rows], margin[rows] = _REACH, _MARGIN
                again.append(rows[thinnest[rows] < separation[rows]])
                continue
            rows = todo[need == group]
            start, length = np.log(pressure[rows]), span[need == group]
            family = gap_family(start, length, source.select(rows), _SPANS[group][1])
            if last is None:
                end = np.log1p(curve.reference[rows] / (margin[rows] * family.gap_of_film(thinnest[rows])))
            else:
                end = last[rows]
            short = _solve_rows(curve, family, rows, pressure, wetting_tension, end)
            thick = ~short & (curve.nodes[rows, -1] > np.log(thinnest[rows])) & (last is None)
            reach[rows[short]] *= 2.5
            margin[rows[thick]] *= 0.7
            again.append(rows[short | thick])
        todo = np.concatenate(again)
        if not todo.size:
            break
    return curve


def _solve_rows(
    curve: Curve,
    family: GapFamily,
    rows: IndexArray,
    pressure: FloatArray,
    wetting_tension: FloatArray,
    end: FloatArray,
) -> BoolArray:
    """Fill in the curves of some rows; tells which had too short a range of pressures."""
    count = curve.nodes.shape[1]
    z = end[:, None] * lobatto(count)
    z[:, 0] = 1e-12
    gap = curve.reference[rows][:, None] / np.expm1(z)
    values, solved = np.empty((*gap.shape, 4)), np.empty(gap.shape, dtype=bool)
    # narrow gaps that are wet at all these Kelvin lengths need not be told apart
    needed = family.components_above(gap[:, -1])
    for keep in np.unique(needed).tolist():
        of_one_size = np.flatnonzero(needed == keep)
        step = max(1, _BLOCK // (count * (keep + 1)))
        for first in range(0, of_one_size.size, step):
            block = of_one_size[first : first + step]
            part, here = family.block(block).lumped(keep), rows[block]
            x, solved[block] = smallest_root(part, pressure[here], wetting_tension[here], gap[block])
            filled = part.fill(x, gap[block])
            logs = np.log([filled.film, filled.area, part.mean_separation(x)])
            values[block] = np.stack([logs[0], x, logs[1], logs[2]], axis=-1)
    short = np.asarray(~solved.all(axis=1))
    curve.end[rows], curve.nodes[rows], curve.parts[rows] = end, values[..., 0], coefficients(values)
    curve.parts[rows[short]] = np.nan
    return short
