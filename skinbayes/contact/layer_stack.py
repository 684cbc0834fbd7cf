"""How a stack of layers answers a contact as a whole, in functions that vanish at the edge of the contact.

A smooth pressure that vanishes at the edge, |r| = a, is a sum of functions whose transforms are Bessel functions of the orders
ν_n = 2n + ν, ν = 3/2 under a ball and 1 under a cylinder. In them the slope −r/R of the surface has one component only, and the
equation of the contact is ``Σ_n ∫₀^∞ S(x/a) J_νm(x) J_νn(x) dx/x g_n = δ_m0``, S(q) = E0*/E_eff(q). Where S = 1 the integral is
1/(2ν_n), and the first function is Hertz's pressure.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq
from scipy.special import gamma, jv, yv

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.hertz import sphere_contact
from skinbayes.contact.layers import layered_modulus
from skinbayes.contact.line_contact import line_contact
from skinbayes.contact.solid import reduced_modulus
from skinbayes.errors import InputError

SPHERE, CYLINDER = 1.5, 1.0
"""Order of the first function under a ball and under a cylinder."""

_FUNCTIONS = 64  # for layers that bend over a thousandth of the contact, or more
_SMALLEST, _LARGEST = 2.0**-24, 2.0**34  # x = qa between which S is looked at
_WAVES = (
    300.0  # x up to which products of Bessel functions are taken with their waves, fading to twice as much
)


class LayerStack:
    """Layers, checked, and what a contact of a given size makes of them."""

    def __init__(
        self,
        moduli: Sequence[float],
        poisson_ratios: Sequence[float],
        thicknesses: Sequence[float],
        name: str,
        radius: float,
    ) -> None:
        if not len(moduli) == len(poisson_ratios) == len(thicknesses) + 1:
            raise InputError(
                f"There are {len(moduli)} moduli, {len(poisson_ratios)} poisson_ratios and {len(thicknesses)} thicknesses, but "
                "there must be as many ratios as moduli, and one thickness less: the half-space has none."
            )
        for kind, values, unit in (
            ("moduli", moduli, "Pa"), ("thicknesses", thicknesses, "m"), (name, [radius], "m")
        ):  # fmt: skip
            if not all(0 < value < np.inf for value in values):
                raise InputError(f"{kind} are {list(values)} {unit}, but must be finite numbers > 0 {unit}.")
        if not all(-1 < value <= 0.5 for value in poisson_ratios):
            raise InputError(
                f"poisson_ratios are {list(poisson_ratios)}, but must be larger than -1 and at most 0.5."
            )
        self._layers = {"moduli": moduli, "poisson_ratios": poisson_ratios, "thicknesses": thicknesses}
        self.surface = float(reduced_modulus(moduli[0], poisson_ratios[0]))
        self.deepest = float(reduced_modulus(moduli[-1], poisson_ratios[-1]))

    def contacts(
        self, loads: ArrayLike, radius: float, order: float
    ) -> Iterator[tuple[float, float, FloatArray, FloatArray]]:
        """Each load, N or N/m, on a radius, m, with the contact that it makes: a, m, and what `solve` finds for it."""
        for load in np.atleast_1d(np.asarray(loads, dtype=np.float64)).tolist():
            size = self.size(load, radius, order)
            yield load, size, *self.solve(size, order)

    def solve(self, size: float, order: float) -> tuple[FloatArray, FloatArray]:
        """``M⁻¹ e_0`` with ``M_mn = ∫S J_νm J_νn dx/x``, and ``∫S √(π/2x) J_νn dx/x``, shape ``(N,)`` each, for a, m."""
        x, step, waves, shifted = _bessel_functions(order)
        ranks = 2 * np.arange(_FUNCTIONS, dtype=np.float64) + order
        if not np.isfinite(size):
            return np.full(ranks.size, np.nan), np.full(ranks.size, np.nan)
        excess = (self.surface / np.asarray(layered_modulus(x / size, **self._layers)).real - 1) * step / x
        # the mean of waves over half a turn is (J J + Y Y)/2, all that counts where S changes slowly
        fading = np.clip(2 - x / _WAVES, 0.0, 1.0)
        fading = fading * fading * (3 - 2 * fading)
        matrix = (waves * (excess * (1 + fading) / 2)) @ waves.T
        matrix += (shifted * (excess * (1 - fading) / 2)) @ shifted.T
        matrix += np.diag(1 / (2 * ranks))
        first = np.zeros(ranks.size)
        first[0] = 1.0
        half = ranks - 0.5  # degree of the spherical Bessel functions
        sinking = np.sqrt(np.pi) / 4 * _gamma_ratio(half) + waves @ (
            excess * fading * np.sqrt(np.pi / (2 * x))
        )
        return np.asarray(np.linalg.solve(matrix, first)), np.asarray(sinking)

    def size(self, load: float, radius: float, order: float) -> float:
        """a, m, at which the stack carries a load, N or N/m, on a radius, m: that of Hertz with the modulus for this size."""
        if not 0 < load < np.inf:
            return np.nan

        def miss(log_size: float) -> float:
            amounts, _ = self.solve(float(np.exp(log_size)), order)
            return _log_hertz(load, radius, self.surface * float(amounts[0]) / (2 * order), order) - log_size

        ends = [
            float(reduced_modulus(modulus, nu))
            for modulus, nu in zip(self._layers["moduli"], self._layers["poisson_ratios"], strict=True)
        ]
        low, high = (_log_hertz(load, radius, modulus, order) for modulus in (max(ends), min(ends) / 2))
        while miss(low) < 0:  # an incompressible layer between stiff ones is stiffer than any of them
            low -= 1.0
        return float(np.exp(brentq(miss, low, high, xtol=1e-12)))


def _log_hertz(load: float, radius: float, modulus: float, order: float) -> float:
    """ln of the contact radius of a ball or the half-width of a cylinder on a half-space."""
    if order == SPHERE:
        return float(np.log(sphere_contact(load, radius, reduced_modulus=modulus).contact_radius))
    return float(np.log(line_contact(load, radius, reduced_modulus=modulus).half_width))


def _gamma_ratio(degree: FloatArray) -> FloatArray:
    """Γ(l/2)/Γ((l + 3)/2), of which ∫₀^∞ j_l dx/x is √π/4 times."""
    found = np.empty_like(degree)
    found[0] = gamma(degree[0] / 2) / gamma((degree[0] + 3) / 2)
    for n in range(1, degree.size):  # gamma itself overflows
        found[n] = found[n - 1] * (degree[n - 1] / 2) / ((degree[n - 1] + 3) / 2)
    return found


@lru_cache(maxsize=2)
def _bessel_functions(order: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Places x, weights of an integral over x, and J and Y of all orders there, shape ``(N, places)``; Y where waves fade."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    doubling = 2.0 ** np.arange(np.log2(_SMALLEST), 1)
    turns = np.arange(1.0, 2 * _WAVES + 4, 4.0)
    far = turns[-1] * 2.0 ** np.arange(1, np.log2(_LARGEST / turns[-1]))
    edges = np.concatenate([doubling, turns[1:], far])
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    x, step = (middle[:, None] + half[:, None] * nodes).ravel(), (half[:, None] * weights).ravel()
    ranks = (2 * np.arange(_FUNCTIONS) + order)[:, None]
    shifted = np.zeros((_FUNCTIONS, x.size))
    shifted[:, x > _WAVES] = yv(ranks, x[x > _WAVES])
    return x, step, jv(ranks, x), shifted
