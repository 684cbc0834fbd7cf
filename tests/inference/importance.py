"""Posterior of a problem by adaptive importance sampling.

Cheap where a hundred posteriors are wanted, independent of the sampler of the package, and it tells when it fails: the proposals
are multivariate Student's t densities, adapted from the prior through tempered posteriors, and the effective sample size of draws
from the last of them has to be large enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import lgamma, log, pi

import numpy as np
from scipy.optimize import minimize

from skinbayes.problem import Problem

DEGREES_OF_FREEDOM = 5.0
PRIOR_DRAWS = 1600
ROUND, FINAL = 2, 6
"""Draws of a round and of the end, over the effective size that is asked for."""
ROUNDS = 40
REMEMBERED = 4
"""Rounds whose draws a proposal is made from; the last draws come from as many proposals."""


@dataclass(frozen=True)
class Weighted:
    """Weighted draws in unconstrained coordinates.

    Attributes
    ----------
    positions : shape ``(n, D)``
    weights : shape ``(n,)``, their sum is 1
    evaluations : likelihoods computed on the way
    log_evidence : ln of the mean unnormalised weight
    """

    positions: np.ndarray
    weights: np.ndarray
    evaluations: int
    log_evidence: float

    @property
    def effective_size(self) -> float:
        """Independent draws that would be as good, 1 / Σ w²."""
        return float(1.0 / np.square(self.weights).sum())

    def levels(self, truth: np.ndarray) -> np.ndarray:
        """Posterior probability of less than ``truth`` ``(D,)`` in each coordinate, half an effective draw off 0 and 1."""
        below = self.weights @ (self.positions < truth)
        return (self.effective_size * below + 0.5) / (self.effective_size + 1.0)

    def moments(self) -> tuple[np.ndarray, np.ndarray]:
        """Mean and standard deviation of each coordinate."""
        mean = self.weights @ self.positions
        return mean, np.sqrt(self.weights @ np.square(self.positions - mean))


@dataclass(frozen=True)
class Student:
    """Multivariate Student's t with 5 degrees of freedom about ``middle``; ``root`` is a Cholesky factor of its scale."""

    middle: np.ndarray
    root: np.ndarray

    def draw(self, rng: np.random.Generator, count: int) -> np.ndarray:
        """``count`` draws, ``(count, D)``."""
        normal = rng.normal(size=(count, self.middle.size))
        stretch = np.sqrt(DEGREES_OF_FREEDOM / rng.chisquare(DEGREES_OF_FREEDOM, count))
        return self.middle + (stretch[:, np.newaxis] * normal) @ self.root.T

    def log_density(self, positions: np.ndarray) -> np.ndarray:
        """Log-density of each row."""
        nu, dimension = DEGREES_OF_FREEDOM, self.middle.size
        distance = np.square(np.linalg.solve(self.root, (positions - self.middle).T)).sum(axis=0)
        norm = lgamma((nu + dimension) / 2) - lgamma(nu / 2) - dimension / 2 * log(nu * pi)
        return norm - np.log(np.diag(self.root)).sum() - (nu + dimension) / 2 * np.log1p(distance / nu)


def mode(problem: Problem, rng: np.random.Generator, tries: int = 400) -> Student:
    """A proposal about the mode that is found uphill of the best of draws from the prior, as wide as its curvature says."""
    target = problem.target()
    draws = target.transform.forward(problem.draw_prior(rng, tries))
    density = target.log_density(draws)
    best = draws[np.argmax(np.where(np.isfinite(density), density, -np.inf))]
    step = 1e-3 * np.eye(problem.dimension)

    def downhill(position: np.ndarray) -> tuple[float, np.ndarray]:
        """Value and slope; by one side alone, or not at all, where the other is beyond what is possible."""
        around = np.concatenate([[position], position + step, position - step])
        value = -target.log_density(around)
        here, sides = value[0], value[1:].reshape(2, -1)
        good = np.isfinite(sides)
        rise = np.where(good, sides, here) if np.isfinite(here) else np.zeros_like(sides)
        slope = (rise[0] - rise[1]) / (np.maximum(good.sum(axis=0), 1) * step[0, 0])
        return (float(here), slope) if np.isfinite(here) else (1e10, slope)

    found = minimize(downhill, best, jac=True, method="BFGS", options={"gtol": 0.05, "maxiter": 60}).x
    wide = 20 * step
    slopes = np.array([downhill(place)[1] for place in np.concatenate([found + wide, found - wide])])
    ahead, behind = np.split(slopes, 2)
    curvature = (ahead - behind) / (2 * wide[0, 0])
    values, axes = np.linalg.eigh((curvature + curvature.T) / 2)
    spread = axes / np.sqrt(np.clip(values, 0.3, 1e5))  # hardly wider than a prior
    return Student(found, np.linalg.cholesky(1.3 * spread @ spread.T))


def importance_sample(
    problem: Problem, rng: np.random.Generator, least: int = 400, start: Student | None = None
) -> Weighted:
    """Weighted draws of the posterior of ``problem``.

    The proposals of the draws that are returned depend on earlier draws only, so that these are plain importance draws from a
    mixture of the last proposals.

    Parameters
    ----------
    problem : a problem with data
    rng : source of randomness
    least : effective sample size that is asked for
    start : first proposal; one from draws of the prior if None

    Raises
    ------
    AssertionError
        It was not reached.
    """
    target = problem.target()
    evaluations = 0
    if start is None:
        draws = target.transform.forward(problem.draw_prior(rng, PRIOR_DRAWS))
        ratio = problem.log_likelihood(target.transform.inverse(draws))
        start = _about(draws, tempered(ratio, 8 * problem.dimension)[0], 1.5)
        evaluations = PRIOR_DRAWS
    proposals = [start]
    rounds: list[tuple[np.ndarray, np.ndarray]] = []
    for _ in range(ROUNDS):
        draws = proposals[-1].draw(rng, ROUND * least)
        evaluations += len(draws)
        rounds = [*rounds, (draws, target.log_density(draws))][-REMEMBERED:]
        known = np.concatenate([positions for positions, _ in rounds])
        density = np.concatenate([values for _, values in rounds])
        ratio = density - _mixture(proposals[-REMEMBERED:], known)
        fractions, power = tempered(ratio, 16 * problem.dimension)
        ready = power == 1.0 and 1.0 / np.square(fractions).sum() > least
        proposals.append(_about(known, fractions, 1.0 if power == 1.0 else 1.3))
        if not ready:
            continue
        chosen = proposals[-REMEMBERED:]
        draws = np.concatenate([student.draw(rng, FINAL * least // len(chosen)) for student in chosen])
        evaluations += len(draws)
        ratio = target.log_density(draws) - _mixture(chosen, draws)
        weights, _ = tempered(ratio, 0.0)
        evidence = float(np.logaddexp.reduce(ratio)) - log(len(draws))
        found = Weighted(draws, weights, evaluations, evidence)
        if found.effective_size >= least:
            return found
    raise AssertionError(f"importance sampling did not find the posterior in {evaluations} evaluations")


def tempered(ratio: np.ndarray, enough: float) -> tuple[np.ndarray, float]:
    """Weights ∝ exp(power · ratio) with the largest power <= 1 that leaves an effective size above ``enough``; and the power."""
    relative = np.where(np.isfinite(ratio), ratio, -np.inf) - np.max(ratio[np.isfinite(ratio)])
    for power in np.geomspace(1.0, 1e-4, 60):
        fractions = np.exp(power * relative)
        fractions /= fractions.sum()
        if 1.0 / np.square(fractions).sum() > enough:
            break
    return fractions, float(power)


def _about(positions: np.ndarray, weights: np.ndarray, wider: float) -> Student:
    """A proposal with mean and ``wider`` times the covariance of weighted draws as its middle and scale."""
    covariance = wider * np.atleast_2d(np.cov(positions.T, aweights=weights))
    return Student(weights @ positions, np.linalg.cholesky(covariance + 1e-12 * np.eye(len(covariance))))


def _mixture(proposals: list[Student], positions: np.ndarray) -> np.ndarray:
    """Log-density of proposals taken in equal shares."""
    return np.logaddexp.reduce([s.log_density(positions) for s in proposals]) - log(len(proposals))
