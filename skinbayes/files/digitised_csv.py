"""The CSV exports of WebPlotDigitizer: pairs of columns, one pair for each data set."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.digitised_set import DigitisedSet
from skinbayes.files.table import MAX_ROWS, Problems, quoted, text_lines

_POINT = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?")
_EXPECTED = "expected two columns of numbers, or pairs of columns under the names of the data sets"
_COLUMNS = ("abscissa", "ordinate")


@dataclass
class _Lines:
    """Cells of the lines of a file, and whether its decimal separator is a comma (None: no fraction seen yet)."""

    numbers: list[int] = field(default_factory=list)
    cells: list[list[str]] = field(default_factory=list)
    decimal_comma: bool | None = None
    separator: str = ","


def read_pairs(path: Path) -> tuple[DigitisedSet, ...]:
    """Data sets of a CSV export, in the order of its columns.

    Parameters
    ----------
    path : the file

    Raises
    ------
    InputError
        naming the line and column of the first problem and the number of the others
    """
    lines = _read(path)
    names, first = _header(path, lines)
    problems = Problems(path)
    points: list[list[tuple[float, float]]] = [[] for _ in names]
    places: list[list[str]] = [[] for _ in names]
    for number, cells in zip(lines.numbers[first:], lines.cells[first:], strict=True):
        if len(cells) != 2 * len(names):
            hint = ""
            if lines.separator == "," and len(cells) == 4 * len(names):
                hint = ". If commas are decimal separators, export with semicolons between cells"
            problems.add(number, 0, f": found {len(cells)} cells; expected {2 * len(names)} as above{hint}")
            continue
        for i in range(len(names)):
            pair = cells[2 * i : 2 * i + 2]
            if pair == ["", ""] and len(names) > 1:  # shorter than its neighbours
                continue
            values = [_number(cell, lines) for cell in pair]
            for j, value in enumerate(values):
                if value is None:
                    what = "an empty cell" if pair[j] == "" else quoted(pair[j])
                    column = f"column {2 * i + j + 1} ({_COLUMNS[j]}{_of(names[i])})"
                    problems.add(
                        number,
                        2 * i + j,
                        f", {column}: found {what}; expected a number{_why(pair[j], lines)}",
                    )
            if values[0] is not None and values[1] is not None:
                points[i].append((values[0], values[1]))
                places[i].append(f"line {number}{_of(names[i])}")
    problems.raise_if_any()
    if not any(points):
        raise InputError(f"{path}: no points; {_EXPECTED}")
    return tuple(
        DigitisedSet(name or path.stem, np.array(rows), tuple(where))
        for name, rows, where in zip(names, points, places, strict=True)
        if rows
    )


def _of(name: str) -> str:
    return f" of {quoted(name)}" if name else ""


def _read(path: Path) -> _Lines:
    found = list(text_lines(path))
    text = [(number, line) for number, line in found if line.strip()]
    if not text:
        raise InputError(f"{path}: the file is empty; {_EXPECTED}")
    if len(text) > MAX_ROWS:
        raise InputError(f"{path}: {len(text)} lines; expected at most {MAX_ROWS}")
    lines = _Lines()
    lines.separator = next((mark for mark in (";", "\t") if any(mark in line for _, line in text)), ",")
    for number, line in text:
        try:
            cells = next(csv.reader([line], delimiter=lines.separator, strict=True, skipinitialspace=True))
        except (csv.Error, StopIteration):
            raise InputError(f"{path}, line {number}: quotation marks do not match; {_EXPECTED}") from None
        lines.numbers.append(number)
        lines.cells.append([cell.strip() for cell in cells])
    cells_of_all = [cell for cells in lines.cells for cell in cells]
    points = any("." in cell and _POINT.fullmatch(cell) for cell in cells_of_all)
    commas = any(_COMMA.fullmatch(cell) for cell in cells_of_all)
    if commas and not points:
        lines.decimal_comma = True
    elif points:
        lines.decimal_comma = False
    return lines


def _number(cell: str, lines: _Lines) -> float | None:
    """The number in a cell, or None; a decimal comma counts only in a file without decimal points."""
    if _POINT.fullmatch(cell):
        value = float(cell)
    elif lines.decimal_comma and _COMMA.fullmatch(cell):
        value = float(cell.replace(",", "."))
    else:
        return None
    return value if abs(value) < float("inf") else None


def _why(cell: str, lines: _Lines) -> str:
    if _COMMA.fullmatch(cell) and lines.decimal_comma is False:
        return ". Other cells have decimal points: which of the two it is cannot be told"
    return ""


def _header(path: Path, lines: _Lines) -> tuple[list[str], int]:
    """Names of the data sets ("" for a single one without name) and the index of the first line of numbers."""
    first = lines.cells[0]
    where = f"{path}, line {lines.numbers[0]}"
    width = len(first)
    if width == 1:
        raise InputError(
            f"{where}: found a single column, {quoted(first[0])}; {_EXPECTED}, with commas, semicolons or tabs between them"
        )
    if width % 2:
        raise InputError(f"{where}: found {width} columns; {_EXPECTED}")
    names, between = first[::2], first[1::2]
    titles = len(lines.cells) > 1 and all(cell.upper() in ("X", "Y") for cell in lines.cells[1])
    if not titles and any(between) and any(_number(cell, lines) is not None for cell in first):
        if width > 2:
            hint = (
                " If commas are decimal separators, export with semicolons between cells"
                if width == 4
                else ""
            )
            raise InputError(
                f"{where}: found {width} columns without a header; {_EXPECTED}.{hint}".rstrip(".")
            )
        return [""], 0
    if width == 2:
        # "wet," above the columns is a name; "speed,friction" are titles of columns
        return [names[0] if between[0] == "" else ""], 2 if titles else 1
    if any(between) or not all(names):
        raise InputError(
            f"{where}: found {', '.join(quoted(cell) for cell in first[:8])}; expected the name of a data set above the "
            "first column of each pair and nothing above the second. A name must not contain the separator"
        )
    return names, 2 if titles else 1
