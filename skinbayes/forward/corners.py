"""Corners of the box that the priors of a model span, for tables of skin."""

from __future__ import annotations

from skinbayes.arrays import FloatArray
from skinbayes.emulation import Box
from skinbayes.forward.base import ROUGHNESS_INPUTS, Ranges
from skinbayes.forward.contact_inputs import PRESSURE_ALTERNATIVES, SOLID_INPUTS

CONTACT_INPUTS = (
    *SOLID_INPUTS,
    *ROUGHNESS_INPUTS,
    "area_correction",
    *(name for names in PRESSURE_ALTERNATIVES for name in names),
)
"""Inputs on which the contact of skin depends, whichever way they are given."""


def known_ranges(ranges: Ranges, optional: dict[str, float]) -> dict[str, tuple[float, float]]:
    """The ranges, and the defaults of inputs that are not in them, SI."""
    return {**{name: (value, value) for name, value in optional.items()}, **ranges}


def corners(known: Ranges, names: tuple[str, ...]) -> dict[str, FloatArray] | None:
    """Inputs at all corners of their ranges, each of shape ``(corners,)``; None if more than twelve of them vary."""
    return Box({name: known[name] for name in names if name in known}).corners()
