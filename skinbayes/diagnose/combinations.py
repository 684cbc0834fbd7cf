"""Combinations of parameters that predictions determine, or leave free, as products of powers.

Locally, predictions determine the directions of parameter space in the row space of the sensitivity matrix and leave
the null space free. Either is a linear space; what a reader can use is its simplest members: vectors that vanish for
as many parameters as possible (the elementary vectors of the space), picked one by one until they span it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, islice
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray

WEAK = 0.05
"""A parameter whose effect is below this fraction of the largest effect is left out of a combination."""

NICE = {1: 0.05, 2: 0.02, 3: 0.02}
"""An exponent is written as a fraction with this denominator if it stays this close to it at 90 % of the points."""

PARALLEL = 0.999
"""Cosine above which a block of parameters acts like a derived quantity."""

MAXIMUM_CANDIDATES = 3000
"""Bound on the sets of parameters tried in the search for simple vectors."""

MAXIMUM_DECOMPOSITIONS = 20000
"""Bound on the small matrices decomposed in that search."""

BoolArray: TypeAlias = NDArray[np.bool_]


@dataclass(frozen=True)
class Decomposition:
    """Singular values and right singular vectors of the scaled sensitivities.

    Attributes
    ----------
    values : shape ``(B, D)``, descending, padded with zeros
    vectors : shape ``(B, D, D)``, one row for each value
    """

    values: FloatArray
    vectors: FloatArray


def decompose(scaled: FloatArray) -> Decomposition:
    """Singular value decomposition of a batch of sensitivity matrices, shape ``(B, rows, D)``."""
    dimension = scaled.shape[-1]
    if scaled.shape[1] > dimension:  # the triangular factor has the same singular values and vectors
        scaled = np.asarray(np.linalg.qr(scaled, mode="r"))
    _, values, vectors = np.linalg.svd(scaled, full_matrices=True)
    padded = np.zeros((len(scaled), dimension))
    padded[:, : values.shape[1]] = values
    return Decomposition(padded, vectors)


def typical(vectors: FloatArray) -> FloatArray:
    """Relative effect of each parameter in ``vectors`` (shape ``(B, D)``), the 90th percentile over the points."""
    largest = np.maximum(np.abs(vectors).max(axis=1, keepdims=True), 1e-300)
    return np.asarray(np.quantile(np.abs(vectors) / largest, 0.9, axis=0))


def simplest_basis(basis: FloatArray) -> list[FloatArray]:
    """Vectors with few entries that span a space.

    Parameters
    ----------
    basis : orthonormal rows, shape ``(B, r, D)``: a space of dimension r at each of B points

    Returns
    -------
    r arrays of shape ``(B, D)``, each with largest entry ±1 and signs aligned over the points; fewer if the space
    is too twisted to be spanned in the same manner at all points

    Examples
    --------
    >>> space = np.linalg.qr(np.array([[1.0, -1, 0, 0], [1, 0, -1, -1]]).T)[0].T
    >>> for vector in simplest_basis(space[None]):
    ...     print(vector[0].round(6) + 0.0)
    [ 1. -1.  0.  0.]
    [ 1.  0. -1. -1.]
    """
    _, rank, dimension = basis.shape
    if not rank:
        return []
    active = [d for d in range(dimension) if np.quantile(np.linalg.norm(basis[:, :, d], axis=1), 0.9) > 0.01]
    trials = list(islice(combinations(active, rank - 1), MAXIMUM_CANDIDATES))
    few = basis[
        :: 1 + len(basis) * len(trials) // MAXIMUM_DECOMPOSITIONS
    ]  # a long search looks at fewer points
    candidates = []
    for zeros in trials:
        vector = _vanishing(few, list(zeros))
        if vector is not None:
            support = tuple(np.flatnonzero(typical(vector) >= WEAK))
            candidates.append((len(support), support, zeros))
    candidates.sort()
    chosen: list[FloatArray] = []
    tried = set()
    for _, support, zeros in candidates:
        if len(chosen) == rank:
            break
        vector = None if support in tried else _vanishing(basis, list(zeros))
        tried.add(support)
        if vector is None:
            continue
        rows = np.stack([*chosen, vector], axis=1)
        rows = rows / np.linalg.norm(rows, axis=2, keepdims=True)
        if np.median(np.linalg.svd(rows, compute_uv=False)[:, -1]) > 0.02:
            chosen.append(vector)
    return chosen


def _vanishing(basis: FloatArray, zeros: list[int]) -> FloatArray | None:
    """The member of the space that is zero for the parameters ``zeros``; None if there are several."""
    if zeros:
        _, values, mixing = np.linalg.svd(np.swapaxes(basis[:, :, zeros], 1, 2), full_matrices=True)
        if np.median(values[:, -1]) < 1e-3:
            return None
        vector = np.einsum("br,brd->bd", mixing[:, -1, :], basis)
        vector[:, zeros] = 0.0
    else:
        vector = basis[:, 0, :].copy()
    vector /= np.abs(vector).max(axis=1, keepdims=True)
    # the sign follows a parameter that never nearly vanishes; the first one of several alike
    anchor = int(
        np.argmax(np.round(np.abs(vector).min(axis=0) + 1e-3 * np.median(np.abs(vector), axis=0), 6))
    )
    sign = np.where(vector[:, anchor] < 0.0, -1.0, 1.0)
    return vector * sign[:, None]


def nice(values: FloatArray) -> float | None:
    """The simple fraction (denominator 1, 2 or 3) that ``values`` keep close to, or None.

    Examples
    --------
    >>> nice(np.array([-0.99, -1.0, -1.01])), nice(np.array([0.4, 0.6]))
    (-1.0, None)
    """
    for denominator, tolerance in NICE.items():
        fraction = float(np.round(np.median(values) * denominator) / denominator)
        if fraction and np.quantile(np.abs(values - fraction), 0.9) <= tolerance * min(1.0, abs(fraction)):
            return fraction
    return None


def normalised(exponents: FloatArray, significant: BoolArray, powers: BoolArray) -> FloatArray:
    """Scale exponents ``(B, D)`` so that they read well: one of them ±1 and most of the others simple fractions.

    ``significant`` (shape ``(D,)``) tells which exponents will be written and ``powers`` which of them are powers, not
    slopes. If every exponent nearly vanishes somewhere, the input is returned with its largest entry scaled to one.
    """
    shown = np.flatnonzero(significant & powers if (significant & powers).any() else significant)
    best, best_cost = (
        exponents / np.maximum(np.abs(exponents[:, shown]).max(axis=1, keepdims=True), 1e-300),
        np.inf,
    )
    for pivot in shown:
        size = np.abs(exponents[:, pivot])
        fraction = size / np.maximum(np.abs(exponents[:, shown]).max(axis=1), 1e-300)
        if np.quantile(fraction, 0.05) < 0.02 or fraction.min() < 1e-3:
            continue
        candidate = exponents / exponents[:, pivot : pivot + 1]
        cost = 0.0
        for column in shown:
            fraction = nice(candidate[:, column])
            if fraction is None:
                cost += 10.0
            else:
                simple = fraction == round(fraction)
                cost += 0.01 * abs(fraction) + (0.0 if simple else 1.0)
        if cost < best_cost:
            best, best_cost = candidate, cost
    first = shown[0]
    return best * (-1.0 if np.median(best[:, first]) < 0.0 else 1.0)


def with_derived(
    vector: FloatArray, gradients: dict[str, FloatArray]
) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Replace blocks of a combination by derived quantities that act alike.

    Parameters
    ----------
    vector : the combination, shape ``(B, D)``, in prior standard deviations
    gradients : slopes of ln of derived quantities, shape ``(B, D)``, in prior standard deviations

    Returns
    -------
    what is left of the combination, shape ``(B, D)``, and the power of each derived quantity used, shape ``(B,)``
    """
    rest, powers, taken = vector.copy(), {}, np.zeros(vector.shape[1], dtype=bool)
    options = []
    for name, gradient in gradients.items():
        block = typical(gradient) >= WEAK
        if block.sum() < 2 or not (typical(vector)[block] >= WEAK).any():
            continue
        inner = (vector[:, block] * gradient[:, block]).sum(axis=1)
        size = np.linalg.norm(vector[:, block], axis=1) * np.linalg.norm(gradient[:, block], axis=1)
        cosine = np.abs(inner) / np.maximum(size, 1e-300)
        if np.median(cosine) > PARALLEL and np.quantile(cosine, 0.1) > 1.0 - 10.0 * (1.0 - PARALLEL):
            power = inner / (gradient[:, block] ** 2).sum(axis=1)
            options.append((int(block.sum()), name, block, power, gradient))
    # small blocks first: quantities next to the parameters say more than those next to the predictions
    for _, name, block, power, gradient in sorted(options, key=lambda option: option[0]):
        if not (block & taken).any():
            rest -= power[:, None] * gradient
            rest[:, block] = 0.0
            powers[name] = power
            taken |= block
    return rest, powers
