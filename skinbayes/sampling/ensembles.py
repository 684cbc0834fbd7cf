"""Sampling a target with several independent ensembles until the stopping rule is met."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.sampling.advance import Density, EnsembleState, EnsembleSteps, advance
from skinbayes.sampling.chains import Chains
from skinbayes.sampling.finish import Finish
from skinbayes.sampling.hierarchical_moves import HierarchicalMoves
from skinbayes.sampling.moves import MoveFactory, moves_for
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.progress import EnsembleProgress
from skinbayes.sampling.starts import initial_states
from skinbayes.sampling.stopping import StoppingReport, is_check, judge
from skinbayes.sampling.store import FINGERPRINT, SampleStore
from skinbayes.sampling.stuck_walkers import gathered, last_gathering, left_behind
from skinbayes.sampling.target import Target, is_hierarchical, moved_together
from skinbayes.sampling.weighted_draws import ImportanceDraws
from skinbayes.sampling.workers import sharing_out


class SamplingInterrupted(KeyboardInterrupt):
    """The user interrupted a run; whole blocks made before are kept.

    Attributes
    ----------
    chains : the steps so far, None if there was no whole block
    """

    def __init__(self, chains: Chains | None) -> None:
        steps = 0 if chains is None else chains.steps
        super().__init__(f"interrupted after {steps} steps")
        self.chains = chains


def run_ensembles(
    target: Target,
    options: SamplerOptions,
    store: SampleStore | None = None,
    progress: Callable[[EnsembleProgress], None] | None = None,
    moves: MoveFactory | None = None,
) -> Chains:
    """Sample a target until the stopping rule is met, importance sampling is accepted or ``max_steps`` are made.

    The draws depend on the target, ``options.seed``, the numbers of ensembles and walkers and the moves alone. They are
    the same to the last bit with any number of cores, and
    whether or not the run was interrupted and resumed; where it stops depends on the number of steps alone.

    Parameters
    ----------
    target : the density
    options : seed, sizes, when to stop, how to compute
    store : where steps are kept; a store that resumes gives the steps it holds
    progress : called at the beginning and after every block of steps
    moves : builds the proposals; those that suit an expensive target, or another, if omitted

    Returns
    -------
    all steps and the verdict

    Raises
    ------
    SamplingInterrupted
        On Ctrl-C, with the steps of whole blocks so far.
    InputError
        If starts are impossible, or the store cannot be used (see :meth:`SampleStore.open`).
    MachineError
        If steps cannot be stored any more, or a worker process died twice; steps stored before are kept.
    """
    moves = moves or _moves_for(target, options)
    rounds = store.open(draw_identity(target, options, moves)) if store is not None else []
    last = options.max_steps // options.block_steps * options.block_steps
    report: StoppingReport | None = None
    states = gathered(rounds[-1], len(rounds), options.seed) if rounds else initial_states(target, options)
    resumed, spent = len(rounds), 0.0
    finish = Finish(target, options)
    work = _Work(target, options.block_steps, moves)
    try:
        with sharing_out(work, min(options.cores, options.ensembles)) as crew:
            for number in range(1, resumed):  # when the next attempt is due hangs on those before
                _attempt(finish, rounds[:number], options, crew)
            while True:
                steps = len(rounds) * options.block_steps
                if steps and (is_check(steps, options.block_steps) or steps >= last):
                    report = _judged(target, options, rounds)
                if progress is not None:
                    made = (len(rounds) - resumed) * options.block_steps
                    walkers = sum(len(state.positions) for state in states)
                    far = sum(left_behind(state.log_density, len(target.names)).sum() for state in states)
                    pace = spent / made if made else None
                    progress(EnsembleProgress(steps, last, report, options, walkers, int(far), pace))
                accepted = _attempt(finish, rounds, options, crew)
                if report is None and accepted is not None:
                    report = _judged(target, options, rounds)
                if report is not None and (accepted is not None or report.converged or steps >= last):
                    if store is not None:
                        store.complete()
                    chains = _chains(target, options, rounds, report)
                    evaluations = chains.evaluations + finish.evaluations
                    return replace(
                        chains, importance=accepted, refused=finish.refused, evaluations=evaluations
                    )
                started = time.perf_counter()
                blocks = crew(states)
                spent += time.perf_counter() - started
                if store is not None:
                    store.append(blocks)
                rounds.append(blocks)
                states = gathered(blocks, len(rounds), options.seed)
    except KeyboardInterrupt:
        if store is not None:
            store.complete()
        if not rounds:
            raise SamplingInterrupted(None) from None
        report = _judged(target, options, rounds)
        raise SamplingInterrupted(_chains(target, options, rounds, report)) from None


@dataclass(frozen=True)
class _Work:
    """What worker processes do: move an ensemble one block further, or evaluate positions."""

    target: Target
    steps: int
    moves: MoveFactory

    def __call__(self, task: EnsembleState | FloatArray) -> Any:
        if isinstance(task, EnsembleState):
            return advance(self.target, task, self.steps, self.moves)
        return Density(self.target)(task)


def draw_identity(
    target: Target, options: SamplerOptions, moves: MoveFactory | None = None
) -> dict[str, Any]:
    """Everything the draws depend on; a stored run can only be continued with the same.

    Parameters
    ----------
    target, options, moves : as in :func:`run_ensembles`

    Returns
    -------
    values that can be written as JSON, under names that make sense in a message
    """
    moves = moves or _moves_for(target, options)
    made = moves if hasattr(moves, "__qualname__") else type(moves)
    return {
        FINGERPRINT: target.fingerprint,
        "coordinates": list(target.names),
        "sampler option seed": options.seed,
        "sampler option ensembles": options.ensembles,
        "sampler option walkers": options.walkers_for(moved_together(target)),
        "sampler option block_steps": options.block_steps,
        "moves": f"{made.__module__}.{made.__qualname__}",
    }


def _moves_for(target: Target, options: SamplerOptions) -> MoveFactory:
    if is_hierarchical(target):
        return HierarchicalMoves(target)  # type: ignore[arg-type]
    return moves_for(options.expensive or options.importance)


def _attempt(
    finish: Finish,
    rounds: list[list[EnsembleSteps]],
    options: SamplerOptions,
    crew: Callable[[Sequence[Any]], list[Any]],
) -> ImportanceDraws | None:
    discarded = last_gathering(rounds) * options.block_steps
    steps = len(rounds) * options.block_steps
    return finish.attempt(steps, partial(_joined, rounds), crew, discarded, _spent(rounds))


def _spent(rounds: list[list[EnsembleSteps]]) -> int:
    """Evaluations for steps and the starts before them."""
    return sum(block.evaluations for blocks in rounds for block in blocks)


def _judged(target: Target, options: SamplerOptions, rounds: list[list[EnsembleSteps]]) -> StoppingReport:
    discarded = last_gathering(rounds) * options.block_steps
    return judge(_joined(rounds, "positions"), target.names, options, discarded)


def _joined(rounds: list[list[EnsembleSteps]], name: str) -> FloatArray:
    return np.concatenate([np.stack([getattr(block, name) for block in blocks]) for blocks in rounds], axis=1)


def _chains(
    target: Target, options: SamplerOptions, rounds: list[list[EnsembleSteps]], report: StoppingReport
) -> Chains:
    return Chains(
        names=target.names,
        positions=_joined(rounds, "positions"),
        log_density=_joined(rounds, "log_density"),
        report=report,
        evaluations=_spent(rounds),
        invalid=sum(block.invalid for blocks in rounds for block in blocks),
        first_invalid=next(
            (block.first_invalid for blocks in rounds for block in blocks if block.invalid),
            np.full(len(target.names), np.nan),
        ),
    )
