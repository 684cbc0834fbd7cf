"""Linear algebra behind crossed group effects: weighted sums over cells, and the posterior of the effects.

The effects are written b = S^½ z with z ~ N(0, I), so that a scale of zero needs no special case. Given the data, z is normal
with precision Q = I + S^½ Zᵀ W⁻¹ Z S^½. The block of Q that belongs to one column is diagonal, because a row has one level of
each column: that column is eliminated by division, and only the Schur complement of the others is factored. Every step treats
the items of a batch apart (stacked matrices, sums along the last axis), so that a batch and its rows agree to the last bit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class CellSums:
    """Sums of row values over cells, prepared once for a design.

    Attributes
    ----------
    rows : rows in order of their cells, shape ``(M,)``
    starts : where each occupied cell starts in ``rows``, shape ``(K,)``
    place : place of each wanted cell among the occupied ones, K for an empty one; any shape
    """

    rows: NDArray[np.intp]
    starts: NDArray[np.intp]
    place: NDArray[np.intp]

    @classmethod
    def of(cls, cell_of_row: NDArray[np.intp], wanted: NDArray[np.intp]) -> CellSums:
        """Prepare sums for rows that count in P cells each, ``cell_of_row`` of shape ``(P, N)``, over the cells ``wanted``."""
        order = np.argsort(cell_of_row, axis=None, kind="stable")
        cells = cell_of_row.ravel()[order]
        starts = np.flatnonzero(np.concatenate([[True], cells[1:] != cells[:-1]]))
        occupied = cells[starts]
        place = np.searchsorted(occupied, wanted)
        empty = occupied[np.minimum(place, len(occupied) - 1)] != wanted
        return cls(order % cell_of_row.shape[1], starts, np.where(empty, len(occupied), place))

    def __call__(self, values: FloatArray) -> FloatArray:
        """Sums of ``values`` of shape ``(B, N)`` over the wanted cells, shape ``(B, *place.shape)``; zero for empty ones."""
        count = len(self.starts)
        sums = np.zeros((len(values), count + 1))
        np.add.reduceat(np.take(values, self.rows, axis=-1), self.starts, axis=-1, out=sums[:, :count])
        return np.take(sums, self.place, axis=-1)


@dataclass(frozen=True, eq=False)
class ConditionedEffects:
    """Normal distribution of scaled effects z, given data, for a batch.

    Attributes
    ----------
    scale : standard deviation of each effect before the data, shape ``(B, G)``, unit of the data
    eliminated, kept : places of the eliminated column and of the others among the G effects
    pivots : diagonal block of Q of the eliminated column, shape ``(B, E)``, dimensionless
    coupling : block of Q between it and the others, shape ``(B, E, R)``, dimensionless
    factor_inverse : inverse of the lower Cholesky factor of the Schur complement, shape ``(B, R, R)``, dimensionless
    centre : mean of z, shape ``(B, G)``, dimensionless
    log_determinant : ln det Q, shape ``(B,)``
    sound : False where the numbers overflowed or rounding left no positive definite matrix, shape ``(B,)``
    """

    scale: FloatArray
    eliminated: slice
    kept: NDArray[np.intp]
    pivots: FloatArray
    coupling: FloatArray
    factor_inverse: FloatArray
    centre: FloatArray
    log_determinant: FloatArray
    sound: NDArray[np.bool_]

    @property
    def mean(self) -> FloatArray:
        """Mean of the effects b, shape ``(B, G)``."""
        return self.scale * self.centre

    def root(self) -> FloatArray:
        """The part F of shape ``(B, R, G)`` in cov(b) = FᵀF + diag(s²/pivots, eliminated column only)."""
        reached = np.matmul(self.factor_inverse, np.swapaxes(self.coupling, 1, 2))
        full = np.empty((*self.factor_inverse.shape[:2], self.scale.shape[1]))
        full[:, :, self.eliminated] = -reached / self.pivots[:, None, :]
        full[:, :, self.kept] = self.factor_inverse
        return full * self.scale[:, None, :]

    def own_variance(self) -> FloatArray:
        """The diagonal part of the covariance, s²/pivots of the eliminated column and zero elsewhere, shape ``(B, G)``."""
        full = np.zeros_like(self.scale)
        full[:, self.eliminated] = self.scale[:, self.eliminated] ** 2 / self.pivots
        return full

    def covariance(self) -> FloatArray:
        """Covariance of the effects b, shape ``(B, G, G)``."""
        root = self.root()
        found = np.matmul(np.swapaxes(root, 1, 2), root)
        diagonal = np.arange(self.scale.shape[1])
        found[:, diagonal, diagonal] += self.own_variance()
        return found

    def draw(self, standard: FloatArray) -> FloatArray:
        """Effects b made of independent standard normal numbers, both of shape ``(B, G)``."""
        deviation = np.empty_like(self.scale)
        kept = _times(np.swapaxes(self.factor_inverse, 1, 2), standard[:, self.kept])
        shift = _times(self.coupling, kept) / self.pivots
        deviation[:, self.kept] = kept
        deviation[:, self.eliminated] = standard[:, self.eliminated] / np.sqrt(self.pivots) - shift
        return self.scale * (self.centre + deviation)


def condition_effects(
    own: FloatArray,
    between: FloatArray,
    among: FloatArray,
    projection: FloatArray,
    scale: FloatArray,
    eliminated: slice,
) -> ConditionedEffects:
    """Distribution of the effects given data.

    Parameters
    ----------
    own, between, among : blocks of Zᵀ W⁻¹ Z, 1/unit²: the diagonal of the eliminated column, shape ``(B, E)``, its block with
        the others, ``(B, E, R)``, and that of the others, ``(B, R, R)``
    projection : Zᵀ W⁻¹ r, shape ``(B, G)``, 1/unit
    scale : standard deviation of each effect, shape ``(B, G)``, unit
    eliminated : place of the column that is eliminated by division
    """
    size = scale.shape[1]
    kept = np.delete(np.arange(size), eliminated)
    outer, inner = scale[:, eliminated], np.take(scale, kept, axis=1)
    pivots = 1.0 + outer**2 * own
    coupling = np.ascontiguousarray(outer[:, :, None] * between * inner[:, None, :])
    complement = inner[:, :, None] * among * inner[:, None, :]
    diagonal = np.arange(len(kept))
    complement[:, diagonal, diagonal] += 1.0
    halved = coupling / np.sqrt(pivots)[:, :, None]
    complement -= np.matmul(np.swapaxes(halved, 1, 2), halved)
    factor, sound = lower_factors(complement)
    inverse = np.asarray(np.linalg.inv(factor), dtype=float)

    target = scale * projection
    fraction = target[:, eliminated] / pivots
    centre = np.empty_like(scale)
    rest = np.take(target, kept, axis=1) - _times(np.swapaxes(coupling, 1, 2), fraction)
    centre[:, kept] = solved = _times(np.swapaxes(inverse, 1, 2), _times(inverse, rest))
    centre[:, eliminated] = fraction - _times(coupling, solved) / pivots
    log_determinant = np.log(pivots).sum(axis=-1)
    log_determinant += 2.0 * np.log(np.ascontiguousarray(np.diagonal(factor, axis1=1, axis2=2))).sum(axis=-1)
    sound &= np.isfinite(centre).all(axis=-1)
    return ConditionedEffects(
        scale, eliminated, kept, pivots, coupling, inverse, centre, log_determinant, sound
    )


def _times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    """Each matrix of a stack times its vector; contiguous, because matmul sums strided vectors in another order."""
    return np.matmul(matrices, np.ascontiguousarray(vectors)[:, :, None])[:, :, 0]


def lower_factors(matrices: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Lower factors of a stack of I + (positive semidefinite), and which of them are right; the unit matrix for the others."""
    unit = np.eye(matrices.shape[-1])
    sound: NDArray[np.bool_] = np.all(np.isfinite(matrices), axis=(-2, -1))
    if not sound.all():
        matrices = np.where(sound[:, None, None], matrices, unit)
    try:
        factors = np.asarray(np.linalg.cholesky(matrices), dtype=float)
    except np.linalg.LinAlgError:  # one bad item spoils the whole call
        factors = np.empty_like(matrices)
        for i, matrix in enumerate(matrices):
            try:
                factors[i] = np.linalg.cholesky(matrix)
            except np.linalg.LinAlgError:
                factors[i] = 0.0
    # without rounding no pivot is below one
    sound &= (np.diagonal(factors, axis1=1, axis2=2) ** 2 > 0.5).all(axis=-1)
    if not sound.all():
        factors = np.where(sound[:, None, None], factors, unit)
    return factors, sound
