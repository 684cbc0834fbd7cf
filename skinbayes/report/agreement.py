"""Whether experiments on one skin agree: each against what all others say about the parameters that they share."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.files.joint_model import EXPERIMENT
from skinbayes.phrases import and_list
from skinbayes.plot.numbers import interval, quantity
from skinbayes.sampling.draws import weighted_quantiles
from skinbayes.statistics.reweighting import reweighted

if TYPE_CHECKING:
    from skinbayes.fit import JointFit

LEVELS = (0.05, 0.5, 0.95)


@dataclass(frozen=True)
class LeftOutExperiment:
    """What the other experiments say without one of them.

    Attributes
    ----------
    experiment : that is left out
    elpd : ln p(its data | the data of the others)
    error : standard error of ``elpd``, of Monte Carlo
    pareto_k : of the weights of the draws
    reliable : whether weights can tell; if not, only a fit without it can
    without, all : 5, 50 and 95 % quantiles of each shared parameter without the experiment, and with all of them, SI
    """

    experiment: str
    elpd: float
    error: float
    pareto_k: float
    reliable: bool
    without: dict[str, tuple[float, ...]]
    all: dict[str, tuple[float, ...]]

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


def shared_labels(fit: JointFit) -> list[str]:
    """Free parameters that more than one experiment has."""
    places = [place for told in fit.provenance["experiments"].values() for place in told["places"]]
    return [label for i, label in enumerate(fit.names) if places.count(i) > 1]


def left_out_experiments(fit: JointFit) -> list[LeftOutExperiment]:
    """Each experiment left out in turn, by weights 1/p(its data | θ) of the draws: nothing is sampled anew.

    Parameters
    ----------
    fit : of several experiments

    Returns
    -------
    list
        One entry for each experiment; none if they share no parameter, so that they cannot disagree.
    """
    labels = shared_labels(fit)
    if not labels:
        return []
    group = fit.groups["log_likelihood_left_out"][EXPERIMENT]
    density = np.asarray(group.values, dtype=float)
    flat = density.reshape(-1, density.shape[-1])
    # the draws of equal weight; what differs by row is kept of some of them only
    columns = {label: _at(fit, label, group["draw"].values) for label in labels}
    sizes = [size for size in fit.provenance["sampling"].get("ess_bulk", []) if size and size > 0]
    correlation = max(1.0, len(flat) / min([len(flat), *sizes]))
    found = []
    for i, name in enumerate(group[f"{EXPERIMENT}_level"].values):
        other = reweighted(np.zeros(len(flat)), -flat[:, i], correlation)
        weights = np.exp(other.log_weights - other.log_weights.max())
        found.append(
            LeftOutExperiment(
                str(name),
                -other.log_ratio,
                other.error,
                other.shape,
                other.reliable,
                {label: _quantiles(values, weights) for label, values in columns.items()},
                {label: _quantiles(values, np.ones(len(flat))) for label, values in columns.items()},
            )
        )
    return found


def agreement_sentences(fit: JointFit) -> list[str]:
    """What the experiments say about each other, in words."""
    labels, found = shared_labels(fit), left_out_experiments(fit)
    if not labels:
        return ["The experiments share no free parameter, so that they cannot disagree about one."]
    said = [f"Informed by more than one experiment: {and_list([fit.symbol(label) for label in labels])}."]
    for one in found:
        if not one.reliable:
            said.append(
                f"{one.experiment}: it says so much that the draws cannot tell what the others would say without it "
                f"(Pareto k {one.pareto_k:.2f}). Fit it alone, and the others without it, or let compare leave it out by "
                "sampling anew."
            )
            continue
        values = [
            f"{fit.symbol(label)} = {quantity(middle, fit.unit(label))} "
            f"(90 %: {interval(low, high, fit.unit(label), typical=middle)}), with it "
            f"{quantity(one.all[label][1], fit.unit(label))} "
            f"({interval(one.all[label][0], one.all[label][2], fit.unit(label), typical=middle)})"
            for label, (low, middle, high) in one.without.items()
        ]
        said.append(
            f"{one.experiment}: without it the others say {'; '.join(values)}. ln of the probability that they give to its data "
            f"is {one.elpd:.2f} ± {one.error:.2f}."
        )
        if one.pulls:
            said.append(
                f"{one.experiment} DISAGREES with the others about {and_list([fit.symbol(label) for label in one.pulls])}: with "
                "it the median leaves the 90 % interval without it. Do not use the joint value before it is clear why."
            )
    return said


def _at(fit: JointFit, label: str, kept: NDArray[np.intp]) -> FloatArray:
    """Draws of a parameter at those that are kept of each chain, chain after chain."""
    chains = fit.groups["posterior"].sizes["chain"]
    return fit.draws(label).reshape(chains, -1)[:, kept].reshape(-1)


def _quantiles(values: FloatArray, weights: FloatArray) -> tuple[float, ...]:
    return tuple(float(q) for q in weighted_quantiles(values, weights, LEVELS))
