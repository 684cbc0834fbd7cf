"""Forward model ``drying``: friction of skin that is wetted and dries, through its peak (Sect. 5, Eq. 8, Fig. 7)."""

from __future__ import annotations

from functools import partial

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.alike_rows import along_rows
from skinbayes.forward.base import ForwardModel, Inputs, Profile, Tables
from skinbayes.forward.capillary_film import WATER_INPUTS
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
from skinbayes.wetting import FILM_FLOOR, drying_curve, evaporation_rate, film_contact, film_of_droplet

FILM_ALTERNATIVES = (("initial_film",), ("droplet_volume", "stroke_length", "contact_width"))
"""How the film right after wetting can be given; the first complete alternative is used."""

EVAPORATION_ALTERNATIVES = (
    ("evaporation_rate",),
    ("surface_temperature", "air_temperature", "relative_humidity"),
)
"""How evaporation can be given; the first complete alternative is used."""

OBSERVABLES = ("friction_coefficient", "film_thickness", "relative_contact_area")


def initial_film_of(inputs: Inputs) -> FloatArray:
    """Return the film right after wetting [m]: as given, or that of a droplet spread over the track."""
    if "initial_film" in inputs:
        return np.asarray(inputs["initial_film"], dtype=float)
    volume, length, width = (inputs[name] for name in FILM_ALTERNATIVES[1])
    return np.asarray(film_of_droplet(volume, length, width), dtype=float)


def evaporation_rate_of(inputs: Inputs) -> FloatArray:
    """Return the thickness evaporated per time [m/s]: as given, or Eq. 8 with the temperatures and the humidity."""
    if "evaporation_rate" in inputs:
        return np.asarray(inputs["evaporation_rate"], dtype=float)
    surface, air, humidity = (inputs[name] for name in EVAPORATION_ALTERNATIVES[1])
    return np.asarray(evaporation_rate(surface, air, humidity, inputs["air_speed"]), dtype=float)


def _dried(inputs: Inputs, time: FloatArray, tables: Tables) -> dict[str, FloatArray]:
    pressure = nominal_pressure_of(inputs)
    contact = film_contact(
        pressure,
        spectrum_of(inputs, tables),
        skin_of(inputs),
        inputs["surface_tension"],
        inputs["contact_angle_skin"],
        inputs["contact_angle_counterface"],
        inputs["young_modulus_layer_dry"],
        inputs["yield_stress"],
        inputs["area_correction"],
        film_floor=inputs["film_floor"],
        hardening_film=inputs.get("hardening_film"),
        hardening_sharpness=inputs["hardening_sharpness"],
    )
    curve = drying_curve(
        time,
        inputs["wetting_time"],
        initial_film_of(inputs),
        evaporation_rate_of(inputs),
        contact,
        inputs["frictional_shear_stress"],
        pressure,
        inputs["film_spread"],
    )
    return {name: np.asarray(getattr(curve, name)) for name in OBSERVABLES}


def _evaluate(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    # noise that differs by row must not part rows that share a curve
    known = {name: value for name, value in inputs.items() if name in MODEL.input_names()}
    return along_rows(known, "time", partial(_dried, tables=tables))


def _grid(inputs: Inputs, tables: Tables) -> FloatArray:
    """From a little before wetting until a little after the film is gone."""
    start = float(np.median(inputs["wetting_time"]))
    lasts = float(np.median(initial_film_of(inputs) / evaporation_rate_of(inputs)))
    return np.linspace(max(0.0, start - 0.1 * lasts), start + 1.1 * lasts, 301)


def _profile(inputs: Inputs, tables: Tables, time: FloatArray, observable: str) -> FloatArray:
    return _dried(inputs, time, tables)[observable]


TIMELINE = tuple(
    Profile(
        name=f"{observable}_against_time",
        title=title,
        abscissa="time",
        ordinate=observable,
        grid=_grid,
        evaluate=partial(_profile, observable=observable),
    )
    for observable, title in (
        ("film_thickness", "Water film against time"),
        ("relative_contact_area", "Contact area against time"),
        ("friction_coefficient", "Friction against time"),
    )
)
"""Film, contact area and friction one below the other, Fig. 7 of the paper."""

MODEL = ForwardModel(
    name="drying",
    summary="friction of skin that is wetted and dries, flooded, held by capillary bridges and dry, against time",
    observables=OBSERVABLES,
    required=(
        "time",
        "wetting_time",
        FILM_ALTERNATIVES,
        EVAPORATION_ALTERNATIVES,
        "frictional_shear_stress",
        *SKIN_INPUTS,
        "young_modulus_layer_dry",
        PRESSURE_ALTERNATIVES,
        *WATER_INPUTS,
    ),
    optional={
        **SKIN_DEFAULTS,
        "air_speed": 0.0,
        "film_spread": 2e-7,
        "film_floor": FILM_FLOOR,
        "hardening_sharpness": 2.0,
    },
    accepted=("hardening_film",),
    evaluate=_evaluate,
    validate=validate_contact,
    derived=pressure_and_slope,
    derived_names=("nominal_pressure", "rms_slope"),
    blocks=("rms_slope",),
    profiles=TIMELINE,
)
