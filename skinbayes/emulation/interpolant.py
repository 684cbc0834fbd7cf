"""Chebyshev interpolation in a box, with as many nodes as a held-out error asks for."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import prod

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.emulation.box import Box, Places
from skinbayes.emulation.chebyshev import grid_coefficients, summed
from skinbayes.emulation.tasks import Tasks

Solve = Callable[[Places], FloatArray]
"""Solutions at M places, shape ``(M, columns)``, nan where there is none; each the same whatever the others."""

Judge = Callable[[FloatArray, FloatArray, Places], float]
"""Error of interpolated solutions against exact ones at M places."""

_BLOCK = 64  # solutions at a time unless told otherwise
_COUNTS = (2, 3, 4, 5, 6, 7, 8, 9, 11, 13, 16, 20)
_PLACES = 9  # at which the error along one input is looked at


@dataclass(frozen=True, eq=False, kw_only=True)
class Interpolant:
    """A function of a box of inputs.

    Attributes
    ----------
    box : the inputs
    counts : nodes of each input that varies
    parts : Chebyshev coefficients, shape ``(*counts, columns)``
    error : at random places of the box; nan if not measured
    """

    box: Box
    counts: Mapping[str, int]
    parts: FloatArray
    error: float = np.nan

    def __call__(self, places: Places) -> FloatArray:
        """Values, shape ``(M, columns)``, at places in the box given by all inputs, shape ``(M,)``."""
        size = max(len(x) for x in places.values())
        return self.of([np.broadcast_to(x, (size,))[:, None] for x in self.box.scaled(places)], size)[:, 0]

    def of(self, scaled: Sequence[FloatArray], vectors: int) -> FloatArray:
        """Values, shape ``(B, N, columns)``, at inputs that vary, scaled to −1 … 1, of shape ``(B, 1)`` or ``(B, N)`` each."""
        return summed(self.parts, scaled, vectors)


def counts_along(
    box: Box, solve: Solve, judge: Judge, aim: float, tasks: Tasks, block: int = _BLOCK
) -> dict[str, int] | None:
    """Nodes along each input that varies, enough for the error ``aim`` where the others are in the middle; None if none are."""
    found: dict[str, int] = {}
    for name in box.varying:
        line = box.line(name)
        places = line.whole({name: np.linspace(*box.ends[name], _PLACES + 2)[1:-1]})
        exact = tasks.at(f"along {name}", solve, places, block)
        for count in _COUNTS:
            table = on_nodes(line, {name: count}, solve, tasks, block)
            if table is not None and judge(table(places), exact, places) < aim:
                found[name] = count
                break
        else:
            return None
    return found


def refined(
    box: Box,
    counts: Mapping[str, int],
    solve: Solve,
    judge: Judge,
    *,
    trial: Places,
    exact: FloatArray,
    worst: float,
    most: int,
    tasks: Tasks,
    block: int = _BLOCK,
) -> Interpolant | None:
    """An interpolant whose error at places of a trial is below ``worst``, from given numbers of nodes on.

    Parameters
    ----------
    box : the inputs
    counts : nodes to begin with
    solve : what to interpolate
    judge : its error
    trial : places that are not used to make it
    exact : solutions there
    worst : allowed error
    most : solutions, at most, on the nodes of a box
    tasks : by whom solutions are computed
    block : solutions at a time

    Returns
    -------
    interpolant : None if it needs more nodes than ``most``, or if there is no solution at some of them
    """
    while prod(counts.values()) <= most:
        table = on_nodes(box, counts, solve, tasks, block)
        if table is None:
            return None
        if (error := judge(table(trial), exact, trial)) < worst:
            return replace(table, error=error)
        counts = {name: count + 1 for name, count in counts.items()}
    return None


def on_nodes(
    box: Box, counts: Mapping[str, int], solve: Solve, tasks: Tasks, block: int = _BLOCK
) -> Interpolant | None:
    """The interpolant with given numbers of nodes; None if some have no solution."""
    values = tasks.at(f"nodes {[*counts.items()]}", solve, box.grid(counts), block)
    if not np.isfinite(values).all():
        return None
    parts = grid_coefficients(values.reshape(*counts.values(), -1))
    return Interpolant(box=box, counts=dict(counts), parts=parts)
