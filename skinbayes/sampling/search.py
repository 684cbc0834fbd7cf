"""Looking for parts of a posterior that ensembles and proposals have missed, and exploring what turns up.

A narrow part far from the rest is found by chance alone: some position has to fall into it. Draws of the prior and of a Cauchy
distribution about what is known, which reaches all scales between posterior and prior, look for it; so does every position where
walkers have been. A place of far more density than the proposal expects is then explored by an ensemble of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.sampling.advance import EnsembleState
from skinbayes.sampling.target import Target
from skinbayes.statistics.student_mixture import StudentMixture

MISSED = 0.01
"""Part of the posterior that must not be missed. Without a single one of n draws it has at least MISSED n/FOUND_WITH times the
density that they lead to expect."""

FOUND_WITH = 3
"""Draws that are expected where at least one falls in 95 of 100 cases: ln 20."""

EXPLORATIONS = 3
"""Places that are explored at most in one attempt; of several in one part, the densest."""

BALL, GROWN, MOST_BLOCKS = 1e-3, 1.3, 6
"""Walkers begin about a place in a ball of so many times the spread of what is known, and move until their spread grows less than
so many times in a block of steps, or so many blocks."""

AT_A_TIME = 256
"""Positions that a worker evaluates at a time; a fixed number, so that one seed gives the same with any number of workers."""


class Search:
    """Evaluates positions of a target and explores places, counting what it costs.

    Parameters
    ----------
    target : the density
    crew : evaluates arrays of positions and moves states of ensembles, in order
    walkers : of an exploring ensemble
    share : draws of the search for each evaluation that was made before

    Attributes
    ----------
    evaluations : made by search and exploration
    from_prior, from_about : draws of the prior, and of the Cauchy distribution, that were looked at
    explorations : places that were explored and are parts of their own
    """

    def __init__(
        self, target: Target, crew: Callable[[Sequence[Any]], list[Any]], walkers: int, share: float
    ) -> None:
        self._target, self._crew, self._walkers, self._share = target, crew, walkers, share
        self.evaluations = self.from_prior = self.from_about = self.explorations = 0

    def evaluate(self, positions: FloatArray) -> FloatArray:
        """Log-density of each row, −inf where impossible."""
        pieces = [positions[first : first + AT_A_TIME] for first in range(0, len(positions), AT_A_TIME)]
        return np.concatenate(self._crew(pieces))

    def look(
        self, about: StudentMixture, before: int, rng: np.random.Generator
    ) -> tuple[FloatArray, FloatArray]:
        """Positions all over the prior and about what is known, and their log-density.

        Parameters
        ----------
        about : what is known, as one component
        before : evaluations that were made before
        rng : source of all randomness
        """
        each = int(self._share * before / 2)
        unit = rng.random((each, about.dimension))
        anywhere = self._target.prior_transform(unit)
        anywhere = anywhere[np.isfinite(anywhere).all(axis=1)]
        around = StudentMixture(about.weights, about.means, about.factors, np.ones(1)).draw(each, rng)
        # a Cauchy distribution reaches further than there is any prior
        inside = (around >= anywhere.min(axis=0, initial=np.inf)) & (
            around <= anywhere.max(axis=0, initial=-np.inf)
        )
        around = around[inside.all(axis=1)]
        self.from_prior += len(anywhere)
        self.from_about += len(around)
        positions = np.concatenate([anywhere, around])
        self.evaluations += len(positions)
        return positions, self.evaluate(positions) if len(positions) else np.empty(0)

    def explore(
        self,
        place: FloatArray,
        factor: FloatArray,
        surprise: Callable[[FloatArray, FloatArray], FloatArray],
        rng: np.random.Generator,
    ) -> tuple[FloatArray, FloatArray]:
        """Positions of an ensemble that began at a place, and their log-density.

        Parameters
        ----------
        place : where, shape ``(D,)``
        factor : lower Cholesky factor of the covariance of what is known, shape ``(D, D)``
        surprise : of positions and their log-density, positive where more is to be found than is known
        rng : source of all randomness
        """
        near = place + BALL * rng.normal(size=(4 * self._walkers, place.size)) @ factor.T
        near[0] = place
        density = self.evaluate(near)
        self.evaluations += len(near)
        densest = np.argsort(-density, kind="stable")[: self._walkers]
        usable = densest[np.isfinite(density[densest])]
        usable = usable[np.arange(self._walkers) % usable.size]  # at the end of a support there may be few
        generator = np.random.RandomState(np.random.MT19937(int(rng.integers(2**32))))
        state = EnsembleState(near[usable], density[usable], tuple(generator.get_state(legacy=True)))
        spread = np.zeros(place.size)
        for _ in range(MOST_BLOCKS):
            (steps,) = self._crew([state])
            state = steps.end
            self.evaluations += steps.evaluations
            before, spread = spread, steps.positions.std(axis=(0, 1))
            # walkers that have come to where everything is known have nothing to find
            if (spread < GROWN * before).all() or np.median(
                surprise(state.positions, state.log_density)
            ) < 0.0:
                break
        return steps.positions.reshape(-1, place.size), steps.log_density.ravel()
