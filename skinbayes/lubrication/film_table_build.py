"""Building a table of films: direct solutions at Chebyshev nodes of the axes, and a check at random places."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import product

import numpy as np
from scipy.interpolate import CubicSpline

from skinbayes.arrays import FloatArray
from skinbayes.emulation import Kept, Progress, Tasks
from skinbayes.emulation.chebyshev import grid_coefficients, summed, zeros
from skinbayes.lubrication._uniform_spline import spline_coefficients
from skinbayes.lubrication.contact_films import LINE, POINT
from skinbayes.lubrication.film_axes import FILM_PARAMETERS, film_scales
from skinbayes.lubrication.film_contraction import contract
from skinbayes.lubrication.film_plan import FEW_CELLS, FilmTablePlan
from skinbayes.lubrication.film_point import (
    end_coordinate,
    log_end,
    relative_outputs,
    smooth_point_films,
)
from skinbayes.lubrication.film_reference import smooth_films
from skinbayes.lubrication.film_sweeps import Ball
from skinbayes.lubrication.film_table import SLOWEST, FilmTable
from skinbayes.lubrication.film_table_evaluation import LubricatedBalls, tabulated_friction
from skinbayes.lubrication.point_film import CELLS
from skinbayes.lubrication.stribeck import THICKEST_FILM

_ANCHOR_COUNT = (
    5  # nodes of an axis, at most, at which the anchors are found; between them they are polynomials
)
_CHECK_NODES, _CHECK_CELLS = 128, 800
# what more cells of a ball change is smooth: it is found at every second speed, and at fewer nodes, of all and of an axis
_EVERY = 2
_FINER, _FINER_AT_LEAST = 0.4, 4
_SPARE = 1e-3  # of ln, beyond the ends of the drag


def build_film_table(
    plan: FilmTablePlan, *, processes: int = 1, progress: Progress | None = None, kept: Kept | None = None
) -> FilmTable:
    """Table of the films under a ball on rough skin, or another solid, for parameters within ranges (Sect. 6 of the paper).

    Parameters
    ----------
    plan : `FilmTablePlan`, what the table is to hold
    processes : how many solve at once, dimensionless
    progress : told the number of sweeps that are done and of all
    kept : where solutions are kept until the table is done; a build that finds some there goes on from them, to the same table

    Returns
    -------
    table : `FilmTable`

    Raises
    ------
    InputError
        if a range is wrong, or if no film is found at a node

    Notes
    -----
    The table ends where b/Rc is the largest strain for the largest ball and where p_H/√V is 0.3: the closer to complete contact,
    the stiffer the dependence on everything. With E0 from 1 to 30 MPa, E1 from 5 to 500 kPa, roughness from 2 to 60 µm, radius
    from 5 to 15 mm and force from 0.1 to 5 N, all varying, friction at any speed and shear stress is within 0.5 % of direct
    solutions at 99 of 100 random places, and within 0.75 % at the worst of 300; narrower ranges do better with fewer nodes.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6).

    Examples
    --------
    A table for one ball only has no axes; it holds the balls that are similar, too.

    >>> from skinbayes.roughness import named_surface
    >>> ball = {"young_modulus_layer": 7e6, "young_modulus_bulk": 20e3, "rms_height": 22.4e-6, "sphere_radius": 8e-3,
    ...         "normal_force": 0.2, "layer_thickness": 20e-6}
    >>> ranges = {name: (value, value) for name, value in ball.items()}
    >>> table = build_film_table(FilmTablePlan(ranges, spectrum=named_surface("paper_reference"), checked=0))
    >>> print(table.axes.names, table.contains(**ball), table.contains(**{**ball, "rms_height": 1e-5}))
    () True False
    """
    axes, point = plan.axes, plan.contact == POINT
    coarse = tuple(min(count, _ANCHOR_COUNT) for count in axes.counts)
    places, coarse_places = _nodes_of(axes.counts), _nodes_of(coarse)
    finer_places = _nodes_of(_finer_at(axes.counts)) if point else np.empty((0, 0))
    sweeps = len(places) + len(coarse_places) + 2 * len(finer_places) + plan.checked

    with Tasks(processes, sweeps, progress, kept) as solve:
        balls = (plan.ball(axes.representative(place)) for place in coarse_places)
        anchors = solve("anchors", partial(_anchors, contact=plan.contact), balls)
        anchor_terms = grid_coefficients(anchors.reshape(*coarse, 2), ends=False)
        more = [(0, count - size) for count, size in zip(axes.counts, coarse, strict=True)]
        grid = np.linspace(SLOWEST, plan.fastest, plan.speeds_solved)

        def solved(
            stage: str, there: FloatArray, speeds: FloatArray, cells: int
        ) -> tuple[FloatArray, FloatArray]:
            """Outputs at M places and the ln λ of some speeds, shape ``(M, K)``."""
            anchored = _at(anchor_terms, there)
            numbers = anchored[:, :1] + anchored[:, 1:] * speeds
            balls = (plan.ball(axes.representative(place)) for place in there)
            outputs_of = partial(_outputs, nodes=plan.nodes, contact=plan.contact, cells=cells)
            return solve(stage, outputs_of, zip(balls, numbers, strict=True)), numbers

        outputs, numbers = solved("outputs", places, grid, FEW_CELLS)
        smooth, ends, there = smooth_films(), (0.0, 0.0), None
        if point:
            few = grid[::_EVERY]
            on_many, _ = solved("on many cells", finer_places, few, plan.cells)
            on_few, _ = solved("on few cells", finer_places, few, FEW_CELLS)
            more_cells = CubicSpline(few, on_many - on_few, axis=-1)(grid)
            terms = grid_coefficients(more_cells.reshape(*_finer_at(axes.counts), -1), ends=False)
            outputs = outputs + _at(terms, places).reshape(outputs.shape)
            ends = _ends_of(plan)
            there = _end_coordinates(plan, axes.representative(places), ends)
            smooth = smooth_point_films(*ends, endless=plan.inlet_length is None)
        splines = spline_coefficients(relative_outputs(outputs, numbers, smooth, there))
        # at the last speeds the ball is smooth to 1e-4: exactly so from there on
        splines[:, (0, 2, 3, 4), -3:] = 0.0
        terms = grid_coefficients(splines.reshape(*axes.counts, -1), ends=False)
        anchor_terms = np.pad(anchor_terms, [*more, (0, 0)])
        table = FilmTable(
            axes=axes,
            coefficients=np.ascontiguousarray(np.concatenate([anchor_terms, terms], axis=-1)),
            speeds=plan.speeds_solved,
            fastest=plan.fastest,
            contact=plan.contact,
            end_low=ends[0],
            end_high=ends[1],
            inlet_length=plan.inlet_length,
            smooth=smooth,
            poisson_ratio_bulk=plan.poisson_ratio_bulk,
            held_out=np.full(3, np.nan),
            held_out_count=plan.checked,
        )
        return replace(table, held_out=_check(table, plan, solve)) if plan.checked else table


def _nodes_of(counts: tuple[int, ...]) -> FloatArray:
    """All combinations of the nodes, shape ``(M, A)``."""
    nodes = list(product(*(zeros(count).tolist() for count in counts)))
    return np.array(nodes).reshape(len(nodes), len(counts))


def _outputs(
    task: tuple[Ball, FloatArray], nodes: int, contact: str = LINE, cells: int = CELLS
) -> FloatArray:
    ball, log_number = task
    return ball.outputs(log_number, nodes, contact=contact, cells=cells)


def _at(terms: FloatArray, places: FloatArray) -> FloatArray:
    """Series in the axes at M places, shape ``(M, columns)``."""
    return summed(terms, list(places.T[:, :, None]), len(places))[:, 0]


def _anchors(ball: Ball, contact: str) -> tuple[float, float]:
    return ball.anchors() if contact == LINE else ball.point_anchors(FEW_CELLS)


def _finer_at(counts: tuple[int, ...]) -> tuple[int, ...]:
    """Numbers of nodes of the axes at which a ball is solved on many cells."""
    return tuple(max(min(count, _FINER_AT_LEAST), round(_FINER * count)) for count in counts)


def _ends_of(plan: FilmTablePlan) -> tuple[float, float]:
    """ln of the smallest and largest end of the drag in a table, over the radius of the contact."""
    axes = plan.axes
    # a/R goes as (F R/E1)^(1/3)/R, and the ends of F R/E1 and of R may meet
    products = axes.low[3] + axes.low[4] - axes.high[1], axes.high[3] + axes.high[4] - axes.low[1]
    radii = axes.high[3], axes.low[3]
    places = [
        [0.0, 0.0, 0.0, radius, product - radius, 0.0]
        for radius, product in zip(radii, products, strict=True)
    ]
    ends = log_end(list(np.array(places).T), plan.poisson_ratio_bulk, plan.inlet_length)
    return float(ends.min()) - _SPARE, float(ends.max()) + _SPARE


def _end_coordinates(
    plan: FilmTablePlan, log_parameters: FloatArray, ends: tuple[float, float]
) -> FloatArray:
    """The end of the drag of balls, −1 … 1, for ln of their parameters, SI, shape ``(M, 6)``."""
    log_ends = log_end(list(log_parameters.T), plan.poisson_ratio_bulk, plan.inlet_length)
    return end_coordinate(log_ends, *ends)


def held_out_places(table: FilmTable, plan: FilmTablePlan, count: int) -> tuple[FloatArray, FloatArray]:
    """Random parameters that a table holds, ln in SI, shape ``(M, 6)``, and ln λ, shape ``(M,)``."""
    rng = np.random.default_rng(20130)
    axes = table.axes
    points: list[FloatArray] = []
    while len(points) < count:
        drawn = axes.tied(rng.uniform(axes.low, axes.high))
        strain = film_scales(list(drawn), table.poisson_ratio_bulk).strain
        if strain <= np.log(plan.largest_strain) and axes.contains(list(drawn)):
            points.append(drawn)
    drawn = np.array(points)
    scales = film_scales(list(drawn.T), table.poisson_ratio_bulk)
    thickest = np.log(THICKEST_FILM) - 2 * scales.strain
    films = contract(table, list(drawn.T[:, :, None]), 1)
    slowest = np.minimum((films.anchor + films.unit * (SLOWEST - 0.2))[:, 0], thickest)
    return drawn, rng.uniform(slowest, thickest)


def _check(table: FilmTable, plan: FilmTablePlan, solve: Tasks) -> FloatArray:
    """Median, 99th percentile and largest error of μ at random parameters and speeds, for a slow μ of 1."""
    drawn, number = held_out_places(table, plan, plan.checked)
    scales = film_scales(list(drawn.T), table.poisson_ratio_bulk)
    balls = [plan.ball(point) for point in drawn]
    # σ_f for which μ of small contacts is about 1 at rest
    shear_stress = np.array(
        [np.sqrt(np.pi * plan.area_correction * ball.twice_variance) / 2 for ball in balls]
    )
    outputs_of = partial(_outputs, nodes=_CHECK_NODES, contact=plan.contact, cells=_CHECK_CELLS)
    found = solve("check", outputs_of, zip(balls, number[:, None], strict=True))
    outputs = found[..., 0]
    slope = np.exp(scales.strain)
    direct = (
        shear_stress * np.exp(outputs[:, 1]) / [ball.stiffness for ball in balls]
        + np.exp(outputs[:, 3]) / np.pi * slope
    )
    if plan.contact == LINE:
        direct = direct + np.exp(number + outputs[:, 2]) / (3 * np.pi) * slope
    parameters = dict(zip(FILM_PARAMETERS, np.exp(drawn.T), strict=True))
    products = np.exp(number - scales.number_per_product)
    tabulated = tabulated_friction(
        table,
        products,
        balls=LubricatedBalls(
            parameters=parameters, frictional_shear_stress=shear_stress, largest_strain=plan.largest_strain
        ),
    ).friction_coefficient
    errors = np.abs(tabulated / direct - 1)
    return np.array([np.quantile(errors, 0.5), np.quantile(errors, 0.99), errors.max()])
