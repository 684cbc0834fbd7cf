"""Friction of a ball on lubricated viscoelastic skin against speed and viscosity, each by itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.area import relative_contact_area
from skinbayes.contact.constant_loss import ConstantLossMaterial
from skinbayes.contact.correction import AREA_CORRECTION
from skinbayes.contact.layered import LayeredSkin
from skinbayes.contact.line_contact import EquivalentCylinder, cylinder_of_sphere, line_contact
from skinbayes.contact.variance import twice_stress_variance
from skinbayes.contact.viscoelastic import ViscoelasticMaterial
from skinbayes.contact.viscoelastic_line_contact import modulus_in_contact
from skinbayes.contact.viscoelastic_skin import ViscoelasticSkin
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import asperity_table, is_lawful, law_of_table
from skinbayes.lubrication.contact_films import CONTACTS, LINE, POINT
from skinbayes.lubrication.film import NODES
from skinbayes.lubrication.flow_factors import FlowFactors
from skinbayes.lubrication.point_film import CELLS
from skinbayes.lubrication.stribeck import (
    LARGE_STRAIN,
    LARGEST_STRAIN,
    NOTABLE_STRAIN,
    THICKEST_FILM,
    StribeckCurve,
)
from skinbayes.lubrication.viscoelastic_film import ViscoelasticFilms, viscoelastic_films
from skinbayes.lubrication.viscoelastic_point_film import (
    ViscoelasticPointFilms,
    passage_under_ball,
    viscoelastic_point_films,
)
from skinbayes.roughness.spectrum import PowerSpectrum

SPHERE_OVER_CYLINDER = 27 * np.pi / 128
"""Hysteresis friction of a sphere, (6/π²) sin δ r0/R, over that of the cylinder of Eq. 9, (8/3π) sin δ b/Rc, dimensionless."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ViscoelasticStribeckCurve(StribeckCurve):
    """Friction of a ball on viscoelastic skin; the fields of `StribeckCurve`, of the shape of the points, and three more.

    Attributes
    ----------
    speed : v, m/s
    viscosity : η, Pa s
    hysteresis : loss of the deeper tissue that the ball deforms as a whole, a part of the friction coefficient, dimensionless
    """

    speed: FloatArray
    viscosity: FloatArray
    hysteresis: FloatArray


def viscoelastic_stribeck_curve(
    speed: ArrayLike,
    viscosity: ArrayLike,
    *,
    normal_force: float,
    sphere_radius: float,
    spectrum: PowerSpectrum,
    skin: ViscoelasticSkin,
    contact: str = LINE,
    frictional_shear_stress: float,
    area_correction: float = AREA_CORRECTION,
    velocity_shift_factor: float = 1.0,
    flow_factors: FlowFactors | None = None,
    nodes: int = NODES,
    cells: int = CELLS,
    thickest_film: float = THICKEST_FILM,
    largest_strain: float = LARGEST_STRAIN,
) -> ViscoelasticStribeckCurve:
    """Friction coefficient of a ball on lubricated, rough, viscoelastic skin (Sect. 6.2 and Fig. 14 of the paper).

    `stribeck_curve` with the films of `viscoelastic_films`, the cylinder of Eq. 9, or `viscoelastic_point_films`, the ball. The
    contact as a whole is that of the tissue: its modulus at v/b (v/a under the ball) makes its size, its memory the shape of the
    film. Layer and tissue together, at the same frequency, make the asperities: the roughness rests in the skin, and is loaded
    once while it passes the contact.

    Parameters
    ----------
    speed : v, m/s, ≥ 0, shape ``(K,)`` or a scalar
    viscosity : η, Pa s, ≥ 0, shape ``(K,)`` or a scalar
    normal_force : F_N, N, > 0
    sphere_radius : R, m, > 0
    spectrum : power spectrum, C in m^4, one surface
    skin : one skin, moduli in Pa, thickness in m
    contact : "line", the cylinder of Eq. 9 of the paper, or "point", the ball as it is
    frictional_shear_stress : σ_f, Pa, ≥ 0
    area_correction : γ, dimensionless, 0 < γ ≤ 1; 1 is plain Persson theory
    velocity_shift_factor : a, dimensionless, > 0; the films are those at a ηv, the tissue that at v
    flow_factors : of the flow between rough surfaces; None for trivial ones
    nodes : number of places across a line contact, dimensionless
    cells : number of cells of half a point contact, dimensionless
    thickest_film : 3π ηv/f_N, dimensionless, beyond which nothing is predicted
    largest_strain : b/Rc, dimensionless, beyond which nothing is predicted

    Returns
    -------
    curve : `ViscoelasticStribeckCurve`, nan where the theory is not valid, with the reason; b and f_N are those of the cylinder

    Raises
    ------
    InputError
        if there is no such contact

    Notes
    -----
    The hysteresis of the cylinder is multiplied by 0.663, `SPHERE_OVER_CYLINDER`, the ratio for weak loss that is the same at all
    frequencies. Asperities of a rough countersurface would stir the skin at the frequencies qv; here the ball is smooth.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6).
    Hunter, J. Appl. Mech. 28 (1961) 611.

    Examples
    --------
    >>> from skinbayes.contact import ViscoelasticMaterial, ViscoelasticSkin, standard_linear_solid
    >>> from skinbayes.roughness import named_surface
    >>> skin = ViscoelasticSkin(
    ...     layer=ViscoelasticMaterial(equilibrium_modulus=7e6),
    ...     bulk=standard_linear_solid(20e3, 27.8e3, relaxation_time=0.2),
    ...     layer_thickness=20e-6,
    ... )
    >>> curve = viscoelastic_stribeck_curve([0.01, 0.01, 1.0], [1e-3, 2.0, 0.02], normal_force=0.2, sphere_radius=8e-3,
    ...     spectrum=named_surface("paper_reference"), skin=skin, frictional_shear_stress=15e6)
    >>> print(curve.friction_coefficient.round(3), curve.hysteresis.round(3))
    [1.452 0.155 0.122] [0.032 0.03  0.002]
    """
    if contact not in CONTACTS:
        raise InputError(f"contact is {contact!r:.60}, but must be {' or '.join(map(repr, CONTACTS))}.")
    tissue = skin.bulk
    if contact == POINT and isinstance(tissue, ConstantLossMaterial):
        raise InputError(
            "contact is 'point', but tissue of constant loss angle in closed form is known under a cylinder only; expected "
            "'line', or a tissue of relaxation times such as that of constant_loss_solid."
        )
    given = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (speed, viscosity)))
    shape = given[0].shape
    speeds, viscosities = (np.atleast_1d(x) for x in given)
    none, no = np.full(speeds.shape, np.nan), np.zeros(speeds.shape, dtype=bool)
    parts = {
        name: none.copy()
        for name in (
            "boundary", "couette", "pressure_flow", "hysteresis", "asperity_load_fraction", "minimum_film",
            "central_film", "strain",
        )
    }  # fmt: skip
    beyond, wide, impossible = no.copy(), no.copy(), np.ones_like(no)
    physical = normal_force > 0 and sphere_radius > 0 and frictional_shear_stress >= 0
    physical = physical and velocity_shift_factor > 0
    shifted = viscosities * velocity_shift_factor
    known = (speeds >= 0) & (speeds < np.inf) & (viscosities >= 0) & (viscosities < np.inf)
    for value in np.unique(speeds[known]).tolist() if physical else ():
        rows = known & (speeds == value)
        cylinder, strain, frequency = _contact(value, normal_force, sphere_radius, skin, contact)
        held = skin.at_frequency(frequency)
        table = asperity_table(spectrum, held, area_correction=area_correction)
        parts["strain"][rows] = strain
        if not (np.isfinite(strain) and is_lawful(*table)):
            continue
        impossible[rows] = False
        beyond |= rows & (3 * np.pi * speeds * shifted > thickest_film * cylinder.load_per_length)
        wide[rows] = strain > largest_strain
        solved = rows & ~beyond & ~wide
        if not solved.any():
            continue
        film: dict[str, Any] = {"asperities": law_of_table(*table), "flow_factors": flow_factors}
        total = normal_force
        films: ViscoelasticFilms | ViscoelasticPointFilms
        if contact == POINT and isinstance(tissue, ViscoelasticMaterial):
            films = viscoelastic_point_films(
                speeds[solved],
                shifted[solved],
                normal_force=normal_force,
                sphere_radius=sphere_radius,
                material=tissue,
                cells=cells,
                **film,
            )
        else:
            total = float(cylinder.load_per_length)
            films = viscoelastic_films(
                speeds[solved],
                shifted[solved],
                load_per_length=total,
                cylinder_radius=float(cylinder.cylinder_radius),
                material=skin.bulk,
                nodes=nodes,
                **film,
            )
        area = relative_contact_area(
            films.asperity_pressure, twice_stress_variance(spectrum, held), area_correction=area_correction
        )
        touching = (area * films.load_weight).sum(axis=-1) / total
        parts["boundary"][solved] = frictional_shear_stress * touching
        parts["hysteresis"][solved] = films.hysteresis * (1 if contact == POINT else SPHERE_OVER_CYLINDER)
        for name in ("couette", "pressure_flow", "asperity_load_fraction", "minimum_film", "central_film"):
            parts[name][solved] = getattr(films, name)
    total = parts["boundary"] + parts["couette"] + parts["pressure_flow"] + parts["hysteresis"]
    tried = ~(impossible | beyond | wide)
    result = parts | {
        "speed": speeds,
        "viscosity": viscosities,
        "speed_viscosity_product": speeds * viscosities,
        "friction_coefficient": total,
        "strained": tried & (parts["strain"] > NOTABLE_STRAIN),
        "largely_strained": tried & (parts["strain"] > LARGE_STRAIN),
        "too_strained": wide,
        "film_beyond_ball": beyond,
        "impossible": impossible,
        "not_converged": tried & np.isnan(total),
        "shear_rate_unmeasured": no,
    }
    return ViscoelasticStribeckCurve(**{name: part.reshape(shape)[()] for name, part in result.items()})


def skin_at_speed(
    speed: float, *, normal_force: float, sphere_radius: float, skin: ViscoelasticSkin
) -> LayeredSkin:
    """Elastic skin of the moduli that a ball meets at v, m/s; moduli in Pa."""
    return skin.at_frequency(_contact(speed, normal_force, sphere_radius, skin, LINE)[2])


def _contact(
    speed: float, force: float, radius: float, skin: ViscoelasticSkin, contact: str
) -> tuple[EquivalentCylinder, float, float]:
    """Cylinder of Eq. 9, its b/Rc and v/b or v/a (1/s), with the modulus of the tissue at that frequency."""

    def cylinder_on(modulus: float) -> EquivalentCylinder:
        return cylinder_of_sphere(force, radius, reduced_modulus=modulus)

    def half_width_of(modulus: float) -> float:
        return float(line_contact(*cylinder_on(modulus), reduced_modulus=modulus).half_width)

    if contact == POINT and isinstance(skin.bulk, ViscoelasticMaterial):
        ball = passage_under_ball(skin.bulk, speed, normal_force=force, sphere_radius=radius)
        cylinder = cylinder_on(ball.modulus)
        return (
            cylinder,
            half_width_of(ball.modulus) / float(cylinder.cylinder_radius),
            speed / ball.half_width,
        )
    modulus, half_width = modulus_in_contact(skin.bulk, speed, half_width_of)
    cylinder = cylinder_on(modulus)
    return cylinder, half_width / float(cylinder.cylinder_radius), speed / half_width
