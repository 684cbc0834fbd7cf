"""The CSV exports of WebPlotDigitizer: pairs of columns, one pair for each data set."""

from __future__ import annotations

import re
from math import isfinite
from pathlib import Path

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.columns import number_in
from skinbayes.files.digitised_set import DigitisedSet
from skinbayes.files.reading import read_file
from skinbayes.files.separated import Records, decoded
from skinbayes.files.table import LARGEST_TABLE, Problems, quoted

_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?")
_EXPECTED = "expected two columns of numbers, or pairs of columns under the names of the data sets"
_SEMICOLONS = "If commas are decimal separators, export with semicolons between cells"


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
    records = _records(path)
    names, first = _header(path, records)
    problems = Problems(path)
    points: list[list[tuple[float, float]]] = [[] for _ in names]
    places: list[list[str]] = [[] for _ in names]
    for line, cells in records[first:]:
        if len(cells) != 2 * len(names):
            hint = f". {_SEMICOLONS}" if len(cells) == 4 * len(names) else ""
            problems.add(line, 0, f": found {len(cells)} cells; expected {2 * len(names)} as above{hint}")
            continue
        for i, name in enumerate(names):
            pair = cells[2 * i : 2 * i + 2]
            if pair == ["", ""] and len(names) > 1:  # shorter than its neighbours
                continue
            of = f" of {quoted(name)}" if name else ""
            numbers = [number_in(cell) for cell in pair]
            for j, axis in enumerate(("abscissa", "ordinate")):
                if not isfinite(numbers[j]):
                    what = quoted(pair[j]) if pair[j] else "an empty cell"
                    mixed = ". Other cells have decimal points: which of the two it is cannot be told"
                    why = mixed if _COMMA.fullmatch(pair[j]) else ""
                    column = f", column {2 * i + j + 1} ({axis}{of})"
                    problems.add(line, 2 * i + j, f"{column}: found {what}; expected a number{why}")
            points[i].append((numbers[0], numbers[1]))
            places[i].append(f"line {line}{of}")
    problems.raise_if_any()
    if not any(points):
        raise InputError(f"{path}: no points; {_EXPECTED}")
    found = zip(names, points, places, strict=True)
    return tuple(
        DigitisedSet(name or path.stem, np.array(rows), tuple(at)) for name, rows, at in found if rows
    )


def _records(path: Path) -> list[tuple[int, list[str]]]:
    """Line and cells of each row; with decimal points if the file has decimal commas and no points."""
    text = decoded(read_file(path, LARGEST_TABLE, "a CSV file"), path)
    separator = next((mark for mark in ";\t" if mark in text), ",")
    rows = [
        (line, [c.strip() for c in cells]) for line, cells in Records(text, path, separator, comments=False)
    ]
    if not rows:
        raise InputError(f"{path}: the file is empty; {_EXPECTED}")
    if any("." in cell and isfinite(number_in(cell)) for _, cells in rows for cell in cells):
        return rows
    return [
        (line, [c.replace(",", ".") if _COMMA.fullmatch(c) else c for c in cells]) for line, cells in rows
    ]


def _header(path: Path, records: list[tuple[int, list[str]]]) -> tuple[list[str], int]:
    """Names of the data sets ("" for a single one without name) and the index of the first row of numbers."""
    line, first = records[0]
    where, width = f"{path}, line {line}", len(first)
    if width == 1:
        raise InputError(
            f"{where}: found a single column, {quoted(first[0])}; {_EXPECTED}, with commas, semicolons or tabs between them"
        )
    if width % 2:
        raise InputError(f"{where}: found {width} columns; {_EXPECTED}")
    names, between = first[::2], first[1::2]
    titles = len(records) > 1 and all(cell.upper() in ("X", "Y") for cell in records[1][1])
    if not titles and any(between) and any(isfinite(number_in(cell)) for cell in first):
        if width == 2:
            return [""], 0
        hint = f". {_SEMICOLONS}" if width == 4 else ""
        raise InputError(f"{where}: found {width} columns without a header; {_EXPECTED}{hint}")
    if width == 2:  # "wet," above the columns is a name; "speed,friction" are titles of columns
        names = [names[0] if between[0] == "" else ""]
    elif any(between) or not all(names):
        raise InputError(
            f"{where}: found {', '.join(quoted(cell) for cell in first[:8])}; expected the name of a data set above the "
            "first column of each pair and nothing above the second. A name must not contain the separator"
        )
    return names, 2 if titles else 1
