"""Nested sampling by dynesty as an engine: draws with weights, and the evidence."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.sampling.draws import Draws
from skinbayes.sampling.options import EngineOptions, whole
from skinbayes.sampling.progress import PlainProgress, RunProgress
from skinbayes.sampling.store import SampleStore
from skinbayes.sampling.target import Target
from skinbayes.sampling.workers import sharing_out

REST = 0.01
"""A run ends when what is left of the evidence is at most this in its logarithm."""

FEWEST_RUNS = 4
"""Runs that are made at least, so that they can be held against each other."""

TOLD = 100
"""Iterations between two calls of ``progress``."""


@dataclass(frozen=True)
class NestedOptions(EngineOptions):
    """Settings of nested sampling.

    Attributes
    ----------
    live_points : of each run; enough to find every mode
    max_runs : independent runs, whose points are merged, until the effective sample size is reached; then the engine gives up

    Raises
    ------
    InputError
        dynesty is not installed, or a value is out of range.
    """

    live_points: int = 250
    max_runs: int = 40

    def __post_init__(self) -> None:
        super().__post_init__()
        whole("live_points", self.live_points, 20)
        whole("max_runs", self.max_runs, 1)
        if find_spec("dynesty") is None:
            raise InputError(
                "engine 'nested': dynesty is not installed; install it with: pip install 'skinbayes[nested]'"
            )


class NestedEngine:
    """Independent runs of dynesty, merged until their weighted draws have the effective sample size wanted.

    Speagle 2020, doi 10.1093/mnras/staa278; Skilling 2006, doi 10.1214/06-BA127. Points move along random slices, scaled by one
    ellipsoid about all live points. On a ridge a hundred times longer than wide, random walks left the median of a run of 100
    live points uncertain by 0.10 in probability, slices by 0.05 (four runs each); the weights alone would claim 0.025.
    Therefore at least four runs are made, and the effective sample size is what their disagreement leaves of that of the weights.
    Runs are not stored: what was stopped begins anew. The same seed gives the same draws on any number of cores, which share the
    runs: each has its own stream, and how many of them are merged depends on what they found in their order alone.
    """

    options = NestedOptions
    package = "dynesty"

    def run(
        self,
        target: Target,
        options: NestedOptions,
        store: SampleStore | None = None,
        progress: Callable[[RunProgress], None] | None = None,
    ) -> Draws:
        """Weighted draws, one chain, and the evidence with its error."""
        import dynesty.utils

        runs: list[Any] = []
        steps = 0
        told = progress if options.cores == 1 else None  # worker processes cannot tell
        with sharing_out(partial(_run, target, options, told), options.cores) as run_all:
            while True:
                last = min(len(runs) + options.cores, options.max_runs)
                for result in run_all([(number, steps) for number in range(len(runs), last)]):
                    runs.append(result)
                    steps += int(result.niter)
                    if progress is not None:
                        words = f"ln Z of run {len(runs)} {float(result.logz[-1]):.1f}"
                        progress(PlainProgress(steps, words))
                    if len(runs) < min(FEWEST_RUNS, options.max_runs):
                        continue
                    found = dynesty.utils.merge_runs(runs, print_progress=False) if len(runs) > 1 else runs[0]
                    sizes = _effective_sizes(runs, found)
                    if sizes.min() >= options.ess or len(runs) >= options.max_runs:
                        return _finished(found, sizes, options, len(runs), steps)


def _run(
    target: Target,
    options: NestedOptions,
    progress: Callable[[RunProgress], None] | None,
    task: tuple[int, int],
) -> Any:
    """One run of dynesty, a function of its number alone; the iterations before it are for ``progress``."""
    import dynesty

    sampler = dynesty.NestedSampler(
        lambda position: float(target.log_likelihood(position[np.newaxis])[0]),
        lambda unit: target.prior_transform(unit[np.newaxis])[0],
        len(target.names),
        nlive=options.live_points,
        bound="single",
        sample="rslice",
        rstate=np.random.default_rng([options.seed, task[0]]),
    )
    with warnings.catch_warnings():
        # on a narrow ridge dynesty says once that steps along it are many, and then doubles them
        warnings.filterwarnings(
            "ignore", "The slice sample interval was exp|Enabling doubling strategy", UserWarning
        )
        sampler.run_nested(dlogz=REST, print_progress=progress is not None, print_func=_told(progress, *task))
    return sampler.results


def _effective_sizes(runs: list[Any], found: Any) -> FloatArray:
    """Effective sample size of each coordinate: by the weights, or by how far the means of the runs differ if that is less."""
    weights = found.importance_weights()
    by_weights = np.full(found.samples.shape[1], 1.0 / np.sum(weights**2))
    if len(runs) < FEWEST_RUNS:
        return by_weights
    means = np.array([run.importance_weights() @ run.samples for run in runs])
    variance = weights @ (found.samples - weights @ found.samples) ** 2
    return np.minimum(by_weights, len(runs) * variance / means.var(axis=0, ddof=1))


def _finished(found: Any, sizes: FloatArray, options: NestedOptions, runs: int, steps: int) -> Draws:
    evidence, size = (float(found.logz[-1]), float(found.logzerr[-1])), float(sizes.min())
    lacking = f"the effective sample size is {size:.0f}, {options.ess:.0f} is asked for"
    words = f"effective sample size at least {size:.0f}, ln Z = {evidence[0]:.2f} ± {evidence[1]:.2f}"
    said = f"Converged after {steps} iterations: {words}."
    if size < options.ess:
        said = (
            f"Not converged after {steps} iterations: {lacking}. What to do: more live points, or more runs."
        )
    diagnostics = {
        "converged": size >= options.ess,
        "verdict": said,
        "missing": [lacking] if size < options.ess else [],
        "runs": runs,
        "live_points": options.live_points,
        "steps": steps,
        "evaluations": int(np.sum(found.ncall)),
        "ess_bulk": sizes,
    }
    return Draws(found.samples, found.logwt, evidence, diagnostics)


def _told(progress: Callable[[RunProgress], None] | None, number: int, before: int) -> Any:
    """What dynesty calls at each iteration."""

    def tell(state: Any, iteration: int, calls: int, **more: Any) -> None:
        if progress is not None and iteration % TOLD == 1:
            left = f"ln of what is left of Z {state.delta_logz:.1f}"
            progress(PlainProgress(before + iteration, f"run {number + 1}: ln Z {state.logz:.1f}, {left}"))

    return tell
