"""Independent draws by importance sampling, from proposals fitted to ensembles that have found the posterior.

A walker needs tens of evaluations for an independent draw; a proposal that has the shape of the posterior needs one or two.
The proposal is a mixture of Student t distributions, fitted to one half of the ensembles and examined with the other. Rounds of
draws improve it, and all of them count, weighted as draws of the mixture of all proposals (adaptive multiple importance sampling,
Cornuet et al. 2012, doi 10.1111/j.1467-9469.2011.00756.x). Draws are likelier under a proposal that was fitted to them than fresh
ones are, and ln Z of a normal distribution in 20 dimensions came out 0.02, four standard errors, too low so. There are therefore
two sequences of rounds side by side: the proposals of one are fitted to draws of the other. The draws are given up where anything
speaks against them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.special import log_expit, logsumexp, stdtrit

from skinbayes.arrays import FloatArray
from skinbayes.sampling.draws import weighted_quantiles
from skinbayes.sampling.search import EXPLORATIONS, Search
from skinbayes.sampling.stuck_walkers import left_behind
from skinbayes.sampling.weighted_draws import POINTS, TAILS, Evaluate, ImportanceDraws, Rounds, weighed
from skinbayes.statistics.pareto import pareto_shape
from skinbayes.statistics.student_mixture import StudentMixture, fit_mixture

ROUNDS = 12
"""Rounds of draws at most."""

REFUSALS = 3
"""Times that enough draws are refused before they are given up: what still speaks against them more draws do not cure."""

GROWTH = 1.5
"""A round has so many times as many draws as the one before, or fewer if that is enough."""

WORTHWHILE = 0.03
"""Effective draws for each evaluation that are worth to begin with; walkers give as many."""

EXPLORED_WEIGHT = 0.2
"""Part of the next draws that a place gets that was missed and then explored."""

LARGEST_SHAPE = 0.5
"""Largest k̂ of the weights, and of those below and above the median of each coordinate, at which draws are accepted."""


class Refusal(NamedTuple):
    """Why draws were not accepted.

    Attributes
    ----------
    why : a sentence
    tried : how many were made
    pending : the attempt, if ensembles that have moved on may change the verdict on the same draws
    """

    why: str
    tried: int
    pending: Attempt | None = None


def importance_draws(
    explored: FloatArray,
    explored_density: FloatArray,
    evaluate: Evaluate,
    ess: float,
    rng: np.random.Generator,
    least: int = 0,
    agree: bool = True,
    search: Search | None = None,
) -> ImportanceDraws | Refusal:
    """Draw from a target that ensembles have explored.

    Parameters
    ----------
    explored : positions after burn-in, shape ``(ensembles, n, D)``, consecutive ones correlated
    explored_density : their log-density, shape ``(ensembles, n)``
    evaluate : the target
    ess : effective sample size wanted in every coordinate; a quarter of it in the quantiles
    rng : source of all randomness
    least : number of draws that are made at least
    agree : whether the ensembles agree; if not, the mixture is fitted to and examined with every second position of each
    search : looks for what ensembles and proposals have missed; None does not look

    Returns
    -------
    the draws, or why there are none
    """
    visited = list(map(_visited, explored, explored_density))
    # a walker, or a whole ensemble, that is left behind in a place of next to no posterior is no draw of it
    usual = max(float(np.median(density)) for _, density in visited)
    near = [~left_behind(density, explored.shape[-1], usual) for _, density in visited]
    points = [place[good] for (place, _), good in zip(visited, near, strict=True)]
    densities = [density[good] for (_, density), good in zip(visited, near, strict=True)]
    agree = agree and min(map(len, points)) > 0
    half = len(points) // 2
    if agree:
        first, second = np.concatenate(points[:half]), np.concatenate(points[half:])
        held_out = np.concatenate(densities[half:])
    else:
        first, second = (np.concatenate([one[start::2] for one in points]) for start in (0, 1))
    mixture = fit_mixture(first, second, rng)
    # positions of ensembles in different modes are no draws of the target, and foresee nothing
    if agree and (foreseen := _foreseen(held_out - mixture.log_density(second))) < WORTHWHILE:
        return Refusal(f"a proposal would give {foreseen:.2g} effective draws for each evaluation", 0)
    everything = np.concatenate([first, second])
    mixture = mixture.refitted(everything, np.ones(len(everything)))
    return Attempt(mixture, evaluate, search, rng).go_on(explored, explored_density, ess, least)


class Attempt:
    """Rounds of draws, until they are enough and nothing speaks against them, or they are given up.

    Where only the quantiles of the ensembles do, which may not have come to their ends yet, the attempt can be gone on with when
    the ensembles have moved: no draw is made in vain.
    """

    def __init__(
        self, mixture: StudentMixture, evaluate: Evaluate, search: Search | None, rng: np.random.Generator
    ) -> None:
        self._begun, self._evaluate, self._search, self._rng = mixture, evaluate, search, rng
        (self._searching,) = rng.spawn(1)  # draws are the same whatever was searched
        self._sides = (Rounds(mixture), Rounds(mixture))
        self._size = max(200, 30 * mixture.dimension)
        self._parts: StudentMixture | None = None
        self._beside: list[tuple[FloatArray, FloatArray]] = []
        self._looked = self._false_alarm = False

    def go_on(
        self, explored: FloatArray, explored_density: FloatArray, ess: float, least: int = 0
    ) -> ImportanceDraws | Refusal:
        """Draw on, and hold the draws against what was explored; arguments as those of :func:`importance_draws`."""
        self._beside += map(_visited, explored, explored_density)
        refusals, against, drawn = 0, "", bool(self._sides[0].log_density.size)
        for number in range(ROUNDS):
            if number or not drawn:
                for side in self._sides:
                    side.draw(self._size, self._evaluate, self._rng)
            found = replace(weighed(self._sides), search=self._search)
            count = len(found.positions)
            lacking = max(found.lacking(ess), least / count)
            if self._explored(found, number, lacking <= 1.0, explored_density.size):
                continue
            if lacking <= 1.0 or (drawn and number == 0):
                if behind := _behind(found, explored, self._begun, self._parts):
                    return Refusal(behind, count, self)
                if lacking <= 1.0:
                    against = next(_against(found, explored, explored_density), "")
                    if not against:
                        return found
                    refusals += 1
                    if refusals == REFUSALS:
                        break
            if number > 2 and count > (2.0 / WORTHWHILE) * found.ess.min():
                break
            fitted = [side.refitted(self._rng) for side in self._sides]
            for side, mixture in zip(self._sides, reversed(fitted), strict=True):
                side.mixture = mixture
            more = max(1.1 * lacking - 1.0, 0.2) * count / 2
            self._size = int(np.ceil(min(GROWTH * self._size, more)))
        return Refusal(
            against or f"the effective sample size of {count} draws is {found.ess.min():.0f}", count
        )

    def _explored(self, found: ImportanceDraws, number: int, enough: bool, steps: int) -> bool:
        """Whether a place that was missed has turned up; it was then explored, and the next draws go there too."""
        search = self._search
        if search is None:
            return False
        whole = self._sides[0].mixture.as_one()
        if enough and not self._looked:
            self._beside.append(search.look(whole, steps + len(found.positions), self._searching))
            self._looked = True
        # in its first rounds a proposal misses much that it will find
        place = _missed(found, self._beside) if enough else _fallen_into(found) if number > 1 else None
        if place is None or self._false_alarm or search.explorations >= EXPLORATIONS:
            return False
        there = search.explore(place, whole.factors[0], found.surprise, self._searching)
        # walkers that came to where everything is known have found a tail of it, no part of its own
        self._false_alarm = enough and bool(np.median(found.surprise(*there)) < 0.0)
        if self._false_alarm:
            return False
        search.explorations += 1
        self._beside.append(there)
        part = fit_mixture(there[0][::2], there[0][1::2], self._searching)
        self._parts = part if self._parts is None else self._parts.with_part(part, 0.5)
        for side in self._sides:
            side.mixture = side.mixture.with_part(part, EXPLORED_WEIGHT)
        self._size = max(self._size, len(found.positions) // 4)
        return True


def _missed(found: ImportanceDraws, beside: list[tuple[FloatArray, FloatArray]]) -> FloatArray | None:
    """The place at which the target most exceeds what the draws lead to expect, if a part of it can have been missed there."""
    positions, log_density = (np.concatenate(arrays) for arrays in zip(*beside, strict=True))
    surprise = found.surprise(positions, log_density)
    return np.asarray(positions[np.argmax(surprise)]) if surprise.max() > 0.0 else None


def _fallen_into(found: ImportanceDraws) -> FloatArray | None:
    """The place of a draw that has a tenth of all weight."""
    ratios = found.log_density - found.log_proposal
    heaviest = int(np.argmax(ratios))
    alone = ratios[heaviest] - logsumexp(ratios) > np.log(0.1)
    return np.asarray(found.positions[heaviest]) if alone else None


def _foreseen(log_ratios: FloatArray) -> float:
    """Effective draws for each draw of a proposal, from ln(target/proposal) at draws of the target: ``1/(E[w] E[1/w])``."""
    count = np.log(log_ratios.size)
    return float(np.exp(2 * count - logsumexp(log_ratios) - logsumexp(-log_ratios)))


def _visited(chain: FloatArray, log_density: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Some of the different positions of an ensemble: a walker that did not move does not count by its steps."""
    places = np.sort(np.unique(chain, axis=0, return_index=True)[1])
    places = places[_evenly(places.size, POINTS)]
    return chain[places], log_density[places]


def _against(found: ImportanceDraws, explored: FloatArray, explored_density: FloatArray) -> Iterator[str]:
    """What speaks against accepting draws and more of them may cure, one sentence each."""
    if not found.shape <= LARGEST_SHAPE:
        yield f"the weights are too uneven (Pareto k {found.shape:.2f}, at most {LARGEST_SHAPE} is accepted)"
    weights = np.exp(found.log_weights - found.log_weights.max())
    for column, x in enumerate(found.positions.T):
        middle = weighted_quantiles(x, weights, 0.5)
        for tail in (x <= middle, x >= middle):
            if not (shape := pareto_shape(weights[tail])) <= LARGEST_SHAPE:
                yield f"the weights are too uneven in a tail of coordinate {column + 1} (Pareto k {shape:.2f})"
    # where the proposal is missing something that ensembles have found, their ratios exceed all those of the draws
    highest = (found.log_density - found.log_proposal).max()
    for chain, density in zip(explored, explored_density, strict=True):
        visited, its_density = _visited(chain, density)
        proposal = StudentMixture.of(found.proposals, [1, 1]).log_density(visited)
        beyond = its_density - proposal > highest
        # one walker that hardly moved is no mode
        if beyond.sum() >= 5 and beyond.mean() > 0.01:
            yield f"{beyond.mean():.0%} of the positions of an ensemble lie where the proposal has hardly any draws"


def _behind(
    found: ImportanceDraws, explored: FloatArray, begun: StudentMixture, parts: StudentMixture | None
) -> str:
    """In which quantile ensembles and draws disagree, in a sentence; empty if in none.

    What was found only by a search, ``parts`` beside the proposal that was ``begun`` with, is not expected of the ensembles.
    """
    log_weights = found.log_weights - found.log_weights.max()
    if parts is not None:
        log_weights = log_weights + log_expit(
            begun.log_density(found.positions) - parts.log_density(found.positions)
        )
    quantiles = np.array([weighted_quantiles(x, np.exp(log_weights), TAILS) for x in found.positions.T])
    fractions = np.array([(chain[:, :, np.newaxis] < quantiles).mean(axis=0) for chain in explored])
    count = len(fractions)
    # of four ensembles, with all quantiles of all coordinates taken into account
    spread = fractions.std(axis=0, ddof=1) / np.sqrt(count)
    often = float(stdtrit(count - 1, 1 - 0.005 / fractions[0].size))
    far = np.abs(fractions.mean(axis=0) - TAILS) > often * spread + 0.01
    if not far.any():
        return ""
    column, place = np.argwhere(far)[0]
    return (
        f"{fractions.mean(axis=0)[column, place]:.1%} of the explored positions lie below the {TAILS[place]:.0%} quantile "
        f"of coordinate {column + 1}"
    )


def _evenly(count: int, most: int) -> np.ndarray:
    return np.linspace(0, count - 1, min(count, most)).round().astype(int)
