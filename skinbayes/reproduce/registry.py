"""Functions that compute what the paper states, each under the name of its statement."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from skinbayes.reproduce.paper import Paper


@dataclass(frozen=True)
class Found:
    """What was computed for a statement.

    Attributes
    ----------
    value : by the package, SI; for a claim the number that its rule judges
    note : what else there is to say about it, one or two sentences
    formula : of an equation, the value of the formula as printed
    """

    value: float
    note: str = ""
    formula: float | None = None


Compute = Callable[[Paper], Found | float]

COMPUTED: dict[str, Compute] = {}
"""Functions by the name of the statement; filled when the modules of the subjects are imported."""


def computes(name: str) -> Callable[[Compute], Compute]:
    """Register the function that computes a statement; a name that is taken is a mistake of ours."""

    def register(function: Compute) -> Compute:
        assert name not in COMPUTED, f"{name} is computed twice"
        COMPUTED[name] = function
        return function

    return register
