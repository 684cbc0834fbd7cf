"""How data lie among what a fitted model predicts for them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import bdtr, ndtri

from skinbayes.arrays import FloatArray
from skinbayes.statistics.quantiles import finite_quantiles

SURPRISING = 0.01
"""A datum with a smaller fraction of predictive draws on one side of it is far out."""


@dataclass(frozen=True)
class Agreement:
    """How the data lie among what the fitted model predicts for them.

    Attributes
    ----------
    count, wide, narrow : data, and those of them in the 5–95 % and in the 25–75 % range of their predictions
    few_inside : True if so few in the 5–95 % range would come about by chance less than once in a hundred times
    far : places of the data that the predictions hardly ever reach, the farthest first
    statistics : name of a statistic of all data to the number of simulated data sets above it, and of all
    """

    count: int
    wide: int
    narrow: int
    few_inside: bool
    far: tuple[int, ...]
    statistics: dict[str, tuple[int, int]]

    @property
    def missed(self) -> list[str]:
        """The statistics that the model does not reproduce."""
        return [name for name, (above, total) in self.statistics.items() if not 0.05 <= above / total <= 0.95]

    @property
    def misfit(self) -> bool:
        """Whether anything speaks against the model."""
        return self.few_inside or bool(self.far or self.missed)


def examine(observed: FloatArray, draws: FloatArray, of_one_kind: bool) -> Agreement:
    """Hold data against posterior predictive draws.

    Coverage of predictive intervals, data in the tails, and posterior predictive p-values of mean and scatter (Gelman, Meng &
    Stern 1996, Statistica Sinica 6:733). A datum counts as far out if less than 1 % of its predictions lie beyond it, or, of
    many data, so few that one such datum among all has a chance of 5 %. Where there are too few draws to tell, it must also be
    that far by the width of its predictions.

    Parameters
    ----------
    observed : N data
    draws : predictive draws, shape ``(S, N)``; those that are not finite are left out
    of_one_kind : True if the data are of one kind, so that their mean and scatter mean something

    Examples
    --------
    >>> draws = np.random.default_rng(1).normal(size=(2000, 20))
    >>> found = examine(np.r_[np.linspace(-1.5, 1.5, 19), 9.0], draws, of_one_kind=True)
    >>> found.misfit, found.far, found.wide
    (True, (19,), 19)
    """
    count = len(observed)
    low, q25, middle, q75, high = finite_quantiles(draws, [0.05, 0.25, 0.5, 0.75, 0.95])
    wide = int(((low <= observed) & (observed <= high)).sum())
    below = (draws < observed).mean(axis=0)
    tails = np.minimum(below, 1.0 - below)
    limit = min(SURPRISING, 0.025 / count)
    rare = (tails < limit) & (_distance(observed, low, middle, high) > -ndtri(limit))
    statistics: dict[str, tuple[int, int]] = {}
    if of_one_kind:
        for name, simulated, real in (
            ("mean", draws.mean(axis=1), observed.mean()),
            ("scatter between rows", draws.std(axis=1, ddof=1), observed.std(ddof=1)),
        ):
            statistics[name] = int((simulated > real).sum()), len(draws)
    return Agreement(
        count,
        wide,
        int(((q25 <= observed) & (observed <= q75)).sum()),
        bool(bdtr(wide, count, 0.9) < 0.01),
        tuple(int(i) for i in np.argsort(tails, kind="stable") if rare[i]),
        statistics,
    )


def _distance(observed: FloatArray, low: FloatArray, middle: FloatArray, high: FloatArray) -> FloatArray:
    """Distance from the median in standard deviations, of logarithms where all is positive, by the nearer end of the range."""
    logs = (low > 0.0) & (observed > 0.0)
    with np.errstate(all="ignore"):
        x, a, m, b = (np.where(logs, np.log(values), values) for values in (observed, low, middle, high))
        width = np.where(x < m, m - a, b - m) / -float(ndtri(0.05))
        return np.asarray(np.where(width > 0.0, np.abs(x - m) / width, np.where(x == m, 0.0, np.inf)))
