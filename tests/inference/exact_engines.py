"""Engines that draw from a posterior with few calculations, rightly or wrongly, for a constant of few Gaussian data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import logsumexp

import skinbayes as sb
from skinbayes.problem import Problem
from skinbayes.sampling import Draws


@dataclass(frozen=True)
class FromPrior:
    """Draws of the prior, weighted by a power of the likelihood and by a slope of the prior: with 1 and 0 the posterior.

    Attributes
    ----------
    power : of the likelihood; 4 is that of noise half as wide
    slope : ln of the prior is raised by so much for each unit of the first coordinate
    broken : seeds that are multiples of this end in an error
    unfinished : seeds that are multiples of this say that they have not converged
    """

    power: float = 1.0
    slope: float = 0.0
    broken: int = 0
    unfinished: int = 0

    def run(self, target: Any, options: Any, store: Any, progress: Any) -> Draws:
        if self.broken and options.seed % self.broken == 0:
            raise RuntimeError("no such posterior")
        place = target.prior_transform(np.random.default_rng(options.seed).random((4000, len(target.names))))
        likelihood = target.log_likelihood(place)
        weights = self.power * likelihood + self.slope * place[:, 0]
        size = float(np.exp(2 * logsumexp(likelihood) - logsumexp(2 * likelihood)))
        evidence = (float(logsumexp(likelihood) - np.log(4000)), float(np.sqrt(1 / size - 1 / 4000)))
        unfinished = bool(self.unfinished) and options.seed % self.unfinished == 0
        return Draws(
            place, log_weights=weights, log_evidence=evidence, diagnostics={"converged": not unfinished}
        )


def constant(width: float = 1.0, name: str = "constant") -> Problem:
    """Two data about a constant with a uniform prior of 0.4 to 0.4 + width."""
    return sb.build_problem(
        "constant",
        {"friction_coefficient [1]": [0.6, 0.7]},
        parameters={"typical_friction_coefficient": {"uniform": [0.4, 0.4 + width]}},
        noise={"family": "gaussian", "noise_scale": 0.15},
        name=name,
    )
