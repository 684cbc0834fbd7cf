"""A problem with some of its rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import compress
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.problem.deduplicated_rows import kinds
from skinbayes.problem.inputs import Conditions
from skinbayes.statistics.groups import CrossedGroups

if TYPE_CHECKING:
    from skinbayes.problem.problem import Problem


def without_level(problem: Problem, column: str, level: str) -> Problem:
    """The problem without the data of one level of a grouping column, such as one person.

    Its parameters are those of the whole problem, in the same order, so that draws of one are parameter vectors of the other. A
    parameter of that level alone stays, with nothing but its prior to say on it.

    Parameters
    ----------
    problem : a problem with data
    column : grouping column
    level : the level whose rows go

    Returns
    -------
    Problem
        what the forward model has prepared is shared

    Raises
    ------
    InputError
        No data, no such column or level, or no other level

    Examples
    --------
    >>> from skinbayes.problem import load_problem
    >>> without_level(load_problem("finger-water"), "person", "ID01").conditions.n_rows
    10
    """
    labels = problem.conditions.labels
    if problem.dataset is None or not problem.observations or column not in labels:
        raise InputError(
            f"{problem.spec.path}: '{problem.name}' has no data with a column '{column}'; "
            f"grouping columns: {', '.join(labels) or 'none'}"
        )
    others = [other for other in dict.fromkeys(labels[column].tolist()) if other != level]
    keep = labels[column] != level
    if keep.all() or not others:
        raise InputError(
            f"{problem.spec.path}: {column} '{level}' cannot be left out: "
            + ("there is no other" if not others else f"expected one of {', '.join(others)}")
        )
    groups, shared = problem.groups, problem.correlated
    kept_labels = {name: values[keep] for name, values in labels.items()}
    if shared is not None:  # all of its effects stay, as those of the curves do
        shared = shared.rows(keep)
        groups = shared.scatter.groups
    elif groups is not None:
        groups = CrossedGroups.of_labels({name: kept_labels[name] for name in groups.columns})
    return _of_rows(
        problem,
        keep,
        dataset=problem.dataset.select({column: others}),
        observations=tuple(
            replace(o, values=o.values[keep], spread=o.spread[keep]) for o in problem.observations
        ),
        input_spread=_kept(problem.input_spread, keep),
        groups=groups,
        correlated=shared,
    )


def one_row_of_each_level(problem: Problem) -> Problem:
    """The problem with one row for each combination of levels of its grouping columns, to evaluate what rows share.

    It has no observations: it serves quantities that are the same for all rows of a level.

    Parameters
    ----------
    problem : any problem

    Examples
    --------
    >>> from skinbayes.problem import load_problem
    >>> one_row_of_each_level(load_problem("forearm-glass")).conditions.n_rows
    2
    """
    rows = problem.conditions
    _, first = np.unique(kinds(list(rows.labels.values()), rows.n_rows), return_index=True)
    keep = np.zeros(rows.n_rows, dtype=bool)
    keep[first] = True
    return _of_rows(problem, keep, observations=(), input_spread={}, groups=None, correlated=None)


def _of_rows(problem: Problem, keep: NDArray[np.bool_], **changes: Any) -> Problem:
    """The problem at some of its rows."""
    rows, tables = problem.conditions, problem.tables
    if tables.flow_curves is not None:
        tables = replace(tables, flow_curves=tuple(compress(tables.flow_curves, keep)))
    labels = {name: values[keep] for name, values in rows.labels.items()}
    kept = Conditions(_kept(rows.values, keep), labels, int(keep.sum()), _kept(rows.covariates, keep))
    reduced = replace(problem, conditions=kept, tables=tables, **changes)
    reduced.__dict__["model"] = problem.model  # prepared for the ranges of all rows, so also for these
    return reduced


def _kept(columns: Mapping[str, FloatArray], keep: NDArray[np.bool_]) -> dict[str, FloatArray]:
    return {name: values[keep] for name, values in columns.items()}
