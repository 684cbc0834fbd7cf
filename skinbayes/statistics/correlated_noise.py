"""Noise with a memory: an Ornstein–Uhlenbeck process along a column, at a cost linear in the rows.

In units of its width the noise of two rows of one series that lie Δ apart has the correlation (1 − ν) exp(−Δ/length), and 1 with
itself: ν is the fraction of its variance that is independent from row to row (a nugget). Rows at equal distances make an AR(1)
process, φ = exp(−Δ/length). Different series share nothing.

The precision of an Ornstein–Uhlenbeck process is tridiagonal: each value depends on the one before it only. Without an
independent part whitening is a difference of neighbours. With it the process u is a latent variable, and
a ↦ [(a − √(1 − ν) u)/√ν, whitened u], at the u that makes it shortest, is a linear map whose inner products are those with the
inverse of the correlation matrix; an error of u enters squares in second order only.

References
----------
Rue & Held, Gaussian Markov Random Fields, Chapman & Hall (2005), doi 10.1201/9780203492024;
Pinheiro & Bates, Mixed-Effects Models in S and S-PLUS, Springer (2000), doi 10.1007/b98882, chapter 5 (correlation, nugget).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpttrf, dpttrs

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError


@dataclass(frozen=True, eq=False)
class CorrelatedNoise:
    """Which rows follow each other, and how far apart.

    Attributes
    ----------
    along : value of the column at each row, shape ``(N,)``, in any unit, that of the length
    series : number of the series of each row, shape ``(N,)``
    independent : whether there is an independent part
    order : rows in order of series and column, shape ``(N,)``
    state : place among the S different values of the column of each row in this order, shape ``(N,)``
    gap : distance of each of these values from the one before, infinite at the start of a series, shape ``(S,)``
    """

    along: FloatArray
    series: NDArray[np.intp]
    independent: bool
    order: NDArray[np.intp]
    state: NDArray[np.intp]
    gap: FloatArray

    @classmethod
    def of(cls, along: ArrayLike, series: ArrayLike, independent: bool) -> CorrelatedNoise:
        """Put rows in order.

        Raises
        ------
        InputError
            two rows of one series at the same value, without an independent part
        """
        x, number = np.asarray(along, dtype=float), np.asarray(series, dtype=np.intp)
        order = np.lexsort((x, number))
        new_series = np.concatenate([[True], np.diff(number[order]) != 0])
        step = np.concatenate([[np.inf], np.diff(x[order])])
        new_state = new_series | (step > 0.0)
        if not independent and not new_state.all():
            row = int(order[np.flatnonzero(~new_state)[0]])
            raise InputError(
                f"rows of one series have the same place ({x[row]:.6g} in SI): their noise would be the same. Expected different "
                "places in each series; tell series apart with 'within', or give the noise an 'independent' part"
            )
        gap = np.where(new_series, np.inf, step)[new_state]
        return cls(x, number, independent, order, np.cumsum(new_state) - 1, gap)

    @cached_property
    def in_order(self) -> bool:
        """Whether the rows stand in order already."""
        return bool((np.diff(self.order) == 1).all())

    @cached_property
    def starts(self) -> NDArray[np.intp]:
        """First of the sorted rows of each different value of the column."""
        return np.flatnonzero(np.diff(self.state, prepend=-1))

    @cached_property
    def counts(self) -> NDArray[np.intp]:
        """Rows of each different value of the column, shape ``(S,)``."""
        return np.bincount(self.state)

    @property
    def n_series(self) -> int:
        """Number of series."""
        return int(self.series.max()) + 1

    def drift_design(self) -> FloatArray:
        """Column of each series that rises from 0 at its first row to 1 over the longest series, shape ``(N, n_series)``."""
        first = np.full(self.n_series, np.inf)
        np.minimum.at(first, self.series, self.along)
        since = self.along - first[self.series]
        found = np.zeros((len(since), self.n_series))
        found[np.arange(len(since)), self.series] = since / since.max()
        return found

    def at(self, length: FloatArray, fraction: FloatArray) -> _Memory:
        """The noise of a batch: ``length`` > 0 and ``fraction`` between 0 and 1, of shape ``(B,)``."""
        gaps, place, counts = self._steps
        exponent = gaps / length[:, np.newaxis]
        innovation = -np.expm1(-2.0 * exponent)
        memory, narrowed = np.exp(-exponent), 1.0 / np.sqrt(innovation)
        log_innovations = (counts * np.log(innovation)).sum(axis=-1)
        memory, narrowed = np.take(memory, place, axis=1), np.take(narrowed, place, axis=1)
        return _Memory(self, memory, narrowed, log_innovations, fraction)

    @cached_property
    def _steps(self) -> tuple[FloatArray, NDArray[np.intp], NDArray[np.intp]]:
        """Different gaps, which of them each value has, and how often each occurs: a series often has equal steps."""
        finite = self.gap[np.isfinite(self.gap)]
        typical = float(np.median(finite)) if finite.size else 1.0
        different, place, counts = np.unique(
            np.round(self.gap / typical, 12), return_inverse=True, return_counts=True
        )
        return different * typical, place.astype(np.intp), counts


@dataclass(frozen=True, eq=False)
class _Memory:
    """The correlation matrix C of a batch.

    Attributes
    ----------
    memory : of each value of the one before, shape ``(B, S)``
    narrowed : one over the standard deviation of what is new in each, shape ``(B, S)``
    log_innovations : sum of ln of its variances, shape ``(B,)``
    fraction : independent fraction, shape ``(B,)``
    """

    noise: CorrelatedNoise
    memory: FloatArray
    narrowed: FloatArray
    log_innovations: FloatArray
    fraction: FloatArray

    def whiten(self, rows: FloatArray) -> FloatArray:
        """Numbers whose inner products are those of rows ``(B, K, N)`` with the inverse of C; ``(B, K, N or N + S)``."""
        sorted_rows = self._sorted(rows)
        if not self.noise.independent:
            return self._innovations(sorted_rows)
        left, latent = self._split(sorted_rows)
        left /= np.sqrt(self.fraction)[:, np.newaxis, np.newaxis]
        return np.concatenate([left, self._innovations(latent)], axis=-1)

    def solve(self, rows: FloatArray) -> FloatArray:
        """The inverse of C times each of ``rows`` of shape ``(B, K, N)``, same shape."""
        sorted_rows = self._sorted(rows)
        if self.noise.independent:
            solved = self._split(sorted_rows)[0] / self.fraction[:, np.newaxis, np.newaxis]
        else:
            whitened = self._innovations(sorted_rows) * self.narrowed[:, np.newaxis]
            solved = whitened.copy()
            solved[..., :-1] -= self.memory[:, np.newaxis, 1:] * whitened[..., 1:]
        return self._unsorted(solved)

    def log_determinant(self) -> FloatArray:
        """ln det C, shape ``(B,)``."""
        if not self.noise.independent:
            return self.log_innovations
        pivots = np.stack([factored[0] for factored in self._factored])
        count = len(self.noise.order)
        return np.asarray(self.log_innovations + np.log(pivots).sum(axis=-1) + count * np.log(self.fraction))

    def diagonal(self) -> FloatArray:
        """Diagonal of the inverse of C, shape ``(B, N)``."""
        if self.noise.independent:
            share = (1.0 - self.fraction) / self.fraction
            variance = np.stack([_diagonal_of_inverse(*matrix) for matrix in self._posterior_precisions()])
            known = (1.0 - share[:, np.newaxis] * variance) / self.fraction[:, np.newaxis]
            values = np.take(known, self.noise.state, axis=1)
        else:
            values = self._precision()[0]
        return self._unsorted(values)

    def draw(self, rng: np.random.Generator) -> FloatArray:
        """Noise of width 1, shape ``(B, N)``."""
        u = rng.standard_normal(self.memory.shape) / self.narrowed
        for i in range(1, u.shape[1]):
            u[:, i] += self.memory[:, i] * u[:, i - 1]
        values = np.take(u, self.noise.state, axis=1)
        if self.noise.independent:
            own = np.sqrt(self.fraction)[:, np.newaxis] * rng.standard_normal(values.shape)
            values = np.sqrt(1.0 - self.fraction)[:, np.newaxis] * values + own
        return self._unsorted(values)

    # -- inner parts -------------------------------------------------------------------------------------------------

    def _sorted(self, rows: FloatArray) -> FloatArray:
        return rows if self.noise.in_order else np.take(rows, self.noise.order, axis=-1)

    def _unsorted(self, values: FloatArray) -> FloatArray:
        if self.noise.in_order:
            return values
        found = np.empty_like(values)
        found[..., self.noise.order] = values
        return found

    def _innovations(self, values: FloatArray) -> FloatArray:
        """What is new in each value of the process, with width 1; shape ``(B, K, S)`` as the values."""
        found = np.empty_like(values)
        found[..., 0] = values[..., 0]
        np.multiply(self.memory[:, np.newaxis, 1:], values[..., :-1], out=found[..., 1:])
        np.subtract(values[..., 1:], found[..., 1:], out=found[..., 1:])
        found *= self.narrowed[:, np.newaxis]
        return found

    def _precision(self) -> tuple[FloatArray, FloatArray]:
        """Diagonal ``(B, S)`` and off-diagonal ``(B, S − 1)`` of the inverse of the covariance of the process."""
        coupling = self.memory[:, 1:] * self.narrowed[:, 1:] ** 2
        diagonal = self.narrowed**2
        diagonal[:, :-1] += self.memory[:, 1:] * coupling
        return diagonal, -coupling

    @cached_property
    def _factored(self) -> list[tuple[FloatArray, FloatArray]]:
        """Pivots and factors of these matrices."""
        return [dpttrf(*matrix)[:2] for matrix in self._posterior_precisions()]

    def _posterior_precisions(self) -> list[tuple[FloatArray, FloatArray]]:
        """The same of the process given values of the rows, for each of the batch."""
        diagonal, coupling = self._precision()
        share = (1.0 - self.fraction) / self.fraction
        diagonal = diagonal + share[:, np.newaxis] * self.noise.counts
        return list(zip(diagonal, coupling, strict=True))

    def _split(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values of sorted rows as independent part ``(B, K, N)`` and process ``(B, K, S)``, each at its posterior mean."""
        root = np.sqrt(1.0 - self.fraction)[:, np.newaxis, np.newaxis]
        repeated, state = len(self.noise.gap) < len(self.noise.state), self.noise.state
        sums = np.add.reduceat(values, self.noise.starts, axis=-1) if repeated else values
        sums = sums * (root / self.fraction[:, np.newaxis, np.newaxis])
        process = np.empty_like(sums)
        for i, (pivots, factors) in enumerate(self._factored):
            process[i] = dpttrs(pivots, factors, sums[i].T)[0].T
        return values - root * (np.take(process, state, axis=-1) if repeated else process), process


def _diagonal_of_inverse(diagonal: FloatArray, coupling: FloatArray) -> FloatArray:
    """Diagonal of the inverse of a tridiagonal matrix: pivots of the elimination from either end meet in each row."""
    forward, backward = dpttrf(diagonal, coupling)[0], dpttrf(diagonal[::-1], coupling[::-1])[0][::-1]
    return np.asarray(1.0 / (forward + backward - diagonal))
