"""Comma-separated text from disk to cells, with errors that name the line.

Nothing here knows quantities; it makes sure that what comes out is a rectangular table of text.
"""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from skinbayes.errors import InputError
from skinbayes.files.reading import open_file

MAX_ROWS = 100_000
"""Rows of data that are read. A likelihood holds a batch of parameter vectors times rows in memory: with 64
vectors every intermediate array of this many rows already takes 50 MB."""

LARGEST_TABLE = 100_000_000
"""Bytes of a table: `MAX_ROWS` long rows of numbers."""

MOST_COLUMNS = 1000
"""Columns of a table."""

MOST_LINES = 2 * MAX_ROWS
"""Lines of a table with its comments and empty lines."""

_LONGEST_LINE = 100_000  # bytes; a table of quantities has lines of some hundred
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"


@dataclass
class Problems:
    """Collects what is wrong with a file, to report the first problem and the number of the others."""

    path: Path
    count: int = 0
    _first: tuple[int, int, str] = field(default=(0, 0, ""))

    def add(self, line: int, position: int, text: str) -> None:
        """Note a problem at a line (the first line of the file is 1) and a column position."""
        if self.count == 0 or (line, position) < self._first[:2]:
            self._first = (line, position, text)
        self.count += 1

    def raise_if_any(self) -> None:
        """Raise InputError for the first problem, if there is one."""
        if self.count == 0:
            return
        others = self.count - 1
        more = f" (and {others} more problem{'s' if others > 1 else ''} in this file)" if others else ""
        raise InputError(f"{self.path}, line {self._first[0]}{self._first[2]}{more}")


@dataclass(frozen=True)
class Table:
    """A rectangular table of text.

    Attributes
    ----------
    path : the file
    header, header_line : column headers as written, and their line number
    lines, rows : line number and cells of every row of data
    sha256 : of the bytes of the file
    """

    path: Path
    header: tuple[str, ...]
    header_line: int
    lines: tuple[int, ...]
    rows: tuple[tuple[str, ...], ...]
    sha256: str

    def column(self, position: int) -> list[str]:
        """Cells of one column, without surrounding blanks."""
        return [row[position].strip() for row in self.rows]


def quoted(text: str) -> str:
    """Text of a file inside a message: quoted, shortened, without control characters."""
    return repr(text if len(text) <= 40 else text[:37] + "...")


def read_table(path: Path, *, max_rows: int = MAX_ROWS) -> Table:
    """Read comma-separated text: UTF-8, one header line, lines that start with ``#`` are comments.

    Parameters
    ----------
    path : the file
    max_rows : largest number of rows of data

    Raises
    ------
    InputError
        for an unreadable, empty, binary, wrongly encoded, too long or ragged file, or another separator
    """
    digest = hashlib.sha256()
    problems = Problems(path)
    header: tuple[str, ...] | None = None
    header_line = 0
    lines: list[int] = []
    rows: list[tuple[str, ...]] = []
    for number, raw in _lines(path):
        digest.update(raw)
        text = _decode(raw, path, number)
        if not text.strip() or text.lstrip().startswith("#"):
            continue
        cells = _split(text, path, number)
        if header is None:
            if len(cells) > MOST_COLUMNS:
                raise InputError(
                    f"{path}, line {number}: {len(cells)} columns; expected a table of at most {MOST_COLUMNS}"
                )
            header, header_line = cells, number
            _check_separator(text, path, number)
            continue
        if len(rows) == max_rows:
            raise InputError(
                f"{path}, line {number}: more than {max_rows} rows of data; expected at most {max_rows}, "
                "for example after averaging neighbouring rows"
            )
        if len(cells) != len(header):
            hint = "; is the decimal separator a comma?" if len(cells) > len(header) else ""
            problems.add(
                number, 0, f": found {len(cells)} cells; expected {len(header)} as in the header{hint}"
            )
        lines.append(number)
        rows.append(cells)
    if header is None:
        raise InputError(f"{path}: the file is empty; expected a header line such as 'normal_force [N]'")
    problems.raise_if_any()
    if not rows:
        raise InputError(
            f"{path}, line {header_line}: no rows of data below the header; expected at least one"
        )
    return Table(path, header, header_line, tuple(lines), tuple(rows), digest.hexdigest())


def text_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Number (from 1) and text of every line of a UTF-8 file, without line ends.

    Raises
    ------
    InputError
        for an unreadable, binary or wrongly encoded file, or a line too long for a table
    """
    for number, raw in _lines(path):
        yield number, _decode(raw, path, number)


def _lines(path: Path) -> Iterator[tuple[int, bytes]]:
    try:
        with open_file(path, LARGEST_TABLE, "a CSV file") as stream:
            number = 0
            while raw := stream.readline(_LONGEST_LINE):
                number += 1
                if number > MOST_LINES:
                    raise InputError(f"{path}: more than {MOST_LINES} lines; expected a table")
                if b"\0" in raw:
                    raise InputError(
                        f"{path}, line {number}: found a zero byte (byte {raw.index(0) + 1} of the line); "
                        "expected comma-separated text in UTF-8, not UTF-16, not a binary file or spreadsheet"
                    )
                if len(raw) == _LONGEST_LINE:
                    raise InputError(
                        f"{path}, line {number}: longer than {_LONGEST_LINE} bytes; expected a table"
                    )
                yield number, raw
    except OSError as error:
        raise InputError(
            f"{path}: cannot be read ({error.strerror or error}); expected a CSV file"
        ) from error


def _decode(raw: bytes, path: Path, number: int) -> str:
    mark = number == 1 and raw.startswith(_BYTE_ORDER_MARK)
    try:
        text = raw[len(_BYTE_ORDER_MARK) if mark else 0 :].decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path}, line {number}: byte {error.start + 1} of the line (0x{error.object[error.start]:02x}) "
            "is not UTF-8; expected comma-separated text saved as UTF-8"
        ) from None
    text = text.rstrip("\r\n")
    if "\r" in text:
        raise InputError(
            f"{path}, line {number}: found a bare carriage return; expected lines ending in a line feed"
        )
    return text


def _split(text: str, path: Path, number: int) -> tuple[str, ...]:
    if '"' not in text:
        return tuple(text.split(","))
    try:
        return tuple(next(csv.reader([text], strict=True, skipinitialspace=True)))
    except (csv.Error, StopIteration):
        raise InputError(
            f'{path}, line {number}: quotation marks do not match; expected cells such as "a, b" on one line'
        ) from None


def _check_separator(text: str, path: Path, number: int) -> None:
    if "," in text:
        return
    for character, name in ((";", "semicolons"), ("\t", "tabs")):
        if character in text:
            raise InputError(
                f"{path}, line {number}: cells are separated by {name}; expected commas between cells and "
                "points as decimal separators"
            )
