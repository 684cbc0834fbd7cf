"""Coordinates of a problem with groups: parameters that differ by the levels of a column, and effects they exchange with."""

from __future__ import annotations

import numpy as np

from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.statistics.funnels import Added, Funnel, FunnelTransform
from skinbayes.statistics.transforms import VectorTransform

LEAST_SLOPE = 0.1
"""Of ln of the data against ln of a parameter, below which a parameter and an effect do not exchange much."""

_STEP = 1e-3  # in a coordinate, for a slope
_RESOLVED = 1e-3  # least width: of ln of a parameter, or of the data over their mean


def straightened(problem: StatisticalModel, usual: VectorTransform) -> VectorTransform:
    """The coordinates of a problem with groups, its funnels straightened: at most one for each group.

    Effects on ln of the data exchange a factor with the levels of a parameter: a ridge that is straight in logarithms. Effects
    on the data exchange an amount: there the levels of one parameter become what they predict.

    Parameters
    ----------
    problem : with groups
    usual : its coordinates so far
    """
    names, logarithmic = problem.names, np.array([t.kind == "log" for t in usual.transforms])
    additive = not problem.noise_is_logarithmic.all()
    funnels: dict[str, Funnel] = {}
    added: Added | None = None
    for column, name in dict.fromkeys((p.by, p.name) for p in problem.free if p.by and p.by_column):
        levels = tuple(i for i, p in enumerate(problem.free) if (p.by, p.name) == (column, name))
        scale = f"group_scale[{column}]"
        shared = scale in names and logarithmic[names.index(scale)]
        wanted = added is None if additive else shared and column not in funnels
        if wanted and len(levels) > 1 and logarithmic[list(levels)].all():
            located = _located(problem, usual, levels, additive)
            if located is not None:
                centre, width, added = located
                if shared:
                    funnels[column] = Funnel(levels, names.index(scale), centre, width)
    if added is None and not funnels:
        return usual
    return FunnelTransform(usual.transforms, tuple(funnels.values()), added)


def _located(
    problem: StatisticalModel, usual: VectorTransform, levels: tuple[int, ...], additive: bool
) -> tuple[tuple[float, ...], float, Added | None] | None:
    """Centre and width of levels from a regression on all grouping columns; None if a level does not act."""
    column, groups = problem.free[levels[0]].by, problem.groups.columns if problem.groups else ()
    labels, medians, places = problem.conditions.labels, problem.prior_medians(), list(levels)
    member = np.stack([labels[column or ""] == problem.free[i].level for i in levels], axis=1)
    others = [labels[c][:, np.newaxis] == np.unique(labels[c]) for c in groups if c != column]
    z = usual.forward(medians[np.newaxis])
    moved = np.tile(medians, (len(medians) + 1, 1))
    logarithmic = [t.kind == "log" for t in usual.transforms]
    np.fill_diagonal(moved[1:], np.where(logarithmic, medians * np.exp(_STEP), usual.inverse(z + _STEP)[0]))
    with np.errstate(all="ignore"):
        predicted = np.log(problem.predict_data(moved))
    if not np.isfinite(predicted).all() or not member.any(axis=0).all():
        return None
    changes = (predicted[1:] - predicted[0]) / _STEP
    slopes = np.array([[change[rows].mean() for change in changes] for rows in member.T])
    slope = slopes[range(len(levels)), places]
    if np.any(np.abs(slope) < LEAST_SLOPE):
        return None
    observed = np.asarray(problem.observed)
    data = observed if additive else np.log(observed) - predicted[0]
    design = np.concatenate([member, *others], axis=1).astype(float)
    solution = np.linalg.lstsq(design, data, rcond=None)[0]
    left = data - design @ solution
    scatter = np.sqrt(left @ left / max(data.size - np.linalg.matrix_rank(design), 1))
    width = float(scatter / np.sqrt(member.sum(axis=0).mean()))
    known = solution[: len(levels)]
    added = None
    if additive:
        width = max(width, _RESOLVED * float(np.abs(observed).mean()))
        offsets = [predicted[0, rows].mean() for rows in member.T] - (slopes * z).sum(axis=-1)
        added = Added(levels, tuple(offsets.tolist()), tuple(map(tuple, slopes.tolist())), width)
    else:
        width = max(width / float(np.abs(slope).mean()), _RESOLVED)
        known = np.log(medians[places]) + known / slope
    return tuple((known - known.mean()).tolist()), width, added
