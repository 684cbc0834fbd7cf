"""Comma-separated text from disk to cells, with errors that name the line.

Nothing here knows quantities; it makes sure that what comes out is a rectangular table of text.
"""

from __future__ import annotations

import csv
import hashlib
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from skinbayes.errors import NEXT_PROBLEM, InputError
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
_DIGITS = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"

MOST_SHOWN = 10
"""Problems of a file that a message lists."""


@dataclass
class Problems:
    """Collects what is wrong with a file, to report all of it at once, in the order of the file."""

    path: Path
    count: int = 0
    _noted: dict[tuple[int, str], list[tuple[int, int, str]]] = field(default_factory=dict)

    def add(self, line: int, position: int, text: str, kind: str = "") -> None:
        """Note a problem at a line (the first line of the file is 1) and a column position.

        Where there are too many to be listed, the first of each ``kind`` in each column comes before others of its kind.
        """
        self.count += 1
        alike = self._noted.setdefault((position, kind), [])
        if len(alike) < MOST_SHOWN:
            alike.append((line, position, text))

    def raise_if_any(self) -> None:
        """Raise InputError that lists the problems, if there are any."""
        if self.count == 0:
            return
        first = sorted(alike[0] for alike in self._noted.values())
        others = sorted(problem for alike in self._noted.values() for problem in alike[1:])
        shown = [f"line {line}{text}" for line, _, text in sorted([*first, *others][:MOST_SHOWN])]
        if self.count == 1:
            raise InputError(f"{self.path}, {shown[0]}")
        if left := self.count - len(shown):
            shown.append(f"and {left} more")
        raise InputError(NEXT_PROBLEM.join((f"{self.path}: {self.count} problems", *shown)))


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


def quoted(text: str, longest: int = 40) -> str:
    """Text of a file inside a message: quoted, shortened, without control characters."""
    return repr(text if len(text) <= longest else text[: longest - 3] + "...")


def read_table(path: Path, *, max_rows: int = MAX_ROWS, problems: Problems | None = None) -> Table:
    """Read comma-separated text: UTF-8, one header line, comments.

    A line that begins with ``#`` is a comment, unless it can be a row: the first column holds labels (its header has no
    unit), the line has all its cells, and one of those under a unit is a number. A label may begin with ``#``.

    Parameters
    ----------
    path : the file
    max_rows : largest number of rows of data
    problems : collects rows of another length, which are left out; without it they are refused here

    Raises
    ------
    InputError
        for an unreadable, empty, binary, wrongly encoded, too long or ragged file, or another separator
    """
    digest = hashlib.sha256()
    noted = Problems(path) if problems is None else problems
    header: tuple[str, ...] | None = None
    header_line = 0
    comment = ""  # the last one
    lines: list[int] = []
    rows: list[tuple[str, ...]] = []
    for number, raw in _lines(path):
        digest.update(raw)
        text = _decode(raw, path, number)
        if not text.strip():
            continue
        if text.lstrip().startswith("#") and not (header and _may_be_row(text, header)):
            comment = text
            continue
        cells = _split(text, path, number)
        if header is None:
            if len(cells) > MOST_COLUMNS:
                raise InputError(
                    f"{path}, line {number}: {len(cells)} columns; expected a table of at most {MOST_COLUMNS}"
                )
            header, header_line = cells, number
            _check_header(text, comment, path, number)
            continue
        if len(rows) == max_rows:
            raise InputError(
                f"{path}, line {number}: more than {max_rows} rows of data; expected at most {max_rows}, "
                "for example after averaging neighbouring rows"
            )
        if len(cells) != len(header):
            noted.add(number, 0, f": {_length(cells, len(header))}", kind=f"{len(cells)} cells")
            continue
        lines.append(number)
        rows.append(cells)
    if header is None:
        raise InputError(f"{path}: the file is empty; expected a header line such as 'normal_force [N]'")
    if problems is None:
        noted.raise_if_any()
    if not rows and not noted.count:
        raise InputError(
            f"{path}, line {header_line}: no rows of data below the header; expected at least one"
        )
    return Table(path, header, header_line, tuple(lines), tuple(rows), digest.hexdigest())


def _may_be_row(text: str, header: tuple[str, ...]) -> bool:
    cells = _cells(text)
    if cells is None or len(cells) != len(header) or "[" in header[0]:
        return False
    return any(
        "[" in name and _DIGITS.fullmatch(cell.strip()) for name, cell in zip(header, cells, strict=True)
    )


def _length(cells: tuple[str, ...], expected: int) -> str:
    """What is wrong with the number of cells of a row, and what may be behind it."""
    found = f"found {len(cells)} cells; expected {expected} as in the header"
    if not any(cell.strip() for cell in cells):
        return f"{found}; the row is empty: remove its commas"
    if len(cells) > expected and not any(cell.strip() for cell in cells[expected:]):
        return f"{found}; those too many are empty: remove the commas at the end"
    if len(cells) > expected:
        return f"{found}; is the decimal separator a comma, or do commas stand between thousands? Write 0.5 and 1000"
    return found


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
    cells = _cells(text)
    if cells is None:
        raise InputError(
            f'{path}, line {number}: quotation marks do not match; expected cells such as "a, b" on one line'
        )
    return cells


def _cells(text: str) -> tuple[str, ...] | None:
    """Cells of a line; None if its quotation marks do not match."""
    if '"' not in text:
        return tuple(text.split(","))
    try:
        return tuple(next(csv.reader([text], strict=True, skipinitialspace=True)))
    except (csv.Error, StopIteration):
        return None


def _check_header(text: str, comment: str, path: Path, number: int) -> None:
    for character, name in ((";", "semicolons"), ("\t", "tabs")):
        if character in text and "," not in text:
            raise InputError(
                f"{path}, line {number}: cells are separated by {name}; expected commas between cells and "
                "points as decimal separators"
            )
    numbers = [bool(_DIGITS.fullmatch(cell.strip())) for cell in text.split(",")]
    if all(numbers):
        hint = "; the header above it begins with #: remove the #" if "[" in comment else ""
        raise InputError(
            f"{path}, line {number}: found numbers; expected a header line first, such as 'normal_force [N]'{hint}"
        )
