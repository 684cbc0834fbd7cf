"""Analysis of variance of crossed columns by least squares, balanced or not: the scatter that group effects leave.

The values are written as a constant plus one free offset for each level of each column, without interactions. What is left is
the noise floor of any model whose only grouped terms are such offsets: its residual standard deviation
can be smaller only if the model explains how rows differ inside their levels.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import nan, sqrt

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.statistics.groups import CrossedGroups


@dataclass(frozen=True, eq=False)
class AnalysisOfVariance:
    """How the variance of values divides among columns.

    Sequential: the squares a column explains beyond the columns named before it; these add up to the total with the residual
    ones. Marginal: beyond all other columns. The two agree in balanced data.

    Attributes
    ----------
    columns : names of the columns, in the order of the sequential sums
    n_rows : number of values
    residual_standard_deviation : square root of residual squares over their degrees of freedom, unit of the values;
        NaN without degrees of freedom
    degrees_of_freedom : of the residual
    column_degrees_of_freedom : of each column beyond the columns named before it
    marginal_degrees_of_freedom : of each column beyond all others
    total_sum_of_squares, residual_sum_of_squares : about the mean and about the fit, unit²
    sequential_sum_of_squares, marginal_sum_of_squares : of each column, unit²
    fitted : constant plus offsets at each row, shape ``(N,)``, unit of the values
    """

    columns: tuple[str, ...]
    n_rows: int
    residual_standard_deviation: float
    degrees_of_freedom: int
    column_degrees_of_freedom: dict[str, int]
    marginal_degrees_of_freedom: dict[str, int]
    total_sum_of_squares: float
    residual_sum_of_squares: float
    sequential_sum_of_squares: dict[str, float]
    marginal_sum_of_squares: dict[str, float]
    fitted: FloatArray

    @property
    def sequential_fraction(self) -> dict[str, float]:
        """Sequential sums of squares over the total; NaN if all values are equal."""
        return {name: self._fraction(squares) for name, squares in self.sequential_sum_of_squares.items()}

    @property
    def marginal_fraction(self) -> dict[str, float]:
        """Marginal sums of squares over the total; NaN if all values are equal."""
        return {name: self._fraction(squares) for name, squares in self.marginal_sum_of_squares.items()}

    @property
    def residual_fraction(self) -> float:
        """Residual sum of squares over the total; NaN if all values are equal."""
        return self._fraction(self.residual_sum_of_squares)

    def _fraction(self, squares: float) -> float:
        return squares / self.total_sum_of_squares if self.total_sum_of_squares > 0.0 else nan


def crossed_analysis_of_variance(
    values: ArrayLike, labels: Mapping[str, NDArray[np.str_]]
) -> AnalysisOfVariance:
    """Least squares of values on a constant and the levels of columns, without interactions.

    Parameters
    ----------
    values : shape ``(N,)``, any unit
    labels : name of each column to the labels of its rows, shape ``(N,)``; sequential sums follow their order

    Returns
    -------
    the analysis; levels that cannot be told apart (nested or disconnected columns) cost no degrees of freedom

    Raises
    ------
    InputError
        if the values are not finite numbers, one for each row, or the labels do not fit each other

    Examples
    --------
    >>> import numpy as np
    >>> labels = {"subject": np.array(["x", "x", "y", "y"]), "item": np.array(["a", "b", "a", "b"])}
    >>> analysis = crossed_analysis_of_variance([1.0, 2.0, 4.0, 7.0], labels)
    >>> round(analysis.sequential_sum_of_squares["subject"], 6), round(analysis.residual_sum_of_squares, 6)
    (16.0, 1.0)

    References
    ----------
    Searle, Casella & McCulloch, Variance Components, Wiley (1992), doi 10.1002/9780470316856.
    """
    groups = CrossedGroups.of_labels(labels)
    data = np.asarray(values, dtype=float)
    if data.shape != (groups.n_rows,) or not np.isfinite(data).all():
        raise InputError(
            f"analysis of variance: values of shape {data.shape}, expected {groups.n_rows} finite numbers, one for each row"
        )
    centred = data - data.mean()
    names = groups.columns
    steps = [_least_squares(centred, groups, names[:count]) for count in range(len(names) + 1)]
    full = steps[-1]
    without = [_least_squares(centred, groups, tuple(n for n in names if n != name)) for name in names]
    left, remaining = groups.n_rows - full.rank, _squares(full.residual)
    return AnalysisOfVariance(
        columns=names,
        n_rows=groups.n_rows,
        residual_standard_deviation=sqrt(remaining / left) if left else nan,
        degrees_of_freedom=left,
        column_degrees_of_freedom={
            n: b.rank - a.rank for n, a, b in zip(names, steps, steps[1:], strict=False)
        },
        marginal_degrees_of_freedom={
            n: full.rank - other.rank for n, other in zip(names, without, strict=True)
        },
        total_sum_of_squares=_squares(steps[0].residual),
        residual_sum_of_squares=remaining,
        # squares of differences of nested fits: the same as differences of squares, with nothing cancelled
        sequential_sum_of_squares={
            n: _squares(a.residual - b.residual) for n, a, b in zip(names, steps, steps[1:], strict=False)
        },
        marginal_sum_of_squares={
            n: _squares(other.residual - full.residual) for n, other in zip(names, without, strict=True)
        },
        fitted=data - full.residual,
    )


@dataclass(frozen=True, eq=False)
class _Regression:
    residual: FloatArray
    rank: int


def _squares(values: FloatArray) -> float:
    return float(values @ values)


def _least_squares(centred: FloatArray, groups: CrossedGroups, columns: tuple[str, ...]) -> _Regression:
    """Regression on a constant and the levels of some columns."""
    parts = [np.ones((groups.n_rows, 1))]
    for name in columns:
        place = groups.effects_of(name)
        member = groups.member[groups.columns.index(name)]
        parts.append((member[:, None] == np.arange(place.start, place.stop)).astype(float))
    design = np.concatenate(parts, axis=1)
    solution, _, rank, _ = np.linalg.lstsq(design, centred, rcond=None)
    return _Regression(centred - design @ solution, int(rank))
