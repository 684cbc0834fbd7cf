"""What a model predicts for data that are really left out: sampled without them."""

from __future__ import annotations

from dataclasses import dataclass
from math import log
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq
from scipy.special import expit

from skinbayes.arrays import FloatArray
from skinbayes.problem.subsets import without_level

if TYPE_CHECKING:
    from skinbayes.problem import Problem

REFIT_ESS = 1000.0
"""Effective sample size of a refit unless told otherwise."""

REFIT_STEPS = 4000
"""Steps after which a refit ends, converged or not: there may be many refits."""

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
    problem: Problem, column: str, level: str, whole: FloatArray, seed: int = 1, ess: float = REFIT_ESS
) -> LeftOutDensity:
    """Sample the problem without one level of a grouping column, and score the data of this level.

    ln p(y_L | y_−L) is the ratio of the evidences of all data and of those without the level, from draws of both posteriors,
    see :func:`ratio_of_evidences`.

    Parameters
    ----------
    problem : a problem with data of one observable
    column, level : what to leave out
    whole : ln p(data of the level | all other data, θ) at draws from the posterior of all data, shape ``(S,)``
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
    chains = run_ensembles(target, SamplerOptions(seed=seed, ess=ess, max_steps=REFIT_STEPS))
    positions, _ = chains.draws(DRAWS_PER_CHAIN)
    draws = target.transform.inverse(positions.reshape(-1, positions.shape[-1]))
    place = list(dict.fromkeys(problem.conditions.labels[column].tolist())).index(level)
    density = np.concatenate(
        [
            problem.log_likelihood_left_out(draws[i : i + PART], column)[:, place]
            for i in range(0, len(draws), PART)
        ]
    )
    value, error = ratio_of_evidences(density, whole)
    return LeftOutDensity(value, error, chains.converged)


def ratio_of_evidences(without: FloatArray, whole: FloatArray) -> tuple[float, float]:
    """ln of the ratio of two evidences from draws of both posteriors, by the best bridge between them.

    Let the posterior of all data be that without some of them times exp(u), not normalised. Then for any c

    ln(Z/Z_0) = c + ln ⟨σ(u − c)⟩_0 − ln ⟨σ(c − u)⟩

    with the logistic function σ and means over draws without the data (0) and with them. The error is least where c is the
    ratio itself, shifted by ln of the ratio of the numbers of draws. The mean of exp(u) over draws without the data would be
    correct too, but a few draws decide it when the data are surprising.

    Parameters
    ----------
    without, whole : u at independent draws of the two posteriors, shapes ``(S0,)`` and ``(S,)``

    Returns
    -------
    ln(Z/Z_0) and its standard error; infinite if the two have no draw in common

    References
    ----------
    Bennett, Journal of Computational Physics 22 (1976) 245, doi 10.1016/0021-9991(76)90078-4; Meng & Wong, Statistica Sinica 6
    (1996) 831.

    Examples
    --------
    >>> ratio, error = ratio_of_evidences(np.full(10, -2.5), np.full(30, -2.5))
    >>> round(ratio, 6), round(error, 6)
    (-2.5, 0.0)
    """
    shift = log(len(whole) / len(without))
    both = np.concatenate([without, whole])
    finite = both[np.isfinite(both)]
    if not finite.size:
        return float("-inf"), float("inf")

    def imbalance(ratio: float) -> float:
        return float(expit(without - ratio + shift).sum() - expit(ratio - shift - whole).sum())

    low, high = finite.min() - abs(shift) - 40.0, finite.max() + abs(shift) + 40.0
    ratio = float(brentq(imbalance, low, high, xtol=1e-10))
    terms = (expit(without - ratio + shift), expit(ratio - shift - whole))
    with np.errstate(divide="ignore", invalid="ignore"):
        variance = sum(float(term.var() / term.mean() ** 2 / len(term)) for term in terms)
    return ratio, float(np.sqrt(variance)) if np.isfinite(variance) else float("inf")
