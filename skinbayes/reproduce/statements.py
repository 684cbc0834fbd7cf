"""What the paper states, read from the data set of its statements."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from skinbayes.files import load_reference
from skinbayes.reproduce.printed import Printed, read_printed

SOURCE = "persson2013-statements"
"""The data set."""

COMPARED = ("number", "equation", "claim")
"""Roles of statements that are computed and compared."""


@dataclass(frozen=True, kw_only=True)
class Statement:
    """One thing that the paper states.

    Attributes
    ----------
    id : name of the row
    group : its subject
    role : "number", "equation", "claim", "input" or "not computed"
    where : place in the paper
    description : what is stated
    words : as printed; empty for equations
    reading : name of the rule by which it is judged; empty where nothing is
    unit : SI unit
    remark : why it is not computed, or how it was read
    printed : the number; None for equations, claims and what is not computed
    """

    id: str
    group: str
    role: str
    where: str
    description: str
    words: str
    reading: str
    unit: str
    remark: str
    printed: Printed | None


@cache
def statements() -> dict[str, Statement]:
    """All statements by their name, in the order of the data set."""
    return {found.id: found for found in map(_statement, load_reference(SOURCE).rows)}


def printed_value(name: str) -> float:
    """The printed number of a statement, SI; the lower end of a range."""
    printed = statements()[name].printed
    assert printed is not None, f"{name} is no number"
    return printed.low


def _statement(row: object) -> Statement:
    cells = {name: "" if value is None else str(value) for name, value in dict(row).items()}  # type: ignore[call-overload]
    words, unit = cells.pop("printed"), cells["unit"]
    number = cells["role"] in ("number", "input")
    printed = read_printed(words, unit, where=f"{SOURCE}, {cells['id']}") if number else None
    cells["reading"] = printed.reading if printed and cells["role"] == "number" else cells["reading"]
    return Statement(**cells, words=words, printed=printed)
