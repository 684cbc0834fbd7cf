"""Batches of parameter vectors worked through in pieces, so that memory does not grow with their number."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray

Scalar = TypeVar("Scalar", bound=np.generic)

PIECE = 2**14
"""Predictions made at a time (vectors times rows): a temporary array of them, 128 kB, stays in the cache."""


def in_pieces(
    function: Callable[[FloatArray], FloatArray], theta: FloatArray, size: int, piece: int = PIECE
) -> FloatArray:
    """A function of a batch, some vectors at a time; the same to the last bit, as it treats vectors apart.

    Parameters
    ----------
    function : ``(B, D)`` to ``(B, ·)``
    theta : the batch, shape ``(B, D)``
    size : numbers that one vector needs, usually its rows
    piece : numbers that may be worked on at a time; one vector at least is

    Returns
    -------
    ndarray
        Shape ``(B, ·)``.

    Examples
    --------
    >>> in_pieces(lambda part: part.sum(axis=-1), np.arange(6.0).reshape(3, 2), size=2, piece=2)
    array([1., 5., 9.])
    """
    step = max(1, piece // max(size, 1))
    if len(theta) <= step:
        return function(theta)
    found = np.empty(0)
    for start in range(0, len(theta), step):
        part = function(theta[start : start + step])
        if not start:
            found = np.empty((len(theta), *part.shape[1:]), dtype=part.dtype)
        found[start : start + step] = part
    return found


def named_in_pieces(
    function: Callable[[FloatArray], Mapping[str, NDArray[Scalar]]],
    theta: FloatArray,
    size: int,
    piece: int = PIECE,
) -> dict[str, NDArray[Scalar]]:
    """The same for a function that gives several named quantities, each ``(B, ·)``, or ``(1, ·)`` where vectors agree."""
    step = max(1, piece // max(size, 1))
    if len(theta) <= step:
        return dict(function(theta))
    found: dict[str, NDArray[Scalar]] = {}
    for start in range(0, len(theta), step):
        for name, part in function(theta[start : start + step]).items():
            if not start:
                found[name] = np.empty((len(theta), *part.shape[1:]), dtype=part.dtype)
            found[name][start : start + step] = part
    return found
