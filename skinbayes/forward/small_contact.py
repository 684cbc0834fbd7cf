"""A mark for contacts in which too little of the roughness lies for its statistics to hold."""

from __future__ import annotations

from typing import Any

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.contact import sphere_contact
from skinbayes.forward.base import Inputs, Tables
from skinbayes.forward.contact_inputs import (
    PRESSURE_AND_SLOPE,
    modulus_under_ball_of,
    nominal_pressure_of,
    spectrum_of,
    validate_contact,
)
from skinbayes.roughness import SelfAffineSpectrum

ENOUGH_WAVELENGTHS = 5.0
"""Width of the contact over the roll-off wavelength 2π/q_r below which it is marked. There the mean height over the contact
scatters by about 4 % of the rms height from place to place, 7 % of the mean separation; at 1.7 wavelengths by 22 and 42 %."""

SMALL_CONTACT = {
    "small_contact": f"the contact is narrower than {ENOUGH_WAVELENGTHS:g} roll-off wavelengths of the roughness, so that "
    "another place on the same skin has another friction"
}
"""The flag and what it says."""


def contact_width(inputs: Inputs) -> FloatArray:
    """Return the width of the nominal contact [m]; inf where only the pressure is known."""
    pressure = nominal_pressure_of(inputs)
    if "nominal_pressure" in inputs:
        return np.full(pressure.shape, np.inf)
    if "nominal_contact_area" in inputs:
        return np.asarray(2 * np.sqrt(inputs["nominal_contact_area"] / np.pi) + 0 * pressure)
    modulus = modulus_under_ball_of(inputs)
    return np.asarray(
        2
        * sphere_contact(
            inputs["normal_force"], inputs["sphere_radius"], reduced_modulus=modulus
        ).contact_radius
    )


def small_contact_flags(inputs: Inputs, tables: Tables) -> dict[str, BoolArray]:
    """Tell where the contact is too small; never where its size or the roll-off is not known."""
    width, spectrum = contact_width(inputs), spectrum_of(inputs, tables)
    if not isinstance(spectrum, SelfAffineSpectrum):
        return {"small_contact": np.zeros(width.shape, dtype=bool)}
    narrow = width * spectrum.wavevector_rolloff < ENOUGH_WAVELENGTHS * 2 * np.pi
    return {"small_contact": np.asarray(narrow)}


def explain_small_contact(inputs: Inputs, tables: Tables) -> list[str]:
    """One sentence where a contact is too small."""
    marked = small_contact_flags(inputs, tables)["small_contact"]
    count = int(np.count_nonzero(marked))
    return [f"{count} of {marked.size} rows: {SMALL_CONTACT['small_contact']}."] if count else []


ROUGH_CONTACT: dict[str, Any] = {
    "validate": validate_contact,
    "flags": small_contact_flags,
    "flag_meanings": SMALL_CONTACT,
    **PRESSURE_AND_SLOPE,
}
"""What all models of the contact of skin in water have in common."""
