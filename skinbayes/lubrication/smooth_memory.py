"""Films under a smooth cylinder on tissue that remembers: what every film of a rough one becomes at high speed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray, IndexArray
from skinbayes.contact.line_contact import line_contact
from skinbayes.lubrication._uniform_spline import cell_of, cubic_slopes, cubic_weights, gather, gather_both
from skinbayes.lubrication.film import lubrication_number_per_product
from skinbayes.lubrication.film_reference import HIGHEST, SmoothFilms
from skinbayes.lubrication.viscoelastic_film import films_on
from skinbayes.lubrication.viscoelastic_memory import passage_in_contact

SMOOTH_OUTPUTS = 5
"""Outputs of smooth films: those of `SmoothFilms`, and ln of the hysteresis over (8/3π) sin δ b/Rc."""

_STEP, _COUNT = 0.75, 23  # of ln λ, down from the fastest
LOG_NUMBERS = HIGHEST - _STEP * np.arange(_COUNT)[::-1]
"""ln λ at which smooth films are solved; below, what memory adds to them stays as it is, as the table of rough ones takes it."""

_NODES, _PART = 128, 6


def smooth_outputs(kernel: tuple[float, float], substrate: str, whole_drag: bool) -> FloatArray:
    """ln of the five outputs at `LOG_NUMBERS`, shape ``(5, S)``; of elastic tissue, for strength 0, with nan for hysteresis.

    ``whole_drag``: with the whole drag of the liquid in place of the pressure flow.
    """
    modulus = 4 / np.pi  # for which b/Rc is 1 under 1 N/m and Rc = 1 m
    hertz = line_contact(1.0, 1.0, reduced_modulus=modulus)
    scales, loss = passage_in_contact(substrate, *kernel, modulus=modulus, half_width=float(hertz.half_width))
    found = np.empty((SMOOTH_OUTPUTS, _COUNT))
    for start in range(0, _COUNT, _PART):
        number = np.exp(LOG_NUMBERS[start : start + _PART])
        films = films_on(
            scales,
            number / lubrication_number_per_product(1.0, hertz),
            load_per_length=1.0,
            cylinder_radius=1.0,
            asperities=None,
            nodes=_NODES,
        )
        couette = films.couette * 3 * np.pi
        pressure_flow = films.pressure_flow * np.pi
        found[:, start : start + _PART] = (
            films.central_film,
            couette / number,
            pressure_flow + couette / 3 if whole_drag else pressure_flow,
            films.minimum_film,
            films.hysteresis / (8 / (3 * np.pi) * loss) if loss > 0 else np.full(number.size, np.nan),
        )
    return np.log(found)


@dataclass(frozen=True, eq=False)
class SmoothWithMemory:
    """Films under smooth balls on tissue of many memories: `SmoothFilms` and what is added to them.

    Attributes
    ----------
    elastic : of elastic tissue
    flat : B-spline coefficients of what is added, of all vectors and rows one after the other, dimensionless
    start : where those of each begin, shape ``(B, 1)`` or ``(B, N)``
    """

    elastic: SmoothFilms
    flat: FloatArray
    start: IndexArray

    @property
    def highest(self) -> float:
        """ln λ of the last point, dimensionless."""
        return self.elastic.highest

    @property
    def everywhere(self) -> bool:
        """Whether the liquid itself ends where the drag does."""
        return self.elastic.everywhere

    def __call__(
        self, log_number: FloatArray, outputs: range, slope: bool = False, end: FloatArray | None = None
    ) -> list[FloatArray]:
        """As `SmoothFilms`; output 4 is the hysteresis."""
        found = self.elastic(log_number, range(outputs.start, min(outputs.stop, 4)), slope, end)
        position = np.minimum(np.maximum((log_number - LOG_NUMBERS[0]) / _STEP, 0.0), _COUNT - 1.0)
        cell, place = cell_of(position, _COUNT)
        start, weights = self.start + cell, cubic_weights(place)
        slopes = cubic_slopes(place) if slope else ()
        inside = (log_number > LOG_NUMBERS[0]) / _STEP
        added: list[FloatArray] = []
        for output in outputs:
            offset = output * (_COUNT + 2)
            if slope:
                value, rate = gather_both(self.flat, start, offset, weights, slopes)
                added += [value, rate * inside]
            else:
                added.append(gather(self.flat, start, offset, weights))
        return [more + known for more, known in zip(added, found, strict=False)] + added[len(found) :]

    def mapped(self, function: Callable[[Any], Any]) -> SmoothWithMemory:
        """The same for other rows."""
        return replace(self, start=function(self.start))
