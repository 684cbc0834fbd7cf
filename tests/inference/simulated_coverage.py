"""Coverage of truths drawn from the prior: over the prior, the truth is a posterior draw like any other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from importance import importance_sample
from scipy import stats

from skinbayes.problem import Problem
from skinbayes.problem.simulated import with_data

ALPHA = 5e-4
"""Probability that one test of one parameter fails though the posterior is right."""


@dataclass(frozen=True)
class Recovered:
    """Posteriors of simulated data, of n simulations and D parameters in unconstrained coordinates.

    Attributes
    ----------
    names : parameters
    truths : shape ``(n, D)``
    levels : posterior probability of less than the truth, ``(n, D)``
    means, widths : posterior mean and standard deviation, ``(n, D)``
    sizes : effective sample size of each posterior, ``(n,)``
    """

    names: tuple[str, ...]
    truths: np.ndarray
    levels: np.ndarray
    means: np.ndarray
    widths: np.ndarray
    sizes: np.ndarray


def possible_draws(problem: Problem, rng: np.random.Generator, count: int) -> np.ndarray:
    """Draws of the prior where the forward model predicts all data, ``(count, D)``.

    The posterior gives no weight to the others, so that it is this prior over which its intervals have to cover.
    """
    draws = problem.draw_prior(rng, 2 * count + 50)
    draws = draws[np.isfinite(problem.predict_data(draws)).all(axis=1)]
    assert len(draws) >= count, "the forward model is silent for half of the prior"
    return draws[:count]


def recover(maker: Problem, simulations: int, seed: int) -> Recovered:
    """Draw truths, simulate data with new group effects for each, and find the posteriors."""
    rng = np.random.default_rng(seed)
    truths = possible_draws(maker, rng, simulations)
    transform = maker.target().transform
    levels, means, widths, sizes = [], [], [], []
    for i, truth in enumerate(transform.forward(truths)):
        problem = with_data(maker, maker.simulate(truths[i], rng))
        found = importance_sample(problem, rng)
        mean, width = found.moments()
        levels.append(found.levels(truth))
        means.append(mean)
        widths.append(width)
        sizes.append(found.effective_size)
    return Recovered(
        maker.names, transform.forward(truths), *(np.array(v) for v in (levels, means, widths, sizes))
    )


def inside(levels: np.ndarray, fraction: float) -> int:
    """How many central intervals of a probability hold the truth."""
    return int(np.count_nonzero(np.abs(levels - 0.5) < fraction / 2))


def failed_tests(levels: np.ndarray) -> list[str]:
    """The tests that levels ``(n,)`` of one parameter fail, each wrong with probability ``ALPHA`` if levels are uniform.

    Counts in the 50 % and 90 % intervals are binomial. Normal scores of the levels have mean 0 (else the posterior is off by as
    many of its standard deviations) and variance 1 (else it is too wide or too narrow by the root of it); Kolmogorov–Smirnov
    sees other shapes.
    """
    n = levels.size
    found = []
    for fraction in (0.5, 0.9):
        hits = inside(levels, fraction)
        low, high = stats.binom.ppf([ALPHA / 2, 1 - ALPHA / 2], n, fraction)
        if not low <= hits <= high:
            found.append(f"{hits} of {n} in the {fraction:.0%} interval, {low:.0f} to {high:.0f} expected")
    scores = stats.norm.ppf(levels)
    limit = stats.norm.ppf(1 - ALPHA / 2) / np.sqrt(n)
    if not abs(scores.mean()) < limit:
        found.append(f"off by {scores.mean():.2f} standard deviations, at most {limit:.2f} expected")
    variance = np.square(scores).sum() / n
    low, high = stats.chi2.ppf([ALPHA / 2, 1 - ALPHA / 2], n) / n
    if not low < variance < high:
        found.append(f"scores of variance {variance:.2f}, {low:.2f} to {high:.2f} expected")
    p_value = stats.kstest(levels, "uniform").pvalue
    if not p_value > ALPHA:
        found.append(f"levels are not uniform (p = {p_value:.1g})")
    return found
