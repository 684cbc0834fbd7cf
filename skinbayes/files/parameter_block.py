"""One parameter of a model file: a fixed value or a prior, as a person writes it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any
from unicodedata import normalize

import numpy as np

from skinbayes.errors import InputError
from skinbayes.statistics.priors import FAMILIES, Prior, make_prior
from skinbayes.units import parse_quantity, unit_example
from skinbayes.vocabulary import LABELS, QUANTITIES, Quantity, lookup, suggestions

RESERVED_NAMES = ("chain", "draw", "row")
"""Dimensions of results."""


@dataclass(frozen=True)
class ParameterSpec:
    """A parameter of a model.

    Attributes
    ----------
    name : name in the vocabulary
    unit : SI unit
    by, level : what the parameter differs by (a label column, the observables, …) and the level it is for; otherwise None
    by_column : whether that is a label column of the rows
    value : SI value of a fixed parameter, else None
    prior : prior of a free parameter in SI, else None
    same_as, times : the parameter, or one level of it, that a tied one is a multiple of, and the multiple; it has neither value
        nor prior
    entry : value or prior as it was written, such as ``{"lognormal": ["15 MPa", 0.5]}``; None if nobody wrote it
    source : where value or prior come from, in a sentence
    """

    name: str
    unit: str
    by: str | None
    level: str | None
    value: float | None
    prior: Prior | None
    entry: Mapping[str, Any] | None = None
    source: str = ""
    by_column: bool = False
    same_as: str | None = None
    times: float = 1.0

    @classmethod
    def of_value(
        cls, name: str, value: float, source: str, entry: Mapping[str, Any] | None = None
    ) -> ParameterSpec:
        """A parameter that has one value, in SI, at all rows."""
        return cls(name, QUANTITIES[name].unit, None, None, value, None, entry, source)

    @property
    def label(self) -> str:
        """``name`` or ``name[level]``."""
        return self.name if self.level is None else f"{self.name}[{self.level}]"

    @property
    def prior_text(self) -> str:
        """Value or prior as it was written: ``lognormal(15 MPa, 0.5)``, ``fixed at 20 um``, ``= 0.5 × young_modulus_layer``."""
        if self.same_as is not None:
            return f"= {self.same_as}" if self.times == 1 else f"= {self.times:g} × {self.same_as}"
        if self.entry is None:
            return ""
        ((key, written),) = self.entry.items()
        return f"fixed at {_as_written(written)}" if key == "fixed" else f"{key}({_as_written(written)})"


def parse_parameter(
    quantity: Quantity,
    entry: Any,
    where: str,
    unit: str | None = None,
    by: str | None = None,
    level: str | None = None,
    may_be_tied: bool = False,
) -> ParameterSpec:
    """Turn ``{ lognormal = ["15 MPa", 0.5], source = "…" }`` or ``{ fixed = "20 um" }`` into a parameter.

    Parameters
    ----------
    quantity : what the parameter is; gives unit and physical range
    entry : the TOML value: a table, or a bare value, which is fixed
    where : file and key, for messages
    unit : SI unit if other than the quantity's (noise in the unit of the observable)
    may_be_tied : whether ``{ same_as = "young_modulus_layer", times = 0.5 }`` has a meaning here

    Raises
    ------
    InputError
        Unknown family or key, wrong number or unit of arguments, value outside the physical range, or a prior with no
        probability inside that range.
    """
    unit = unit or quantity.unit
    if isinstance(entry, (str, int, float)) and not isinstance(entry, bool):
        entry = {"fixed": entry}
    if not isinstance(entry, dict):
        raise InputError(
            f"{where}: found {entry!r:.60}; expected a value with unit or a table such as {_example(unit)}"
        )
    source = entry.get("source", "")
    if not isinstance(source, str):
        raise InputError(f"{where}.source: found {source!r:.60}; expected a sentence in quotes")
    if "same_as" in entry:
        if not may_be_tied:
            raise InputError(
                f"{where}: only inputs of the forward model, in [parameters], can be tied with 'same_as'"
            )
        same_as, times = _parse_tie(entry, where)
        return ParameterSpec(
            quantity.name, unit, by, level, None, None, dict(entry), source, same_as=same_as, times=times
        )
    keys = [key for key in entry if key != "source"]
    unknown = [key for key in keys if key != "fixed" and key not in FAMILIES]
    if unknown:
        known = ["fixed", *(["same_as"] if may_be_tied else []), *FAMILIES]
        raise InputError(
            f"{where}: unknown key '{unknown[0]:.60}'.{suggestions(unknown[0], known)} "
            f"Expected one of {', '.join(known)}, and 'source'"
        )
    if len(keys) != 1:
        raise InputError(
            f"{where}: found {len(keys)} priors or values ({', '.join(keys) or 'none':.60}); expected exactly one"
        )
    key = keys[0]
    if key == "fixed":
        value, prior = parse_value(quantity, entry["fixed"], where, unit), None
    else:
        value, prior = None, _parse_prior(quantity, key, entry[key], f"{where}.{key}", unit)
    return ParameterSpec(quantity.name, unit, by, level, value, prior, {key: entry[key]}, source)


def parse_levels(
    quantity: Quantity,
    entry: Any,
    where: Callable[..., str],
    unit: str | None = None,
    may_be_tied: bool = False,
) -> list[ParameterSpec]:
    """Turn an entry into one parameter, or into one for each level of the grouping column that it names with ``by``.

    ``where`` gives the place of the entry, and of keys below it, for messages. Raises :class:`InputError` as
    `parse_parameter` does, and for a column that cannot group or has no levels.
    """
    if not (isinstance(entry, dict) and "by" in entry):
        return [parse_parameter(quantity, entry, where(), unit, may_be_tied=may_be_tied)]
    column = label_column(entry["by"], where("by"))
    levels = {key: value for key, value in entry.items() if key != "by"}
    if not levels:
        raise InputError(f"{where()}: 'by = \"{column}\"' but no level is given")
    return [
        replace(
            parse_parameter(quantity, value, where(level), unit, column, level, may_be_tied), by_column=True
        )
        for level, value in levels.items()
    ]


def _parse_tie(entry: Mapping[str, Any], where: str) -> tuple[str, float]:
    """Name and multiple of ``{ same_as = "young_modulus_layer[dry]", times = 0.5, source = "…" }``."""
    other, times = entry["same_as"], entry.get("times", 1.0)
    if unknown := sorted(set(entry) - {"same_as", "times", "source"}):
        raise InputError(
            f"{where}: unknown key '{unknown[0]:.60}' beside 'same_as'; expected 'times' or 'source'"
        )
    if not isinstance(other, str):
        raise InputError(f"{where}.same_as: found {other!r:.60}; expected the name of a parameter in quotes")
    number = parse_quantity(times, "1", where=f"{where}.times")
    if not 0 < number < np.inf:
        raise InputError(f"{where}.times: found {_as_written(times)}; expected a finite number > 0")
    return normalize("NFC", other), number


def label_column(name: Any, where: str) -> str:
    """A name that a label column can have; :class:`InputError` for others, such as that of a quantity."""
    if not isinstance(name, str) or not name.strip() or name != name.strip() or lookup(name) is not None:
        raise InputError(
            f"{where}: found {name!r:.60}; expected a label column of the data, such as {', '.join(LABELS)}"
        )
    if name in RESERVED_NAMES or "/" in name:
        raise InputError(
            f"{where}: '{name:.60}' cannot stand in results; expected another name of the column"
        )
    return name


def parse_value(quantity: Quantity, raw: Any, where: str, unit: str | None = None) -> float:
    """Read one value of ``quantity``: text with unit, a bare number if dimensionless, or ``none`` where it has a meaning.

    Raises :class:`InputError` for a missing or wrong unit and for a value outside the physical range.
    """
    unit = unit or quantity.unit
    if quantity.none_means is not None and isinstance(raw, str) and raw.strip().lower() == "none":
        return quantity.none_means
    value = parse_quantity(raw, unit, where=where)
    if not quantity.admits(value):
        raise InputError(
            f"{where}: found {_as_written(raw)}; expected a {quantity.name} {quantity.range_text()}"
        )
    if value != 0 and isfinite(value) and not SMALLEST <= abs(value) <= LARGEST:
        raise InputError(f"{where}: found {_as_written(raw)}; expected {_sizes(quantity, unit)}")
    return value


def _parse_prior(quantity: Quantity, family: str, raw: Any, where: str, unit: str) -> Prior:
    arguments = raw if isinstance(raw, list) else [raw]
    expected = FAMILIES[family].arguments
    if len(arguments) != len(expected):
        raise InputError(
            f"{where}: found {len(arguments)} arguments; expected {len(expected)}: "
            f"[{', '.join(argument.name for argument in expected)}]"
        )
    if FAMILIES[family].dimensionless and unit != "1":
        raise InputError(
            f"{where}: {family} is for dimensionless parameters; {quantity.name} has the unit {unit}"
        )
    numbers = [
        parse_quantity(
            given,
            unit if argument.kind == "value" else "1",
            where=f"{where} ({argument.name})",
            difference=argument.is_width,
        )
        for given, argument in zip(arguments, expected, strict=True)
    ]
    try:
        prior = make_prior(family, numbers)
        low, high = prior.support
        if low < quantity.lower or high > quantity.upper:
            prior = prior.truncated(quantity.lower, quantity.upper)
    except InputError as error:
        raise InputError(f"{where}: {error} ({quantity.name} must be {quantity.range_text()})") from None
    _check_sizes(prior, quantity, where, unit)
    return prior


SMALLEST, LARGEST = 1e-30, 1e30
"""Sizes of numbers in SI that anything about skin has, with a wide margin; products of powers of them stay numbers."""

TAIL = 0.01
"""Fraction of a prior that may lie beyond these sizes at either end."""


def _check_sizes(prior: Prior, quantity: Quantity, where: str, unit: str) -> None:
    """Refuse a prior of which a noticeable part is too large or too small to be computed with."""
    with np.errstate(all="ignore"):
        low, high = (float(prior.quantile(fraction)) for fraction in (TAIL, 1 - TAIL))
    # one that goes through zero has any number of small values, and none of them matters
    smallest = low if prior.support[0] >= 0 else max(-low, high)
    if not (smallest >= SMALLEST and max(abs(low), abs(high)) <= LARGEST):
        raise InputError(
            f"{where}: 98 % of this prior lies between {low:.3g} and {high:.3g} in SI; expected {_sizes(quantity, unit)}"
        )


def _sizes(quantity: Quantity, unit: str) -> str:
    in_unit = "" if unit == "1" else f" {unit}"
    return f"a {quantity.name} between {SMALLEST:g} and {LARGEST:g}{in_unit} in size"


def _as_written(raw: Any) -> str:
    return f"{', '.join(str(item) for item in raw) if isinstance(raw, list) else raw!s:.60}"


def _example(unit: str) -> str:
    text = unit_example(unit) if unit == "1" else f'"{unit_example(unit)}"'
    return f'{{ lognormal = [{text}, 0.5], source = "…" }} or {{ fixed = {text} }}'
