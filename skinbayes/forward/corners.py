"""Corners of the box that the priors of a model span, for tables of skin."""

from __future__ import annotations

from skinbayes.arrays import FloatArray
from skinbayes.emulation import Box
from skinbayes.forward.base import ROUGHNESS_INPUTS, Multiples, Ranges
from skinbayes.forward.contact_inputs import PRESSURE_ALTERNATIVES, SOLID_INPUTS

CONTACT_INPUTS = (
    *SOLID_INPUTS,
    *ROUGHNESS_INPUTS,
    "area_correction",
    *(name for names in PRESSURE_ALTERNATIVES for name in names),
)
"""Inputs on which the contact of skin depends, whichever way they are given."""


NO_TABLE = (
    "Bridges are solved anew at every evaluation, which is slow: the skins of the priors differ in too much for a table, or some "
    "of them have no bridges to solve. Narrower priors, fixed values, or inputs that are multiples of others (same_as) make one "
    "possible."
)
"""Why there is no table of bridges, and what to do."""


def known_ranges(ranges: Ranges, optional: dict[str, float]) -> dict[str, tuple[float, float]]:
    """The ranges, and the defaults of inputs that are not in them, SI."""
    return {**{name: (value, value) for name, value in optional.items()}, **ranges}


def corners(known: Ranges, names: tuple[str, ...], multiples: Multiples) -> dict[str, FloatArray] | None:
    """Inputs at all corners of their ranges, each of shape ``(corners,)``; None if more than twelve of them vary.

    What is a multiple of another input goes with it: a box of both would hold skins that the model does not have, some of them
    without a solution.
    """
    entering = [name for name in names if name in known]
    tied = {name: tie for name, tie in multiples.items() if name in entering and tie[0] in entering}
    found = Box({name: known[name] for name in entering if name not in tied}).corners()
    return None if found is None else found | {name: times * found[of] for name, (of, times) in tied.items()}
