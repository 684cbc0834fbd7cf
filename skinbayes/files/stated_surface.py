"""What is known about a power spectrum beside its numbers: its convention, and what the surface was measured to have."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.modelschema import SurfaceBlock
from skinbayes.files.table import quoted
from skinbayes.roughness import CONVENTIONS
from skinbayes.units import format_quantity, parse_quantity


class StatedSurface(NamedTuple):
    """What a model file, or the comments of a CSV, say about a spectrum; None where they do not.

    Attributes
    ----------
    convention : one of `CONVENTIONS`
    rms_height_measured : m
    rms_slope_measured : dimensionless
    total_area_ratio_measured : true area over nominal area, dimensionless
    """

    convention: str | None = None
    rms_height_measured: float | None = None
    rms_slope_measured: float | None = None
    total_area_ratio_measured: float | None = None


MEASURED = {"rms_height_measured": "m", "rms_slope_measured": "1", "total_area_ratio_measured": "1"}
"""What may have been measured, and its unit."""


def stated_surface(given: Mapping[str, Any], where: Callable[[str], str]) -> StatedSurface:
    """Read what is stated about a spectrum; ``where`` gives the place of a key. InputError for a name or value that is none."""
    found: dict[str, Any] = {}
    for key, value in given.items():
        if key == "convention":
            if value not in CONVENTIONS:
                names = ", ".join(map(repr, CONVENTIONS))
                raise InputError(f"{where(key)}: found {quoted(str(value))}; expected one of {names}")
            found[key] = value
        else:
            measured = parse_quantity(value, MEASURED[key], where=where(key))
            least = 1.0 if key == "total_area_ratio_measured" else 0.0
            if not least < measured < np.inf:
                raise InputError(f"{where(key)}: found {value}; expected a number larger than {least:g}")
            found[key] = measured
    return StatedSurface(**found)


def stated_about(block: SurfaceBlock | None, where: Callable[..., str]) -> StatedSurface | None:
    """What ``[surface]`` states about its file."""
    given = {} if block is None else block.model_dump(include=set(StatedSurface._fields), exclude_none=True)
    if block is None or block.file is None:
        for key in given:
            raise InputError(f"{where('surface', key)}: no file is given that this is about; drop it")
        return None
    return stated_surface(given, lambda key: where("surface", key))


def stated_text(stated: StatedSurface | None) -> dict[str, str]:
    """The keys of ``[surface]`` that say it again."""
    if stated is None:
        return {}
    known = {key: value for key, value in stated._asdict().items() if value is not None}
    return {
        key: value if key == "convention" else format_quantity(value, MEASURED[key], 12)
        for key, value in known.items()
    }
