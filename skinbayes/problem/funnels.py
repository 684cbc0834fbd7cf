"""Funnels of a problem: parameters that differ by the levels of a column whose effects are a group too."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.statistics.funnels import Funnel

LEAST_SLOPE = 0.1
"""Of ln of the data against ln of a parameter, below which a parameter and an effect do not exchange much."""

_STEP = 1e-3  # in ln of a parameter, for a slope


def funnels_of(problem: StatisticalModel, logarithmic: tuple[bool, ...]) -> tuple[Funnel, ...]:
    """The funnels of a problem with groups on ln of its data; at most one for each group.

    Parameters
    ----------
    problem : with groups
    logarithmic : which of the free parameters have their logarithm as coordinate
    """
    groups, names = problem.groups, problem.names
    if groups is None:
        return ()
    medians = problem.prior_medians()
    found = []
    for column in groups.columns:
        scale = f"group_scale[{column}]"
        for name in dict.fromkeys(p.name for p in problem.free if p.by_column and p.by == column):
            levels = [
                i for i, p in enumerate(problem.free) if p.name == name and p.by_column and p.by == column
            ]
            if (
                scale in names
                and len(levels) > 1
                and all(logarithmic[i] for i in [*levels, names.index(scale)])
            ):
                located = _located(problem, medians, levels, column)
                if located is not None:
                    found.append(Funnel(tuple(levels), names.index(scale), *located))
                    break
    return tuple(found)


def _located(
    problem: StatisticalModel, medians: FloatArray, levels: list[int], column: str
) -> tuple[tuple[float, ...], float] | None:
    """Centre and width of a funnel from a regression on all grouping columns; None if a level does not act."""
    labels, columns = problem.conditions.labels, problem.groups.columns if problem.groups else ()
    member = np.stack([labels[column] == problem.free[i].level for i in levels], axis=1)
    others = [labels[c][:, np.newaxis] == np.unique(labels[c]) for c in columns if c != column]
    moved = np.tile(medians, (len(levels) + 1, 1))
    moved[1:, levels] *= np.exp(_STEP * np.eye(len(levels)))
    with np.errstate(all="ignore"):
        predicted = np.log(problem.predict_data(moved))
    if not np.isfinite(predicted).all() or not member.any(axis=0).all():
        return None
    slopes = (predicted[1:] - predicted[0]) / _STEP
    slope = np.array([slopes[i, rows].mean() for i, rows in enumerate(member.T)])
    if np.any(np.abs(slope) < LEAST_SLOPE):
        return None
    data = np.log(np.asarray(problem.observed)) - predicted[0]
    design = np.concatenate([member, *others], axis=1).astype(float)
    solution = np.linalg.lstsq(design, data, rcond=None)[0]
    left = data - design @ solution
    centre = np.log(medians[levels]) + solution[: len(levels)] / slope
    scatter = np.sqrt(left @ left / max(data.size - np.linalg.matrix_rank(design), 1))
    width = max(float(scatter / np.sqrt(member.sum(axis=0).mean()) / np.abs(slope).mean()), 1e-3)
    return tuple((centre - centre.mean()).tolist()), width
