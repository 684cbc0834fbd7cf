"""Walkers that burn-in left behind, in places that the ensemble would hardly ever visit, are taken along.

Moves that learn from the other walkers do not reach a walker far from all of them: differences between the others are too
short for the way back, and a proposal drawn near the others is refused because the way back to the lost place would be
impossible. Such a walker stays for thousands of steps and spoils every measure of convergence. While the run is young it is
therefore set on the place of another walker of its ensemble; all steps up to then are discarded with the burn-in.

A whole ensemble is left behind where a theory has jumps: those of the data are met or missed, and starts that miss them, and
let the noise make up for it, are in a mode of their own. Such an ensemble goes on from walkers of the others. What is compared is
the mass of the modes, not their density alone: a narrow mode may be much higher and matter little.
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

SETTLED_ROUND = 3
"""Blocks of steps after which an ensemble in a mode of its own can be told from one that is still on its way."""

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


def ensembles_left_behind(log_density: FloatArray, positions: FloatArray) -> NDArray[np.bool_]:
    """Which ensembles are in a mode of next to no mass, against the ensemble in the largest.

    The logarithm of the mass of a mode is that of its density and of its volume, here the median over the walkers and
    ½ ln det of their covariance.

    Parameters
    ----------
    log_density : shape ``(ensembles, n)``
    positions : shape ``(ensembles, n, D)``

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> x = rng.normal(size=(3, 500, 2)) * np.array([1.0, 1.0, 1e-4])[:, None, None]
    >>> height = np.array([0.0, -60.0, 18.4])[:, None]  # the third is 10^8 times as high, and as much smaller
    >>> ensembles_left_behind(height + np.zeros((3, 500)), x).tolist()
    [False, True, False]
    """
    dimension = positions.shape[-1]
    volume = [0.5 * np.linalg.slogdet(np.atleast_2d(np.cov(x.T)))[1] for x in positions]
    mass = np.median(log_density, axis=1) + np.array(volume)
    return np.asarray(mass < mass.max() - (DEPTH + DEPTH_PER_DIMENSION * dimension))


def gathered(blocks: Sequence[EnsembleSteps], rounds: int, seed: int) -> list[EnsembleState]:
    """States from which the ensembles go on after ``rounds`` blocks of steps: the ends of the last, stuck walkers taken along.

    A function of its arguments alone, so that a resumed run goes on as an uninterrupted one does.
    """
    states = [block.end for block in blocks]
    lost = _lost(blocks, rounds)
    there = np.concatenate([state.positions[~gone] for state, gone in zip(states, lost, strict=True)])
    density = np.concatenate([state.log_density[~gone] for state, gone in zip(states, lost, strict=True)])
    for index, (state, gone) in enumerate(zip(states, lost, strict=True)):
        if not gone.any():
            continue
        rng = np.random.default_rng([seed, 5, index, rounds])
        positions, log_density = state.positions.copy(), state.log_density.copy()
        if gone.all():  # from walkers of the others, different ones as far as there are
            chosen = rng.choice(len(there), size=gone.size, replace=len(there) < gone.size)
            positions, log_density = there[chosen], density[chosen]
        else:
            chosen = rng.choice(np.flatnonzero(~gone), size=int(gone.sum()))
            positions[gone], log_density[gone] = positions[chosen], log_density[chosen]
        states[index] = replace(state, positions=positions, log_density=log_density)
    return states


def last_gathering(rounds: Sequence[Sequence[EnsembleSteps]]) -> int:
    """Number of blocks after which walkers were last taken along, before the last block; 0 if never."""
    for number in range(min(len(rounds) - 1, LATEST_ROUND), 0, -1):
        if any(gone.any() for gone in _lost(rounds[number - 1], number)):
            return number
    return 0


def _lost(blocks: Sequence[EnsembleSteps], rounds: int) -> list[NDArray[np.bool_]]:
    """Which walkers of each ensemble are taken along after ``rounds`` blocks of steps."""
    dimension = blocks[0].positions.shape[-1]
    if rounds > LATEST_ROUND:
        return [np.zeros(block.log_density.shape[1], dtype=bool) for block in blocks]
    lost = [left_behind(block.log_density[-1], dimension) for block in blocks]
    if rounds >= SETTLED_ROUND:
        density = np.array([block.log_density.ravel() for block in blocks])
        positions = np.array([block.positions.reshape(-1, dimension) for block in blocks])
        for index in np.flatnonzero(ensembles_left_behind(density, positions)):
            lost[index][:] = True
    return lost
