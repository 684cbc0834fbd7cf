"""How far the inputs of a problem reach."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.forward.base import Ranges

if TYPE_CHECKING:
    from skinbayes.problem.problem import Problem

DRAWS = 2000
"""Prior draws looked at."""

BEYOND = 1e-5
"""Share of the prior of each parameter that lies beyond the range on either side."""


def input_ranges(problem: Problem, seed: int = 4) -> Ranges:
    """Smallest and largest value of each input over the rows and nearly all of the prior; inputs that are not finite left out.

    Parameters
    ----------
    problem : any problem
    seed : seed of the prior draws

    Notes
    -----
    Looked at are prior draws, and each parameter by itself at its outermost quantiles with the others at their medians.
    """
    dimension = problem.dimension
    vectors = np.tile(np.full(dimension, 0.5), (2 * dimension, 1))
    for i in range(dimension):
        vectors[2 * i : 2 * i + 2, i] = BEYOND, 1 - BEYOND
    draws = np.concatenate(
        [problem.prior_transform(vectors), problem.draw_prior(np.random.default_rng([seed]), DRAWS)]
    )
    found = {}
    for name, values in problem.inputs(draws).items():
        if np.isfinite(values).all():
            found[name] = (float(values.min()), float(values.max()))
    return found
