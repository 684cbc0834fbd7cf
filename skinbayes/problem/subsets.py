"""A problem with some of its rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import compress
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.problem.deduplicated_rows import kinds
from skinbayes.problem.inputs import Conditions
from skinbayes.problem.joint import JointProblem
from skinbayes.problem.joint_densities import split
from skinbayes.statistics.groups import CrossedGroups

if TYPE_CHECKING:
    from skinbayes.problem.problem import Problem


@overload
def without_data(problem: Problem, keep: NDArray[np.bool_]) -> Problem: ...


@overload
def without_data(problem: JointProblem, keep: NDArray[np.bool_]) -> JointProblem: ...


def without_data(problem: Problem | JointProblem, keep: NDArray[np.bool_]) -> Problem | JointProblem:
    """The problem without some of its data, such as those of one person.

    Its parameters are those of the whole problem, in the same order, so that draws of one are parameter vectors of the other. A
    parameter of nothing but data that are left out stays, with only its prior to say on it.

    Parameters
    ----------
    problem : a problem with data, or several experiments
    keep : which data stay, shape ``(M,)``: those of the first observable, then those of the second, … experiment by experiment

    Returns
    -------
    Problem
        what the forward model has prepared is shared

    Examples
    --------
    >>> from skinbayes.problem import load_problem
    >>> problem = load_problem("finger-water")
    >>> without_data(problem, problem.conditions.labels["person"] != "ID01").conditions.n_rows
    10
    """
    if isinstance(problem, JointProblem):
        each = split(problem, keep)
        kept = {
            name: one if each[name].all() else without_data(one, each[name])
            for name, one in problem.experiments.items()
        }
        return replace(problem, experiments=kept)
    if len(problem.observations) > 1 or not keep.any() or problem.dataset is None:
        reduced = replace(problem)
        reduced.__dict__["model"] = problem.model
        reduced.__dict__["likelihood"] = replace(problem.likelihood, counted=keep)
        return reduced
    labels, groups, shared = problem.conditions.labels, problem.groups, problem.correlated
    if shared is not None:  # all of its effects stay, as those of the curves do
        shared = shared.rows(keep)
        groups = shared.scatter.groups
    elif groups is not None:
        groups = CrossedGroups.of_labels({name: labels[name][keep] for name in groups.columns})
    return _of_rows(
        problem,
        keep,
        dataset=problem.dataset.rows(keep),
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
