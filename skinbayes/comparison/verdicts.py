"""What scores say, in words."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from skinbayes.comparison.parts import ORDER
from skinbayes.comparison.scores import FEW_ROWS, LeftOut
from skinbayes.phrases import plural, singular

AHEAD, LOSES, DOUBT, REMARK = "ahead", "loses", "doubt", "remark"


class Statement(NamedTuple):
    """A sentence of a comparison, and what it does.

    Attributes
    ----------
    text : the sentence
    kind : ``AHEAD`` if it says which model is, ``LOSES`` if a theory loses to a model without it, ``DOUBT`` if numbers cannot be
        trusted, ``REMARK`` if it says how to read them
    """

    text: str
    kind: str = REMARK


def pointwise_question(grouped_by: Sequence[str]) -> str:
    """What leaving out single data answers if groups have effects."""
    known = " and ".join(f"its {singular(column)}" for column in grouped_by)
    effects = "the effect" if len(grouped_by) == 1 else "the effects"
    return (
        f"Leaving out one datum at a time asks how well one more measurement is predicted, {effects} of {known} being known from "
        "other rows. Such effects make up for whatever a theory misses of a whole group, so this number cannot tell which "
        "physics is right about the groups; it judges how rows differ inside them."
    )


def is_of_blocks(column: str) -> bool:
    """Whether it is blocks of rows that are left out, ``"normal_force in 3"``, and not the levels of a column."""
    return re.search(r" in \d+$", column) is not None


def one(column: str) -> str:
    """What is left out at a time: ``"person"``, ``"block along normal_force"``."""
    return _block(column, "block") if is_of_blocks(column) else singular(column)


def many(column: str) -> str:
    """Several of them: ``"people"``, ``"blocks along normal_force"``."""
    return _block(column, "blocks") if is_of_blocks(column) else plural(column)


def _block(column: str, word: str) -> str:
    along = column.rpartition(" in ")[0]
    return f"{word} of rows" if along == ORDER else f"{word} along {along}"


def level_question(column: str, grouped_by: Sequence[str]) -> str:
    """What leaving out the levels of a column, or blocks of rows, answers."""
    if is_of_blocks(column):
        return (
            f"Leaving out one {one(column)} at a time asks how well a model carries over to conditions at which nothing was "
            "measured. Single rows of a sweep are predicted by their neighbours, whatever the model says of the whole."
        )
    others = [plural(other) for other in grouped_by if other != column]
    rest = f" from the other {plural(column)}"
    if others:
        rest += f", the {' and '.join(others)} being known"
    article = "an" if singular(column)[0] in "aeiou" else "a"
    asks = f"asks how well {article} {singular(column)} never measured is predicted{rest}"
    return f"Leaving out one {singular(column)} at a time {asks}."


def unreliable_data(name: str, unreliable: int, refitted: int, count: int) -> list[Statement]:
    """Sentences on single data whose score is doubtful, and on those that were left out by a refit."""
    said = []
    if refitted:
        what = f"each of the {count} data" if refitted == count else f"{refitted} of {count} data"
        said.append(Statement(f"'{name}' was sampled anew without {what}, one at a time."))
    if unreliable:
        remedy = (
            "refits without them leave their numbers uncertain too"
            if refitted
            else "refits without them would tell, which need the model and its data"
        )
        text = (
            f"'{name}': {unreliable} of {count} data influence the posterior so strongly that leaving them out cannot be "
            f"estimated by importance sampling (Pareto k above the limit); {remedy}."
        )
        said.append(Statement(text, DOUBT))
    return said


def not_refitted(name: str, refits: int, count: int) -> list[Statement]:
    """What was left undone because it takes long, and how to ask for it."""
    if not refits:
        return []
    times = "1 refit" if refits == 1 else f"{refits} refits"
    return [
        Statement(
            f"'{name}': {times} of {count} data {'was' if refits == 1 else 'were'} not made, each of which takes about as long "
            "as the fit: --refit, in Python refit=True, makes them.",
            DOUBT,
        )
    ]


def unreliable_levels(name: str, left_out: LeftOut) -> list[Statement]:
    """Sentences on levels whose score is doubtful, and on those that were fitted anew."""
    said = []
    count, what = len(left_out.levels), many(left_out.column)
    again = [level for level in left_out.refitted if level not in left_out.unreliable]
    if again:
        text = f"'{name}' was sampled anew without {_some(again)}, {len(again)} of {count} {what}."
        said.append(Statement(text))
    if left_out.unreliable:
        failed = [level for level in left_out.unreliable if level in left_out.refitted]
        remedy = (
            "even refits without them leave their numbers uncertain"
            if len(failed) == len(left_out.unreliable)
            else "refits without them would tell, which need the model and its data"
        )
        text = (
            f"'{name}': {len(left_out.unreliable)} of {count} {what} ({_some(left_out.unreliable)}) influence the posterior so "
            f"strongly that leaving them out cannot be estimated by importance sampling (Pareto k above the limit); {remedy}."
        )
        said.append(Statement(text, DOUBT))
    return said


def few_levels(left_out: LeftOut) -> list[Statement]:
    """Why there is no standard error over levels, if there is none."""
    count = len(left_out.levels)
    if count >= FEW_ROWS:
        return []
    what = many(left_out.column)
    return [
        Statement(
            f"With {count} {what} a standard error of what is predicted for them would mean nothing and is not given."
        )
    ]


def _some(levels: Sequence[str], at_most: int = 4) -> str:
    more = f" and {len(levels) - at_most} more" if len(levels) > at_most else ""
    return ", ".join(levels[:at_most]) + more


def plus_minus(value: float, error: float | None, digits: int = 2) -> str:
    """A number with its standard error, if it has one: ``"1.30 ± 0.20"``."""
    return f"{value:.{digits}f}" + ("" if error is None else f" ± {error:.{digits}f}")
