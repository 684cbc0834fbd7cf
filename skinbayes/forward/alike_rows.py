"""Rows that differ in nothing, or in nothing but the abscissa of a curve, so that one evaluation serves them all."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import Inputs


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


def once_for_alike(
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
    >>> once_for_alike(rows, lambda common: {"time": common["film"] / common["rate"]})["time"]
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
    _, group = np.unique(np.concatenate(tables), axis=1, return_inverse=True)
    return [np.flatnonzero(group.reshape(-1) == g) for g in range(int(group.max()) + 1)]
