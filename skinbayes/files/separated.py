"""Separated text as spreadsheets of many countries write it: its encoding, what separates its cells, its decimal commas.

A file is read in the one way in which it can be read; of two ways none is chosen.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from functools import cache
from io import StringIO
from itertools import islice
from pathlib import Path
from typing import Any

from skinbayes.errors import InputError

MOST_LINES = 200_000
"""Lines of a table with its comments and empty lines."""

_LONGEST_LINE = 100_000  # characters; a table of quantities has lines of some hundred
_LONGEST_HEADER = 100  # lines
_MARKS = {b"\xef\xbb\xbf": "utf-8-sig", b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}
_SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs"}
_STATED = re.compile(r"sep=(?P<separator>[,;\t])\s*")  # a first line that spreadsheets write and obey
_NUMERIC = re.compile(r"[+-]?[0-9]*[.,]?[0-9]+[.,]?(?:[eE][+-]?[0-9]+)?")
_FRACTION = re.compile(r"[+-]?[0-9]*(?P<mark>[.,])[0-9]+(?:[eE][+-]?[0-9]+)?")
_THOUSAND = re.compile(r"[+-]?[1-9][0-9]{0,2}[.,][0-9]{3}")


def decoded(data: bytes, path: Path) -> str:
    """Text of a file: UTF-8, UTF-16 with a byte order mark, or Windows-1252 of letters that are the same in related code pages.

    Raises
    ------
    InputError
        for bytes that are no such text, with their place
    """
    encoding = next((name for mark, name in _MARKS.items() if data.startswith(mark)), "utf-8")
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        foreign = (i for i, byte in enumerate(data) if byte >= 128 and byte not in _common_bytes())
        odd = error.start if encoding == "utf-16" else next(foreign, None)
        if odd is not None:
            known = "UTF-16, as the file begins" if encoding == "utf-16" else "UTF-8"
            raise InputError(
                f"{path}, {_place(data[:odd])} (0x{data[odd]:02x}) is not {known}; expected comma-separated text saved as UTF-8"
            ) from None
        text = data.decode("cp1252")
    if "\0" in text:
        before = text[: text.index("\0")].encode(errors="replace")
        raise InputError(
            f"{path}, {_place(before)} is a zero byte; expected comma-separated text in UTF-8 (or UTF-16 with its byte order "
            "mark), not a binary file or spreadsheet"
        )
    return text


def _place(before: bytes) -> str:
    lines = re.split(rb"\r\n|\r|\n", before)
    return f"line {len(lines)}: byte {len(lines[-1]) + 1} of the line"


@cache
def _common_bytes() -> frozenset[int]:
    """Letters and signs that are the same in the Windows code pages of western, central European, Turkish and Baltic languages.

    Those below 0xa0 are left out: there other systems have letters of their own.
    """
    pages = ("cp1252", "cp1250", "cp1254", "cp1257")
    read = {byte: {bytes([byte]).decode(page, "replace") for page in pages} for byte in range(0xA0, 0x100)}
    return frozenset(byte for byte, found in read.items() if len(found) == 1)


def numbered_lines(text: str, path: Path) -> Iterator[tuple[int, str]]:
    """Number (from 1) and text of every line; a line ends in a line feed, a carriage return or both.

    Raises
    ------
    InputError
        for a line too long, or too many lines, for a table
    """
    for number, line in enumerate(StringIO(text, newline=None), 1):
        if number > MOST_LINES:
            raise InputError(f"{path}: more than {MOST_LINES} lines; expected a table")
        if len(line) > _LONGEST_LINE:
            raise InputError(
                f"{path}, line {number}: longer than {_LONGEST_LINE} characters; expected a table"
            )
        yield number, line


class Records:
    """Rows of separated text with the numbers of their first lines; empty lines, and comments if there are any, are left out.

    Attributes
    ----------
    separator : what stands between cells, found in the text if it is not given
    header : header, once it is known: a line that looks like a comment may be a row below it
    comments : those above the header, each with its number
    """

    def __init__(self, text: str, path: Path, separator: str = "", comments: bool = True) -> None:
        self.separator = separator or _separator(text, path)
        self.header: tuple[str, ...] = ()
        self.comments: list[tuple[int, str]] = []
        self._path, self._lines = path, numbered_lines(text, path)
        self._first, self._inside, self._may_comment = 0, False, comments
        self._reader = csv.reader(self._feed(), **self._dialect())

    def __iter__(self) -> Records:
        return self

    def __next__(self) -> tuple[int, tuple[str, ...]]:
        self._inside = False
        try:
            cells = tuple(next(self._reader))
        except csv.Error:
            raise InputError(
                f"{self._path}, line {self._first}: quotation marks do not match; expected cells such as "
                f'"a{self.separator} b"'
            ) from None
        return self._first, cells

    def _dialect(self) -> dict[str, Any]:
        return {"delimiter": self.separator, "strict": True, "skipinitialspace": True}

    def _feed(self) -> Iterator[str]:
        for number, line in self._lines:
            if not self._inside:
                if not line.strip() or (number == 1 and _STATED.fullmatch(line)):
                    continue
                if self._may_comment and line.lstrip().startswith("#") and not self._may_be_row(line):
                    if not self.header:
                        self.comments.append((number, line))
                    continue
                self._first, self._inside = number, True
            yield line

    def _may_be_row(self, line: str) -> bool:
        try:
            cells = next(csv.reader([line], **self._dialect()))
        except (csv.Error, StopIteration):
            return False
        if not self.header or len(cells) != len(self.header) or "[" in self.header[0]:
            return False
        return any(
            "[" in name and _NUMERIC.fullmatch(cell.strip())
            for name, cell in zip(self.header, cells, strict=True)
        )


def _separator(text: str, path: Path) -> str:
    """What separates the cells, from the header; of several that occur there the one that gives the first row as many cells."""
    header, first = "", 0
    for number, line in numbered_lines(text, path):
        if number == 1 and (stated := _STATED.fullmatch(line)):
            return stated["separator"]
        if not header and (not line.strip() or line.lstrip().startswith("#")):
            continue
        header, first = header + line, first or number
        if header.count('"') % 2 == 0 or number - first > _LONGEST_HEADER:
            break
    bare = re.sub(r'"[^"]*"|\[[^\]]*\]', "", header)
    found = [mark for mark in _SEPARATORS if mark in bare]
    if len(found) > 1:
        rows = {mark: list(islice(Records(text, path, mark), 2)) for mark in found}
        fitting = [
            mark for mark, two in rows.items() if len({len(cells) for _, cells in two}) == 1 < len(two)
        ]
        if len(fitting) != 1:
            raise InputError(
                f"{path}, line {first}: found {' and '.join(_SEPARATORS[mark] for mark in found)}, so that what separates the "
                "cells cannot be told; put cells that hold one of them into double quotes"
            )
        found = fitting
    return found[0] if found else ","


def with_points(
    path: Path, header: Sequence[str], lines: Sequence[int], rows: list[tuple[str, ...]], separator: str
) -> list[tuple[str, ...]]:
    """Rows with decimal points in the columns that have a unit, if the decimal separator of the file is a comma.

    It is one if a number shows it (``0,5``, but not ``1,000``) and no number has a point.

    Raises
    ------
    InputError
        for cells separated by semicolons or tabs and numbers with commas and with points, or numbers whose points may all
        stand between thousands
    """
    numeric = {i for i, name in enumerate(header) if "[" in name}
    seen: dict[tuple[str, bool], tuple[str, str]] = {}
    for line, row in zip(lines, rows, strict=True):
        for i in numeric:
            cell = row[i].strip()
            if ("," in cell or "." in cell) and (fraction := _FRACTION.fullmatch(cell)):
                thousand = _THOUSAND.fullmatch(cell) is not None
                seen.setdefault((fraction["mark"], thousand), (cell[:20], f"'{cell[:20]}' (line {line})"))
    comma, point = (seen.get((mark, False)) or seen.get((mark, True)) for mark in ",.")
    number = point[0] if point and (".", False) not in seen else ""  # whose point may stand between thousands
    if separator != "," and comma and point:
        way_out = (
            f": {number.replace('.', '')}, or {number.replace('.', ',')} if it is decimal" if number else ""
        )
        raise InputError(
            f"{path}: found {comma[1]} and {point[1]}; expected one decimal separator in all numbers of a file, and none "
            f"between thousands{way_out}"
        )
    if separator == ";" and point and number:
        raise InputError(
            f"{path}: found {point[1]} between semicolons, where a point may stand before decimals or between thousands; write "
            f"{number}0 if it is decimal, {number.replace('.', '')} if it is a thousand's"
        )
    if point or (",", False) not in seen:
        return rows
    return [
        tuple(
            cell.replace(",", ".") if i in numeric and _FRACTION.fullmatch(cell.strip()) else cell
            for i, cell in enumerate(row)
        )
        for row in rows
    ]
