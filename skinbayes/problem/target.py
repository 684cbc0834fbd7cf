"""The posterior of a problem, as samplers see it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import isfinite

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.problem.failures import impossible
from skinbayes.problem.funnels import straightened
from skinbayes.problem.joint_densities import JointModel
from skinbayes.problem.memory import LOGARITHM, with_innovations
from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.statistics.annealing import SWEEPS, anneal, effective_number, largest_power
from skinbayes.statistics.densities import LogDensity
from skinbayes.statistics.hierarchy import Hierarchy
from skinbayes.statistics.innovations import InnovationTransform
from skinbayes.statistics.priors import IndependentPriors
from skinbayes.statistics.transforms import Transform, VectorTransform, transform_for

CANDIDATES_PER_START = 20
"""Prior draws looked at for each start."""

FOUND = 2.0
"""Effective number of candidates under the whole likelihood below which the prior draws have not found the posterior."""

DISPERSION = 0.25
"""Power of the likelihood at which starts led towards the posterior are left: twice as wide as it."""

SWEEPS_WITH_MEMORY, DISPERSION_WITH_MEMORY = 20, 0.5
"""Moves on the way there at each power, and that at which starts are left, where noise has a memory. With as few moves as
otherwise the starts of a drying series lay 200 below the posterior, all alike, and ensembles took a hundred steps to spread."""


@dataclass(frozen=True)
class PosteriorTarget:
    """Posterior density in unconstrained coordinates: log for positive parameters, logit for bounded ones.

    Where groups share effects, bounded positive parameters are logarithms with walls instead. Levels of a parameter and the
    effects of a group exchange a factor, or, where effects are added to the data, an amount: together they are known as badly
    as the effects, their ratios or differences as well as the data. That ridge is straight in logarithms, or in the data that the
    levels predict. Logits bend it towards the bounds: differences of walkers in the middle no longer point along it, and walkers
    in its tails stay there for thousands of steps. Where a parameter differs by the very levels that have effects, the
    funnel between it and the scale of the effects is straightened too.

    Attributes
    ----------
    problem : the problem
    use_likelihood : False samples the prior alone, a test of the whole machinery
    """

    problem: StatisticalModel | JointModel
    use_likelihood: bool = True

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the free parameters."""
        return self.problem.names

    @property
    def fingerprint(self) -> str:
        """Digest of model, data, priors and version, and of coordinates that are not the usual ones."""
        supports = [p.prior.support for p in self.problem.free if p.prior]
        walls = "" if self._without_memory == VectorTransform.for_supports(supports) else "-walls"
        memory = "-innovations" if isinstance(self.transform, InnovationTransform) else ""
        return self.problem.fingerprint + walls + memory + ("" if self.use_likelihood else "-prior")

    @cached_property
    def transform(self) -> VectorTransform:
        """Map between parameters in SI and the real space; the density is zero where it leads out of their support."""
        return with_innovations(self.problem, self._without_memory)

    @cached_property
    def _without_memory(self) -> VectorTransform:
        """The coordinates if noise had no memory."""
        supports = [p.prior.support for p in self.problem.free if p.prior]
        if all(part.groups is None for part, _ in self.problem.parts.values()):
            return VectorTransform.for_supports(supports)
        walls = VectorTransform(tuple(_with_walls(support) for support in supports))
        # what several experiments share is known from all of them, so that funnels of one are none of the whole
        return straightened(self.problem, walls) if isinstance(self.problem, StatisticalModel) else walls

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

    def log_likelihood(self, position: FloatArray) -> FloatArray:
        """Log-likelihood of each row of ``position``; −inf where the forward model has no answer."""
        if not self.use_likelihood:
            return np.zeros(len(position))
        with np.errstate(all="ignore"):
            return impossible(self.problem.data_likelihood()(self.transform.inverse(position)))

    @cached_property
    def hierarchy(self) -> Hierarchy | None:
        """Which coordinates belong to single people; None where no parameter has a population.

        None also where rows share something that is integrated out: then people are not independent given what they share.
        """
        problem = self.problem
        if (
            not isinstance(problem, StatisticalModel)
            or problem.populations is None
            or problem.shared is not None
        ):
            return None
        return problem.populations.hierarchy(problem.conditions, len(problem.observations))

    def pointwise(self, position: FloatArray) -> FloatArray:
        """Log-likelihood of each datum, ``(B, M)``; −inf where impossible, NaN where the forward model has no answer."""
        assert isinstance(self.problem, StatisticalModel)
        if not self.use_likelihood:
            return np.zeros((len(position), self.problem.likelihood.size))
        with np.errstate(all="ignore"):
            return self.problem.likelihood.pointwise(self.transform.inverse(position))

    def log_prior(self, position: FloatArray) -> FloatArray:
        """Log prior density of each row of ``position``, Jacobian included."""
        with np.errstate(all="ignore"):
            return self._prior(position)

    @cached_property
    def _prior(self) -> LogDensity:
        return self.problem.prior_density().transformed(self.transform)

    def shared_parameters(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Of those coordinates that are no deviates, ``(B, K)``: parameters in SI, and ln of the prior density of each."""
        transform, prior = self._of_shared
        with np.errstate(all="ignore"):
            theta = transform.inverse(position)
            density = prior.each(theta)
            # where the density is zero the Jacobian may be infinite
            return theta, np.where(
                density > -np.inf, density + transform.log_jacobian_each(position), -np.inf
            )

    @cached_property
    def _of_shared(self) -> tuple[VectorTransform, IndependentPriors]:
        assert self.hierarchy is not None
        places = self.hierarchy.shared
        priors = [self.problem.free[i].prior for i in places]
        transform = VectorTransform(tuple(self.transform.transforms[i] for i in places))
        return transform, IndependentPriors(tuple(p for p in priors if p))

    def prior_transform(self, unit: FloatArray) -> FloatArray:
        """Positions at quantiles of the prior, rows of the unit cube ``(B, D)``."""
        return self.transform.forward(self.problem.prior_transform(unit))

    def integrated_out(self, position: FloatArray, rng: np.random.Generator) -> dict[str, FloatArray]:
        """Effects of each group, averaged over its levels."""
        theta, found = self.transform.inverse(position), {}
        for name, (part, place) in self.problem.parts.items():
            if part.groups is not None:
                effects = part.draw_effects(theta[:, place], rng)
                for column in part.groups.columns:
                    words = f"the effect of {column}" + (f" in {name}" if name else "")
                    found[words] = effects[:, part.groups.effects_of(column)].mean(axis=1)
        return found

    def starts(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Positions to start from: prior draws, thinned towards the posterior but as dispersed as the draws allow.

        See :meth:`starts_counted`.
        """
        return self.starts_counted(rng, count)[0]

    def starts_counted(self, rng: np.random.Generator, count: int) -> tuple[FloatArray, int]:
        """Positions to start from, shape ``(count, D)``, and the likelihoods that were evaluated to find them.

        Of 20 prior draws for each start, ``count`` different ones are drawn with probability ∝ L^β; β ≤ 1 is as large as
        it can be while the effective number of candidates stays at or above ``count``. Where one candidate outweighs all the
        others together, the starts are led on by `anneal`, until β is a quarter.

        Raises
        ------
        InputError
            Fewer than ``count`` of the prior draws have a finite posterior density.
        """
        if self.hierarchy is not None:
            return self._starts_of_people(rng, count)
        theta = self.problem.draw_prior(rng, CANDIDATES_PER_START * count)
        position = self.transform.forward(theta)
        # the likelihood is what costs: it is evaluated once for each candidate
        found = self.problem.data_likelihood()(theta) if self.use_likelihood else np.zeros(len(theta))
        weight = impossible(found)
        prior = replace(self, use_likelihood=False).log_density(position)
        usable = np.isfinite(prior + weight) & np.isfinite(position).all(axis=-1)
        if usable.sum() < count:
            path, without = self.problem.spec.path, int(np.isnan(found).sum())
            remedy = (
                f"the forward model gives no prediction at {without} of them. What to do: narrow the priors to values at "
                f"which it does; 'skinbayes check {path}' names some at which it does not"
                if 2 * without > len(usable) - usable.sum()
                else "nearly all of them make the data impossible. What to do: widen the noise or the priors until they reach "
                f"the data; 'skinbayes prior {path}' shows how far they are"
            )
            raise InputError(
                f"{path}: only {usable.sum()} of {len(usable)} prior draws have a finite posterior density, where {count} are "
                f"needed to start from; {remedy}"
            )
        position, weight = position[usable], weight[usable]
        beta = largest_power(weight, count)
        # Gumbel top-k: sampling without replacement with probability ∝ exp(β·weight)
        chosen = np.argsort(-(beta * weight + rng.gumbel(size=weight.shape)))[:count]
        evaluated = len(theta) if self.use_likelihood else 0
        if effective_number(weight) > FOUND:
            return position[chosen], evaluated
        only_prior = replace(self, use_likelihood=False).log_density
        final, sweeps = DISPERSION, SWEEPS
        if isinstance(self.transform, InnovationTransform):
            final, sweeps = DISPERSION_WITH_MEMORY, SWEEPS_WITH_MEMORY

        def likelihood(moved: FloatArray) -> FloatArray:
            nonlocal evaluated
            evaluated += len(moved)
            return self.log_likelihood(moved)

        led = anneal(position[chosen], weight[chosen], beta, final, only_prior, likelihood, rng, sweeps)
        return led, evaluated

    def _starts_of_people(self, rng: np.random.Generator, count: int) -> tuple[FloatArray, int]:
        """Draws of the prior: with many people none of them is near the data, and moves person by person lead there."""
        theta = self.problem.draw_prior(rng, CANDIDATES_PER_START * count)
        position = self.transform.forward(theta)
        usable = np.isfinite(self.log_density(position)) & np.isfinite(position).all(axis=-1)
        if usable.sum() < count:
            raise InputError(
                f"{self.problem.spec.path}: only {usable.sum()} of {len(usable)} prior draws have a finite posterior density, "
                f"where {count} are needed to start from; narrow the priors to values at which there is a prediction"
            )
        return position[usable][:count], len(theta)


def _with_walls(support: tuple[float, float]) -> Transform:
    """Logarithms of a bounded positive parameter, the usual coordinates of others."""
    lower, upper = support
    return LOGARITHM if lower >= 0.0 and isfinite(upper) else transform_for(support)
