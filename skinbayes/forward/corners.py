"""Corners of the box that the priors of a model span, for tables of skin."""

from __future__ import annotations

from itertools import product

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import ROUGHNESS_INPUTS, Ranges
from skinbayes.forward.contact_inputs import PRESSURE_ALTERNATIVES, SOLID_INPUTS

CONTACT_INPUTS = (
    *SOLID_INPUTS,
    *ROUGHNESS_INPUTS,
    "area_correction",
    *(name for names in PRESSURE_ALTERNATIVES for name in names),
)
"""Inputs on which the contact of skin depends, whichever way they are given."""

_MOST = 12  # inputs that vary


def known_ranges(ranges: Ranges, optional: dict[str, float]) -> dict[str, tuple[float, float]]:
    """The ranges, and the defaults of inputs that are not in them, SI."""
    return {**{name: (value, value) for name, value in optional.items()}, **ranges}


def corners(known: Ranges, names: tuple[str, ...]) -> dict[str, FloatArray] | None:
    """Inputs at all corners of their ranges, each of shape ``(corners,)``; None if more than twelve of them vary.

    Examples
    --------
    >>> corners({"rms_height": (1e-5, 3e-5), "temperature": (293.0, 293.0)}, ("rms_height", "temperature"))
    {'rms_height': array([1.e-05, 3.e-05]), 'temperature': array([293., 293.])}
    """
    ends = {name: known[name] for name in names if name in known}
    if sum(high > low for low, high in ends.values()) > _MOST:
        return None
    found = np.array(list(product(*(sorted({low, high}) for low, high in ends.values())))).T
    return dict(zip(ends, found, strict=True))
