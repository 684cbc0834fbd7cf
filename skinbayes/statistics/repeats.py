"""Lack of fit: whether rows of the same conditions allow the misfit that a model has.

A free scatter takes in whatever a model misses, but rows measured under the same conditions tell what scatter there is. The
statistic is that of the F-test for lack of fit, which does not depend on the size of the scatter,

    F = [Σ_k n_k r̄_k² / K] / [Σ_k Σ_i (r_ki − r̄_k)² / (N − K)]

with residuals r of K conditions, held against the same of data simulated from the posterior (Gelman, Meng & Stern 1996,
Statistica Sinica 6, 733).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray

FEWEST_FREEDOM = 3
"""With fewer degrees of freedom among the repeats their scatter is not known."""

FEWEST_SIMULATED = 100

SURPRISING = 0.05
"""Largest p-value at which the misfit counts as more than repeats allow."""


@dataclass(frozen=True)
class LackOfFit:
    """Misfit of a model beside the scatter of repeats.

    Attributes
    ----------
    conditions : number of different conditions
    degrees_of_freedom : of the scatter of rows about the mean of their condition
    scatter : of such rows, a standard deviation; the noise floor of any model
    misfit : of the means of the conditions from the model, root mean square over the rows
    allowed : what the scatter of repeats alone would make of it
    probability : that simulated data of the model have a misfit as large, in units of their scatter
    """

    conditions: int
    degrees_of_freedom: int
    scatter: float
    misfit: float
    allowed: float
    probability: float

    @property
    def found(self) -> bool:
        """Whether the misfit is more than repeats allow."""
        return self.probability <= SURPRISING and self.misfit > self.allowed


def lack_of_fit(
    residuals: FloatArray, simulated: FloatArray, condition: NDArray[np.intp]
) -> LackOfFit | None:
    """Hold the misfit of a model against the scatter of repeats.

    Parameters
    ----------
    residuals : of the data, from a typical prediction of each row, shape ``(N,)``
    simulated : of data simulated from the posterior, from the same predictions, shape ``(S, N)``
    condition : number of the condition of each row, from 0, shape ``(N,)``

    Returns
    -------
    LackOfFit or None
        None without enough repeats or simulated data, or if repeats do not scatter.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> load = np.repeat(np.arange(10), 2)
    >>> noise = 0.1 * rng.normal(size=(500, 20))
    >>> found = lack_of_fit(np.sin(load) + noise[0], noise[1:], load)
    >>> found.degrees_of_freedom, found.found, round(found.misfit, 1), round(found.scatter, 1)
    (10, True, 0.7, 0.1)
    """
    data = np.vstack([residuals, simulated])
    data = data[np.isfinite(data).all(axis=1)]
    count = np.bincount(condition).astype(float)
    freedom = len(condition) - len(count)
    if freedom < FEWEST_FREEDOM or len(data) <= FEWEST_SIMULATED or not np.isfinite(residuals).all():
        return None
    # rows of different scatter count alike
    width = data[1:].std(axis=0)
    if not (width > 0).all():
        return None
    between, within = _squares(data / width, condition, count)
    if within[0] == 0.0:
        return None
    ratio = between / within
    own = _squares(residuals[np.newaxis], condition, count)
    scatter = float(np.sqrt(own[1][0] / freedom))
    return LackOfFit(
        len(count),
        freedom,
        scatter,
        float(np.sqrt(own[0][0] / len(condition))),
        scatter * float(np.sqrt(len(count) / len(condition))),
        float((ratio >= ratio[0]).mean()),
    )


def _squares(
    data: FloatArray, condition: NDArray[np.intp], count: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Sums of squares of the means of conditions and about them, each ``(S,)``."""
    rows = np.argsort(condition, kind="stable")
    first = np.concatenate([[0], np.cumsum(count[:-1])]).astype(np.intp)
    means = np.add.reduceat(data[:, rows], first, axis=1) / count
    return np.square(means) @ count, np.square(data - means[:, condition]).sum(axis=1)
