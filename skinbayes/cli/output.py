"""Printing: sentences, JSON documents, tables. The only place that writes text to the terminal.

What files, arguments and model files say may hold anything; characters that a terminal would obey are shown, not sent.
"""

from __future__ import annotations

import json
import math
import os
import re
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any
from unicodedata import category

import click

from skinbayes.errors import NEXT_PROBLEM

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

PIPED, NARROWEST = 160, 30
"""Columns of output that is no terminal, and the fewest that are taken from the variable COLUMNS."""

EXIT_DONE = 0
EXIT_BAD_INPUT = 2
EXIT_NOT_CONVERGED = 3
EXIT_MACHINE = 4
EXIT_INTERRUPTED = 130

MOST_ROWS = 200
"""Longest table of rows; of more the first, or the most telling, are listed."""

LONGEST_CELL = 500
"""Characters of a cell of a table that are printed."""

LONGEST_WORD = 400
"""Characters without a blank that a message repeats."""

LONGEST_MESSAGE = 6000


def printable(text: str) -> str:
    """Text without characters that control a terminal or turn the direction of writing; line breaks stay.

    Examples
    --------
    >>> printable("a\\x1b[31m\\u202eb")
    'a\\\\x1b[31m\\\\u202eb'
    """
    return "".join(
        c if c.isprintable() or c == "\n" else " " if category(c) == "Zs" else repr(c)[1:-1] for c in text
    )


def say(text: str = "", err: bool = False) -> None:
    """Print text that may come from a user."""
    click.echo(printable(text), err=err)


def message(text: str) -> str:
    """A message for standard error: printable, long words shortened; line breaks between problems of a file only."""
    lines = [
        printable(re.sub(rf"\S{{{LONGEST_WORD + 1},}}", _shortened, line)).replace("\n", "\\n")
        for line in text.split(NEXT_PROBLEM)
    ]
    return NEXT_PROBLEM.join(lines)[:LONGEST_MESSAGE]


def _shortened(word: re.Match[str]) -> str:
    return f"{word[0][:80]}… ({len(word[0])} characters)"


def print_json(document: Any) -> None:
    """Print one valid JSON document; infinities become the strings "inf" and "-inf", NaN becomes null."""
    encoding = (getattr(sys.stdout, "encoding", None) or "utf-8").lower().replace("-", "")
    # what a terminal of another code page cannot show, JSON can still say in ASCII
    text = json.dumps(plain(document), indent=1, ensure_ascii=encoding != "utf8", allow_nan=False)
    click.echo("".join(c if c.isprintable() or c == "\n" else json.dumps(c)[1:-1] for c in text))


def plain(value: Any) -> Any:
    """Turn arrays, NumPy scalars and non-finite numbers into what JSON can hold."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else ("inf" if value > 0 else "-inf")
    return value


def console(stderr: bool = False) -> Console:
    """A rich console; where it is not a terminal plain text, as wide as ``COLUMNS`` says or as wide as text usually is."""
    from rich.console import Console

    made = Console(stderr=stderr, highlight=False, emoji=False)
    if made.is_terminal:
        return made
    columns = os.environ.get("COLUMNS", "")
    # fewer columns than a word is long would cut words
    width = max(NARROWEST, int(columns)) if columns.isdecimal() and int(columns) else PIPED
    return Console(stderr=stderr, highlight=False, emoji=False, width=width, color_system=None)


def print_table(
    headers: Sequence[str], rows: Iterable[Sequence[str]], title: str = "", right: Sequence[int] = ()
) -> None:
    """Print a table; ``right`` lists the columns aligned to the right.

    Words are never broken. A table whose words are too wide for the terminal becomes a list: for each row the first column
    and below it the others, each with its header.
    """
    from rich.text import Text

    headers = [_cell(header) for header in headers]
    cells = [[_cell(cell) for cell in row] for row in rows]
    terminal = console()
    for gap in (3, 2):
        if widths := _column_widths(headers, cells, right, terminal.width - gap * len(headers) + 1):
            table = _table(headers, cells, title, right, widths, gap)
            if terminal.is_terminal:
                terminal.print(table)
                return
            with terminal.capture() as captured:
                terminal.print(table)
            # blanks that fill up a line are of no use to who reads or compares a file
            click.echo("\n".join(line.rstrip() for line in captured.get().splitlines()))
            return
    if title:
        terminal.print(Text(printable(title), style="italic"))
    for first, *others in cells:
        _print_indented(terminal, f"{headers[0]}: {first}", 0)
        for header, cell in zip(headers[1:], others, strict=True):
            if cell:
                _print_indented(terminal, f"{header}: {cell}", 2)
    terminal.print("")


def _table(
    headers: Sequence[str],
    rows: list[list[str]],
    title: str,
    right: Sequence[int],
    widths: list[int],
    gap: int,
) -> Table:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    table = Table(
        title=Text(printable(title)) if title else None, box=SIMPLE_HEAD, title_justify="left", pad_edge=False
    )
    table.padding = (0, gap - 2, 0, 1)
    for i, header in enumerate(headers):
        table.add_column(
            Text(header), justify="right" if i in right else "left", overflow="fold", width=widths[i]
        )
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    return table


def _column_widths(
    headers: Sequence[str], rows: list[list[str]], right: Sequence[int], room: int
) -> list[int]:
    """Widths of columns that cut no word, and no number from its unit; empty if there is no room for them."""
    from rich.cells import cell_len

    columns = [list(column) for column in zip(headers, *rows, strict=True)]
    widths = [
        max(cell_len(line) for cell in column for line in [*cell.splitlines(), ""]) for column in columns
    ]
    pieces = [column if i in right else " ".join(column).split() for i, column in enumerate(columns)]
    least = [max((cell_len(piece) for piece in found), default=0) for found in pieces]
    for _ in range(sum(widths) - room):
        widest = max(range(len(widths)), key=lambda i: (widths[i] > least[i], widths[i]))
        if widths[widest] <= least[widest]:
            return []
        widths[widest] -= 1
    return widths


def print_text(*paragraphs: str) -> None:
    """Print text; lines that are too long are wrapped, words stay whole."""
    from rich.text import Text

    terminal = console()
    for paragraph in paragraphs:
        terminal.print(Text(printable(paragraph)))


def _print_indented(terminal: Console, text: str, indent: int) -> None:
    """Print text whose every line is indented, wrapped, without blanks at the ends of lines."""
    from rich.text import Text

    for line in Text(text).wrap(terminal, terminal.width - indent):
        terminal.print(Text(" " * indent + line.plain.rstrip()))


def _cell(text: str) -> str:
    shown = text if len(text) <= LONGEST_CELL else f"{text[: LONGEST_CELL - 40]}… ({len(text)} characters)"
    return printable(shown).replace("\n", "\\n")


def print_sentences(sentences: Iterable[str], title: str = "") -> None:
    """Print sentences as a list, wrapped."""
    from rich.text import Text

    terminal = console()
    if title:
        terminal.print(Text(printable(title), style="bold"))
    for sentence in sentences:
        _print_indented(terminal, printable(f"- {sentence}"), 1)


def quantity_text(name: str, value: Any, digits: int = 3, written: str | None = None) -> str:
    """A value with its unit, that of ``written`` text if there is one; text as it is, a dash for none."""
    from skinbayes.units import format_quantity
    from skinbayes.vocabulary import QUANTITIES

    if isinstance(value, str):
        return value
    if value != value:
        return "–"
    unit = QUANTITIES[name].unit if name in QUANTITIES else "1"
    return format_quantity(float(value), unit, digits, written)
