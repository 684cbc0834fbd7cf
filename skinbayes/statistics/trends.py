"""Whether residuals follow a column: what a free scatter hides from checks of single values.

Posterior predictive checks (Gelman, Meng & Stern 1996, Statistica Sinica 6, 733) with statistics that do not depend on the size
of the scatter. Each is held against the same statistic of simulated data; that several are looked at is taken into account by
the distribution of the smallest p-value among them, of the simulated data themselves (Westfall & Young 1993).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import FloatArray

FEWEST_ROWS = 6
"""With fewer data no trend can be told from chance."""

FEWEST_VALUES = 4
"""A column needs so many different values."""

SURPRISING = 0.05
"""Largest p-value, all checks taken into account, at which a trend counts as found."""

KINDS = ("slope", "curvature", "spread", "neighbours")
"""What is looked at along a column: correlation with the ranks of the column, with their square, of the size of residuals with
the ranks, and of each residual with the next one along the column."""


@dataclass(frozen=True)
class Trend:
    """One check of the residuals along one column.

    Attributes
    ----------
    column : the column, or ``"order"`` for that of the rows
    kind : one of `KINDS`
    value : the statistic, a correlation, −1 … 1
    expected : 5 and 95 % quantiles of that of simulated data
    probability : that simulated data of the model have one as far out in any of the checks
    low, middle, high : mean residual in the lower, middle and upper third of the rows along the column
    """

    column: str
    kind: str
    value: float
    expected: tuple[float, float]
    probability: float
    low: float
    middle: float
    high: float

    @property
    def found(self) -> bool:
        """Whether the model does not reproduce it."""
        return self.probability <= SURPRISING


def trends(
    residuals: FloatArray, simulated: FloatArray, columns: Mapping[str, FloatArray]
) -> tuple[Trend, ...]:
    """Check residuals along columns against those of simulated data.

    Parameters
    ----------
    residuals : of the data, from a typical prediction of each row, shape ``(N,)``
    simulated : of data simulated from the posterior, from the same predictions, shape ``(S, N)``
    columns : name to values of the rows, shape ``(N,)`` each; those of fewer than four different values are passed over

    Returns
    -------
    tuple
        All checks, the most surprising first; empty with too few data.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> load = np.linspace(0.0, 1.0, 20)
    >>> noise = rng.normal(size=(500, 20))
    >>> first, *_ = trends(3 * load - 1.5 + 0.3 * noise[0], noise[1:], {"load": load})
    >>> first.kind, first.found, round(first.value, 1)
    ('slope', True, 1.0)
    """
    from scipy.stats import rankdata

    data = np.vstack([residuals, simulated])
    data = data[np.isfinite(data).all(axis=1)]
    usable = {name: x for name, x in columns.items() if np.unique(x).size >= FEWEST_VALUES}
    if data.shape[1] < FEWEST_ROWS or not usable or len(data) < 100 or not np.isfinite(residuals).all():
        return ()
    # rows of different scatter count alike
    width = data[1:].std(axis=0)
    if not (width > 0).all():
        return ()
    scaled = data / width
    statistics = np.stack([row for x in usable.values() for row in _statistics(scaled, x)], axis=1)
    distance = statistics - np.median(statistics[1:], axis=0)
    names = [(column, kind) for column in usable for kind in KINDS]
    # neighbours that are less alike than expected miss no curve: effects of groups of rows that stand together make them so
    both_sides = np.array([kind != "neighbours" for _, kind in names])
    distance = np.where(both_sides, np.abs(distance), distance)
    # of each check, how many of all are as far out: the data and the simulated ones are treated the same
    p_values = 1 - (rankdata(distance, axis=0, method="min") - 1) / len(distance)
    smallest = p_values.min(axis=1)
    found = []
    for place, (column, kind) in enumerate(names):
        order = np.argsort(usable[column], kind="stable")
        thirds = [float(residuals[part].mean()) for part in np.array_split(order, 3)]
        low, high = np.quantile(statistics[1:, place], [0.05, 0.95])
        probability = float((smallest <= p_values[0, place]).mean())
        found.append(
            Trend(column, kind, float(statistics[0, place]), (float(low), float(high)), probability, *thirds)
        )
    return tuple(sorted(found, key=lambda trend: (trend.probability, -abs(trend.value))))


def _statistics(data: FloatArray, column: FloatArray) -> list[FloatArray]:
    """One statistic of each kind for every data set, shape ``(S + 1,)`` each."""
    from scipy.stats import rankdata

    ranks = _standardised(rankdata(column))
    square = np.square(ranks)
    bend = _standardised(square - square.mean() - (square @ ranks) / (ranks @ ranks) * ranks)
    order = np.argsort(column, kind="stable")
    centred = data - data.mean(axis=1, keepdims=True)
    unit = _standardised(data)
    size = _standardised(np.abs(centred - (centred @ ranks)[:, None] / (ranks @ ranks) * ranks))
    along = centred[:, order]
    neighbours = (along[:, 1:] * along[:, :-1]).sum(axis=1) / np.square(along).sum(axis=1)
    return [unit @ ranks, unit @ bend, size @ ranks, neighbours]


def _standardised(values: FloatArray) -> FloatArray:
    """Mean 0 and square sum 1 along the last axis."""
    centred = values - values.mean(axis=-1, keepdims=True)
    return np.asarray(centred / np.sqrt(np.square(centred).sum(axis=-1, keepdims=True)))
