"""Comparing models on the same data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.arrays import FloatArray
    from skinbayes.fit import Fit

FEW_ROWS = 10
"""With fewer data than this a standard error of a sum over data means little."""


@dataclass(frozen=True)
class ComparedModel:
    """One model of a comparison.

    Attributes
    ----------
    name : the model
    log_evidence, log_evidence_se : not computed in this version, None
    elpd_loo, elpd_loo_se : expected log predictive density of left-out data and its standard error
    p_loo : effective number of parameters
    elpd_difference, elpd_difference_se : difference to the best model and its standard error
    weight : stacking weight
    unreliable_rows : data whose Pareto k says that leaving them out cannot be estimated from these draws
    """

    name: str
    log_evidence: float | None
    log_evidence_se: float | None
    elpd_loo: float
    elpd_loo_se: float
    p_loo: float
    elpd_difference: float
    elpd_difference_se: float
    weight: float
    unreliable_rows: int
    converged: bool


@dataclass(frozen=True)
class Comparison:
    """Models ordered from best to worst by their predictive density.

    Attributes
    ----------
    models : best first
    rows : number of data
    """

    models: tuple[ComparedModel, ...]
    rows: int

    def sentences(self) -> list[str]:
        """What the comparison says, in words."""
        best, said = self.models[0], []
        for other in self.models[1:]:
            gap, error = -other.elpd_difference, other.elpd_difference_se
            if gap < 2 * error or gap < 4:
                said.append(
                    f"These data do not tell '{best.name}' and '{other.name}' apart: their predictive densities differ by "
                    f"{gap:.2f} ± {error:.2f}."
                )
            else:
                said.append(
                    f"'{best.name}' predicts left-out data better than '{other.name}', by {gap:.1f} ± {error:.1f}."
                )
        if self.rows < FEW_ROWS:
            said.append(
                f"With {self.rows} data leave-one-out can hardly decide anything; standard errors are not to be trusted."
            )
        for model in self.models:
            if model.unreliable_rows:
                said.append(
                    f"'{model.name}': {model.unreliable_rows} of {self.rows} data influence the posterior so strongly that "
                    "leaving them out cannot be estimated by importance sampling (Pareto k above the limit)."
                )
            if not model.converged:
                said.append(f"'{model.name}' has NOT CONVERGED; its numbers are provisional.")
        return said

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        return {"models": [asdict(m) for m in self.models], "rows": self.rows, "sentences": self.sentences()}


def compare(fits: Sequence[Fit]) -> Comparison:
    """Compare fits by Pareto-smoothed importance-sampling leave-one-out cross-validation.

    Vehtari, Gelman & Gabry 2017, doi 10.1007/s11222-016-9696-4; weights by stacking, Yao et al. 2018,
    doi 10.1214/17-BA1091.

    Parameters
    ----------
    fits : two or more fits of the same data

    Raises
    ------
    InputError
        Fewer than two fits, or fits of different data (another table, other rows or another observable).
    """
    from skinbayes.fit.arviz_adapter import loo, standard_error

    if len(fits) < 2:
        raise InputError(f"{len(fits)} run given; a comparison needs at least two")
    reference = fits[0]
    for fit in fits[1:]:
        if fit.provenance["data"]["fingerprint"] != reference.provenance["data"]["fingerprint"]:
            raise InputError(
                f"'{reference.name}' and '{fit.name}' were fitted to different data "
                f"({_describe(reference)}; {_describe(fit)}); only models of the same rows can be compared"
            )
    results = [loo(fit.groups) for fit in fits]
    pointwise = np.stack([result["pointwise"] for result in results])
    weights = stacking_weights(pointwise)
    best = int(np.argmax([result["elpd"] for result in results]))
    models = []
    for i, (fit, result) in enumerate(zip(fits, results, strict=True)):
        difference = pointwise[i] - pointwise[best]
        models.append(
            ComparedModel(
                name=fit.name,
                log_evidence=None,
                log_evidence_se=None,
                elpd_loo=result["elpd"],
                elpd_loo_se=result["se"],
                p_loo=result["p"],
                elpd_difference=float(difference.sum()),
                elpd_difference_se=standard_error(difference),
                weight=float(weights[i]),
                unreliable_rows=int((result["pareto_k"] > result["good_k"]).sum()),
                converged=fit.converged,
            )
        )
    models.sort(key=lambda model: -model.elpd_loo)
    return Comparison(tuple(models), pointwise.shape[1])


def stacking_weights(pointwise: FloatArray) -> FloatArray:
    """Weights of a mixture of predictive distributions that maximise its summed log density at left-out data.

    Parameters
    ----------
    pointwise : log predictive density of each left-out datum under each model, shape ``(models, N)``

    Returns
    -------
    ndarray
        Shape ``(models,)``, non-negative, sum 1.

    Examples
    --------
    >>> stacking_weights(np.log([[0.5, 0.5], [0.1, 0.1]])).round(3).tolist()
    [1.0, 0.0]
    """
    from scipy.optimize import minimize

    count = len(pointwise)
    density = np.exp(pointwise - pointwise.max(axis=0))
    solution = minimize(
        lambda w: -np.log(w @ density).sum(),
        np.full(count, 1 / count),
        jac=lambda w: -(density / (w @ density)).sum(axis=1),
        bounds=[(0.0, 1.0)] * count,
        constraints={"type": "eq", "fun": lambda w: w.sum() - 1.0, "jac": lambda w: np.ones(count)},
        method="SLSQP",
    )
    weights: FloatArray = np.clip(solution.x, 0.0, 1.0)
    return weights / weights.sum()


def _describe(fit: Fit) -> str:
    data = fit.provenance["data"]
    return f"{data.get('rows')} rows of {data.get('key')}"
