"""Friction of a ball on lubricated skin against speed times viscosity: the Stribeck curve, its parts and its validity."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, BoolArray, FloatArray
from skinbayes.contact.area import relative_contact_area
from skinbayes.contact.ball_on_skin import modulus_under_ball
from skinbayes.contact.correction import AREA_CORRECTION
from skinbayes.contact.line_contact import cylinder_of_sphere, line_contact
from skinbayes.contact.solid import ElasticSolid
from skinbayes.contact.variance import twice_stress_variance
from skinbayes.lubrication.asperities import AsperityTable, asperity_table, is_lawful, law_of_table
from skinbayes.lubrication.contact_films import POINT, contact_films, weighted
from skinbayes.lubrication.film import NODES, LubricatedFilms
from skinbayes.lubrication.flow_factors import FlowFactors
from skinbayes.lubrication.point_film import CELLS, LubricatedPointFilms
from skinbayes.lubrication.rheology import Rheology
from skinbayes.roughness.spectrum import PowerSpectrum

LARGEST_STRAIN = 1.3
"""b/Rc, dimensionless, beyond which nothing is predicted. It is b/R = 0.74: there the parabola of Hertz lies 16 % short of the
ball, and the skin around the contact is indented by half a radius."""

LARGE_STRAIN = 0.8
"""b/Rc, dimensionless, b/R = 0.45, beyond which a prediction is marked as largely strained: the shape is 6 % off."""

NOTABLE_STRAIN = 0.3
"""b/Rc, dimensionless, beyond which a prediction is marked as strained."""

THICKEST_FILM = 0.5
"""Largest 3π ηv/f_N = λ(b/Rc)², dimensionless. A fifth of the load is then carried beyond the edge of the ball, x = −Rc."""


REASONS_FOR_NO_PREDICTION = {
    "impossible": "an input is not physical",
    "too_strained": "the contact is too wide for the ball (b/Rc too large)",
    "film_beyond_ball": "the film is thicker than the inlet of the ball (3π ηv/f_N too large)",
    "not_converged": "no film was found",
}
"""Flags where there is no prediction, and what they say."""


@dataclass(frozen=True, eq=False, kw_only=True)
class StribeckCurve:
    """Friction of a lubricated ball and what it consists of; all but ``strain`` have the batch shape plus that of the speeds.

    Where a flag of validity is raised the numbers are nan; ``strained``, ``largely_strained`` and ``shear_rate_unmeasured``
    only warn.

    Attributes
    ----------
    speed_viscosity_product : ηv, N/m, before the shift
    friction_coefficient : μ, sum of the three parts, dimensionless
    boundary : shear stress of the areas of real contact, dimensionless
    couette : shear flow of the liquid, dimensionless
    pressure_flow : pressure flow of the liquid, dimensionless
    asperity_load_fraction : fraction of the load that asperities carry, dimensionless
    minimum_film : smallest mean separation, m
    central_film : mean separation under the middle of the ball, m
    strain : b/Rc of the Hertz contact, dimensionless, batch shape
    strained : b/Rc is above `NOTABLE_STRAIN`: Hertz's theory is stretched
    largely_strained : b/Rc is above `LARGE_STRAIN`
    too_strained : b/Rc is above the largest strain
    film_beyond_ball : 3π ηv/f_N is above the thickest film: it is thicker than the inlet that the ball offers
    impossible : an input is not a number or not physical, such as a force or speed below 0
    not_converged : no film was found
    shear_rate_unmeasured : v/u of the film lies outside the shear rates for which the viscosity is known
    """

    speed_viscosity_product: FloatArray
    friction_coefficient: FloatArray
    boundary: FloatArray
    couette: FloatArray
    pressure_flow: FloatArray
    asperity_load_fraction: FloatArray
    minimum_film: FloatArray
    central_film: FloatArray
    strain: FloatArray
    strained: BoolArray
    largely_strained: BoolArray
    too_strained: BoolArray
    film_beyond_ball: BoolArray
    impossible: BoolArray
    not_converged: BoolArray
    shear_rate_unmeasured: BoolArray

    @property
    def valid(self) -> BoolArray:
        """Where there is a prediction."""
        return ~(self.too_strained | self.film_beyond_ball | self.impossible | self.not_converged)

    def reasons(self) -> list[str]:
        """Why points are missing or doubtful, one sentence a reason, with the number of points."""
        said = REASONS_FOR_NO_PREDICTION | {
            "strained": f"b/Rc is above {NOTABLE_STRAIN:g}, where Hertz's theory is stretched",
            "largely_strained": f"b/Rc is above {LARGE_STRAIN:g}: the contact is nearly half as wide as the ball, or wider",
            "shear_rate_unmeasured": "the liquid is sheared at rates for which its viscosity was not measured",
        }
        counts = {name: int(np.count_nonzero(getattr(self, name))) for name in said}
        total = self.friction_coefficient.size
        return [f"{counts[name]} of {total} points: {text}." for name, text in said.items() if counts[name]]


def stribeck_curve(
    speed_viscosity_product: ArrayLike,
    *,
    normal_force: ArrayLike,
    sphere_radius: ArrayLike,
    spectrum: PowerSpectrum,
    skin: ElasticSolid,
    contact: str = POINT,
    frictional_shear_stress: ArrayLike,
    area_correction: ArrayLike = AREA_CORRECTION,
    velocity_shift_factor: ArrayLike = 1.0,
    flow_factors: FlowFactors | None = None,
    rheology: Rheology | None = None,
    nodes: int = NODES,
    cells: int = CELLS,
    inlet_length: float | None = None,
    thickest_film: float = THICKEST_FILM,
    largest_strain: float = LARGEST_STRAIN,
) -> StribeckCurve:
    """Friction coefficient of a ball on lubricated rough skin (Sect. 6 of the paper, Fig. 13).

    The film on the tissue's modulus E1*, with the asperities of the layered surface, is that of `lubricated_point_films`.
    ``μ = (1/F_N) [∫ σ_f A(p_a)/A0 dA + ∫ ηv/u dA + ∫ (u/2) ∂p_f/∂x dA]``: areas of real contact, shear flow and pressure
    flow. Where A ∝ p the first is ``σ_f A/(A0 p)`` times the load fraction of the asperities. For a line contact the ball
    is replaced by the cylinder of Eq. 9, as in the paper: the film is that of `lubricated_films`, the sums are those per length.

    Parameters
    ----------
    speed_viscosity_product : ηv, N/m, ≥ 0, shape ``(K,)``, or a scalar; with a rheology η0 v. At 0 there is boundary friction.
    normal_force : F_N, N, > 0, batch shape
    sphere_radius : R, m, > 0, batch shape
    spectrum : power spectrum, C in m^4, batch shape
    skin : moduli in Pa, thickness in m, batch shape
    contact : "point", the ball as it is, or "line", the cylinder of Eq. 9 of the paper
    frictional_shear_stress : σ_f, Pa, ≥ 0, batch shape
    area_correction : γ, dimensionless, 0 < γ ≤ 1, batch shape; 1 is plain Persson theory
    velocity_shift_factor : a, dimensionless, > 0, batch shape; the theory is evaluated at a ηv
    flow_factors : of the flow between rough surfaces; None for trivial ones, which the paper finds sufficient
    rheology : viscosity against shear rate v/u; None for a Newtonian liquid
    nodes : number of places across a line contact, dimensionless
    cells : number of cells of half a point contact, dimensionless
    inlet_length : distance from the contact, m, at which liquid and drag end; None for liquid without end
    thickest_film : 3π ηv/f_N, dimensionless, beyond which nothing is predicted
    largest_strain : b/Rc, dimensionless, beyond which nothing is predicted

    Returns
    -------
    curve : `StribeckCurve`, nan where the theory is not valid, with the reason; b and f_N are those of the cylinder

    Raises
    ------
    InputError
        if there is no such contact

    Notes
    -----
    The shear stress under a ball is counted up to its edge, see `lubricated_point_films`, that under a cylinder everywhere.
    The cylinder carries the same load at 0.8 of the speed, and its friction is 7 to 32 % smaller at the minimum.
    Which terms are summed matters: the minimum of Fig. 13 is 0.108 (line) with all three and 0.086 without the pressure flow.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6).
    Persson & Scaraggi, J. Phys.: Condens. Matter 21 (2009) 185002, doi 10.1088/0953-8984/21/18/185002.

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> surface = named_surface("paper_reference")
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> curve = stribeck_curve([1e-6, 1e-3, 2e-2, 10.0], normal_force=0.2, sphere_radius=8e-3,
    ...     spectrum=surface, skin=wet, frictional_shear_stress=15e6)
    >>> print(curve.friction_coefficient.round(3))
    [1.423 1.006 0.132   nan]
    >>> print(*curve.reasons(), sep="\\n")
    1 of 4 points: the film is thicker than the inlet of the ball (3π ηv/f_N too large).
    3 of 4 points: b/Rc is above 0.3, where Hertz's theory is stretched.
    """
    given = np.asarray(speed_viscosity_product, dtype=np.float64)
    products = np.atleast_1d(given)
    twice_variance = twice_stress_variance(spectrum, skin)
    modulus = modulus_under_ball(normal_force, sphere_radius, skin=skin)
    table = asperity_table(spectrum, skin, area_correction=area_correction)
    case = (normal_force, sphere_radius, frictional_shear_stress, area_correction, velocity_shift_factor,
            twice_variance, modulus)  # fmt: skip
    inputs = np.broadcast_arrays(
        *(np.asarray(x, dtype=np.float64)[..., None] for x in case), table.separation[..., :1]
    )
    batch = inputs[0].shape[:-1]
    liquid = {
        "flow_factors": flow_factors, "rheology": rheology, "contact": contact, "nodes": nodes, "cells": cells,
        "inlet_length": inlet_length,
    }  # fmt: skip
    cases = np.concatenate(inputs[:-1], axis=-1).reshape(-1, len(inputs) - 1)
    points = (np.broadcast_to(part, (*batch, part.shape[-1])) for part in table)
    knots, levels = (part.reshape(-1, part.shape[-1]) for part in points)
    rows = [
        _one_curve(products, _Case(*row), AsperityTable(*points), liquid, thickest_film, largest_strain)
        for row, *points in zip(cases.tolist(), knots, levels, strict=True)
    ]

    def gather(name: str, kind: str) -> Any:
        # an empty batch has no row that tells its kind
        stacked = np.array([row[name] for row in rows], dtype=bool if kind == "BoolArray" else np.float64)
        if name == "strain":
            return stacked.reshape(batch)[()]
        return stacked.reshape((*batch, *given.shape))[()]

    return StribeckCurve(
        **{entry.name: gather(entry.name, str(entry.type)) for entry in fields(StribeckCurve)}
    )


class _Case(NamedTuple):
    """One set of parameters, SI."""

    normal_force: float
    sphere_radius: float
    shear_stress: float
    area_correction: float
    shift: float
    twice_variance: float
    modulus: float


def _one_curve(
    products: FloatArray,
    case: _Case,
    table: AsperityTable,
    liquid: dict[str, Any],
    thickest_film: float,
    largest_strain: float,
) -> dict[str, Any]:
    """The fields of a `StribeckCurve` for one set of parameters; ``liquid`` is what `contact_films` takes beside them."""
    cylinder = cylinder_of_sphere(case.normal_force, case.sphere_radius, reduced_modulus=case.modulus)
    line = line_contact(cylinder.load_per_length, cylinder.cylinder_radius, reduced_modulus=case.modulus)
    load, strain = float(cylinder.load_per_length), float(line.half_width / cylinder.cylinder_radius)
    shifted = products * case.shift
    with np.errstate(invalid="ignore"):
        physical = np.isfinite(strain) & (load > 0) & (case.shear_stress >= 0)
        physical = physical & (case.shift > 0) & is_lawful(*table)
        possible = (shifted >= 0) & (shifted < np.inf) & physical
        beyond = possible & (3 * np.pi * shifted > thickest_film * load)
    wide = np.full(products.shape, bool(strain > largest_strain))
    solved = possible & ~beyond & ~wide
    result: dict[str, Any] = {
        "speed_viscosity_product": products,
        "strain": strain,
        "strained": solved & (strain > NOTABLE_STRAIN),
        "largely_strained": solved & (strain > LARGE_STRAIN),
        "too_strained": wide,
        "film_beyond_ball": beyond,
        "impossible": ~possible,
        "shear_rate_unmeasured": np.zeros(products.shape, dtype=bool),
    }
    names = (
        "boundary", "couette", "pressure_flow", "asperity_load_fraction", "minimum_film", "central_film",
    )  # fmt: skip
    result |= {name: np.full(products.shape, np.nan) for name in names}
    if solved.any():
        films, total = contact_films(
            shifted[solved],
            normal_force=case.normal_force,
            sphere_radius=case.sphere_radius,
            reduced_modulus=case.modulus,
            asperities=law_of_table(*table),
            **liquid,
        )
        area = relative_contact_area(
            films.asperity_pressure, case.twice_variance, area_correction=case.area_correction
        )
        boundary = case.shear_stress * weighted(area, films.load_weight) / total
        for name in names:
            result[name][solved] = boundary if name == "boundary" else getattr(films, name)
        if liquid["rheology"] is not None:
            result["shear_rate_unmeasured"][solved] = _unmeasured(shifted[solved], films, liquid["rheology"])
    result["friction_coefficient"] = result["boundary"] + result["couette"] + result["pressure_flow"]
    result["not_converged"] = solved & np.isnan(result["friction_coefficient"])
    return result


def _unmeasured(
    products: FloatArray, films: LubricatedFilms | LubricatedPointFilms, rheology: Rheology
) -> BoolArray:
    """Where the fastest sheared place, or the middle of the film, lies outside the known shear rates."""
    low, high = rheology.shear_rate_range
    speed = products / rheology.low_shear_viscosity
    with np.errstate(invalid="ignore"):
        return (speed / films.minimum_film > high) | (speed / films.central_film < low)
