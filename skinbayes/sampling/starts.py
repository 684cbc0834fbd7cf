"""Where the walkers begin, and the random stream each ensemble owns."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.sampling.advance import Density, EnsembleState
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.target import Target, is_hierarchical, moved_together


def initial_states(target: Target, options: SamplerOptions) -> list[EnsembleState]:
    """Draw the starts of every ensemble and give each its own generator.

    Each ensemble gets one child of the seed's ``SeedSequence`` for its starts and one for its steps, so an ensemble
    is the same whatever the number of others.

    Parameters
    ----------
    target : the density; its ``starts`` are asked for ``walkers`` positions of each ensemble
    options : seed, number of ensembles and walkers

    Returns
    -------
    one state an ensemble

    Raises
    ------
    InputError
        If a start is impossible (its ensemble, walker and coordinates are named) or the starts do not spread over
        all coordinates.
    """
    walkers = options.walkers_for(moved_together(target))
    states = []
    for index, child in enumerate(np.random.SeedSequence(options.seed).spawn(options.ensembles)):
        for_starts, for_steps = child.spawn(2)
        found, spent = _found(target, np.random.default_rng(for_starts), walkers)
        positions = np.array(found, dtype=float)
        log_density = Density(target)(positions)
        _check(target.names, index, positions, log_density, walkers, not is_hierarchical(target))
        # emcee draws from a RandomState; a Generator would be ignored.
        generator = np.random.RandomState(np.random.MT19937(for_steps))
        random_state = tuple(generator.get_state(legacy=True))
        states.append(EnsembleState(positions, log_density, random_state, spent + len(positions)))
    return states


def _found(target: Target, rng: np.random.Generator, walkers: int) -> tuple[FloatArray, int]:
    """Starts, and the evaluations that looking for them took as far as the target says."""
    counted = getattr(target, "starts_counted", None)
    return (target.starts(rng, walkers), 0) if counted is None else counted(rng, walkers)


def _check(
    names: tuple[str, ...],
    index: int,
    positions: FloatArray,
    log_density: FloatArray,
    walkers: int,
    spans: bool = True,
) -> None:
    where = f"starts of ensemble {index + 1}"
    if positions.shape != (walkers, len(names)) or log_density.shape != (walkers,):
        raise InputError(
            f"{where}: positions of shape {positions.shape} and densities of shape {log_density.shape} found, "
            f"{(walkers, len(names))} and {(walkers,)} expected."
        )
    impossible = np.flatnonzero(~np.isfinite(log_density) | ~np.isfinite(positions).all(axis=1))
    if impossible.size:
        first = int(impossible[0])
        place = ", ".join(f"{name} = {value:g}" for name, value in zip(names, positions[first], strict=True))
        raise InputError(
            f"{where}: {impossible.size} of {walkers} walkers begin where the log-density is not finite; "
            f"the first is walker {first + 1} at {place} (log-density {log_density[first]:g}). "
            "Finite starts are expected, a walker at −inf may never leave."
        )
    flat = [name for name, spread in zip(names, np.ptp(positions, axis=0), strict=True) if spread == 0.0]
    if flat:
        raise InputError(
            f"{where}: all walkers begin at the same {', '.join(flat)}; dispersed starts are expected."
        )
    if not spans:  # people are moved one by one, so that walkers need not span the whole space
        return
    scaled = (positions - positions.mean(axis=0)) / positions.std(axis=0)
    if np.linalg.matrix_rank(scaled, tol=1e-8 * np.sqrt(walkers)) < len(names):
        raise InputError(f"{where}: the walkers lie in a plane of fewer than {len(names)} dimensions.")
