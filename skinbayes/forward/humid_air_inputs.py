"""From named inputs to skin in humid air; shared by the closures of the gaps and by the table of skins."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.errors import InputError
from skinbayes.forward.base import Inputs, Tables
from skinbayes.forward.contact_inputs import (
    PRESSURE_ALTERNATIVES,
    SKIN_DEFAULTS,
    check_one_solid,
    nominal_pressure_of,
    validate_contact,
)
from skinbayes.wetting import (
    humidity_at_surface,
    kelvin_gap,
    kelvin_radius,
    surface_tension_of_water,
    young_modulus_at_humidity,
)

CURVE_INPUTS = (
    "young_modulus_layer_dry",
    "young_modulus_layer_wet",
    "transition_humidity",
    "transition_sharpness",
)
"""Parameters of the modulus against humidity, see `skinbayes.wetting.young_modulus_at_humidity`."""

MODULUS_ALTERNATIVES = (("young_modulus_layer",), CURVE_INPUTS)
"""How the modulus of the layer can be given: itself, the same in all rows or one for each, or a curve against humidity."""

HUMID_SOLIDS = (
    *((*names, "young_modulus_bulk", "layer_thickness") for names in MODULUS_ALTERNATIVES),
    ("young_modulus",),
)
"""How the solid can be given: skin with either modulus of its layer, or a homogeneous solid, which is the same in any air."""

TEMPERATURE_ALTERNATIVES = (("temperature",), ("air_temperature", "surface_temperature"))
"""One temperature of skin and air alike, or that of the air in which the humidity was measured and that of the skin."""

AIR_INPUTS = (
    "relative_humidity",
    *(name for names in TEMPERATURE_ALTERNATIVES for name in names),
    "contact_angle_skin",
    "contact_angle_counterface",
)

HUMID_AIR_INPUTS = (
    "relative_humidity",
    TEMPERATURE_ALTERNATIVES,
    "contact_angle_skin",
    "contact_angle_counterface",
    "frictional_shear_stress",
    HUMID_SOLIDS,
    PRESSURE_ALTERNATIVES,
)
"""Required inputs of all models of skin in humid air."""

HUMID_AIR_DEFAULTS = dict(SKIN_DEFAULTS)


LINEAR_GAP = 2e-11
"""Gap in m, a fifteenth of a molecule, up to which the area of narrower gaps grows in proportion to it, to 0.2 %."""


def at_skin(inputs: Inputs) -> dict[str, FloatArray]:
    """Return the inputs with ``temperature`` [K] and ``relative_humidity`` at the skin in place of those of a room."""
    if "surface_temperature" not in inputs:
        return dict(inputs)
    air, surface = inputs["air_temperature"], inputs["surface_temperature"]
    known = {name: value for name, value in inputs.items() if not name.endswith("_temperature")}
    humidity = humidity_at_surface(
        relative_humidity=inputs["relative_humidity"], air_temperature=air, surface_temperature=surface
    )
    return known | {"temperature": surface, "relative_humidity": np.asarray(humidity)}


def with_modulus(inputs: Inputs) -> dict[str, FloatArray]:
    """Return the inputs at the skin, with ``young_modulus_layer`` [Pa] in place of its curve: as given, or that of the curve."""
    known = {name: value for name, value in at_skin(inputs).items() if name not in CURVE_INPUTS}
    if "young_modulus_layer" not in known and "young_modulus" not in known:
        curve = young_modulus_at_humidity(
            known["relative_humidity"],
            inputs["young_modulus_layer_dry"],
            young_modulus_wet=inputs["young_modulus_layer_wet"],
            transition_humidity=inputs["transition_humidity"],
            sharpness=inputs["transition_sharpness"],
        )
        known["young_modulus_layer"] = np.asarray(curve)
    return known


def kelvin_radius_of(inputs: Inputs) -> FloatArray:
    """Return r_K [m] of water at the temperature and humidity of the skin."""
    return np.asarray(kelvin_radius(inputs["relative_humidity"], inputs["temperature"]))


def bridges_form(inputs: Inputs) -> BoolArray:
    """Tell where water on skin and counterface makes bridges, cos θ1 + cos θ2 > 0."""
    return np.asarray(
        kelvin_gap(
            1.0, inputs["contact_angle_skin"], contact_angle_counterface=inputs["contact_angle_counterface"]
        )
        > 0
    )


def kelvin_gap_of(inputs: Inputs) -> FloatArray:
    """Return d_K [m], the largest gap that a bridge spans; 0 without bridges and in dry air, inf in saturated air."""
    radius = kelvin_radius_of(inputs)
    found = kelvin_gap(
        radius, inputs["contact_angle_skin"], contact_angle_counterface=inputs["contact_angle_counterface"]
    )
    return np.asarray(found)


def kelvin_gap_and_strength(inputs: Inputs) -> tuple[FloatArray, FloatArray]:
    """Return d_K [m] and the Laplace pressure over the nominal one, p_K/p0, both as if no gap were below `LINEAR_GAP`.

    In narrower gaps, those of very dry air and of water that hardly wets, the capillary pressure depends on p_K d_K alone.
    """
    gap, load = kelvin_gap_of(inputs), nominal_pressure_of(inputs)
    tension = surface_tension_of_water(inputs["temperature"])
    wetting = kelvin_gap(
        1.0, inputs["contact_angle_skin"], contact_angle_counterface=inputs["contact_angle_counterface"]
    )
    with np.errstate(all="ignore"):
        strength = np.where(
            gap < LINEAR_GAP, tension * wetting / LINEAR_GAP, tension / kelvin_radius_of(inputs)
        )
        return np.maximum(gap, LINEAR_GAP), np.asarray(strength / load)


def validate_humid_air(inputs: Inputs, tables: Tables) -> None:
    """Raise InputError naming the input that cannot be: two ways to give modulus or temperature, ice, or as in any contact."""
    check_one_solid(inputs)
    curve = [name for name in CURVE_INPUTS if name in inputs]
    if "young_modulus_layer" in inputs and curve:
        raise InputError(
            f"young_modulus_layer and {curve[0]} exclude each other: the modulus of the layer is given, for all rows or as a "
            f"column, or follows the humidity by {', '.join(CURVE_INPUTS)}"
        )
    temperatures = [name for names in TEMPERATURE_ALTERNATIVES for name in names if name in inputs]
    if "temperature" in temperatures and len(temperatures) > 1:
        raise InputError(
            f"temperature and {temperatures[1]} exclude each other: air and skin have one temperature, or air_temperature and "
            "surface_temperature are given"
        )
    for name in temperatures:
        values = np.asarray(inputs[name], dtype=float)
        frozen = values[np.isnan(surface_tension_of_water(values))]
        if frozen.size:
            raise InputError(
                f"{name}: found {frozen[0]:g} K ({frozen[0] - 273.15:.4g} degC); expected that of liquid water, from 273.15 K "
                "(0 degC) to 647 K"
            )
    validate_contact(with_modulus(inputs), tables)
