"""Separated text of recordings: where its numbers begin, what its columns are called, and the numbers themselves, in pieces."""

from __future__ import annotations

import codecs
import re
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from io import TextIOWrapper
from pathlib import Path
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.reading import open_file, read_file
from skinbayes.files.recipe_schema import FileBlock
from skinbayes.files.separated import decoded
from skinbayes.files.table import quoted
from skinbayes.units import comma_advice, is_unit

LARGEST_RECORDING = 4_000_000_000
"""Bytes of a recording."""

PIECE = 200_000
"""Samples that are turned into numbers at a time."""

MISSING = ("", "nan", "NaN", "NAN", "na", "NA", "n/a", "N/A", "null", "-", "--", "#N/A")
SEPARATORS = {"tab": "\t", "semicolon": ";", "comma": ",", "blanks": r"\s+"}
_LOOKED_AT = 300_000  # bytes from the beginning
_ROWS = 20
_NUMBER = re.compile(r"[+-]?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+)(?:[eE][+-]?[0-9]+)?")
_WITH_UNIT = re.compile(
    r"(?P<name>.*?)\s*(?:\[(?P<square>[^\]]*)\]|\((?P<round>[^)]*)\)|/\s*(?P<slash>\S+)|,\s*(?P<comma>\S+))"
)


@dataclass(frozen=True)
class Layout:
    """How the numbers stand in a file.

    Attributes
    ----------
    path : the file
    encoding : of its text
    separator : name of what stands between cells, a key of `SEPARATORS`
    decimal : ``"."`` or ``","``
    header_lines : lines above the numbers
    width : cells of a line
    names, units : of the columns; empty text where there is none
    names_line : line of the names, 0 without
    """

    path: Path
    encoding: str
    separator: str
    decimal: str
    header_lines: int
    width: int
    names: tuple[str, ...]
    units: tuple[str, ...]
    names_line: int


def layout_of(path: Path, stated: FileBlock) -> Layout:
    """See how the numbers stand in a file, as far as that is not stated.

    The numbers begin at the first line from which on twenty lines have as many cells, the same of them numbers and at least one;
    of separators that fit, tabs come before semicolons, commas and blanks. Names stand on the line above, or two above if
    that one holds units.

    Raises
    ------
    InputError
        if the file cannot be read, or no such lines are found
    """
    encoding = _encoding(path)
    with open_file(path, LARGEST_RECORDING, "a recording") as stream:
        text = stream.read(_LOOKED_AT).decode(encoding, errors="replace")
    lines = re.split(r"\r\n|\r|\n", text)
    lines = lines[:-1] if len(lines) > 1 else lines
    candidates = [stated.separator] if stated.separator else list(SEPARATORS)
    for separator in candidates:
        begin = stated.header_lines if stated.header_lines is not None else _begin(lines, separator)
        if begin is None or begin >= len(lines):
            continue
        cells = [_cells(line, separator) for line in lines[begin : begin + 200] if line.strip()]
        if not cells or (
            stated.separator is None
            and separator != "blanks"
            and len(cells[0]) < 2
            and stated.header_lines is not None
        ):
            continue
        names_line, units_line = _header(lines, begin, separator, len(cells[0]), stated)
        width = len(cells[0])
        header = [_cells(lines[i - 1], separator) if i else [] for i in (names_line, units_line)]
        names, written = (tuple((one + [""] * width)[:width]) for one in header)
        units = [name_and_unit(name)[1] for name in names]
        return Layout(
            path, encoding, separator, _decimal(path, begin, cells, separator, stated), begin, width, names,
            tuple(_unit(w) or u for w, u in zip(written, units, strict=True)), names_line,
        )  # fmt: skip
    raise InputError(
        f"{path}: no lines of numbers found; expected a recording, as text with tabs, semicolons, commas or blanks "
        "between cells. State separator and header_lines under [file] of the recipe"
    )


def _encoding(path: Path) -> str:
    with open_file(path, LARGEST_RECORDING, "a recording") as stream:
        start = stream.read(4)
        if not start.strip():
            raise InputError(f"{path}: the file is empty; expected a recording")
        if start.startswith((b"\xff\xfe", b"\xfe\xff")):
            return "utf-16"
        stream.seek(0)
        decoder = codecs.getincrementaldecoder("utf-8-sig")()
        try:
            while piece := stream.read(1 << 20):
                if b"\0" in piece:
                    break
                decoder.decode(piece)
            else:
                decoder.decode(b"", final=True)
                return "utf-8-sig"
        except UnicodeDecodeError:
            pass
    decoded(read_file(path, LARGEST_RECORDING, "a recording"), path)  # says what is wrong
    return "cp1252"


def _cells(line: str, separator: str) -> list[str]:
    if separator == "blanks":
        return line.split()
    return [cell.strip().strip('"') for cell in line.split(SEPARATORS[separator])]


def _shape(line: str, separator: str) -> tuple[bool, ...]:
    return tuple(bool(_NUMBER.fullmatch(cell)) for cell in _cells(line, separator))


def _begin(lines: Sequence[str], separator: str) -> int | None:
    """Lines above the numbers, None if there are none with this separator."""
    filled = [(i, _shape(line, separator)) for i, line in enumerate(lines) if line.strip()]
    for k, (i, shape) in enumerate(filled):
        after = [other for _, other in filled[k : k + _ROWS]]
        enough = len(after) == _ROWS or (k + len(after) == len(filled) and len(after) > 1)
        if (
            sum(shape)
            and len(shape) > 1
            and enough
            and all(len(o) == len(shape) and sum(o) >= sum(shape) - 1 for o in after)
        ):
            return i
    return None


def _header(
    lines: Sequence[str], begin: int, separator: str, width: int, stated: FileBlock
) -> tuple[int, int]:
    """Lines of names and of units, from 1; 0 without."""
    if stated.names_line is not None:
        return min(stated.names_line, len(lines)), min(stated.units_line or 0, len(lines))
    above = [i for i in range(begin, 0, -1) if lines[i - 1].strip()][:2]
    cells = [_cells(lines[i - 1], separator) for i in above]
    if cells and _only_units(cells[0]) and len(above) > 1 and abs(len(cells[1]) - width) <= 1:
        return above[1], stated.units_line or above[0]
    return (above[0] if cells and abs(len(cells[0]) - width) <= 1 else 0), stated.units_line or 0


def _only_units(cells: Sequence[str]) -> bool:
    bare = [_unit(cell) for cell in cells]
    return any(map(is_unit, bare)) and all(is_unit(one) or one in ("", "1", "-") for one in bare)


def _unit(cell: str) -> str:
    return cell.strip().strip("[]()").strip()


def name_and_unit(cell: str) -> tuple[str, str]:
    """A header taken apart; text behind a name is a unit only if it is one."""
    found = _WITH_UNIT.fullmatch(cell)
    unit = (
        next((part for part in found.groupdict().values() if part and part != found["name"]), "")
        if found
        else ""
    )
    return (found["name"], unit.strip()) if found and is_unit(unit) else (cell, "")


def column_number(layout: Layout, name: str) -> int | None:
    """Number of the column of a name, from 0: the whole header, or without its unit; None if there is none."""
    plain = " ".join(name.split())
    whole = [" ".join(header.split()) for header in layout.names]
    bare = [" ".join(name_and_unit(header)[0].split()) for header in layout.names]
    for names in (whole, bare):
        if names.count(plain) == 1:
            return names.index(plain)
    return None


def _decimal(
    path: Path, begin: int, cells: Sequence[Sequence[str]], separator: str, stated: FileBlock
) -> str:
    if stated.decimal is not None:
        return "," if stated.decimal == "comma" else "."
    written = [cell for row in cells for cell in row if _NUMBER.fullmatch(cell)]
    comma = next((cell for cell in written if "," in cell), None)
    point = next((cell for cell in written if "." in cell), None)
    if comma and point:
        raise InputError(
            f"{path}, below line {begin}: found {comma!r} and {point!r}; expected one decimal separator: state decimal under "
            "[file] of the recipe"
        )
    return "," if comma and separator != "comma" else "."


@contextmanager
def _text(layout: Layout) -> Iterator[TextIOWrapper]:
    with (
        open_file(layout.path, LARGEST_RECORDING, "a recording") as stream,
        TextIOWrapper(stream, encoding=layout.encoding) as text,
    ):
        for _ in range(layout.header_lines):
            text.readline()
        yield text


def read_numbers(
    layout: Layout, numeric: Collection[int], labels: Collection[int], footer_lines: int
) -> tuple[dict[int, FloatArray], dict[int, tuple[tuple[str, ...], Any]], Any]:
    """Columns by number: numbers, nan where a cell is empty; labels with the number of the label of each row; and the lines.

    Raises
    ------
    InputError
        with line and column of a cell that is no number, or of a line of another length
    """
    import pandas as pd

    wanted = sorted({*numeric, *labels})
    parts: dict[int, list[FloatArray]] = {i: [] for i in numeric}
    codes: dict[int, list[Any]] = {i: [] for i in labels}
    known: dict[int, dict[str, int]] = {i: {} for i in labels}
    lines: list[Any] = []
    options = {
        "sep": SEPARATORS[layout.separator], "header": None, "usecols": wanted, "decimal": layout.decimal,
        "na_values": list(MISSING), "skip_blank_lines": False, "skipinitialspace": True, "chunksize": PIECE, "engine": "c",
        "dtype": dict.fromkeys(labels, str), "index_col": False,
        "nrows": _rows(layout, footer_lines),
    }  # fmt: skip
    with _text(layout) as text:
        try:
            for frame in pd.read_csv(text, **options):  # type: ignore[call-overload]
                number = layout.header_lines + 1 + np.asarray(frame.index, dtype=np.int64)
                filled = ~frame.isna().all(axis=1).to_numpy()
                for i in numeric:
                    parts[i].append(_converted(layout, frame[i], number, i)[filled])
                for i in labels:
                    cells = frame[i].fillna("").str.strip().to_numpy()[filled]
                    for label in dict.fromkeys(cells.tolist()):
                        known[i].setdefault(label, len(known[i]))
                    codes[i].append(np.array([known[i][cell] for cell in cells.tolist()], dtype=np.int32))
                lines.append(number[filled])
        except pd.errors.ParserError as error:
            said = re.search(r"Expected (\d+) fields in line (\d+), saw (\d+)", str(error))
            where = (
                f", line {layout.header_lines + int(said[2])}: {said[3]} cells" if said else ": lines differ"
            )
            raise InputError(
                f"{layout.path}{where}; expected {layout.width} in each, as in the first"
            ) from None
    return (
        {i: np.concatenate(part) for i, part in parts.items()},
        {i: (tuple(known[i]), np.concatenate(part)) for i, part in codes.items()},
        np.concatenate(lines),
    )


def _no_number(layout: Layout, line: int, column: int, cell: str) -> InputError:
    name = layout.names[column] or f"number {column + 1}"
    advice = comma_advice(cell)
    return InputError(
        f"{layout.path}, line {line}, column {quoted(name)}: found {quoted(cell, 20)}"
        + (f", {advice}" if advice else ", which is no number")
        + f"; expected a number with a decimal {'comma' if layout.decimal == ',' else 'point'}. If lines without numbers end "
        "the file, state footer_lines under [file] of the recipe"
    )


def _rows(layout: Layout, footer_lines: int) -> int | None:
    """Lines of numbers, if those at the end of the file are not to be read; None for all."""
    if not footer_lines:
        return None
    count = 0
    with _text(layout) as text:
        for number, line in enumerate(text, 1):
            count = number if line.strip() else count
    return max(0, count - footer_lines)


def _converted(layout: Layout, cells: Any, number: Any, column: int) -> FloatArray:
    import pandas as pd

    if cells.dtype.kind in "iuf":
        values = cells.to_numpy(dtype=np.float64)
        wrong = np.isinf(values)
    else:
        plain = cells.astype(str).str.strip()
        if layout.decimal == ",":
            plain = plain.where(
                plain.str.contains(".", regex=False), plain.str.replace(",", ".", regex=False)
            )
        values = pd.to_numeric(plain, errors="coerce").to_numpy(dtype=np.float64)
        wrong = (np.isnan(values) & cells.notna().to_numpy()) | np.isinf(values)
    if wrong.any():
        first = int(wrong.argmax())
        raise _no_number(layout, int(number[first]), column, str(cells.iloc[first]))
    return values
