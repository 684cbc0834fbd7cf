"""Ensembles of emcee as an engine."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from skinbayes.sampling.chains import Chains
from skinbayes.sampling.draws import Draws
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.progress import RunProgress
from skinbayes.sampling.store import SampleStore
from skinbayes.sampling.target import Target
from skinbayes.sampling.verdict import verdict

DRAWS_PER_CHAIN = 2500
"""Draws kept of each ensemble; nearly independent, so four ensembles give quantiles to about 0.01 sd."""


class EnsembleEngine:
    """Several independent ensembles of emcee, run until the stopping rule is met; see :func:`run_ensembles`."""

    options = SamplerOptions
    package = "emcee"

    def run(
        self,
        target: Target,
        options: SamplerOptions,
        store: SampleStore | None = None,
        progress: Callable[[RunProgress], None] | None = None,
    ) -> Draws:
        """Nearly independent draws; a chain is an ensemble."""
        chains = run_ensembles(target, options, store=store, progress=progress)
        positions, log_density = chains.draws(DRAWS_PER_CHAIN)
        words = verdict(chains, target, options)
        return Draws(positions, diagnostics=_diagnostics(chains, words), log_density=log_density)


def _diagnostics(chains: Chains, words: str) -> dict[str, Any]:
    report = chains.report
    return {
        "converged": report.converged,
        "verdict": words,
        "missing": list(report.missing),
        "ensembles": chains.positions.shape[0],
        "walkers": chains.positions.shape[2],
        "steps": chains.steps,
        "burn_in": report.burn_in,
        "thinning": chains.thinning(),
        "evaluations": chains.evaluations,
        "invalid": chains.invalid,
        "first_invalid": chains.first_invalid if chains.invalid else None,
        "acceptance_fraction": chains.acceptance_fraction(),
        "tau": report.tau,
        "ess_bulk": report.ess_bulk,
        "ess_tail": report.ess_tail,
        "r_hat": report.r_hat,
    }
