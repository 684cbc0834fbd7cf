"""What speaks against the model of a fit: data outside their predictions, trends of the residuals, misfit beyond repeats."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import is_logarithmic, observables, observed_values, predictive_draws
from skinbayes.problem.deduplicated_rows import kinds
from skinbayes.statistics.agreement import Agreement, examine
from skinbayes.statistics.repeats import LackOfFit, lack_of_fit
from skinbayes.statistics.trends import Trend, trends
from skinbayes.vocabulary import STANDARD_DEVIATION_SUFFIX, lookup, spread_of

if TYPE_CHECKING:
    from skinbayes.fit.result import FitResult
    from skinbayes.problem import Problem

FEW = 5
"""With fewer data than this their agreement says little."""

MOST_DRAWS = 1000
"""Simulated data sets that the data are held against."""

FEWEST_DRAWS, MOST_NUMBERS = 200, 2_000_000
"""With many rows fewer, so that they hold at most so many numbers."""

ORDER = "order"
"""Name of the order of the rows among the columns."""

NO_CONDITIONS = ("friction_coefficient", "friction_force", "number_of_measurements")
"""Columns of data that are results, whether the model explains them or not."""


def agreement(fit: FitResult) -> Agreement:
    """How the data lie among their posterior predictive draws."""
    observed = observed_values(fit)
    of_one_kind = len(observed) >= FEW and len(observables(fit)) == 1
    return examine(observed, predictive_draws(fit), of_one_kind)


def residual_trends(fit: FitResult) -> dict[str, tuple[Trend, ...]]:
    """Checks of the residuals along every column that varies and in the order of the rows, by observable."""
    columns = columns_of_rows(fit)
    return {name: trends(data, simulated, columns) for name, (data, simulated) in residuals_of(fit).items()}


def repeats(fit: FitResult) -> dict[str, LackOfFit]:
    """The misfit beside the scatter of repeats, by observable; empty if hardly any row repeats another."""
    if fit.problem is None:
        return {}
    condition = conditions(fit.problem)
    found = {}
    for name, (data, simulated) in residuals_of(fit).items():
        if (one := lack_of_fit(data, simulated, condition)) is not None:
            found[name] = one
    return found


def residuals_of(fit: FitResult) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Residuals of the data ``(N,)`` and of simulated data ``(S, N)`` from typical predictions, by observable."""
    names = observables(fit)
    observed = observed_values(fit).reshape(len(names), -1)
    draws = predictive_draws(fit)
    most = max(FEWEST_DRAWS, min(MOST_DRAWS, MOST_NUMBERS // observed.size))
    draws = draws[:: max(1, len(draws) // most)].reshape(-1, len(names), observed.shape[1])
    found = {}
    for place, name in enumerate(names):
        logarithmic = is_logarithmic(fit, name)
        with np.errstate(all="ignore"):
            data, simulated = (np.log(x) if logarithmic else x for x in (observed[place], draws[:, place]))
            usable = simulated[np.isfinite(simulated).all(axis=1)]
            if len(usable):
                middle = np.median(usable, axis=0)
                found[name] = (data - middle, usable - middle)
    return found


def columns_of_rows(fit: FitResult) -> dict[str, FloatArray]:
    """Numbers that differ from row to row, and the order of the rows, each ``(N,)``."""
    count = fit.groups["observed_data"].sizes["row"]
    found: dict[str, FloatArray] = {}
    if "constant_data" in fit.groups:
        for name, values in fit.groups["constant_data"].data_vars.items():
            spread = str(name).endswith(STANDARD_DEVIATION_SUFFIX)
            if values.dtype.kind in "fiu" and values.shape == (count,) and not spread:
                found[str(name)] = np.asarray(values.values, dtype=float)
    return found | {ORDER: np.arange(count, dtype=float)}


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
