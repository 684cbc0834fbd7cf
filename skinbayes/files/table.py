"""A table of text from disk to cells, with errors that name the line.

Nothing here knows quantities; it makes sure that what comes out is a rectangular table of text.
"""

from __future__ import annotations

import csv
import hashlib
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from skinbayes.errors import NEXT_PROBLEM, InputError
from skinbayes.files.reading import read_file
from skinbayes.files.separated import Records, decoded, with_points
from skinbayes.units import NUMBER

MAX_ROWS = 100_000
"""Rows of data that are read. A likelihood holds a batch of parameter vectors times rows in memory: with 64
vectors every intermediate array of this many rows already takes 50 MB."""

LARGEST_TABLE = 100_000_000
"""Bytes of a table: `MAX_ROWS` long rows of numbers."""

MOST_COLUMNS = 1000
"""Columns of a table."""

MOST_SHOWN = 10
"""Problems of a file that a message lists."""


@dataclass
class Problems:
    """Collects what is wrong with a file, to report all of it at once, in the order of the file."""

    path: Path
    row_word: str = "line"
    count: int = 0
    _noted: dict[tuple[int, str], list[tuple[int, int, str]]] = field(default_factory=dict)

    def add(self, line: int, position: int, text: str, kind: str = "") -> None:
        """Note a problem at a line (the first line of the file is 1; 0 for none) and a column position.

        Where there are too many to be listed, the first of each ``kind`` in each column comes before others of its kind.
        """
        self.count += 1
        same_kind = self._noted.setdefault((position, kind), [])
        if len(same_kind) < MOST_SHOWN:
            same_kind.append((line, position, text))

    def raise_if_any(self) -> None:
        """Raise InputError that lists the problems, if there are any."""
        if self.count == 0:
            return
        first = sorted(same_kind[0] for same_kind in self._noted.values())
        others = sorted(problem for same_kind in self._noted.values() for problem in same_kind[1:])
        listed = sorted([*first, *others][:MOST_SHOWN])
        shown = [f"{self.row_word} {line}{text}" if line else text.lstrip(":, ") for line, _, text in listed]
        if self.count == 1:
            raise InputError(f"{self.path}{', ' if listed[0][0] else ': '}{shown[0]}")
        if left := self.count - len(shown):
            shown.append(f"and {left} more")
        raise InputError(NEXT_PROBLEM.join((f"{self.path}: {self.count} problems", *shown)))


@dataclass(frozen=True)
class CsvTable:
    """A rectangular table of text.

    Attributes
    ----------
    path : the file, or the name of what was given in its place
    header, header_line : column headers as written, and their line number (0 if there is no file)
    lines, rows : line number and cells of every row of data
    sha256 : of the bytes of the file
    row_word : what ``lines`` count, ``"line"`` of a file or ``"row"``
    comments : line number and text of each comment above the header
    """

    path: Path
    header: tuple[str, ...]
    header_line: int
    lines: tuple[int, ...]
    rows: tuple[tuple[str, ...], ...]
    sha256: str
    row_word: str = "line"
    comments: tuple[tuple[int, str], ...] = ()

    @property
    def header_place(self) -> str:
        """Where the header stands, for messages."""
        return f"{self.path}, line {self.header_line}" if self.header_line else f"{self.path}"

    def column(self, position: int) -> list[str]:
        """Cells of one column, without surrounding blanks."""
        return [row[position].strip() for row in self.rows]


def quoted(text: str, longest: int = 40) -> str:
    """Text of a file inside a message: quoted, shortened, without control characters."""
    return repr(text if len(text) <= longest else text[: longest - 3] + "...")


def csv_text(columns: Mapping[str, Sequence[str]], units: Mapping[str, str]) -> str:
    """Columns of text as a CSV that `read_table` reads, with the unit of each that has one in its header."""
    text = io.StringIO()
    # quotes about headers, so that a semicolon in a name is not taken for what separates cells
    odd = any(mark in name for name in columns for mark in ";\t")
    heading = csv.writer(text, lineterminator="\n", quoting=csv.QUOTE_ALL if odd else csv.QUOTE_MINIMAL)
    heading.writerow([f"{name} [{units[name]}]" if name in units else name for name in columns])
    csv.writer(text, lineterminator="\n").writerows(zip(*columns.values(), strict=True))
    return text.getvalue()


def read_table(path: Path, *, max_rows: int = MAX_ROWS, problems: Problems | None = None) -> CsvTable:
    """Read a table of text: one header line, comments, cells separated by commas, semicolons or tabs.

    What separates the cells is seen in the header, or said by a first line ``sep=;``. Numbers may have decimal commas where
    no other reading is possible; they are then written with points in what is returned. A line that begins with ``#`` is a
    comment, unless it can be a row: the first column holds labels (its header has no unit), the line has all its cells, and
    one of those under a unit is a number. A label may begin with ``#``. Rows and columns without any text are left out.

    Parameters
    ----------
    path : the file
    max_rows : largest number of rows of data
    problems : collects rows of another length, which are left out; without it they are refused here

    Raises
    ------
    InputError
        for an unreadable, empty, binary, wrongly encoded, too long or ragged file, or one that can be read in two ways
    """
    data = read_file(path, LARGEST_TABLE, "a CSV file")
    noted = Problems(path) if problems is None else problems
    text = decoded(data, path)
    records = Records(text, path)
    header_line, header = next(records, (0, ()))
    header = tuple(" ".join(cell.split()) for cell in header)
    if not header:
        raise InputError(f"{path}: the file is empty; expected a header line such as 'normal_force [N]'")
    if len(header) > MOST_COLUMNS:
        raise InputError(
            f"{path}, line {header_line}: {len(header)} columns; expected a table of at most {MOST_COLUMNS}"
        )
    comments = tuple(records.comments)
    _check_header(header, comments[-1][1] if comments else "", f"{path}, line {header_line}")
    records.header = header
    lines: list[int] = []
    rows: list[tuple[str, ...]] = []
    for number, cells in records:
        if not any(cell.strip() for cell in cells):  # as spreadsheets leave them below a table
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
    if problems is None:
        noted.raise_if_any()
    if not rows and not noted.count:
        raise InputError(
            f"{path}, line {header_line}: no rows of data below the header; expected at least one"
        )
    named = [i for i, name in enumerate(header) if name.strip() or any(row[i].strip() for row in rows)]
    if len(named) < len(header):
        header, rows = tuple(header[i] for i in named), [tuple(row[i] for i in named) for row in rows]
    rows = with_points(path, header, lines, rows, records.separator)
    digest = hashlib.sha256(data).hexdigest()
    return CsvTable(path, header, header_line, tuple(lines), tuple(rows), digest, comments=comments)


def _length(cells: tuple[str, ...], expected: int) -> str:
    """What is wrong with the number of cells of a row, and what may be behind it."""
    found = f"found {len(cells)} cells; expected {expected} as in the header"
    if len(cells) > expected and not any(cell.strip() for cell in cells[expected:]):
        return f"{found}; those too many are empty: remove the commas at the end"
    if len(cells) > expected:
        return f"{found}; is the decimal separator a comma, or do commas stand between thousands? Write 0.5 and 1000"
    return found


def _check_header(header: tuple[str, ...], comment: str, where: str) -> None:
    if all(NUMBER.fullmatch(cell.strip()) for cell in header):
        hint = "; the header above it begins with #: remove the #" if "[" in comment else ""
        raise InputError(
            f"{where}: found numbers; expected a header line first, such as 'normal_force [N]'{hint}"
        )
