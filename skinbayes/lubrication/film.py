"""The film between a cylinder and a lubricated, soft, rough solid: separation, pressures and drag at many speeds.

Lengths along the surface are counted in b, pressures in p_H, separations in b²/Rc (line contact of Hertz). Reynolds'
equation with the mean speed v/2 of the two surfaces, ``d/dx[φ_p u³/(12η) dp/dx] = (v/2) d/dx[u + Φ_s]``, becomes
``d/dX[φ_p H³ dP/dX] = λ d/dX[H + Φ_s]``: the left side carries p_H (b²/Rc)³/(12 η b²), the right side (v/2)(b²/Rc)/b, so that
``λ = 6 η v Rc²/(b³ p_H)``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.line_contact import HertzLine, line_contact
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import AsperityLaw
from skinbayes.lubrication.drag import drag_integrals
from skinbayes.lubrication.flow_factors import FlowFactors
from skinbayes.lubrication.grid import LineGrid, line_grid
from skinbayes.lubrication.newton import LOAD, Law, Solver
from skinbayes.lubrication.rheology import Rheology
from skinbayes.lubrication.sweep import sweep
from skinbayes.lubrication.transport import no_asperities, transport_of

NODES = 80
"""Nodes across the contact unless told otherwise. Friction in the case of Fig. 13 is then within 0.3 % of that on ten times
as many; over random balls, skins and speeds the largest error of a curve is 0.3 % in the median and 1.4 % at worst."""

_WEAKEST = (
    1e-7  # of the squared roughness: below this λ the fluid carries about that share and all is linear in λ
)

_THICKER = (1.0, 2.0, 4.0)  # first guesses of the approach over a film thicker than the asperities

_FASTEST = 1e10  # λ beyond which the parabola drowns in rounding


class LubricatedFilms(NamedTuple):
    """Films under a cylinder at K speeds; x = 0 is the middle of the cylinder and the fluid enters at negative x.

    Attributes
    ----------
    position : x, m, shape ``(N,)``
    separation : mean separation ū(x), m, shape ``(K, N)``
    fluid_pressure : p_f(x), Pa, shape ``(K, N)``
    asperity_pressure : p_a(x), Pa, shape ``(K, N)``
    couette : friction coefficient of the shear flow, ∫φ ηv/u dx/f_N, dimensionless, shape ``(K,)``
    pressure_flow : friction coefficient of the pressure flow, ½∫u dp_f/f_N, dimensionless, shape ``(K,)``
    asperity_load_fraction : load carried by asperities over load, dimensionless, shape ``(K,)``
    minimum_film : smallest ū, m, shape ``(K,)``
    central_film : ū under the middle of the cylinder, m, shape ``(K,)``
    lubrication_number : λ = 6 η v Rc²/(b³ p_H), dimensionless, shape ``(K,)``
    load_weight : weights that integrate over x, m, shape ``(N,)``
    """

    position: FloatArray
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


def lubricated_films(
    speed_viscosity_product: ArrayLike,
    *,
    load_per_length: float,
    cylinder_radius: float,
    reduced_modulus: float,
    asperities: AsperityLaw | None = None,
    flow_factors: FlowFactors | None = None,
    rheology: Rheology | None = None,
    nodes: int = NODES,
    inlet_length: float | None = None,
) -> LubricatedFilms:
    """Mixed lubrication of a rigid cylinder that slides on a soft rough solid (Sect. 6 of the paper, Figs. 11, 13 and 15).

    ``H = H0 + X²/2 − (1/π)∫P ln|X − X′| dX′``, ``∫P dX = π/2``, ``P = P_f + P_a(H)``,
    ``d/dX[φ_p H³ P_f′] = λ d/dX[H + Φ_s]`` with P_f ≥ 0: where full film would pull, the fluid cavitates and the film that
    remains is carried along without a change of its volume.

    Parameters
    ----------
    speed_viscosity_product : η v, N/m, ≥ 0, shape ``(K,)``; with a rheology η0 v. At 0 asperities carry everything; smooth
        surfaces have no film then.
    load_per_length : f_N, N/m, > 0
    cylinder_radius : Rc, m, > 0
    reduced_modulus : E* of the solid on the scale of the contact, Pa, > 0
    asperities : p_a against ū, from `asperity_law`; None for smooth surfaces
    flow_factors : None for trivial ones
    rheology : viscosity against local shear rate v/u; None for a Newtonian liquid
    nodes : number of places across the contact, dimensionless, ≥ 4
    inlet_length : m, > 0: liquid fills the gap up to this distance from the edge of the contact of Hertz, and nothing is beyond;
        None for liquid without end

    Returns
    -------
    films : `LubricatedFilms`; nan in rows where no film was found or an argument is impossible

    Raises
    ------
    InputError
        if there are fewer than four nodes

    Notes
    -----
    The parabola and the liquid are continued to both sides without end: shear stress far out is counted. The drag of the
    cavity is that of the fraction θ of its width that is liquid, ``ηvθ/u`` with θu constant. The reference pressure is that of
    the cavity. Nothing is said about the range of validity here; see `stribeck_curve`.

    Where λ is so small that the fluid carries less than about 1e-7 of the load, the fluid's part is scaled in proportion to
    λ. Smooth surfaces need λ > 1e-6; beyond λ = 1e10 there is no film.

    References
    ----------
    Persson & Scaraggi, J. Phys.: Condens. Matter 21 (2009) 185002, doi 10.1088/0953-8984/21/18/185002.
    Persson & Scaraggi, Eur. Phys. J. E 34 (2011) 113, doi 10.1140/epje/i2011-11113-9.

    Examples
    --------
    >>> films = lubricated_films([0.1], cylinder_radius=4.533e-3, load_per_length=21.92, reduced_modulus=20e3 / 0.75)
    >>> print(f"{films.central_film[0]:.2e} m, {films.couette[0]:.3f}")
    1.94e-04 m, 0.138
    """
    return films_of(
        np.atleast_1d(np.asarray(speed_viscosity_product, dtype=np.float64)),
        load_per_length=load_per_length,
        cylinder_radius=cylinder_radius,
        reduced_modulus=reduced_modulus,
        asperities=asperities,
        flow_factors=flow_factors,
        rheology=rheology,
        nodes=nodes,
        inlet_length=inlet_length,
    )


@np.errstate(all="ignore")
def films_of(
    product: FloatArray,
    *,
    load_per_length: float,
    cylinder_radius: float,
    reduced_modulus: float,
    asperities: AsperityLaw | None,
    flow_factors: FlowFactors | None,
    rheology: Rheology | None,
    nodes: int,
    respond: Callable[[LineGrid], LineGrid] | None = None,
    inlet_length: float | None = None,
) -> LubricatedFilms:
    """`lubricated_films`, on another solid if ``respond`` puts its kernel, and nodes where it needs them, into a grid."""
    if nodes < 4:
        raise InputError(f"nodes is {nodes}, but must be at least 4.")
    hertz = line_contact(load_per_length, cylinder_radius, reduced_modulus=reduced_modulus)
    wanted = lubrication_number_per_product(cylinder_radius, hertz) * product
    known = (wanted > 0 if asperities is None else wanted >= 0) & (wanted <= _FASTEST)
    if not (known.any() and 0 < load_per_length < np.inf):
        return _no_films(product.size, nodes)
    height = float(hertz.half_width**2 / cylinder_radius)
    law: Law = (
        no_asperities if asperities is None else asperities.scaled(height, float(hertz.maximum_pressure))
    )
    rough, tail = (0.0, 0.0) if asperities is None else roughness_of(law)
    number = np.maximum(np.where(known, wanted, wanted[known].min()), _WEAKEST * rough**2)
    end = None if inlet_length is None else 1 + inlet_length / float(hertz.half_width)
    grid = grid_for(float(number.min()), float(number.max()), rough, tail, nodes, end)
    if respond is not None:
        grid = respond(grid)
    transport = transport_of(
        flow_factors, rheology, height, lubrication_number_per_product(cylinder_radius, hertz)
    )
    thick = [factor * (1.5 + rough) for factor in _THICKER]
    found, _ = sweep(number, Solver(grid, law, endless=end is None), transport, thick)

    states = [state if here else None for state, here in zip(found, known, strict=True)]
    missing = np.full(grid.position.size, np.nan)
    pressure = np.array([missing if state is None else state.pressure for state in states])
    approach = np.array([np.nan if state is None else state.approach for state in states])
    film = approach[:, None] + np.square(grid.position) / 2 - pressure @ grid.kernel.T
    carried = law(film)[0] + 0.0 * film
    fluid = pressure - carried
    speed = None if rheology is None else product / rheology.low_shear_viscosity
    drag = drag_integrals(
        grid, film, fluid, number, height, flow_factors, rheology, speed, endless=end is None
    )
    slope = float(hertz.half_width / cylinder_radius)
    fainter = wanted / number  # 1 but for the weakest flows, of which everything is linear in λ
    return LubricatedFilms(
        position=grid.position * hertz.half_width,
        separation=film * height,
        fluid_pressure=fluid * (hertz.maximum_pressure * fainter)[:, None],
        asperity_pressure=carried * hertz.maximum_pressure,
        asperity_load_fraction=1 - fainter * (1 - carried @ grid.weight / LOAD),
        couette=wanted / (3 * np.pi) * slope * drag.couette,
        pressure_flow=fainter * slope / np.pi * drag.pressure_flow,
        minimum_film=film.min(axis=1) * height,
        central_film=_at_middle(grid, film) * height,
        lubrication_number=wanted,
        load_weight=grid.weight * hertz.half_width,
    )


def _no_films(count: int, nodes: int) -> LubricatedFilms:
    """What is known of films that cannot be."""
    place, row, table = (np.full(shape, np.nan) for shape in (nodes, count, (count, nodes)))
    return LubricatedFilms(place, table, table, table, row, row, row, row, row, row, place)


def lubrication_number_per_product(cylinder_radius: float, hertz: HertzLine) -> float:
    """λ/(ηv) = 6 Rc²/(b³ p_H), m/N."""
    return float(6 * cylinder_radius**2 / (hertz.half_width**3 * hertz.maximum_pressure))


def grid_for(
    smallest: float, largest: float, rough: float, tail: float, nodes: int, end: float | None = None
) -> LineGrid:
    """Grid for lubrication numbers from ``smallest`` to ``largest``; ``rough``, ``tail``: H at P_a = 1 and its decay length.

    The inlet is as long as fluid pressure (as λ/X³) or asperities (as exp(−X²/2 tail)) reach, the edges are resolved down to
    the width over which the thinnest film opens, its 2/3rd power. Inlet and outlet are as long as ``end``, if that is given.
    """
    reach = 6 * np.sqrt(tail)
    inlet = float(3 + reach + 12 * np.sqrt(largest)) if end is None else end
    outlet = float(2 + reach + 2 * np.sqrt(largest)) if end is None else end
    thinnest = max(0.4 * min(smallest, 1.0) ** 0.6, rough)
    return line_grid(inlet, outlet, nodes, float(np.clip(1.4 * thinnest ** (2 / 3), 2e-3, 0.15)))


def roughness_of(law: Law) -> tuple[float, float]:
    """H at P_a = 1 and the decay length of an asperity law, dimensionless."""
    assert isinstance(law, AsperityLaw)
    return law.separation_at(1.0), law.decay_length


def _at_middle(grid: LineGrid, film: FloatArray) -> FloatArray:
    """H at X = 0: parabola through the three nearest nodes."""
    place = int(np.clip(np.argmin(np.abs(grid.position)), 1, grid.position.size - 2))
    x, y = grid.position[place - 1 : place + 2], film[:, place - 1 : place + 2]
    basis = [
        x[(i + 1) % 3] * x[(i + 2) % 3] / ((x[i] - x[(i + 1) % 3]) * (x[i] - x[(i + 2) % 3]))
        for i in range(3)
    ]
    return np.asarray(y @ np.array(basis))
