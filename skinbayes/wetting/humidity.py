"""Skin in equilibrium with humid air: bridges of a few nanometres, and a layer that softens with humidity."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray, floats
from skinbayes.contact import AREA_CORRECTION, ElasticSolid
from skinbayes.roughness.spectrum import PowerSpectrum
from skinbayes.wetting._gaps import Closure
from skinbayes.wetting.capillary import Branch, CapillaryState, capillary_state_at_gap, kelvin_gap
from skinbayes.wetting.water import (
    BOLTZMANN_CONSTANT,
    molecular_volume_of_water,
    saturation_vapour_pressure,
    surface_tension_of_water,
)

MOLECULE_DIAMETER = 0.3e-9
"""Size of a water molecule, m, about the cube root of its volume in the liquid; a Kelvin length below it means nothing."""


def kelvin_radius(relative_humidity: ArrayLike, temperature: ArrayLike) -> FloatArray:
    """Radius of curvature of water in equilibrium with humid air, ``r_K = γ_w v/(k_B T ln(1/RH))`` (Appendix A of the paper).

    Parameters
    ----------
    relative_humidity : RH, dimensionless, 0 … 1, any shape; 0 gives 0 and 1 inf
    temperature : T, K, broadcasts; surface tension and molecular volume v are those of water at T

    Returns
    -------
    kelvin_radius : m, broadcast shape, counted positive; nan where an argument is impossible

    Notes
    -----
    One of the two radii of a bridge is taken as infinite, as in Eq. 6. The Laplace pressure γ_w/r_K is k_B T ln(1/RH)/v, whatever
    the surface tension: 94 MPa at 50 %.

    References
    ----------
    Butt & Kappl, Adv. Colloid Interface Sci. 146 (2009) 48, doi 10.1016/j.cis.2008.10.002 (Sect. 2).

    Examples
    --------
    >>> print(f"{kelvin_radius(0.5, 293.15):.4e} {kelvin_radius(0.9, 293.15):.4e}")
    7.7704e-10 5.1120e-09
    """
    humidity, kelvin = floats(relative_humidity, temperature)
    with np.errstate(all="ignore"):
        humidity = np.where((humidity >= 0) & (humidity <= 1), humidity, np.nan)
        work = BOLTZMANN_CONSTANT * kelvin * np.abs(np.log(humidity))
        return np.asarray(surface_tension_of_water(kelvin) * molecular_volume_of_water(kelvin) / work)[()]


def humidity_at_surface(
    relative_humidity: ArrayLike, surface_temperature: ArrayLike, *, air_temperature: ArrayLike
) -> FloatArray:
    """Relative humidity at a surface that is warmer or colder than the air (for Appendix A of the paper).

    The vapour pressure p_a of Eq. 8 is the same in the room and at the skin, that of saturation is not:
    ``RH_s = RH p_w(T_air)/p_w(T_surface)``.

    Parameters
    ----------
    relative_humidity : RH of the air, dimensionless, 0 … 1, any shape
    surface_temperature : T_surface, K, broadcasts
    air_temperature : T_air, K, broadcasts

    Returns
    -------
    relative_humidity : RH_s, dimensionless, 0 … 1, broadcast shape; 1 where a cold surface makes water condense; nan where an
        argument is impossible

    Notes
    -----
    Air of 50 % in a room of 20 °C is air of 25 % to skin of 32 °C. Covered skin and skin under a probe are moister: they
    lose water themselves.

    References
    ----------
    Wagner & Pruß, J. Phys. Chem. Ref. Data 22 (1993) 783, doi 10.1063/1.555926 (saturation pressure).

    Examples
    --------
    >>> print(humidity_at_surface([0.5, 0.9], [305.15, 288.15], air_temperature=293.15).round(4))
    [0.2457 1.    ]
    """
    humidity = np.asarray(relative_humidity, dtype=np.float64)
    air, surface = (saturation_vapour_pressure(x) for x in (air_temperature, surface_temperature))
    with np.errstate(all="ignore"):
        humidity = np.where((humidity >= 0) & (humidity <= 1), humidity, np.nan)
        # equal temperatures leave the humidity as it is, to the last bit
        return np.minimum(humidity * (air / surface), 1.0)[()]


def is_below_molecule(kelvin_gap: ArrayLike) -> FloatArray:
    """Tell where a Kelvin length is smaller than a water molecule, so that bridges are no more than a figure of speech (Appendix
    A of the paper, Eq. 5).

    Parameters
    ----------
    kelvin_gap : d_K, m, ≥ 0, any shape

    Returns
    -------
    below : 1 where d_K < `MOLECULE_DIAMETER`, else 0, dimensionless, shape of ``kelvin_gap``; nan for nan or a negative d_K

    References
    ----------
    Butt & Kappl, Adv. Colloid Interface Sci. 146 (2009) 48, doi 10.1016/j.cis.2008.10.002 (Sect. 2).

    Examples
    --------
    >>> from math import radians
    >>> gap = kelvin_gap(kelvin_radius([0.1, 0.2, 0.5], 293.15), radians(80.0), contact_angle_counterface=0.0)
    >>> print(is_below_molecule(gap))
    [1. 0. 0.]
    """
    gap = np.asarray(kelvin_gap, dtype=np.float64)
    return np.where(gap >= 0, gap < MOLECULE_DIAMETER, np.nan)[()]


def capillary_state_in_humid_air(
    relative_humidity: ArrayLike,
    temperature: ArrayLike,
    *,
    nominal_pressure: ArrayLike,
    spectrum: PowerSpectrum,
    skin: ElasticSolid,
    contact_angle_skin: ArrayLike,
    contact_angle_counterface: ArrayLike,
    area_correction: ArrayLike = AREA_CORRECTION,
    closure: Closure = "gaussian",
    branch: Branch = "approach",
    count: bool = True,
) -> CapillaryState:
    """Contact of skin whose bridges are in equilibrium with humid air (Appendix A and Fig. 16 of the paper).

    Parameters
    ----------
    relative_humidity : RH, dimensionless, 0 … 1, shape ``(F,)`` or ``(..., F)``, or a scalar; 1 floods the gap, 0 is the limit
        of ever drier air
    temperature : T, K, one for each member of the batch
    nominal_pressure : p0, Pa, > 0, batch shape
    spectrum : power spectrum, C in m^4, scalar or batched
    skin : moduli in Pa, thickness in m; broadcasts with the spectrum. The modulus of the layer depends on humidity; give
        each humidity its own skin (batch of skins, humidity of shape ``(..., 1)``) to follow it.
    contact_angle_skin : θ1, rad, 0 … π, batch shape
    contact_angle_counterface : θ2, rad, 0 … π, batch shape
    area_correction : γ, dimensionless, 0 < γ ≤ 1, batch shape
    closure : P(u) from Gaussians (default) or from sharp gaps, see `gap_distribution`
    branch, count : see `capillary_state_at_gap`

    Returns
    -------
    state : `CapillaryState`, batch shape, plus the axis of ``relative_humidity`` if it has one; nan where a parameter is
        impossible. ``kelvin_gap`` is 0 where no bridges form, and in perfectly dry air.

    Notes
    -----
    With E0 = 70 MPa the area hardly changes with humidity, with E0 = 7 MPa the bridges pull skin into nearly complete contact in
    dry air. Where, between 60 and 95 %, the soft curve comes down depends on the closure and is no result of the theory. Below
    about 12 % d_K is smaller than a molecule, see `is_below_molecule`. At both ends the capillary pressure is continuous:
    towards saturation d_K grows beyond all gaps and p_K falls to 0, towards dry air p_K grows as the area that d_K reaches
    shrinks, and the capillary pressure comes to γ_w (cos θ1 + cos θ2) P(u → 0).

    References
    ----------
    Persson, J. Phys.: Condens. Matter 20 (2008) 315007, doi 10.1088/0953-8984/20/31/315007.
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Appendix A).

    Examples
    --------
    >>> from math import radians
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> stiff = LayeredSkin(young_modulus_layer=70e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> state = capillary_state_in_humid_air([0.3, 0.9], 293.15, nominal_pressure=6830.0,
    ...     spectrum=named_surface("paper_reference"), skin=stiff, contact_angle_skin=radians(80.0),
    ...     contact_angle_counterface=0.0)
    >>> print(np.log10(state.relative_contact_area).round(2))
    [-4.09 -4.13]
    """
    humidity, kelvin = floats(relative_humidity, temperature)
    with np.errstate(all="ignore"):
        each, first, second = (
            np.asarray(x, dtype=np.float64)[..., None]
            for x in (kelvin, contact_angle_skin, contact_angle_counterface)
        )
        gap = kelvin_gap(kelvin_radius(humidity, each), first, contact_angle_counterface=second)
        tension = surface_tension_of_water(kelvin)
    state = capillary_state_at_gap(
        gap,
        nominal_pressure,
        spectrum=spectrum,
        skin=skin,
        surface_tension=tension,
        contact_angle_skin=contact_angle_skin,
        contact_angle_counterface=contact_angle_counterface,
        area_correction=area_correction,
        closure=closure,
        branch=branch,
        count=count,
    )
    # one humidity has no axis of its own
    return (
        state
        if humidity.ndim
        else CapillaryState(**{x.name: getattr(state, x.name)[..., 0] for x in fields(state)})
    )


def young_modulus_at_humidity(
    relative_humidity: ArrayLike,
    young_modulus_dry: ArrayLike,
    *,
    young_modulus_wet: ArrayLike,
    transition_humidity: ArrayLike,
    sharpness: ArrayLike,
) -> FloatArray:
    """Young's modulus of the stratum corneum against humidity, a smooth description (for Fig. 17 of the paper).

    ``ln E0 = (1 − s) ln E_dry + s ln E_wet``, ``s = 1/(1 + [(1 − RH) RH_t/(RH (1 − RH_t))]^k)``: E_dry at 0, E_wet at
    100 %, their geometric mean at the transition RH_t.

    Parameters
    ----------
    relative_humidity : RH, dimensionless, 0 … 1, any shape
    young_modulus_dry : E_dry, Pa, > 0, broadcasts
    young_modulus_wet : E_wet, Pa, > 0, broadcasts
    transition_humidity : RH_t, dimensionless, between 0 and 1, both excluded, broadcasts
    sharpness : k, dimensionless, > 0, broadcasts; larger is more abrupt

    Returns
    -------
    young_modulus : Pa, broadcast shape; nan where an argument is impossible

    Notes
    -----
    A description, not a theory, and fitted to nothing: the points of Fig. 17 are not available. What is known are its
    ends (1 to 3 GPa dry, 5 to 10 MPa wet, as the paper has it) and that the layer of newborn rats turns from brittle to
    ductile near 70 % at 25 °C. Use priors on all four parameters, or a table of your own in place of this function.

    References
    ----------
    Papir, Hsu & Wildnauer, Biochim. Biophys. Acta 399 (1975) 170, doi 10.1016/0304-4165(75)90223-8 (transition near 70 %).
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Fig. 17).

    Examples
    --------
    >>> moduli = young_modulus_at_humidity([0.0, 0.5, 0.7, 0.9, 1.0], 1e9, young_modulus_wet=7e6,
    ...     transition_humidity=0.7, sharpness=1.5)
    >>> print((moduli / 1e6).round(1))
    [1000.   337.2   83.7   12.5    7. ]
    """
    humidity, dry, wet = floats(relative_humidity, young_modulus_dry, young_modulus_wet)
    middle, power = floats(transition_humidity, sharpness)
    with np.errstate(all="ignore"):
        possible = (humidity >= 0) & (humidity <= 1) & (dry > 0) & (wet > 0)
        possible = possible & (middle > 0) & (middle < 1) & (power > 0)
        odds = (1 - humidity) / humidity * (middle / (1 - middle))
        return np.where(possible, softened_modulus(dry, wet, 1 / odds, power), np.nan)[()]


def softened_modulus(
    young_modulus_dry: FloatArray, young_modulus_wet: FloatArray, wetness: FloatArray, sharpness: FloatArray
) -> FloatArray:
    """Geometric mean of two moduli (Pa) with the weight ``w^k/(1 + w^k)`` of the wet one, w = ``wetness`` from 0 to inf."""
    fraction = 1 / (1 + np.exp(-sharpness * np.log(wetness)))
    return np.asarray(young_modulus_dry * np.exp(fraction * np.log(young_modulus_wet / young_modulus_dry)))
