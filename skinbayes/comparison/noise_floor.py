"""The scatter that no theory with effects of groups can do without explaining how rows differ inside them."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import isfinite, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.phrases import plural
from skinbayes.statistics.two_way import residual_scatter

if TYPE_CHECKING:
    from skinbayes.problem import Problem


@dataclass(frozen=True)
class NoiseFloor:
    """Residual scatter of data after a free offset for each level of each grouping column.

    Attributes
    ----------
    columns : the grouping columns
    observable : what scatters
    logarithmic : True if it is ln of the observable
    standard_deviation : of the residual, unit of the observable or none
    degrees_of_freedom : of the residual
    """

    columns: tuple[str, ...]
    observable: str
    logarithmic: bool
    standard_deviation: float
    degrees_of_freedom: int

    @property
    def relative_error(self) -> float:
        """Standard error of the standard deviation, relative, for normal residuals."""
        return 1.0 / sqrt(2.0 * self.degrees_of_freedom)

    def sentence(self) -> str:
        """What the floor is, in words."""
        offsets = " and ".join(plural(column) for column in self.columns)
        what = f"ln {self.observable}" if self.logarithmic else self.observable
        return (
            f"Noise floor: free offsets of {offsets} leave a scatter of {self.standard_deviation:.3g} in {what} "
            f"(analysis of variance, {self.degrees_of_freedom} degrees of freedom)."
        )

    def against(self, scatter: float) -> str:
        """How the scatter that a fit needs compares with the floor, in words; same unit as the floor."""
        ratio = scatter / self.standard_deviation
        said = f"The fit needs a scatter of {scatter:.3g}, {ratio:.2f} times the floor: "
        if ratio > 1.0 + 2.0 * self.relative_error:
            return said + "it adds errors of its own inside the groups."
        if ratio < 1.0 - 2.0 * self.relative_error:
            return said + "it explains how rows differ inside the groups."
        return said + "what it leaves is about what offsets of the groups leave."

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        return asdict(self)


def noise_floor(problem: Problem) -> NoiseFloor | None:
    """Analysis of variance of the data of a problem in the columns that have effects; None without such effects.

    Parameters
    ----------
    problem : a problem with data

    Returns
    -------
    NoiseFloor or None
        None also if the columns leave no degrees of freedom, or all data agree

    Examples
    --------
    >>> from skinbayes.problem import load_problem
    >>> floor = noise_floor(load_problem("finger-null"))
    >>> round(floor.standard_deviation, 3), floor.degrees_of_freedom
    (0.3, 140)
    """
    if problem.groups is None:
        return None
    (observation,) = problem.observations
    logarithmic = observation.noise.logarithmic
    values = np.log(observation.values) if logarithmic else observation.values
    columns = problem.groups.columns
    deviation, left = residual_scatter(values, {c: problem.conditions.labels[c] for c in columns})
    if not (isfinite(deviation) and deviation > 0):
        return None
    return NoiseFloor(columns, observation.name, logarithmic, deviation, left)
