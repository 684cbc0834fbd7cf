"""What can be left out of a fit: single data, all data of one level of a column, or blocks of rows along a column."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.fit.joint_fit import JointFit
from skinbayes.problem.joint import JointProblem
from skinbayes.units import format_quantity

if TYPE_CHECKING:
    from skinbayes.fit import Fit
    from skinbayes.problem import Problem

SINGLE = "datum"
"""Name of the parts that are single data."""

ORDER = "order"
"""Name of the order of the rows among the columns along which they are cut into blocks."""

BLOCKS = 3
"""Blocks unless told otherwise: a model that carries over a third of a sweep has understood it."""

MOST_DRAWS = 4000
"""Draws of the posterior at which blocks are looked at."""

_LEFT_OUT = "log_likelihood_left_out"


@dataclass(frozen=True, eq=False)
class Parts:
    """Parts of the data, each of which is left out in turn.

    Attributes
    ----------
    name : ``"datum"``, a grouping column, or what the blocks are called
    labels : of the parts
    member : part of each datum, shape ``(M,)``
    densities : ln p(data of a part | all other data, θ) at draws of the posterior, shape ``(S, parts)``
    """

    name: str
    labels: tuple[str, ...]
    member: NDArray[np.intp]
    densities: FloatArray

    def counts(self) -> list[int]:
        """Number of data of each part."""
        return [int(count) for count in np.bincount(self.member, minlength=len(self.labels))]

    def at(self, fit: Fit | JointFit, theta: FloatArray) -> Parts:
        """The same parts with their densities at other parameter vectors ``(S, D)``."""
        assert fit.problem is not None
        if self.name == SINGLE:
            found = fit.problem.log_likelihood(theta, pointwise=True)
        elif _LEFT_OUT in fit.groups and self.name in fit.groups[_LEFT_OUT]:
            found = fit.problem.log_likelihood_left_out(theta, self.name)
        else:
            found = _densities(fit.problem, self.member, len(self.labels), theta)
        return replace(self, densities=found)


def single_data(fit: Fit | JointFit) -> Parts:
    """The data of all observables, one by one."""
    variables = fit.groups["log_likelihood"].data_vars.values()
    densities = np.concatenate([v.values.reshape(-1, v.shape[-1]) for v in variables], axis=-1)
    count = densities.shape[-1]
    return Parts(SINGLE, tuple(str(i + 1) for i in range(count)), np.arange(count), densities)


def levels(fit: Fit | JointFit) -> list[Parts]:
    """The levels of each grouping column that can be left out of a fit."""
    found = []
    for column, variable in fit.groups[_LEFT_OUT].data_vars.items() if _LEFT_OUT in fit.groups else ():
        names = tuple(str(level) for level in variable[f"{column}_level"].values)
        rows = fit.groups["constant_data"][column].values
        member = np.array([names.index(str(label)) for label in rows])
        found.append(Parts(str(column), names, member, variable.values.reshape(-1, len(names))))
    return found


def blocks(fit: Fit | JointFit, wanted: str) -> Parts:
    """Blocks of neighbouring rows.

    Parameters
    ----------
    fit : a fit whose model and data are at hand
    wanted : ``"normal_force in 3"``: the rows, sorted by a column, in so many parts of about the same size, rows of the same
        value staying together; ``"in 3"``: along the column of numbers that has the most different values, of several the one
        whose largest is the largest multiple of its smallest; ``"order in 3"``: as the rows stand in the data;
        ``"session"``: all rows with the same value of a column of text, or three parts of one of numbers

    Raises
    ------
    InputError
        Another wish, a column that the data do not have or that does not differ, or the data are not at hand.
    """
    problem = fit.problem
    if isinstance(fit, JointFit):
        raise InputError(
            f"leave out: {wanted!r} found; of several experiments, single data and whole ones ('experiment') are left out"
        )
    if problem is None or isinstance(problem, JointProblem) or problem.dataset is None:
        raise InputError(
            f"'{fit.name}': its model or its data are not at hand, so no blocks of rows can be left out"
        )
    match = re.fullmatch(r"\s*(?P<column>.*?)\s*(?:(?:^|\s)in\s+(?P<count>\d+))?\s*", wanted)
    asked, number = (match["column"], match["count"]) if match else (wanted, None)
    columns = {**problem.dataset.columns, ORDER: np.arange(problem.conditions.n_rows, dtype=float)}
    column = asked or longest_column(problem)
    count = BLOCKS if number is None else int(number)
    if column not in columns or count < 2:
        raise InputError(
            f"leave out: {wanted!r} found; expected a column of the data and a number of blocks from 2 on, such as "
            f"'{longest_column(problem)} in 3'; columns: {', '.join(columns)}"
        )
    values = columns[column]
    if values.dtype.kind == "U":
        names, name = list(dict.fromkeys(values.tolist())), column
        member = np.array([names.index(value) for value in values.tolist()])
    else:
        member, name = _blocks_along(np.asarray(values, dtype=float), count), f"{column} in {count}"
        names = [_range(values[member == i], column, problem) for i in range(member.max() + 1)]
    if len(names) < 2:
        raise InputError(f"leave out: {wanted!r} found, but '{column}' does not differ from row to row")
    # data stand observable by observable
    member = np.tile(member, len(problem.observations))
    parts = Parts(name, tuple(names), member, np.empty((0, len(names))))
    theta = fit.theta()
    return parts.at(fit, theta[:: -(-len(theta) // MOST_DRAWS)])


def longest_column(problem: Problem) -> str:
    """The column along which a sweep runs; the order of the rows if none differs.

    Of inputs and covariates it is the one with the most different values, of several the one whose largest is the largest
    multiple of its smallest.
    """
    numbers = {**problem.conditions.values, **problem.conditions.covariates}

    def reach(column: str) -> tuple[int, float]:
        size = np.abs(numbers[column])
        return np.unique(size).size, float(size.max() / size.min()) if size.min() > 0 else 0.0

    differing = [column for column in numbers if np.unique(numbers[column]).size > 1]
    return max(differing, key=reach, default=ORDER)


def _blocks_along(values: FloatArray, count: int) -> NDArray[np.intp]:
    """Block of each row; the blocks are numbered along the column, and none is empty."""
    from scipy.stats import rankdata

    if np.isnan(values).any():
        raise InputError("leave out: a column without missing values expected")
    place = np.floor((rankdata(values) - 0.5) / len(values) * count)
    return np.asarray(np.unique(place, return_inverse=True)[1].reshape(-1))


def _range(values: FloatArray, column: str, problem: Problem) -> str:
    """From where to where a block goes."""
    if column == ORDER:
        return f"rows {values.min() + 1:.0f} to {values.max() + 1:.0f}"
    assert problem.dataset is not None
    unit = problem.dataset.units.get(column, "1")
    ends = dict.fromkeys(format_quantity(float(end), unit, 4) for end in (values.min(), values.max()))
    return " to ".join(ends)


def _densities(
    problem: Problem | JointProblem, member: NDArray[np.intp], count: int, theta: FloatArray
) -> FloatArray:
    from skinbayes.fit.refit import left_out_densities
    from skinbayes.problem.subsets import without_data

    found: Sequence[FloatArray] = [
        left_out_densities(problem, without_data(problem, member != i), theta) for i in range(count)
    ]
    return np.stack(found, axis=-1)
