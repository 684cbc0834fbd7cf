"""What scores say, in words."""

from __future__ import annotations

from collections.abc import Sequence

from skinbayes.comparison.scores import FEW_ROWS, LeftOut
from skinbayes.phrases import plural, singular

SMALL = 4.0
"""A smaller difference of predictive densities says nothing, whatever its standard error."""


def sign_of(difference: float, error: float) -> int:
    """1 if a difference of predictive densities is clearly positive, −1 if clearly negative, else 0."""
    clear = abs(difference) >= 2 * error and abs(difference) >= SMALL
    return (1 if difference > 0 else -1) if clear else 0


def pointwise_question(grouped_by: Sequence[str]) -> str:
    """What leaving out single data answers if groups have effects."""
    known = " and ".join(f"its {singular(column)}" for column in grouped_by)
    effects = "the effect" if len(grouped_by) == 1 else "the effects"
    return (
        f"Leaving out one datum at a time asks how well one more measurement is predicted, {effects} of {known} being known from "
        "other rows. Such effects make up for whatever a theory misses of a whole group, so this number cannot tell which "
        "physics is right about the groups; it judges how rows differ inside them."
    )


def level_question(column: str, grouped_by: Sequence[str]) -> str:
    """What leaving out the levels of a column answers."""
    others = [plural(other) for other in grouped_by if other != column]
    rest = f" from the other {plural(column)}"
    if others:
        rest += f", the {' and '.join(others)} being known"
    return f"Leaving out one {singular(column)} at a time asks how well a {singular(column)} never measured is predicted{rest}."


def unreliable_levels(name: str, left_out: LeftOut) -> list[str]:
    """Sentences on levels whose score is doubtful, and on those that were fitted anew."""
    said = []
    count, what = len(left_out.levels), plural(left_out.column)
    again = [level for level in left_out.refitted if level not in left_out.unreliable]
    if again:
        said.append(f"'{name}' was sampled anew without {_some(again)}, {len(again)} of {count} {what}.")
    if left_out.unreliable:
        failed = [level for level in left_out.unreliable if level in left_out.refitted]
        remedy = (
            "even refits without them leave their numbers uncertain"
            if len(failed) == len(left_out.unreliable)
            else "refits without them would tell (--refit)"
        )
        said.append(
            f"'{name}': {len(left_out.unreliable)} of {count} {what} ({_some(left_out.unreliable)}) influence the posterior so "
            f"strongly that leaving them out cannot be estimated by importance sampling (Pareto k above the limit); {remedy}."
        )
    return said


def few_levels(left_out: LeftOut) -> list[str]:
    """A warning if a standard error over levels means little."""
    count = len(left_out.levels)
    if count >= FEW_ROWS:
        return []
    return [
        f"With {count} {plural(left_out.column)} the standard errors of what is predicted for them are not to be trusted."
    ]


def _some(levels: Sequence[str], at_most: int = 4) -> str:
    more = f" and {len(levels) - at_most} more" if len(levels) > at_most else ""
    return ", ".join(levels[:at_most]) + more
