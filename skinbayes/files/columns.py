"""From the text of a table to named columns in SI, checked against the vocabulary."""

from __future__ import annotations

import re
from math import inf
from unicodedata import normalize

import numpy as np
from numpy.typing import NDArray

from skinbayes import vocabulary
from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.table import Problems, Table, quoted
from skinbayes.units import comma_advice, convert_array, describe_unit, is_unit, split_header
from skinbayes.vocabulary import Quantity

LabelArray = NDArray[np.str_]

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_INFINITE = re.compile(r"[+-]?inf(?:inity)?", re.IGNORECASE)
_MISSING = frozenset({"", "nan", "na", "n/a", "null", "none", "-", "--", "#n/a", "missing"})
_LONGEST_LABEL = 200
_LONGEST_SHOWN = 20
"""Characters of a cell that a message quotes."""


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
            kind, found = _found(cells[row], unit, value, quantity)
            problems.add(table.lines[row], position, f", column '{quantity.name}': {found}", kind)
    return values


def _number(cell: str) -> float:
    if _NUMBER.fullmatch(cell):
        return float(cell)
    if _INFINITE.fullmatch(cell):
        return -inf if cell.startswith("-") else inf
    return float("nan")


def _found(cell: str, unit: str, value: float, quantity: Quantity) -> tuple[str, str]:
    """What kind of problem a cell has, and what to say about it."""
    expected = f"expected {quantity.range_text()}"
    if cell.lower() in _MISSING:
        what = "an empty cell" if cell == "" else f"{quoted(cell)} (a missing value)"
        return "missing", f"found {what}; {expected}. Leave out rows without a value"
    if advice := comma_advice(cell):
        return "comma", f"found {quoted(cell, _LONGEST_SHOWN)}, {advice}; {expected}"
    if value != value:
        return "text", f"found {quoted(cell, _LONGEST_SHOWN)}, which is not a number; {expected}"
    shown = cell if len(cell) <= _LONGEST_SHOWN else f"{cell[:_LONGEST_SHOWN]}..."
    shown += "" if unit in ("1", "-") else f" {unit}"
    in_si = "" if unit in (quantity.unit, "-") else f" ({value:.6g}{_unit_after(quantity)} in SI)"
    return "range", f"found {shown}{in_si}; {expected}"


def _unit_after(quantity: Quantity) -> str:
    return "" if quantity.unit == "1" else f" {quantity.unit}"


def read_labels(table: Table, position: int, name: str, problems: Problems) -> LabelArray:
    """One column of labels, shape (n_rows,), in Unicode normal form C; unusable labels are noted in ``problems``."""
    cells = [normalize("NFC", cell) for cell in table.column(position)]
    for row, cell in enumerate(cells):
        if cell == "" or len(cell) > _LONGEST_LABEL or not cell.isprintable():
            found = "an empty cell" if cell == "" else quoted(cell, _LONGEST_SHOWN)
            problems.add(
                table.lines[row],
                position,
                f", column '{name}': found {found}; expected 1 to {_LONGEST_LABEL} printable characters",
                "label",
            )
    return np.array(cells, dtype=np.str_)


def read_columns(
    table: Table, problems: Problems | None = None
) -> tuple[dict[str, FloatArray | LabelArray], dict[str, str]]:
    """All columns of a table by name, numbers in SI, and the SI unit of each numeric column.

    ``problems`` are those found while the table was read.

    Raises
    ------
    InputError
        with line and column of all problems: unknown or repeated columns, missing or wrong units, cells that are
        no number, missing, infinite or outside the physical range
    """
    problems = Problems(table.path) if problems is None else problems
    found: dict[int, tuple[str, Quantity | None, str]] = {}
    _refuse_foreign_header(table)
    for position, header in enumerate(table.header):
        try:
            name, quantity, unit = _identify(header)
            if name in (other for other, _, _ in found.values()):
                raise InputError(f"column '{name}' appears twice; expected each quantity once")
            found[position] = name, quantity, unit
        except InputError as error:
            problems.add(table.header_line, position, f": {error}")
    if not problems.count and all(quantity is None for _, quantity, _ in found.values()):
        raise InputError(
            f"{table.path}, line {table.header_line}: no quantity among the columns; expected at least one "
            "header with a unit, such as 'friction_coefficient [1]'"
        )
    columns: dict[str, FloatArray | LabelArray] = {}
    units: dict[str, str] = {}
    for position, (name, quantity, unit) in found.items() if table.rows else ():
        if quantity is None:
            columns[name] = read_labels(table, position, name, problems)
        else:
            spread = name not in vocabulary.QUANTITIES
            columns[name] = read_quantity(table, position, quantity, unit, problems, difference=spread)
            units[name] = quantity.unit
    problems.raise_if_any()
    return columns, units


_KNOWN = tuple(
    name
    for name in (*vocabulary.QUANTITIES, *vocabulary.LABELS)
    if not name.startswith(("noise_", "discrepancy_", "group_", "covariate_", "degrees_of_"))
)


def _refuse_foreign_header(table: Table) -> None:
    """Refuse a file of which no column is known, without quoting it: a model may name any file there is."""
    for header in table.header:
        name, _ = split_header(header)
        if name in vocabulary.LABELS or vocabulary.lookup(name) or _meant(name):
            return
    number = len(table.header)
    none = "its column has no name" if number == 1 else f"none of its {number} columns has a name"
    raise InputError(
        f"{table.path}, line {table.header_line}: {none} that skinbayes knows; expected a header line such as "
        "'normal_force [N],friction_coefficient [1]'"
    )


def _identify(header: str) -> tuple[str, Quantity | None, str]:
    """Name, quantity (None for labels) and written unit of a header; InputError without place."""
    name, unit = split_header(header)
    if name in vocabulary.LABELS:
        if unit is not None:
            raise InputError(f"column '{name}' holds labels; expected no unit, found '[{unit[:40]}]'")
        return name, None, ""
    quantity = vocabulary.lookup(name)
    if quantity is None:
        what = "a column without a name" if name == "" else f"unknown column {quoted(name)}"
        guess = _guess(name, unit)
        labels = f"; if the model does not need it, leave it out; labels are {', '.join(vocabulary.LABELS)}"
        raise InputError(
            f"{what}; expected a quantity or label that skinbayes knows{f'.{guess}' if guess else labels}"
        )
    if unit is None or unit == "":
        raise InputError(
            f"column '{name}' has no unit; expected {describe_unit(quantity.unit)}: "
            f"write '{name} [{quantity.unit}]'"
        )
    convert_array(
        1.0, unit, quantity.unit, f"column '{name}'"
    )  # so that a wrong unit counts among the problems
    return name, quantity, unit


def _meant(name: str) -> str:
    """The sentence on what a header may have been meant to be, its unit taken away; empty if there is none."""
    return next(
        (said for base, _ in _split_units(name) if (said := vocabulary.suggestions(base, _KNOWN))), ""
    )


def _guess(name: str, unit: str | None) -> str:
    """What an unknown header may have been meant to be, and how that is written with its unit."""
    for base, apart in _split_units(name):
        for match, _ in vocabulary.meant(base, _KNOWN):
            quantity = vocabulary.lookup(match)
            written = unit or apart
            if quantity is None or not (written and _converts(written, quantity.unit)):
                continue
            where = "" if unit else ", with the unit in square brackets"
            return f"{vocabulary.suggestions(base, _KNOWN)} Write '{match} [{written}]'{where}"
    said = _meant(name)
    found = vocabulary.meant(name, _KNOWN)
    quantity = vocabulary.lookup(found[0][0]) if len(found) == 1 else None
    return f"{said} Write '{quantity.name} [{quantity.unit}]'" if quantity is not None and not unit else said


def _split_units(name: str) -> list[tuple[str, str]]:
    """Ways to take a header without square brackets for a name and a unit: ``load (mN)``, ``load, mN``, ``load_mN``."""
    found = [(name, "")]
    if bracket := re.fullmatch(r"(.+?)[\s_]*[({<]\s*(.*?)\s*[)}>]", name):
        found.append((bracket[1], bracket[2]))
    apart = []
    if comma := re.fullmatch(r"(.+?)\s*(?:[,/]|\sin\s)\s*(.+)", name):
        apart.append((comma[1], comma[2]))
    words = re.split(r"[\s_]+", name)
    for tail in range(1, min(3, len(words))):
        base, unit = "_".join(words[:-tail]), words[-tail:]
        apart += [(base, "/".join(unit)), (base, " ".join(unit))][: len(unit)]
    return [*found, *((base, unit) for base, unit in apart if is_unit(unit))]


def _converts(unit: str, to_unit: str) -> bool:
    try:
        convert_array(1.0, unit, to_unit, "")
    except InputError:
        return False
    return True
