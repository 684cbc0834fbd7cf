"""How well one fit predicts data that are left out: one datum at a time, or all data of one level of a grouping column."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.fit import Fit

FEW_ROWS = 10
"""With fewer data, or levels, than this a standard error of a sum over them means little."""

LARGEST_REFIT_ERROR = 0.2
"""A refit whose ln density is uncertain by more than this is not reliable either."""

RefitProgress = Callable[[int, int], None]
"""Called with the number of refits done and their total."""

_LEFT_OUT = "log_likelihood_left_out"


@dataclass(frozen=True)
class LeftOutLevel:
    """Prediction of all data of one level of a grouping column from those of the other levels.

    Attributes
    ----------
    level : the level left out
    rows : number of its data
    elpd : ln p(its data | all other data)
    pareto_k : of the importance sampling
    refitted : True if the model was sampled anew without the level, and ``elpd`` comes from that
    reliable : whether ``elpd`` can be trusted
    """

    level: str
    rows: int
    elpd: float
    pareto_k: float
    refitted: bool
    reliable: bool


@dataclass(frozen=True)
class LeftOut:
    """Prediction of each level of a grouping column from the others.

    Attributes
    ----------
    column : the grouping column
    levels : one entry for each level, in the order of the data
    elpd, elpd_se : sum over levels and its standard error
    difference, difference_se : to the best model in this column, and its standard error
    """

    column: str
    levels: tuple[LeftOutLevel, ...]
    elpd: float
    elpd_se: float
    difference: float = 0.0
    difference_se: float = 0.0

    @property
    def pointwise(self) -> FloatArray:
        """``elpd`` of each level, shape ``(levels,)``."""
        return np.array([level.elpd for level in self.levels])

    @property
    def unreliable(self) -> list[str]:
        """Levels whose number cannot be trusted."""
        return [level.level for level in self.levels if not level.reliable]

    @property
    def refitted(self) -> list[str]:
        """Levels without which the model was sampled anew."""
        return [level.level for level in self.levels if level.refitted]

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        counts = {"unreliable_levels": len(self.unreliable), "refitted_levels": len(self.refitted)}
        return vars(self) | counts | {"levels": {entry.level: vars(entry) for entry in self.levels}}


@dataclass(frozen=True)
class Scores:
    """All scores of one fit.

    Attributes
    ----------
    name : the model
    converged : whether the fit met its stopping rule
    loo : of single data, see :func:`skinbayes.fit.arviz_adapter.loo`
    left_out : of levels, by grouping column
    log_evidence : ln Z and its standard error, None if the engine did not give it
    """

    name: str
    converged: bool
    loo: dict[str, Any]
    left_out: dict[str, LeftOut]
    log_evidence: tuple[float, float] | None = None


def grouping_columns(fit: Fit) -> tuple[str, ...]:
    """Columns whose levels can be left out of a fit, one at a time."""
    return tuple(str(name) for name in fit.groups[_LEFT_OUT].data_vars) if _LEFT_OUT in fit.groups else ()


def score(fit: Fit, refit: bool = False, progress: RefitProgress | None = None) -> Scores:
    """Score a fit by Pareto-smoothed importance sampling, and by refits where that fails if asked to.

    Parameters
    ----------
    fit : the fit
    refit : sample anew without a level wherever importance sampling cannot leave it out
    progress : called after every refit

    Raises
    ------
    InputError
        A refit is needed, but the problem of the fit is not at hand.
    """
    from skinbayes.fit.arviz_adapter import leave_level_out, loo

    results = {column: leave_level_out(fit.groups, column) for column in grouping_columns(fit)}
    found = {column: _levels(fit, column, result) for column, result in results.items()}
    if refit:
        wanted = [
            (column, entry) for column, levels in found.items() for entry in levels if not entry.reliable
        ]
        for done, (column, entry) in enumerate(wanted):
            if progress is not None:
                progress(done, len(wanted))
            place = found[column].index(entry)
            found[column][place] = _refitted(fit, column, entry)
        if progress is not None and wanted:
            progress(len(wanted), len(wanted))
    left_out = {column: _summed(column, levels) for column, levels in found.items()}
    evidence = fit.provenance["sampling"].get("log_evidence")
    return Scores(fit.name, fit.converged, loo(fit.groups), left_out, tuple(evidence) if evidence else None)


def difference(first: FloatArray, second: FloatArray) -> tuple[float, float]:
    """Sum of the differences of two sets of scores, and its standard error."""
    from skinbayes.fit.arviz_adapter import standard_error

    return float((first - second).sum()), standard_error(first - second)


def _levels(fit: Fit, column: str, result: dict[str, Any]) -> list[LeftOutLevel]:
    counts: Counter[str] = Counter()
    if column in fit.groups["constant_data"]:
        counts = Counter(str(label) for label in fit.groups["constant_data"][column].values)
    return [
        LeftOutLevel(level, counts[level], float(value), float(k), False, bool(k <= result["good_k"]))
        for level, value, k in zip(result["levels"], result["pointwise"], result["pareto_k"], strict=True)
    ]


def _refitted(fit: Fit, column: str, entry: LeftOutLevel) -> LeftOutLevel:
    from skinbayes.fit.refit import predict_left_out

    if fit.problem is None:
        raise InputError(
            f"'{fit.name}' cannot be sampled without {column} '{entry.level}': its model or its data are not at hand"
        )
    seed = int(fit.provenance["sampling"]["seed"])
    densities = fit.groups[_LEFT_OUT][column]
    place = [str(level) for level in densities[f"{column}_level"].values].index(entry.level)
    whole = densities.values[..., place].reshape(-1)
    found = predict_left_out(fit.problem, column, entry.level, whole, seed)
    reliable = bool(found.converged and found.error <= LARGEST_REFIT_ERROR)
    return LeftOutLevel(entry.level, entry.rows, found.log_density, entry.pareto_k, True, reliable)


def _summed(column: str, levels: list[LeftOutLevel]) -> LeftOut:
    from skinbayes.fit.arviz_adapter import standard_error

    values = np.array([entry.elpd for entry in levels])
    return LeftOut(column, tuple(levels), float(values.sum()), standard_error(values))
