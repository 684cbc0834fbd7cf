"""A problem in a few lines, for people who print it."""

from __future__ import annotations

from collections.abc import Iterable
from textwrap import shorten

from skinbayes.phrases import row_count
from skinbayes.problem.bound import BoundModel

LONGEST, MOST_NAMES = 100, 12


def summary(problem: BoundModel) -> str:
    """Title, data, and the names of the parameters with their priors or values; the rest is in the attributes."""
    said = [f"Problem '{problem.name}': {shorten(problem.spec.title, LONGEST, placeholder=' …')}"]
    if problem.dataset is None:
        said.append("data: none")
    else:
        explained = ", ".join(f"{o.name} (noise {o.noise.name})" for o in problem.observations)
        said.append(f"data: {row_count(problem.conditions.n_rows)} of {problem.dataset.shown}: {explained}")
    said.append(f"forward model: {problem.forward.name}")
    said += listed("free", (f"{p.label}: {p.prior_text}" for p in problem.free))
    said += listed("fixed", (f"{p.label}: {p.prior_text}" for p in problem.fixed))
    if problem.tied:
        said += listed("tied", (f"{p.label} {p.prior_text}" for p in problem.tied))
    return "\n".join(said)


def listed(title: str, lines: Iterable[str]) -> list[str]:
    """A title with the number of lines, and the first of them."""
    found = list(lines)
    more = [f"  and {len(found) - MOST_NAMES} more"] if len(found) > MOST_NAMES else []
    shown = [f"  {shorten(line, LONGEST, placeholder=' …')}" for line in found[:MOST_NAMES]]
    return [f"{title}: {len(found) or 'none'}", *shown, *more]
