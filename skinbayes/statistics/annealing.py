"""A population led from the prior towards the posterior, by raising the power of the likelihood a little at a time.

Where data are many, draws of the prior hit the posterior too rarely to choose starts from them: walkers that begin far out on a
curved ridge crawl along it for thousands of steps. Each rise of the power takes a weighted choice of the population, and some
moves by differences between its members; what comes out is spread as the widened posterior is, modes included.
"""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.statistics.densities import BatchFunction

SWEEPS, LAST_SWEEPS = 4, 12
"""Moves of all members after each rise of the power, unless told otherwise, and after the last."""

_FRACTION = 0.4  # of the members that the weights of a rise leave effective
_JITTER = 1e-4  # of the spread of the population, so that members chosen twice part


def effective_number(log_weight: FloatArray) -> float:
    """Effective number of weights, ``(Σw)²/Σw²``, from their logarithms.

    Parameters
    ----------
    log_weight : shape ``(n,)``, at least one of them finite

    Examples
    --------
    >>> effective_number(np.array([0.3, 0.3])), effective_number(np.array([0.0, -np.inf]))
    (2.0, 1.0)
    """
    weight = np.exp(log_weight - log_weight.max())
    return float(weight.sum() ** 2 / np.square(weight).sum())


def largest_power(log_likelihood: FloatArray, count: float, low: float = 0.0, high: float = 1.0) -> float:
    """Largest power between two at which the effective number of weights ``L^(power − low)`` is at least ``count``.

    Parameters
    ----------
    log_likelihood : ln L, shape ``(n,)``
    count : wanted effective number
    low, high : powers; ``low`` is where the weights are equal

    Examples
    --------
    >>> round(largest_power(np.array([0.0, -10.0, -20.0]), 2.0), 3)
    0.096
    """
    start = low
    if effective_number((high - start) * log_likelihood) >= count:
        return high
    for _ in range(40):
        middle = (low + high) / 2
        enough = effective_number((middle - start) * log_likelihood) >= count
        low, high = (middle, high) if enough else (low, middle)
    return low


def anneal(
    position: FloatArray,
    log_likelihood: FloatArray,
    power: float,
    final: float,
    prior: BatchFunction,
    likelihood: BatchFunction,
    rng: np.random.Generator,
    sweeps: int = SWEEPS,
) -> FloatArray:
    """Lead a population distributed as ``prior · L^power`` to ``prior · L^final``.

    Sequential Monte Carlo (Del Moral, Doucet & Jasra 2006, doi 10.1111/j.1467-9868.2006.00553.x) with differential evolution
    (ter Braak 2006, doi 10.1007/s11222-006-8769-1) between two halves of the population as its moves.

    Parameters
    ----------
    position : members, shape ``(n, D)``, n at least 4
    log_likelihood : ln L of the members, finite, shape ``(n,)``
    power : where the population stands
    final : where it shall go, not less
    prior, likelihood : logarithms, ``(B, D)`` to ``(B,)``; anything that is not a number, or infinite, is impossible
    rng : source of all randomness
    sweeps : moves of all members after each rise of the power; after the last :data:`LAST_SWEEPS`, if these are more

    Returns
    -------
    members there, shape ``(n, D)``
    """
    position, value = position.copy(), log_likelihood.copy()
    density = _possible(prior(position))
    count, dimension = position.shape
    while power < final:
        # however steep the likelihood, there is an end to it
        following = max(largest_power(value, _FRACTION * count, power, final), min(1.02 * power, final))
        weight = np.exp((following - power) * (value - value.max()))
        # systematic choice: each member as often as its weight says, up to one
        ladder = (rng.random() + np.arange(count)) / count
        chosen = np.minimum(np.searchsorted(np.cumsum(weight) / weight.sum(), ladder), count - 1)
        chosen = rng.permutation(chosen)  # the halves below must not be neighbours
        power, position, value, density = following, position[chosen], value[chosen], density[chosen]
        for _ in range(sweeps if power < final else max(sweeps, LAST_SWEEPS)):
            for half, others in _halves(count):
                step = _difference(position[others], half.size, rng)
                proposal = position[half] + 2.38 / np.sqrt(2 * dimension) * step
                proposal += _JITTER * position.std(axis=0) * rng.normal(size=proposal.shape)
                there = _possible(prior(proposal))
                found = np.full(half.size, -np.inf)
                inside = there > -np.inf
                if inside.any():
                    found[inside] = _possible(likelihood(proposal[inside]))
                gain = there - density[half] + power * (found - value[half])
                taken = np.log(rng.random(half.size)) < gain
                rows = half[taken]
                position[rows], value[rows], density[rows] = proposal[taken], found[taken], there[taken]
    return position


def _possible(log_density: FloatArray) -> FloatArray:
    return np.where(np.isfinite(log_density), log_density, -np.inf)


def _halves(count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    first, second = np.arange(0, count, 2), np.arange(1, count, 2)
    return [(first, second), (second, first)]


def _difference(others: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
    """Differences between two different members of the other half, shape ``(count, D)``."""
    one = rng.integers(len(others), size=count)
    two = (one + rng.integers(1, len(others), size=count)) % len(others)
    return np.asarray(others[one] - others[two])
