"""How far the inputs of a problem reach."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.forward.base import Ranges

if TYPE_CHECKING:
    from skinbayes.problem.problem import Problem

DRAWS = 20_000
"""Prior draws looked at; about one draw in ten thousand lies beyond the range of an input on either side."""


def input_ranges(problem: Problem, seed: int = 4) -> Ranges:
    """Smallest and largest value of each input over the rows and over prior draws; inputs that are not finite left out.

    Parameters
    ----------
    problem : any problem
    seed : seed of the prior draws
    """
    draws = problem.draw_prior(np.random.default_rng([seed]), DRAWS) if problem.free else np.zeros((1, 0))
    found = {}
    for name, values in problem.inputs(draws).items():
        usable = values[np.isfinite(values)]
        if usable.size:
            found[name] = (float(usable.min()), float(usable.max()))
    return found
