"""Mixtures of multivariate Student t distributions: heavy-tailed stand-ins of a posterior that can be drawn from and evaluated.

Fitted by expectation maximisation (Peel & McLachlan 2000, doi 10.1023/A:1008981510081); the degrees of freedom, common to all
components, are chosen from a few values by the log-density of other points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln, logsumexp

from skinbayes.arrays import FloatArray

DEGREES_OF_FREEDOM = (3.0, 5.0, 8.0)
"""What is tried: with 3 the variance is still finite, with 8 the tails are still heavier than those of a normal distribution."""

ITERATIONS = 40
"""Steps of expectation maximisation at most."""

_CLOSE = 1e-4  # gain of the mean log-density at which they end
_RIDGE = 1e-9  # of the variances, added to them
_LEAST_VARIANCE = 1e-30  # of points without any, so that they have a density


@dataclass(frozen=True)
class StudentMixture:
    """``Σ_k α_k t_ν(x; m_k, S_k)``.

    Attributes
    ----------
    weights : α, dimensionless, shape ``(K,)``, sum 1
    means : m, shape ``(K, D)``
    factors : lower Cholesky factors of the scale matrices S, shape ``(K, D, D)``
    degrees_of_freedom : ν of each component, shape ``(K,)``
    """

    weights: FloatArray
    means: FloatArray
    factors: FloatArray
    degrees_of_freedom: FloatArray

    @property
    def dimension(self) -> int:
        """Number of coordinates D."""
        return int(self.means.shape[1])

    def log_density(self, x: FloatArray) -> FloatArray:
        """Logarithm of the density at rows of ``x``, shape ``(n, D)`` to ``(n,)``.

        Examples
        --------
        >>> one = StudentMixture(np.ones(1), np.zeros((1, 1)), np.ones((1, 1, 1)), np.array([1.0]))
        >>> np.exp(one.log_density(np.array([[0.0], [1.0]]))) * np.pi  # a Cauchy distribution
        array([1. , 0.5])
        """
        return np.asarray(logsumexp(self._parts(x)[0], axis=0))

    def draw(self, count: int, rng: np.random.Generator) -> FloatArray:
        """Independent draws, shape ``(count, D)``, in random order."""
        which = rng.choice(self.weights.size, size=count, p=self.weights)
        nu = self.degrees_of_freedom[which]
        stretch = np.sqrt(nu / rng.chisquare(nu))[:, np.newaxis]
        steps = np.einsum("nij,nj->ni", self.factors[which], rng.normal(size=(count, self.dimension)))
        return np.asarray(self.means[which] + stretch * steps)

    @staticmethod
    def of(mixtures: Sequence[StudentMixture], counts: Sequence[int]) -> StudentMixture:
        """The mixture of several mixtures, each with so many draws."""
        fraction = np.array(counts) / sum(counts)
        return StudentMixture(
            np.concatenate([a * one.weights for a, one in zip(fraction, mixtures, strict=True)]),
            np.concatenate([one.means for one in mixtures]),
            np.concatenate([one.factors for one in mixtures]),
            np.concatenate([one.degrees_of_freedom for one in mixtures]),
        )

    def as_one(self) -> StudentMixture:
        """One component with the mean of all, and their covariance (of the scale matrices) as its scale matrix."""
        mean = self.weights @ self.means
        apart = self.means - mean
        covariance = np.einsum("k,kij,klj->il", self.weights, self.factors, self.factors)
        covariance += np.einsum("k,ki,kj->ij", self.weights, apart, apart)
        factor = _lower_factor(covariance)
        return StudentMixture(
            np.ones(1), mean[np.newaxis], factor[np.newaxis], np.array([DEGREES_OF_FREEDOM[0]])
        )

    def with_wide_component(self, weight: float, stretch: float) -> StudentMixture:
        """Add a component with the mean and ``stretch`` times the spread of the whole: it bounds weights in the far tails."""
        wide = self.as_one()
        wide = StudentMixture(wide.weights, wide.means, stretch * wide.factors, wide.degrees_of_freedom)
        return self.with_part(wide, weight)

    def with_part(self, other: StudentMixture, weight: float) -> StudentMixture:
        """Add another mixture, which gets a part ``weight`` of all draws."""
        return StudentMixture(
            np.append((1 - weight) * self.weights, weight * other.weights),
            np.concatenate([self.means, other.means]),
            np.concatenate([self.factors, other.factors]),
            np.append(self.degrees_of_freedom, other.degrees_of_freedom),
        )

    def refitted(self, x: FloatArray, weights: FloatArray) -> StudentMixture:
        """Expectation maximisation from here on to points with weights, shapes ``(n, D)`` and ``(n,)``.

        Components that are left with hardly more points than their matrix needs are dropped. The degrees of freedom are chosen
        anew by the log-density of the points.
        """
        points = weights.sum() ** 2 / np.square(weights).sum()
        share = weights / weights.sum()
        mixture, before = self, -np.inf
        mean = share @ x
        prior = np.einsum("n,ni,nj->ij", share, x - mean, x - mean)
        prior[np.diag_indices_from(prior)] *= 1 + _RIDGE
        for _ in range(ITERATIONS):
            parts, distance = mixture._parts(x)
            total = logsumexp(parts, axis=0)
            gained = float(share @ total)
            if gained < before + _CLOSE:
                break
            before = gained
            try:
                mixture = mixture._maximised(x, share * np.exp(parts - total), distance, points, prior)
            except np.linalg.LinAlgError:
                break  # where one point has nearly all the weight there is no matrix to learn
        return max(
            (
                StudentMixture(
                    mixture.weights, mixture.means, mixture.factors, np.full(mixture.weights.size, nu)
                )
                for nu in DEGREES_OF_FREEDOM
            ),
            key=lambda tried: float(share @ tried.log_density(x)),
        )

    def _maximised(
        self, x: FloatArray, belongs: FloatArray, distance: FloatArray, points: float, prior: FloatArray
    ) -> StudentMixture:
        """Means, matrices and weights given how much each point belongs to each component, shape ``(K, n)``."""
        dimension = self.dimension
        alpha = belongs.sum(axis=1)
        enough = alpha * points > dimension + 1
        kept = np.flatnonzero(enough) if enough.any() else np.array([int(np.argmax(alpha))])
        nu = self.degrees_of_freedom[kept, np.newaxis]
        pull = belongs[kept] * (nu + dimension) / (nu + distance[kept])
        means = (pull @ x) / pull.sum(axis=1, keepdims=True)
        # a few points' worth of the whole, shrunk to the volume of one of K components, keeps small components round
        few = (dimension + 2) / points
        shape = prior / kept.size ** (2 / dimension)
        factors = np.empty((kept.size, dimension, dimension))
        for place in range(kept.size):
            apart = x - means[place]
            scatter = (pull[place, :, np.newaxis] * apart).T @ apart
            factors[place] = np.linalg.cholesky((scatter + few * shape) / (alpha[kept[place]] + few))
        return StudentMixture(alpha[kept] / alpha[kept].sum(), means, factors, self.degrees_of_freedom[kept])

    def _parts(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln α_k t_ν and squared distances in units of the scale, both ``(K, n)``."""
        nu, dimension = self.degrees_of_freedom, self.dimension
        distance = np.empty((self.weights.size, len(x)))
        for place, (mean, factor) in enumerate(zip(self.means, self.factors, strict=True)):
            # a matrix product instead of SciPy's triangular solver, which is threaded and waits for its threads
            white = (x - mean) @ np.linalg.inv(factor).T
            distance[place] = np.einsum("ij,ij->i", white, white)
        norm = gammaln((nu + dimension) / 2) - gammaln(nu / 2) - dimension / 2 * np.log(nu * np.pi)
        norm -= np.log(np.diagonal(self.factors, axis1=1, axis2=2)).sum(axis=1)
        with np.errstate(divide="ignore"):
            head = np.log(self.weights) + norm
        return head[:, np.newaxis] - (nu[:, np.newaxis] + dimension) / 2 * np.log1p(
            distance / nu[:, np.newaxis]
        ), distance


def fit_mixture(
    x: FloatArray,
    held_out: FloatArray,
    rng: np.random.Generator,
    most: int = 16,
    weights: tuple[FloatArray, FloatArray] | None = None,
    known: StudentMixture | None = None,
) -> StudentMixture:
    """Fit mixtures of 1, 2, 4, … components to points, and take the one under which other points are likeliest.

    Parameters
    ----------
    x, held_out : points of the distribution, shapes ``(n, D)`` and ``(m, D)``; neither needs to be independent
    rng : where the components begin
    most : components at most
    weights : of both, shapes ``(n,)`` and ``(m,)``; equal if omitted
    known : a mixture that may be near; one that goes on from it is tried too

    Returns
    -------
    StudentMixture
        Fitted to all points, with the number of components that ``held_out`` prefers.
    """
    own, others = weights or (np.ones(len(x)), np.ones(len(held_out)))
    points = own.sum() ** 2 / np.square(own).sum()
    share = others / others.sum()
    chosen, best = None, -np.inf
    count = 1
    while count <= most and count * (x.shape[1] + 2) <= points:
        fitted = _begun(x, count, rng, own).refitted(x, own)
        found = float(share @ fitted.log_density(held_out))
        if found <= best + 1e-3:
            break
        chosen, best, count = fitted, found, 2 * count
    if known is not None:
        fitted = known.refitted(x, own)
        if float(share @ fitted.log_density(held_out)) > best:
            chosen = fitted
    if chosen is None:
        chosen = _begun(x, 1, rng, own)
    return chosen.refitted(np.concatenate([x, held_out]), np.concatenate([own, others]))


def _begun(x: FloatArray, count: int, rng: np.random.Generator, weights: FloatArray) -> StudentMixture:
    """Components at points far from each other (k-means++), each as wide as the whole over their number."""
    dimension = x.shape[1]
    mean = weights @ x / weights.sum()
    alone = np.square(weights).sum() > (1 - _RIDGE) * weights.sum() ** 2
    # one point with all the weight has no spread: a small part of what all points have
    covariance = np.atleast_2d(_RIDGE * np.cov(x.T, ddof=0) if alone else np.cov(x.T, aweights=weights))
    covariance[np.diag_indices_from(covariance)] *= 1 + _RIDGE
    whole = _lower_factor(covariance)
    white = (x - mean) @ np.linalg.inv(whole).T
    places = [int(rng.choice(len(x), p=weights / weights.sum()))]
    nearest = np.full(len(x), np.inf)
    while len(places) < count:
        nearest = np.minimum(nearest, np.square(white - white[places[-1]]).sum(axis=1))
        far = weights * nearest
        if not 0.0 < far.sum() < np.inf:
            break  # the points with weight are one point
        places.append(int(rng.choice(len(x), p=far / far.sum())))
    count = len(places)
    means = x[places] if count > 1 else mean[np.newaxis]
    factors = np.repeat(whole[np.newaxis] / count ** (1 / dimension), count, axis=0)
    return StudentMixture(np.full(count, 1 / count), means, factors, np.full(count, 6.0))


def _lower_factor(covariance: FloatArray) -> FloatArray:
    """Lower Cholesky factor of a covariance; one too thin for double precision gets as little width as makes it a matrix.

    Examples
    --------
    >>> thin = np.array([[1.0, 1.0], [1.0, 1.0]])  # of points on a line
    >>> factor = _lower_factor(thin)
    >>> bool(np.abs(factor @ factor.T - thin).max() < 1e-10)
    True
    """
    try:
        return np.asarray(np.linalg.cholesky(covariance))
    except np.linalg.LinAlgError:
        pass
    scale = np.sqrt(np.maximum(np.diagonal(covariance), _LEAST_VARIANCE))
    values, vectors = np.linalg.eigh(covariance / scale[:, np.newaxis] / scale)
    least = len(scale) * np.finfo(float).eps * max(float(values[-1]), 1.0)
    root = (vectors * np.sqrt(np.maximum(values, least))).T
    triangle = np.asarray(
        np.linalg.qr(root, mode="r")
    ).T  # the triangle of a square root needs no positive matrix
    return np.asarray(scale[:, np.newaxis] * triangle * np.sign(np.diagonal(triangle)))
