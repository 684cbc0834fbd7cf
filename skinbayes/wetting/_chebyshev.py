"""Chebyshev interpolation between Lobatto nodes, for each row of a batch; rows are summed alike whatever the batch."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from skinbayes.arrays import FloatArray


def lobatto(count: int) -> FloatArray:
    """Nodes on [0, 1], ascending, ends included, shape ``(count,)``."""
    return np.asarray(np.square(np.sin(np.pi / 2 * np.arange(count) / (count - 1))))


@lru_cache(maxsize=32)
def _to_coefficients(count: int) -> FloatArray:
    """Matrix from values at the nodes to coefficients."""
    cosines = np.cos(np.outer(np.pi - np.pi * np.arange(count) / (count - 1), np.arange(count)))
    return np.asarray(np.linalg.inv(cosines))


def coefficients(values: FloatArray) -> FloatArray:
    """Coefficients for ``values`` at the nodes along the axis before the last, shape ``(B, K, n)``."""
    return np.asarray(_to_coefficients(values.shape[1]) @ values)


@lru_cache(maxsize=32)
def _to_values(count: int) -> FloatArray:
    """Matrix from coefficients to values at the nodes, transposed."""
    return np.ascontiguousarray(np.linalg.inv(_to_coefficients(count)).T)


def values_at_nodes(parts: FloatArray) -> FloatArray:
    """Values at the nodes of the series with coefficients ``parts``, both of shape ``(B, K)``."""
    return np.asarray((parts[:, None, :] @ _to_values(parts.shape[1]))[:, 0, :])


def values_between(count: int, t: FloatArray) -> FloatArray:
    """Matrix from values at the nodes to those at t, from −1 to 1 and of shape ``(P,)``, shape ``(P, count)``."""
    return np.asarray(polynomials(t, count)[0] @ _to_coefficients(count))


def polynomials(t: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """T_0 … T_(count−1) at t, from −1 to 1, on a new last axis, and their derivatives."""
    values, slopes = np.empty((2, count, *t.shape))
    values[0], values[1], slopes[0], slopes[1] = 1.0, t, 0.0, 1.0
    double = 2 * t
    for j in range(2, count):
        values[j] = double * values[j - 1] - values[j - 2]
        slopes[j] = 2 * values[j - 1] + double * slopes[j - 1] - slopes[j - 2]
    return np.moveaxis(values, 0, -1), np.moveaxis(slopes, 0, -1)


def clenshaw(parts: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and derivatives at t, shape ``(B, F)``, of the series with coefficients ``parts``, shape ``(B, K)``."""
    double = 2 * t
    one, two, slope_one, slope_two = np.zeros((4, *t.shape))
    for j in range(parts.shape[1] - 1, 0, -1):
        slope_one, slope_two = 2 * one + double * slope_one - slope_two, slope_one
        one, two = parts[:, j, None] + double * one - two, one
    return parts[:, 0, None] + t * one - two, one + t * slope_one - slope_two


def series(parts: FloatArray, t: FloatArray) -> FloatArray:
    """Values at t, shape ``(B, F)``, of n series with coefficients ``parts``, shape ``(B, K, n)``; shape ``(B, F, n)``."""
    double = 2 * t[..., None]
    one, two = np.zeros((2, *t.shape, parts.shape[-1]))
    for j in range(parts.shape[1] - 1, 0, -1):
        one, two = parts[:, j, None] + double * one - two, one
    return np.asarray(parts[:, 0, None] + t[..., None] * one - two)
