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

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import expit, logsumexp, stdtrit

from skinbayes.arrays import FloatArray
from skinbayes.sampling.draws import weighted_quantiles
from skinbayes.sampling.search import EXPLORATIONS, FOUND_WITH, MISSED, Search
from skinbayes.sampling.stopping import TAIL_FRACTION
from skinbayes.sampling.stuck_walkers import left_behind
from skinbayes.statistics.pareto import pareto_shape, smoothed
from skinbayes.statistics.student_mixture import StudentMixture, fit_mixture

Evaluate = Callable[[FloatArray], FloatArray]
"""Log-density at positions ``(B, D)``, −inf where impossible."""

POINTS = 2000
"""Explored positions of each ensemble that the mixture is fitted to."""

WIDE_WEIGHT, WIDE_VOLUME, LEAST_STRETCH, MOST_STRETCH = 0.2, 250.0, 1.3, 2.5
"""A component about the whole, of so many times its volume, gets this part of all draws; it is wider by a factor between two. Of
much more volume it would have hardly any draws where the weights become large."""

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


def importance_draws(
    explored: FloatArray,
    explored_density: FloatArray,
    evaluate: Evaluate,
    ess: float,
    rng: np.random.Generator,
    least: int = 0,
    agree: bool = True,
    search: Search | None = None,
) -> ImportanceDraws | tuple[str, int]:
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
    the draws, or in a sentence why there are none, and how many were tried
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
        return f"a proposal would give {foreseen:.2g} effective draws for each evaluation", 0
    everything = np.concatenate([first, second])
    mixture = mixture.refitted(everything, np.ones(len(everything)))
    sides = (_Rounds(mixture), _Rounds(mixture))
    size, against = max(200, 30 * explored.shape[-1]), None
    beside, begun, parts = visited, mixture, None
    looked, refusals = False, 0
    for number in range(ROUNDS):
        for side in sides:
            side.draw(size, evaluate, rng)
        found = replace(_weighed(sides), search=search)
        count = len(found.positions)
        lacking = max(found.lacking(ess), least / count)
        if search is not None:
            if lacking <= 1.0 and not looked:
                beside.append(search.look(mixture.as_one(), explored_density.size + count, rng))
                looked = True
            if search.explorations < EXPLORATIONS and (place := _missed(found, beside)) is not None:
                beside.append(search.explore(place, mixture.as_one().factors[0], rng))
                part = fit_mixture(beside[-1][0][::2], beside[-1][0][1::2], rng)
                parts = part if parts is None else parts.with_part(part, 0.5)
                for side in sides:
                    side.mixture = side.mixture.with_part(part, EXPLORED_WEIGHT)
                size = max(size, count // 4)
                continue
        if lacking <= 1.0:
            known = 1.0 if parts is None else expit(_log_ratio(begun, parts, found.positions))
            against = next(_against(found, explored, explored_density, known), None)
            if against is None:
                return found
            refusals += 1
            if refusals == REFUSALS:
                break
        if number > 4 and count > (2.0 / WORTHWHILE) * found.ess.min():
            break
        fitted = [side.refitted(rng) for side in sides]
        for side, mixture in zip(sides, reversed(fitted), strict=True):
            side.mixture = mixture
        size = int(np.ceil(min(GROWTH * size, max(1.1 * lacking - 1.0, 0.2) * count / 2)))
    return against or f"the effective sample size of {count} draws is {found.ess.min():.0f}", count


def _log_ratio(one: StudentMixture, other: StudentMixture, positions: FloatArray) -> FloatArray:
    return one.log_density(positions) - other.log_density(positions)


def _missed(found: ImportanceDraws, beside: list[tuple[FloatArray, FloatArray]]) -> FloatArray | None:
    """The place at which the target most exceeds what the draws lead to expect, if a part of it can have been missed there."""
    positions, heights = (np.concatenate(arrays) for arrays in zip(*beside, strict=True))
    count = len(found.positions)
    ratios = found.log_density - found.log_proposal
    expected = logsumexp(ratios) - np.log(count)
    there = heights - StudentMixture.of(found.proposals, [1, 1]).log_density(positions)
    # a single draw with a tenth of all weight has fallen into something, too
    if count >= 1000 and ratios.max() - expected > np.log(0.1 * count):
        return np.asarray(found.positions[np.argmax(ratios)])
    if there.max() > max(ratios.max(), expected + np.log(max(MISSED * count / FOUND_WITH, 10.0))):
        return np.asarray(positions[np.argmax(there)])
    return None


class _Rounds:
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
        if weights.sum() ** 2 / np.square(weights).sum() < POINTS / 4:
            return self.mixture.refitted(self.positions, weights)
        # as many components as they can tell; a draw chosen twice is in one half only
        part = rng.random(count) < 0.5
        first, second = (self._chosen(weights * chosen, rng) for chosen in (part, ~part))
        return fit_mixture(first, second, rng)

    def _chosen(self, weights: FloatArray, rng: np.random.Generator) -> FloatArray:
        size = min(POINTS, len(weights) // 2)
        return np.asarray(self.positions[rng.choice(len(weights), size=size, p=weights / weights.sum())])


def _widened(mixture: StudentMixture) -> StudentMixture:
    stretch = np.clip(WIDE_VOLUME ** (1.0 / mixture.dimension), LEAST_STRETCH, MOST_STRETCH)
    return mixture.with_wide_component(WIDE_WEIGHT, float(stretch))


def _weighed(sides: tuple[_Rounds, _Rounds]) -> ImportanceDraws:
    proposals = (sides[0].proposal, sides[1].proposal)
    positions, log_density, log_proposal = (
        np.stack(pair, axis=1).reshape(-1, *pair[0].shape[1:])
        for pair in zip(
            *((side.positions, side.log_density, side.log_proposal) for side in sides), strict=True
        )
    )
    log_weights, shape = smoothed(log_density - log_proposal)
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
    return np.asarray(variance / error)


def _foreseen(log_ratios: FloatArray) -> float:
    """Effective draws for each draw of a proposal, from ln(target/proposal) at draws of the target: ``1/(E[w] E[1/w])``."""
    count = np.log(log_ratios.size)
    return float(np.exp(2 * count - logsumexp(log_ratios) - logsumexp(-log_ratios)))


def _visited(chain: FloatArray, log_density: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Some of the different positions of an ensemble: a walker that did not move does not count by its steps."""
    places = np.sort(np.unique(chain, axis=0, return_index=True)[1])
    places = places[_evenly(places.size, POINTS)]
    return chain[places], log_density[places]


def _against(
    found: ImportanceDraws, explored: FloatArray, explored_density: FloatArray, known: FloatArray | float
) -> Iterator[str]:
    """What speaks against accepting draws, one sentence each.

    ``known`` is how much of each draw, between 0 and 1, is of the parts that the ensembles have found.
    """
    if not found.shape <= LARGEST_SHAPE:
        yield f"the weights are too uneven (Pareto k {found.shape:.2f}, at most {LARGEST_SHAPE} is accepted)"
    weights = np.exp(found.log_weights - found.log_weights.max())
    quantiles = np.array([weighted_quantiles(x, weights, TAILS) for x in found.positions.T])
    for column, (x, ends) in enumerate(zip(found.positions.T, quantiles, strict=True)):
        for tail in (x <= ends[1], x >= ends[1]):
            if not (shape := pareto_shape(weights[tail])) <= LARGEST_SHAPE:
                yield f"the weights are too uneven in a tail of coordinate {column + 1} (Pareto k {shape:.2f})"
    quantiles = np.array([weighted_quantiles(x, weights * known, TAILS) for x in found.positions.T])
    # where the proposal is missing something that ensembles have found, their ratios exceed all those of the draws
    highest = (found.log_density - found.log_proposal).max()
    below = []
    for chain, density in zip(explored, explored_density, strict=True):
        visited, its_density = _visited(chain, density)
        proposal = StudentMixture.of(found.proposals, [1, 1]).log_density(visited)
        beyond = its_density - proposal > highest
        # one walker that hardly moved is no mode
        if beyond.sum() >= 5 and beyond.mean() > 0.01:
            yield f"{beyond.mean():.0%} of the positions of an ensemble lie where the proposal has hardly any draws"
        below.append((chain[:, :, np.newaxis] < quantiles).mean(axis=0))
    fractions = np.array(below)
    count = len(fractions)
    # of four ensembles, with all quantiles of all coordinates taken into account
    spread = fractions.std(axis=0, ddof=1) / np.sqrt(count)
    often = float(stdtrit(count - 1, 1 - 0.005 / fractions[0].size))
    far = np.abs(fractions.mean(axis=0) - TAILS) > often * spread + 0.01
    if far.any():
        column, place = np.argwhere(far)[0]
        yield (
            f"{fractions.mean(axis=0)[column, place]:.1%} of the explored positions lie below the {TAILS[place]:.0%} quantile "
            f"of coordinate {column + 1}"
        )


def _evenly(count: int, most: int) -> np.ndarray:
    return np.linspace(0, count - 1, min(count, most)).round().astype(int)
