"""Stick and slip: whether a series repeats itself, and how often."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from skinbayes.arrays import FloatArray

REPEATED = 0.15
"""Least autocorrelation after one period."""

FEWEST_PERIODS = 8
"""In a series of typical length; of fewer nothing can be told."""

SHORTEST_PERIOD = 4
"""Samples of a period."""


def period_of(series: Sequence[FloatArray]) -> float:
    """Samples from one cycle to the next of a series that repeats itself, nan of others.

    The autocorrelation, averaged over the series with a straight line taken off each, has to rise again above 0.15 after it was
    negative; the period is where it is largest, up to an eighth of the median length.

    Parameters
    ----------
    series : residuals in time, evenly sampled, shape ``(n,)`` each

    Examples
    --------
    >>> x = np.arange(1000.0)
    >>> period_of([x % 50.0]), period_of([np.random.default_rng(1).normal(size=1000)])
    (50.0, nan)
    """
    from scipy.signal import correlate, detrend

    usable = [one for one in series if one.size >= 6 * SHORTEST_PERIOD and np.ptp(one) > 0]
    if not usable:
        return float("nan")
    longest = int(np.median([one.size for one in usable])) // FEWEST_PERIODS + 1
    usable = [one for one in usable if one.size > longest]
    total = np.zeros(longest)
    for one in usable:
        left = detrend(one)
        found = correlate(left, left, method="fft")[left.size - 1 : left.size - 1 + longest]
        total += found * left.size / (left.size - np.arange(longest))
    if not total[0] > 0:
        return float("nan")
    total /= total[0]
    negative = np.flatnonzero(total < 0)
    if not negative.size:
        return float("nan")
    after = total[negative[0] :]
    best = int(negative[0] + after.argmax())
    # the largest value at the end of what is looked at belongs to no maximum
    if total[best] < REPEATED or best < SHORTEST_PERIOD or best == longest - 1:
        return float("nan")
    return float(best)


def in_cycles(series: FloatArray, cycle: int) -> FloatArray:
    """Means of a series over each whole cycle of so many samples; the series itself if that is one, or longer than an eighth."""
    if cycle == 1 or series.size < FEWEST_PERIODS * cycle:
        return series
    return np.asarray(series[: series.size // cycle * cycle].reshape(-1, cycle).mean(axis=1))
