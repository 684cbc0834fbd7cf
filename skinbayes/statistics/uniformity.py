"""Whether numbers are uniform between 0 and 1: their empirical distribution with a band that holds all of it at once.

A posterior is calibrated if the true value of a parameter, drawn from the prior, is a draw of the posterior like any other: its
rank among independent posterior draws is then uniform.

Säilynoja, Bürkner & Vehtari 2022, doi 10.1007/s11222-022-10090-6: let c(z) be how many of n numbers are at most z. At each z it
is binomial; the smallest two-sided tail probability of it over all z, γ, says how far the empirical distribution strays. Its
distribution is computed, not simulated: between two points uniform numbers are a Poisson process given their total, so that the
probability of all counts being within limits is a chain of convolutions. ArviZ has the band, but neither the probability of what
was observed nor one name for it in all its versions; a test holds this band against that of ArviZ.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.special import bdtr, bdtrc, gammaln

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError

POINTS = 100
"""Places between 0 and 1 at which the counts are looked at, of which the last counts everything."""


def random_rank(truth: float, draws: FloatArray, rng: np.random.Generator) -> int:
    """Rank of a true value among posterior draws: how many are smaller; among those that equal it any place is as likely.

    Parameters
    ----------
    truth : the value that the data were made with
    draws : independent draws of its posterior, shape ``(L,)``
    rng : decides between places among draws that are equal to the truth

    Returns
    -------
    int
        From 0 to L.

    Examples
    --------
    >>> random_rank(2.5, np.array([1.0, 2.0, 3.0]), np.random.default_rng(1))
    2
    """
    return int(np.sum(draws < truth) + rng.integers(np.sum(draws == truth) + 1))


@dataclass(frozen=True)
class UniformBand:
    """How n uniform numbers are distributed, at :data:`POINTS` places.

    Attributes
    ----------
    count : n

    Examples
    --------
    >>> band = uniform_band(200)
    >>> low, high = band.limits()
    >>> print(low[49].round(3), high[49].round(3))
    -0.105 0.105
    >>> print(f"{band.p_value((np.arange(200) + 0.5) / 200):.2f}", band.p_value(np.linspace(0, 0.8, 200)) < 1e-9)
    1.00 True
    """

    count: int

    @property
    def places(self) -> FloatArray:
        """z, between 0 and 1, shape ``(POINTS − 1,)``."""
        return np.arange(1, POINTS) / POINTS

    def difference(self, values: FloatArray) -> FloatArray:
        """Share of values of at most z less z, at all places, shape ``(POINTS − 1,)``."""
        return np.asarray(self._counts(values) / self.count - self.places)

    def p_value(self, values: FloatArray) -> float:
        """Probability that uniform numbers stray as far as these n somewhere; below about 1e-13 only that it is small."""
        deepest = self._depth[np.arange(POINTS - 1), self._counts(values)].min()
        return min(1.0, max(self._outside(deepest), np.finfo(float).tiny))

    def limits(self, probability: float = 0.95) -> tuple[FloatArray, FloatArray]:
        """Lower and upper end of :meth:`difference` that uniform numbers keep to everywhere with this probability at least."""
        levels = np.unique(self._depth[self._depth < 1.0])
        low, high = 0, len(levels) - 1  # outside() rises with the level
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (
                (middle, high) if self._outside(levels[middle]) <= 1.0 - probability else (low, middle)
            )
        allowed = self._depth > levels[low]
        first = allowed.argmax(axis=1)
        last = self.count - allowed[:, ::-1].argmax(axis=1)
        return first / self.count - self.places, last / self.count - self.places

    def _counts(self, values: FloatArray) -> np.ndarray:
        if len(values) != self.count:
            raise InputError(f"{len(values)} values found, {self.count} expected")
        return np.searchsorted(np.sort(values), self.places + 1e-12, side="right")

    @cached_property
    def _depth(self) -> FloatArray:
        """Two-sided tail probability of each count at each place, shape ``(POINTS − 1, n + 1)``."""
        counts = np.arange(self.count + 1.0)
        z = self.places[:, np.newaxis]
        at_most = bdtr(counts, self.count, z)
        at_least = np.where(counts > 0, bdtrc(np.maximum(counts - 1.0, 0.0), self.count, z), 1.0)
        return np.asarray(2.0 * np.minimum(at_most, at_least))

    def _outside(self, level: float) -> float:
        """Probability that the depth of some count of uniform numbers is at most a level."""
        counts = np.arange(self.count + 1.0)
        mean = self.count / POINTS
        steps = np.exp(counts * np.log(mean) - mean - gammaln(counts + 1.0))
        inside = np.zeros(self.count + 1)
        inside[0] = 1.0
        start = end = 0
        for allowed in self._depth > level:
            if not allowed.any():
                return 1.0
            first, last = int(allowed.argmax()), self.count - int(allowed[::-1].argmax())
            reached = np.convolve(inside[start : end + 1], steps[: last - start + 1])[: last - start + 1]
            inside = np.zeros(self.count + 1)
            inside[first : last + 1] = reached[first - start : last - start + 1]
            start, end = first, last
        final = float(inside[start : end + 1] @ steps[self.count - np.arange(start, end + 1)])
        total = np.exp(self.count * np.log(self.count) - self.count - gammaln(self.count + 1.0))
        return 1.0 - final / float(total)


@lru_cache(maxsize=32)
def uniform_band(count: int) -> UniformBand:
    """How ``count`` uniform numbers are distributed; kept for the next who asks.

    Raises
    ------
    InputError
        There are none.
    """
    if count < 1:
        raise InputError("no values found; at least 1 is expected")
    return UniformBand(count)
