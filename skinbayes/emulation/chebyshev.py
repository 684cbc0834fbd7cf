"""Chebyshev series in one variable or in many; rows of a batch are summed alike, whatever the batch."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebval, chebvander

from skinbayes.arrays import FloatArray

_NARROW = 1e-9  # half a range of rows that are all alike


def lobatto(count: int) -> FloatArray:
    """Nodes on [0, 1], ascending, ends included, shape ``(count,)``."""
    return np.asarray(np.square(np.sin(np.pi / 2 * np.arange(count) / (count - 1))))


def zeros(count: int) -> FloatArray:
    """Zeros of the polynomial of degree ``count``, −1 … 1, descending, shape ``(count,)``."""
    return np.asarray(np.cos(np.pi * (np.arange(count) + 0.5) / count))


def polynomials(t: FloatArray, count: int) -> FloatArray:
    """T_0 … T_(count−1) at t, from −1 to 1, on a new last axis."""
    return np.asarray(chebvander(t, count - 1))


@lru_cache(maxsize=32)
def slopes(count: int) -> FloatArray:
    """Matrix from T_0 … T_(count−2) to the derivatives of T_0 … T_(count−1), shape ``(count − 1, count)``."""
    return np.asarray(chebder(np.eye(count)))


@lru_cache(maxsize=64)
def _to_coefficients(count: int, ends: bool = True) -> FloatArray:
    """Matrix from values at the nodes to coefficients."""
    order = np.arange(count)
    if ends:
        return np.asarray(np.linalg.inv(np.cos(np.outer(np.pi - np.pi * order / (count - 1), order))))
    return (
        np.asarray(np.cos(order[:, None] * np.pi * (order + 0.5) / count) * np.where(order, 2, 1)[:, None])
        / count
    )


def coefficients(values: FloatArray) -> FloatArray:
    """Coefficients for ``values`` at the nodes `lobatto` along the axis before the last, shape ``(B, K, n)``."""
    return np.asarray(_to_coefficients(values.shape[1]) @ values)


def grid_coefficients(values: FloatArray, ends: bool = True) -> FloatArray:
    """Coefficients along all axes but the last, from values at the nodes `lobatto`, or `zeros` without ``ends``."""
    for axis in range(values.ndim - 1):
        moved = np.moveaxis(values, axis, 0)
        found = _to_coefficients(len(moved), ends) @ moved.reshape(len(moved), -1)
        values = np.moveaxis(found.reshape(moved.shape), 0, axis)
    return np.ascontiguousarray(values)


@lru_cache(maxsize=32)
def _to_values(count: int) -> FloatArray:
    """Matrix from coefficients to values at the nodes, transposed."""
    return np.ascontiguousarray(np.linalg.inv(_to_coefficients(count)).T)


def values_at_nodes(parts: FloatArray) -> FloatArray:
    """Values at the nodes `lobatto` of the series with coefficients ``parts``, both of shape ``(B, K)``."""
    return np.asarray((parts[:, None, :] @ _to_values(parts.shape[1]))[:, 0, :])


def values_between(count: int, t: FloatArray) -> FloatArray:
    """Matrix from values at the nodes `lobatto` to those at t, from −1 to 1 and of shape ``(P,)``, shape ``(P, count)``."""
    return np.asarray(polynomials(t, count) @ _to_coefficients(count))


def series(parts: FloatArray, t: FloatArray) -> FloatArray:
    """Values at t, shape ``(B, F)``, of n series with coefficients ``parts``, shape ``(B, K, n)``; shape ``(B, F, n)``."""
    return np.asarray(chebval(t[..., None], np.moveaxis(parts, 1, 0)[:, :, None], tensor=False))


def clenshaw(parts: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and derivatives at t, shape ``(B, F)``, of the series with coefficients ``parts``, shape ``(B, K)``.

    Both in one pass: those of NumPy take a tenth longer, and as long again for the coefficients of the derivative.
    """
    double = 2 * t
    one, two, slope_one, slope_two = np.zeros((4, *t.shape))
    for j in range(parts.shape[1] - 1, 0, -1):
        slope_one, slope_two = 2 * one + double * slope_one - slope_two, slope_one
        one, two = parts[:, j, None] + double * one - two, one
    return parts[:, 0, None] + t * one - two, one + t * slope_one - slope_two


def summed(parts: FloatArray, places: Sequence[FloatArray], vectors: int) -> FloatArray:
    """Values of series in A variables for B vectors of N rows.

    Parameters
    ----------
    parts : coefficients, shape ``(n1, …, nA, columns)``
    places : A arrays of the variables, −1 … 1, shape ``(B, 1)`` for one that all rows of a vector share, else ``(B, N)``
    vectors : B

    Returns
    -------
    values : shape ``(B, N, columns)``, or ``(B, 1, columns)`` if rows share all variables

    Notes
    -----
    Variables that rows share come first. Every vector has matrix products of its own, of the same shapes whatever the batch.
    """
    *counts, columns = parts.shape
    common = [axis for axis, place in enumerate(places) if place.shape[1] == 1]
    rows = [axis for axis, place in enumerate(places) if place.shape[1] != 1]
    if common + rows != sorted(common + rows):
        parts = np.ascontiguousarray(np.transpose(parts, (*common, *rows, len(counts))))
    for axes in (common, rows):
        if axes or axes is common:
            weights = np.ones((vectors, places[axes[0]].shape[1] if axes else 1, 1))
            for axis in axes:
                outer = weights[..., None] * polynomials(places[axis], counts[axis])[..., None, :]
                weights = outer.reshape(
                    *weights.shape[:2], weights.shape[-1] * counts[axis]
                )  # of an empty batch, too
            size = weights.shape[-1]
            block = parts.reshape(size, -1) if axes is common else parts.reshape(vectors, size, columns)
            # contiguous also in a batch of one, whose strides say so anyway: the same product for both
            parts = np.matmul(np.ascontiguousarray(weights), block)
    return np.asarray(parts)


def summed_locally(
    parts: FloatArray, places: Sequence[FloatArray], vectors: int, axis: int, count: int
) -> FloatArray:
    """`summed`, where the rows of a vector lie close to each other along one axis.

    Between the outermost rows of each vector the series along ``axis`` is replaced by one of ``count`` terms through as many
    nodes: rows then have fewer terms. The other arguments and the values are those of `summed`; rows must vary along ``axis``.
    """
    *counts, columns = parts.shape
    place = places[axis]
    low, high = place.min(axis=1, keepdims=True), place.max(axis=1, keepdims=True)
    half = np.maximum((high - low) / 2, _NARROW)
    middle = (low + high) / 2
    common = [a for a, other in enumerate(places) if other.shape[1] == 1]
    rows = [a for a, other in enumerate(places) if other.shape[1] != 1 and a != axis]
    weights = _to_coefficients(count, False) @ polynomials(middle + half * zeros(count), counts[axis])
    for other in common:
        weights = (weights[..., None] * polynomials(places[other], counts[other])[:, :, None, :]).reshape(
            vectors, count, -1
        )
    block = np.ascontiguousarray(np.transpose(parts, (axis, *common, *rows, len(counts))))
    block = np.matmul(np.ascontiguousarray(weights), block.reshape(weights.shape[-1], -1))
    weights = polynomials((place - middle) / half, count)
    for other in rows:
        weights = (weights[..., None] * polynomials(places[other], counts[other])[..., None, :]).reshape(
            vectors, place.shape[1], -1
        )
    return np.asarray(
        np.matmul(np.ascontiguousarray(weights), block.reshape(vectors, weights.shape[-1], columns))
    )
