"""What a model predicts for data that are really left out: sampled without them."""

from __future__ import annotations

from dataclasses import dataclass
from math import log
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import logsumexp

from skinbayes.problem.subsets import without_level

if TYPE_CHECKING:
    from skinbayes.problem import Problem

REFIT_ESS = 1000.0
"""Effective sample size of a refit unless told otherwise; as importance sampling without weights needs."""

DRAWS_PER_CHAIN = 1000

PART = 250
"""Draws whose densities are computed at a time, to bound memory."""


@dataclass(frozen=True)
class LeftOutDensity:
    """Predictive density of data that were left out.

    Attributes
    ----------
    log_density : ln p(data of the level | all other data)
    error : its standard error, of Monte Carlo
    converged : whether the posterior without these data was sampled until the stopping rule was met
    """

    log_density: float
    error: float
    converged: bool


def predict_left_out(
    problem: Problem, column: str, level: str, seed: int = 1, ess: float = REFIT_ESS
) -> LeftOutDensity:
    """Sample the problem without one level of a grouping column, and score the data of this level.

    ln p(y_L | y_−L) = ln of the mean of p(y_L | y_−L, θ) over draws θ of the posterior of y_−L.

    Parameters
    ----------
    problem : a problem with data of one observable
    column, level : what to leave out
    seed : non-negative integer
    ess : effective sample size wanted in every parameter

    Raises
    ------
    InputError
        No such level, or no other one.
    """
    from skinbayes.sampling.ensembles import run_ensembles
    from skinbayes.sampling.options import SamplerOptions

    reduced = without_level(problem, column, level)
    target = reduced.target()
    chains = run_ensembles(target, SamplerOptions(seed=seed, ess=ess))
    positions, _ = chains.draws(DRAWS_PER_CHAIN)
    draws = target.transform.inverse(positions.reshape(-1, positions.shape[-1]))
    place = list(dict.fromkeys(problem.conditions.labels[column].tolist())).index(level)
    density = np.concatenate(
        [
            problem.log_likelihood_left_out(draws[i : i + PART], column)[:, place]
            for i in range(0, len(draws), PART)
        ]
    )
    mean = float(logsumexp(density) - log(len(density)))
    with np.errstate(invalid="ignore"):
        error = float(np.exp(density - mean).std() / np.sqrt(len(density)))
    return LeftOutDensity(mean, error, chains.converged)
