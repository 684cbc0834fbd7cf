"""The posterior of a problem, as samplers see it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.statistics.densities import LogDensity
from skinbayes.statistics.transforms import VectorTransform

if TYPE_CHECKING:
    from skinbayes.problem.problem import Problem

CANDIDATES_PER_START = 20
"""Prior draws looked at for each start."""


@dataclass(frozen=True)
class PosteriorTarget:
    """Posterior density in unconstrained coordinates: log for positive parameters, logit for bounded ones.

    Attributes
    ----------
    problem : the problem
    use_likelihood : False samples the prior alone, a test of the whole machinery
    """

    problem: Problem
    use_likelihood: bool = True

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the free parameters."""
        return self.problem.names

    @property
    def fingerprint(self) -> str:
        """Digest of model, data, priors and version."""
        return self.problem.fingerprint + ("" if self.use_likelihood else "-prior")

    @cached_property
    def transform(self) -> VectorTransform:
        """Map between parameters in SI and the real space."""
        return VectorTransform.for_supports([p.prior.support for p in self.problem.free if p.prior])

    @cached_property
    def _density(self) -> LogDensity:
        prior = self.problem.prior_density()
        density = prior.times(self.problem.data_likelihood()) if self.use_likelihood else prior
        return density.transformed(self.transform)

    def log_density(self, position: FloatArray) -> FloatArray:
        """Log posterior density of each row of ``position``, Jacobian included; −inf where impossible.

        NaN where the forward model has no answer, which the sampler counts and takes as impossible.
        """
        with np.errstate(all="ignore"):
            return self._density(position)

    def starts(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Positions to start from: prior draws, thinned towards the posterior but as dispersed as the draws allow.

        Of 20 prior draws for each start, ``count`` different ones are drawn with probability ∝ L^β; β ≤ 1 is as large as
        it can be while the effective number of candidates stays at or above ``count``.

        Raises
        ------
        InputError
            Fewer than ``count`` of the prior draws have a finite posterior density.
        """
        theta = self.problem.draw_prior(rng, CANDIDATES_PER_START * count)
        position = self.transform.forward(theta)
        # the likelihood is what costs: it is evaluated once for each candidate
        weight = self.problem.log_likelihood(theta) if self.use_likelihood else np.zeros(len(theta))
        prior = replace(self, use_likelihood=False).log_density(position)
        usable = np.isfinite(prior + weight) & np.isfinite(position).all(axis=-1)
        if usable.sum() < count:
            raise InputError(
                f"{self.problem.spec.path}: only {usable.sum()} of {len(usable)} prior draws have a finite posterior density; "
                "the priors mostly cover values at which the forward model gives no prediction (see 'skinbayes check')"
            )
        position, weight = position[usable], weight[usable]
        beta = _tempering(weight, count)
        # Gumbel top-k: sampling without replacement with probability ∝ exp(β·weight)
        keys = beta * weight + rng.gumbel(size=weight.shape)
        return position[np.argsort(-keys)[:count]]


def _tempering(log_weight: FloatArray, count: int) -> float:
    low, high = 0.0, 1.0
    if _effective(log_weight) >= count:
        return 1.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if _effective(middle * log_weight) >= count else (low, middle)
    return low


def _effective(log_weight: FloatArray) -> float:
    weight = np.exp(log_weight - log_weight.max())
    return float(weight.sum() ** 2 / (weight**2).sum())
