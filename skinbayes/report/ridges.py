"""Pairs of parameters that the posterior knows together much better than apart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.diagnose import ridges
from skinbayes.phrases import number, percent

if TYPE_CHECKING:
    from skinbayes.fit import Fit

PLAIN = 0.05
"""An exponent so close to one is written as one."""

SMALL = 1.15
"""Ratios below are said as percentages: a factor of 1.0 says nothing."""


@dataclass(frozen=True)
class PosteriorRidge:
    """Two parameters on a ridge.

    Attributes
    ----------
    first, second : labels of the parameters
    correlation : of their logarithms, or of themselves where one is not positive
    exponent : k of second ∝ first^k along the ridge; None where one is not positive
    combination : what is known, in symbols; empty where one is not positive
    factor : upper over lower end of the 90 % interval of the combination
    factors_alone : the same for each of the two
    """

    first: str
    second: str
    correlation: float
    exponent: float | None
    combination: str
    factor: float | None
    factors_alone: tuple[float, float] | None


def posterior_ridges(fit: Fit) -> list[PosteriorRidge]:
    """The ridges of a fit, strongest first."""
    found = []
    shown = [i for i, label in enumerate(fit.names) if label in fit.shown_names]
    for ridge in ridges(fit.shown_names, fit.theta()[:, shown]):
        if not ridge.logarithmic:
            found.append(PosteriorRidge(ridge.first, ridge.second, ridge.correlation, None, "", None, None))
            continue
        power = 1.0 if abs(abs(ridge.exponent) - 1.0) < PLAIN else abs(ridge.exponent)
        sign = 1.0 if ridge.exponent > 0.0 else -1.0
        symbol = fit.symbol(ridge.first)
        raised = symbol if power == 1.0 else f"{symbol}^{number(power, 2)}"
        logs = [np.log(fit.draws(label)) for label in (ridge.first, ridge.second)]
        found.append(
            PosteriorRidge(
                ridge.first,
                ridge.second,
                ridge.correlation,
                sign * power,
                f"{fit.symbol(ridge.second)} {'/' if sign > 0.0 else '·'} {raised}",
                _factor(logs[1] - sign * power * logs[0]),
                (_factor(logs[0]), _factor(logs[1])),
            )
        )
    return found


def ridge_sentences(fit: Fit) -> list[str]:
    """Which parameters form ridges, the combination that is known and how much better than each alone."""
    said = []
    for ridge in posterior_ridges(fit):
        first, second = fit.symbol(ridge.first), fit.symbol(ridge.second)
        start = (
            f"{first} and {second} are known together better than apart (correlation {ridge.correlation:.2f})"
        )
        if ridge.factor is None or ridge.factors_alone is None:
            said.append(f"{start}.")
            continue
        one, two = (_within(factor) for factor in ridge.factors_alone)
        said.append(
            f"{start}: {ridge.combination} is known within {_within(ridge.factor)}, from end to end of its 90 % "
            f"interval; alone, {first} is known only within {one} and {second} within {two}."
        )
    return said


def _within(factor: float) -> str:
    """How far apart two ends are whose ratio is ``factor``, as people say it."""
    return percent(factor - 1) if factor < SMALL else f"a factor of {number(factor, 2)}"


def _factor(logarithm: FloatArray) -> float:
    low, high = np.quantile(logarithm, [0.05, 0.95])
    return float(np.exp(high - low))
