"""From named inputs to drying skin; shared by the series ``drying`` and its features, in either closure of the gaps."""

from __future__ import annotations

from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import Inputs, Tables
from skinbayes.forward.capillary_film import WATER_INPUTS, Closure
from skinbayes.forward.contact_inputs import (
    GOES_WITH,
    PRESSURE_ALTERNATIVES,
    SKIN_DEFAULTS,
    SKIN_INPUTS,
    nominal_pressure_of,
    skin_of,
    spectrum_of,
)
from skinbayes.wetting import (
    FILM_FLOOR,
    LATENT_HEAT_OF_PAPER,
    BridgeTable,
    evaporation_rate,
    film_contact,
    film_of_droplet,
)

FILM_ALTERNATIVES = (("initial_film",), ("droplet_volume", "stroke_length", "contact_width"))
"""How the film right after wetting can be given; the first complete alternative is used."""

EVAPORATION_ALTERNATIVES = (
    ("evaporation_rate",),
    ("surface_temperature", "air_temperature", "relative_humidity"),
)
"""How evaporation can be given; the first complete alternative is used."""

DRYING_SOLIDS = ((*SKIN_INPUTS, "young_modulus_layer_dry"), ("young_modulus",))
"""How the solid can be given: skin whose layer hardens as it dries, or a homogeneous solid, which stays as it is."""

DRYING_GOES_WITH = {
    **GOES_WITH,
    **dict.fromkeys(("hardening_film", "hardening_sharpness"), "young_modulus_layer_dry"),
}
"""Inputs that have no meaning for one of them."""

DRYING_INPUTS = (
    "wetting_time",
    FILM_ALTERNATIVES,
    EVAPORATION_ALTERNATIVES,
    "frictional_shear_stress",
    DRYING_SOLIDS,
    PRESSURE_ALTERNATIVES,
    *WATER_INPUTS,
)
"""Required inputs of all models of drying skin."""

DRYING_DEFAULTS = {
    **SKIN_DEFAULTS,
    "air_speed": 0.0,
    "latent_heat": LATENT_HEAT_OF_PAPER,
    "film_spread": 2e-7,
    "film_floor": FILM_FLOOR,
    "hardening_sharpness": 2.0,
}
"""Still air, the paper's latent heat, a film that is even to 0.2 µm."""

DRYING_ACCEPTED = ("hardening_film",)
"""Without it the layer keeps its wet modulus down to the floor."""

_FILM_CONTACT = (
    *WATER_INPUTS, "yield_stress", "area_correction", "film_floor", "young_modulus_layer_dry", "hardening_film",
    "hardening_sharpness",
)  # fmt: skip


def initial_film_of(inputs: Inputs) -> FloatArray:
    """Return the film right after wetting [m]: as given, or that of a droplet spread over the track."""
    if "initial_film" in inputs:
        return np.asarray(inputs["initial_film"], dtype=float)
    volume, length, width = (inputs[name] for name in FILM_ALTERNATIVES[1])
    return np.asarray(film_of_droplet(volume, length, contact_width=width), dtype=float)


def evaporation_rate_of(inputs: Inputs) -> FloatArray:
    """Return the thickness evaporated per time [m/s]: as given, or Eq. 8 with the temperatures and the humidity."""
    if "evaporation_rate" in inputs:
        return np.asarray(inputs["evaporation_rate"], dtype=float)
    surface, air, humidity = (inputs[name] for name in EVAPORATION_ALTERNATIVES[1])
    rate = evaporation_rate(
        surface_temperature=surface,
        air_temperature=air,
        relative_humidity=humidity,
        air_speed=inputs["air_speed"],
        latent_heat=inputs["latent_heat"],
    )
    return np.asarray(rate, dtype=float)


def explain_evaporation(inputs: Inputs) -> list[str]:
    """One sentence where water condenses."""
    if not (evaporation_rate_of(inputs) < 0).any():
        return []
    return [
        "water condenses on the skin instead of evaporating, and a film that grows is not described; nothing is predicted there"
    ]


def drying_arguments(
    inputs: Inputs, tables: Tables, closure: Closure, table: BridgeTable | None = None
) -> dict[str, Any]:
    """Return what `drying_curve` and `drying_features` take beside times, for inputs that broadcast to the batch."""
    pressure = nominal_pressure_of(inputs)
    contact = film_contact(
        pressure,
        spectrum_of(inputs, tables),
        skin=skin_of(inputs),
        closure=closure,
        table=table,
        **{name: inputs[name] for name in _FILM_CONTACT if name in inputs},
    )
    return {
        "initial_film": initial_film_of(inputs),
        "evaporation_rate": evaporation_rate_of(inputs),
        "contact": contact,
        "frictional_shear_stress": inputs["frictional_shear_stress"],
        "nominal_pressure": pressure,
        "film_spread": inputs["film_spread"],
    }
