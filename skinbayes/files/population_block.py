"""``population`` of a parameter: values that differ from person to person, drawn from a population."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from skinbayes.errors import InputError
from skinbayes.files.group_block import scale_that_swallows
from skinbayes.files.parameter_block import ParameterSpec, label_column, parse_parameter
from skinbayes.statistics.families import FAMILIES
from skinbayes.statistics.transforms import Transform, transform_for
from skinbayes.vocabulary import QUANTITIES, Quantity, suggestions

POPULATION = "population"
"""Key of a parameter that has one, and what its scale, deviates and contrasts differ by."""

DEVIATE = "population_deviate"
"""Normal score of one person in the population."""

POPULATION_PARAMETERS = ("population_scale", DEVIATE, "contrast", "contrast_scale")
"""Parameters that a population adds."""

_KEYS = ("scale", "within", "contrast", "source")


@dataclass(frozen=True)
class ContrastSpec:
    """What a treatment does to a parameter.

    Attributes
    ----------
    column : label column of the treatment
    reference : its level without an effect
    effect : value or prior of the effect of every other level, on the scale of the population
    scale : how far the effect differs from person to person; None if it is the same for all
    """

    column: str
    reference: str
    effect: ParameterSpec
    scale: ParameterSpec | None


@dataclass(frozen=True)
class PopulationSpec:
    """A parameter with a value for each level of a label column, drawn from a population.

    Attributes
    ----------
    name : the parameter; what the model file has under this name is the median of the population
    by : the label column, such as ``"person"``
    scale : standard deviation between levels, on the scale of :attr:`natural`
    within : a second label column nested in the first, such as ``"body_site"``, or None
    within_scale : standard deviation between the levels of `within` of one level of `by`
    contrast : a treatment that acts on the parameter, or None
    """

    name: str
    by: str
    scale: ParameterSpec
    within: str | None = None
    within_scale: ParameterSpec | None = None
    contrast: ContrastSpec | None = None

    @property
    def natural(self) -> Transform:
        """The scale on which the population is normal: ln where a quantity is positive, logit where it has two ends."""
        return natural_scale(QUANTITIES[self.name])

    @property
    def columns(self) -> tuple[str, ...]:
        """Label columns that the data need."""
        treatment = None if self.contrast is None else self.contrast.column
        return tuple(column for column in (self.by, self.within, treatment) if column)


def natural_scale(quantity: Quantity) -> Transform:
    """ln of a quantity that has a lower end, logit of one with two, itself otherwise."""
    return transform_for((quantity.lower, quantity.upper))


def location_entry(entry: Any) -> Any:
    """What a parameter with a population has as prior of its median; other entries as they are."""
    if not is_population(entry):
        return entry
    block = entry[POPULATION]
    return {key: value for key, value in block.items() if key in ("fixed", "source", *FAMILIES)}


def is_population(entry: Any) -> bool:
    """Whether an entry of ``[parameters]`` has a population."""
    return (
        isinstance(entry, Mapping)
        and isinstance(entry.get(POPULATION), Mapping)
        and ("scale" in entry[POPULATION] or set(entry) <= {"by", POPULATION})
    )


def read_populations(block: Mapping[str, Any], where: Callable[..., str]) -> tuple[PopulationSpec, ...]:
    """Read the populations of ``[parameters]``; ``where`` gives the place of a key, for messages.

    Raises
    ------
    InputError
        An unknown or missing key, a column that cannot group, or a prior that lets people differ beyond all measure.
    """
    return tuple(
        _read(QUANTITIES[name], entry, lambda *keys, name=name: str(where("parameters", name, *keys)))
        for name, entry in block.items()
        if name in QUANTITIES and is_population(entry)
    )


def _read(quantity: Quantity, entry: Mapping[str, Any], where: Callable[..., str]) -> PopulationSpec:
    place, block = where(POPULATION), entry[POPULATION]
    if extra := sorted(set(entry) - {"by", POPULATION}):
        raise InputError(f"{where(extra[0])}: unknown key '{extra[0]:.60}' beside 'by' and 'population'")
    if "by" not in entry:
        raise InputError(
            f"{place}: found no 'by'; expected the label column of the population, such as by = \"person\""
        )
    by = label_column(entry["by"], where("by"))
    _known_keys(block, (*_KEYS, "fixed", *FAMILIES), where, POPULATION)
    if "scale" not in block:
        raise InputError(
            f"{place}: found no 'scale'; expected how far levels of {by} differ, such as {_usual(quantity)}"
        )
    scale = _scale(
        "population_scale", quantity, block["scale"], quantity.name, f"levels of {by}", where, "scale"
    )
    within, within_scale = None, None
    if (nested := block.get("within")) is not None:
        _known_keys(nested, ("column", "scale"), where, POPULATION, "within")
        within = label_column(
            _needed(nested, "column", where, "within"), where(POPULATION, "within", "column")
        )
        level, between = f"{quantity.name}, {within}", f"levels of {within} of one {by}"
        raw = _needed(nested, "scale", where, "within")
        within_scale = _scale("population_scale", quantity, raw, level, between, where, "within", "scale")
    found = PopulationSpec(
        quantity.name, by, scale, within, within_scale, _contrast(quantity, block, by, where)
    )
    if len(set(found.columns)) < len(found.columns):
        raise InputError(
            f"{place}: 'by', 'within' and 'contrast' name the columns {', '.join(found.columns)}; expected each once"
        )
    return found


def _contrast(
    quantity: Quantity, block: Mapping[str, Any], by: str, where: Callable[..., str]
) -> ContrastSpec | None:
    one = block.get("contrast")
    if one is None:
        return None
    _known_keys(one, ("column", "reference", "effect", "scale"), where, POPULATION, "contrast")
    column = label_column(_needed(one, "column", where, "contrast"), where(POPULATION, "contrast", "column"))
    reference = _needed(one, "reference", where, "contrast")
    if not isinstance(reference, str) or not reference:
        raise InputError(
            f"{where(POPULATION, 'contrast', 'reference')}: found {reference!r:.60}; expected the level of {column} without "
            "effect"
        )
    place, unit = where(POPULATION, "contrast", "effect"), _unit(quantity)
    raw = _needed(one, "effect", where, "contrast")
    effect = parse_parameter(QUANTITIES["contrast"], raw, place, unit, POPULATION, quantity.name)
    scale = None
    if "scale" in one:
        between = f"the effects on levels of {by}"
        scale = _scale(
            "contrast_scale", quantity, one["scale"], quantity.name, between, where, "contrast", "scale"
        )
    return ContrastSpec(column, reference, effect, scale)


def _scale(
    name: str,
    quantity: Quantity,
    raw: Any,
    level: str,
    between: str,
    where: Callable[..., str],
    *keys: str,
) -> ParameterSpec:
    """A standard deviation between levels, for ``level``; on the scale on which the population is normal."""
    place = where(POPULATION, *keys)
    spec = parse_parameter(QUANTITIES[name], raw, place, _unit(quantity), POPULATION, level)
    if natural_scale(quantity).kind != "identity":
        scale_that_swallows(spec, place, f"between {between}")
    return spec


def _unit(quantity: Quantity) -> str:
    return quantity.unit if natural_scale(quantity).kind == "identity" else "1"


def _usual(quantity: Quantity) -> str:
    plain = _unit(quantity) == "1"
    return "{ half_normal = 0.5 }" if plain else f'{{ half_normal = "1 {quantity.unit}" }}'


def _needed(block: Mapping[str, Any], key: str, where: Callable[..., str], table: str) -> Any:
    if key not in block:
        raise InputError(f"{where(POPULATION, table)}: found no '{key}'; expected it in '{table}'")
    return block[key]


def _known_keys(block: Any, known: tuple[str, ...], where: Callable[..., str], *keys: str) -> None:
    if not isinstance(block, Mapping):
        raise InputError(f"{where(*keys)}: found {block!r:.60}; expected a table with {', '.join(known[:4])}")
    if unknown := [key for key in block if key not in known]:
        raise InputError(
            f"{where(*keys)}: unknown key '{unknown[0]:.60}'.{suggestions(unknown[0], known)} "
            f"Expected {'one of ' if len(known) > 2 else ''}{', '.join(known)}"
        )


def of_level(spec: ParameterSpec, level: str) -> ParameterSpec:
    """The same value or prior for another level."""
    return replace(spec, level=level)
