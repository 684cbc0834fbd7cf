"""Where the data lie at the edge of the theory: how many rows, how much of the posterior, and which."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import row_names
from skinbayes.phrases import and_list, percent, plural
from skinbayes.plot.rows import label_columns, levels_of_rows

if TYPE_CHECKING:
    from skinbayes.fit import Fit

SELDOM = 0.05
"""A row flagged in a smaller fraction of the draws is not counted."""

MOST_NAMED = 8
"""Rows that are named one by one."""

MOST_LEVELS = 4
"""Levels of a column that are named one by one."""


@dataclass(frozen=True)
class Flag:
    """One mark that the forward model puts on predictions.

    Attributes
    ----------
    name : of the flag
    meaning : what it says, a clause
    fractions : fraction of the posterior draws in which each row is flagged, shape ``(N,)``
    """

    name: str
    meaning: str
    fractions: FloatArray

    @property
    def flagged(self) -> NDArray[np.bool_]:
        """Rows flagged in at least 5 % of the draws."""
        return np.asarray(self.fractions >= SELDOM)

    def to_dict(self, names: Sequence[str]) -> dict[str, Any]:
        """Everything as plain types."""
        rows = np.flatnonzero(self.flagged)
        return {
            "rows": len(rows),
            "fraction": float(self.fractions.mean()),
            "meaning": self.meaning,
            "fraction_by_row": {names[int(row)]: float(self.fractions[row]) for row in rows},
        }


def flags(fit: Fit) -> list[Flag]:
    """The marks of this fit, those of the most rows first."""
    group = fit.groups.get("validity")
    if group is None:
        return []
    meanings = {} if fit.problem is None else fit.problem.forward.flag_meanings
    found = [
        Flag(
            str(name),
            str(meanings.get(str(name), str(name).replace("_", " "))),
            np.asarray(variable.values, dtype=float),
        )
        for name, variable in group.data_vars.items()
    ]
    return sorted(found, key=lambda flag: -float(flag.fractions.sum()))


def validity_sentences(fit: Fit) -> list[str]:
    """What lies at the edge of the theory, in words; that nothing does is said too."""
    found = flags(fit)
    if not found:
        if fit.problem is not None and fit.problem.forward.flags is not None:
            return ["Where the theory ends was not looked at when this result was made; fit again to know."]
        return ["The forward model marks no predictions as doubtful; it either gives a value or none."]
    names, said = row_names(fit), []
    for flag in found:
        rows = np.flatnonzero(flag.flagged)
        if not len(rows):
            continue
        mostly = int((flag.fractions > 0.5).sum())
        inside = "all" if mostly == len(rows) else str(mostly) if mostly else "none"
        said.append(
            f"{flag.meaning[:1].upper()}{flag.meaning[1:]}: {len(rows)} of {len(names)} rows, {inside} of them in more than half "
            f"of the posterior; {percent(float(flag.fractions.mean()))} of the posterior predictions of all rows. "
            f"{_which(fit, names, rows)}"
        )
    quiet = [flag.meaning for flag in found if not flag.flagged.any()]
    if quiet:
        listed, seldom = "; ".join(quiet), percent(SELDOM)
        said.append(
            f"No row is marked in {seldom} of the posterior or more for any of the other limits ({listed})."
            if said
            else f"Nothing to say: no row is marked in {seldom} of the posterior or more ({listed})."
        )
    if len(quiet) < len(found):
        said.append(
            "Marked rows stand on theory at its edge. Fit again without them (rows in [data] of the model file) to see whether "
            "conclusions hold."
        )
    return said


def _which(fit: Fit, names: list[str], rows: NDArray[np.intp]) -> str:
    """The rows in words: levels of a column that are there with all their rows stand for these; of many, where most are."""
    if len(rows) == len(names) and len(names) > 1:
        return "These are all rows."
    said: list[str] = []
    flagged, left = set(rows.tolist()), set(rows.tolist())
    members: dict[str, dict[str, set[int]]] = {}
    for column in _label_columns(fit):
        of_row = levels_of_rows(fit, column)
        levels = list(dict.fromkeys(of_row.tolist()))
        members[column] = {level: set(np.flatnonzero(of_row == level).tolist()) for level in levels}
        own = members[column]
        whole = [
            level for level in levels if len(own[level]) > 1 and own[level] <= flagged and own[level] & left
        ]
        if whole:
            said.append(_whole(column, whole, levels))
            left -= set().union(*(own[level] for level in whole))
    if len(left) > MOST_NAMED and members:
        said.append(f"{'of the others ' if said else ''}most often rows of {_mostly(members, left)}")
    elif left:
        # names of rows hold commas themselves
        said.append(f"{'row' if len(left) == 1 else 'rows'} {'; '.join(names[row] for row in sorted(left))}")
    listed = and_list(said)
    return f"{listed[:1].upper()}{listed[1:]}."


def _label_columns(fit: Fit) -> list[str]:
    """Columns of labels that tell rows apart."""
    return [
        name for name in label_columns(fit) if 1 < len(set(levels_of_rows(fit, name))) < len(row_names(fit))
    ]


def _whole(column: str, whole: list[str], levels: list[str]) -> str:
    """Levels with all their rows."""
    missing = [level for level in levels if level not in whole]
    if len(missing) <= MOST_LEVELS < len(whole):
        return f"all rows of all {plural(column)} but {and_list(missing)}"
    if len(whole) > MOST_LEVELS:
        whole = [*whole[:MOST_LEVELS], f"{len(whole) - MOST_LEVELS} more {plural(column)}"]
    return f"all rows of {and_list(whole)}"


def _mostly(members: dict[str, dict[str, set[int]]], left: set[int]) -> str:
    """The levels with the largest fractions of some rows, of the column that parts these best."""

    def fraction(column: str, level: str) -> float:
        return len(members[column][level] & left) / len(members[column][level])

    column = max(members, key=lambda name: float(np.var([fraction(name, level) for level in members[name]])))
    levels = sorted(members[column], key=lambda level: -fraction(column, level))[:MOST_LEVELS]
    return and_list(
        [
            f"{level} ({len(members[column][level] & left)} of {len(members[column][level])})"
            for level in levels
            if fraction(column, level) > 0.0
        ]
    )
