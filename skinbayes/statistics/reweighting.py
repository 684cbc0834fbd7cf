"""Draws of one distribution as draws of another, by weights; and whether they can be trusted as such."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np
from scipy.special import logsumexp

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.statistics.annealing import effective_number
from skinbayes.statistics.pareto import TAIL_DOUBT, largest_shape, smoothed

SMOOTHED_FROM = 1 / 3
"""Pareto k from which weights are smoothed; below it their moments of order three exist, and their plain mean is as good."""


@dataclass(frozen=True)
class Reweighted:
    """Draws with other weights.

    Attributes
    ----------
    log_weights : ln of the weights up to a constant, shape ``(N,)``
    log_ratio, error : ln of the mean ratio of the two densities over the first distribution, and its standard error; for
        unnormalised densities that is ln of the ratio of their integrals; the error counts weights that no draw has shown
    shape : Pareto k of the weights
    reliable : whether k is at most that for so many independent draws
    """

    log_weights: FloatArray
    log_ratio: float
    error: float
    shape: float
    reliable: bool


def reweighted(log_weights: FloatArray, log_ratios: FloatArray, correlation: float = 1.0) -> Reweighted:
    """Draws of one density as draws of another.

    Parameters
    ----------
    log_weights : ln of the weights that the draws have, up to a constant, shape ``(N,)``
    log_ratios : ln of the other density over the first one at each draw, −inf where it is zero, shape ``(N,)``
    correlation : draws that one independent one is worth

    Examples
    --------
    >>> draws = np.random.default_rng(1).normal(size=10_000)
    >>> narrower = -0.5 * 3.0 * draws**2  # of half the standard deviation, with an integral half as large
    >>> found = reweighted(np.zeros(draws.size), narrower)
    >>> round(float(np.exp(found.log_ratio)), 2), found.reliable
    (0.5, True)
    """
    top = log_weights.max()
    before = np.exp(log_weights - top)
    effective = effective_number(log_weights) / correlation
    total = log_weights + log_ratios
    if not np.isfinite(total.max()):
        return Reweighted(total, -inf, inf, inf, False)
    after, shape, beyond = smoothed(total)
    after = after if shape >= SMOOTHED_FROM else total
    value = float(logsumexp(after) - logsumexp(log_weights))
    share = np.exp(after - logsumexp(after)) - before / before.sum()
    error = float(np.hypot(np.sqrt(correlation * np.square(share).sum()), TAIL_DOUBT * beyond))
    return Reweighted(after, value, error, shape, shape <= largest_shape(effective))


def quantile_errors(values: FloatArray, weights: FloatArray, probabilities: ArrayLike) -> FloatArray:
    """Standard errors of quantiles of independent draws with weights.

    From the error of the weighted part of the draws below, and the distance of the quantiles that far apart.

    Parameters
    ----------
    values, weights : shape ``(n,)``; the weights need no norm
    probabilities : between 0 and 1, shape ``(q,)``

    Examples
    --------
    >>> draws = np.random.default_rng(1).normal(size=10_000)
    >>> print(quantile_errors(draws, np.ones(draws.size), [0.5]).round(3))  # √(π/2)/100
    [0.012]
    """
    order = np.argsort(values)
    x, share = values[order], weights[order] / weights.sum()
    heights = np.cumsum(share) - share / 2
    p = np.asarray(probabilities, dtype=float)[:, np.newaxis]
    error = np.sqrt((np.square(share) * np.square((heights <= p) - p)).sum(axis=1))
    p = p[:, 0]
    return np.asarray((np.interp(p + error, heights, x) - np.interp(p - error, heights, x)) / 2)
