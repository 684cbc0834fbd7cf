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
        exponent = self.gap / length[:, np.newaxis]
        return _Memory(self, np.exp(-exponent), -np.expm1(-2.0 * exponent), fraction)


@dataclass(frozen=True, eq=False)
class _Memory:
    """The correlation matrix C of a batch; ``memory`` and ``innovation`` (variances) of each value, shape ``(B, S)``."""

    noise: CorrelatedNoise
    memory: FloatArray
    innovation: FloatArray
    fraction: FloatArray

    def whiten(self, columns: FloatArray) -> FloatArray:
        """Numbers whose inner products are those of columns ``(B, N, K)`` with the inverse of C; ``(B, N or N + S, K)``."""
        sorted_rows = np.take(columns, self.noise.order, axis=1)
        if not self.noise.independent:
            return self._innovations(sorted_rows)
        left, latent = self._split(sorted_rows)
        left /= np.sqrt(self.fraction)[:, np.newaxis, np.newaxis]
        return np.concatenate([left, self._innovations(latent)], axis=1)

    def solve(self, columns: FloatArray) -> FloatArray:
        """The inverse of C times columns, shape ``(B, N, K)``."""
        sorted_rows = np.take(columns, self.noise.order, axis=1)
        if self.noise.independent:
            solved = self._split(sorted_rows)[0] / self.fraction[:, np.newaxis, np.newaxis]
        else:
            whitened = self._innovations(sorted_rows) / np.sqrt(self.innovation)[:, :, np.newaxis]
            solved = whitened.copy()
            solved[:, :-1] -= self.memory[:, 1:, np.newaxis] * whitened[:, 1:]
        found = np.empty_like(solved)
        found[:, self.noise.order] = solved
        return found

    def log_determinant(self) -> FloatArray:
        """ln det C, shape ``(B,)``."""
        found = np.log(self.innovation).sum(axis=-1)
        if not self.noise.independent:
            return np.asarray(found)
        pivots = np.stack([np.asarray(dpttrf(*matrix)[0]) for matrix in self._posterior_precisions()])
        count = len(self.noise.order)
        return np.asarray(found + np.log(pivots).sum(axis=-1) + count * np.log(self.fraction))

    def diagonal(self) -> FloatArray:
        """Diagonal of the inverse of C, shape ``(B, N)``."""
        if self.noise.independent:
            share = (1.0 - self.fraction) / self.fraction
            variance = np.stack([_diagonal_of_inverse(*matrix) for matrix in self._posterior_precisions()])
            known = (1.0 - share[:, np.newaxis] * variance) / self.fraction[:, np.newaxis]
            values = np.take(known, self.noise.state, axis=1)
        else:
            values = self._precision()[0]
        found = np.empty_like(values)
        found[:, self.noise.order] = values
        return found

    def draw(self, rng: np.random.Generator) -> FloatArray:
        """Noise of width 1, shape ``(B, N)``."""
        u = rng.standard_normal(self.memory.shape) * np.sqrt(self.innovation)
        for i in range(1, u.shape[1]):
            u[:, i] += self.memory[:, i] * u[:, i - 1]
        values = np.take(u, self.noise.state, axis=1)
        if self.noise.independent:
            own = np.sqrt(self.fraction)[:, np.newaxis] * rng.standard_normal(values.shape)
            values = np.sqrt(1.0 - self.fraction)[:, np.newaxis] * values + own
        found = np.empty_like(values)
        found[:, self.noise.order] = values
        return found

    # -- inner parts -------------------------------------------------------------------------------------------------

    def _innovations(self, values: FloatArray) -> FloatArray:
        """What is new in each value of the process, with width 1; shape ``(B, S, K)`` as the values."""
        found = values.copy()
        found[:, 1:] -= self.memory[:, 1:, np.newaxis] * values[:, :-1]
        found /= np.sqrt(self.innovation)[:, :, np.newaxis]
        return found

    def _precision(self) -> tuple[FloatArray, FloatArray]:
        """Diagonal ``(B, S)`` and off-diagonal ``(B, S − 1)`` of the inverse of the covariance of the process."""
        coupling = self.memory[:, 1:] / self.innovation[:, 1:]
        diagonal = 1.0 / self.innovation
        diagonal[:, :-1] += self.memory[:, 1:] * coupling
        return diagonal, -coupling

    def _posterior_precisions(self) -> list[tuple[FloatArray, FloatArray]]:
        """The same of the process given values of the rows, for each of the batch."""
        diagonal, coupling = self._precision()
        share = (1.0 - self.fraction) / self.fraction
        diagonal = diagonal + share[:, np.newaxis] * np.bincount(self.noise.state)
        return list(zip(diagonal, coupling, strict=True))

    def _split(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values of sorted rows as independent part ``(B, N, K)`` and process ``(B, S, K)``, each at its posterior mean."""
        starts = np.flatnonzero(np.diff(self.noise.state, prepend=-1))
        root = np.sqrt(1.0 - self.fraction)[:, np.newaxis, np.newaxis]
        sums = np.add.reduceat(values, starts, axis=1) * (root / self.fraction[:, np.newaxis, np.newaxis])
        process = np.empty_like(sums)
        for i, (diagonal, coupling) in enumerate(self._posterior_precisions()):
            pivots, factors, _ = dpttrf(diagonal, coupling)
            process[i] = dpttrs(pivots, factors, sums[i])[0]
        return values - root * np.take(process, self.noise.state, axis=1), process


def _diagonal_of_inverse(diagonal: FloatArray, coupling: FloatArray) -> FloatArray:
    """Diagonal of the inverse of a tridiagonal matrix: pivots of the elimination from either end meet in each row."""
    forward, backward = dpttrf(diagonal, coupling)[0], dpttrf(diagonal[::-1], coupling[::-1])[0][::-1]
    return np.asarray(1.0 / (forward + backward - diagonal))
