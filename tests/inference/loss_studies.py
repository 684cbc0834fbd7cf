"""Simulated finger pads whose tissue relaxes, or does not: what comes back, and which substrate the evidence prefers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from importance import importance_sample, mode
from simulated_coverage import possible_draws

from skinbayes.problem import Problem, load_problem
from skinbayes.problem.simulated import with_data

SEED = 31
LOSS = "loss_tangent_bulk"


@dataclass(frozen=True)
class FoundLoss:
    """What is found in the data of one simulation.

    Attributes
    ----------
    truth : tan δ that it was simulated with, 0 for elastic skin
    level : posterior probability of a smaller one
    mean, width : of the posterior of tan δ
    preference : ln of the evidence of skin that relaxes over that of elastic skin
    """

    truth: float
    level: float
    mean: float
    width: float
    preference: float


@lru_cache(maxsize=2)
def problem_of(name: str) -> Problem:
    """A shipped model of finger pads, its table built or read."""
    problem = load_problem(name)
    assert problem.model is not None
    return problem


def simulation(number: int, kind: str = "prior") -> FoundLoss:
    """Simulate data at the 165 conditions and find the posterior and both evidences.

    Simulations do not depend on each other.

    Parameters
    ----------
    number : which
    kind : "prior": all parameters are drawn from the prior; "elastic": from that of elastic skin; "small": from the prior, but
        tan δ evenly between 0 and 0.1
    """
    rng = np.random.default_rng([SEED, ("prior", "elastic", "small").index(kind), number])
    relaxing, elastic = (problem_of(f"finger-stribeck{end}") for end in ("-viscoelastic", ""))
    place = relaxing.names.index(LOSS)
    maker = elastic if kind == "elastic" else relaxing
    (truth,) = possible_draws(maker, rng, 1)
    if kind == "small":
        truth[place] *= 0.2
    data = maker.simulate(truth, rng)
    found, without = (
        importance_sample(problem, rng, least=250, start=mode(problem, rng))
        for problem in (with_data(relaxing, data), with_data(elastic, data))
    )
    losses = relaxing.target().transform.inverse(found.positions)[:, place]
    loss = 0.0 if kind == "elastic" else float(truth[place])
    mean = float(found.weights @ losses)
    return FoundLoss(
        truth=loss,
        level=(found.effective_size * float(found.weights @ (losses < loss)) + 0.5)
        / (found.effective_size + 1),
        mean=mean,
        width=float(np.sqrt(found.weights @ np.square(losses - mean))),
        preference=found.log_evidence - without.log_evidence,
    )
