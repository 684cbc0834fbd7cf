"""From named inputs to skin in humid air; shared by the closures of the gaps and by the table of skins."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.forward.base import Inputs, Tables
from skinbayes.forward.contact_inputs import (
    PRESSURE_ALTERNATIVES,
    SKIN_DEFAULTS,
    nominal_pressure_of,
    validate_contact,
)
from skinbayes.wetting import kelvin_gap, kelvin_radius, surface_tension_of_water, young_modulus_at_humidity

CURVE_INPUTS = (
    "young_modulus_layer_dry",
    "young_modulus_layer_wet",
    "transition_humidity",
    "transition_sharpness",
)
"""Parameters of the modulus against humidity, see `skinbayes.wetting.young_modulus_at_humidity`."""

MODULUS_ALTERNATIVES = (("young_modulus_layer",), CURVE_INPUTS)
"""How the modulus of the layer can be given: itself, the same in all rows or one for each, or a curve against humidity."""

AIR_INPUTS = (
    "relative_humidity",
    "temperature",
    "contact_angle_skin",
    "contact_angle_counterface",
)

HUMID_AIR_INPUTS = (
    *AIR_INPUTS,
    "frictional_shear_stress",
    MODULUS_ALTERNATIVES,
    "young_modulus_bulk",
    "layer_thickness",
    PRESSURE_ALTERNATIVES,
)
"""Required inputs of all models of skin in humid air."""

HUMID_AIR_DEFAULTS = dict(SKIN_DEFAULTS)


def with_modulus(inputs: Inputs) -> dict[str, FloatArray]:
    """Return the inputs with ``young_modulus_layer`` [Pa] in place of its curve: as given, or of the curve at the humidity."""
    known = {name: value for name, value in inputs.items() if name not in CURVE_INPUTS}
    if "young_modulus_layer" not in known:
        curve = young_modulus_at_humidity(
            inputs["relative_humidity"], *(inputs[name] for name in CURVE_INPUTS)
        )
        known["young_modulus_layer"] = np.asarray(curve)
    return known


def kelvin_radius_of(inputs: Inputs) -> FloatArray:
    """Return r_K [m] of water at the temperature and humidity of the air."""
    return np.asarray(kelvin_radius(inputs["relative_humidity"], inputs["temperature"]))


def kelvin_gap_of(inputs: Inputs) -> FloatArray:
    """Return d_K [m], the largest gap that a bridge spans; 0 where there are none, inf in saturated air."""
    radius = kelvin_radius_of(inputs)
    found = kelvin_gap(radius, inputs["contact_angle_skin"], inputs["contact_angle_counterface"])
    return np.asarray(found)


def pull_strength_of(inputs: Inputs) -> FloatArray:
    """Return the Laplace pressure of the bridges over the nominal pressure, p_K/p0."""
    tension = surface_tension_of_water(inputs["temperature"])
    return np.asarray(tension / kelvin_radius_of(inputs) / nominal_pressure_of(inputs))


def validate_humid_air(inputs: Inputs, tables: Tables) -> None:
    """Raise InputError naming the input that cannot be: two ways to give the modulus, dry air, ice, or as in any contact."""
    curve = [name for name in CURVE_INPUTS if name in inputs]
    if "young_modulus_layer" in inputs and curve:
        raise InputError(
            f"young_modulus_layer and {curve[0]} exclude each other: the modulus of the layer is given, for all rows or as a "
            f"column, or follows the humidity by {', '.join(CURVE_INPUTS)}"
        )
    if (np.asarray(inputs["relative_humidity"]) <= 0).any():
        raise InputError(
            "relative_humidity: found 0; expected > 0 %, as perfectly dry air has no Kelvin length; 1 % is as dry as can be told"
        )
    coldest = float(np.min(inputs["temperature"]))
    if np.isnan(surface_tension_of_water(inputs["temperature"])).any():
        raise InputError(
            f"temperature: found {coldest:g} K; expected that of liquid water, from 273.15 to 647 K"
        )
    validate_contact(with_modulus(inputs), tables)
