"""After sampling: what the data changed about each parameter, and which pairs they left on a ridge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.diagnose.rule import Verdict, verdict
from skinbayes.statistics.transforms import VectorTransform

RIDGE = 0.9
"""Correlation above which two parameters lie on a ridge."""


@dataclass(frozen=True)
class PriorUpdate:
    """What the data changed about one parameter.

    Attributes
    ----------
    name : the parameter
    contraction : 1 − (posterior variance)/(prior variance) in the unconstrained coordinate; 1 is known exactly,
        0 is as before, negative is wider than before
    prior_quantile : fraction of the prior below the posterior median
    verdict : in one word
    """

    name: str
    contraction: float
    prior_quantile: float
    verdict: Verdict

    @property
    def ratio(self) -> float:
        """Posterior over prior standard deviation."""
        return float(np.sqrt(max(0.0, 1.0 - self.contraction)))


def prior_updates(
    names: Sequence[str],
    prior_draws: FloatArray,
    posterior_draws: FloatArray,
    transform: VectorTransform | None = None,
) -> tuple[PriorUpdate, ...]:
    """Compare prior and posterior of each parameter.

    Contraction is used as in Schad, Betancourt & Vasishth 2021, doi 10.1037/met0000275.

    Parameters
    ----------
    names : D parameters
    prior_draws : shape ``(M, D)``, natural coordinates
    posterior_draws : shape ``(S, D)``, natural coordinates
    transform : to the coordinates in which variances are compared; None compares natural coordinates

    Returns
    -------
    one finding per parameter: ``contradicted`` if the posterior median lies beyond the 1 % or 99 % quantile of the prior;
    otherwise, if the standard deviation is still 0.9 of the prior's or more, ``moved`` if it lies beyond the 20 % or 80 %
    quantile and ``not updated`` if not

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> prior, posterior = rng.normal(size=(4000, 1)), rng.normal(4.0, 0.1, size=(4000, 1))
    >>> prior_updates(["a"], prior, posterior)[0].verdict
    'contradicted'
    """
    before, after = np.asarray(prior_draws, dtype=float), np.asarray(posterior_draws, dtype=float)
    fraction = (before < np.median(after, axis=0)).mean(axis=0)
    if transform is not None:
        before, after = transform.forward(before), transform.forward(after)
    contraction = 1.0 - after.var(axis=0, ddof=1) / before.var(axis=0, ddof=1)
    updates = []
    for name, shrunk, quantile in zip(names, contraction, fraction, strict=True):
        ratio = float(np.sqrt(max(0.0, 1.0 - shrunk)))
        updates.append(PriorUpdate(name, float(shrunk), float(quantile), verdict(ratio, float(quantile))))
    return tuple(updates)


@dataclass(frozen=True)
class Ridge:
    """Two parameters that the posterior knows together much better than apart.

    Attributes
    ----------
    first, second : the parameters
    correlation : of their coordinates (ln where positive)
    exponent : k of second ∝ first^k along the ridge (slope between the coordinates, where one is not positive)
    logarithmic : True if both coordinates are logarithms
    """

    first: str
    second: str
    correlation: float
    exponent: float
    logarithmic: bool


def ridges(
    names: Sequence[str], draws: FloatArray, logarithmic: Sequence[bool] | None = None
) -> tuple[Ridge, ...]:
    """Find pairs of parameters with a correlation above 0.9.

    Parameters
    ----------
    names : D parameters
    draws : posterior draws, shape ``(S, D)``, natural coordinates
    logarithmic : for each parameter, True to look at its logarithm; by default where all draws are positive

    Returns
    -------
    the pairs, strongest first; exponents are slopes of the principal axis of the two coordinates

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> x = np.exp(rng.normal(size=500))
    >>> round(ridges(["a", "b"], np.column_stack([x, x**2 * np.exp(0.01 * rng.normal(size=500))]))[0].exponent, 2)
    2.0
    """
    values = np.asarray(draws, dtype=float)
    logs = np.asarray((values > 0.0).all(axis=0) if logarithmic is None else logarithmic, dtype=bool)
    coordinates = np.where(logs, np.log(np.where(logs, values, 1.0)), values)
    moving = [i for i in range(len(names)) if np.ptp(coordinates[:, i]) > 0.0]
    found = []
    for i, j in combinations(moving, 2):
        covariance = np.cov(coordinates[:, i], coordinates[:, j])
        correlation = float(covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]))
        if abs(correlation) <= RIDGE:
            continue
        axis = np.linalg.eigh(covariance)[1][:, -1]
        exponent = float(axis[1] / axis[0])
        found.append(Ridge(names[i], names[j], correlation, exponent, bool(logs[i] and logs[j])))
    return tuple(sorted(found, key=lambda ridge: -abs(ridge.correlation)))
