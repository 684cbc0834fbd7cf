"""Evidence and posterior of a fit under priors of another width, from its draws, or sampled anew where these cannot tell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import hypot, inf

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.fit.result import FitResult, JointResult
from skinbayes.fit.sampled_anew import sampled_anew
from skinbayes.problem import JointProblem, Problem
from skinbayes.problem.other_priors import possible_range, priors_of, with_priors
from skinbayes.sampling.draws import weighted_quantiles
from skinbayes.statistics.priors import Prior
from skinbayes.statistics.reweighting import quantile_errors, reweighted
from skinbayes.statistics.widening import BOUNDED, LOGARITHMIC, factor_of_reach, widened

REFIT_STEPS = 1000
"""Steps after which sampling anew is given up."""

EDGE = 0.02
"""Part of the range of a prior next to one of its ends, from which is guessed how much of the posterior would lie beyond."""

LARGEST_TAIL = 0.02
"""Part of the posterior that may lie beyond an end that moves away."""


@dataclass(frozen=True)
class _Weighted:
    """Draws of the posterior under some priors: ``theta`` ``(N, D)``, their weights, and how ln Z changed to get there."""

    theta: FloatArray
    log_weights: FloatArray
    priors: tuple[Prior, ...]
    correlation: float = 1.0
    change: float = 0.0
    error: float = 0.0
    evidence: tuple[float, float] | None = None

    def quantiles(
        self, place: int, logarithmic: bool, probabilities: Sequence[float]
    ) -> tuple[FloatArray, FloatArray]:
        """Of one parameter, or its logarithm, and their standard errors."""
        values = np.log(self.theta[:, place]) if logarithmic else self.theta[:, place]
        weights = np.exp(self.log_weights - self.log_weights.max())
        errors = quantile_errors(values, weights, probabilities) * np.sqrt(self.correlation)
        return weighted_quantiles(values, weights, probabilities), errors


@dataclass(frozen=True)
class UnderOtherPriors:
    """What becomes of evidence and posterior.

    Attributes
    ----------
    change, error : of ln of the evidence, and its standard error
    pareto_k : of the weights
    reliable : whether these numbers can be trusted
    refitted : whether they are of draws that were made for these priors
    held : ends of priors that cannot move as far, each in words; parameters whose prior has no other width
    """

    change: float = 0.0
    error: float = inf
    pareto_k: float = inf
    reliable: bool = False
    refitted: bool = False
    held: tuple[str, ...] = ()
    draws: _Weighted | None = field(default=None, repr=False, compare=False)


class OtherPriors:
    """A fit, asked about other priors.

    With weights p'/p a draw of the posterior under p is one under p', and the mean weight is the ratio of the evidences. Where
    draws come from importance sampling, the weights they have already are multiplied: they reach further than the posterior. A
    posterior under wider priors, sampled anew, tells by the same weights about narrower ones.

    Parameters
    ----------
    fit : any fit whose model and data are at hand
    refit : sample anew where the draws cannot tell
    seed : of what is sampled anew

    Raises
    ------
    InputError
        Model or data of the fit are gone.
    """

    def __init__(self, fit: FitResult | JointResult, refit: bool = False, seed: int = 1) -> None:
        if fit.problem is None:
            raise InputError(
                f"'{fit.name}': its model or data are gone, so that its priors cannot be changed"
            )
        self.problem: Problem | JointProblem = fit.problem
        self.priors = priors_of(self.problem)
        self.own = _own_draws(fit, self.priors)
        self._refit, self._seed = refit, seed
        self._bases: dict[frozenset[str], list[_Weighted]] = {}
        self._known: dict[tuple[frozenset[tuple[str, float]], bool], UnderOtherPriors] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """Labels of the free parameters."""
        return self.problem.names

    def prior(self, label: str) -> Prior:
        """The prior of a parameter."""
        return self.priors[self.names.index(label)]

    def logarithmic(self, label: str) -> bool:
        """Whether the prior of a parameter is stated for its logarithm."""
        return self.prior(label).family in LOGARITHMIC

    def under(self, factors: Mapping[str, float], refit: bool = True) -> UnderOtherPriors:
        """Evidence and posterior with priors of some parameters so many times as wide.

        ``refit`` False takes the draws that there are, whatever was said at the beginning.
        """
        key = (frozenset(factors.items()), refit and self._refit)
        if key not in self._known:
            self._known[key] = self._found(factors, refit and self._refit)
        return self._known[key]

    def factors(self, labels: Sequence[str], reach: float) -> dict[str, float]:
        """How many times as wide priors become whose ends are moved out by a factor, see :func:`factor_of_reach`."""
        return {label: factor_of_reach(self.prior(label), reach) for label in labels}

    def quantiles(
        self, found: UnderOtherPriors | None, label: str, probabilities: Sequence[float]
    ) -> tuple[FloatArray, FloatArray]:
        """Posterior quantiles of a parameter and their standard errors; of the fit itself for None.

        They are those of its logarithm where its prior is stated for that.
        """
        draws = self.own if found is None else found.draws
        assert draws is not None
        return draws.quantiles(self.names.index(label), self.logarithmic(label), probabilities)

    def _found(self, factors: Mapping[str, float], refit: bool) -> UnderOtherPriors:
        wanted, held = list(self.priors), []
        for label, factor in factors.items():
            place = self.names.index(label)
            try:
                wanted[place] = widened(self.priors[place], factor, *possible_range(self.problem, label))
            except InputError:  # cut-offs would leave nothing
                return UnderOtherPriors(held=(f"the prior of {label}",))
            held += _held(label, self.priors[place], wanted[place], factor)
        priors, start = tuple(wanted), UnderOtherPriors(held=tuple(held))
        bases = self._bases.setdefault(frozenset(factors), [])
        tried = [self._from(base, priors, start) for base in (self.own, *bases)]
        if refit and not any(found.reliable for found in tried):
            new = self._sampled(priors)
            if new is not None:
                bases.append(new)
                tried.append(self._from(new, priors, start))
        return min(tried, key=lambda found: (not found.reliable, found.error))

    def _from(self, base: _Weighted, priors: tuple[Prior, ...], start: UnderOtherPriors) -> UnderOtherPriors:
        ratios, beyond = np.zeros(len(base.theta)), 0.0
        for place, (old, new) in enumerate(zip(base.priors, priors, strict=True)):
            if old != new:
                ratios += new.log_density(base.theta[:, place]) - old.log_density(base.theta[:, place])
                beyond += _beyond(base, place, old, new)
        found = reweighted(base.log_weights, ratios, base.correlation)
        return replace(
            start,
            change=base.change + found.log_ratio,
            error=hypot(base.error, found.error, beyond),
            pareto_k=found.shape,
            reliable=found.reliable and beyond <= LARGEST_TAIL,
            refitted=base is not self.own,
            draws=replace(base, log_weights=found.log_weights, priors=priors),
        )

    def _sampled(self, priors: tuple[Prior, ...]) -> _Weighted | None:
        """The posterior under other priors, sampled anew; None if that did not converge or fails."""
        try:
            found = sampled_anew(with_priors(self.problem, priors), seed=self._seed, max_steps=REFIT_STEPS)
        except InputError:
            return None
        if not found.converged:
            return None
        made = _weighted(found.theta, found.log_weights, priors, found.evidence, [found.ess])
        back = self._from(made, self.priors, UnderOtherPriors())
        if back.reliable:
            return replace(made, change=-back.change, error=back.error)
        if self.own.evidence is None or made.evidence is None:
            return None
        (before, its_error), (after, error) = self.own.evidence, made.evidence
        return replace(made, change=after - before, error=hypot(its_error, error))


def _held(label: str, old: Prior, new: Prior, factor: float) -> list[str]:
    """What of a prior did not become as wide as was asked for, in words."""
    if old == new:
        return [f"the prior of {label}"]
    if old.family not in BOUNDED:
        return []
    free = widened(old, factor)
    return [
        f"the {name} end of {label}"
        for name, place in (("lower", 0), ("upper", 1))
        if not np.isclose(free.support[place], new.support[place], rtol=1e-9)
    ]


def _beyond(base: _Weighted, place: int, old: Prior, new: Prior) -> float:
    """Part of the posterior beyond ends of a prior that move outwards, at most, if its density goes on falling there.

    From how it falls near the end: the last two pieces of the range hold a and b, so that the next ones would hold a·(a/b),
    a·(a/b)², … of a density whose logarithm is concave, and no more than a each.
    """
    if old.family not in BOUNDED:
        return 0.0
    logs = old.family == "loguniform"
    values, ends = base.theta[:, place], np.array([old.support, new.support])
    x, ((low, high), (new_low, new_high)) = (np.log(values), np.log(ends)) if logs else (values, ends)
    weights = np.exp(base.log_weights - base.log_weights.max())
    piece, total = EDGE * (high - low), 0.0
    for distance, further in ((x - low, low - new_low), (high - x, new_high - high)):
        if further > 0.0:
            pieces = [weights[(distance >= i * piece) & (distance < (i + 1) * piece)].sum() for i in (0, 1)]
            last, before = (part / weights.sum() for part in pieces)
            series = last**2 / (before - last) if before > last else inf if last > 0 else 0.0
            total += min(series, last * further / piece)
    return float(total)


def _own_draws(fit: FitResult | JointResult, priors: tuple[Prior, ...]) -> _Weighted:
    sampling = fit.provenance["sampling"]
    evidence = sampling.get("log_evidence")
    found: tuple[float, float] | None = None if evidence is None else (evidence[0], evidence[1])
    if (weighted := fit.groups.get("weighted_posterior")) is not None:
        theta = weighted["theta"].values.reshape(-1, len(priors))
        return _weighted(theta, weighted["log_weight"].values.reshape(-1), priors, found)
    return _weighted(fit.theta(), None, priors, found, sampling.get("ess_bulk", []))


def _weighted(
    theta: FloatArray,
    log_weights: FloatArray | None,
    priors: tuple[Prior, ...],
    evidence: tuple[float, float] | None,
    sizes: Sequence[float] = (),
) -> _Weighted:
    """Draws with weights, which are independent, or of equal weight with the effective sample sizes of their parameters."""
    if log_weights is not None:
        # a proposal reaches beyond the ends of priors; what lies there has no weight, and no ratio of densities
        counts = np.isfinite(log_weights)
        return _Weighted(theta[counts], log_weights[counts], priors, evidence=evidence)
    least = min((size for size in sizes if size > 0), default=len(theta))
    return _Weighted(theta, np.zeros(len(theta)), priors, max(1.0, len(theta) / least), evidence=evidence)
