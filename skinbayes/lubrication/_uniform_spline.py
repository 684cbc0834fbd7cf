"""Cubic splines on evenly spaced points, by their B-spline coefficients."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from skinbayes.arrays import FloatArray, IndexArray

_ENDS = np.array([1.0, -4.0, 6.0, -4.0, 1.0])  # no jump of the third derivative at the point before the end


def spline_coefficients(values: FloatArray) -> FloatArray:
    """Coefficients, shape ``(..., S + 2)``, of the spline through values at S ≥ 3 points along the last axis."""
    return np.ascontiguousarray(values @ _inverse(values.shape[-1]).T)


@lru_cache(maxsize=16)
def _inverse(count: int) -> FloatArray:
    matrix = np.zeros((count + 2, count + 2))
    places = np.arange(count)
    for shift, weight in enumerate((1 / 6, 4 / 6, 1 / 6)):
        matrix[places, places + shift] = weight
    matrix[count, :5], matrix[count + 1, -5:] = _ENDS, _ENDS
    return np.ascontiguousarray(np.linalg.inv(matrix)[:, :count])


def cell_of(position: FloatArray, count: int) -> tuple[IndexArray, FloatArray]:
    """Cell 0 … S − 2 and place 0 … 1 in it, of positions 0 … S − 1 counted in spacings."""
    cell = position.astype(np.intp)
    np.minimum(cell, count - 2, out=cell)
    return cell, position - cell


def cubic_weights(place: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Weights of the four coefficients from that of the cell on."""
    square = place * place
    last = square * place
    last *= 1 / 6
    # (1 + 3u + 3u² − 3u³)/6 and (1 − 3u + 3u² − u³)/6; all four add up to 1
    third = place + square
    third *= 0.5
    third += 1 / 6
    third -= 3 * last
    first = square - place
    first *= 0.5
    first += 1 / 6
    first -= last
    return first, 1 - first - third - last, third, last


def cubic_slopes(place: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Derivatives of the weights by the position."""
    last = place * place
    last *= 0.5
    third = place + 0.5
    third -= 3 * last
    first = place - 0.5
    first -= last
    return first, -(first + third + last), third, last


def gather(
    coefficients: FloatArray, start: IndexArray, offset: int, weights: tuple[FloatArray, ...]
) -> FloatArray:
    """Sum of four weighted coefficients of a flat array, from ``start + offset`` on."""
    total = weights[0] * coefficients[offset:].take(start)
    for shift in (1, 2, 3):
        total += weights[shift] * coefficients[offset + shift :].take(start)
    return total


def gather_both(
    coefficients: FloatArray,
    start: IndexArray,
    offset: int,
    weights: tuple[FloatArray, ...],
    slopes: tuple[FloatArray, ...],
) -> tuple[FloatArray, FloatArray]:
    """The sums of `gather` for two sets of weights."""
    found = coefficients[offset:].take(start)
    total, rate = weights[0] * found, slopes[0] * found
    for shift in (1, 2, 3):
        found = coefficients[offset + shift :].take(start)
        total += weights[shift] * found
        rate += slopes[shift] * found
    return total, rate
