"""One simulation: a truth from the prior, data made with it, a fit of these data, and where the truth lies in its result."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from math import isfinite
from time import process_time
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import logsumexp

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError, MachineError
from skinbayes.fit.run import sample
from skinbayes.problem.joint import JointProblem
from skinbayes.problem.simulated import draw_possible, with_data
from skinbayes.statistics.uniformity import random_rank

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit
    from skinbayes.problem import Problem

LEVELS = (0.5, 0.9)
"""Probability of the central intervals whose coverage is counted."""

RANKED_DRAWS = 199
"""Draws of a posterior among which the truth gets its rank, so that there are 200 ranks; a fit has ten times as many that are
independent."""

PRIOR_DRAWS = 20_000
"""Draws of the prior whose mean likelihood is the evidence once more, by means that share nothing with the sampler."""

TRIALS = 10_000
"""Draws of the prior that are tried for one whose data can be predicted."""


@dataclass(frozen=True)
class FitOutcome:
    """What became of one fit.

    Attributes
    ----------
    converged : whether the stopping rule was met
    failure : the error that it ended with, empty if there was none
    log_evidence : ln Z with its standard error, None if it is not known
    reference : the same from the mean likelihood of draws of the prior, None where it was not computed
    """

    converged: bool
    failure: str = ""
    log_evidence: tuple[float, float] | None = None
    reference: tuple[float, float] | None = None


@dataclass(frozen=True)
class Simulated:
    """One simulation. Values of parameters stand in their order; those of a fit that ended in an error are missing.

    Attributes
    ----------
    number : of the simulation, from 0
    model : which of the models made the data
    truth : parameters that the data were made with, SI
    fits : of each model
    ranks : of the truth among posterior draws, for each parameter and then for ln of the likelihood of all data
    inside : for each of :data:`LEVELS` whether the central interval of the result holds the truth
    z_scores : posterior mean less truth, over the posterior standard deviation, where the parameter has no bounds
    contraction : 1 less the ratio of posterior to prior variance, there
    again : draws of the prior for which the forward model could not predict the data, before this one
    seconds : of this process
    """

    number: int
    model: int
    truth: list[float]
    fits: list[FitOutcome]
    ranks: list[int] = field(default_factory=list)
    inside: list[list[bool]] = field(default_factory=list)
    z_scores: list[float] = field(default_factory=list)
    contraction: list[float] = field(default_factory=list)
    again: int = 0
    seconds: float = 0.0

    @property
    def converged(self) -> bool:
        """Whether all fits met their stopping rule."""
        return all(one.converged for one in self.fits)

    def to_dict(self) -> dict[str, Any]:
        """What JSON can hold."""
        return asdict(self)

    @classmethod
    def from_dict(cls, entry: Mapping[str, Any]) -> Simulated:
        """The inverse of :meth:`to_dict`."""
        fits = [
            FitOutcome(
                bool(one["converged"]),
                str(one["failure"]),
                _pair(one["log_evidence"]),
                _pair(one["reference"]),
            )
            for one in entry["fits"]
        ]
        return cls(**{**entry, "fits": fits})


def _pair(value: Any) -> tuple[float, float] | None:
    return None if value is None else (float(value[0]), float(value[1]))


@dataclass(frozen=True)
class Simulation:
    """Makes simulation after simulation; its result depends on the number of the simulation and on what stands here alone.

    Attributes
    ----------
    problems : models of the same data, one or two; each is as likely to have made the data
    seed : non-negative integer
    options : of :func:`skinbayes.sample`
    """

    problems: tuple[Problem | JointProblem, ...]
    seed: int
    options: Mapping[str, Any]

    def __call__(self, number: int) -> Simulated:
        """Draw a truth, simulate, fit, and look where the truth lies."""
        started = process_time()
        rng = np.random.default_rng([self.seed, number])
        model, truth, again = self._truth(rng)
        data = self.problems[model].simulate(truth, rng)
        fits, found = [], None
        for place, problem in enumerate(self.problems):
            simulated = with_data(problem, data)
            fit, outcome = self._fitted(simulated, number)
            fits.append(outcome)
            if place == model and fit is not None:
                found = _where(fit, simulated, truth, np.random.default_rng([self.seed, number, 2]))
        return Simulated(
            number,
            model,
            truth.tolist(),
            fits,
            **(found or {}),
            again=again,
            seconds=process_time() - started,
        )

    def _truth(self, rng: np.random.Generator) -> tuple[int, FloatArray, int]:
        for again in range(TRIALS):
            # the model anew too: one whose prior holds more that cannot be is as much less likely as its evidence is smaller
            model = int(rng.integers(len(self.problems)))
            truth = draw_possible(self.problems[model], rng)
            if truth is not None:
                return model, truth, again
        raise InputError(
            f"{self.problems[0].spec.path}: the forward model cannot predict the data for any of {TRIALS} draws of the prior"
        )

    def _fitted(
        self, problem: Problem | JointProblem, number: int
    ) -> tuple[Fit | JointFit | None, FitOutcome]:
        seed = int(np.random.SeedSequence([self.seed, number, 1]).generate_state(1)[0])
        try:
            fit = sample(problem, seed=seed, **self.options)
        except (MachineError, MemoryError):
            raise  # says nothing about the model
        except Exception as error:  # whatever it is: it is counted, and said
            return None, FitOutcome(False, f"{type(error).__name__}: {error}"[:500])
        evidence = fit.provenance["sampling"]["log_evidence"]
        known = evidence is not None and all(isfinite(value) for value in evidence)
        reference = None
        if known and not problem.expensive:
            reference = _mean_likelihood(problem, np.random.default_rng([self.seed, number, 3]))
        return fit, FitOutcome(fit.converged, "", _pair(evidence) if known else None, reference)


def _where(
    fit: Fit | JointFit, problem: Problem | JointProblem, truth: FloatArray, rng: np.random.Generator
) -> dict[str, Any]:
    """Where the truth lies in a result."""
    draws = fit.theta()
    # those of a fit are nearly independent and in the order of time; evenly spaced ones are further apart
    chosen = draws[np.linspace(0, len(draws) - 1, RANKED_DRAWS).round().astype(int)]
    density = problem.log_likelihood(np.vstack([chosen, truth]))
    quantities = np.column_stack([chosen, density[:-1]])
    ends = [
        np.array([fit.quantiles(name, [(1 - level) / 2, (1 + level) / 2]) for name in fit.names])
        for level in LEVELS
    ]
    to_line = problem.target().transform.forward
    line, before, there = to_line(draws), to_line(fit.theta("prior")), to_line(truth[np.newaxis])[0]
    mean, variance = line.mean(axis=0), line.var(axis=0)
    return {
        "ranks": [
            random_rank(value, quantities[:, place], rng) for place, value in enumerate([*truth, density[-1]])
        ],
        "inside": [((end[:, 0] <= truth) & (truth <= end[:, 1])).tolist() for end in ends],
        "z_scores": ((mean - there) / np.sqrt(variance)).tolist(),
        "contraction": (1.0 - variance / before.var(axis=0)).tolist(),
    }


def _mean_likelihood(problem: Problem | JointProblem, rng: np.random.Generator) -> tuple[float, float] | None:
    """ln Z and its standard error from draws of the prior."""
    density = problem.log_likelihood(problem.draw_prior(rng, PRIOR_DRAWS))
    weights = density - logsumexp(density)
    size = float(np.exp(-logsumexp(2.0 * weights)))
    if not size > 1.0:
        return None
    return float(logsumexp(density) - np.log(PRIOR_DRAWS)), float(np.sqrt(1.0 / size - 1.0 / PRIOR_DRAWS))
