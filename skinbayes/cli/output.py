"""Printing: JSON documents, tables, progress. The only place besides the commands that writes to the terminal."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from rich.console import Console

EXIT_DONE = 0
EXIT_BAD_INPUT = 2
EXIT_NOT_CONVERGED = 3
EXIT_INTERRUPTED = 130

_Command = Callable[..., Any]


def json_option(command: _Command) -> _Command:
    """The option every command has."""
    return click.option(
        "--json",
        "as_json",
        is_flag=True,
        help="Print one JSON document (SI values) on standard output, nothing else.",
    )(command)


def print_json(document: Any) -> None:
    """Print one valid JSON document; infinities become the strings "inf" and "-inf", NaN becomes null."""
    encoding = (getattr(sys.stdout, "encoding", None) or "utf-8").lower().replace("-", "")
    # what a terminal of another code page cannot show, JSON can still say in ASCII
    click.echo(json.dumps(plain(document), indent=1, ensure_ascii=encoding != "utf8", allow_nan=False))


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
    """A rich console; plain text when it is not a terminal, and then as wide as the text."""
    from rich.console import Console

    made = Console(stderr=stderr, highlight=False, emoji=False)
    return (
        made
        if made.is_terminal
        else Console(stderr=stderr, highlight=False, emoji=False, width=160, color_system=None)
    )


def print_table(
    headers: Sequence[str], rows: Iterable[Sequence[str]], title: str = "", right: Sequence[int] = ()
) -> None:
    """Print a table; ``right`` lists the columns aligned to the right."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table
    from rich.text import Text

    table = Table(title=Text(title) if title else None, box=SIMPLE_HEAD, title_justify="left", pad_edge=False)
    for i, header in enumerate(headers):
        table.add_column(Text(header), justify="right" if i in right else "left", overflow="fold")
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    console().print(table)


def print_sentences(sentences: Iterable[str], title: str = "") -> None:
    """Print sentences as a list, wrapped."""
    from rich.padding import Padding
    from rich.text import Text

    terminal = console()
    if title:
        terminal.print(Text(title, style="bold"))
    for sentence in sentences:
        terminal.print(Padding(Text(f"- {sentence}"), (0, 0, 0, 1)))
