"""A changed problem, sampled anew: the same data under other priors, or some of the data left out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray

if TYPE_CHECKING:
    from skinbayes.problem import JointProblem, Problem

SAMPLE_SIZE = 1000.0
"""Effective sample size in every parameter unless told otherwise."""

MOST_DRAWS = 4000
"""Draws of equal weight that are looked at; of those with weights all are."""


@dataclass(frozen=True)
class SampledAnew:
    """Draws of a posterior.

    Attributes
    ----------
    theta : parameter vectors, shape ``(S, D)``
    log_weights : of the draws, up to a constant, shape ``(S,)``; None if they all weigh the same
    evidence : ln Z and its standard error, where they are known
    converged : whether the stopping rule was met
    ess : effective sample size of all that was sampled, the smallest of any parameter; 0 if it is not known
    """

    theta: FloatArray
    log_weights: FloatArray | None
    evidence: tuple[float, float] | None
    converged: bool
    ess: float


def sampled_anew(
    problem: Problem | JointProblem, *, seed: int, max_steps: int, ess: float = SAMPLE_SIZE
) -> SampledAnew:
    """Sample a problem as a fit of default options does, without a run of its own on disk.

    Parameters
    ----------
    problem : with data
    seed : non-negative integer
    max_steps : steps of each ensemble after which that ends, converged or not
    ess : effective sample size wanted in every parameter

    Raises
    ------
    InputError
        No table can be made for the priors, or too few starts have a finite density.
    """
    from skinbayes.sampling.ensemble_engine import EnsembleEngine
    from skinbayes.sampling.options import SamplerOptions

    problem.prepare()
    target = problem.target()
    options = SamplerOptions(seed=seed, ess=ess, max_steps=max_steps, expensive=problem.expensive)
    draws = EnsembleEngine().run(target, options)
    weights, positions = draws.log_weights, draws.samples
    if weights is None:
        positions = draws.equally_weighted(MOST_DRAWS, np.random.default_rng(seed))
    return SampledAnew(
        theta=target.transform.inverse(positions.reshape(-1, draws.dimension)),
        log_weights=None if weights is None else weights.ravel(),
        evidence=draws.log_evidence,
        converged=bool(draws.diagnostics["converged"]),
        ess=float(np.min(draws.diagnostics["ess_bulk"])),
    )
