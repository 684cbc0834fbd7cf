"""Rows of a problem for which the forward model gives the same, whatever the parameters are."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.forward import Tables
from skinbayes.problem.inputs import Conditions, InputPlan


@dataclass(frozen=True)
class DistinctRows:
    """Rows that stand for all of them.

    Attributes
    ----------
    first : one row of each kind, shape ``(K,)``
    place : kind of each row, shape ``(N,)``
    """

    first: NDArray[np.intp]
    place: NDArray[np.intp]

    def of_inputs(self, inputs: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        """Inputs of the rows that stand for all, each ``(B or 1, K or 1)``."""
        return {
            name: values if values.shape[-1] == 1 else np.take(values, self.first, axis=-1)
            for name, values in inputs.items()
        }

    def of_tables(self, tables: Tables) -> Tables:
        """Curves of the rows that stand for all."""
        curves = tables.flow_curves
        return (
            tables
            if curves is None
            else replace(tables, flow_curves=tuple(curves[row] for row in self.first))
        )

    def at_rows(self, values: FloatArray) -> FloatArray:
        """Values ``(·, K)`` at all rows, ``(·, N)``; those that are the same for all rows stay ``(·, 1)``."""
        values = np.atleast_2d(values)
        return values if values.shape[-1] == 1 else np.take(values, self.place, axis=-1)


def distinct_rows(
    plan: Iterable[InputPlan],
    conditions: Conditions,
    tables: Tables,
    further: Mapping[str, NDArray[np.generic]] | None = None,
) -> DistinctRows | None:
    """Find rows of equal inputs; None if no two rows are alike.

    Parameters
    ----------
    plan : where each input comes from
    conditions : the rows
    tables : curves that belong to rows
    further : what else makes rows differ, each ``(N,)``
    """
    columns: list[NDArray[np.generic]] = [*conditions.values.values(), *conditions.covariates.values()]
    columns += list((further or {}).values())
    for entry in plan:
        columns += [entry.index, entry.fixed, entry.times]
    if tables.flow_curves is not None:
        columns.append(np.array([id(curve) for curve in tables.flow_curves]))
    place = kinds([column for column in columns if len(column) > 1], conditions.n_rows)
    _, first, place = np.unique(place, return_index=True, return_inverse=True)
    return None if len(first) == conditions.n_rows else DistinctRows(first, place.reshape(-1))


def kinds(columns: Sequence[NDArray[np.generic]], count: int) -> NDArray[np.intp]:
    """A number for each row, the same for rows that agree in all columns, each ``(N,)``; NaN agrees with NaN."""
    found = np.zeros(count, dtype=np.intp)
    for column in columns:
        _, value = np.unique(column, return_inverse=True)
        # numbers stay below the number of rows, so that products of two cannot overflow
        _, found = np.unique(found * count + value.reshape(-1), return_inverse=True)
        found = found.reshape(-1)
    return found
