"""Rows that differ in nothing, or in nothing but the abscissa of a curve, so that one evaluation serves them all."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import Inputs

FEW = 64
"""Rows times vectors below which telling rows apart costs more than evaluating them all."""


def along_rows(
    inputs: Inputs, abscissa: str, curve: Callable[[Inputs, FloatArray], dict[str, FloatArray]]
) -> dict[str, FloatArray]:
    """Evaluate a curve once for all rows whose inputs agree in everything but the abscissa.

    Parameters
    ----------
    inputs : name to SI values, each broadcasts to ``(B, N)``
    abscissa : the input that runs along the curve
    curve : ``(inputs, values) -> {observable: (B, F)}`` for inputs that broadcast to ``(B,)`` and values of the abscissa of
        shape ``(B or 1, F)``

    Returns
    -------
    dict
        Observable to values of shape ``(B, N)``, rows in their order.

    Examples
    --------
    >>> rows = {"time": np.array([[0.0, 1.0, 2.0]]), "rate": np.array([[3.0, 3.0, 5.0]])}
    >>> along_rows(rows, "time", lambda common, time: {"film": time * common["rate"][:, np.newaxis]})["film"]
    array([[ 0.,  3., 10.]])
    """
    tables = {name: np.atleast_2d(np.asarray(value, dtype=float)) for name, value in inputs.items()}
    count = max(table.shape[-1] for table in tables.values())
    along = tables.pop(abscissa)
    along = np.broadcast_to(along, (along.shape[0], count))
    found: dict[str, FloatArray] = {}
    batch = max(along.shape[0], *(table.shape[0] for table in tables.values()))
    for rows, common in _common(tables, count):
        for name, values in curve(common, np.ascontiguousarray(along[:, rows])).items():
            found.setdefault(name, np.empty((batch, count)))[:, rows] = values
    return found


def once_for_distinct(
    inputs: Inputs, function: Callable[[Inputs], dict[str, FloatArray]]
) -> dict[str, FloatArray]:
    """Evaluate a function once for all rows whose inputs agree.

    Parameters
    ----------
    inputs : name to SI values, each broadcasts to ``(B, N)``
    function : ``inputs -> {observable: (B,)}`` for inputs that broadcast to ``(B,)``

    Returns
    -------
    dict
        Observable to values of shape ``(B, N)``, rows in their order.

    Examples
    --------
    >>> rows = {"film": np.array([[6.0]]), "rate": np.array([[3.0, 3.0, 2.0]])}
    >>> once_for_distinct(rows, lambda common: {"time": common["film"] / common["rate"]})["time"]
    array([[2., 2., 3.]])
    """
    tables = {name: np.atleast_2d(np.asarray(value, dtype=float)) for name, value in inputs.items()}
    count = max(table.shape[-1] for table in tables.values())
    batch = max(table.shape[0] for table in tables.values())
    found: dict[str, FloatArray] = {}
    for rows, common in _common(tables, count):
        for name, values in function(common).items():
            found.setdefault(name, np.empty((batch, count)))[:, rows] = np.asarray(values)[..., np.newaxis]
    return found


def on_distinct(inputs: Inputs, function: Callable[[Inputs], FloatArray]) -> FloatArray:
    """Evaluate a function of arrays on the columns that differ, all at once.

    Parameters
    ----------
    inputs : name to SI values, each broadcasts to ``(B, N)``
    function : ``inputs -> values`` where each broadcasts to ``(B, K)``, for K columns

    Returns
    -------
    ndarray
        Broadcasts to ``(B, N)``, columns in their order.

    Examples
    --------
    >>> rows = {"modulus": np.array([[7.0, 9.0, 7.0, 7.0]]), "depth": np.array([[2.0]])}
    >>> on_distinct(rows, lambda few: few["modulus"] * few["depth"])
    array([[14., 18., 14., 14.]])
    """
    tables = {name: table for name, table in inputs.items() if table.ndim == 2}
    differing = [table for table in tables.values() if table.shape[-1] > 1]
    if not differing:
        return function(inputs)
    count = differing[0].shape[-1]
    if count * max(map(len, tables.values())) < FEW:
        return function(inputs)
    # often no two rows agree, as the first vector shows
    if any(len(table) and len(set(table[0].tolist())) == count for table in differing):
        return function(inputs)
    place = _kinds(differing, count)
    first = _first_of_each(place)
    if len(first) == count:
        return function(inputs)
    few = {name: table.take(first, axis=-1) for name, table in tables.items() if table.shape[-1] > 1}
    values = function({**inputs, **few})
    return np.take(values, place, axis=-1) if np.shape(values)[-1:] == (len(first),) else values


def _common(
    tables: dict[str, FloatArray], count: int
) -> Iterator[tuple[NDArray[np.intp], dict[str, FloatArray]]]:
    """Rows of equal columns, and what these columns are, each of shape ``(B,)`` or ``(1,)``."""
    for rows in _groups([table for table in tables.values() if table.shape[-1] > 1], count):
        yield (
            rows,
            {
                name: np.ascontiguousarray(table[:, rows[0] if table.shape[-1] > 1 else 0])
                for name, table in tables.items()
            },
        )


def _groups(tables: list[FloatArray], count: int) -> list[NDArray[np.intp]]:
    """Rows of equal columns in all tables, each of shape ``(B, N)``."""
    if not tables:
        return [np.arange(count)]
    place = _kinds(tables, count)
    order = np.argsort(place, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(place[order])) + 1)


def _kinds(tables: list[FloatArray], count: int) -> NDArray[np.intp]:
    """A number for each row, 0, 1, …, the same for rows of equal columns in all tables, each of shape ``(B, N)``."""
    found = np.zeros(count, dtype=np.intp)
    for table in tables:
        if not len(table):
            continue
        # rows that differ mostly do so in the first vector: its numbers are sorted, those of the others compared
        found = _refined(found, table[0], count)
        shared = table[:, _first_of_each(found)][:, found]
        for vector in np.flatnonzero((shared != table).any(axis=1)):
            found = _refined(found, table[vector], count)
    return found


def _refined(kinds: NDArray[np.intp], values: FloatArray, count: int) -> NDArray[np.intp]:
    """Kinds of rows told apart by one more number each."""
    _, place = np.unique(values, return_inverse=True)
    found = place.reshape(-1)
    if kinds.any():
        _, found = np.unique(kinds * count + found, return_inverse=True)
    return np.asarray(found.reshape(-1), dtype=np.intp)


def _first_of_each(kinds: NDArray[np.intp]) -> NDArray[np.intp]:
    """One row of each kind."""
    first = np.empty(int(kinds.max()) + 1, dtype=np.intp)
    first[kinds] = np.arange(len(kinds))
    return first
