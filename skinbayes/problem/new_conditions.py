"""A problem at rows that were not measured: other loads, speeds and liquids, known people and new ones."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.emulation import Progress
from skinbayes.errors import InputError
from skinbayes.files.dataset import Data, Dataset, as_dataset
from skinbayes.files.dataset_rows import place_of_row
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.files.scatter_block import ORDER
from skinbayes.problem.inputs import Conditions
from skinbayes.problem.populations import new_people
from skinbayes.problem.problem import Problem
from skinbayes.problem.rheology import flow_curves_of
from skinbayes.problem.rows import given_rows
from skinbayes.problem.shared_scatter import SharedScatter
from skinbayes.statistics.correlated_scatter import CorrelatedScatter
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.smooth_curves import SmoothCurves


@dataclass(frozen=True)
class NewConditions:
    """A problem at new rows, and what these share with the measured ones.

    Attributes
    ----------
    measured : the problem with its data
    problem : the same at the new rows, its parameters in the order of the measured one; without observations
    dataset : the new rows as they were given
    people : labels of the deviates of people who were not measured; the parameters of the problem end with them
    known : place among the effects of the measured rows that each effect of the new ones has, −1 for new levels, shape ``(K,)``
    notes : sentences on what is not carried over to new rows
    """

    measured: Problem
    problem: Problem
    dataset: Dataset
    known: NDArray[np.intp]
    notes: tuple[str, ...]
    people: tuple[str, ...] = ()

    def of_people(self, theta: FloatArray, rng: np.random.Generator | None = None) -> FloatArray:
        """Parameters of the problem for those of the measured one: new people are drawn, or as the median without ``rng``."""
        size = len(theta), len(self.people)
        anew = np.zeros(size) if rng is None else rng.standard_normal(size)
        return np.concatenate([theta, anew], axis=1)

    @property
    def new_people(self) -> dict[str, tuple[str, ...]]:
        """Levels of populations that were not measured, by label column."""
        found: dict[str, dict[str, None]] = {}
        for spec in self.measured.spec.populations if self.people else ():
            for column in (spec.by, spec.within):
                before = self.measured.conditions.labels.get(column or "")
                now = self.problem.conditions.labels.get(column or "", np.full(1, "", dtype=str))
                new = [
                    level
                    for level in now.tolist()
                    if before is not None and level not in set(before.tolist())
                ]
                found.setdefault(str(column), {}).update(dict.fromkeys(new))
        return {column: tuple(levels) for column, levels in found.items() if levels}

    @property
    def new_levels(self) -> dict[str, tuple[str, ...]]:
        """Levels of the grouping columns that were not measured, by column."""
        groups, start = self.problem.groups, 0
        found: dict[str, tuple[str, ...]] = {}
        for column, levels in zip(groups.columns, groups.levels, strict=True) if groups else ():
            if new := tuple(level for i, level in enumerate(levels) if self.known[start + i] < 0):
                found[column] = new
            start += len(levels)
        return found


def at_new_conditions(
    measured: Problem, data: Data, progress: Progress | None = None, cores: int = 1
) -> NewConditions:
    """The problem at new rows.

    Parameters
    ----------
    measured : a problem with data
    data : the rows, as a CSV, data set, data frame or mapping of columns. A fixed parameter may be a column of them
    progress, cores : as :meth:`Problem.prepare` takes them, should the rows need a table of their own

    Raises
    ------
    InputError
        A column that the data of the fit have is missing, or one is a parameter that was inferred; a label has no value or no
        flow curve; a row lies where the discrepancy is not known.
    """
    dataset = as_dataset(data)
    rows = given_rows(measured.spec, measured.forward, dataset)
    if lacking := sorted(set(measured.conditions.values) - set(rows.values)):
        raise InputError(
            f"{dataset.path}: no column '{lacking[0]} [..]', which the data of '{measured.name}' have; expected it in rows to "
            "predict too"
        )
    inferred = {p.name for p in (*measured.free, *measured.tied)} | {
        p.name for p in measured.spec.populations
    }
    if given := sorted(inferred & set(rows.values)):
        raise InputError(
            f"{dataset.path}: column '{given[0]}' is a parameter of '{measured.name}' that was inferred; drop the column"
        )
    tables = replace(
        measured.tables,
        flow_curves=flow_curves_of(measured.flow_curves, measured.spec.rheology_by, rows, dataset.path),
    )
    groups, shared, known, notes = _shared(measured, rows, dataset)
    people: tuple[ParameterSpec, ...] = ()
    populations = measured.populations
    if populations is not None:
        _check_treatments(measured, rows, dataset)
        people = new_people(populations, rows)
        populations = replace(populations, free=(*populations.free, *(p.label for p in people)))
    problem = replace(
        measured,
        free=(*measured.free, *people),
        populations=populations,
        fixed=tuple(p for p in measured.fixed if p.name not in rows.values),
        conditions=rows,
        dataset=None,
        observations=(),
        input_spread={},
        groups=groups,
        correlated=shared,
        tables=tables,
    )
    try:
        _ = problem.plan
    except InputError as error:
        raise InputError(f"{dataset.path}: {error}") from None
    _prepare(problem, measured, progress, cores)
    return NewConditions(measured, problem, dataset, known, notes, tuple(p.label for p in people))


def _check_treatments(measured: Problem, rows: Conditions, dataset: Dataset) -> None:
    """Refuse treatments that were not measured: nothing is known of what they do."""
    for spec in measured.spec.populations:
        column = None if spec.contrast is None else spec.contrast.column
        seen = set(measured.conditions.labels[column].tolist()) if column else set()
        given = rows.labels.get(column, np.zeros(0, dtype=str)).tolist() if column else []
        if unknown := sorted(set(given) - seen):
            raise InputError(
                f"{dataset.path}: {column} '{unknown[0]:.60}' was not measured, and acts on {spec.name}; expected "
                f"{' or '.join(sorted(seen))}"
            )


def _prepare(problem: Problem, measured: Problem, progress: Progress | None, cores: int) -> None:
    """Give the problem what its forward model needs to be evaluated many times: that of the measured rows where it reaches."""
    by = problem.spec.rheology_by if problem.flow_curves else None
    same_liquids = by is None or set(problem.conditions.labels[by]) <= set(measured.conditions.labels[by])
    if problem.forward.prepare is None or not problem.free or (same_liquids and _reaches(measured, problem)):
        problem.__dict__["model"] = measured.model
    else:
        problem.prepared_for_many(progress, cores)


def _reaches(measured: Problem, problem: Problem) -> bool:
    """Whether the inputs of measured rows reach as far as those of others."""
    here, there = problem.ranges(), measured.ranges()
    # new people are of the same population, for which the table was made
    drawn = {spec.name for spec in measured.spec.populations}
    return here.multiples == there.multiples and all(
        name in there and there[name][0] <= low and high <= there[name][1]
        for name, (low, high) in here.items()
        if name not in drawn
    )


def _shared(
    measured: Problem, rows: Conditions, dataset: Dataset
) -> tuple[CrossedGroups | None, SharedScatter | None, NDArray[np.intp], tuple[str, ...]]:
    """What new rows share: effects of groups and curves; where each effect stands among those of the measured rows; notes."""
    known, notes = [np.zeros(0, dtype=np.intp)], list[str]()
    groups = measured.groups
    if groups is not None:
        # rows without the column are all of one level that nobody has measured
        labels = {c: rows.labels.get(c, np.full(rows.n_rows, "")) for c in groups.columns}
        start, found = 0, CrossedGroups.of_labels(labels)
        for before, new in zip(groups.levels, found.levels, strict=True):
            place = {level: start + i for i, level in enumerate(before)}
            known.append(np.array([place.get(level, -1) for level in new], dtype=np.intp))
            start += len(before)
        groups = found
    old = measured.correlated
    if old is None:
        return groups, None, np.concatenate(known), ()
    if old.scatter.noise is not None:
        notes.append(
            "Noise has no memory between the rows, and no drift: each row is predicted as a measurement by itself."
        )
    curves, parameters = [], list(old.parameters[: 0 if groups is None else len(groups.columns)])
    for number, (axis, curve) in enumerate(zip(old.axes, old.scatter.curves, strict=True)):
        x = axis.coordinate(_along(measured, axis.column, rows, dataset))
        if (beyond := np.flatnonzero((x < -EDGE) | (x > 1.0 + EDGE))).size:
            raise InputError(
                f"{place_of_row(dataset, int(beyond[0]))}: {axis.column} lies outside {axis.low:.4g} to {axis.high:.4g}, the "
                f"range of the data in which the discrepancy of '{measured.name}' is known; expected rows within it"
            )
        labels_of = rows.labels.get(axis.within) if axis.within else None
        if labels_of is None:
            labels_of = np.full(rows.n_rows, "")
        levels = tuple(dict.fromkeys(labels_of.tolist()))
        level = np.array([levels.index(label) for label in labels_of.tolist()], dtype=np.intp)
        curves.append(SmoothCurves(np.clip(x, 0.0, 1.0), level, len(levels), curve.n_nodes))
        first = old.scatter.curve_effects(number).start
        for label in levels:
            at = axis.levels.index(label) if label in axis.levels else -1
            nodes = np.arange(curve.n_nodes) + first + at * curve.n_nodes
            known.append(nodes if at >= 0 else np.full(curve.n_nodes, -1))
        begin = len(parameters)
        parameters += old.parameters[begin : begin + 2]
    if not curves:
        return groups, None, np.concatenate(known), tuple(notes)
    scatter = CorrelatedScatter(rows.n_rows, groups, tuple(curves))
    return groups, SharedScatter(scatter, tuple(parameters)), np.concatenate(known), tuple(notes)


EDGE = 1e-9
"""Rounding of a coordinate at the ends of a range."""


def _along(measured: Problem, column: str, rows: Conditions, dataset: Dataset) -> FloatArray:
    if column == ORDER:
        raise InputError(
            f"'{measured.name}' has a discrepancy along the order of its rows, which rows to predict have no place in"
        )
    if column not in dataset.columns:
        raise InputError(
            f"{dataset.path}: no column '{column}', along which '{measured.name}' has a discrepancy; expected it in rows to "
            "predict too"
        )
    return np.asarray(dataset.columns[column], dtype=float)
