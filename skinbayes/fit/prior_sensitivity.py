"""What would change with other priors: evidence and posterior with each half and twice as wide; and who speaks, prior or data."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from math import hypot, log
from typing import Any, Literal

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.diagnose import PriorUpdate, prior_updates
from skinbayes.files.population_block import DEVIATE
from skinbayes.fit.arviz_adapter import power_scaling
from skinbayes.fit.other_priors import OtherPriors, UnderOtherPriors
from skinbayes.fit.result import FitResult, JointResult
from skinbayes.phrases import and_list
from skinbayes.statistics.transforms import VectorTransform

Progress = Callable[[int, int], None]
"""Called with the number of changed priors done and their total."""

Speaks = Literal["data", "both", "conflict", "others", "prior"]

FACTORS = (0.5, 2.0)
"""How many times as wide priors are made."""

THRESHOLD = 0.05
"""Power-scaling sensitivity from which prior or likelihood count as informative; of the source in :func:`power_scaling`."""

FAR = 0.1
"""A posterior median in this tail of a prior lies where the prior did not expect it."""

LARGE_SHIFT, LARGE_STRETCH = 0.3, 1.2
"""Shifts of medians, in standard deviations, and ratios of widths that are worth a sentence."""


@dataclass(frozen=True)
class ChangedPrior:
    """Evidence and posterior with other priors.

    Attributes
    ----------
    labels : parameters whose priors were made wider or narrower
    factor : how many times as wide
    log_evidence_change, error : of ln of the evidence, and its standard error
    shifts : of the median of each parameter, in standard deviations of its posterior, and its standard error; of its logarithm,
        where its prior is stated for that
    width_ratios : of the 90 % interval of each parameter, in the same terms, to what it was, and its standard error
    pareto_k : of the weights
    reliable : whether these numbers can be trusted; shifts and widths are empty otherwise
    refitted : whether the model was sampled anew
    held : what could not be made as wide, in words
    """

    labels: tuple[str, ...]
    factor: float
    log_evidence_change: float
    error: float
    shifts: dict[str, tuple[float, float]]
    width_ratios: dict[str, tuple[float, float]]
    pareto_k: float
    reliable: bool
    refitted: bool
    held: tuple[str, ...]

    @property
    def furthest(self) -> tuple[str, float, float]:
        """The parameter whose median moves most, how far, and the standard error; no name and 0 if unknown."""
        return _extreme(self.shifts, 0.0, abs)

    @property
    def stretched(self) -> tuple[str, float, float]:
        """The parameter whose interval changes its width most, its ratio, and the standard error; no name and 1 if unknown."""
        return _extreme(self.width_ratios, 1.0, lambda ratio: abs(log(ratio)))


def _extreme(
    found: dict[str, tuple[float, float]], nothing: float, size: Callable[[float], float]
) -> tuple[str, float, float]:
    name = max(found, key=lambda label: size(found[label][0]), default="")
    return (name, *found.get(name, (nothing, 0.0)))


@dataclass(frozen=True)
class Informed:
    """Who speaks about a parameter.

    Attributes
    ----------
    name : the parameter
    prior, likelihood : power-scaling sensitivities of its posterior to all priors and to the likelihood
    speaks : ``"data"``; ``"both"`` prior and data; ``"conflict"`` if both do, and the posterior median lies in a tail of the
        prior; ``"others"`` if the data narrow it down, but only together with others, whose priors say how far; ``"prior"`` if
        the data leave it as it was
    """

    name: str
    prior: float
    likelihood: float
    speaks: Speaks


@dataclass(frozen=True)
class PriorSensitivity:
    """What a fit owes to its priors.

    Attributes
    ----------
    model : name
    changed : each prior half and twice as wide, in the order of the parameters; all together at the end
    informed : who speaks about each parameter
    """

    model: str
    changed: tuple[ChangedPrior, ...]
    informed: tuple[Informed, ...]

    def sentences(self) -> list[str]:
        """The findings in words, parameters by their names."""
        return [*self._on_parameters(), *self._on_posterior(), *self._on_evidence(), *self._on_limits()]

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        return asdict(self) | {"sentences": self.sentences()}

    def of(self, labels: Sequence[str], factor: float) -> ChangedPrior:
        """The entry for some parameters and a factor; KeyError if there is none."""
        for entry in self.changed:
            if entry.labels == tuple(labels) and entry.factor == factor:
                return entry
        raise KeyError((labels, factor))

    def _on_parameters(self) -> list[str]:
        by: dict[Speaks, list[str]] = {}
        for entry in self.informed:
            by.setdefault(entry.speaks, []).append(entry.name)
        said = []
        if names := by.get("prior"):
            said.append(f"Only the prior speaks about {and_list(names)}.")
        if names := by.get("others"):
            said.append(
                f"The data know {and_list(names)} together with other parameters only: how well is a matter of the priors, and "
                "more of the same data would hardly help."
            )
        if names := by.get("conflict"):
            said.append(
                f"Prior and data pull against each other in {and_list(names)}: both matter, and the posterior lies in a tail of "
                "the prior."
            )
        if names := by.get("both"):
            said.append(f"Both prior and data speak about {and_list(names)}.")
        if names := by.get("data"):
            said.append(
                f"The data speak about {and_list(names)}; a slightly other prior would not change it."
            )
        return said

    def _on_posterior(self) -> list[str]:
        known = [entry for entry in self._single() if entry.reliable]
        if not known:
            return []
        far = sorted(known, key=lambda entry: -abs(entry.furthest[1]))
        silent = [informed.name for informed in self.informed if informed.speaks == "prior"]
        heard = [entry for entry in known if entry.labels[0] not in silent]
        wide = sorted(heard, key=lambda entry: -abs(log(entry.stretched[1])))
        said = []
        for entry in far[:MOST_SAID]:
            name, shift, error = entry.furthest
            if abs(shift) >= max(LARGE_SHIFT, 2 * error):
                said.append(
                    f"With a prior of {entry.labels[0]} {_width(entry.factor)}, {_its('median', name, entry)} moves "
                    f"{'up' if shift > 0 else 'down'} by {abs(shift):.2f} ± {error:.2f} posterior standard deviations."
                )
        if not said:
            _, shift, error = far[0].furthest
            said.append(
                f"With single priors half or twice as wide no median moves by more than {abs(shift):.2f} ± {error:.2f} posterior "
                "standard deviations."
            )
        for entry in wide[:MOST_SAID]:
            name, ratio, error = entry.stretched
            if abs(log(ratio)) >= max(log(LARGE_STRETCH), 2 * error / ratio):
                said.append(
                    f"With a prior of {entry.labels[0]} {_width(entry.factor)}, {_its('90 % interval', name, entry)} is "
                    f"{ratio:.2f} ± {error:.2f} times as wide."
                )
        return said

    def _on_evidence(self) -> list[str]:
        known = [entry for entry in self._single() if entry.reliable]
        if not known:
            return []
        worst = max(known, key=lambda entry: abs(entry.log_evidence_change))
        said = (
            f"ln of the evidence changes by {worst.log_evidence_change:+.2f} at most when one prior is made half or twice as "
            f"wide (that of {worst.labels[0]}, {_width(worst.factor)})"
        )
        together = [e for e in self.changed if len(e.labels) > 1 and e.reliable]
        several = [f"{e.log_evidence_change:+.2f} with all {_width(e.factor)}" for e in together]
        return [f"{said}{''.join(f', by {part}' for part in several)}."]

    def _on_limits(self) -> list[str]:
        held = list(dict.fromkeys(text for entry in self.changed for text in entry.held))
        said = []
        if held:
            said.append(f"What was not made as wide, because it cannot be: {and_list(held)}.")
        unknown = [
            f"{'all priors' if len(entry.labels) > 1 else entry.labels[0]} {_width(entry.factor)}"
            for entry in self.changed
            if not entry.reliable
        ]
        if unknown:
            said.append(
                f"These draws cannot tell what would change with {and_list(unknown)}: too few of them lie where that posterior "
                "would be."
            )
        again = sum(entry.refitted for entry in self.changed)
        if again:
            said.append(f"For {again} of these {len(self.changed)} changes the model was sampled anew.")
        return said

    def _single(self) -> list[ChangedPrior]:
        return [entry for entry in self.changed if len(entry.labels) == 1]


MOST_SAID = 3
"""Changes of medians, and of widths, that get a sentence each."""


def _its(what: str, name: str, entry: ChangedPrior) -> str:
    return f"its {what}" if name == entry.labels[0] else f"the {what} of {name}"


def _width(factor: float) -> str:
    return {0.5: "half as wide", 2.0: "twice as wide"}.get(factor, f"{factor:g} times as wide")


def prior_sensitivity(
    fit: FitResult | JointResult, refit: bool = False, progress: Progress | None = None
) -> PriorSensitivity:
    """Find out what a fit owes to its priors, see :meth:`skinbayes.Fit.prior_sensitivity`."""
    other = OtherPriors(fit, refit)
    # that people are drawn from a population is the model, not a prior that could be wider
    groups: list[tuple[str, ...]] = [(name,) for name in fit.shown_names]
    if len(groups) > 1:
        groups.append(fit.shown_names)
    wanted = [(labels, factor) for labels in groups for factor in FACTORS]
    changed = []
    for done, (labels, factor) in enumerate(wanted):
        if progress is not None:
            progress(done, len(wanted))
        found = other.under(dict.fromkeys(labels, factor))
        changed.append(_changed(other, labels, factor, found))
    if progress is not None:
        progress(len(wanted), len(wanted))
    return PriorSensitivity(fit.name, tuple(changed), _informed(fit, other))


PROBABILITIES = (0.05, 0.1587, 0.5, 0.8413, 0.95)
"""Of a normal distribution the second and fourth lie one standard deviation from the median."""


def _changed(
    other: OtherPriors, labels: tuple[str, ...], factor: float, found: UnderOtherPriors
) -> ChangedPrior:
    shifts, widths = {}, {}
    for label in (n for n in other.names if n.partition("[")[0] != DEVIATE) if found.reliable else ():
        (before, _), (after, errors) = (other.quantiles(x, label, PROBABILITIES) for x in (None, found))
        spread, width = (before[3] - before[1]) / 2, before[4] - before[0]
        shifts[label] = float((after[2] - before[2]) / spread), float(errors[2] / spread)
        widths[label] = float((after[4] - after[0]) / width), float(hypot(errors[0], errors[4]) / width)
    return ChangedPrior(
        labels, factor, found.change, found.error, shifts, widths, found.pareto_k, found.reliable,
        found.refitted, found.held,
    )  # fmt: skip


def _informed(fit: FitResult | JointResult, other: OtherPriors) -> tuple[Informed, ...]:
    """Power-scaling, each prior taken as a density of the logarithm where it is stated for that."""
    theta, logs = fit.theta(), [other.logarithmic(name) for name in other.names]
    log_prior, log_likelihood = _densities(fit, other, theta)
    log_x = np.log(np.where(logs, theta, 1.0))
    found = power_scaling(np.where(logs, log_x, theta), log_prior + log_x.sum(axis=1), log_likelihood)
    transform = VectorTransform(other.problem.target().transform.transforms)
    updates = prior_updates(other.names, fit.theta("prior"), theta, transform)
    return tuple(
        Informed(update.name, float(prior), float(likelihood), _speaks(prior, likelihood, update))
        for update, prior, likelihood in zip(updates, found["prior"], found["likelihood"], strict=True)
        if update.name in fit.shown_names
    )


def _speaks(prior: float, likelihood: float, update: PriorUpdate) -> Speaks:
    if likelihood < THRESHOLD:
        if update.verdict in ("not updated", "moved"):
            return "prior"
        return "others" if prior >= THRESHOLD else "data"
    if prior < THRESHOLD:
        return "data"
    return "both" if FAR <= update.prior_quantile <= 1 - FAR else "conflict"


def _densities(
    fit: FitResult | JointResult, other: OtherPriors, theta: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """ln of prior and likelihood at the kept draws: the likelihood is what prior and Jacobian leave of the stored density."""
    log_prior = other.problem.log_prior(theta)
    transform = other.problem.target().transform
    density = fit.groups["sample_stats"]["lp"].values.reshape(-1)
    return log_prior, density - log_prior - transform.log_jacobian(transform.forward(theta))
