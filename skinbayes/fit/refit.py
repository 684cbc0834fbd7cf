"""What a model predicts for data that are really left out: sampled without them."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, log
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq
from scipy.special import expit, logsumexp

from skinbayes.arrays import FloatArray
from skinbayes.fit.sampled_anew import SAMPLE_SIZE, sampled_anew
from skinbayes.problem.subsets import without_data

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from skinbayes.problem import JointProblem, Problem

REFIT_STEPS = 4000
"""Steps after which a refit ends, converged or not: there may be many refits."""

AGREEMENT = 5.0
"""Standard errors by which the bridge and the difference of two ln Z may differ; those of a bridge over a gap are rough."""

PART = 250
"""Draws whose densities are computed at a time, to bound memory."""


@dataclass(frozen=True)
class Refit:
    """Predictive density of data that were left out.

    Attributes
    ----------
    log_density : ln p(data left out | all other data)
    error : its standard error, of Monte Carlo
    reliable : whether the posterior without these data was sampled until the stopping rule was met, and the two ways to the
        number agree where there are two
    """

    log_density: float
    error: float
    reliable: bool


def predict_left_out(
    problem: Problem | JointProblem,
    keep: NDArray[np.bool_],
    whole: FloatArray,
    effective: float,
    evidence: tuple[float, float] | None = None,
    seed: int = 1,
    ess: float = SAMPLE_SIZE,
) -> Refit:
    """Sample the problem without some of its data, and score these.

    ln p(y_L | y_−L) is the ratio of the evidences of all data and of those that are left, from draws of both posteriors, see
    :func:`ratio_of_evidences`; or the difference of the two ln Z where both are known and that is more certain, as it is where
    the posteriors hardly overlap.

    Parameters
    ----------
    problem : a problem with data
    keep : which data stay, shape ``(M,)``
    whole : ln p(data left out | all other data, θ) at draws from the posterior of all data, shape ``(S,)``
    effective : number of independent draws that these are worth
    evidence : ln Z of all data and its standard error, if it is known
    seed : non-negative integer
    ess : effective sample size wanted in every parameter
    """
    reduced = without_data(problem, keep)
    found = sampled_anew(reduced, seed=seed, max_steps=REFIT_STEPS, ess=ess)
    density = left_out_densities(problem, reduced, found.theta)
    value, error = ratio_of_evidences(density, whole, found.log_weights, effective)
    agree = True
    if evidence is not None and found.evidence is not None:
        gap, its_error = evidence[0] - found.evidence[0], hypot(evidence[1], found.evidence[1])
        agree = abs(gap - value) <= AGREEMENT * hypot(error, its_error)
        if its_error < error:
            value, error = gap, its_error
    return Refit(value, error, found.converged and agree)


def left_out_densities(
    problem: Problem | JointProblem, reduced: Problem | JointProblem, theta: FloatArray
) -> FloatArray:
    """ln p(data left out | all other data, θ) by the rule of products, shape ``(S,)``.

    Parameters
    ----------
    problem, reduced : with all data, and without those left out
    theta : parameter vectors, shape ``(S, D)``
    """
    parts = [theta[i : i + PART] for i in range(0, len(theta), PART)]
    return np.concatenate([problem.log_likelihood(part) - reduced.log_likelihood(part) for part in parts])


def ratio_of_evidences(
    without: FloatArray,
    whole: FloatArray,
    log_weights: FloatArray | None = None,
    effective: float | None = None,
) -> tuple[float, float]:
    """ln of the ratio of two evidences from draws of both posteriors, by the best bridge between them.

    Let the posterior of all data be that without some of them times exp(u), not normalised. Then for any c

    ln(Z/Z_0) = c + ln ⟨σ(u − c)⟩_0 − ln ⟨σ(c − u)⟩

    with the logistic function σ and means over draws without the data (0) and with them. The error is least where c is the
    ratio itself, shifted by ln of the ratio of the numbers of draws. The mean of exp(u) over draws without the data would be
    correct too, but a few draws decide it when the data are surprising.

    Parameters
    ----------
    without, whole : u at draws of the two posteriors, shapes ``(S0,)`` and ``(S,)``
    log_weights : of the draws without the data, up to a constant, shape ``(S0,)``; None if they all weigh the same
    effective : number of independent draws that those with all data are worth; S if omitted

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
    weights = np.full(len(without), -log(len(without))) if log_weights is None else log_weights
    weights = np.exp(weights - logsumexp(weights))
    counts = float(1 / np.square(weights).sum()), float(effective or len(whole))
    shift = log(counts[1] / counts[0])
    both = np.concatenate([without, whole])
    finite = both[np.isfinite(both)]
    if not finite.size:
        return float("-inf"), float("inf")

    def terms(ratio: float) -> tuple[FloatArray, FloatArray]:
        return expit(without - ratio + shift), expit(ratio - shift - whole)

    def imbalance(ratio: float) -> float:
        first, second = terms(ratio)
        return float(counts[0] * (weights @ first) - counts[1] * second.mean())

    low, high = finite.min() - abs(shift) - 40.0, finite.max() + abs(shift) + 40.0
    ratio = float(brentq(imbalance, low, high, xtol=1e-10))
    first, second = terms(ratio)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = weights @ first
        variance = np.square(weights) @ np.square(first - mean) / mean**2
        variance += second.var() / second.mean() ** 2 / counts[1]
    return ratio, float(np.sqrt(variance)) if np.isfinite(variance) else float("inf")
