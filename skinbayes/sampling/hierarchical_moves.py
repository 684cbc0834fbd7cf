"""Moves of an ensemble through a hierarchical model: person by person, then what all people share.

In 50 coordinates differences between walkers are hardly ever accepted. Given what people share they are independent, so that all of
them are moved at once, each with four or so coordinates and accepted by itself: one evaluation of the likelihood for all. What
people share, location and scale of the population, is moved twice: with the values of the people as they are, which needs no
likelihood, and with their deviates as they are. The first mixes where data tell each person's value, the second where they do not
(Yu & Meng 2011, doi 10.1198/jcgs.2011.203main), so that there is nothing to choose.
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
from skinbayes.statistics.transforms import VectorTransform

REPEATS = 3
"""Moves of location and scale with the values of all people as they are; they cost no likelihood."""

FROM_PRIOR, WHOLE_STEP = 0.1, 0.1
"""Fractions of the moves of people that are drawn from the population, and of differences that are taken whole, not scaled."""

JITTER = 1e-5
"""Added to differences, as a fraction of the spread of the walkers."""


class HierarchicalTarget(Target, Protocol):
    """A target whose parameters belong to single levels or are shared by all.

    Attributes
    ----------
    hierarchy : which do
    transform : from parameters to coordinates; deviates are the same in both
    """

    hierarchy: Hierarchy
    transform: VectorTransform

    def pointwise(self, position: FloatArray) -> FloatArray:
        """Log-likelihood of each datum, ``(B, M)``."""

    def log_prior(self, position: FloatArray) -> FloatArray:
        """Log prior density, ``(B,)``."""

    def log_prior_of(self, places: list[int], position: FloatArray) -> FloatArray:
        """Log prior density of some coordinates, ``(B,)``."""


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
        self._terms = [term for term in self._of.terms if term.shared]
        self._coordinates = np.zeros((0, 0))
        self._pointwise = np.zeros((0, 0))

    def propose(self, model: Any, state: Any) -> tuple[Any, NDArray[np.bool_]]:
        """Move all walkers; the state and which of them moved."""
        random, before = model.random, state.coords.copy()
        if not np.array_equal(before, self._coordinates):
            self._pointwise = self._likelihood(before, model)
        position, pointwise = before.copy(), self._pointwise
        order = random.permutation(len(position))
        halves = order[::2], order[1::2]
        for moved, others in (halves, halves[::-1]):
            x, terms = position[moved], pointwise[moved]
            still = position[others]
            for grouping in self._of.groupings:
                x, terms = self._move_levels(x, terms, still, grouping, model)
            for _ in range(REPEATS):
                for term in self._terms:
                    self._move_population(x, still, term, random)
            for places in self._chosen(random):
                x, terms = self._move_shared(x, terms, still, places, model)
            position[moved], pointwise[moved] = x, terms
        self._coordinates, self._pointwise = position, pointwise
        state.coords = position.copy()
        state.log_prob = self._target.log_prior(position) + pointwise.sum(axis=1)
        return state, (position != before).any(axis=1)

    def _likelihood(self, position: FloatArray, model: Any) -> FloatArray:
        found = np.array(self._target.pointwise(position), dtype=float)
        invalid = np.isnan(found) | (found == np.inf)
        model.compute_log_prob_fn.counted(position, invalid.any(axis=1))
        found[invalid] = -np.inf
        return found

    # -- people ------------------------------------------------------------------------------------------------------

    def _move_levels(
        self, x: FloatArray, terms: FloatArray, still: FloatArray, grouping: Grouping, model: Any
    ) -> tuple[FloatArray, FloatArray]:
        random, (count, levels) = model.random, (len(x), len(grouping.blocks))
        places = np.maximum(grouping.blocks, 0)
        real = grouping.blocks >= 0
        scores = x[:, places]
        choice = random.random_sample()
        if choice < FROM_PRIOR:
            proposed = random.standard_normal(scores.shape)
        else:
            first, second = _pairs(random, (count, levels), len(still))
            values = still[:, places]
            scale = 1.0
            if choice < (1.0 + FROM_PRIOR) / 2.0:  # differences of values, not of deviates
                located, scaled = self._values(still)
                values = located[:, grouping.terms] + scaled[:, grouping.terms] * values
                scale = self._values(x)[1][:, grouping.terms]
            which = np.arange(levels)
            difference = values[first, which] - values[second, which]
            size = _sizes(random, (count, levels), np.maximum(real.sum(axis=1), 1))[..., np.newaxis]
            noise = JITTER * random.standard_normal(scores.shape)
            with np.errstate(all="ignore"):
                proposed = scores + size * difference / scale + noise
        proposed = np.where(real & np.isfinite(proposed), proposed, scores)
        moved = x.copy()
        for i in range(places.shape[1]):
            moved[:, places[real[:, i], i]] = proposed[:, real[:, i], i]
        found = self._likelihood(moved, model)
        gain = _by_level(found, grouping.level, levels) - _by_level(terms, grouping.level, levels)
        if choice >= FROM_PRIOR:
            gain -= 0.5 * np.where(real, proposed**2 - scores**2, 0.0).sum(axis=-1)
        taken = np.log(random.random_sample(gain.shape)) < gain
        for i in range(places.shape[1]):
            columns = places[real[:, i], i]
            x[:, columns] = np.where(taken[:, real[:, i]], moved[:, columns], x[:, columns])
        return x, np.where(taken[:, grouping.level], found, terms)

    def _values(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Location and scale of each term, each ``(B, terms)``."""
        theta = self._target.transform.inverse(position)
        located = np.stack([term.located(theta) for term in self._of.terms], axis=1)
        return located, np.stack([term.scaled(theta) for term in self._of.terms], axis=1)

    # -- what they share ---------------------------------------------------------------------------------------------

    def _move_population(self, x: FloatArray, still: FloatArray, term: Term, random: Any) -> None:
        """Location and scale of a population with the values of its people as they are; ``x`` is changed."""
        places = term.shared
        first, second = _pairs(random, (len(x),), len(still))
        step = still[first][:, places] - still[second][:, places]
        size = _sizes(random, (len(x),), np.array(len(places)))[:, np.newaxis]
        moved = x.copy()
        moved[:, places] += size * step + JITTER * random.standard_normal(step.shape)
        (here, spread), (there, wider) = (self._of_term(term, one[:, places]) for one in (x, moved))
        scores = x[:, term.deviates]
        with np.errstate(all="ignore"):
            new = (here[:, np.newaxis] + spread[:, np.newaxis] * scores - there[:, np.newaxis]) / wider[
                :, np.newaxis
            ]
            gain = self._target.log_prior_of(places, moved[:, places]) - self._target.log_prior_of(
                places, x[:, places]
            )
            gain += len(term.deviates) * np.log(spread / wider) - 0.5 * (new**2 - scores**2).sum(axis=1)
        taken = np.log(random.random_sample(len(x))) < gain
        moved[:, term.deviates] = new
        x[taken] = moved[taken]

    def _of_term(self, term: Term, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Location and scale of a term for those of its coordinates that are free, ``(B, K)``; each ``(B,)``."""
        transforms = self._target.transform.transforms
        free = {place: transforms[place].inverse(position[:, i]) for i, place in enumerate(term.shared)}
        fixed = np.full((2, len(position)), [[term.location_value], [term.scale_value]])
        located = term.natural.forward(free[term.location]) if term.location >= 0 else fixed[0]
        return located, free[term.scale] if term.scale >= 0 else fixed[1]

    def _chosen(self, random: Any) -> list[NDArray[np.intp]]:
        """What of all that people share is moved together: everything, some of it, and one by itself."""
        places = self._shared
        if not len(places):
            return []
        some = places[random.random_sample(len(places)) < 0.5]
        one = places[[random.randint(len(places))]]
        return [found for found in (places, some, one) if len(found)]

    def _move_shared(
        self, x: FloatArray, terms: FloatArray, still: FloatArray, places: NDArray[np.intp], model: Any
    ) -> tuple[FloatArray, FloatArray]:
        """Some of what people share with their deviates as they are."""
        random = model.random
        first, second = _pairs(random, (len(x),), len(still))
        step = still[first][:, places] - still[second][:, places]
        size = _sizes(random, (len(x),), np.array(len(places)))[:, np.newaxis]
        moved = x.copy()
        moved[:, places] += size * step + JITTER * random.standard_normal(step.shape)
        shared = self._shared.tolist()
        gain = self._target.log_prior_of(shared, moved[:, shared]) - self._target.log_prior_of(
            shared, x[:, shared]
        )
        found = np.full(terms.shape, -np.inf)
        possible = np.isfinite(gain)
        if possible.any():
            found[possible] = self._likelihood(moved[possible], model)
        gain = gain + found.sum(axis=1) - terms.sum(axis=1)
        taken = np.log(random.random_sample(len(x))) < gain
        return np.where(taken[:, np.newaxis], moved, x), np.where(taken[:, np.newaxis], found, terms)

    def tune(self, state: Any, accepted: NDArray[np.bool_]) -> None:
        """There is nothing to tune."""


def _pairs(random: Any, shape: tuple[int, ...], count: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Two different ones of ``count`` for each place."""
    first = random.randint(count, size=shape)
    return first, (first + random.randint(1, count, size=shape)) % count


def _sizes(random: Any, shape: tuple[int, ...], dimension: NDArray[np.intp]) -> FloatArray:
    """Factors on differences of ``dimension`` coordinates: small ones too, for walkers that have some way to go."""
    size = 2.38 / np.sqrt(2.0 * dimension) * random.uniform(0.2, 1.2, size=shape)
    return np.where(random.random_sample(shape) < WHOLE_STEP, 1.0, size)


def _by_level(terms: FloatArray, level: NDArray[np.intp], count: int) -> FloatArray:
    """Sums over the data of each level, ``(B, levels)``."""
    order = np.argsort(level, kind="stable")
    starts = np.searchsorted(level[order], np.arange(count))
    return np.asarray(np.add.reduceat(terms[:, order], starts, axis=1))
