"""What rows measured under the same conditions say about the misfit of a model, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinbayes.phrases import percent
from skinbayes.plot.numbers import quantity_of
from skinbayes.plot.symbols import spoken_name
from skinbayes.problem.deduplicated_rows import kinds
from skinbayes.report.trends import is_logarithmic, residuals_of
from skinbayes.statistics.repeats import LackOfFit, lack_of_fit
from skinbayes.vocabulary import lookup, spread_of

if TYPE_CHECKING:
    from skinbayes.fit import Fit
    from skinbayes.problem import Problem

NO_CONDITIONS = ("friction_coefficient", "friction_force", "number_of_measurements")
"""Columns of data that are results, whether the model explains them or not."""


def repeats(fit: Fit) -> dict[str, LackOfFit]:
    """The misfit beside the scatter of repeats, by observable; empty if hardly any row repeats another."""
    if fit.problem is None:
        return {}
    condition = conditions(fit.problem)
    found = {}
    for name, (data, simulated) in residuals_of(fit).items():
        if (one := lack_of_fit(data, simulated, condition)) is not None:
            found[name] = one
    return found


def conditions(problem: Problem) -> NDArray[np.intp]:
    """Number of the condition of each row, from 0, shape ``(N,)``.

    Rows have the same condition if they are the same to the model and to the effects of groups, and agree in all columns of the
    data that hold known quantities and no results.
    """
    count = problem.conditions.n_rows
    same = problem.deduplicated
    columns: list[NDArray[np.generic]] = [np.arange(count) if same is None else same.place]
    if problem.groups is not None:
        columns += [problem.conditions.labels[column] for column in problem.groups.columns]
    results = {*NO_CONDITIONS, *problem.observables}
    for name, values in {} if problem.dataset is None else problem.dataset.columns.items():
        is_result = name in results or (spread_of(name) or "") in results
        if values.dtype.kind != "U" and lookup(name) is not None and not is_result:
            columns.append(values)
    return kinds(columns, count)


def repeat_sentences(fit: Fit) -> tuple[list[str], list[str]]:
    """A sentence for each observable with repeats: how they scatter, and whether that allows the misfit.

    Those that speak against the model, and the others.
    """
    against: list[str] = []
    others: list[str] = []
    for name, one in repeats(fit).items():
        (against if one.found else others).append(_said(fit, name, one))
    return against, others


def _said(fit: Fit, observable: str, found: LackOfFit) -> str:
    known = lookup(observable)
    what = known.symbol if known else spoken_name(observable)
    logarithmic = is_logarithmic(fit, observable)

    def size(value: float) -> str:
        return percent(value) if logarithmic else quantity_of(observable, value)

    chance = f"simulated data of the model miss them as far in {percent(found.probability)} of cases"
    return (
        f"Rows of the same conditions scatter by {size(found.scatter)}{f' of {what}' if logarithmic else ''} "
        f"({found.degrees_of_freedom} degrees of freedom). The model misses the means of the {found.conditions} conditions by "
        f"{size(found.misfit)}, where such a scatter alone makes {size(found.allowed)}: "
        + ("MORE than repeats allow" if found.found else "no more than repeats allow")
        + f" ({chance})."
    )
