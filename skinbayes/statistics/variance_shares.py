"""How much of the variance of one quantity goes with each of several groups of others, from draws of all of them."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations, permutations
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray

FOLDS = 5
"""Parts of the draws, each predicted from a regression on the others."""

PARTS = 4
"""Parts of the draws whose shares are compared for their standard errors."""


class VarianceShares(NamedTuple):
    """Shares of a variance, which sum to 1.

    Attributes
    ----------
    variance : of the target, in its unit squared
    shares : group to its share, dimensionless; ``residual`` is what no group explains
    standard_errors : of the shares, from the finite number of draws
    """

    variance: float
    shares: dict[str, float]
    standard_errors: dict[str, float]


def variance_shares(target: FloatArray, groups: Mapping[str, FloatArray]) -> VarianceShares:
    """Split the variance of a quantity between groups of others.

    A group explains ``Var E[y|x] / Var y``, the variance of the conditional mean, taken from a regression of y on all products of
    up to two of its members. Where groups depend on each other a share is the mean of what the group adds to those before it,
    over all orders of the groups (Shapley's value).

    Parameters
    ----------
    target : y, shape ``(n,)``
    groups : name to the members of a group, shape ``(n, k)``; k may be 0

    Returns
    -------
    VarianceShares

    Notes
    -----
    The regression predicts each fifth of the draws from the others, so that what it explains is not overfitted; what bends more
    than a parabola counts as unexplained.

    References
    ----------
    Owen, SIAM/ASA J. Uncertainty Quantification 2 (2014) 245, doi 10.1137/130936233.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> a, b, rest = rng.normal(size=(3, 20000))
    >>> found = variance_shares(2 * a + b + rest, {"a": a[:, None], "b": b[:, None]})
    >>> {name: round(share, 1) for name, share in found.shares.items()}
    {'a': 0.7, 'b': 0.2, 'residual': 0.2}
    """
    target = np.asarray(target, dtype=float)
    shares = _shares(target, groups)
    order = np.arange(len(target)) * PARTS // len(target)
    parts = [
        _shares(target[order == i], {name: values[order == i] for name, values in groups.items()})
        for i in range(PARTS)
    ]
    errors = {name: float(np.std([part[name] for part in parts], ddof=1) / np.sqrt(PARTS)) for name in shares}
    return VarianceShares(float(target.var()), shares, errors)


def _shares(target: FloatArray, groups: Mapping[str, FloatArray]) -> dict[str, float]:
    names = list(groups)
    explained = {
        frozenset(subset): _explained(target, [groups[name] for name in subset])
        for count in range(len(names) + 1)
        for subset in combinations(names, count)
    }
    for subset in sorted(
        explained, key=len
    ):  # what more members seem to explain less of is the scatter of the estimate
        explained[subset] = max(explained[other] for other in explained if other <= subset)
    orders = list(permutations(names))
    found = dict.fromkeys(names, 0.0)
    for order in orders:
        for i, name in enumerate(order):
            gain = explained[frozenset(order[: i + 1])] - explained[frozenset(order[:i])]
            found[name] += gain / len(orders)
    return found | {"residual": 1.0 - explained[frozenset(names)]}


def _explained(target: FloatArray, members: list[FloatArray]) -> float:
    """Fraction of the variance that a regression predicts of draws it has not seen; at least 0."""
    columns = np.concatenate([np.empty((len(target), 0)), *members], axis=1)
    columns = columns[:, np.ptp(columns, axis=0) > 0]
    if columns.shape[1] == 0:
        return 0.0
    columns = (columns - columns.mean(axis=0)) / columns.std(axis=0)
    first, second = np.triu_indices(columns.shape[1])
    design = np.concatenate(
        [np.ones((len(target), 1)), columns, columns[:, first] * columns[:, second]], axis=1
    )
    fold = np.arange(len(target)) % FOLDS
    error = 0.0
    for i in range(FOLDS):
        here = fold == i
        weights = np.linalg.lstsq(design[~here], target[~here], rcond=None)[0]
        error += float(np.square(target[here] - design[here] @ weights).sum())
    return float(max(0.0, 1.0 - error / (target.var() * len(target))))
