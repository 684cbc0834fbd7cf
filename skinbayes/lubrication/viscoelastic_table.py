"""Building the correction of a table of films for tissue that remembers, and its check at random places."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from skinbayes.arrays import FloatArray
from skinbayes.emulation import Kept, Progress, Tasks
from skinbayes.emulation.chebyshev import grid_coefficients, zeros
from skinbayes.lubrication._uniform_spline import spline_coefficients
from skinbayes.lubrication.contact_films import LINE, POINT
from skinbayes.lubrication.film_axes import FILM_PARAMETERS, film_scales
from skinbayes.lubrication.film_contraction import contract
from skinbayes.lubrication.film_plan import FilmTablePlan
from skinbayes.lubrication.film_point import relative_outputs
from skinbayes.lubrication.film_reference import smooth_films
from skinbayes.lubrication.film_similarity import similar_speeds, whole_drag, with_whole_drag
from skinbayes.lubrication.film_sweeps import FAINT, HALF, Ball
from skinbayes.lubrication.film_table import (
    BOUNDARY,
    COUETTE,
    FASTEST,
    HYSTERESIS,
    PRESSURE_FLOW,
    REFERENCE_WITH_MEMORY,
    SLOWEST,
    FilmTable,
)
from skinbayes.lubrication.film_table_build import held_out_places
from skinbayes.lubrication.film_table_evaluation import LubricatedBalls, tabulated_friction
from skinbayes.lubrication.smooth_memory import LOG_NUMBERS, smooth_outputs
from skinbayes.lubrication.viscoelastic_correction import (
    NARROWEST,
    MemoryCorrection,
    RememberingTissue,
    bent,
    unbent,
)
from skinbayes.lubrication.viscoelastic_memory import STANDARD_LINEAR_SOLID, passage_in_contact
from skinbayes.lubrication.viscoelastic_stribeck import SPHERE_OVER_CYLINDER

VERSION = 2
"""Of what the numbers in a correction mean; those of another version are built anew."""

_EVERY = 2  # of the speeds of the table at which the correction is solved
_BEYOND = 8  # speeds, beyond those of the table, at which the shifted ones may lie
_SPARSER = 1 / 3  # nodes at which the correction is solved, over those of the table
_CHECK_NODES = 128


@dataclass(frozen=True, eq=False)
class MemoryPlan:
    """A correction of a table of films for tissue that remembers, before it is built.

    Attributes
    ----------
    films : the table that it belongs to, whose ranges of moduli are those of |E| at v/b
    substrate : "standard_linear_solid" or "constant_loss"
    largest_strength : ln(1 + Δ) or n, dimensionless, > 0; the correction begins at 0
    places : smallest and largest ln(vτ√(1 + Δ)/b), dimensionless; both 0 for a constant loss angle
    counts : nodes of strength and place, dimensionless; by the width of their ranges if None
    checked : number of random places, dimensionless, at which friction is compared with direct solutions
    """

    films: FilmTablePlan
    _: KW_ONLY
    substrate: str
    largest_strength: float
    places: tuple[float, float] = (0.0, 0.0)
    counts: tuple[int, int] | None = None
    checked: int = 120

    @property
    def ends(self) -> tuple[float, float]:
        """Ends of the axis of the place."""
        first, last = (float(bent(np.asarray(place))) for place in self.places)
        middle, half = (first + last) / 2, max(last - first, NARROWEST) / 2
        return middle - half, middle + half

    @property
    def kernels(self) -> tuple[int, int]:
        """Nodes of strength and place."""
        if self.counts is not None:
            return self.counts
        if self.substrate != STANDARD_LINEAR_SOLID:
            return 3 + int(np.ceil(self.largest_strength / 0.15)), 1
        width = self.ends[1] - self.ends[0]
        return 3 + int(np.ceil(self.largest_strength)), 1 if width < 2 * NARROWEST else 3 + int(
            np.ceil(5 * width)
        )

    @property
    def nodes(self) -> tuple[int, ...]:
        """Nodes of the axes of the table at which the correction is solved: fewer than those of the table."""
        return tuple(max(min(count, 3), round(_SPARSER * count)) for count in self.films.axes.counts)

    def key(self) -> dict[str, Any]:
        """Numbers and texts that JSON can hold; equal for equal corrections."""
        return {
            "version": VERSION,
            "films": self.films.key(),
            "substrate": self.substrate,
            "largest_strength": float(self.largest_strength),
            "places": [float(place) for place in self.places],
            "nodes": [*self.kernels, *self.nodes],
            "checked": self.checked,
        }


def build_memory_correction(
    plan: MemoryPlan,
    table: FilmTable,
    *,
    processes: int = 1,
    progress: Progress | None = None,
    kept: Kept | None = None,
) -> MemoryCorrection:
    """The correction of a table that was built from ``plan.films``; other arguments are those of `build_film_table`.

    At Chebyshev nodes of strength, place and the axes of the table a cylinder on tissue that remembers is solved, and one on
    elastic tissue of the same modulus at v/b. What is added to ln of the outputs is smooth in everything. For a ball it is taken
    from its cylinder, where asperities carry as much of the load.
    """
    axes = plan.films.axes
    whole = plan.films.contact == POINT
    first, last = plan.ends
    strengths = plan.largest_strength * (zeros(plan.kernels[0]) + 1) / 2
    along = unbent((first + last) / 2 + (last - first) / 2 * zeros(plan.kernels[1]))
    kernels = [*product(strengths.tolist(), along.tolist())]
    nodes = [*product(*(zeros(count).tolist() for count in plan.nodes))]
    places = axes.representative(np.array(nodes).reshape(len(nodes), len(axes.names)))
    grid = np.linspace(SLOWEST, FASTEST, plan.films.speeds)
    step = (FASTEST - SLOWEST) / (plan.films.speeds - 1)
    fine = np.asarray(SLOWEST + step * np.arange(plan.films.speeds + _BEYOND), dtype=np.float64)
    few = fine[::_EVERY]
    total = (len(kernels) + 2) * len(places) + len(kernels) + 1 + plan.checked
    with Tasks(processes, total, progress, kept) as solve:
        balls = [plan.films.ball(place) for place in places]
        anchors = _anchors_of(table, places, balls, solve)
        numbers, all_numbers = (anchors[:, :1] + anchors[:, 1:] * places for places in (few, fine))
        of_nodes = partial(_outputs, nodes=plan.films.nodes, substrate=plan.substrate)
        elastic = solve("elastic", of_nodes, ((*one, None) for one in zip(balls, all_numbers, strict=True)))
        smooth = solve(
            "smooth",
            partial(smooth_outputs, substrate=plan.substrate, whole_drag=whole),
            [(0.0, 0.0), *kernels],
        )
        tasks = ((*one, kernel) for kernel in kernels for one in zip(balls, numbers, strict=True))
        found = solve("memory", of_nodes, tasks).reshape(len(kernels), len(places), HYSTERESIS + 1, few.size)
        if whole:
            elastic = whole_drag(elastic, all_numbers)
            found = np.stack([whole_drag(one, numbers) for one in found])
        added = smooth[1:]
        added[:, :-1] -= smooth[0, :-1]
        reference = CubicSpline(LOG_NUMBERS, added, axis=-1)(np.maximum(numbers, LOG_NUMBERS[0]))
        elastic = elastic[:, :HYSTERESIS]
        found[:, :, :HYSTERESIS] -= elastic[..., ::_EVERY]
        for output, place in REFERENCE_WITH_MEMORY.items():
            found[:, :, output] -= reference[:, place]
        found = CubicSpline(few, found, axis=-1)(fine)
        films = smooth_films()
        elastic = relative_outputs(elastic, all_numbers, with_whole_drag(films) if whole else films)
        found[:, :, :HYSTERESIS] += elastic
        terms = np.stack([_similar(one, elastic, fine, grid) for one in found])
        strength = np.array(kernels)[:, :1, None]
        terms[..., : -grid.size - 2] /= strength  # of all but the hysteresis
        added[:, :-1] /= strength
        terms = terms.reshape(*plan.kernels, *plan.nodes, -1)
        correction = MemoryCorrection(
            substrate=plan.substrate,
            largest_strength=float(plan.largest_strength),
            first_place=first,
            last_place=last,
            coefficients=grid_coefficients(terms, ends=False),
            smooth=grid_coefficients(spline_coefficients(added).reshape(*plan.kernels, -1), ends=False),
            held_out=np.full(3, np.nan),
            held_out_count=plan.checked,
        )
        return (
            replace(correction, held_out=_check(correction, table, plan, solve))
            if plan.checked
            else correction
        )


def _similar(found: FloatArray, elastic: FloatArray, fine: FloatArray, grid: FloatArray) -> FloatArray:
    """What is added to the anchors and outputs of M cylinders, shape ``(M, 2 + 7 (S + 2))``, at speeds of equal load fractions.

    Relative outputs are those of tissue that remembers, ``(M, 7, F)``, and of elastic one, ``(M, 6, F)``, at its speeds.
    """
    similar = similar_speeds(found, fine, elastic, fine, (HALF, FAINT))
    residual = np.empty((*found.shape[:2], grid.size))
    for row, (shift, stretch) in enumerate(similar.tolist()):
        residual[row] = CubicSpline(fine, found[row], axis=-1)(np.minimum(shift + stretch * grid, fine[-1]))
    residual[:, :HYSTERESIS] -= elastic[..., : grid.size]
    splines = spline_coefficients(residual)
    splines[:, [*REFERENCE_WITH_MEMORY], -3:] = 0.0  # as those of the table
    return np.concatenate([similar - [0.0, 1.0], splines.reshape(len(found), -1)], axis=1)


_Task = tuple[Ball, FloatArray, tuple[float, float] | None]


def _outputs(task: _Task, nodes: int, substrate: str) -> FloatArray:
    """Outputs of a cylinder, shape ``(7, K)``; without a kernel the tissue is elastic, and the last of them nan."""
    ball, log_number, kernel = task
    if kernel is None:
        elastic = ball.outputs(log_number, nodes)
        return np.concatenate([elastic, np.full((1, log_number.size), np.nan)])
    return ball.outputs_with_memory(
        log_number, nodes, substrate=substrate, strength=kernel[0], place=kernel[1]
    )


def _anchors_of(table: FilmTable, places: FloatArray, balls: list[Ball], solve: Tasks) -> FloatArray:
    """ln λ that speeds of the cylinders are counted from, and its unit, shape ``(M, 2)``."""
    if table.contact == LINE:
        films = contract(table, list(places.T[:, :, None]), 1)
        return np.concatenate([films.anchor, films.unit], axis=1)
    return solve("anchors", Ball.anchors, balls)


def _check(correction: MemoryCorrection, table: FilmTable, plan: MemoryPlan, solve: Tasks) -> FloatArray:
    """Median, 99th percentile and largest error of μ at random parameters, memories and speeds, for a slow μ of 1.

    A table of balls is not compared with balls, but its correction with that of cylinders.
    """
    drawn, number = held_out_places(table, plan.films, plan.checked)
    rng = np.random.default_rng(20131)
    strength = rng.uniform(0, correction.largest_strength, plan.checked)
    place = unbent(rng.uniform(correction.first_place, correction.last_place, plan.checked))
    balls = [plan.films.ball(point) for point in drawn]
    shear_stress = np.array(
        [np.sqrt(np.pi * plan.films.area_correction * ball.twice_variance) / 2 for ball in balls]
    )
    kernels = zip(strength.tolist(), place.tolist(), strict=True)
    tasks = zip(balls, number[:, None], kernels, strict=True)
    outputs = solve("check", partial(_outputs, nodes=_CHECK_NODES, substrate=plan.substrate), tasks)[..., 0]
    scales = film_scales(list(drawn.T), table.poisson_ratio_bulk)
    slope = np.exp(scales.strain)
    loss = np.array(
        [
            passage_in_contact(plan.substrate, *kernel, modulus=1.0, half_width=1.0)[1]
            for kernel in zip(strength.tolist(), place.tolist(), strict=True)
        ]
    )
    direct = (
        shear_stress * np.exp(outputs[:, BOUNDARY]) / [ball.stiffness for ball in balls]
        + np.exp(number + outputs[:, COUETTE]) / (3 * np.pi) * slope
        + np.exp(outputs[:, PRESSURE_FLOW]) / np.pi * slope
        + SPHERE_OVER_CYLINDER * 8 / (3 * np.pi) * loss * slope * np.exp(outputs[:, HYSTERESIS])
    )
    tissue = RememberingTissue(correction=correction, strength=strength, place=place, loss=loss)
    tabulated = tabulated_friction(
        table,
        np.exp(number - scales.number_per_product),
        balls=LubricatedBalls(
            parameters=dict(zip(FILM_PARAMETERS, np.exp(drawn.T), strict=True)),
            frictional_shear_stress=shear_stress,
            largest_strain=plan.films.largest_strain,
            tissue=tissue,
        ),
    ).friction_coefficient
    errors = np.abs(tabulated / direct - 1)
    return np.array([np.quantile(errors, 0.5), np.quantile(errors, 0.99), errors.max()])
