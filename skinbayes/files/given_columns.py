"""Columns that are at hand in Python as the table that a CSV of them would be."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.table import MAX_ROWS, MOST_COLUMNS, CsvTable, quoted
from skinbayes.units import describe_unit, split_header
from skinbayes.vocabulary import Quantity, lookup, spread_of

if TYPE_CHECKING:
    from pandas import DataFrame


def table_of_columns(columns: Mapping[str, Any] | DataFrame, name: str) -> CsvTable:
    """The table of a data frame or a mapping of headers to values, each of shape (n_rows,).

    Numbers become the shortest text that denotes them, missing values empty cells.

    Raises
    ------
    InputError
        for columns of different lengths or more than one dimension, too many of them or of their rows, none at all, or a
        ``pint`` quantity of another dimension than its name has
    """
    found: list[tuple[str, list[str]]] = []
    for key, values in columns.items():
        header = " ".join(str(key).split())
        place = f"{name}: column {quoted(header)}"
        header, values = _with_unit(header, values, place)
        found.append((header, _cells(values, place)))
    if not found or len(found) > MOST_COLUMNS:
        raise InputError(f"{name}: {len(found)} columns; expected 1 to {MOST_COLUMNS}")
    counts = {len(cells) for _, cells in found}
    if len(counts) > 1:
        lengths = ", ".join(f"{quoted(header)} {len(cells)}" for header, cells in found[:20])
        raise InputError(f"{name}: columns of different lengths ({lengths}); expected one value for each row")
    rows = counts.pop()
    if not 0 < rows <= MAX_ROWS:
        raise InputError(f"{name}: {rows} rows of data; expected 1 to {MAX_ROWS}")
    headers, cells = zip(*found, strict=True)
    return CsvTable(
        Path(name), headers, 0, tuple(range(1, rows + 1)), tuple(zip(*cells, strict=True)), "", "row"
    )


def _with_unit(header: str, values: Any, place: str) -> tuple[str, Any]:
    """Header with the unit of its values, and the bare values."""
    name, unit = split_header(header)
    quantity = lookup(name)
    if hasattr(values, "magnitude") and hasattr(values, "units"):  # of pint
        if unit is not None:
            raise InputError(
                f"{place}: the values have a unit of their own; expected the bare name of a quantity"
            )
        if quantity is None:
            raise InputError(f"{place}: no quantity that skinbayes knows; write the unit into the header")
        try:
            values = _in_si(values, quantity)
        except Exception:  # registries have errors of their own
            raise InputError(
                f"{place}: unit '{values.units}' has the wrong dimension; expected {describe_unit(quantity.unit)}"
            ) from None
    return (f"{name} [{quantity.unit}]" if quantity is not None and unit is None else header), values


def _in_si(values: Any, quantity: Quantity) -> Any:
    unit = "" if quantity.unit == "1" else quantity.unit
    magnitude = values.to(unit).magnitude
    if spread_of(quantity.name) is None:
        return magnitude
    return magnitude - type(values)(0.0, values.units).to(unit).magnitude  # a spread in degC has no offset


def _cells(values: Any, place: str) -> list[str]:
    from pandas import isna

    array = np.asarray(values, dtype=object)
    if array.ndim != 1:
        raise InputError(f"{place}: found values of shape {array.shape}; expected one for each row")
    return [
        "" if empty else _cell(value)
        for value, empty in zip(array.tolist(), isna(array).tolist(), strict=True)
    ]


def _cell(value: Any) -> str:
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return repr(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    return str(value).strip()
