"""Forward model ``friction``: μ = σ_f A/F_N with the contact area of layered, rough, elastoplastic skin (Sect. 4)."""

from __future__ import annotations

from skinbayes.arrays import FloatArray
from skinbayes.contact.elastoplastic import total_area
from skinbayes.forward.base import ForwardModel, Inputs, Tables
from skinbayes.forward.contact_area import CONTACT_AREA_PROFILE
from skinbayes.forward.contact_inputs import (
    FURTHER,
    PRESSURE_ALTERNATIVES,
    SOLID_ALTERNATIVES,
    contact_area_of,
    nominal_pressure_of,
    pressure_on_skin_of,
    spectrum_of,
    validate_contact,
    variance_of,
)
from skinbayes.forward.ridges import CLOSING_RIDGES, contact_flags, explain_contact
from skinbayes.forward.small_contact import SMALL_CONTACT
from skinbayes.friction import coefficient
from skinbayes.roughness import rms_slope


def _evaluate(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    pressure = pressure_on_skin_of(inputs)
    twice_variance = variance_of(inputs, tables)
    area = total_area(pressure, twice_variance, inputs["yield_stress"], inputs["area_correction"])
    return {"friction_coefficient": coefficient(inputs["frictional_shear_stress"], area, pressure)}


def _derived(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    area = contact_area_of(inputs, tables, variance_of(inputs, tables))
    return {
        "nominal_pressure": nominal_pressure_of(inputs),
        "rms_slope": rms_slope(spectrum_of(inputs, tables)),
        "relative_contact_area": area.total,
        "plastic_fraction": area.plastic_fraction,
    }


MODEL = ForwardModel(
    name="friction",
    summary="friction coefficient of skin on a smooth hard surface: shear stress times area of real contact over load",
    observables=("friction_coefficient",),
    required=("frictional_shear_stress", SOLID_ALTERNATIVES, PRESSURE_ALTERNATIVES),
    **FURTHER,
    evaluate=_evaluate,
    validate=validate_contact,
    explain=explain_contact,
    flags=contact_flags,
    flag_meanings=SMALL_CONTACT | CLOSING_RIDGES,
    derived=_derived,
    derived_names=("nominal_pressure", "rms_slope", "relative_contact_area", "plastic_fraction"),
    blocks=("rms_slope",),
    profiles=(CONTACT_AREA_PROFILE,),
)
