"""Ensembles of emcee as an engine."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from skinbayes.sampling.advance import Density
from skinbayes.sampling.chains import Chains
from skinbayes.sampling.draws import Draws
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.evidence import bridge, combined
from skinbayes.sampling.importance import LARGEST_SHAPE, importance_draws
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.progress import RunProgress
from skinbayes.sampling.search import FOUND_WITH
from skinbayes.sampling.store import SampleStore
from skinbayes.sampling.target import Target, is_hierarchical
from skinbayes.sampling.verdict import verdict
from skinbayes.sampling.weighted_draws import ImportanceDraws

EVIDENCE_DRAWS = 2000
"""Draws of a proposal for ln Z, where walkers gave those of the posterior: its error is then about 0.02."""

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
        """Nearly independent draws, a chain being an ensemble, or weighted ones if importance sampling was accepted; ln Z."""
        chains = run_ensembles(target, options, store=store, progress=progress)
        if chains.importance is not None:
            return _weighted(chains, chains.importance)
        positions, log_density = chains.draws(DRAWS_PER_CHAIN)
        words = verdict(chains, target, options)
        asked = options.importance and chains.converged and not is_hierarchical(target)
        evidence, spent = _evidence(chains, target, options) if asked else (None, 0)
        diagnostics = _diagnostics(chains, words) | {"evaluations": chains.evaluations + spent}
        if chains.refused:
            diagnostics["importance_refused"] = chains.refused
        return Draws(positions, None, evidence, diagnostics, log_density)


def _weighted(chains: Chains, found: ImportanceDraws) -> Draws:
    ensembles, _, walkers, _ = chains.positions.shape
    search = found.search
    words = (
        f"Converged: {ensembles} ensembles of {walkers} walkers found the posterior in {chains.steps} steps, and "
        f"{len(found.positions)} independent draws by importance sampling have an effective sample size of at least "
        f"{found.ess.min():.0f} (Pareto k {found.shape:.2f}, at most {LARGEST_SHAPE} is accepted). A part of the posterior "
        f"in less than 1/{len(found.positions) // FOUND_WITH} of the space that they cover can have been missed{_looked(found)}."
    )
    diagnostics = _explored(chains, words) | {
        "missing": [],
        "importance_draws": len(found.positions),
        "pareto_k": found.shape,
        "evaluations": chains.evaluations + len(found.positions) + (search.evaluations if search else 0),
        "ess_bulk": found.ess,
        "ess_tail": found.tail_ess,
    }
    return Draws(found.positions, found.log_weights, _bridged(chains, found), diagnostics, found.log_density)


def _looked(found: ImportanceDraws) -> str:
    """What was searched beside the draws, as the end of a sentence."""
    search = found.search
    if search is None or search.from_prior < FOUND_WITH:
        return ""
    places = "a place that was" if search.explorations == 1 else f"{search.explorations} places that were"
    more = f"{places} then explored" if search.explorations else "nothing else"
    return (
        f", outside it one in less than 1/{search.from_prior // FOUND_WITH} of the prior: {search.from_prior} draws of the prior "
        f"and {search.from_about} of a Cauchy distribution about the posterior found {more}"
    )


def _evidence(
    chains: Chains, target: Target, options: SamplerOptions
) -> tuple[tuple[float, float] | None, int]:
    """ln Z and its error where walkers gave the draws, None if no proposal resembles the posterior; and evaluations."""
    kept = chains.positions[:, chains.kept]
    density = Density(target)
    found = importance_draws(
        kept.reshape(len(kept), -1, kept.shape[-1]),
        chains.log_density[:, chains.kept].reshape(len(kept), -1),
        density,
        EVIDENCE_DRAWS / 2,
        np.random.default_rng([options.seed, 9]),
        EVIDENCE_DRAWS,
    )
    if isinstance(found, ImportanceDraws):
        return _bridged(chains, found), len(found.positions)
    return None, found.tried


def _bridged(chains: Chains, found: ImportanceDraws) -> tuple[float, float]:
    positions, log_density = chains.draws(DRAWS_PER_CHAIN)
    tau = chains.report.tau.max()
    kept = chains.positions[:, chains.kept, :, 0].size
    effective = min(kept / tau, log_density.size) if np.isfinite(tau) else chains.positions.shape[0]
    evidences = []
    for side, proposal in enumerate(found.proposals):
        at_walkers = proposal.log_density(positions.reshape(-1, positions.shape[-1]))
        at_draws = (found.log_density - found.log_proposal)[side::2]
        evidences.append(bridge(log_density - at_walkers.reshape(log_density.shape), at_draws, effective))
    bridged = combined([(one.value, one.error) for one in evidences], shared=True)
    plain = combined([(one.plain, one.plain_error) for one in evidences])
    if found.search is not None and found.search.explorations:
        return plain  # the ensembles had missed something
    # explored positions that are few and correlated add more error than they take away
    return min(bridged, plain, key=lambda one: one[1])


def _explored(chains: Chains, words: str) -> dict[str, Any]:
    """What is said of walkers whether they gave the draws or not."""
    return {
        "converged": chains.converged,
        "verdict": words,
        "ensembles": chains.positions.shape[0],
        "walkers": chains.positions.shape[2],
        "steps": chains.steps,
        "evaluations": chains.evaluations,
        "invalid": chains.invalid,
        "first_invalid": chains.first_invalid if chains.invalid else None,
    }


def _diagnostics(chains: Chains, words: str) -> dict[str, Any]:
    report = chains.report
    return _explored(chains, words) | {
        "missing": list(report.missing),
        "burn_in": report.burn_in,
        "thinning": chains.thinning(),
        "acceptance_fraction": chains.acceptance_fraction(),
        "tau": report.tau,
        "ess_bulk": report.ess_bulk,
        "ess_tail": report.ess_tail,
        "r_hat": report.r_hat,
    }
