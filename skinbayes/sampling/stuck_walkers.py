"""Walkers that burn-in left behind, in places that the ensemble would hardly ever visit, are taken along.

Moves that learn from the other walkers do not reach a walker far from all of them: differences between the others are too
short for the way back, and a proposal drawn near the others is refused because the way back to the lost place would be
impossible. Such a walker stays for thousands of steps and spoils every measure of convergence. While the run is young it is
therefore set on the place of another walker of its ensemble; all steps up to then are discarded with the burn-in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.sampling.advance import EnsembleState, EnsembleSteps

LATEST_ROUND = 10
"""Blocks of steps after which walkers may still be taken along."""

DEPTH, DEPTH_PER_DIMENSION = 20.0, 3.0
"""A walker is left behind if its log-density is lower than the median of its ensemble by more than the first plus the second
times the dimension. Of a normal distribution in 8 dimensions a fraction of 1e-17 lies so low; a second mode that matters would
need e^44 times the volume."""


def left_behind(log_density: FloatArray, dimension: int, usual: float | None = None) -> NDArray[np.bool_]:
    """Which walkers are left behind.

    Parameters
    ----------
    log_density : of the walkers of one ensemble, shape ``(walkers,)``
    dimension : number of coordinates
    usual : log-density of others that they are held against; the median of these if omitted

    Examples
    --------
    >>> left_behind(np.array([-3.0, -5.0, -4.0, -80.0]), 2).tolist()
    [False, False, False, True]
    """
    middle = np.median(log_density) if usual is None else usual
    low = middle - (DEPTH + DEPTH_PER_DIMENSION * dimension)
    return np.asarray(log_density < low)


def gathered(blocks: Sequence[EnsembleSteps], rounds: int, seed: int) -> list[EnsembleState]:
    """States from which the ensembles go on after ``rounds`` blocks of steps: the ends of the last, stuck walkers taken along.

    A function of its arguments alone, so that a resumed run goes on as an uninterrupted one does.
    """
    states = []
    for index, block in enumerate(blocks):
        state = block.end
        lost = left_behind(state.log_density, state.positions.shape[1])
        if rounds <= LATEST_ROUND and lost.any():
            rng = np.random.default_rng([seed, 5, index, rounds])
            chosen = rng.choice(np.flatnonzero(~lost), size=int(lost.sum()))
            positions, log_density = state.positions.copy(), state.log_density.copy()
            positions[lost], log_density[lost] = positions[chosen], log_density[chosen]
            state = replace(state, positions=positions, log_density=log_density)
        states.append(state)
    return states


def last_gathering(rounds: Sequence[Sequence[EnsembleSteps]]) -> int:
    """Number of blocks after which walkers were last taken along, before the last block; 0 if never."""
    for number in range(min(len(rounds) - 1, LATEST_ROUND), 0, -1):
        for block in rounds[number - 1]:
            if left_behind(block.log_density[-1], block.positions.shape[-1]).any():
                return number
    return 0
