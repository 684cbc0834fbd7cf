"""The table: everything that the paper states and skinbayes computes, beside each other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

# imported for what they register
from skinbayes.reproduce import (  # noqa: F401
    ball,
    bridges,
    contact,
    contact_claims,
    drying,
    ellipse,
    humid,
    liquid,
    stribeck,
    surface,
)
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import COMPUTED, Found
from skinbayes.reproduce.rules import RULES, relative_difference
from skinbayes.reproduce.statements import COMPARED, Statement, statements


@dataclass(frozen=True, kw_only=True)
class Compared:
    """A statement of the paper beside what is computed.

    Attributes
    ----------
    statement : what the paper states
    computed : value in the SI unit of the statement; for a claim the number that its rule judges
    formula : of an equation, the value of the formula as printed
    relative_difference : computed over printed less 1; of an equation over the formula; None for claims
    agrees : by the rule of the reading
    note : what else there is to say
    """

    statement: Statement
    computed: float
    formula: float | None
    relative_difference: float | None
    agrees: bool
    note: str

    def to_dict(self) -> dict[str, Any]:
        """As in the JSON document: ``paper`` is a number, both ends of a range, or the words of a claim."""
        stated = self.statement
        paper = self.formula if stated.role == "equation" else stated.printed and stated.printed.value
        return {
            "id": stated.id,
            "where": stated.where,
            "description": stated.description,
            "unit": stated.unit,
            "paper": stated.words if paper is None else paper,
            "computed": self.computed,
            "relative_difference": self.relative_difference,
            "agrees": self.agrees,
            "note": self.note,
            "group": stated.group,
            "kind": stated.role,
            "printed": stated.words,
            "rule": RULES[stated.reading].sentence,
        }


def compared(statement: Statement, paper: Paper) -> Compared:
    """Compute what a statement is about, and judge it.

    Examples
    --------
    >>> row = compared(statements()["nominal-pressure"], Paper())
    >>> row.statement.words, round(row.computed), row.agrees
    ('6.83 kPa', 6829, True)
    """
    found = COMPUTED[statement.id](paper)
    return judged(statement, found if isinstance(found, Found) else Found(float(found)))


def judged(statement: Statement, found: Found) -> Compared:
    """A statement beside what was found."""
    difference = None
    if found.formula is not None:
        difference = found.value / found.formula - 1 if found.formula else found.value
    elif statement.printed is not None:
        difference = relative_difference(found.value, statement.printed)
    judged_by = difference if statement.role == "equation" and difference is not None else found.value
    return Compared(
        statement=statement,
        computed=float(found.value),
        formula=None if found.formula is None else float(found.formula),
        relative_difference=None if difference is None else float(difference),
        agrees=bool(RULES[statement.reading].agrees(float(judged_by), statement.printed)),
        note=found.note,
    )


def reproduction(
    paper: Paper | None = None, progress: Callable[[int, int], None] | None = None
) -> list[Compared]:
    """Everything that the paper states and skinbayes computes.

    Parameters
    ----------
    paper : the cases of the paper; None for those of its numbers
    progress : called with the number of rows done and their total

    Returns
    -------
    list of Compared
        One for each statement that is computed, in the order of the data set
    """
    cases = paper or Paper()
    wanted = [found for found in statements().values() if found.role in COMPARED]
    rows = []
    for done, statement in enumerate(wanted):
        if progress is not None:
            progress(done, len(wanted))
        rows.append(compared(statement, cases))
    return rows
