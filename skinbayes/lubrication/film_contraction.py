"""A table of films at given parameters: the axes summed up, functions of the speed left."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray, IndexArray
from skinbayes.emulation.chebyshev import summed, summed_locally
from skinbayes.lubrication._uniform_spline import (
    cell_of,
    cubic_slopes,
    cubic_weights,
    gather,
    gather_both,
)
from skinbayes.lubrication.contact_films import POINT
from skinbayes.lubrication.film_axes import FilmAxes, Scales, film_scales
from skinbayes.lubrication.film_point import end_coordinate, log_end
from skinbayes.lubrication.film_reference import SmoothFilms
from skinbayes.lubrication.film_table import (
    ANCHORS,
    BOUNDARY,
    CENTRAL,
    COUETTE,
    FRACTION,
    HYSTERESIS,
    MINIMUM,
    PRESSURE_FLOW,
    REFERENCE_WITH_MEMORY,
    SLOWEST,
    FilmTable,
)
from skinbayes.lubrication.smooth_memory import SmoothWithMemory

_POWER = {
    CENTRAL: 0.0,
    BOUNDARY: 0.0,
    COUETTE: 0.0,
    PRESSURE_FLOW: 1.0,
    MINIMUM: 0.0,
    FRACTION: 0.0,
    HYSTERESIS: 0.0,
}
"""Powers of λ that the outputs become at low speed: films stay, ∫θ dX/H too, the fluid pressure is in proportion to λ."""


@dataclass(frozen=True, eq=False)
class ContractedFilms:
    """Films of B parameter vectors with N rows each as functions of ln λ.

    Attributes
    ----------
    flat : coefficients of all vectors and rows one after the other, dimensionless
    start : where those of each vector and row begin, shape ``(B, 1)`` or ``(B, N)``
    anchor, unit : ln λ that speeds are counted from and their unit, dimensionless, shape ``(B, 1)`` or ``(B, N)``
    speeds : number of speeds, dimensionless
    fastest : the last of them, in that unit
    smooth : films of the smooth ball
    log_loss : ln sin δ of tissue that remembers, shape ``(B, 1)`` or ``(B, N)``; None if it is elastic
    end : where the drag of a ball ends, −1 … 1 between the ends of the table, shape ``(B, 1)`` or ``(B, N)``; None for a line
        contact, and for points, of which no drag is asked, unless it changes their films
    scales : of the contact, shape ``(B, 1)`` or ``(B, N)`` each
    inside : where the table holds the parameters
    """

    flat: FloatArray
    start: IndexArray
    anchor: FloatArray
    unit: FloatArray
    speeds: int
    fastest: float
    smooth: SmoothFilms | SmoothWithMemory
    end: FloatArray | None
    scales: Scales
    inside: BoolArray
    log_loss: FloatArray | None = None

    def points(self, shape: tuple[int, int]) -> ContractedFilms:
        """The same for vectors and rows of the given shape one after the other, as arrays of one axis."""
        return self._mapped(lambda array: np.broadcast_to(array, shape).reshape(-1))

    def chosen(self, places: IndexArray) -> ContractedFilms:
        """Some of the points."""
        return self._mapped(lambda array: array.take(places))

    def _mapped(self, function: Callable[[Any], Any]) -> ContractedFilms:
        names = ("start", "anchor", "unit", "inside")
        scales = Scales(*(function(scale) for scale in self.scales))
        end = function(self.end) if self.smooth.everywhere else None
        return replace(
            self,
            scales=scales,
            end=end,
            log_loss=None,
            smooth=self.smooth.mapped(function),
            **{name: function(getattr(self, name)) for name in names},
        )

    def log_outputs(self, log_number: FloatArray, outputs: Sequence[int]) -> list[FloatArray]:
        """ln of some outputs at ln λ of shape ``(B, N)``; of shape ``(P,)`` for points."""
        return self._evaluate(log_number, outputs, slope=False)

    def log_central_film(self, log_number: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln H under the middle of the ball and its derivative by ln λ, at ln λ of shape ``(B, N)`` or ``(P,)``."""
        value, slope = self._evaluate(log_number, (CENTRAL,), slope=True)
        return value, slope

    def _evaluate(self, log_number: FloatArray, outputs: Sequence[int], slope: bool) -> list[FloatArray]:
        count = self.speeds
        per_unit = (count - 1) / (self.fastest - SLOWEST)
        position = ((log_number - self.anchor) / self.unit - SLOWEST) * per_unit
        held = np.minimum(np.maximum(position, 0.0), count - 1.0)
        cell, place = cell_of(held, count)
        start = self.start + cell
        weights, slopes = cubic_weights(place), cubic_slopes(place) if slope else ()
        ends = _Ends(self, position, log_number)
        references = [REFERENCE_WITH_MEMORY[output] for output in outputs if output in REFERENCE_WITH_MEMORY]
        smooth = iter(self._smooth(ends.held_number, references, slope))
        found: list[FloatArray] = []
        for output in outputs:
            offset = ANCHORS + output * (count + 2)
            rate: FloatArray | None = None
            if slope:
                value, rate = gather_both(self.flat, start, offset, weights, slopes)
                rate *= per_unit / self.unit
            else:
                value = gather(self.flat, start, offset, weights)
            if output in REFERENCE_WITH_MEMORY:
                value += next(smooth)
                if rate is not None:
                    rate += next(smooth)
            found.extend(ends.continued(output, value, rate))
        return found

    def _smooth(self, log_number: FloatArray, references: list[int], slope: bool) -> list[FloatArray]:
        if not references:
            return []
        wanted = range(references[0], references[-1] + 1)
        parts = self.smooth(log_number, wanted, slope, self.end)
        each = 2 if slope else 1
        return [parts[(reference - wanted[0]) * each + i] for reference in references for i in range(each)]


class _Ends:
    """Continuation beyond the slowest and the fastest speed of a table.

    Slow: the fluid acts in proportion to λ, so that ``ln Y = ln Y0 + s ΔL + (Y0′ − s)(e^ΔL − 1)`` with the limiting power s.
    Fast: boundary term and load fraction fall on with the slope they have; the others are those of the smooth ball.
    """

    def __init__(self, films: ContractedFilms, position: FloatArray, log_number: FloatArray) -> None:
        self.films = films
        self.slow = np.nonzero(position < 0)
        self.fast = np.nonzero(position > films.speeds - 1)
        self.held_number = log_number
        self.shape = position.shape
        self.per_unit = (films.speeds - 1) / (films.fastest - SLOWEST)
        if self.slow[0].size:
            first = np.broadcast_to(films.anchor + films.unit * SLOWEST, self.shape)[self.slow]
            self.held_number = log_number.copy()
            self.held_number[self.slow] = first
            self.below = log_number[self.slow] - first
        if self.fast[0].size:
            last = np.broadcast_to(films.anchor + films.unit * films.fastest, self.shape)[self.fast]
            self.above = log_number[self.fast] - last

    def continued(self, output: int, value: FloatArray, rate: FloatArray | None) -> list[FloatArray]:
        if self.slow[0].size:
            power = _POWER[output]
            growth = np.exp(self.below)
            bend = self._rate(output, self.slow, 0) - power
            value[self.slow] += power * self.below + bend * (growth - 1)
            if rate is not None:
                rate[self.slow] = power + bend * growth
        if self.fast[0].size and output not in REFERENCE_WITH_MEMORY:
            value[self.fast] += self._rate(output, self.fast, self.films.speeds - 1) * self.above
        return [value] if rate is None else [value, rate]

    def _rate(self, output: int, where: tuple[IndexArray, ...], point: int) -> FloatArray:
        """Derivative by ln λ at the first or last speed, of chosen places."""
        films = self.films
        start = (
            np.broadcast_to(films.start, self.shape)[where] + ANCHORS + output * (films.speeds + 2) + point
        )
        unit = np.broadcast_to(films.unit, self.shape)[where]
        rate = (films.flat.take(start + 2) - films.flat.take(start)) / 2 * self.per_unit / unit
        if output in REFERENCE_WITH_MEMORY:
            at = np.broadcast_to(
                films.anchor + films.unit * (SLOWEST if point == 0 else films.fastest), self.shape
            )
            reference = REFERENCE_WITH_MEMORY[output]
            end = None if films.end is None else np.broadcast_to(films.end, self.shape)[where]
            wanted = range(reference, reference + 1)
            smooth = films.smooth.mapped(lambda array: np.broadcast_to(array, self.shape)[where])
            rate = rate + smooth(at[where], wanted, slope=True, end=end)[1]
        return np.asarray(rate)


def contract(
    table: FilmTable, log_parameters: Sequence[FloatArray], outputs: int, *, local: int | None = None
) -> ContractedFilms:
    """Sum up the axes of a table for B parameter vectors.

    Parameters
    ----------
    table : `FilmTable`
    log_parameters : ln of the parameters, SI, each of shape ``(B, 1)`` or ``(B, N)``
    outputs : how many of the outputs are wanted, from the first on, dimensionless
    local : terms between the rows of a vector along the first of several axes that they vary along, dimensionless; all if None

    Returns
    -------
    films : `ContractedFilms`; the parameters outside the table are taken as those of its middle, and marked
    """
    axes = table.axes
    inside = axes.contains(log_parameters)
    columns = ANCHORS + outputs * (table.speeds + 2)
    held = held_coordinates(axes, log_parameters)
    parts, vectors = table.coefficients[..., :columns], len(log_parameters[0])
    rows = [axis for axis, place in enumerate(held) if place.shape[1] > 1]
    if local is not None and len(rows) > 1 and parts.shape[rows[0]] > local:
        found = summed_locally(parts, held, vectors, rows[0], local)
    else:
        found = summed(parts, held, vectors)
    flat = found.reshape(-1)
    start = np.arange(0, flat.size, columns).reshape(found.shape[:2])
    scales = film_scales(log_parameters, table.poisson_ratio_bulk)
    end = None
    if table.contact == POINT:
        log_ends = log_end(log_parameters, table.poisson_ratio_bulk, table.inlet_length)
        end = end_coordinate(log_ends, table.end_low, table.end_high)
        inside = inside & (np.abs(end) <= 1)
        end = np.where(np.abs(end) <= 1, end, 0.0)
    return ContractedFilms(
        flat,
        start,
        flat.take(start),
        flat.take(start + 1),
        table.speeds,
        table.fastest,
        table.smooth,
        end,
        scales,
        inside,
    )


def held_coordinates(axes: FilmAxes, log_parameters: Sequence[FloatArray]) -> list[FloatArray]:
    """Coordinates of parameters, those outside the table as in its middle, which nan is, too."""
    return [np.where(np.abs(part) <= 1 + 1e-6, part, 0.0) for part in axes.coordinates(log_parameters)]
