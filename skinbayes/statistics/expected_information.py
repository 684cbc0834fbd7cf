"""How much a datum that was not measured yet would tell: mutual information from draws, without new fits.

Given draws θ_j of what is known now and, for each of them, data y_i that it predicts,

    I(y; θ) = E[ln p(y | θ)] − E[ln p(y)] ≈ mean over i of ( ln p(y_i | θ_i) − ln mean over j of p(y_i | θ_j) ),

nested Monte Carlo whose inner draws are the outer ones. Of some of the parameters, φ, alone it is estimated from
the distances of neighbours among the pairs (y_i, φ_i), without a density (Kraskov, Stögbauer and Grassberger 2004). Both are in
nats: a normal quantity known so far with width s and then with width t has gained ln(s/t).

References
----------
Ryan et al., International Statistical Review 84 (2016) 128, doi 10.1111/insr.12107 (design by expected information);
Rainforth et al., Statistical Science 39 (2024) 100, doi 10.1214/23-STS915 (nested Monte Carlo and its bias);
Kraskov, Stögbauer & Grassberger, Physical Review E 69 (2004) 066138, doi 10.1103/PhysRevE.69.066138 (neighbours).
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree
from scipy.special import digamma, logsumexp, ndtri

from skinbayes.arrays import FloatArray

NEIGHBOURS = 5
"""Neighbours whose distance counts: more have less scatter and more bias."""


def information(log_density: FloatArray) -> tuple[float, float]:
    """Expected information of data on all parameters, in nats, and its standard error.

    Parameters
    ----------
    log_density : ln p(y_i | θ_j), shape ``(M, M)``; y_i was drawn from θ_i

    Returns
    -------
    tuple of float
        The estimate, at most ln M, and the standard error of its outer mean.

    Examples
    --------
    >>> from scipy.stats import norm
    >>> rng = np.random.default_rng(1)
    >>> theta = rng.standard_normal(1500)  # and a datum with scatter 0.5: ln(sqrt(1 + 4)) = 0.805
    >>> y = theta + 0.5 * rng.standard_normal(1500)
    >>> found, error = information(norm.logpdf(y[:, np.newaxis], theta, 0.5))
    >>> bool(abs(found - 0.805) < 4 * error + 0.01)
    True
    """
    gain = np.diagonal(log_density) - logsumexp(log_density, axis=1) + np.log(len(log_density))
    return float(gain.mean()), float(gain.std(ddof=1) / np.sqrt(len(gain)))


def information_on(phi: FloatArray, y: FloatArray) -> tuple[float, float]:
    """Expected information of data on some of the parameters, in nats, and its standard error.

    Parameters
    ----------
    phi : draws of these parameters, shape ``(M, d)``, d of 1 to 3
    y : the data that each draw predicts, shape ``(M, k)``

    Returns
    -------
    tuple of float
        The estimate, and the standard error of its mean over the draws. About zero, so also below it, for data that tell nothing.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> theta = rng.standard_normal((4000, 2))  # of the first, a sum of both with scatter 1 tells ln(sqrt(3/2)) = 0.203
    >>> y = theta.sum(axis=1, keepdims=True) + rng.standard_normal((4000, 1))
    >>> found, error = information_on(theta[:, :1], y)
    >>> bool(abs(found - 0.203) < 4 * error + 0.01)
    True

    Notes
    -----
    Every coordinate is turned into normal scores by its ranks, which changes no information.
    """
    count = len(phi)
    parts = [ndtri((values.argsort(axis=0).argsort(axis=0) + 0.5) / count) for values in (phi, y)]
    # the k-th neighbour in all coordinates, the point itself apart, and how many are nearer in each part
    distance = cKDTree(np.hstack(parts)).query(np.hstack(parts), NEIGHBOURS + 1, p=np.inf)[0][:, -1]
    inside = np.nextafter(distance, 0.0)
    nearer = [cKDTree(part).query_ball_point(part, inside, p=np.inf, return_length=True) for part in parts]
    gain = digamma(NEIGHBOURS) + digamma(count) - digamma(nearer[0]) - digamma(nearer[1])
    return float(gain.mean()), float(gain.std(ddof=1) / np.sqrt(count))


def information_on_model(
    of_first: tuple[FloatArray, FloatArray],
    of_second: tuple[FloatArray, FloatArray],
    probability: float = 0.5,
) -> tuple[float, float]:
    """Expected information of data on which of two models is right, in nats, at most ln 2; and its standard error.

    Parameters
    ----------
    of_first, of_second : for data that the first, or the second, model made, ln p(y_i | model) under the first and the second,
        each ``(M,)``
    probability : that the first is right

    Examples
    --------
    >>> from scipy.stats import norm
    >>> rng = np.random.default_rng(1)
    >>> one, other = rng.standard_normal(4000), 10.0 + rng.standard_normal(3000)
    >>> found, _ = information_on_model(*((norm.logpdf(y), norm.logpdf(y, 10.0)) for y in (one, other)))
    >>> round(found, 3)  # data that tell for sure: ln 2
    0.693
    """
    prior = np.array([probability, 1.0 - probability])
    gains = [
        densities[right] - np.logaddexp(densities[0] + np.log(prior[0]), densities[1] + np.log(prior[1]))
        for right, densities in enumerate((of_first, of_second))
    ]
    errors = [part * gain.std(ddof=1) / np.sqrt(len(gain)) for part, gain in zip(prior, gains, strict=True)]
    means = [gain.mean() for gain in gains]
    return float(prior @ means), float(np.hypot(*errors))
