"""From the text of a table to named columns in SI, checked against the vocabulary."""

from __future__ import annotations

import re
from math import inf
from typing import Any, Literal
from unicodedata import normalize

import numpy as np
from numpy.typing import NDArray

from skinbayes import vocabulary
from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.table import CsvTable, Problems, quoted
from skinbayes.units import (
    NUMBER,
    comma_advice,
    convert_array,
    converts,
    describe_unit,
    is_unit,
    split_header,
)
from skinbayes.vocabulary import Quantity

LabelArray = NDArray[np.str_]

_NUMERIC = re.compile(r"[+-]?[0-9.,]*[0-9][0-9.,]*(?:[eE][+-]?[0-9]+)?")
_INFINITE = re.compile(r"[+-]?inf(?:inity)?", re.IGNORECASE)
_MISSING = frozenset({"", "nan", "na", "n/a", "null", "none", "-", "--", "#n/a", "missing"})
LEAVE_OUT = "Leave out rows without a value"
DROP = 'or write missing = "drop" under [data] of the model file'
"""What to do about cells of a data set without a value."""

Missing = Literal["refuse", "keep"]

LONGEST_LABEL = 200
_LONGEST_SHOWN = 20
"""Characters of a cell that a message quotes."""


def read_quantity(
    table: CsvTable,
    position: int,
    quantity: Quantity,
    unit: str,
    problems: Problems,
    *,
    difference: bool = False,
    missing: Missing | None = None,
) -> FloatArray:
    """One numeric column in SI, shape (n_rows,); cells that cannot be used are noted in ``problems``.

    Parameters
    ----------
    table, position : the table and the column in it
    quantity : what the column holds
    unit : unit written in the header
    problems : collects what is wrong
    difference : True for spreads, whose conversion has no offset
    missing : whether cells without a value are problems, or kept as NaN; None where a model file cannot drop their rows
    """
    cells = table.column(position)
    written = np.array([number_in(cell) for cell in cells])
    where = f"{table.header_place}, column '{table.header[position].strip()}'"
    values = convert_array(written, unit, quantity.unit, where, difference=difference)
    if quantity.admits(values.min()) and quantity.admits(values.max()):  # the range has no gaps; nan fails
        return values
    for row, value in enumerate(values.tolist()):
        if not quantity.admits(value) and not (missing == "keep" and _is_missing(cells[row])):
            kind, found = _found(cells[row], unit, value, quantity)
            found += f", {DROP}" if kind == "missing" and missing else ""
            problems.add(table.lines[row], position, f", column '{quantity.name}': {found}", kind)
    return values


def _is_missing(cell: str) -> bool:
    return cell.lower() in _MISSING


def number_in(cell: str) -> float:
    """The number in a cell, NaN if there is none."""
    if NUMBER.fullmatch(cell):
        return float(cell)
    if _INFINITE.fullmatch(cell):
        return -inf if cell.startswith("-") else inf
    return float("nan")


def _found(cell: str, unit: str, value: float, quantity: Quantity) -> tuple[str, str]:
    """What kind of problem a cell has, and what to say about it."""
    expected = f"expected {quantity.range_text()}"
    if _is_missing(cell):
        what = "an empty cell" if cell == "" else f"{quoted(cell)} (a missing value)"
        return "missing", f"found {what}; {expected}. {LEAVE_OUT}"
    if advice := comma_advice(cell):
        if "." in cell and "," in cell[cell.rfind(".") :]:  # other cells had decimal commas, perhaps
            advice += f" ({cell.replace('.', '')} where the file has decimal commas)"
        return "comma", f"found {quoted(cell, _LONGEST_SHOWN)}, {advice}; {expected}"
    if value != value:
        return "text", f"found {quoted(cell, _LONGEST_SHOWN)}, which is not a number; {expected}"
    shown = cell if len(cell) <= _LONGEST_SHOWN else f"{cell[:_LONGEST_SHOWN]}..."
    shown += "" if unit in ("1", "-") else f" {unit}"
    in_si = "" if unit in (quantity.unit, "-") else f" ({value:.6g}{_unit_after(quantity)} in SI)"
    return "range", f"found {shown}{in_si}; {expected}"


def _unit_after(quantity: Quantity) -> str:
    return "" if quantity.unit == "1" else f" {quantity.unit}"


def read_labels(
    table: CsvTable, position: int, name: str, problems: Problems, missing: Missing = "refuse"
) -> LabelArray:
    """One column of labels, shape (n_rows,), on one line in Unicode normal form C; unusable ones are noted in ``problems``."""
    cells = [" ".join(normalize("NFC", cell).splitlines()) for cell in table.column(position)]
    for row, cell in enumerate(cells):
        if cell == "" and (missing == "keep" or name not in vocabulary.LABELS):
            continue  # a model that uses the column asks for values
        if cell == "" or len(cell) > LONGEST_LABEL or not cell.isprintable():
            found = "an empty cell" if cell == "" else quoted(cell, _LONGEST_SHOWN)
            problems.add(
                table.lines[row],
                position,
                f", column '{name}': found {found}; expected 1 to {LONGEST_LABEL} printable characters"
                + (f". {LEAVE_OUT}, {DROP}" if cell == "" else ""),
                "label",
            )
    return np.array(cells, dtype=np.str_)


def read_columns(
    table: CsvTable, problems: Problems | None = None, missing: Missing = "refuse"
) -> tuple[dict[str, FloatArray | LabelArray], dict[str, str]]:
    """All columns of a table by name, and the unit of each numeric column.

    Quantities are in SI. Those that are no words of the vocabulary are kept as they are written, for nothing uses them. A
    friction force beside a normal force makes the friction coefficient, see `add_friction_coefficient`.

    Parameters
    ----------
    table : the table
    problems : those found while the table was read
    missing : whether cells without a value are problems, or kept as NaN or empty labels

    Raises
    ------
    InputError
        with line and column of all problems: repeated columns, missing or wrong units, quantities that would be taken for
        labels, cells that are no number, missing, infinite or outside the physical range
    """
    problems = Problems(table.path, table.row_word) if problems is None else problems
    found: dict[int, tuple[str, Quantity | None, str | None]] = {}
    _refuse_foreign_header(table)
    for position, header in enumerate(table.header):
        try:
            name, quantity, unit = _identify(header, table.column(position))
            if name in (other for other, _, _ in found.values()):
                raise InputError(f"column '{name}' appears twice; expected each column once")
            found[position] = name, quantity, unit
        except InputError as error:
            problems.add(table.header_line, position, f": {error}")
    if not problems.count and all(quantity is None for _, quantity, _ in found.values()):
        guess = next((_guess(name, unit) for name, _, unit in found.values() if unit), "")
        raise InputError(
            f"{table.header_place}: no quantity that skinbayes knows among the columns; expected at least one header with a "
            f"unit, such as 'friction_coefficient [1]'.{guess}".rstrip(".")
        )
    columns: dict[str, FloatArray | LabelArray] = {}
    units: dict[str, str] = {}
    for position, (name, quantity, unit) in found.items() if table.rows else ():
        if unit is None:
            columns[name] = read_labels(table, position, name, problems, missing)
        elif quantity is None:
            columns[name] = np.array([number_in(cell) for cell in table.column(position)])
            units[name] = unit
        else:
            spread = vocabulary.spread_of(name) is not None
            columns[name] = read_quantity(
                table, position, quantity, unit, problems, difference=spread, missing=missing
            )
            units[name] = quantity.unit
    problems.raise_if_any()
    add_friction_coefficient(columns, units)
    return columns, units


def add_friction_coefficient(columns: dict[str, Any], units: dict[str, str]) -> None:
    """Add the friction coefficient of a friction force and a normal force, F_f/F_N, unless it is there.

    Its standard deviation (or standard error) is sqrt(s_f² + (μ s_N)²)/F_N with those of the two forces, taken as independent;
    it is added where the friction force has one, and that of the normal force is 0 where there is none.
    """
    if not {"friction_force", "normal_force"} <= columns.keys() or "friction_coefficient" in columns:
        return
    load = columns["normal_force"]
    ratio = columns["friction_force"] / load
    found = {"friction_coefficient": ratio}
    for suffix in (vocabulary.STANDARD_DEVIATION_SUFFIX, vocabulary.STANDARD_ERROR_SUFFIX):
        if (own := columns.get("friction_force" + suffix)) is not None:
            of_load = columns.get("normal_force" + suffix, 0.0)
            found["friction_coefficient" + suffix] = np.hypot(own, ratio * of_load) / load
    for name, values in found.items():
        columns.setdefault(name, values)
        units.setdefault(name, "1")


def known_names() -> list[str]:
    """Quantities and usual labels that a column of data may hold."""
    inner = ("noise_", "discrepancy_", "group_", "covariate_", "degrees_of_")
    return [name for name in (*vocabulary.QUANTITIES, *vocabulary.LABELS) if not name.startswith(inner)]


def _refuse_foreign_header(table: CsvTable) -> None:
    """Refuse a file of which no column is known, without quoting it: a model may name any file there is."""
    for header in table.header:
        name, _ = split_header(header)
        if name in vocabulary.LABELS or vocabulary.lookup(name) or _meant(name):
            return
    number = len(table.header)
    none = "its column has no name" if number == 1 else f"none of its {number} columns has a name"
    raise InputError(
        f"{table.header_place}: {none} that skinbayes knows; expected a header line such as "
        "'normal_force [N],friction_coefficient [1]'"
    )


def _identify(header: str, cells: list[str]) -> tuple[str, Quantity | None, str | None]:
    """Name, quantity (None if unknown) and written unit (None for labels) of a column; InputError without place."""
    name, unit = split_header(header)
    if name == "n" and unit in (None, "", "1", "-"):
        name = "number_of_measurements"
    if name == "number_of_measurements":
        unit = unit or "1"
    if name == "":
        raise InputError("a column without a name; give it one, or remove it")
    if not header.isprintable() or len(header) > LONGEST_LABEL:
        raise InputError(f"column {quoted(header, _LONGEST_SHOWN)}: expected a name of printable characters")
    if name in vocabulary.LABELS and unit is not None:
        raise InputError(f"column '{name}' holds labels; expected no unit, found '[{unit[:40]}]'")
    quantity = vocabulary.lookup(name)
    if quantity is None:
        if unit is None:
            refuse_quantity(name, cells)
        elif unit == "":
            raise InputError(f"column {quoted(name)} has no unit; expected one, or no brackets for labels")
        return name, None, unit
    if not unit:
        raise InputError(
            f"column '{name}' has no unit; expected {describe_unit(quantity.unit)}: "
            f"write '{name} [{quantity.unit}]'"
        )
    convert_array(
        1.0, unit, quantity.unit, f"column '{name}'"
    )  # so that a wrong unit counts among the problems
    return name, quantity, unit


def refuse_quantity(name: str, cells: list[str]) -> None:
    """Refuse a header without unit that names a quantity otherwise, or, above numbers only, nearly so."""
    if name in vocabulary.LABELS:
        return
    if "[" in name or "]" in name:
        raise InputError(
            f"column {quoted(name)}: expected a name, or a name with its unit in square brackets"
        )
    numbers = [bool(_NUMERIC.fullmatch(cell)) for cell in cells if not _is_missing(cell)]
    near = bool(numbers) and all(numbers)
    if len(name) == 1 and not near:  # a letter above words is no symbol
        return
    bases = [base for base, _ in _split_units(name)]
    quantities = [known for known in known_names() if known not in vocabulary.LABELS]
    if any(vocabulary.meant(base, quantities, near) for base in bases):
        raise InputError(
            f"unknown column {quoted(name)}; expected a quantity that skinbayes knows with its unit, or another name if it holds "
            f"labels.{_guess(name, None)}"
        )


def _meant(name: str) -> str:
    """The sentence on what a header may have been meant to be, its unit taken away; empty if there is none."""
    known = known_names()
    return next((said for base, _ in _split_units(name) if (said := vocabulary.suggestions(base, known))), "")


def _guess(name: str, unit: str | None) -> str:
    """What an unknown header may have been meant to be, and how that is written with its unit."""
    known = known_names()
    for base, apart in _split_units(name):
        for match, _ in vocabulary.meant(base, known):
            quantity, written = vocabulary.lookup(match), unit or apart
            if quantity is not None and written and converts(written, quantity.unit):
                where = "" if unit else ", with the unit in square brackets"
                return f"{vocabulary.suggestions(base, known)} Write '{match} [{written}]'{where}"
    found = vocabulary.meant(name, known)
    quantity = vocabulary.lookup(found[0][0]) if len(found) == 1 and not unit else None
    return _meant(name) + ("" if quantity is None else f" Write '{quantity.name} [{quantity.unit}]'")


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
