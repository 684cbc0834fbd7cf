"""Whether experiments on one skin agree: each against what all others say about the parameters that they share."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from math import hypot
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.files.joint_model import EXPERIMENT
from skinbayes.fit.result import JointResult
from skinbayes.problem.joint import JointProblem
from skinbayes.problem.subsets import without_data
from skinbayes.sampling.draws import weighted_quantiles
from skinbayes.statistics.pareto import FINITE_VARIANCE
from skinbayes.statistics.reweighting import reweighted

LEVELS = (0.05, 0.5, 0.95)

REFIT_ESS, REFIT_STEPS = 1000.0, 4000
"""Effective sample size of what is sampled without an experiment, and steps after which that ends."""


@dataclass(frozen=True)
class LeftOutExperiment:
    """What the other experiments say without one of them.

    Attributes
    ----------
    experiment : that is left out
    elpd : ln p(its data | the data of the others)
    error : standard error of ``elpd``, of Monte Carlo
    pareto_k : of the weights of the draws
    reliable : whether these numbers can be trusted; if weights cannot tell, only a fit without it can
    refitted : whether they are from a fit without it
    without, all : 5, 50 and 95 % quantiles of each shared parameter without the experiment, and with all of them, SI
    """

    experiment: str
    elpd: float
    error: float
    pareto_k: float
    reliable: bool
    without: dict[str, tuple[float, ...]]
    all: dict[str, tuple[float, ...]]
    refitted: bool = False

    @property
    def pulls(self) -> list[str]:
        """Shared parameters whose median, with this experiment, lies outside the 90 % interval without it."""
        return [
            label
            for label, (low, _, high) in self.without.items()
            if self.reliable and not low <= self.all[label][1] <= high
        ]

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        return asdict(self) | {"pulls": self.pulls}


def shared_labels(fit: JointResult) -> list[str]:
    """Free parameters that more than one experiment has."""
    places = [place for told in fit.provenance["experiments"].values() for place in told["places"]]
    return [label for i, label in enumerate(fit.names) if places.count(i) > 1]


def left_out_experiments(fit: JointResult, refit: bool = False) -> list[LeftOutExperiment]:
    """Each experiment left out in turn, by weights 1/p(its data | θ) of the draws, or by a fit without it.

    What only this experiment has, such as its own scatter, goes back to its prior then. Draws of the posterior may not reach that
    far, and those with weights are looked at as well.

    Parameters
    ----------
    fit : of several experiments
    refit : sample without an experiment where the draws cannot tell, if the model and its data are at hand

    Returns
    -------
    list
        One entry for each experiment; none if they share no parameter, so that they cannot disagree.
    """
    labels = shared_labels(fit)
    if not labels:
        return []
    names = [str(name) for name in fit.groups["log_likelihood_left_out"][f"{EXPERIMENT}_level"].values]
    equal = _equal_draws(fit, labels)
    found = [_left_out(name, i, equal, equal) for i, name in enumerate(names)]
    sure = [one.reliable and one.pareto_k <= FINITE_VARIANCE for one in found]
    if not all(sure) and (reaching := _weighted_draws(fit, labels)) is not None:
        for i in np.flatnonzero(~np.array(sure)):
            new = _left_out(names[i], int(i), reaching, equal)
            found[i] = min(found[i], new, key=lambda one: (not one.reliable, one.error))
    if not refit or fit.problem is None:
        return found
    return [one if one.reliable else _refitted(fit, fit.problem, one) for one in found]


@dataclass(frozen=True)
class _Drawn:
    """Draws of the shared parameters, each ``(S,)``, ln of their weights, and ln p of each experiment, ``(S, experiments)``."""

    columns: dict[str, FloatArray]
    log_weights: FloatArray
    density: FloatArray
    correlation: float


def _refitted(fit: JointResult, problem: JointProblem, before: LeftOutExperiment) -> LeftOutExperiment:
    """The same from a posterior of all other experiments; ln p is the difference of the two ln Z."""
    from skinbayes.sampling.ensemble_engine import EnsembleEngine
    from skinbayes.sampling.options import SamplerOptions

    names = [name for name, count in problem.counts().items() for _ in range(count)]
    target = without_data(problem, np.array(names) != before.experiment).target()
    run = fit.provenance["sampling"]
    options = SamplerOptions(
        seed=int(run["seed"]),
        ess=REFIT_ESS,
        max_steps=REFIT_STEPS,
        importance=True,
        expensive=problem.expensive,
    )
    draws = EnsembleEngine().run(target, options)
    whole, other = run.get("log_evidence"), draws.log_evidence
    if not draws.diagnostics["converged"] or not whole or other is None:
        return before
    theta = target.transform.inverse(draws.samples.reshape(-1, draws.dimension))
    logs = np.zeros(len(theta)) if draws.log_weights is None else draws.log_weights.reshape(-1)
    weights = np.exp(logs - logs.max())
    without = {label: _quantiles(theta[:, fit.names.index(label)], weights) for label in before.without}
    error = hypot(whole[1], other[1])
    return replace(
        before, elpd=whole[0] - other[0], error=error, reliable=True, without=without, refitted=True
    )


def _equal_draws(fit: JointResult, labels: list[str]) -> _Drawn:
    group = fit.groups["log_likelihood_left_out"]
    density = np.asarray(group[EXPERIMENT].values, dtype=float)
    flat = density.reshape(-1, density.shape[-1])
    # what is large is kept of some of the draws only
    columns = {label: _at(fit, label, group["draw"].values) for label in labels}
    sizes = [size for size in fit.provenance["sampling"].get("ess_bulk", []) if size and size > 0]
    return _Drawn(columns, np.zeros(len(flat)), flat, max(1.0, len(flat) / min([len(flat), *sizes])))


def _weighted_draws(fit: JointResult, labels: list[str]) -> _Drawn | None:
    """The engine's own draws, if they have weights and the model is at hand: they reach further out than the posterior."""
    if fit.problem is None or "weighted_posterior" not in fit.groups:
        return None
    group = fit.groups["weighted_posterior"]
    theta = np.asarray(group["theta"].values, dtype=float).reshape(-1, len(fit.names))
    log_weights = np.asarray(group["log_weight"].values, dtype=float).reshape(-1)
    possible = np.isfinite(log_weights)
    theta, log_weights = theta[possible], log_weights[possible]
    columns = {label: theta[:, fit.names.index(label)] for label in labels}
    return _Drawn(columns, log_weights, fit.problem.log_likelihood_left_out(theta), 1.0)


def _left_out(name: str, place: int, drawn: _Drawn, equal: _Drawn) -> LeftOutExperiment:
    other = reweighted(drawn.log_weights, -drawn.density[:, place], drawn.correlation)
    weights = np.exp(other.log_weights - other.log_weights.max())
    return LeftOutExperiment(
        name,
        -other.log_ratio,
        other.error,
        other.shape,
        other.reliable,
        {label: _quantiles(values, weights) for label, values in drawn.columns.items()},
        {label: _quantiles(values, np.ones(len(values))) for label, values in equal.columns.items()},
    )


def _at(fit: JointResult, label: str, kept: NDArray[np.intp]) -> FloatArray:
    """Draws of a parameter at those that are kept of each chain, chain after chain."""
    chains = fit.groups["posterior"].sizes["chain"]
    return fit.draws(label).reshape(chains, -1)[:, kept].reshape(-1)


def _quantiles(values: FloatArray, weights: FloatArray) -> tuple[float, ...]:
    return tuple(float(q) for q in weighted_quantiles(values, weights, LEVELS))
