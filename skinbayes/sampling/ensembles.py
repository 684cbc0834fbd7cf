"""Sampling a target with several independent ensembles until the stopping rule is met."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from skinbayes.sampling.advance import Block, EnsembleState, advance
from skinbayes.sampling.chains import Chains
from skinbayes.sampling.moves import MoveFactory, default_moves
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.starts import initial_states
from skinbayes.sampling.stopping import StoppingReport, is_check, judge
from skinbayes.sampling.target import Target


@dataclass(frozen=True)
class Progress:
    """How far a run is, told after every block.

    Attributes
    ----------
    steps : steps of each ensemble so far
    max_steps : where the run ends at the latest
    report : the latest verdict of the stopping rule, None before the first
    """

    steps: int
    max_steps: int
    report: StoppingReport | None


def run_ensembles(
    target: Target,
    options: SamplerOptions,
    progress: Callable[[Progress], None] | None = None,
    moves: MoveFactory = default_moves,
) -> Chains:
    """Sample a target until the stopping rule is met or ``max_steps`` are made.

    Parameters
    ----------
    target : the density
    options : seed, sizes, when to stop
    progress : called after every block of steps
    moves : builds the proposals

    Returns
    -------
    all steps and the verdict
    """
    starts = initial_states(target, options)
    run = _Run(target, options, starts)
    last = options.max_steps // options.block_steps * options.block_steps
    report: StoppingReport | None = None
    while True:
        if run.steps and (is_check(run.steps, options.block_steps) or run.steps >= last):
            report = judge(run.positions(), target.names, options)
        if progress is not None and run.steps:
            progress(Progress(run.steps, last, report))
        if report is not None and (report.converged or run.steps >= last):
            return run.chains(report)
        run.append(
            [advance(target, state, options.block_steps, options.vectorize, moves) for state in run.states]
        )


@dataclass
class _Run:
    target: Target
    options: SamplerOptions
    states: list[EnsembleState]
    rounds: list[list[Block]] = field(default_factory=list)

    @property
    def steps(self) -> int:
        return len(self.rounds) * self.options.block_steps

    def append(self, blocks: list[Block]) -> None:
        self.rounds.append(blocks)
        self.states = [block.end for block in blocks]

    def positions(self) -> np.ndarray:
        return np.concatenate(
            [np.stack([block.positions for block in blocks]) for blocks in self.rounds], axis=1
        )

    def chains(self, report: StoppingReport) -> Chains:
        blocks = [block for blocks in self.rounds for block in blocks]
        starts = self.options.ensembles * len(self.states[0].log_density)
        return Chains(
            names=self.target.names,
            positions=self.positions(),
            log_density=np.concatenate([np.stack([b.log_density for b in bs]) for bs in self.rounds], axis=1),
            report=report,
            evaluations=starts + sum(block.evaluations for block in blocks),
            invalid=sum(block.invalid for block in blocks),
        )
