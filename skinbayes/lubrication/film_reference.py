"""Films under a smooth ball as functions of λ alone: what every film of a rough one becomes at high speed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray, IndexArray
from skinbayes.contact.line_contact import line_contact
from skinbayes.lubrication._uniform_spline import cell_of, spline_coefficients
from skinbayes.lubrication.film import lubricated_films, lubrication_number_per_product

LOWEST, HIGHEST = float(np.log(1e-6)), float(np.log(2e4))
"""ln λ between which smooth films are solved; below, each output is a power of λ."""

HIGHEST_WITH_END = float(np.log(1e8))
"""ln λ up to which they are where the liquid ends: a contact that is nearly flat has a large λ."""

STEP = 0.4
"""Of ln λ between solved films."""

_NODES, _PART = 160, 6


@dataclass(frozen=True, eq=False)
class SmoothFilms:
    """ln of the outputs of smooth films against ln λ.

    The outputs are, in this order, H under the middle, ``∫θ dX/H``, ``∫H dP_f`` and the smallest H, all dimensionless. Under a
    ball the second and third, which depend on where the drag ends, are series of T Chebyshev polynomials of the end, and the
    third is the whole drag, ``∫H dP_f + (λ/3)∫θ dX/H`` of a cylinder of the same friction.

    Attributes
    ----------
    coefficients : of cubic B-splines of ln of the outputs, dimensionless, shape ``(2 + 2 T, S + 2)``, one after the other
    lowest : ln λ of the first point, dimensionless
    step : spacing of ln λ, dimensionless
    everywhere : all four outputs are series of the end, shape ``(4 T, S + 2)``: the liquid itself ends there
    """

    coefficients: FloatArray
    lowest: float
    step: float
    everywhere: bool = False

    @property
    def highest(self) -> float:
        """ln λ of the last point, dimensionless."""
        return self.lowest + self.step * (self.coefficients.shape[1] - 3)

    def __call__(
        self, log_number: FloatArray, outputs: range, slope: bool = False, end: FloatArray | None = None
    ) -> list[FloatArray]:
        """ln of some outputs at ln λ, any shape; with ``slope`` each is followed by its derivative.

        ``end`` is where the drag of a ball ends, −1 … 1 between the ends of the table.

        On even points: SciPy's piecewise polynomials take 1.7 times as long for values, 4.7 times with the derivative.

        Below the range they go on as powers of λ, above it the values at its end are given.
        """
        cells = self.coefficients.shape[1] - 3
        position = (log_number - self.lowest) / self.step
        held = np.minimum(np.maximum(position, 0.0), float(cells))
        cell, place = cell_of(held, cells + 1)
        below = np.minimum(position, 0.0)
        terms = self.terms
        chebyshev = [] if terms == 1 or end is None else _chebyshev(end, terms)
        found: list[FloatArray] = []
        for output in outputs:
            first = output * terms if self.everywhere else (0, 1, 1 + terms, 1 + 2 * terms)[output]
            value, rate = self._spline(first, cell, place, below, slope)
            for more, polynomial in enumerate(chebyshev if self.everywhere or output in (1, 2) else ()):
                further, further_rate = self._spline(first + 1 + more, cell, place, below, slope)
                value = value + polynomial * further
                if rate is not None and further_rate is not None:
                    rate = rate + polynomial * further_rate
            found.extend([value] if rate is None else [value, rate])
        return found

    def _spline(
        self, row: int, cell: IndexArray, place: FloatArray, below: FloatArray, slope: bool
    ) -> tuple[FloatArray, FloatArray | None]:
        """Value and, if wanted, derivative of one of the splines."""
        level, linear, square, cube = (part[row].take(cell) for part in self._cubics)
        cube *= place
        inner = square + cube
        inner *= place
        value = (linear + inner) * place
        value += level
        value += self._cubics[1, row, 0] * below
        if not slope:
            return value, None
        # d/du of level + u (linear + u (square + u cube)), with inner = u square + u² cube
        cube *= place
        return value, (linear + 2 * inner + cube) / self.step

    def mapped(self, function: Callable[[Any], Any]) -> SmoothFilms:
        """The same for other rows: it does not depend on them."""
        return self

    @property
    def terms(self) -> int:
        """T, number of polynomials of the end of the drag, dimensionless; 1 if it has none."""
        rows = self.coefficients.shape[0]
        return rows // 4 if self.everywhere else (rows - 2) // 2

    @cached_property
    def _cubics(self) -> FloatArray:
        """Coefficients by the place in a cell, 0 … 1, lowest first, shape ``(4, 2 + 2 T, cells)``."""
        first, second, third, fourth = (
            self.coefficients[:, shift : self.coefficients.shape[1] - 3 + shift] for shift in range(4)
        )
        return np.array(
            [
                (first + 4 * second + third) / 6,
                (third - first) / 2,
                (first - 2 * second + third) / 2,
                (fourth - first + 3 * (second - third)) / 6,
            ]
        )


def _chebyshev(place: FloatArray, count: int) -> list[FloatArray]:
    """T_1 … T_(count−1), without T_0 = 1."""
    found = [np.ones_like(place), place]
    while len(found) < count:
        found.append(2 * place * found[-1] - found[-2])
    return found[1:]


@lru_cache(maxsize=1)
def smooth_films() -> SmoothFilms:
    """Solve the smooth films, once in a process (0.3 s)."""
    count = round((HIGHEST - LOWEST) / STEP) + 1
    log_number = np.asarray(LOWEST + STEP * np.arange(count), dtype=np.float64)
    parts = [_outputs(log_number[start : start + _PART]) for start in range(0, count, _PART)]
    return SmoothFilms(spline_coefficients(np.concatenate(parts, axis=1)), LOWEST, STEP)


def _outputs(log_number: FloatArray) -> FloatArray:
    """ln of the four outputs, shape ``(4, K)``; a ball with b/Rc = 1 makes films and friction those without dimension."""
    modulus = 4 / np.pi
    hertz = line_contact(1.0, 1.0, reduced_modulus=modulus)
    products = np.exp(log_number) / lubrication_number_per_product(1.0, hertz)
    height, slope = float(hertz.half_width**2), float(hertz.half_width)
    films = lubricated_films(
        products, cylinder_radius=1.0, load_per_length=1.0, reduced_modulus=modulus, nodes=_NODES
    )
    return np.log(
        np.array(
            [
                films.central_film / height,
                films.couette * 3 * np.pi / slope / np.exp(log_number),
                films.pressure_flow * np.pi / slope,
                films.minimum_film / height,
            ]
        )
    )
