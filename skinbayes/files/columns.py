"""From the text of a table to named columns in SI, checked against the vocabulary."""

from __future__ import annotations

import re
from math import inf

import numpy as np
from numpy.typing import NDArray

from skinbayes import vocabulary
from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.table import Problems, Table, quoted
from skinbayes.units import convert_array, describe_unit, split_header
from skinbayes.vocabulary import Quantity

LabelArray = NDArray[np.str_]

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_INFINITE = re.compile(r"[+-]?inf(?:inity)?", re.IGNORECASE)
_DECIMAL_COMMA = re.compile(r"[+-]?[0-9]+,[0-9]+(?:[eE][+-]?[0-9]+)?")
_MISSING = frozenset({"", "nan", "na", "n/a", "null", "none", "-", "--", "#n/a", "missing"})
_LONGEST_LABEL = 200


def read_quantity(
    table: Table,
    position: int,
    quantity: Quantity,
    unit: str,
    problems: Problems,
    *,
    difference: bool = False,
) -> FloatArray:
    """One numeric column in SI, shape (n_rows,); cells that cannot be used are noted in ``problems``.

    Parameters
    ----------
    table, position : the table and the column in it
    quantity : what the column holds
    unit : unit written in the header
    problems : collects what is wrong
    difference : True for spreads, whose conversion has no offset
    """
    cells = table.column(position)
    written = np.array([_number(cell) for cell in cells])
    where = f"{table.path}, line {table.header_line}, column '{table.header[position].strip()}'"
    values = convert_array(written, unit, quantity.unit, where, difference=difference)
    if quantity.admits(values.min()) and quantity.admits(values.max()):  # the range has no gaps; nan fails
        return values
    for row, value in enumerate(values.tolist()):
        if not quantity.admits(value):
            found = _found(cells[row], unit, value, quantity)
            problems.add(table.lines[row], position, f", column '{quantity.name}': {found}")
    return values


def _number(cell: str) -> float:
    if _NUMBER.fullmatch(cell):
        return float(cell)
    if _INFINITE.fullmatch(cell):
        return -inf if cell.startswith("-") else inf
    return float("nan")


def _found(cell: str, unit: str, value: float, quantity: Quantity) -> str:
    expected = f"expected {quantity.range_text()}"
    if cell.lower() in _MISSING:
        what = "an empty cell" if cell == "" else f"{quoted(cell)} (a missing value)"
        return f"found {what}; {expected}. Leave out rows without a value"
    if _DECIMAL_COMMA.fullmatch(cell):
        return f"found {quoted(cell)}, a decimal comma; write a decimal point; {expected}"
    if value != value:
        return f"found {quoted(cell)}, which is not a number; {expected}"
    shown = cell if unit in ("1", "-") else f"{cell} {unit}"
    in_si = "" if unit in (quantity.unit, "-") else f" ({value:.6g}{_unit_after(quantity)} in SI)"
    return f"found {shown[:60]}{in_si}; {expected}"


def _unit_after(quantity: Quantity) -> str:
    return "" if quantity.unit == "1" else f" {quantity.unit}"


def read_labels(table: Table, position: int, name: str, problems: Problems) -> LabelArray:
    """One column of labels, shape (n_rows,); empty and unprintable labels are noted in ``problems``."""
    cells = table.column(position)
    for row, cell in enumerate(cells):
        if cell == "" or len(cell) > _LONGEST_LABEL or not cell.isprintable():
            found = "an empty cell" if cell == "" else quoted(cell)
            problems.add(
                table.lines[row],
                position,
                f", column '{name}': found {found}; expected 1 to {_LONGEST_LABEL} printable characters",
            )
    return np.array(cells, dtype=np.str_)


def read_columns(table: Table) -> tuple[dict[str, FloatArray | LabelArray], dict[str, str]]:
    """All columns of a table by name, numbers in SI, and the SI unit of each numeric column.

    Raises
    ------
    InputError
        naming the line and column of the first problem: an unknown or repeated column, a missing or wrong
        unit, a cell that is not a number, is missing, infinite or outside the physical range
    """
    problems = Problems(table.path)
    found: list[tuple[str, Quantity | None, str]] = []
    for position, header in enumerate(table.header):
        try:
            name, quantity, unit = _identify(header)
            if name in (other for other, _, _ in found):
                raise InputError(f"column '{name}' appears twice; expected each quantity once")
            found.append((name, quantity, unit))
        except InputError as error:
            problems.add(table.header_line, position, f": {error}")
    problems.raise_if_any()
    if all(quantity is None for _, quantity, _ in found):
        raise InputError(
            f"{table.path}, line {table.header_line}: no quantity among the columns; expected at least one "
            "header with a unit, such as 'friction_coefficient [1]'"
        )
    columns: dict[str, FloatArray | LabelArray] = {}
    units: dict[str, str] = {}
    for position, (name, quantity, unit) in enumerate(found):
        if quantity is None:
            columns[name] = read_labels(table, position, name, problems)
        else:
            spread = name not in vocabulary.QUANTITIES
            columns[name] = read_quantity(table, position, quantity, unit, problems, difference=spread)
            units[name] = quantity.unit
    problems.raise_if_any()
    return columns, units


def _identify(header: str) -> tuple[str, Quantity | None, str]:
    """Name, quantity (None for labels) and written unit of a header; InputError without place."""
    name, unit = split_header(header)
    if name in vocabulary.LABELS:
        if unit is not None:
            raise InputError(f"column '{name}' holds labels; expected no unit, found '[{unit[:40]}]'")
        return name, None, ""
    quantity = vocabulary.lookup(name)
    if quantity is None:
        known = [*vocabulary.QUANTITIES, *vocabulary.LABELS]
        guess = vocabulary.suggestions(name[:80].replace(" ", "_").lower(), known)
        what = "a column without a name" if name == "" else f"unknown column {quoted(name)}"
        if "(" in name:
            guess += " Units stand in square brackets."
        raise InputError(f"{what}; expected a quantity or label that skinbayes knows.{guess}".rstrip("."))
    if unit is None or unit == "":
        raise InputError(
            f"column '{name}' has no unit; expected {describe_unit(quantity.unit)}: "
            f"write '{name} [{quantity.unit}]'"
        )
    convert_array(
        1.0, unit, quantity.unit, f"column '{name}'"
    )  # so that a wrong unit counts among the problems
    return name, quantity, unit
