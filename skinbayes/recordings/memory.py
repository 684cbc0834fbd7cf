"""How well the mean of a series with memory is known: the number of independent samples in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import FloatArray

BLOCKS = 256
"""Means of neighbouring samples that a series is replaced by: the mean forgets faster changes anyway."""

MOST_ORDER = 30
"""Order of an autoregression."""

LOST = 2
"""Independent samples of each series that its mean and slope take."""

FEWEST_SAMPLES = 8
"""A shorter series has no error of its own."""


@dataclass(frozen=True)
class Memory:
    """How long a series remembers.

    Attributes
    ----------
    samples : samples that count as one independent one, the sum of the autocorrelation over all lags, dimensionless
    order : of the autoregression that says so
    independent : number of independent samples that it was seen in, dimensionless
    """

    samples: float
    order: int
    independent: float = np.inf


@dataclass(frozen=True)
class MeanError:
    """How well a mean is known.

    Attributes
    ----------
    standard_error : to be used as that of a normal distribution, in the unit of the series
    effective_samples : number of independent samples
    scatter : standard deviation of single samples about a straight line, in the unit of the series
    """

    standard_error: float
    effective_samples: float
    scatter: float


def memory_of(series: Sequence[FloatArray]) -> Memory:
    """Memory that several series have in common, from an autoregression fitted to all of them by Burg's method.

    A straight line is taken off each series. The order is that of the smallest information criterion of Akaike; with
    coefficients a_k and variance v of what is new in a step, the density of the spectrum at frequency zero is
    S = v/(1 + Σ a_k)² (Heidelberger & Welch 1981, 10.1145/358598.358630, use it so), and a mean of n samples has the
    variance S/n.

    Parameters
    ----------
    series : residuals in time, evenly sampled, shape ``(n,)`` each

    Returns
    -------
    Memory
        at least one sample

    Examples
    --------
    >>> noise = np.random.default_rng(1).normal(size=(2, 5000))
    >>> series = noise[:, 1:] + noise[:, :-1]
    >>> round(memory_of(list(series)).samples, 1)
    2.0
    """
    usable = [one - _line(one) for one in series if one.size >= FEWEST_SAMPLES]
    if not usable:
        return Memory(1.0, 0)
    block = max(1, int(np.median([one.size for one in usable])) // BLOCKS)
    variance = sum(float(one @ one) for one in usable) / sum(one.size for one in usable)
    means = [
        one[: one.size // block * block].reshape(-1, block).mean(axis=1)
        for one in usable
        if one.size // block >= FEWEST_SAMPLES
    ]
    if not means or variance <= 0:
        return Memory(1.0, 0)
    density, order = _density_at_zero(means)
    samples = max(1.0, block * density / variance)
    longest = 0.5 * float(np.mean([one.size for one in usable])) / LOST
    # lines take the slowest changes away
    samples /= 1.0 - LOST * min(samples, longest) / float(np.mean([one.size for one in usable]))
    return Memory(samples, order, sum(one.size for one in usable) / samples)


def _line(values: FloatArray) -> FloatArray:
    """Least-squares straight line through a series."""
    x = np.arange(values.size) - 0.5 * (values.size - 1)
    return np.asarray(values.mean() + x * ((x @ values) / (x @ x)))


def _density_at_zero(series: Sequence[FloatArray]) -> tuple[float, int]:
    """Spectral density at frequency zero of an autoregression, in squares of the unit, and its order."""
    total = sum(one.size for one in series)
    forward, backward = [one[1:] for one in series], [one[:-1] for one in series]
    coefficients = np.ones(1)
    new = sum(float(one @ one) for one in series) / total
    best = (total * np.log(new), new, 0) if new > 0 else (0.0, 0.0, 0)
    for order in range(1, 1 + min(MOST_ORDER, min(one.size for one in series) // 3)):
        power = sum(float(f @ f + b @ b) for f, b in zip(forward, backward, strict=True))
        if not power > 0 or not new > 1e-12 * abs(best[1]):
            break
        reflection = -2.0 * sum(float(f @ b) for f, b in zip(forward, backward, strict=True)) / power
        longer = np.append(coefficients, 0.0)
        coefficients = longer + reflection * longer[::-1]
        new *= 1.0 - reflection**2
        criterion = total * np.log(new) + 2 * order if new > 0 else np.inf
        if criterion < best[0]:
            best = (criterion, new / coefficients.sum() ** 2, order)
        forward, backward = (
            [(f + reflection * b)[1:] for f, b in zip(forward, backward, strict=True)],
            [(b + reflection * f)[:-1] for f, b in zip(forward, backward, strict=True)],
        )
    return best[1], best[2]


def error_of_mean(residuals: FloatArray, memory: Memory, *, step: float = 0.0) -> MeanError:
    """Standard error of the mean of a series with memory.

    With s² the variance of the residuals about a straight line and τ the memory, n_e = n/τ samples are independent, and the
    variance of the mean is s²/(n_e − 2), as mean and line have taken two of them. What is returned is larger by the ratio of
    the 95 % quantiles of Student's t with n_e − 2 degrees of freedom and of the normal distribution, so that mean
    ± 1.645 standard errors hold 90 % where s² is known from few independent samples.

    Parameters
    ----------
    residuals : shape ``(n,)``, in the unit of the series
    memory : of this series and others like it
    step : resolution of the sensor, in the unit of the series; where residuals scatter by less it is added, over √12

    Returns
    -------
    MeanError

    Examples
    --------
    >>> noise = np.random.default_rng(1).normal(size=1000)
    >>> found = error_of_mean(noise, Memory(10.0, 1))
    >>> round(found.standard_error, 2), found.effective_samples
    (0.1, 100.0)
    """
    count = residuals.size
    if count < FEWEST_SAMPLES:
        return MeanError(float("nan"), float("nan"), float("nan"))
    left = residuals - _line(residuals)
    variance = float(left @ left) / count
    effective = count / memory.samples
    left_over = max(effective - 2.0, 1.0)
    freedom = max(1.0, 2.0 / (2.0 / left_over + 2.0 / memory.independent))
    error = widening(freedom) * np.sqrt(variance / left_over)
    if variance < step**2:
        error = np.hypot(error, step / np.sqrt(12.0))
    return MeanError(float(error), effective, float(np.sqrt(variance)))


def widening(freedom: float) -> float:
    """Ratio of the 95 % quantiles of Student's t with so many degrees of freedom and of the normal distribution."""
    from scipy.special import ndtri, stdtrit

    return float(stdtrit(freedom, 0.95) / ndtri(0.95))
