"""Analysis of variance of crossed columns by least squares, balanced or not: the scatter that group effects leave.

The values are written as a constant plus one free offset for each level of each column, without interactions. What is left is
the noise floor of any model whose only grouped terms are such offsets: its residual standard deviation
can be smaller only if the model explains how rows differ inside their levels.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import nan, sqrt

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike
from skinbayes.errors import InputError
from skinbayes.statistics.groups import CrossedGroups


def residual_scatter(values: ArrayLike, labels: Mapping[str, NDArray[np.str_]]) -> tuple[float, int]:
    """What least squares of values on a constant and the levels of columns, without interactions, leaves.

    Parameters
    ----------
    values : shape ``(N,)``, any unit
    labels : name of each column to the labels of its rows, shape ``(N,)``

    Returns
    -------
    standard deviation, the square root of the residual squares over their degrees of freedom, in the unit of the values (NaN
    without degrees of freedom), and these degrees of freedom; levels that cannot be told apart (nested or disconnected columns)
    cost none

    Raises
    ------
    InputError
        if the values are not finite numbers, one for each row, or the labels do not fit each other

    Examples
    --------
    >>> labels = {"subject": np.array(["x", "x", "y", "y"]), "item": np.array(["a", "b", "a", "b"])}
    >>> deviation, degrees_of_freedom = residual_scatter([1.0, 2.0, 4.0, 7.0], labels)
    >>> round(deviation, 6), degrees_of_freedom
    (1.0, 1)

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
    members = (groups.member[:, :, None] == np.arange(groups.n_effects)).any(axis=0).astype(float)
    design = np.column_stack([np.ones(groups.n_rows), members])
    solution, _, rank, _ = np.linalg.lstsq(design, centred, rcond=None)
    residual, left = centred - design @ solution, groups.n_rows - int(rank)
    return sqrt(residual @ residual / left) if left else nan, left
