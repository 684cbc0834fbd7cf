"""What residuals do along the columns that vary, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.fit.misfit import ORDER
from skinbayes.fit.predicted import is_logarithmic, observables
from skinbayes.phrases import percent
from skinbayes.plot.numbers import quantity_of
from skinbayes.plot.symbols import spoken_name
from skinbayes.statistics.noise_families import noise_family
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from skinbayes.fit import Fit
    from skinbayes.statistics.trends import Trend


def worst(fit: Fit) -> dict[str, Trend]:
    """The most surprising trend of each observable that has one; along a column rather than in the order of the rows."""
    found = {name: [c for c in checks if c.found] for name, checks in fit.residual_trends.items()}
    # rows often stand in the order of a column
    return {name: min(checks, key=lambda c: c.column == ORDER) for name, checks in found.items() if checks}


def trend_sentences(fit: Fit) -> list[str]:
    """One sentence for each observable whose residuals follow a column as those of the model hardly ever do."""
    found = worst(fit)
    said = [_said(fit, name, trend) for name, trend in found.items()]
    return said + [remedy for name, trend in found.items() if (remedy := _remedy(fit, name, trend.column))]


def _remedy(fit: Fit, observable: str, column: str) -> str:
    """What to put into the model file against a trend along a column; nothing where it cannot be said there, or is already."""
    noise = fit.provenance.get("noise", {}).get(observable)
    usable = noise is not None and noise_family(str(noise)).closed_form_groups
    if (
        len(observables(fit)) > 1
        or not usable
        or any("correlat" in n or "discrepancy_s" in n for n in fit.names)
    ):
        return ""
    curve = f'[discrepancy] with along = "{column}", a smooth curve that the theory may miss'
    memory = f'[noise.correlation] with along = "{column}", noise whose neighbours are alike'
    return f"What the model file can say to that: {f'{memory}; or ' if column in (ORDER, 'time') else ''}{curve}."


def _said(fit: Fit, observable: str, trend: Trend) -> str:
    known = lookup(observable)
    what = known.symbol if known else spoken_name(observable)
    along = "the order of the rows" if trend.column == ORDER else spoken_name(trend.column)
    chance = f"simulated data of the model do so in {percent(trend.probability)} of cases"
    logs = is_logarithmic(fit, observable)
    low, middle, high = (_size(observable, x, logs) for x in (trend.low, trend.middle, trend.high))
    if trend.kind == "slope":
        return (
            f"{what} {'rises' if trend.value > 0 else 'falls'} along {along} as this model cannot: on average the data lie "
            f"{low} the model in the lower third of the rows and {high} it in the upper third ({chance})."
        )
    if trend.kind == "curvature":
        return (
            f"{what} bends along {along} as this model cannot: on average the data lie {low} the model in the lower third of "
            f"the rows, {middle} it in the middle and {high} it in the upper third ({chance})."
        )
    if trend.kind == "spread":
        return (
            f"The scatter of {what} {'grows' if trend.value > 0 else 'shrinks'} along {along}, which this model does not know "
            f"({chance})."
        )
    return (
        f"Residuals of {what} that follow each other along {along} are alike (correlation {trend.value:.2f}, at most "
        f"{trend.expected[1]:.2f} would be usual): the model misses a curve there, or the rows are not independent ({chance})."
    )


def _size(observable: str, residual: float, logarithmic: bool) -> str:
    side = "above" if residual > 0 else "below"
    if logarithmic:
        return f"{percent(abs(float(np.expm1(residual))))} {side}"
    return f"{quantity_of(observable, abs(residual))} {side}"
