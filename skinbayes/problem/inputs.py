"""From a parameter vector and rows of conditions to the named inputs of a forward model."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.vocabulary import meant, suggestions


@dataclass(frozen=True)
class Conditions:
    """Rows at which a forward model is evaluated.

    Attributes
    ----------
    values : quantity to SI values, each of shape ``(n_rows,)``
    labels : grouping column to text values, each of shape ``(n_rows,)``
    n_rows : number of rows
    covariates : further columns that act on inputs or observables, each of shape ``(n_rows,)``, SI
    """

    values: Mapping[str, FloatArray]
    labels: Mapping[str, NDArray[np.str_]]
    n_rows: int
    covariates: Mapping[str, FloatArray] = field(default_factory=dict)

    def without(self, names: Collection[str]) -> Conditions:
        """The same rows without some of the quantities."""
        kept = {k: v for k, v in self.values.items() if k not in names}
        return Conditions(kept, self.labels, self.n_rows, self.covariates)

    def matching(self, wanted: Mapping[str, Collection[str]]) -> NDArray[np.bool_]:
        """Which rows have one of the wanted levels in each of the named grouping columns, shape ``(n_rows,)``."""
        chosen = np.ones(self.n_rows, dtype=bool)
        for column, levels in wanted.items():
            chosen &= np.isin(self.labels[column], list(levels)) if column in self.labels else False
        return chosen

    def row_labels(self) -> list[str]:
        """A short name for each row: a grouping column or all of them together if that tells rows apart, else a number."""
        telling = [
            [str(value) for value in column] for column in self.labels.values() if len(set(column)) > 1
        ]
        joined = [", ".join(parts) for parts in zip(*telling, strict=True)] if telling else []
        for names in (*telling, joined):
            if len(set(names)) == self.n_rows:
                return names
        return [str(row + 1) for row in range(self.n_rows)]


@dataclass(frozen=True)
class InputPlan:
    """How to assemble one input for all rows: from the parameter vector, from fixed values, or both.

    Attributes
    ----------
    name : input of the forward model
    index : position in the parameter vector for each row, −1 where the value is fixed; shape ``(1,)`` or ``(n_rows,)``
    fixed : fixed value for each row, NaN where free; same shape
    times : what the free value is multiplied with for each row, 1 unless tied; same shape
    """

    name: str
    index: NDArray[np.intp]
    fixed: FloatArray
    times: FloatArray

    def values(self, theta: FloatArray) -> FloatArray:
        """Values for a batch of parameter vectors ``(B, D)``: shape ``(B, 1)`` or ``(B, n_rows)``; ``(1, ·)`` if fixed."""
        position, is_fixed, is_tied = self._prepared
        if not self.varies:
            return self.fixed[np.newaxis, :]
        values = theta.take(position, axis=1)
        if is_tied:
            values *= self.times
        if is_fixed is not None:
            values[:, is_fixed] = self.fixed[is_fixed]
        return values

    @cached_property
    def varies(self) -> bool:
        """Whether the parameter vector enters."""
        return bool((self.index >= 0).any())

    @cached_property
    def _prepared(self) -> tuple[NDArray[np.intp], NDArray[np.bool_] | None, bool]:
        """Where each row stands in the parameter vector, which rows are fixed, None if none is, and whether any is tied."""
        fixed = self.index < 0
        return np.maximum(self.index, 0), fixed if fixed.any() else None, bool((self.times != 1).any())


def label_meant(column: str, labels: Collection[str]) -> str:
    """A sentence on the label columns that there are instead of one that is not, or on the one that may be meant."""
    said = suggestions(column, labels)
    other = next((label for label in labels if meant(label, [column])), None)
    listed = ", ".join(labels) or "none"
    return said or (f" Label columns: {listed}" if other is None else f" Did you mean '{other}'?")


def plan_inputs(
    fixed: Sequence[ParameterSpec],
    free: Sequence[ParameterSpec],
    conditions: Conditions,
    tied: Sequence[ParameterSpec] = (),
) -> tuple[InputPlan, ...]:
    """Work out where each input comes from for the given rows; those that are ``tied`` follow one of the others.

    Raises
    ------
    InputError
        A parameter has values for each level of a grouping column that the rows lack, or a row has a level without value.
    """
    by_name: dict[str, list[tuple[ParameterSpec, int]]] = {}
    positions = [(spec, -1) for spec in fixed] + [(spec, position) for position, spec in enumerate(free)]
    places = {spec.label: (spec.value, position) for spec, position in positions} if tied else {}
    for spec in tied:
        value, position = places[str(spec.same_as)]
        positions.append((replace(spec, value=None if value is None else value * spec.times), position))
    for spec, position in positions:
        by_name.setdefault(_input_name(spec), []).append((spec, position))
    return tuple(_plan_one(name, entries, conditions) for name, entries in by_name.items())


def _input_name(spec: ParameterSpec) -> str:
    """Parameters that differ by a column of the rows are one input, those that differ by something else are several."""
    return spec.label if spec.by is not None and not spec.by_column else spec.name


def _plan_one(name: str, entries: list[tuple[ParameterSpec, int]], conditions: Conditions) -> InputPlan:
    column = entries[0][0].by
    if column is None or not entries[0][0].by_column:
        (spec, position), *_ = entries
        value = np.nan if spec.value is None else spec.value
        return InputPlan(name, np.array([position]), np.array([value]), np.array([spec.times]))
    if column not in conditions.labels:
        raise InputError(
            f"{name} differs by '{column}', but the rows have no column '{column}': add it ('skinbayes template' prints the "
            f"header that a model needs).{label_meant(column, conditions.labels)}".rstrip(".")
        )
    index = np.full(conditions.n_rows, -2)
    fixed, times = np.full(conditions.n_rows, np.nan), np.ones(conditions.n_rows)
    for spec, position in entries:
        here = conditions.labels[column] == spec.level
        index[here] = position
        fixed[here] = np.nan if spec.value is None else spec.value
        times[here] = spec.times
    if (index == -2).any():
        missing = sorted({str(level) for level in conditions.labels[column][index == -2]})
        known = ", ".join(str(spec.level) for spec, _ in entries)
        raise InputError(
            f"{name} differs by '{column}' and has values for {known}, but rows have {', '.join(missing)}"
        )
    return InputPlan(name, index, fixed, times)
