"""``[discrepancy]`` and ``[noise.correlation]`` of a model file: how rows scatter that are not independent."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from skinbayes.errors import InputError
from skinbayes.files.group_block import closed_form_noise, scale_that_swallows
from skinbayes.files.modelschema import CorrelationBlock, DiscrepancyBlock
from skinbayes.files.parameter_block import ParameterSpec, label_column, parse_parameter
from skinbayes.statistics.noise_families import NOISE_FAMILIES
from skinbayes.vocabulary import QUANTITIES, suggestions

ORDER = "order"
"""Stands for a column: the order of the rows, 1, 2, …"""

DISCREPANCY = "discrepancy"
"""What size and length of the discrepancy along several columns differ by."""

USUAL_SIZE = 0.3
"""Scale of the half-normal prior of the size of a discrepancy of ln, unless another is given."""

CORRELATION_KEYS = {
    "length": "correlation_length",
    "independent": "independent_fraction",
    "drift": "drift_scale",
}
"""Keys of ``[noise.correlation]`` that hold parameters, and their names."""

SCATTER_PARAMETERS = ("group_scale", "discrepancy_size", "discrepancy_length", *CORRELATION_KEYS.values())
"""Parameters of what rows share: they say how data scatter, and do not enter predictions."""


@dataclass(frozen=True)
class DiscrepancySpec:
    """What the forward model misses along columns, as smooth curves.

    Attributes
    ----------
    columns : numeric columns, one curve along each; their sum is the discrepancy
    within : label column whose levels have curves of their own, or None
    axis : ``"linear"``, ``"logarithmic"``, or None where the data decide
    parameters : sizes and lengths that the file gives, ``discrepancy_size[normal_force]``
    """

    columns: tuple[str, ...]
    within: str | None
    axis: str | None
    parameters: tuple[ParameterSpec, ...]


@dataclass(frozen=True)
class CorrelationSpec:
    """How the noise of neighbouring rows is correlated.

    Attributes
    ----------
    along : numeric column, or ``"order"``
    within : label column whose levels are series of their own, or None
    independent, drift : whether the noise has an independent part, and each series a drift
    parameters : length, independent fraction and scale of the drift, as far as the file gives them
    """

    along: str
    within: str | None
    independent: bool
    drift: bool
    parameters: tuple[ParameterSpec, ...]


def column_unit(column: str) -> str:
    """SI unit of a column along which rows are correlated."""
    return "1" if column == ORDER else QUANTITIES[column].unit


def read_discrepancy(
    block: DiscrepancyBlock | None, noise: Mapping[str, str], where: Callable[..., str]
) -> DiscrepancySpec | None:
    """Read ``[discrepancy]``.

    Raises
    ------
    InputError
        An unknown column, noise of another kind, several observables, or a prior that lets the curve swallow everything.
    """
    if block is None:
        return None
    family, unit = closed_form_noise(noise, where("discrepancy"), "a discrepancy along a column")
    columns = (block.along,) if isinstance(block.along, str) else tuple(block.along)
    if len(set(columns)) < len(columns):
        raise InputError(f"{where('discrepancy', 'along')}: names a column twice: {', '.join(columns)}")
    for column in columns:
        _known(column, where("discrepancy", "along"))
    if block.within is not None:
        label_column(block.within, where("discrepancy", "within"))
    size = block.size
    if size is None:
        if not NOISE_FAMILIES[family].logarithmic:
            raise InputError(
                f"{where('discrepancy')}: noise '{family}' is in the unit of the data, so that no size of the discrepancy is "
                f'usual; give one, such as size = {{ half_normal = "0.1 {unit}" }}'.replace(' 1"', '"')
            )
        size = {"half_normal": USUAL_SIZE, "source": "usual: the theory may miss some tens of percent"}
    found = []
    for column in columns:
        place = where("discrepancy", "size")
        quantity = QUANTITIES["discrepancy_size"]
        spec = parse_parameter(quantity, _of_column(size, column, place), place, unit, DISCREPANCY, column)
        if NOISE_FAMILIES[family].logarithmic:
            scale_that_swallows(spec, place, "between its ends")
        found.append(spec)
        if block.length is not None:
            place = where("discrepancy", "length")
            quantity = QUANTITIES["discrepancy_length"]
            entry = _of_column(block.length, column, place)
            found.append(parse_parameter(quantity, entry, place, "1", DISCREPANCY, column))
    return DiscrepancySpec(columns, block.within, block.axis, tuple(found))


def read_correlation(
    block: CorrelationBlock | None,
    noise: Mapping[str, str],
    noise_parameters: tuple[ParameterSpec, ...],
    spreads: tuple[str | None, ...],
    where: Callable[..., str],
) -> CorrelationSpec | None:
    """Read ``[noise.correlation]``; ``spreads`` are the keys ``spread`` and ``input_spread`` of ``[data]``.

    Raises
    ------
    InputError
        An unknown column, noise of another kind, several observables, or known spreads, which are independent.
    """
    if block is None:
        return None
    place = where("noise", "correlation")
    family, unit = closed_form_noise(noise, place, "correlated noise")
    _known(block.along, where("noise", "correlation", "along"))
    if "use" in spreads or any(p.name == "discrepancy_scale" for p in noise_parameters):
        raise InputError(
            f"{place}: all of the noise is correlated, which reading errors (spread, input_spread) and a discrepancy_scale are "
            "not; leave them out, or the correlation. 'independent' is the part of the noise that differs from row to row"
        )
    if block.within is not None:
        label_column(block.within, where("noise", "correlation", "within"))
    units = {"length": column_unit(block.along), "independent": "1", "drift": unit}
    found = []
    for key, name in CORRELATION_KEYS.items():
        entry = getattr(block, key)
        if entry is not None:
            spec = parse_parameter(QUANTITIES[name], entry, where("noise", "correlation", key), units[key])
            if key == "drift" and NOISE_FAMILIES[family].logarithmic:
                scale_that_swallows(spec, where("noise", "correlation", key), "between its ends")
            found.append(spec)
    return CorrelationSpec(
        block.along, block.within, block.independent is not None, block.drift is not None, tuple(found)
    )


def _of_column(entry: Any, column: str, place: str) -> Any:
    """The entry for one column: the same for all, or one for each under ``by = "column"``."""
    if not (isinstance(entry, dict) and entry.get("by") == "column"):
        return entry
    if column not in entry:
        raise InputError(f"{place}: nothing is given for the column '{column}'")
    return entry[column]


def _known(column: str, place: str) -> None:
    if column != ORDER and column not in QUANTITIES:
        raise InputError(
            f"{place}: unknown quantity '{column:.60}'.{suggestions(column, [*QUANTITIES, ORDER])} Expected a numeric column "
            f"of the data, or '{ORDER}' for the order of the rows"
        )
