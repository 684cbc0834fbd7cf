"""Independent draws by importance sampling, from a proposal fitted to ensembles that have found the posterior.

A walker needs tens of evaluations for an independent draw; a proposal that has the shape of the posterior needs one or two.
The proposal is a mixture of Student t distributions, fitted to one half of the ensembles and examined with the other. A few
rounds of draws improve it, weighted as draws of the mixture of all proposals so far (adaptive multiple importance sampling,
Cornuet et al. 2012, doi 10.1111/j.1467-9469.2011.00756.x). Only draws of the last proposal count: it was fitted to the others,
which are therefore likelier under it than fresh ones, and ln Z of a normal distribution in 20 dimensions came out 0.02, four
standard errors, too low with them. The draws are given up where anything speaks against them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp, stdtrit

from skinbayes.arrays import FloatArray
from skinbayes.sampling.draws import weighted_quantiles
from skinbayes.sampling.stopping import TAIL_FRACTION
from skinbayes.statistics.annealing import effective_number
from skinbayes.statistics.pareto import pareto_shape, smoothed
from skinbayes.statistics.student_mixture import StudentMixture, fit_mixture

Evaluate = Callable[[FloatArray], FloatArray]
"""Log-density at positions ``(B, D)``, −inf where impossible."""

POINTS = 2000
"""Explored positions of each ensemble that the mixture is fitted to."""

WIDE_WEIGHT, WIDE_STRETCH = 0.1, 2.5
"""A component about the whole, so much wider than it, gets this part of all draws."""

ROUNDS = 6
"""Rounds in which the proposal is improved at most."""

TRIES = 5
"""How often draws are made that are to be accepted; those that were not improve the proposal of the next."""

WORTHWHILE = 0.03
"""Effective draws for each evaluation that are worth to begin with; walkers give as many."""

LARGEST_SHAPE = 0.5
"""Largest k̂ of the weights, and of the weights in the tails of each coordinate, at which draws are accepted."""

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
    log_proposal : ln of its density, shape ``(N,)``
    proposal : what they were drawn from
    shape : k̂ of the weights
    ess, tail_ess : effective sample sizes of the mean, and the smaller of the 5 % and 95 % quantiles, of each coordinate
    evaluations : of the target, with those of the rounds before
    """

    positions: FloatArray
    log_density: FloatArray
    log_weights: FloatArray
    log_proposal: FloatArray
    proposal: StudentMixture
    shape: float
    ess: FloatArray
    tail_ess: FloatArray
    evaluations: int

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
) -> ImportanceDraws | tuple[str, int]:
    """Draw from a target that ensembles have explored.

    Parameters
    ----------
    explored : positions after burn-in, shape ``(ensembles, n, D)``, consecutive ones correlated
    explored_density : their log-density, shape ``(ensembles, n)``
    evaluate : the target
    ess : effective sample size wanted in every coordinate; a quarter of it in the quantiles
    rng : source of all randomness
    least : number of draws that are made at least: as many as the exploration took cost no more than that

    Returns
    -------
    the draws, or in a sentence why there are none, and how many were tried
    """
    points, densities = zip(*map(_visited, explored, explored_density), strict=True)
    half = len(points) // 2
    first, second = np.concatenate(points[:half]), np.concatenate(points[half:])
    mixture = fit_mixture(first, second, rng)
    held_out = np.concatenate(densities[half:])
    if (foreseen := _foreseen(held_out - mixture.log_density(second))) < WORTHWHILE:
        return f"a proposal would give {foreseen:.2g} effective draws for each evaluation", 0
    everything = np.concatenate([first, second])
    mixture = mixture.refitted(everything, np.ones(len(everything)))
    rounds = _Rounds(explored.shape[-1])
    size, gain = max(400, 60 * explored.shape[-1]), 0.0
    for _ in range(ROUNDS):
        rounds.draw(mixture.with_wide_component(WIDE_WEIGHT, WIDE_STRETCH), size, evaluate, rng)
        before, gain = gain, effective_number(rounds.log_ratios()) / rounds.count
        mixture = rounds.improved(mixture, rng)
        if gain < 1.1 * before:
            break
    if gain < WORTHWHILE:
        return f"draws of the proposal count {gain:.2g} each", rounds.count
    count = max(int(np.ceil(1.1 * ess / gain)), least - rounds.count, size)
    for _ in range(TRIES):
        proposal = mixture.with_wide_component(WIDE_WEIGHT, WIDE_STRETCH)
        positions = proposal.draw(count, rng)
        density = evaluate(positions)
        found = _weighed(positions, density, proposal, rounds.count + count)
        if (more := found.lacking(ess)) > 1.0:
            new = proposal.draw(int(np.ceil(min(1.2 * more - 1.0, 10.0) * count)), rng)
            positions, density = np.concatenate([positions, new]), np.append(density, evaluate(new))
            found = _weighed(positions, density, proposal, rounds.count + len(positions))
        against = next(_against(found, explored, explored_density, ess), None)
        if against is None:
            return found
        rounds.add(positions, density, proposal)
        mixture = rounds.improved(mixture, rng)
    return str(against), rounds.count


class _Rounds:
    """Draws of several proposals, weighted as draws of their mixture."""

    def __init__(self, dimension: int) -> None:
        self.positions = np.empty((0, dimension))
        self._density = np.empty(0)
        self._proposals: list[StudentMixture] = []
        self._counts: list[int] = []

    @property
    def count(self) -> int:
        return len(self.positions)

    def draw(
        self, proposal: StudentMixture, count: int, evaluate: Evaluate, rng: np.random.Generator
    ) -> None:
        new = proposal.draw(count, rng)
        self.add(new, evaluate(new), proposal)

    def add(self, positions: FloatArray, log_density: FloatArray, proposal: StudentMixture) -> None:
        self.positions = np.concatenate([self.positions, positions])
        self._density = np.append(self._density, log_density)
        self._proposals.append(proposal)
        self._counts.append(len(positions))

    def log_ratios(self) -> FloatArray:
        mixture = StudentMixture.of(self._proposals, self._counts)
        return np.asarray(self._density - mixture.log_density(self.positions))

    def improved(self, mixture: StudentMixture, rng: np.random.Generator) -> StudentMixture:
        """The mixture fitted anew to some of the draws."""
        log_ratios = self.log_ratios()
        weights = np.exp(log_ratios - log_ratios.max())
        # draws with weights far above the others would teach the mixture themselves only
        weights = np.minimum(weights, weights.sum() / np.sqrt(self.count))
        if self.count <= 2 * POINTS:
            return mixture.refitted(self.positions, weights)
        chosen = rng.choice(self.count, size=2 * POINTS, p=weights / weights.sum())
        return mixture.refitted(self.positions[chosen], np.ones(chosen.size))


def _weighed(
    positions: FloatArray, log_density: FloatArray, proposal: StudentMixture, evaluations: int
) -> ImportanceDraws:
    log_proposal = proposal.log_density(positions)
    log_weights, shape = smoothed(log_density - log_proposal)
    weights = np.exp(log_weights - log_weights.max())
    mean = weights @ positions / weights.sum()
    ends = np.array([weighted_quantiles(column, weights, TAILS[[0, 2]]) for column in positions.T])
    tails = np.array([_effective((positions <= ends[:, end]).astype(np.float64), weights) for end in (0, 1)])
    return ImportanceDraws(
        positions, log_density, log_weights, log_proposal, proposal, shape,
        _effective(positions - mean, weights), tails.min(axis=0), evaluations,
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
    found: ImportanceDraws, explored: FloatArray, explored_density: FloatArray, ess: float
) -> Iterator[str]:
    """What speaks against accepting draws, one sentence each."""
    if found.lacking(ess) > 1.0:
        yield f"the effective sample size stays at {found.ess.min():.0f}"
    if not found.shape <= LARGEST_SHAPE:
        yield f"the weights are too uneven (Pareto k {found.shape:.2f}, at most {LARGEST_SHAPE} is accepted)"
    weights = np.exp(found.log_weights - found.log_weights.max())
    mean = weights @ found.positions / weights.sum()
    for column, (x, middle) in enumerate(zip(found.positions.T, mean, strict=True)):
        for side in (-1.0, 1.0):
            shape = pareto_shape(weights * np.maximum(side * (x - middle), 0.0))
            if not shape <= LARGEST_SHAPE:
                yield f"the weights are too uneven in a tail of coordinate {column + 1} (Pareto k {shape:.2f})"
    # where the proposal is missing something that ensembles have found, their ratios exceed all those of the draws
    highest = (found.log_density - found.log_proposal).max()
    quantiles = np.array([weighted_quantiles(x, weights, TAILS) for x in found.positions.T])
    below = []
    for chain, density in zip(explored, explored_density, strict=True):
        visited, its_density = _visited(chain, density)
        beyond = its_density - found.proposal.log_density(visited) > highest
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
