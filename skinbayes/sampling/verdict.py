"""The verdict on a run of ensembles in words: what is missing, why, and what to do about it."""

from __future__ import annotations

from math import ceil

import numpy as np

from skinbayes.sampling.causes import Cause, cause, thinned
from skinbayes.sampling.chains import Chains
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.progress import steps_needed
from skinbayes.sampling.target import Target

FEW = 4
"""Walkers apart that a ridge explains."""


def verdict(chains: Chains, target: Target, options: SamplerOptions) -> str:
    """The sentence of the stopping rule; of a run that has not converged also the cause and the remedy."""
    said = chains.report.sentence()
    if chains.converged:
        return said
    shared = target.integrated_out(thinned(chains), np.random.default_rng([options.seed, 6]))
    found = cause(chains, shared)
    return f"{said} {_because(found, chains)} {_remedy(found, chains.steps, steps_needed(chains.report, options))}"


def _because(found: Cause, chains: Chains) -> str:
    name = found.slowest
    if _two_places(found):
        return (
            f"Cause: two groups of walkers in different places, {found.apart} of {found.walkers} apart in {name}: "
            "stuck, or a second mode."
        )
    if found.partner is not None:
        return (
            f"Cause: a ridge between {name} and {found.partner} (rank correlation {found.correlation:.2f}): the data know "
            "the two together, not each."
        )
    tau = float(chains.report.tau[chains.names.index(name)])
    time = (
        f"{tau:.0f} steps"
        if np.isfinite(tau)
        else f"over {(chains.steps - chains.report.burn_in) // 10} steps"
    )
    return f"Cause: the run is short for {name}, whose autocorrelation time is {time}."


def _two_places(found: Cause) -> bool:
    """Whether walkers apart are the cause; one or two at the end of a ridge are a sign of the ridge."""
    return found.apart > (FEW if found.partner is not None else 0)


def _remedy(found: Cause, steps: int, steps_needed: int | None) -> str:
    more = max(steps_needed or 0, 2 * steps)
    longer = f"--resume --max-steps {ceil(more / 1000) * 1000}"
    if _two_places(found):
        tighter = f"a tighter prior on {found.slowest}"
        return f"What to do: fit with other seeds; if both places remain, {tighter} decides between them."
    if found.partner is not None:
        other = found.partner.removeprefix("the effect of ")
        whose = f"the scale of the groups of {other}" if other != found.partner else found.partner
        return f"What to do: a tighter prior on {found.slowest} or on {whose}, or more steps with {longer}."
    return f"What to do: more steps with {longer}."
