"""Optional terms of dry friction: pressure in the real contact, adhesion, loss of the tissue, and time on the skin.

A term is there if its inputs are. Attraction is taken as an even pressure over the nominal contact, as that of capillary
bridges is: with adhesion all is as without it under the load F1 of `jkr_contact`, over the load that the balance shows.
"""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.contact import tabor_parameter
from skinbayes.contact.adhesion import jkr_carried_force
from skinbayes.contact.elastoplastic import total_area
from skinbayes.errors import InputError
from skinbayes.forward.base import Inputs, Tables
from skinbayes.forward.contact_inputs import (
    modulus_under_ball_of,
    nominal_pressure_of,
    pressure_on_skin_of,
    variance_of,
)
from skinbayes.friction import ball_hysteresis, contact_after_dwell, occluded_modulus, run_in_factor
from skinbayes.friction.coefficient import coefficient

BOUNDARY, PRESSURE, HYSTERESIS = (
    "friction_coefficient_boundary",
    "friction_coefficient_pressure",
    "friction_coefficient_hysteresis",
)

GOES_WITH_TERMS = {
    "work_of_adhesion": ("sphere_radius", "normal_force"),
    "loss_tangent_bulk": ("sphere_radius", "normal_force", "young_modulus_bulk"),
    "loss_tangent": ("sphere_radius", "normal_force", "young_modulus"),
    "initial_contact_fraction": ("contact_growth_time", "dwell_time"),
    "contact_growth_time": ("initial_contact_fraction", "dwell_time"),
    "occluded_modulus_ratio": ("occlusion_time", "dwell_time", "young_modulus_layer"),
    "occlusion_time": ("occluded_modulus_ratio", "dwell_time"),
    "run_in_ratio": ("run_in_cycles", "cycle"),
    "run_in_cycles": ("run_in_ratio", "cycle"),
}
"""Input of a term to all that it has no meaning without."""

TERMS = frozenset({"shear_pressure_coefficient", *GOES_WITH_TERMS})
"""Inputs that make a term."""

ACCEPTED = (*sorted(TERMS), "dwell_time", "cycle")
"""Inputs of all of them."""

FEWEST_TABOR = 5.0
"""Tabor parameter from which the contact is that of Johnson, Kendall and Roberts."""

NOT_JKR = {
    "not_jkr": f"the Tabor parameter is below {FEWEST_TABOR:g}, where attraction around the contact matters and the contact is "
    "smaller than computed"
}
"""The flag and what it says."""


def validate_terms(inputs: Inputs) -> None:
    """Raise InputError if adhesion meets a contact whose size is given."""
    given = [name for name in ("nominal_pressure", "nominal_contact_area") if name in inputs]
    if "work_of_adhesion" in inputs and given:
        raise InputError(
            f"work_of_adhesion enlarges the contact of a ball, and {given[0]} says how large it is; expected normal_force and "
            "sphere_radius alone"
        )


def after_occlusion(inputs: Inputs) -> Inputs:
    """Inputs with the modulus that the layer has after the dwell."""
    if "occluded_modulus_ratio" not in inputs:
        return inputs
    softened = occluded_modulus(
        inputs["young_modulus_layer"],
        inputs["occluded_modulus_ratio"],
        dwell_time=inputs["dwell_time"],
        occlusion_time=inputs["occlusion_time"],
    )
    return {**inputs, "young_modulus_layer": softened}


def under_adhesion(inputs: Inputs) -> Inputs:
    """Inputs with the load that the contact carries, of attraction and weight together."""
    if "work_of_adhesion" not in inputs:
        return inputs
    force, radius, work = (
        np.asarray(inputs[name], dtype=float)
        for name in ("normal_force", "sphere_radius", "work_of_adhesion")
    )
    return {**inputs, "normal_force": jkr_carried_force(force, radius, work)}


def carried_share(inputs: Inputs, carrying: Inputs) -> FloatArray | float:
    """Load that the contact carries over the normal force; 1 without adhesion."""
    return 1.0 if carrying is inputs else np.asarray(carrying["normal_force"] / inputs["normal_force"])


def grown(inputs: Inputs) -> FloatArray | float:
    """Real contact after the dwell over that after a long one; 1 where it does not grow."""
    if "initial_contact_fraction" not in inputs:
        return 1.0
    return contact_after_dwell(
        inputs["dwell_time"],
        inputs["contact_growth_time"],
        initial_contact_fraction=inputs["initial_contact_fraction"],
    )


def parts_of(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    """Parts of the friction coefficient, which add up to it: those that are there, that of the real contact always."""
    inputs = after_occlusion(inputs)
    carrying = under_adhesion(inputs)
    share = carried_share(inputs, carrying)
    pressure = pressure_on_skin_of(carrying)
    area = total_area(
        pressure, variance_of(inputs, tables), inputs["yield_stress"], inputs["area_correction"]
    )
    run_in: FloatArray | float = 1.0
    if "run_in_ratio" in inputs:
        run_in = run_in_factor(inputs["cycle"], inputs["run_in_cycles"], run_in_ratio=inputs["run_in_ratio"])
    boundary = coefficient(inputs["frictional_shear_stress"], area, pressure)
    parts = {BOUNDARY: np.asarray(boundary * share * grown(inputs) * run_in)}
    if "shear_pressure_coefficient" in inputs:
        rising = inputs["shear_pressure_coefficient"] * share * run_in
        parts[PRESSURE] = np.asarray(np.where(np.isfinite(boundary), rising, np.nan))
    for name in ("loss_tangent_bulk", "loss_tangent"):
        if name in inputs:
            width = np.sqrt(carrying["normal_force"] / (np.pi * nominal_pressure_of(carrying)))
            loss = ball_hysteresis(width, inputs["sphere_radius"], loss_tangent=inputs[name])
            parts[HYSTERESIS] = np.asarray(loss * share)
    return parts


def adhesion_flags(inputs: Inputs) -> dict[str, BoolArray]:
    """Tell where adhesion is not that of a soft ball; nothing without adhesion."""
    if "work_of_adhesion" not in inputs:
        return {}
    found = tabor_parameter(
        inputs["sphere_radius"], modulus_under_ball_of(inputs), work_of_adhesion=inputs["work_of_adhesion"]
    )
    return {"not_jkr": np.asarray((found < FEWEST_TABOR) & (inputs["work_of_adhesion"] > 0))}
