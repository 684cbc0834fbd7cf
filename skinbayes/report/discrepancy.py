"""What the theory misses along a column, how the noise of neighbours is correlated, and drifts, in words and numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import is_logarithmic, observables
from skinbayes.phrases import percent
from skinbayes.plot.discrepancy import Curve, curves_of
from skinbayes.plot.numbers import interval, quantity, quantity_of
from skinbayes.plot.symbols import spoken_name

if TYPE_CHECKING:
    from skinbayes.fit import Fit

LEAST = 0.1
"""Part of the prior of a size next to 0 that the posterior is held against."""

WANTED, UNWANTED = 0.1, 1.0
"""Posterior over prior probability of a size next to 0 below which the data want the curve, and above which they do not."""

QUANTILES = (0.05, 0.5, 0.95)


@dataclass(frozen=True)
class DiscrepancyFinding:
    """The discrepancy along one column.

    Attributes
    ----------
    column : the column
    logarithmic : True if curves are those of ln of the observable, dimensionless; else they have its unit
    largest : 5, 50 and 95 % quantiles of the largest distance of the curves from 0
    x : values of the column, SI
    curves : level (or an empty name) to the same quantiles at these, shape ``(3, n)``
    ratio : probability of a size next to 0 over that before the data; None if the size is fixed
    """

    column: str
    logarithmic: bool
    largest: tuple[float, float, float]
    x: FloatArray
    curves: dict[str, FloatArray]
    ratio: float | None

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types, SI."""
        keys = ("q05", "median", "q95")
        return {
            "logarithmic": self.logarithmic,
            "largest": dict(zip(keys, self.largest, strict=True)),
            "probability_of_none_over_prior": self.ratio,
            "x": self.x.tolist(),
            "curves": {
                level: dict(zip(keys, values.tolist(), strict=True)) for level, values in self.curves.items()
            },
        }


def discrepancy_findings(fit: Fit) -> list[DiscrepancyFinding]:
    """What the theory misses along each column of a discrepancy; none without one."""
    return [_finding(fit, curve) for curve in curves_of(fit)]


def _finding(fit: Fit, curve: Curve) -> DiscrepancyFinding:
    largest = np.quantile(np.abs(curve.draws).max(axis=(1, 2)), QUANTILES)
    label, ratio = f"discrepancy_size[{curve.column}]", None
    if label in fit.names:
        near = np.quantile(fit.draws(label, "prior"), LEAST)
        ratio = float((fit.draws(label) < near).mean() / LEAST)
    bands = {level: np.quantile(curve.draws[:, i], QUANTILES, axis=0) for i, level in enumerate(curve.levels)}
    low, middle, high = (float(value) for value in largest)
    logarithmic = is_logarithmic(fit, observables(fit)[0])
    return DiscrepancyFinding(curve.column, logarithmic, (low, middle, high), curve.x, bands, ratio)


def discrepancy_sentences(fit: Fit) -> list[str]:
    """One entry for each column of a discrepancy, one for drifts, one for correlated noise."""
    said = [_said(fit, finding) for finding in discrepancy_findings(fit)]
    return [*said, *_drifts(fit), *_correlation(fit)]


def _said(fit: Fit, finding: DiscrepancyFinding) -> str:
    along = spoken_name(finding.column)
    low, middle, high = finding.largest
    said = (
        f"Along {along}: the theory misses up to {_size(fit, middle)} (90 %: {_size(fit, low)} to {_size(fit, high)}). "
        "Predictions contain this curve, and intervals of the parameters know that it is unknown."
    )
    if finding.ratio is None:
        return said
    if finding.ratio < WANTED:
        return f"{said} The data want it: without such a curve they would be far less probable."
    if finding.ratio > UNWANTED:
        return f"{said} The data do not ask for it: no such curve is at least as probable as before."
    return f"{said} Whether it is there at all the data leave open."


def _size(fit: Fit, value: float) -> str:
    """A distance: in percent of the observable where it is one of ln."""
    name = observables(fit)[0]
    if is_logarithmic(fit, name):
        return percent(float(np.expm1(value)))
    return quantity_of(name, value)


def _drifts(fit: Fit) -> list[str]:
    group = fit.groups.get("discrepancy")
    if group is None or "drift" not in group:
        return []
    series = [str(name) for name in group["series"].values]
    draws = np.asarray(group["drift"].values, dtype=float).reshape(-1, len(series))
    low, middle, high = np.quantile(draws, QUANTILES, axis=0)
    observable = observables(fit)[0]
    logarithmic = is_logarithmic(fit, observable)

    def shown(value: float) -> str:
        if logarithmic:
            change = float(np.expm1(value))
            return f"{'−' if change < 0 else '+'}{percent(abs(change))}"
        return quantity_of(observable, value)

    order = np.argsort(-np.abs(middle))[:3]
    each = [
        f"{series[i] + ' ' if series[i] else ''}{shown(middle[i])} (90 %: {shown(low[i])} to {shown(high[i])})"
        for i in order
    ]
    largest = "" if len(series) == 1 else "largest "
    return [f"Drift over the {'longest ' if len(series) > 1 else ''}series: {largest}{', '.join(each)}."]


def _correlation(fit: Fit) -> list[str]:
    label = "correlation_length"
    if label not in fit.names or fit.problem is None or fit.problem.correlated is None:
        return []
    noise = fit.problem.correlated.scatter.noise
    along = fit.problem.spec.correlation
    if noise is None or along is None:
        return []
    low, middle, high = (float(q) for q in fit.quantiles(label))
    unit = fit.unit(label)
    memory = float(np.exp(-np.median(noise.gap[np.isfinite(noise.gap)]) / middle))
    rows = fit.problem.conditions.n_rows
    where = "the order of the rows" if along.along == "order" else spoken_name(along.along)
    return [
        f"Memory of the noise: its correlation along {where} falls to 1/e over {quantity(middle, unit)} (90 %: "
        f"{interval(low, high, unit, typical=middle)}), that of neighbouring rows is {memory:.2f}. For a mean, {rows} such rows "
        f"tell about as much as {max(1, round(rows * (1 - memory) / (1 + memory)))} independent ones."
    ]
