"""The film between a ball and a lubricated, rough, viscoelastic solid, in two dimensions."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.hertz import sphere_contact
from skinbayes.contact.viscoelastic import ViscoelasticMaterial
from skinbayes.contact.viscoelastic_line_contact import Passage, passage_of
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import AsperityLaw
from skinbayes.lubrication.flow_factors import FlowFactors
from skinbayes.lubrication.point_dry import edges
from skinbayes.lubrication.point_film import CELLS, cells_on_grid, point_films_of
from skinbayes.lubrication.point_grid import PointGrid
from skinbayes.lubrication.point_memory import point_memory

_BY_CELL = (
    "position",
    "lateral_position",
    "separation",
    "fluid_pressure",
    "asperity_pressure",
    "load_weight",
)


@dataclass(frozen=True, eq=False, kw_only=True)
class ViscoelasticPointFilms:
    """Films under a ball at K pairs of speed and viscosity; x = y = 0 is its middle, the fluid enters at negative x.

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
    hysteresis : friction coefficient of the solid's loss, ∫p (∂w/∂x) dA/F_N with its depth w, dimensionless, shape ``(K,)``
    reference_modulus : |E*| at the frequency v/a, Pa, shape ``(K,)``
    contact_radius : a of the contact of Hertz with that modulus, m, shape ``(K,)``
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
    hysteresis: FloatArray
    reference_modulus: FloatArray
    contact_radius: FloatArray
    load_weight: FloatArray


def viscoelastic_point_films(
    speed: ArrayLike,
    viscosity: ArrayLike,
    *,
    normal_force: float,
    sphere_radius: float,
    material: ViscoelasticMaterial,
    asperities: AsperityLaw | None = None,
    flow_factors: FlowFactors | None = None,
    cells: int = CELLS,
) -> ViscoelasticPointFilms:
    """Mixed lubrication of a rigid ball that slides on a viscoelastic rough solid, in two dimensions (Sect. 6.2, Fig. 14).

    The equations of `lubricated_point_films` with the deflection ``w(q) = 2 p(q)/(|q| E*(q_x v))`` of a solid that passes under
    the ball: each retardation time of its creep compliance remembers the deflection upstream. Friction depends on v through the
    Deborah number vτ/a, and on ηv.

    Parameters
    ----------
    speed : v, m/s, ≥ 0, shape ``(K,)`` or a scalar
    viscosity : η, Pa s, ≥ 0, shape ``(K,)`` or a scalar
    normal_force : F_N, N, > 0
    sphere_radius : R, m, > 0
    material : of the half-space, one material, moduli in Pa
    asperities : p_a against ū, from `asperity_law`, of skin as it is at the frequency of the contact; None for smooth surfaces
    flow_factors : None for trivial ones
    cells : number of cells of half the plane, dimensionless, ≥ 40, about

    Returns
    -------
    films : `ViscoelasticPointFilms`; nan in rows where no film was found or an argument is impossible

    Raises
    ------
    InputError
        if there are fewer than 40 cells

    Notes
    -----
    Linear and quasi-static: v is far below the speed of sound. Drag of the liquid is counted up to the edge of the ball, as in
    `lubricated_point_films`. Cells are finest around the dry contact, which loss moves upstream. Smooth films thinner than about
    0.003 a²/R are not found where loss is strong; with asperities no such limit was met.

    References
    ----------
    Persson & Scaraggi, J. Phys.: Condens. Matter 21 (2009) 185002, doi 10.1088/0953-8984/21/18/185002.
    Johnson, Contact Mechanics (1985), Sect. 9.4, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> from skinbayes.contact import standard_linear_solid
    >>> tissue = standard_linear_solid(20e3, 28e3, relaxation_time=0.1)
    >>> films = viscoelastic_point_films([1e-5, 0.01], [1e4, 10.0], normal_force=0.2, sphere_radius=8e-3, material=tissue)
    >>> print(films.central_film.round(6), films.couette.round(3), films.hysteresis.round(3))
    [0.000166 0.000153] [0.179 0.184] [0.    0.021]
    """
    given = (np.asarray(x, dtype=np.float64) for x in (speed, viscosity))
    speeds, viscosities = np.broadcast_arrays(*(np.atleast_1d(x) for x in given))
    if cells < 40:
        raise InputError(f"cells is {cells}, but must be at least 40.")
    found = {entry.name: np.full(speeds.shape, np.nan) for entry in fields(ViscoelasticPointFilms)}
    for name in _BY_CELL:
        found[name] = np.full((*speeds.shape, cells_on_grid(cells)), np.nan)
    for value in np.unique(speeds[(speeds >= 0) & (speeds < np.inf) & (viscosities >= 0)]).tolist():
        rows = speeds == value
        scales = passage_under_ball(material, value, normal_force=normal_force, sphere_radius=sphere_radius)
        if not 0 < scales.half_width < np.inf:
            continue
        films, hysteresis = point_films_of(
            value * viscosities[rows],
            normal_force=normal_force,
            sphere_radius=sphere_radius,
            reduced_modulus=scales.modulus,
            asperities=asperities,
            flow_factors=flow_factors,
            rheology=None,
            cells=cells,
            respond=partial(passing, scales=scales),
        )
        found["hysteresis"][rows] = hysteresis
        found["reference_modulus"][rows], found["contact_radius"][rows] = scales.modulus, scales.half_width
        for name in found.keys() & set(films._fields):
            found[name][rows] = getattr(films, name)
    return ViscoelasticPointFilms(**found)


def passage_under_ball(
    material: ViscoelasticMaterial, speed: float, *, normal_force: float, sphere_radius: float
) -> Passage:
    """Scales of a ball at v, m/s, under F_N, N, with R, m; modulus at v/a and contact radius a belong to each other."""
    scales = passage_of(
        material,
        speed,
        lambda modulus: float(
            sphere_contact(normal_force, sphere_radius, reduced_modulus=modulus).contact_radius
        ),
    )
    assert isinstance(scales, Passage)  # of a material of relaxation times
    return scales


def passing(grid: PointGrid, scales: Passage) -> PointGrid:
    """The grid stretched to the dry contact on a solid that passes, with its kernel and the slope of its depth."""
    solid: dict[str, Any] = {
        "instantaneous": scales.instantaneous, "compliance": scales.compliance, "length": scales.length,
    }  # fmt: skip
    lead, trail = edges(**solid)
    if np.isfinite(trail - lead):
        grid = grid.stretched((trail - lead) / 2, (trail + lead) / 2)
    memory = point_memory(grid, **solid)
    # work is even in the direction of the passage: the mean over both has no error of the slope that does none
    cells = np.arange(grid.radius.size).reshape(-1, grid.rays)[:, ::-1].ravel()
    both = (memory.slope + memory.slope[np.ix_(cells, cells)]) / 2
    return grid._replace(kernel=memory.deflection @ grid.kernel, drag=both @ grid.kernel)
