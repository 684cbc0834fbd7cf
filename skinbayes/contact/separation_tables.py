"""The universal function behind the mean interfacial separation.

Persson's theory gives each wavevector the gap ``∝ w I(wp)`` with ``I(x) = γ E₁(x²)/2 + 3(1 − γ) J(x)``,
``J(x) = ∫_x^∞ erf²(t) e^(−t²) dt/t``. Integrated once more over V = w⁻², twice the stress variance, which leaves integrands
without the singularity of w at the smallest wavevector, this becomes

``Q(x) = 2 ∫_x^∞ (t − x)/t² [γ + 3(1 − γ) erf²(t)] e^(−t²) dt``,  ``√V Q(p/√V) = ∫_0^V I(p/√v) dv/√v``.

Q depends on x and γ only, and linearly on γ. It falls, is convex, behaves as −2γ ln x for small x and as
``(3 − 2γ) e^(−x²)/(2x⁴)`` for large x.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import erf

from skinbayes.arrays import FloatArray
from skinbayes.roughness._rules import gauss_unit

_PER_UNIT = 64  # knots per unit of ℓ = −2 ln x
_FIRST, _LAST = -6.5, 46.0
_CELLS = round((_LAST - _FIRST) * _PER_UNIT)
_NOTHING_LEFT = 800.0  # of p²/V, where e^(−p²/V) is 0 in floating point
_POINTS, _POINT_WEIGHTS = gauss_unit(16)


class ClosingFunction(NamedTuple):
    """Q of x = p/√V for one γ, or for an array of γ that broadcasts against x.

    Attributes
    ----------
    parts : one or two sets of cubics, each of shape ``(4, cells)``, lowest order first: ``e^(x²) Q`` on the cells of ℓ =
        −2 ln x; if two, its parts that go with γ and with 3(1 − γ)
    gamma : γ, dimensionless
    """

    parts: tuple[FloatArray, ...]
    gamma: FloatArray

    def __call__(self, log_ratio: FloatArray, square: FloatArray) -> FloatArray:
        """Q for ``log_ratio`` = ln(V/p²) and ``square`` = p²/V, dimensionless; both are overwritten."""
        (value,) = self._scaled(log_ratio, slope=False)
        value *= np.exp(np.negative(square, out=square), out=square)
        return value

    def with_slope(self, log_ratio: FloatArray, square: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Q and dQ/dln p at constant V, dimensionless."""
        value, rise = self._scaled(log_ratio, slope=True)
        # where V vanishes, as on a plateau without length, the square is inf and all of this 0
        square = np.minimum(square, _NOTHING_LEFT)
        decay = np.exp(-square)
        return value * decay, -2 * (rise + square * value) * decay

    def of(self, rows: slice) -> ClosingFunction:
        """The function for some of the rows of an array of γ."""
        return self if self.gamma.ndim == 0 else ClosingFunction(self.parts, self.gamma[rows])

    def _scaled(self, log_ratio: FloatArray, slope: bool) -> tuple[FloatArray, ...]:
        """``e^(x²) Q`` and, if wanted, its derivative by ℓ."""
        inside = np.fmin(log_ratio, _LAST)  # fmin keeps nan out of the index
        place = np.fmax(inside, _FIRST)
        place -= _FIRST
        place *= _PER_UNIT
        cell = place.astype(np.intp)
        np.minimum(cell, _CELLS - 1, out=cell)
        place -= cell
        value = self._coefficient(3, cell)
        rise = 3 * value if slope else value
        for order in (2, 1, 0):
            coefficient = self._coefficient(order, cell)
            value *= place
            value += coefficient
            if slope and order:
                rise = rise * place + order * coefficient
        if not log_ratio.max(initial=_FIRST) <= _LAST:
            value += self.gamma * (log_ratio - inside)  # Q is linear in ℓ to 1e-10; nan comes back
        if not slope:
            return (value,)
        return value, np.where(log_ratio > _LAST, self.gamma, rise * _PER_UNIT)

    def _coefficient(self, order: int, cell: NDArray[np.intp]) -> FloatArray:
        found = [part[order].take(cell) for part in self.parts]
        return found[0] if len(found) == 1 else _combine(self.gamma, *found)


def closing_function(area_correction: FloatArray) -> ClosingFunction:
    """Q for γ, a scalar or rows of shape ``(R,)`` that get two new last axes.

    The same numbers to the last bit whether γ is one number or a member of an array.
    """
    gamma = np.where((area_correction > 0) & (area_correction <= 1), area_correction, np.nan)
    if gamma.ndim:
        return ClosingFunction(_parts(), gamma[:, None, None])
    return ClosingFunction((_combine(gamma, *_parts()),), gamma)


def _combine(gamma: FloatArray, first: FloatArray, second: FloatArray) -> FloatArray:
    return np.asarray(gamma * first + 3 * (1 - gamma) * second)


@lru_cache(maxsize=1)
def _parts() -> tuple[FloatArray, FloatArray]:
    """Cubics of the parts of Q that go with γ and with 3(1 − γ), each of shape ``(4, cells)``."""
    # knots of x, ascending; above the last one of the table e^(−x²) is below 1e-16 of its value there
    log_x = np.append(
        np.arange(-_LAST * _PER_UNIT, -_FIRST * _PER_UNIT + 0.5) / (2 * _PER_UNIT), -_FIRST / 2 + 0.03
    )
    x = np.exp(log_x)
    step = np.diff(x)[:, None]
    t = x[:-1, None] + step * _POINTS
    density = np.exp(-np.square(t)) * _POINT_WEIGHTS * step / np.square(t)
    return _cubics(x, t, density), _cubics(x, t, density * np.square(erf(t)))


def _cubics(x: FloatArray, t: FloatArray, density: FloatArray) -> FloatArray:
    """Hermite cubics of ``e^(x²) Q`` over ℓ from the quadrature of its integrand on the cells between knots of x.

    With R(x) = ∫_x^∞ f/t² dt, Q′ = −2R: both are summed from above, all terms positive.
    """
    zeroth = density.sum(axis=-1)
    first = (density * (t - x[:-1, None])).sum(axis=-1)
    tail = np.append(np.cumsum(zeroth[::-1])[::-1], 0.0)
    gap = 2 * np.append(np.cumsum((first + tail[1:] * np.diff(x))[::-1])[::-1], 0.0)
    x, tail, gap = (part[-2::-1] for part in (x, tail, gap))  # ℓ ascending, the auxiliary knot dropped
    growth = np.exp(np.square(x))
    value = growth * gap
    slope = (growth * tail * x - np.square(x) * value) / _PER_UNIT
    rise, left, right = np.diff(value), slope[:-1], slope[1:]
    return np.stack([value[:-1], left, 3 * rise - 2 * left - right, left + right - 2 * rise])
