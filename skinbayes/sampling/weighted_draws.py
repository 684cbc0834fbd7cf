"""Weighted draws of a target: rounds of several proposals, weighted as draws of the mixture of all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from skinbayes.arrays import FloatArray
from skinbayes.sampling.draws import weighted_quantiles
from skinbayes.sampling.search import FOUND_WITH, MISSED, Search
from skinbayes.sampling.stopping import TAIL_FRACTION
from skinbayes.statistics.pareto import smoothed
from skinbayes.statistics.student_mixture import StudentMixture, fit_mixture

Evaluate = Callable[[FloatArray], FloatArray]
"""Log-density at positions ``(B, D)``, −inf where impossible."""

POINTS = 2000
"""Explored positions of each ensemble that the mixture is fitted to."""

FEWEST_POINTS = 200
"""Effective number of draws from which the number of components is chosen anew."""

WIDE_WEIGHT, WIDE_VOLUME, LEAST_STRETCH, MOST_STRETCH = 0.2, 250.0, 1.3, 2.5
"""A component about the whole, of so many times its volume, gets this part of all draws; it is wider by a factor between two. Of
much more volume it would have hardly any draws where the weights become large."""

LEAST_SURPRISE = 10.0
"""Times the expected density that are no surprise however few draws there are."""

TAILS = np.array([0.05, 0.5, 0.95])
"""Quantiles in which ensembles and weighted draws have to agree."""


@dataclass(frozen=True)
class ImportanceDraws:
    """Weighted draws that were accepted.

    Attributes
    ----------
    positions : shape ``(N, D)``
    log_density : of the target, shape ``(N,)``
    log_weights : Pareto-smoothed, up to a constant, shape ``(N,)``
    log_proposal : ln of the density that they were drawn from, shape ``(N,)``
    proposals : what either half of them, every second one, was drawn from
    shape : k̂ of the weights
    ess, tail_ess : effective sample sizes of the mean, and the smaller of the 5 % and 95 % quantiles, of each coordinate
    search : what was looked for beside the draws; None if nothing was
    """

    positions: FloatArray
    log_density: FloatArray
    log_weights: FloatArray
    log_proposal: FloatArray
    proposals: tuple[StudentMixture, StudentMixture]
    shape: float
    ess: FloatArray
    tail_ess: FloatArray
    search: Search | None = None

    def lacking(self, ess: float) -> float:
        """How many times as many draws it takes for an effective sample size; at most 1 if these do."""
        return float(max(ess / self.ess.min(), TAIL_FRACTION * ess / self.tail_ess.min()))

    def surprise(self, positions: FloatArray, log_density: FloatArray) -> FloatArray:
        """By how much ln of the target exceeds what leaves no room for a part that these draws can miss, shape ``(n,)``."""
        ratios = self.log_density - self.log_proposal
        count = len(ratios)
        room = logsumexp(ratios) - np.log(count) + np.log(max(MISSED * count / FOUND_WITH, LEAST_SURPRISE))
        expected = StudentMixture.of(self.proposals, [1, 1]).log_density(positions)
        return np.asarray(log_density - expected - max(ratios.max(), room))


class Rounds:
    """Draws of several proposals, weighted as draws of their mixture.

    Attributes
    ----------
    mixture : what the next round is drawn from, but for a wide component
    positions, log_density : all draws, and the target there
    proposal, log_proposal : what all of them together were drawn from, and ln of its density there
    """

    def __init__(self, mixture: StudentMixture) -> None:
        self.mixture = mixture
        self.positions = np.empty((0, mixture.dimension))
        self.log_density = np.empty(0)
        self.proposal, self.log_proposal = mixture, np.empty(0)
        self._proposals: list[StudentMixture] = []
        self._counts: list[int] = []

    def draw(self, count: int, evaluate: Evaluate, rng: np.random.Generator) -> None:
        """Draw one more round."""
        proposal = _widened(self.mixture)
        new = proposal.draw(count, rng)
        self.positions = np.concatenate([self.positions, new])
        self.log_density = np.append(self.log_density, evaluate(new))
        self._proposals.append(proposal)
        self._counts.append(count)
        self.proposal = StudentMixture.of(self._proposals, self._counts)
        self.log_proposal = self.proposal.log_density(self.positions)

    def refitted(self, rng: np.random.Generator) -> StudentMixture:
        """The mixture fitted anew to the draws."""
        log_ratios = self.log_density - self.log_proposal
        weights = np.exp(log_ratios - log_ratios.max())
        count = len(weights)
        # draws with weights far above the others would teach the mixture themselves only
        weights = np.minimum(weights, weights.sum() / np.sqrt(count))
        if weights.sum() ** 2 / np.square(weights).sum() < FEWEST_POINTS:
            return self.mixture.refitted(self.positions, weights)
        # as many components as they can tell; a draw is in one half only
        part = rng.random(count) < 0.5
        first, second = (self._chosen(np.flatnonzero(chosen), weights, rng) for chosen in (part, ~part))
        return fit_mixture(first[0], second[0], rng, weights=(first[1], second[1]), known=self.mixture)

    def _chosen(
        self, rows: np.ndarray, weights: FloatArray, rng: np.random.Generator
    ) -> tuple[FloatArray, FloatArray]:
        """Some of the draws with their weights, or as many as a fit can use in no time, chosen by their weights."""
        if len(rows) <= POINTS:
            return self.positions[rows], weights[rows]
        chosen = rng.choice(rows, size=POINTS, p=weights[rows] / weights[rows].sum())
        return self.positions[chosen], np.ones(POINTS)


def _widened(mixture: StudentMixture) -> StudentMixture:
    stretch = np.clip(WIDE_VOLUME ** (1.0 / mixture.dimension), LEAST_STRETCH, MOST_STRETCH)
    return mixture.with_wide_component(WIDE_WEIGHT, float(stretch))


def weighed(sides: tuple[Rounds, Rounds]) -> ImportanceDraws:
    """The draws of two sequences of rounds with their weights and what these are worth."""
    proposals = (sides[0].proposal, sides[1].proposal)
    positions, log_density, log_proposal = (
        np.stack(pair, axis=1).reshape(-1, *pair[0].shape[1:])
        for pair in zip(
            *((side.positions, side.log_density, side.log_proposal) for side in sides), strict=True
        )
    )
    log_weights, shape, _ = smoothed(log_density - log_proposal)
    weights = np.exp(log_weights - log_weights.max())
    mean = weights @ positions / weights.sum()
    ends = np.array([weighted_quantiles(column, weights, TAILS[[0, 2]]) for column in positions.T])
    tails = np.array([_effective((positions <= ends[:, end]).astype(np.float64), weights) for end in (0, 1)])
    return ImportanceDraws(
        positions, log_density, log_weights, log_proposal, proposals, shape,
        _effective(positions - mean, weights), tails.min(axis=0),
    )  # fmt: skip


def _effective(values: FloatArray, weights: FloatArray) -> FloatArray:
    """Independent draws with which the mean of each column would be known as well, shape ``(D,)``."""
    apart = values - weights @ values / weights.sum()
    variance = weights @ np.square(apart) / weights.sum()
    error = np.square(weights) @ np.square(apart) / weights.sum() ** 2
    # squares of weights hundreds of powers of ten below the largest are 0: all rests on a single draw
    return np.divide(variance, error, out=np.ones_like(error), where=error > 0)
