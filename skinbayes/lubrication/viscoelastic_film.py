"""The film between a cylinder and a lubricated, rough, viscoelastic solid: speed and viscosity act apart from each other."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.moving_kernel import MovingKernel
from skinbayes.contact.viscoelastic_line_contact import (
    AnyMaterial,
    AnyPassage,
    edges,
    hysteresis_integral,
    passage,
)
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import AsperityLaw
from skinbayes.lubrication.film import NODES, LubricatedFilms, films_of
from skinbayes.lubrication.flow_factors import FlowFactors
from skinbayes.lubrication.grid import LineGrid
from skinbayes.lubrication.newton import LOAD


@dataclass(frozen=True, eq=False, kw_only=True)
class ViscoelasticFilms:
    """Films under a cylinder at K pairs of speed and viscosity; x = 0 is its middle, the fluid enters at negative x.

    Attributes
    ----------
    position : x, m, shape ``(K, N)``
    separation : mean separation ū(x), m, shape ``(K, N)``
    fluid_pressure : p_f(x), Pa, shape ``(K, N)``
    asperity_pressure : p_a(x), Pa, shape ``(K, N)``
    couette : friction coefficient of the shear flow, ∫φ ηv/u dx/f_N, dimensionless, shape ``(K,)``
    pressure_flow : friction coefficient of the pressure flow, ½∫u dp_f/f_N, dimensionless, shape ``(K,)``
    asperity_load_fraction : load carried by asperities over load, dimensionless, shape ``(K,)``
    minimum_film : smallest ū, m, shape ``(K,)``
    central_film : ū under the middle of the cylinder, m, shape ``(K,)``
    hysteresis : friction coefficient of the solid's loss, ∫p (dw/dx) dx/f_N with its depth w, dimensionless, shape ``(K,)``
    reference_modulus : |E*| at the frequency v/b, Pa, shape ``(K,)``
    half_width : b of the line contact with that modulus, m, shape ``(K,)``
    load_weight : weights that integrate over x, m, shape ``(K, N)``
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
    hysteresis: FloatArray
    reference_modulus: FloatArray
    half_width: FloatArray
    load_weight: FloatArray


def viscoelastic_films(
    speed: ArrayLike,
    viscosity: ArrayLike,
    *,
    load_per_length: float,
    cylinder_radius: float,
    material: AnyMaterial,
    asperities: AsperityLaw | None = None,
    flow_factors: FlowFactors | None = None,
    nodes: int = NODES,
) -> ViscoelasticFilms:
    """Mixed lubrication of a rigid cylinder that slides on a viscoelastic rough solid (Sect. 6.2 and Fig. 14 of the paper).

    The equations of `lubricated_films` with the deflection ``w(q) = 2 p(q)/(|q| E*(qv))`` of a solid that passes through the
    contact: it is stiff while it is pressed and has not come back where it leaves. Friction depends on v through the
    Deborah number vτ/b, and on ηv.

    Parameters
    ----------
    speed : v, m/s, ≥ 0, shape ``(K,)`` or a scalar
    viscosity : η, Pa s, ≥ 0, shape ``(K,)`` or a scalar
    load_per_length : f_N, N/m, > 0
    cylinder_radius : Rc, m, > 0
    material : of the half-space, one material, moduli in Pa
    asperities : p_a against ū, from `asperity_law`, of skin as it is at the frequency of the contact; None for smooth surfaces
    flow_factors : None for trivial ones
    nodes : number of places across the contact, dimensionless, ≥ 4

    Returns
    -------
    films : `ViscoelasticFilms`; nan in rows where no film was found or an argument is impossible

    Raises
    ------
    InputError
        if there are fewer than four nodes

    Notes
    -----
    Linear, quasi-static, one-dimensional. The horizontal force on the cylinder is the sum of shear flow, pressure flow,
    hysteresis and the shear stress of the asperities: ``∫p_f dh/dx`` of the film and ``∫p_a dh/dx``, which is none, turn the
    pressure on the cylinder into one on the solid. The deflection of single asperities is that of ``asperities``, without a
    memory.

    References
    ----------
    Persson & Scaraggi, J. Phys.: Condens. Matter 21 (2009) 185002, doi 10.1088/0953-8984/21/18/185002.
    Hunter, J. Appl. Mech. 28 (1961) 611.

    Examples
    --------
    >>> from skinbayes.contact import standard_linear_solid
    >>> tissue = standard_linear_solid(20e3, 28e3, relaxation_time=0.1)
    >>> films = viscoelastic_films([1e-5, 0.01], [1e4, 10.0], load_per_length=21.92, cylinder_radius=4.533e-3, material=tissue)
    >>> print(films.central_film.round(6), films.couette.round(3), films.hysteresis.round(3))
    [0.000194 0.000174] [0.138 0.143] [0.    0.035]
    """
    given = (np.asarray(x, dtype=np.float64) for x in (speed, viscosity))
    speeds, viscosities = np.broadcast_arrays(*(np.atleast_1d(x) for x in given))
    if nodes < 4:
        raise InputError(f"nodes is {nodes}, but must be at least 4.")
    found = {entry.name: np.full(speeds.shape, np.nan) for entry in fields(ViscoelasticFilms)}
    for name in ("position", "separation", "fluid_pressure", "asperity_pressure", "load_weight"):
        found[name] = np.full((*speeds.shape, nodes), np.nan)
    for value in np.unique(speeds[(speeds >= 0) & (speeds < np.inf) & (viscosities >= 0)]).tolist():
        rows = speeds == value
        scales = passage(material, value, load_per_length=load_per_length, cylinder_radius=cylinder_radius)
        if not (scales.half_width > 0 and scales.half_width < np.inf):
            continue
        solved = films_on(
            scales,
            value * viscosities[rows],
            load_per_length=load_per_length,
            cylinder_radius=cylinder_radius,
            asperities=asperities,
            flow_factors=flow_factors,
            nodes=nodes,
        )
        for name, part in found.items():
            part[rows] = getattr(solved, name)
    return ViscoelasticFilms(**found)


def films_on(
    scales: AnyPassage,
    product: FloatArray,
    *,
    load_per_length: float,
    cylinder_radius: float,
    asperities: AsperityLaw | None,
    flow_factors: FlowFactors | None = None,
    nodes: int,
) -> ViscoelasticFilms:
    """Films at products ηv, N/m, shape ``(K,)``, of a solid that passes with one memory; places ``(N,)`` are the same for all."""
    stage = _Stage(scales)
    films = films_of(
        product,
        load_per_length=load_per_length,
        cylinder_radius=cylinder_radius,
        reduced_modulus=scales.modulus,
        asperities=asperities,
        flow_factors=flow_factors,
        rheology=None,
        nodes=nodes,
        respond=stage.respond,
    )
    solved = stage.part(films, scales.modulus * scales.half_width / (2 * cylinder_radius), cylinder_radius)
    return ViscoelasticFilms(**solved)


class _Stage:
    """One speed: puts its kernel into a grid and measures the hysteresis of what was solved on it."""

    def __init__(self, scales: AnyPassage) -> None:
        self._scales = scales
        self._kernel: MovingKernel | None = None
        self._position = np.zeros(0)

    def respond(self, grid: LineGrid) -> LineGrid:
        """The grid stretched from the Hertz contact to the dry contact on this solid, with the kernel of the solid."""
        lead, trail = edges(self._scales)
        half = (trail - lead) / 2
        self._position = (trail + lead) / 2 + half * grid.position
        self._kernel = self._scales.kernel(self._position)
        return LineGrid(self._position, grid.spacing * half, grid.weight * half, self._kernel.deflection)

    def part(self, films: LubricatedFilms, peak: float, radius: float) -> dict[str, FloatArray]:
        """Fields of `ViscoelasticFilms`; ``peak`` is p_H (Pa), ``radius`` Rc (m)."""
        names = {entry.name for entry in fields(ViscoelasticFilms)} & set(LubricatedFilms._fields)
        part: dict[str, FloatArray] = {name: getattr(films, name) for name in names}
        whole = np.full(films.couette.shape, 1.0)
        part |= {
            "reference_modulus": self._scales.modulus * whole,
            "half_width": self._scales.half_width * whole,
        }
        part["hysteresis"] = np.nan * whole
        if self._kernel is not None:
            pressure = (films.fluid_pressure + films.asperity_pressure) / peak
            drag = hysteresis_integral(self._position, pressure, self._kernel)
            part["hysteresis"] = self._scales.half_width / radius / LOAD * drag
        return part
