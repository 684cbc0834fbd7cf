"""Forward model ``capillary-film``: skin held by capillary bridges against the water film (Eqs. 5–7, Figs. 8–10)."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.alike_rows import along_rows
from skinbayes.forward.base import ForwardModel, Inputs, Tables
from skinbayes.forward.contact_inputs import (
    PRESSURE_ALTERNATIVES,
    SKIN_DEFAULTS,
    SKIN_INPUTS,
    nominal_pressure_of,
    pressure_and_slope,
    skin_of,
    spectrum_of,
    validate_contact,
)
from skinbayes.wetting import capillary_state

Closure = Literal["gaussian", "delta"]

WATER_INPUTS = ("surface_tension", "contact_angle_skin", "contact_angle_counterface")

BRIDGED_SKIN_DEFAULTS = {name: value for name, value in SKIN_DEFAULTS.items() if name != "yield_stress"}
"""Contact of bridged skin is elastic."""

OBSERVABLES = (
    "relative_contact_area",
    "wet_area",
    "mean_separation",
    "mean_separation_wet",
    "capillary_pressure",
)


def _bridged(inputs: Inputs, film: FloatArray, tables: Tables, closure: Closure) -> dict[str, FloatArray]:
    state = capillary_state(
        film,
        nominal_pressure_of(inputs),
        spectrum_of(inputs, tables),
        skin_of(inputs),
        inputs["surface_tension"],
        inputs["contact_angle_skin"],
        inputs["contact_angle_counterface"],
        inputs["area_correction"],
        closure,
    )
    return {name: np.asarray(getattr(state, name)) for name in OBSERVABLES}


def _evaluate(inputs: Inputs, tables: Tables, closure: Closure) -> dict[str, FloatArray]:
    # noise that differs by row must not part rows that share a curve
    known = {name: value for name, value in inputs.items() if name in MODEL.input_names()}
    return along_rows(known, "film_thickness", partial(_bridged, tables=tables, closure=closure))


def capillary_film_model(name: str, summary: str, closure: Closure) -> ForwardModel:
    """Return the forward model with one of the closures of the gap distribution."""
    return ForwardModel(
        name=name,
        summary=summary,
        observables=OBSERVABLES,
        required=("film_thickness", *SKIN_INPUTS, PRESSURE_ALTERNATIVES, *WATER_INPUTS),
        optional=BRIDGED_SKIN_DEFAULTS,
        evaluate=partial(_evaluate, closure=closure),
        validate=validate_contact,
        derived=pressure_and_slope,
        derived_names=("nominal_pressure", "rms_slope"),
        blocks=("rms_slope",),
    )


MODEL = capillary_film_model(
    "capillary-film", "contact and gaps of skin held by capillary bridges, against the water film", "gaussian"
)
