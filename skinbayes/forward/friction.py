"""Forward model ``friction``: μ = σ_f A/F_N with the contact area of layered, rough, elastoplastic skin (Sect. 4)."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
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
from skinbayes.forward.friction_terms import (
    ACCEPTED,
    GOES_WITH_TERMS,
    NOT_JKR,
    TERMS,
    adhesion_flags,
    after_occlusion,
    carried_share,
    grown,
    parts_of,
    under_adhesion,
    validate_terms,
)
from skinbayes.forward.ridges import CLOSING_RIDGES, contact_flags, explain_contact
from skinbayes.forward.small_contact import SMALL_CONTACT
from skinbayes.friction.coefficient import coefficient
from skinbayes.roughness import rms_slope


def _evaluate(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    if not TERMS.isdisjoint(inputs):
        return {"friction_coefficient": np.asarray(sum(parts_of(inputs, tables).values()))}
    pressure = pressure_on_skin_of(inputs)
    twice_variance = variance_of(inputs, tables)
    area = total_area(pressure, twice_variance, inputs["yield_stress"], inputs["area_correction"])
    return {"friction_coefficient": coefficient(inputs["frictional_shear_stress"], area, pressure)}


def _derived(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    parts = {} if TERMS.isdisjoint(inputs) else parts_of(inputs, tables)
    inputs = after_occlusion(inputs)
    carrying = under_adhesion(inputs)
    area = contact_area_of(carrying, tables, variance_of(inputs, tables))
    return {
        "nominal_pressure": np.asarray(nominal_pressure_of(carrying) / carried_share(inputs, carrying)),
        "rms_slope": rms_slope(spectrum_of(inputs, tables)),
        "relative_contact_area": np.asarray(area.total * grown(inputs)),
        "plastic_fraction": area.plastic_fraction,
        **(parts if len(parts) > 1 else {}),
    }


def _validate(inputs: Inputs, tables: Tables) -> None:
    validate_terms(inputs)
    validate_contact(inputs, tables)


def _flags(inputs: Inputs, tables: Tables) -> dict[str, BoolArray]:
    return contact_flags(under_adhesion(inputs), tables) | adhesion_flags(inputs)


def _explain(inputs: Inputs, tables: Tables) -> list[str]:
    said = explain_contact(under_adhesion(inputs), tables)
    for name, marked in adhesion_flags(inputs).items():
        if marked.any():
            said.append(f"{np.count_nonzero(marked)} of {marked.size} rows: {NOT_JKR[name]}.")
    return said


MODEL = ForwardModel(
    name="friction",
    summary="friction coefficient of skin on a smooth hard surface: shear stress times area of real contact over load",
    observables=("friction_coefficient",),
    required=("frictional_shear_stress", SOLID_ALTERNATIVES, PRESSURE_ALTERNATIVES),
    **{
        **FURTHER,
        "accepted": (*FURTHER["accepted"], *ACCEPTED),
        "goes_with": FURTHER["goes_with"] | GOES_WITH_TERMS,
    },
    evaluate=_evaluate,
    validate=_validate,
    explain=_explain,
    flags=_flags,
    flag_meanings=SMALL_CONTACT | CLOSING_RIDGES | NOT_JKR,
    parts=parts_of,
    derived=_derived,
    derived_names=("nominal_pressure", "rms_slope", "relative_contact_area", "plastic_fraction"),
    blocks=("rms_slope",),
    profiles=(CONTACT_AREA_PROFILE,),
)
