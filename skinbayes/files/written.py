"""Values of Python as they are written in a model file: text with a unit."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from numbers import Real
from typing import Any

from skinbayes.errors import InputError
from skinbayes.statistics.families import FAMILIES
from skinbayes.statistics.priors import Prior


def written_value(value: Any, unit: str, where: str) -> Any:
    """A value as it stands in a model file.

    Parameters
    ----------
    value : text with a unit, which stays as it is; a quantity of `pint`; or a number in SI
    unit : SI unit of the value, ``"1"`` for dimensionless numbers
    where : its place, for messages

    Returns
    -------
    str or float
        text with a unit, or a number without one

    Raises
    ------
    InputError
        a quantity of another dimension, or something that is no value at all

    Examples
    --------
    >>> written_value(15e6, "Pa", "yield_stress"), written_value("15 MPa", "Pa", "yield_stress")
    ('15000000.0 Pa', '15 MPa')
    """
    if isinstance(value, str):
        return value
    if hasattr(value, "magnitude") and hasattr(
        value, "to"
    ):  # a quantity of pint, whose registry is the user's
        try:
            value = value.to("" if unit == "1" else unit).magnitude
        except Exception as error:
            raise InputError(
                f"{where}: found {value!s:.60}; expected a quantity in {unit} ({error!s:.100})"
            ) from None
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"{where}: found {value!r:.60}; expected a number in {unit}, or text with a unit")
    number = float(value)
    if unit == "1":
        return number
    return f"{number if math.isfinite(number) else str(number)} {unit}"


def written_parameter(entry: Any, unit: str, where: str) -> Any:
    """A fixed value or a prior as it stands in a model file.

    Parameters
    ----------
    entry : a value, a :class:`~skinbayes.statistics.priors.Prior` in SI, or what stands in a model file with values of Python:
        ``{"lognormal": [15e6, 0.5]}``, ``{"by": "state", "dry": …, "wet": …}``
    unit : SI unit of the parameter
    where : its place, for messages

    Examples
    --------
    >>> written_parameter({"lognormal": [15e6, 0.5], "source": "a guess"}, "Pa", "yield_stress")
    {'lognormal': ['15000000.0 Pa', 0.5], 'source': 'a guess'}
    """
    if isinstance(entry, Prior):
        entry = {entry.family: entry.arguments}
    if not isinstance(entry, Mapping):
        return written_value(entry, unit, where)
    found: dict[str, Any] = {}
    for key, value in entry.items():
        place = f"{where}.{key}"
        if key in ("source", "by", "same_as", "times"):
            found[key] = value
        elif key == "fixed":
            found[key] = written_value(value, unit, place)
        elif key == "population" and isinstance(value, Mapping):
            found[key] = _written_population(value, unit, place)
        elif key in FAMILIES:
            found[key] = _written_arguments(key, value, unit, place)
        else:  # a level
            found[key] = written_parameter(value, unit, place)
    return found


def _written_arguments(family: str, raw: Any, unit: str, where: str) -> Any:
    kinds = [argument.kind for argument in FAMILIES[family].arguments]
    several = isinstance(raw, Sequence) and not isinstance(raw, str)
    arguments = list(raw) if several else [raw]
    if len(arguments) != len(kinds):  # the reader of model files says so
        return arguments
    found = [
        written_value(argument, unit if kind == "value" else "1", where)
        for argument, kind in zip(arguments, kinds, strict=True)
    ]
    return found if several else found[0]


def _written_population(block: Mapping[str, Any], unit: str, where: str) -> dict[str, Any]:
    """``population`` of a parameter: its scales and effects are numbers unless they are given as text."""
    found: dict[str, Any] = {}
    for key, value in block.items():
        place = f"{where}.{key}"
        if key in ("within", "contrast") and isinstance(value, Mapping):
            found[key] = {
                name: written_parameter(entry, "1", f"{place}.{name}")
                if name in ("scale", "effect")
                else entry
                for name, entry in value.items()
            }
        elif key == "scale":
            found[key] = written_parameter(value, "1", place)
        else:
            found |= written_parameter({key: value}, unit, where)
    return found
