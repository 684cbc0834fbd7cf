"""One ensemble, some steps further: a function of its state alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.sampling.moves import MoveFactory
from skinbayes.sampling.target import Target


@dataclass(frozen=True)
class EnsembleState:
    """Everything the future of an ensemble depends on.

    Attributes
    ----------
    positions : walkers, shape ``(walkers, D)``
    log_density : at those positions, shape ``(walkers,)``
    random_state : state of its own ``numpy.random.RandomState`` (Mersenne Twister)
    spent : log-densities computed to come here that no steps count
    """

    positions: FloatArray
    log_density: FloatArray
    random_state: tuple[Any, ...]
    spent: int = 0


@dataclass(frozen=True)
class EnsembleSteps:
    """Consecutive steps of one ensemble.

    Attributes
    ----------
    positions : shape ``(steps, walkers, D)``
    log_density : shape ``(steps, walkers)``
    random_state : generator state after the last step
    evaluations : log-densities computed, those that were spent on the state they begin from included
    invalid : how many of them were NaN or +inf and were taken as −inf
    first_invalid : the first position of that kind, shape ``(D,)``; NaN if there was none
    """

    positions: FloatArray
    log_density: FloatArray
    random_state: tuple[Any, ...]
    evaluations: int
    invalid: int
    first_invalid: FloatArray

    @property
    def end(self) -> EnsembleState:
        """The state after the last step."""
        return EnsembleState(self.positions[-1], self.log_density[-1], self.random_state)


class Density:
    """The target's log-density with NaN and +inf counted and taken as −inf."""

    def __init__(self, target: Target) -> None:
        self._target = target
        self.evaluations = 0
        self.invalid = 0
        self.first_invalid = np.full(len(target.names), np.nan)

    def __call__(self, position: FloatArray) -> FloatArray:
        """Log-density of each row of ``position`` (shape ``(B, D)``), shape ``(B,)``."""
        value = np.array(self._target.log_density(position), dtype=float)
        invalid = np.isnan(value) | (value == np.inf)
        value[invalid] = -np.inf
        self.counted(position, invalid)
        return value

    def counted(self, position: FloatArray, invalid: NDArray[np.bool_]) -> None:
        """Count evaluations that were made, ``(B, D)``, and which of them gave no number."""
        if invalid.any() and not self.invalid:
            self.first_invalid = position[np.argmax(invalid)].copy()
        self.evaluations += len(position)
        self.invalid += int(np.count_nonzero(invalid))


class _Counting:
    """A density as emcee asks for it, which also counts what moves evaluate by themselves."""

    def __init__(self, density: Density) -> None:
        self._density, self.counted = density, density.counted

    def __call__(self, position: FloatArray) -> tuple[FloatArray, None]:
        return self._density(position), None


def advance(target: Target, state: EnsembleState, steps: int, moves: MoveFactory) -> EnsembleSteps:
    """Move an ensemble by ``steps`` steps.

    The result depends on the arguments only, so it does not matter in which process, after which interruption or
    in how many pieces the steps are made.

    Parameters
    ----------
    target : the density
    state : where the ensemble stands
    steps : how many steps, at least 1
    moves : builds the proposals

    Returns
    -------
    the steps made, the first being the one after ``state``
    """
    import emcee

    walkers, dimension = state.positions.shape
    density = Density(target)
    sampler = emcee.EnsembleSampler(walkers, dimension, density, moves=moves())
    # emcee's own wrapper prints to standard output when a call is interrupted, raises on NaN and accepts +inf.
    sampler.compute_log_prob = _Counting(density)
    # emcee ignores a random state it does not understand, in silence: a RandomState tuple is what works.
    current = emcee.State(state.positions, state.log_density, random_state=state.random_state, copy=True)
    positions = np.empty((steps, walkers, dimension))
    log_density = np.empty((steps, walkers))
    made = sampler.sample(current, iterations=steps, store=False, skip_initial_state_check=True)
    for step, current in enumerate(made):
        positions[step] = current.coords
        log_density[step] = current.log_prob
    return EnsembleSteps(
        positions,
        log_density,
        sampler.random_state,
        state.spent + density.evaluations,
        density.invalid,
        density.first_invalid,
    )
