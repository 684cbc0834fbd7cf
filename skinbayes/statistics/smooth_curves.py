"""Smooth unknown curves along a column: Gaussian processes, written as a few normal effects.

A curve g over x in 0 … 1 has mean zero and covariance size² exp(−(x − x')²/(2 length²)). Curves of that kind are smooth: they are
known between the Chebyshev points of an interval from their values there, by the polynomial through them. With P of shape
``(N, M)``, which interpolates from M nodes to N rows, the covariance of the rows is

    K(x, x') ≈ P K(nodes, nodes) Pᵀ,

a matrix of rank M whose factor needs no rows. With M = `nodes_for` (length) nodes its entries are wrong by less than
`WORST_ERROR` size² (tested against the dense matrix), and by orders of magnitude less at lengths twice as long. It serves all
lengths, and, unlike basis functions on a wider domain, has no boundary to choose.

References
----------
Rasmussen & Williams, Gaussian Processes for Machine Learning, MIT Press (2006), chapters 2 and 8;
Berrut & Trefethen, SIAM Review 46 (2004) 501, doi 10.1137/S0036144502417715 (barycentric interpolation);
Riutort-Mayol et al., Statistics and Computing 33 (2023) 17, doi 10.1007/s11222-022-10167-2 (basis functions, for comparison).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray

WORST_ERROR = 5e-4
"""Largest error of an entry of the covariance at the least length, in units of size²."""

_JITTER = 1e-12
"""Variance that is added at the nodes, in units of size²: rounding leaves no positive definite matrix without it."""


def nodes_for(length: float) -> int:
    """Number of nodes that hold curves of this length, and of all longer ones."""
    return ceil(5.0 + 1.7 / length)


@dataclass(frozen=True, eq=False)
class SmoothCurves:
    """One curve for each level of a label, or one for all rows; size and length are the same for all levels.

    Attributes
    ----------
    x : coordinate of each row, 0 … 1, shape ``(N,)``
    level : number of the level of each row, shape ``(N,)``
    n_levels : number of curves
    n_nodes : nodes of each
    """

    x: FloatArray
    level: NDArray[np.intp]
    n_levels: int
    n_nodes: int

    @property
    def n_effects(self) -> int:
        """Values that stand for all curves, those of the first level first."""
        return self.n_levels * self.n_nodes

    @property
    def nodes(self) -> FloatArray:
        """Chebyshev points of the interval 0 … 1, shape ``(M,)``."""
        return np.asarray(0.5 - 0.5 * np.cos(_angles(self.n_nodes)))

    def design(self) -> FloatArray:
        """Matrix from the values at the nodes to the rows, shape ``(N, n_effects)``."""
        found = np.zeros((len(self.x), self.n_levels, self.n_nodes))
        found[np.arange(len(self.x)), self.level] = self.interpolation(self.x)
        return found.reshape(len(self.x), -1)

    def interpolation(self, x: FloatArray) -> FloatArray:
        """Matrix from the values at the nodes of a curve to those at ``x`` of shape ``(n,)``, shape ``(n, M)``."""
        distance = x[:, np.newaxis] - self.nodes
        hit = distance == 0.0
        weight = (-1.0) ** np.arange(self.n_nodes) * np.sin(_angles(self.n_nodes))
        found = weight / np.where(hit, 1.0, distance)
        found[hit.any(axis=1)] = 0.0
        found[hit] = 1.0
        return np.asarray(found / found.sum(axis=1, keepdims=True))

    def factor(self, size: FloatArray, length: FloatArray) -> FloatArray:
        """Lower factors of the covariance of the values at the nodes of one curve.

        Parameters
        ----------
        size : standard deviation of a curve, shape ``(B,)``, unit of the data
        length : its length, shape ``(B,)``, > 0, in units of the coordinate

        Returns
        -------
        shape ``(B, M, M)``, unit of the data
        """
        nodes = self.nodes
        square = (nodes[:, np.newaxis] - nodes) ** 2
        covariance = np.exp(-0.5 * square / (length * length)[:, np.newaxis, np.newaxis])
        covariance += _JITTER * np.eye(self.n_nodes)
        return np.asarray(size[:, np.newaxis, np.newaxis] * np.linalg.cholesky(covariance))


def _angles(count: int) -> FloatArray:
    return np.asarray((2.0 * np.arange(count) + 1.0) * np.pi / (2.0 * count))
