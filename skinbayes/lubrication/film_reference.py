"""Films under a smooth ball as functions of λ alone: what every film of a rough one becomes at high speed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.line_contact import line_contact
from skinbayes.lubrication._uniform_spline import cell_of, spline_coefficients
from skinbayes.lubrication.film import lubricated_films, lubrication_number_per_product

LOWEST, HIGHEST = float(np.log(1e-6)), float(np.log(2e4))
"""ln λ between which smooth films are solved; below, each output is a power of λ."""

_STEP, _NODES, _PART = 0.4, 160, 6


@dataclass(frozen=True, eq=False)
class SmoothFilms:
    """ln of the outputs of smooth films against ln λ.

    The outputs are, in this order, H under the middle, ``∫θ dX/H``, ``∫H dP_f`` and the smallest H, all dimensionless.

    Attributes
    ----------
    coefficients : of cubic B-splines of ln of the outputs, dimensionless, shape ``(4, S + 2)``
    lowest : ln λ of the first point, dimensionless
    step : spacing of ln λ, dimensionless
    """

    coefficients: FloatArray
    lowest: float
    step: float

    @property
    def highest(self) -> float:
        """ln λ of the last point, dimensionless."""
        return self.lowest + self.step * (self.coefficients.shape[1] - 3)

    def __call__(self, log_number: FloatArray, outputs: range, slope: bool = False) -> list[FloatArray]:
        """ln of some outputs at ln λ, any shape; with ``slope`` each is followed by its derivative.

        On even points: SciPy's piecewise polynomials take 1.7 times as long for values, 4.7 times with the derivative.

        Below the range they go on as powers of λ, above it the values at its end are given.
        """
        cells = self.coefficients.shape[1] - 3
        position = (log_number - self.lowest) / self.step
        held = np.minimum(np.maximum(position, 0.0), float(cells))
        cell, place = cell_of(held, cells + 1)
        below = np.minimum(position, 0.0)
        found: list[FloatArray] = []
        for output in outputs:
            level, linear, square, cube = (part[output].take(cell) for part in self._cubics)
            cube *= place
            inner = square + cube
            inner *= place
            value = (linear + inner) * place
            value += level
            value += self._cubics[1, output, 0] * below
            found.append(value)
            if slope:
                # d/du of level + u (linear + u (square + u cube)), with inner = u square + u² cube
                cube *= place
                found.append((linear + 2 * inner + cube) / self.step)
        return found

    @cached_property
    def _cubics(self) -> FloatArray:
        """Coefficients by the place in a cell, 0 … 1, lowest first, shape ``(4, 4, cells)``."""
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


@lru_cache(maxsize=1)
def smooth_films() -> SmoothFilms:
    """Solve the smooth films, once in a process (0.3 s)."""
    count = round((HIGHEST - LOWEST) / _STEP) + 1
    log_number = np.asarray(LOWEST + _STEP * np.arange(count), dtype=np.float64)
    parts = [_outputs(log_number[start : start + _PART]) for start in range(0, count, _PART)]
    return SmoothFilms(spline_coefficients(np.concatenate(parts, axis=1)), LOWEST, _STEP)


def _outputs(log_number: FloatArray) -> FloatArray:
    """ln of the four outputs, shape ``(4, K)``; a ball with b/Rc = 1 makes films and friction those without dimension."""
    modulus = 4 / np.pi
    hertz = line_contact(1.0, 1.0, reduced_modulus=modulus)
    products = np.exp(log_number) / lubrication_number_per_product(1.0, hertz)
    films = lubricated_films(
        products, cylinder_radius=1.0, load_per_length=1.0, reduced_modulus=modulus, nodes=_NODES
    )
    height, slope = float(hertz.half_width**2), float(hertz.half_width)
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
