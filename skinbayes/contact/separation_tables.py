"""The universal function behind the mean interfacial separation.

Persson's theory gives each wavevector the gap ``∝ w I(wp)`` with ``I(x) = γ E₁(x²)/2 + 3(1 − γ) J(x)``,
``J(x) = ∫_x^∞ erf²(t) e^(−t²) dt/t``. Integrated once more over the stress variance V = w⁻², which leaves integrands
without the singularity of w at the smallest wavevector, this becomes

``Q(x) = 2 ∫_x^∞ (t − x)/t² [γ + 3(1 − γ) erf²(t)] e^(−t²) dt``,  ``√V Q(p/√V) = ∫_0^V I(p/√v) dv/√v``.

Q depends on x and γ only, and linearly on γ. It falls, is convex, behaves as −2γ ln x for small x and as
``(3 − 2γ) e^(−x²)/(2x⁴)`` for large x.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.special import erf

from skinbayes.arrays import FloatArray
from skinbayes.roughness._rules import gauss_unit

_PER_UNIT = 64  # knots per unit of ℓ = −2 ln x
_FIRST, _LAST = -6.5, 46.0
_CELLS = round((_LAST - _FIRST) * _PER_UNIT)
_POINTS, _POINT_WEIGHTS = gauss_unit(16)


class ClosingFunction(NamedTuple):
    """Q of x = p/√V for one γ, or for an array of γ that broadcasts against x.

    Attributes
    ----------
    coefficients : of the cubic of each cell of ℓ = −2 ln x for ``e^(x²) Q``, lowest order first, dimensionless, four
        arrays of shape ``(cells,)``; or a pair of such sets, the parts of Q that go with γ and with 3(1 − γ)
    gamma : γ, dimensionless
    """

    coefficients: FloatArray
    gamma: FloatArray

    def __call__(self, log_ratio: FloatArray, square: FloatArray) -> FloatArray:
        """Q for ``log_ratio`` = ln(V/p²) and ``square`` = p²/V, dimensionless, broadcast shape."""
        return np.asarray(self._scaled(log_ratio, slope=False)[0] * np.exp(-square))

    def with_slope(self, log_ratio: FloatArray, square: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Q and dQ/dln p at constant V, dimensionless, each of broadcast shape."""
        scaled, rise = self._scaled(log_ratio, slope=True)
        decay = np.exp(-square)
        return np.asarray(scaled * decay), np.asarray(-2 * (rise + square * scaled) * decay)

    def _scaled(self, log_ratio: FloatArray, slope: bool) -> tuple[FloatArray, FloatArray]:
        """``e^(x²) Q`` and, if wanted, its derivative by ℓ."""
        # beyond the last knot Q is linear in ℓ to 1e-10; fmin keeps nan out of the index, the last term brings it back
        inside = np.fmin(log_ratio, _LAST)
        place = (np.maximum(inside, _FIRST) - _FIRST) * _PER_UNIT
        cell = np.minimum(place, _CELLS - 1).astype(np.intp)
        place = place - cell
        if self.coefficients.ndim == 2:
            c0, c1, c2, c3 = (part[cell] for part in self.coefficients)
        else:
            first, second = self.coefficients
            c0, c1, c2, c3 = (
                _combine(self.gamma, a[cell], b[cell]) for a, b in zip(first, second, strict=True)
            )
        value = ((c3 * place + c2) * place + c1) * place + c0 + self.gamma * (log_ratio - inside)
        if not slope:
            return value, value
        rise = ((3 * c3 * place + 2 * c2) * place + c1) * _PER_UNIT
        return value, np.where(log_ratio > _LAST, self.gamma, rise)


def closing_function(area_correction: FloatArray) -> ClosingFunction:
    """Q for γ of any shape; the same numbers to the last bit whether γ is one number or a member of an array."""
    gamma = np.where((area_correction > 0) & (area_correction <= 1), area_correction, np.nan)
    first, second = _parts()
    if gamma.size == 1:
        return ClosingFunction(_combine(gamma.reshape(-1)[0], first, second), gamma)
    return ClosingFunction(np.stack([first, second]), gamma)


def _combine(gamma: FloatArray, first: FloatArray, second: FloatArray) -> FloatArray:
    return gamma * first + 3 * (1 - gamma) * second


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
