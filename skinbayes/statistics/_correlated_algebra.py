"""Linear algebra behind correlated scatter: rows whitened by the noise, and the posterior of what they share."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan
from typing import Protocol

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.statistics._group_algebra import ConditionedEffects, condition_effects
from skinbayes.statistics._group_input import GroupData
from skinbayes.statistics.correlated_noise import CorrelatedNoise


class Shared(Protocol):
    """What of correlated scatter its algebra needs; see :class:`skinbayes.statistics.correlated_scatter.CorrelatedScatter`."""

    @property
    def noise(self) -> CorrelatedNoise | None: ...
    @property
    def _design(self) -> FloatArray: ...
    @property
    def _gram(self) -> FloatArray: ...
    def _memory(self, scales: FloatArray) -> tuple[FloatArray, FloatArray]: ...
    def prior_factor(self, scales: FloatArray) -> FloatArray: ...
    def _columns(self, last: FloatArray, width: FloatArray) -> FloatArray: ...
    def at_rows(self, effects: ArrayLike) -> FloatArray: ...


@dataclass(frozen=True, eq=False)
class White:
    """Residuals and design of a batch, whitened by the noise.

    Attributes
    ----------
    residual : shape ``(B, N')``; N' is N, or more with a latent process
    gram, projection : products of the whitened design with itself, ``(B, K, K)``, and with the residuals, ``(B, K)``
    log_determinant : of the covariance of the noise, shape ``(B,)``
    design : whitened, ``(B, K, N')``; None where each row is divided by its width
    """

    scatter: Shared
    data: GroupData
    residual: FloatArray
    gram: FloatArray
    projection: FloatArray
    log_determinant: FloatArray
    design: FloatArray | None = None

    @classmethod
    def of(cls, scatter: Shared, data: GroupData) -> White:
        log_determinant, residual = 2.0 * np.log(data.width).sum(axis=-1), data.residual / data.width
        if scatter.noise is None:
            projection = times(scatter._design.T, data.weight * data.residual)
            return cls(scatter, data, residual, _weighted_gram(scatter, data), projection, log_determinant)
        memory = scatter.noise.at(*scatter._memory(data.scale))
        white = memory.whiten(scatter._columns(residual, data.width))
        design, residual = white[:, :-1], white[:, -1]
        gram, projection = np.matmul(design, np.swapaxes(design, 1, 2)), times(design, residual)
        log_determinant += memory.log_determinant()
        return cls(scatter, data, residual, gram, projection, log_determinant, design)

    def turned(self, factor: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Gram matrix and projection for z instead of the effects F z."""
        turned = np.swapaxes(factor, 1, 2)
        return np.matmul(turned, np.matmul(self.gram, factor)), times(turned, self.projection)

    def less(self, effects: FloatArray) -> FloatArray:
        """Whitened residuals less effects ``(B, K)``."""
        if self.design is not None:
            return self.residual - np.matmul(effects[:, np.newaxis], self.design)[:, 0]
        return self.residual - self.scatter.at_rows(effects) / self.data.width


@dataclass(frozen=True, eq=False)
class Solved:
    """Posterior of the effects of a batch, and what is left of the data.

    Attributes
    ----------
    factor : F, shape ``(B, K, K)``
    effects : posterior of z; NaN in its centre where rounding left no positive definite matrix
    left : whitened residuals less effects, shape ``(B, N')``
    """

    scatter: Shared
    data: GroupData
    factor: FloatArray
    effects: ConditionedEffects
    left: FloatArray

    @classmethod
    def of(cls, scatter: Shared, data: GroupData) -> Solved:
        factor, white = scatter.prior_factor(data.scale), White.of(scatter, data)
        inner, target = white.turned(factor)
        count, size = target.shape
        effects = condition_effects(
            np.zeros((count, 0)),
            np.zeros((count, 0, size)),
            inner,
            target,
            np.ones((count, size)),
            slice(0, 0),
        )
        effects.centre[~effects.sound] = nan
        return cls(scatter, data, factor, effects, white.less(times(factor, effects.mean)))

    @property
    def mean(self) -> FloatArray:
        """Posterior mean of the effects, shape ``(B, K)``."""
        return times(self.factor, self.effects.mean)

    def force_and_precision(self) -> tuple[FloatArray, FloatArray]:
        """Σ⁻¹ r and the diagonal of Σ⁻¹, shape ``(B, N)``."""
        design, width = self.scatter._design, self.data.width
        rest = (self.data.residual - times(design, self.mean)) / width
        columns = self.scatter._columns(rest, width)
        own: FloatArray | float = 1.0
        if self.scatter.noise is not None:
            memory = self.scatter.noise.at(*self.scatter._memory(self.data.scale))
            columns, own = memory.solve(columns), memory.diagonal()
        root = np.matmul(self.effects.root(), np.swapaxes(self.factor, 1, 2))
        reach = np.matmul(np.ascontiguousarray(root), columns[:, :-1])
        return columns[:, -1] / width, (own - (reach**2).sum(axis=1)) / width**2


def _weighted_gram(scatter: Shared, data: GroupData) -> FloatArray:
    """Xᵀ W⁻¹ X, shape ``(B, K, K)``; known beforehand for vectors whose rows are all as wide."""
    weight, design = data.weight, scatter._design
    alike = (weight == weight[:, :1]).all(axis=-1)
    found = np.empty((len(weight), design.shape[1], design.shape[1]))
    found[alike] = weight[alike, :1, np.newaxis] * scatter._gram
    for i in np.flatnonzero(~alike):
        found[i] = design.T @ (weight[i][:, np.newaxis] * design)
    return found


def times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    """Each matrix of a stack, or one matrix, times each vector."""
    return np.matmul(matrices, np.ascontiguousarray(vectors)[:, :, np.newaxis])[:, :, 0]
