"""Moves of an ensemble through a hierarchical model: person by person, then what all people share.

In 50 coordinates differences between walkers are hardly ever accepted. Given what people share they are independent, so that all
of them are moved at once, each with four or so coordinates and accepted by itself: one evaluation of the likelihood for all. What
people share, location and scale of the population, is moved twice: with the values of the people as they are, which needs no
likelihood, and with their deviates as they are. The first mixes where data tell each person's value, the second where they do
not (Yu & Meng 2011, doi 10.1198/jcgs.2011.203main), so that there is nothing to choose.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.sampling.moves import WeightedMoves
from skinbayes.sampling.target import Target
from skinbayes.statistics.hierarchy import Grouping, Hierarchy, Term

REPEATS = 2
"""Moves of location and scale with the values of all people as they are; they cost no likelihood."""

FROM_PRIOR, WHOLE_STEP = 0.1, 0.1
"""Fractions of the moves of people that are drawn from the population, and of differences that are taken whole, not scaled."""

TOGETHER = 0.5
"""Fraction of the sweeps in which all that people share is moved together."""

LOG_SIZES = np.log([0.1, 1.2])
"""Range of ln of the factor on the usual size of a difference: what is moved is often known better given all else."""

JITTER = 1e-5
"""Added to differences, as a fraction of the spread of the walkers."""


class HierarchicalTarget(Target, Protocol):
    """A target whose parameters belong to single levels or are shared by all.

    Attributes
    ----------
    hierarchy : which do; deviates are coordinates as they are
    """

    hierarchy: Hierarchy

    def pointwise(self, position: FloatArray) -> FloatArray:
        """Log-likelihood of each datum, ``(B, M)``."""

    def log_prior(self, position: FloatArray) -> FloatArray:
        """Log prior density, ``(B,)``."""

    def shared_parameters(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Of those coordinates that are no deviates, ``(B, K)``: parameters, and ln of the prior density of each."""


@dataclass(frozen=True)
class HierarchicalMoves:
    """Builds the moves for a target."""

    target: HierarchicalTarget

    def __call__(self) -> WeightedMoves:
        """The only move: a sweep."""
        return [(HierarchicalMove(self.target), 1.0)]


class HierarchicalMove:
    """One sweep over all people and all that they share, as a move of emcee.

    Half of the walkers are moved by differences between the others, which stay, and then the other way round.
    """

    def __init__(self, target: HierarchicalTarget) -> None:
        self._target, self._of = target, target.hierarchy
        self._shared = self._of.shared
        place = {int(one): i for i, one in enumerate(self._shared)}
        # locations and scales among what is shared
        self._terms = [
            (term, np.array([place[i] for i in term.shared])) for term in self._of.terms if term.shared
        ]
        self._places = place
        used = np.concatenate([np.zeros(0, dtype=np.intp), *(places for _, places in self._terms)])
        self._others = np.setdiff1d(np.arange(len(self._shared)), used)
        self._coordinates = np.zeros((0, 0))
        self._pointwise = np.zeros((0, 0))

    def propose(self, model: Any, state: Any) -> tuple[Any, NDArray[np.bool_]]:
        """Move all walkers; the state and which of them moved."""
        random, before = model.random, state.coords.copy()
        if not np.array_equal(before, self._coordinates):
            self._pointwise = self._likelihood(before, model)
        position, pointwise = before.copy(), self._pointwise.copy()
        order = random.permutation(len(position))
        halves = order[::2], order[1::2]
        for moved, others in (halves, halves[::-1]):
            walkers = _Walkers(self._target, self._shared, position[moved], pointwise[moved])
            still = position[others]
            for grouping in self._of.groupings:
                self._move_levels(walkers, still, grouping, model)
            for _ in range(REPEATS):
                self._move_populations(walkers, still, random)
            self._move_all_shared(walkers, still, model)
            position[moved], pointwise[moved] = walkers.x, walkers.pointwise
        self._coordinates, self._pointwise = position, pointwise
        state.coords = position.copy()
        state.log_prob = self._target.log_prior(position) + pointwise.sum(axis=1)
        return state, (position != before).any(axis=1)

    def tune(self, state: Any, accepted: NDArray[np.bool_]) -> None:
        """There is nothing to tune."""

    def _likelihood(self, position: FloatArray, model: Any) -> FloatArray:
        found = np.array(self._target.pointwise(position), dtype=float)
        invalid = np.isnan(found) | (found == np.inf)
        model.compute_log_prob_fn.counted(position, invalid.any(axis=1))
        found[invalid] = -np.inf
        return found

    # -- people ------------------------------------------------------------------------------------------------------

    def _move_levels(self, walkers: _Walkers, still: FloatArray, grouping: Grouping, model: Any) -> None:
        random, x, levels = model.random, walkers.x, len(grouping.blocks)
        places, real = np.maximum(grouping.blocks, 0), grouping.blocks >= 0
        scores = x[:, places]
        choice = random.random_sample()
        if choice < FROM_PRIOR:
            proposed = random.standard_normal(scores.shape)
        else:
            first, second = _pairs(random, (len(x), levels), len(still))
            values, scale = still[:, places], np.ones(1)
            if choice < (1.0 + FROM_PRIOR) / 2.0:  # differences of values, not of deviates
                theta, _ = self._target.shared_parameters(still[:, self._shared])
                located, scaled = self._values(theta)
                values = located[:, grouping.terms] + scaled[:, grouping.terms] * values
                scale = self._values(walkers.theta)[1][:, grouping.terms]
            which = np.arange(levels)
            difference = values[first, which] - values[second, which]
            size = _sizes(random, (len(x), levels), np.maximum(real.sum(axis=1), 1))[..., np.newaxis]
            with np.errstate(all="ignore"):
                proposed = scores + size * difference / scale + JITTER * random.standard_normal(scores.shape)
        proposed = np.where(real & np.isfinite(proposed), proposed, scores)
        moved = x.copy()
        moved[:, places[real]] = proposed[:, real]
        found = self._likelihood(moved, model)
        gain = _by_level(found, grouping.level, levels) - _by_level(walkers.pointwise, grouping.level, levels)
        if choice >= FROM_PRIOR:
            gain -= 0.5 * np.where(real, proposed**2 - scores**2, 0.0).sum(axis=-1)
        taken = np.log(random.random_sample(gain.shape)) < gain
        x[:, places[real]] = np.where(taken[..., np.newaxis], proposed, scores)[:, real]
        walkers.pointwise = np.where(taken[:, grouping.level], found, walkers.pointwise)

    def _values(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Location and scale of each term for shared parameters ``(B, K)``, each ``(B, terms)``."""
        found = [self._of_term(term, theta) for term in self._of.terms]
        return np.stack([one[0] for one in found], axis=1), np.stack([one[1] for one in found], axis=1)

    def _of_term(self, term: Term, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Location and scale of a term for shared parameters ``(B, K)``, each ``(B,)``."""
        located, scaled = (np.full(len(theta), v) for v in (term.location_value, term.scale_value))
        if term.location >= 0:
            located = term.natural.forward(theta[:, self._places[term.location]])
        return located, theta[:, self._places[term.scale]] if term.scale >= 0 else scaled

    # -- what they share ---------------------------------------------------------------------------------------------

    def _stepped(
        self, walkers: _Walkers, still: FloatArray, places: NDArray[np.intp], size: FloatArray, random: Any
    ) -> FloatArray:
        """What is shared, ``(n, K)``, some of it moved by a difference between other walkers."""
        first, second = _pairs(random, (len(walkers.x),), len(still))
        columns = self._shared[places]
        step = still[first][:, columns] - still[second][:, columns]
        moved = walkers.x[:, self._shared]
        moved[:, places] += size * step + JITTER * random.standard_normal(step.shape)
        return moved

    def _move_populations(self, walkers: _Walkers, still: FloatArray, random: Any) -> None:
        """Location and scale of each population with the values of its people as they are: no likelihood is needed."""
        if not self._terms:
            return
        places = np.concatenate([places for _, places in self._terms])
        counts = np.array([len(places) for _, places in self._terms])
        size = np.repeat(_sizes(random, (len(walkers.x), len(counts)), counts), counts, axis=1)
        moved = self._stepped(walkers, still, places, size, random)
        theta, prior = self._target.shared_parameters(moved)
        for term, own in self._terms:
            new, gain = self._kept(walkers, term, theta, 1.0)
            gain = gain + (prior[:, own] - walkers.prior[:, own]).sum(axis=1)
            taken = np.log(random.random_sample(len(gain))) < gain
            walkers.take(taken, own, moved, theta, prior)
            walkers.x[np.ix_(taken, term.deviates)] = new[taken]

    def _kept(
        self, walkers: _Walkers, term: Term, theta: FloatArray, part: float
    ) -> tuple[FloatArray, FloatArray]:
        """Deviates that go a ``part`` of the way to unchanged values, and what they add to ln of the chance of acceptance.

        With a part b of the way deviates times the scale to the power b stay as they are. Where the data tell a person's value
        about as well as the population does, some b between the ends mixes best.
        """
        (here, spread), (there, wider) = (self._of_term(term, one) for one in (walkers.theta, theta))
        scores = walkers.x[:, term.deviates]
        with np.errstate(all="ignore"):
            # symmetric in the two ends, so that the way back is the same
            shift = part * (there - here) * spread ** (-(1.0 - part) / 2.0) * wider ** (-(1.0 + part) / 2.0)
            ratio = spread / wider
            new = (ratio**part)[:, np.newaxis] * scores - shift[:, np.newaxis]
            gain = part * len(term.deviates) * np.log(ratio) - 0.5 * (new**2 - scores**2).sum(axis=1)
        return new, np.where(np.isfinite(gain), gain, -np.inf)

    def _move_all_shared(self, walkers: _Walkers, still: FloatArray, model: Any) -> None:
        """What no population has; location and scale of each population; now and then everything that is shared."""
        if len(self._others):
            self._move_shared(walkers, still, self._others, None, model)
        for term, places in self._terms:
            # location and scale together, or one of them: where another parameter holds the one, the other still moves
            which = model.random.randint(3)
            chosen = places[which - 1 : which] if which else places
            if len(chosen):
                self._move_shared(walkers, still, chosen, term, model)
        if len(self._shared) and model.random.random_sample() < TOGETHER:
            self._move_shared(walkers, still, np.arange(len(self._shared)), None, model)

    def _move_shared(
        self, walkers: _Walkers, still: FloatArray, places: NDArray[np.intp], term: Term | None, model: Any
    ) -> None:
        """Some of what people share; deviates stay as they are, or those of a ``term`` go part of the way to unchanged values."""
        random = model.random
        size = _sizes(random, (len(walkers.x), 1), np.array(len(places)))
        shared = self._stepped(walkers, still, places, size, random)
        theta, prior = self._target.shared_parameters(shared)
        gain = (prior - walkers.prior).sum(axis=1)
        moved = walkers.x.copy()
        moved[:, self._shared] = shared
        if term is not None:
            new, more = self._kept(walkers, term, theta, random.random_sample())
            moved[:, term.deviates] = new
            gain = gain + more
        found = np.full(walkers.pointwise.shape, -np.inf)
        possible = np.isfinite(gain) & np.isfinite(moved).all(axis=1)
        if possible.any():
            found[possible] = self._likelihood(moved[possible], model)
        with np.errstate(invalid="ignore"):
            gain = gain + found.sum(axis=1) - walkers.pointwise.sum(axis=1)
        taken = np.log(random.random_sample(len(gain))) < gain
        walkers.take(taken, places, shared, theta, prior)
        if term is not None:
            walkers.x[np.ix_(taken, term.deviates)] = moved[np.ix_(taken, term.deviates)]
        walkers.pointwise[taken] = found[taken]


class _Walkers:
    """Walkers that are moved, with what is known about them.

    Attributes
    ----------
    x, pointwise : positions ``(n, D)``, and ln of the likelihood of each datum there
    theta, prior : shared parameters and ln of the prior density of each, ``(n, K)``
    """

    def __init__(
        self, target: HierarchicalTarget, shared: NDArray[np.intp], x: FloatArray, pointwise: FloatArray
    ) -> None:
        self.x, self.pointwise, self._shared = x, pointwise, shared
        self.theta, self.prior = target.shared_parameters(x[:, shared])

    def take(
        self,
        taken: NDArray[np.bool_],
        places: NDArray[np.intp],
        moved: FloatArray,
        theta: FloatArray,
        prior: FloatArray,
    ) -> None:
        """Set some of what is shared of those that accept a move."""
        chosen = np.ix_(taken, places)
        self.x[np.ix_(taken, self._shared[places])] = moved[chosen]
        self.theta[chosen], self.prior[chosen] = theta[chosen], prior[chosen]


def _pairs(random: Any, shape: tuple[int, ...], count: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Two different ones of ``count`` for each place."""
    first = random.randint(count, size=shape)
    return first, (first + random.randint(1, count, size=shape)) % count


def _sizes(random: Any, shape: tuple[int, ...], dimension: NDArray[np.intp]) -> FloatArray:
    """Factors on differences of ``dimension`` coordinates: small ones too, for walkers that have some way to go."""
    size = 2.38 / np.sqrt(2.0 * dimension) * np.exp(random.uniform(*LOG_SIZES, size=shape))
    return np.where(random.random_sample(shape) < WHOLE_STEP, 1.0, size)


def _by_level(terms: FloatArray, level: NDArray[np.intp], count: int) -> FloatArray:
    """Sums over the data of each level, ``(B, levels)``."""
    order = np.argsort(level, kind="stable")
    starts = np.searchsorted(level[order], np.arange(count))
    return np.asarray(np.add.reduceat(terms[:, order], starts, axis=1))
