"""The film between a ball and a lubricated, soft, rough solid, in two dimensions: separation, pressures and drag.

Lengths along the surface are counted in the Hertz radius a, pressures in the Hertz maximum p_H, separations in a²/R. Reynolds'
equation with the mean speed v/2 of the two surfaces becomes ``div(φ_p H³ ∇P) = λ ∂(H + Φ_s)/∂x`` with
``λ = 6 η v R²/(a³ p_H)``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, BoolArray, FloatArray, IndexArray
from skinbayes.contact.hertz import sphere_contact
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import AsperityLaw
from skinbayes.lubrication.film import roughness_of
from skinbayes.lubrication.flow_factors import FlowFactors
from skinbayes.lubrication.newton import Law, Transport
from skinbayes.lubrication.point_drag import point_drag_integrals
from skinbayes.lubrication.point_grid import PointGrid, point_grid
from skinbayes.lubrication.point_newton import LOAD, PointSolver
from skinbayes.lubrication.rheology import Rheology
from skinbayes.lubrication.sweep import sweep
from skinbayes.lubrication.transport import no_asperities, transport_of

CELLS = 360
"""Cells of half the contact and its surroundings unless told otherwise."""

_RINGS_PER_RAY, _RINGS_PER_RAY_OF_FEW = 2.5, 4.0
_FEW = 300  # cells below which rings matter more: the edge of a thin film is narrower than an angle is coarse
_APPROACHES = (0.0, 1.0, 3.0)  # of first guesses, beside a film thicker than the asperities
_WEAKEST = 1e-7  # of the squared roughness: below this λ everything is linear in λ
_FASTEST = 1e5  # λ beyond which an inlet without end is longer than any grid
_FASTEST_WITH_END = 1e10
_SHORTEST_REACH = 20.0
_WIDE, _WIDER = (
    2.0,
    6.0,
)  # λ up to which films are as wide as the contact, and the range of a grid for wider ones
_PART_OF_WIDTH = 0.3


class LubricatedPointFilms(NamedTuple):
    """Films under a ball at K speeds; x = y = 0 is its middle and the fluid enters at negative x.

    Attributes
    ----------
    position : x of the cells with y > 0, m, shape ``(K, n)``; y and −y are alike
    lateral_position : y of these cells, m, shape ``(K, n)``
    separation : mean separation ū, m, shape ``(K, n)``
    fluid_pressure : p_f, Pa, shape ``(K, n)``
    asperity_pressure : p_a, Pa, shape ``(K, n)``
    couette : friction coefficient of the shear flow, ∫φ ηv/u dA/F_N, dimensionless, shape ``(K,)``
    pressure_flow : friction coefficient of the pressure flow, ½∫u ∂p_f/∂x dA/F_N, dimensionless, shape ``(K,)``
    asperity_load_fraction : load carried by asperities over load, dimensionless, shape ``(K,)``
    minimum_film : smallest ū, m, shape ``(K,)``
    central_film : ū under the middle of the ball, m, shape ``(K,)``
    lubrication_number : λ = 6 η v R²/(a³ p_H), dimensionless, shape ``(K,)``
    load_weight : area of the cells with their mirror images, m², shape ``(K, n)``: weights that integrate over the plane
    """

    position: FloatArray
    lateral_position: FloatArray
    separation: FloatArray
    fluid_pressure: FloatArray
    asperity_pressure: FloatArray
    couette: FloatArray
    pressure_flow: FloatArray
    asperity_load_fraction: FloatArray
    minimum_film: FloatArray
    central_film: FloatArray
    lubrication_number: FloatArray
    load_weight: FloatArray


def lubricated_point_films(
    speed_viscosity_product: ArrayLike,
    *,
    normal_force: float,
    sphere_radius: float,
    reduced_modulus: float,
    asperities: AsperityLaw | None = None,
    flow_factors: FlowFactors | None = None,
    rheology: Rheology | None = None,
    cells: int = CELLS,
    inlet_length: float | None = None,
) -> LubricatedPointFilms:
    """Mixed lubrication of a rigid ball that slides on a soft rough solid, solved in two dimensions (Sect. 6 of the paper).

    ``H = H0 + r²/2 + (2/π²) ∫P/ρ dA``, ``∫P dA = 2π/3``, ``P = P_f + P_a(H)``,
    ``div(φ_p H³ ∇P_f) = λ ∂(H + Φ_s)/∂x`` with P_f ≥ 0, where ρ is the distance of two places: where full film would pull, the
    fluid cavitates and the film that remains is carried along without a change of its volume.

    Parameters
    ----------
    speed_viscosity_product : η v, N/m, ≥ 0, shape ``(K,)``; with a rheology η0 v. At 0 asperities carry everything; smooth
        surfaces have no film then.
    normal_force : F_N, N, > 0
    sphere_radius : R, m, > 0
    reduced_modulus : E* of the solid on the scale of the contact, Pa, > 0
    asperities : p_a against ū, from `asperity_law`; None for smooth surfaces
    flow_factors : None for trivial ones
    rheology : viscosity against local shear rate v/u; None for a Newtonian liquid
    cells : number of cells of half the plane, dimensionless, ≥ 40, about
    inlet_length : m, > 0: liquid fills the gap up to this distance from the edge of the contact of Hertz, and nothing is beyond;
        None for liquid without end, with drag up to the edge of the ball

    Returns
    -------
    films : `LubricatedPointFilms`; nan in rows where no film was found or an argument is impossible

    Raises
    ------
    InputError
        if there are fewer than 40 cells, or the inlet has no length

    Notes
    -----
    The parabola goes on without end, but shear stress and pressure flow are counted up to the edge of the ball only, r = R: their
    sums would grow without bound as ln r. Where the contact is so wide that it nears the edge, the end keeps
    outside of it, at ``(R⁴ + a⁴)^(1/4)``: 1 % beyond R at a/R = 0.45. The reference pressure is that of the cavity. With an
    ``inlet_length`` the grid, the pressure of the liquid and its drag all end at that distance from the contact.

    References
    ----------
    Persson & Scaraggi, J. Phys.: Condens. Matter 21 (2009) 185002, doi 10.1088/0953-8984/21/18/185002.
    Johnson, Contact Mechanics (1985), Chap. 3 and 4, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> films = lubricated_point_films([0.1], normal_force=0.2, sphere_radius=8e-3, reduced_modulus=20e3 / 0.75)
    >>> print(f"{films.central_film[0]:.2e} m, {films.couette[0]:.3f}")
    1.66e-04 m, 0.179
    """
    return point_films_of(
        np.atleast_1d(np.asarray(speed_viscosity_product, dtype=np.float64)),
        normal_force=normal_force,
        sphere_radius=sphere_radius,
        reduced_modulus=reduced_modulus,
        asperities=asperities,
        flow_factors=flow_factors,
        rheology=rheology,
        cells=cells,
        inlet_length=inlet_length,
    )[0]


@np.errstate(all="ignore")
def point_films_of(
    product: FloatArray,
    *,
    normal_force: float,
    sphere_radius: float,
    reduced_modulus: float,
    asperities: AsperityLaw | None,
    flow_factors: FlowFactors | None,
    rheology: Rheology | None,
    cells: int,
    inlet_length: float | None = None,
    respond: Callable[[PointGrid], PointGrid] | None = None,
) -> tuple[LubricatedPointFilms, FloatArray]:
    """`lubricated_point_films`, on another solid if ``respond`` puts it into a grid; and its hysteresis ∫p (∂w/∂x) dA/F_N."""
    if cells < 40:
        raise InputError(f"cells is {cells}, but must be at least 40.")
    if inlet_length is not None and not 0 < inlet_length < np.inf:
        raise InputError(f"inlet_length is {inlet_length:g} m, but must be finite and > 0 m.")
    hertz = sphere_contact(normal_force, sphere_radius, reduced_modulus=reduced_modulus)
    radius, peak = float(hertz.contact_radius), float(hertz.maximum_pressure)
    slope, height = radius / sphere_radius, radius * radius / sphere_radius
    per_product = point_number_per_product(radius, peak, sphere_radius)
    wanted = per_product * product
    known = (wanted > 0 if asperities is None else wanted >= 0) & (
        wanted <= (_FASTEST if inlet_length is None else _FASTEST_WITH_END)
    )
    known = known & (0 < normal_force < np.inf)
    law: Law = no_asperities if asperities is None else asperities.scaled(height, peak)
    rough, tail = (0.0, 0.0) if asperities is None else roughness_of(law)
    number = np.maximum(wanted, _WEAKEST * rough**2)
    end = end_of_drag(slope) if inlet_length is None else 1 + inlet_length / radius
    transport = transport_of(flow_factors, rheology, height, per_product)
    speed = None if rheology is None else product / rheology.low_shear_viscosity
    films = _nothing(product.size, cells_on_grid(cells))._replace(lubrication_number=wanted)
    hysteresis = np.full(product.size, np.nan)
    fainter = wanted / number  # 1 but for the weakest flows, of which everything is linear in λ
    for rows, grid, film, pressure in point_sweeps(
        number,
        known,
        law,
        transport,
        rough=rough,
        tail=tail,
        end=end,
        cells=cells,
        endless=inlet_length is None,
        respond=respond,
    ):
        hysteresis[rows] = slope / LOAD * _work(grid, pressure)
        carried = law(film)[0] + 0.0 * film
        fluid = pressure - carried
        drag = point_drag_integrals(
            grid, film, fluid, number[rows], end=end, height=height, flow_factors=flow_factors,
            rheology=rheology, speed=None if speed is None else speed[rows],
        )  # fmt: skip
        faint = fainter[rows]
        films.position[rows] = (grid.radius * np.cos(grid.angle) + grid.centre) * radius
        films.lateral_position[rows] = grid.radius * np.sin(grid.angle) * radius
        films.load_weight[rows] = grid.area * radius**2
        films.separation[rows] = film * height
        films.fluid_pressure[rows] = fluid * (peak * faint)[:, None]
        films.asperity_pressure[rows] = carried * peak
        films.couette[rows] = wanted[rows] * slope / (4 * np.pi) * drag.couette
        films.pressure_flow[rows] = faint * 3 * slope / (4 * np.pi) * drag.pressure_flow
        films.asperity_load_fraction[rows] = 1 - faint * (1 - carried @ grid.area / LOAD)
        films.minimum_film[rows] = film.min(axis=1) * height
        films.central_film[rows] = _at_middle(grid, film) * height
    return films, hysteresis


def _at_middle(grid: PointGrid, film: FloatArray) -> FloatArray:
    """H under the middle of the ball, shape ``(K,)``: the innermost ring, or the ray towards it if it is elsewhere."""
    middle = film[:, : grid.rays].mean(axis=1)
    if grid.centre == 0:
        return np.asarray(middle)
    ray = grid.rays - 1 if grid.centre > 0 else 0
    places = np.concatenate([[0.0], grid.radius[ray :: grid.rays]])
    found = [
        np.interp(abs(grid.centre), places, [start, *row])
        for start, row in zip(middle, film[:, ray :: grid.rays], strict=True)
    ]
    return np.array(found)


def _work(grid: PointGrid, pressure: FloatArray) -> FloatArray:
    """∫P (∂W/∂x) dA of the depth W, dimensionless, shape ``(K,)``."""
    slope = 0.0 * pressure if grid.drag is None else pressure @ grid.drag.T
    return np.asarray((slope * pressure) @ grid.area)


def _nothing(rows: int, cells: int) -> LubricatedPointFilms:
    """Films of which nothing is known."""
    resolved = np.full((6, rows, cells), np.nan)
    numbers = np.full((6, rows), np.nan)
    return LubricatedPointFilms(
        resolved[0], resolved[1], resolved[2], resolved[3], resolved[4],
        numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], resolved[5],
    )  # fmt: skip


def point_sweeps(
    number: FloatArray,
    known: BoolArray,
    law: Law,
    transport: Callable[[float], Transport],
    *,
    rough: float,
    tail: float,
    end: float,
    cells: int,
    endless: bool = True,
    respond: Callable[[PointGrid], PointGrid] | None = None,
) -> Iterator[tuple[IndexArray, PointGrid, FloatArray, FloatArray]]:
    """Rows of lubrication numbers that share a grid, the grid, and their H and P, dimensionless, shape ``(K, n)``.

    Unless the liquid is ``endless`` it ends where the drag does.
    """
    for rows in _by_reach(number, known) if endless else [np.flatnonzero(known)]:
        grid = grid_of(number[rows], rough, tail, end=end, cells=cells, endless=endless)
        if respond is not None:
            grid = respond(grid)
        solver = PointSolver(grid, law, float(number[rows].min()), endless=endless)
        states, _ = sweep(number[rows], solver, transport, (rough, *(rough + more for more in _APPROACHES)))
        missing = np.full(grid.radius.size, np.nan)
        yield (
            rows,
            grid,
            np.array([missing if state is None else solver.separation(state) for state in states]),
            np.array([missing if state is None else state.pressure for state in states]),
        )


def point_number_per_product(contact_radius: float, maximum_pressure: float, sphere_radius: float) -> float:
    """λ/(ηv) = 6 R²/(a³ p_H), m/N."""
    return 6 * sphere_radius**2 / (contact_radius**3 * maximum_pressure)


def end_of_drag(slope: float) -> float:
    """Radius, in units of the contact's, up to which drag is counted, for a/R: the edge of the ball, but outside the contact."""
    return float((1 + slope**-4) ** 0.25)


def _by_reach(number: FloatArray, known: BoolArray) -> list[IndexArray]:
    """Rows whose films are as wide as the contact, and those of wider and wider ones: one grid does not hold them all."""
    group = np.ceil(np.log(np.maximum(number, _WIDE) / _WIDE) / np.log(_WIDER) - 1e-9)
    return [np.flatnonzero(known & (group == value)) for value in np.unique(group[known])]


def grid_of(
    number: FloatArray, rough: float, tail: float, *, end: float, cells: int, endless: bool = True
) -> PointGrid:
    """Grid for lubrication numbers of shape ``(K,)``; ``rough``, ``tail``: H at P_a = 1 and its decay length.

    It reaches as far as fluid pressure (as λ/r³), asperities (as exp(−r²/2 tail)) or the drag that is counted. The rings are
    finest at the edge of the contact, down to the width over which the thinnest film opens, at any speed if there are asperities;
    where the film of a rigid ball, which is 0.6 λ wide, is wider than the contact, they are as wide as a part of it. Liquid that
    is not ``endless`` reaches to ``end``.
    """
    smallest, largest = float(number.min()), float(number.max())
    reach = max(_SHORTEST_REACH, 1.1 * end, 3 + 6 * np.sqrt(tail), 12 * largest)
    # asperities press where the film is thinnest, in a seam at the exit narrower than the film alone would have it
    thinnest = rough if rough > 0 else 0.4 * min(smallest, 1.0) ** 0.6
    edge = float(np.clip(2.4 * thinnest ** (2 / 3), 0.03, 0.15))
    if endless and smallest > _WIDE:
        edge = max(edge, _PART_OF_WIDTH * smallest)
    return point_grid(_rings(cells), _rays(cells), edge, float(reach if endless else end))


def cells_on_grid(cells: int) -> int:
    """Number of cells of a grid for which so many were asked."""
    return _rings(cells) * _rays(cells)


def _rays(cells: int) -> int:
    return max(round(np.sqrt(cells / (_RINGS_PER_RAY if cells >= _FEW else _RINGS_PER_RAY_OF_FEW))), 4)


def _rings(cells: int) -> int:
    return round(cells / _rays(cells))
