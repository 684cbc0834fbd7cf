"""Viscosity of a liquid at the shear rate of the film that it makes, with the direct film solver."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, BoolArray, FloatArray
from skinbayes.contact.ball_on_skin import modulus_under_ball
from skinbayes.contact.correction import AREA_CORRECTION
from skinbayes.contact.solid import ElasticSolid
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import asperity_table, is_lawful, law_of_table
from skinbayes.lubrication.contact_films import POINT, contact_films
from skinbayes.lubrication.film import NODES
from skinbayes.lubrication.flow_curves import LiquidRows, liquid_rows
from skinbayes.lubrication.flow_factors import FlowFactors
from skinbayes.lubrication.point_film import CELLS
from skinbayes.lubrication.rheology import FlowCurve
from skinbayes.lubrication.stribeck import LARGEST_STRAIN, THICKEST_FILM, StribeckCurve, stribeck_curve
from skinbayes.roughness.spectrum import PowerSpectrum

_ROUNDS, _CLOSE = 60, 1e-7  # of the iteration for ln η


class EffectiveViscosity(NamedTuple):
    """Viscosity of liquids at the shear rate of the film they make; arrays of the broadcast shape of the arguments.

    Attributes
    ----------
    viscosity : η(v/u), Pa s
    shear_rate : v/u with the mean separation u under the middle of the ball, 1/s
    unmeasured : the shear rate lies outside those that were measured, and the viscosity is that at the nearer end
    """

    viscosity: FloatArray
    shear_rate: FloatArray
    unmeasured: BoolArray


def stribeck_curve_of_liquid(
    sliding_speed: ArrayLike,
    flow_curve: FlowCurve,
    *,
    normal_force: float,
    sphere_radius: float,
    spectrum: PowerSpectrum,
    skin: ElasticSolid,
    contact: str = POINT,
    frictional_shear_stress: float,
    area_correction: float = AREA_CORRECTION,
    velocity_shift_factor: float = 1.0,
    flow_factors: FlowFactors | None = None,
    nodes: int = NODES,
    cells: int = CELLS,
    inlet_length: float | None = None,
    thickest_film: float = THICKEST_FILM,
    largest_strain: float = LARGEST_STRAIN,
) -> tuple[StribeckCurve, EffectiveViscosity]:
    """Stribeck curve of a liquid of measured flow curve, with one viscosity for the whole film (Appendix C of the paper).

    The viscosity is that at the shear rate v/u under the middle of the ball: ``u = u(a η(v/u) v)``, solved for each speed by
    false position (Illinois) on ln η between the extremes of the flow curve.

    Parameters
    ----------
    sliding_speed : v, m/s, ≥ 0, shape ``(K,)``; at 0 there is boundary friction
    flow_curve : η against shear rate; outside the measured rates the viscosity at the nearer end is used
    normal_force : F_N, N, > 0
    sphere_radius : R, m, > 0
    spectrum : power spectrum, C in m^4, one surface
    skin : moduli in Pa, thickness in m, one skin
    contact : "point", the ball as it is, or "line", the cylinder of Eq. 9 of the paper
    frictional_shear_stress : σ_f, Pa, ≥ 0
    area_correction : γ, dimensionless, 0 < γ ≤ 1
    velocity_shift_factor : a, dimensionless, > 0; the shear rate is that of the speed without it
    flow_factors : of the flow between rough surfaces; None for trivial ones
    nodes : number of places across a line contact, dimensionless
    cells : number of cells of half a point contact, dimensionless
    inlet_length : distance from the contact, m, at which liquid and drag end; None for liquid without end
    thickest_film, largest_strain : 3π ηv/f_N and b/Rc, dimensionless, beyond which nothing is predicted

    Returns
    -------
    curve : `StribeckCurve` at ηv with the viscosity found, ``shear_rate_unmeasured`` as in `viscosity`
    viscosity : `EffectiveViscosity`, nan where there is no film

    Raises
    ------
    InputError
        if a speed is not a finite number ≥ 0

    Notes
    -----
    See `tabulated_friction_of_liquids` for when there is only one solution, and for how far one viscosity is from the local
    one at every place of the film. Where several agree with their films, one of them is given.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6, Appendix C).

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> surface = named_surface("paper_reference")
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> honey = FlowCurve([10.0, 100.0, 1000.0], [25.0, 23.5, 15.0])
    >>> curve, viscosity = stribeck_curve_of_liquid([1e-3, 1e-2], honey, normal_force=0.2, sphere_radius=8e-3,
    ...     spectrum=surface, skin=wet, frictional_shear_stress=15e6)
    >>> print(curve.friction_coefficient.round(3), viscosity.viscosity.round(1))
    [0.127 0.314] [25.  24.5]
    """
    speed = np.atleast_1d(np.asarray(sliding_speed, dtype=np.float64))
    wrong = np.flatnonzero(~(np.isfinite(speed) & (speed >= 0)))
    if wrong.size:
        raise InputError(
            f"sliding_speed {wrong[0] + 1} is {speed[wrong[0]]:g} m/s, but must be a finite number >= 0 m/s."
        )
    liquids = liquid_rows([flow_curve]).at(np.zeros(speed.size, dtype=np.intp))
    modulus = float(modulus_under_ball(normal_force, sphere_radius, skin=skin))
    table = asperity_table(spectrum, skin, area_correction=area_correction)
    law = law_of_table(*table) if is_lawful(*table) else None

    def shear_rate(log_viscosity: FloatArray) -> FloatArray:
        """ln v/u."""
        if law is None:
            return np.full(speed.shape, np.nan)
        products = np.exp(log_viscosity) * speed * velocity_shift_factor
        films, _ = contact_films(
            products,
            normal_force=float(normal_force),
            sphere_radius=float(sphere_radius),
            reduced_modulus=modulus,
            asperities=law,
            contact=contact,
            flow_factors=flow_factors,
            nodes=nodes,
            cells=cells,
            inlet_length=inlet_length,
        )
        with np.errstate(divide="ignore"):
            return np.asarray(np.log(speed / films.central_film))

    log_viscosity = agreeing_viscosity(shear_rate, liquids)
    rate = np.exp(shear_rate(log_viscosity))
    curve = stribeck_curve(
        np.exp(log_viscosity) * speed,
        sphere_radius=sphere_radius,
        normal_force=normal_force,
        skin=skin,
        spectrum=spectrum,
        frictional_shear_stress=frictional_shear_stress,
        area_correction=area_correction,
        velocity_shift_factor=velocity_shift_factor,
        flow_factors=flow_factors,
        contact=contact,
        nodes=nodes,
        cells=cells,
        inlet_length=inlet_length,
        thickest_film=thickest_film,
        largest_strain=largest_strain,
    )
    good = np.isfinite(curve.friction_coefficient)
    unmeasured = good & ~liquids.measured(rate)
    viscosity = np.where(good, np.exp(log_viscosity), np.nan)
    found = EffectiveViscosity(viscosity, np.where(good, rate, np.nan), unmeasured)
    return replace(curve, shear_rate_unmeasured=unmeasured), found


def agreeing_viscosity(shear_rate: Callable[[FloatArray], FloatArray], liquids: LiquidRows) -> FloatArray:
    """ln η that agrees with its own ln shear rate, by false position (Illinois) from the extremes of each liquid."""

    def miss_at(place: FloatArray) -> FloatArray:
        return liquids.log_viscosity(shear_rate(place))[0] - place

    low, high = liquids.least.copy(), liquids.most.copy()
    at_low, at_high = miss_at(low), miss_at(high)
    side = np.zeros(low.shape)
    for _ in range(_ROUNDS):
        fall = at_low - at_high
        with np.errstate(invalid="ignore", divide="ignore"):
            place = np.where(fall > 0, (high * at_low - low * at_high) / fall, high)
        miss = miss_at(place)
        if np.nanmax(np.abs(miss), initial=0.0) < _CLOSE:
            break
        above = miss > 0
        # the value at an end that stays twice is halved
        at_high = np.where(above, np.where(side > 0, at_high / 2, at_high), miss)
        at_low = np.where(above, miss, np.where(side < 0, at_low / 2, at_low))
        low, high = np.where(above, place, low), np.where(above, high, place)
        side = np.where(above, 1.0, -1.0)
    return place
