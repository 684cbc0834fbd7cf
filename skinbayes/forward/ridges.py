"""Marks for contacts of which more than the roughness of a large flat matters: narrow ones, and ridges pressed flat."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import BoolArray
from skinbayes.contact import effective_modulus
from skinbayes.forward.base import Inputs, Tables
from skinbayes.forward.contact_inputs import nominal_pressure_of, skin_of
from skinbayes.forward.small_contact import explain_small_contact, small_contact_flags

CLOSING = 0.3
"""Nominal pressure over that which presses ridges flat above which they are marked: well below 1, since flat tops let the skin
between them rise earlier than those of a sinusoidal surface do."""

CLOSING_RIDGES = {
    "closing_ridges": f"the pressure is more than {CLOSING:g} of that which presses ridges of this height flat, so that valleys "
    "begin to carry load"
}
"""The flag and what it says."""


def contact_flags(inputs: Inputs, tables: Tables) -> dict[str, BoolArray]:
    """Tell where the contact is too small, and where ridges of known height are pressed flat.

    A sinusoidal surface of wavelength λ and height h from valley to top is flat under ``p = π E* h/(2λ)`` (Johnson, Contact
    Mechanics, Sect. 13.2), with E* that at the wavevector 2π/λ.
    """
    found = small_contact_flags(inputs, tables)
    if "ridge_height" not in inputs:
        return found
    spacing = np.asarray(inputs["ridge_spacing"], dtype=float)
    modulus = effective_modulus(skin_of(inputs), (2 * np.pi / spacing)[..., None])[..., 0]
    flattening = np.pi * modulus * inputs["ridge_height"] / (2 * spacing)
    return found | {"closing_ridges": np.asarray(nominal_pressure_of(inputs) > CLOSING * flattening)}


def explain_contact(inputs: Inputs, tables: Tables) -> list[str]:
    """A sentence for each flag that is raised."""
    said = explain_small_contact(inputs, tables)
    marked = contact_flags(inputs, tables).get("closing_ridges")
    if marked is not None and marked.any():
        said.append(f"{np.count_nonzero(marked)} of {marked.size} rows: {CLOSING_RIDGES['closing_ridges']}.")
    return said
