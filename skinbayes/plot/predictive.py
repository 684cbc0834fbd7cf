"""Observed data against what the model predicts for them, before and after the fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import observables, observed_values, predictive_draws, row_names
from skinbayes.plot.scales import scale_for, ticks
from skinbayes.plot.style import (
    OBSERVED,
    POSTERIOR,
    PRIOR,
    SMALL,
    inches,
    key_below,
    look,
    new_figure,
    set_title,
    shortened,
)
from skinbayes.plot.symbols import figure_text, spoken_name
from skinbayes.statistics.quantiles import finite_quantiles
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult

MOST_LABELLED = 40
"""Up to so many rows each has its name; beyond, rows are ordered by prediction and have none."""

LONGEST, LONGEST_SMALL = 24, 16
"""Letters of the name of a row, on screens and in narrow figures."""

LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)


def plot_predictive(fit: FitResult, width: str | None = None) -> Figure:
    """Draw observed values on their posterior predictive distributions.

    Parameters
    ----------
    fit : any fit
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        For each row of data the median and the 25–75 % and 5–95 % ranges of data simulated from the posterior, noise
        included, and the observed value.
    """
    return _plot(fit, "posterior_predictive", "Data against the fitted model", POSTERIOR, width)


def plot_prior_predictive(fit: FitResult, width: str | None = None) -> Figure:
    """Draw observed values on their prior predictive distributions: what the model expected before it saw the data.

    Parameters
    ----------
    fit : any fit
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        As :func:`plot_predictive`, from the prior.
    """
    return _plot(fit, "prior_predictive", "Data against what the priors allow", PRIOR, width)


def predictive_quantiles(fit: FitResult, group: str = "posterior_predictive") -> FloatArray:
    """5, 25, 50, 75 and 95 % quantiles of the finite predictive draws of each row, shape ``(5, N)``, SI."""
    return finite_quantiles(predictive_draws(fit, group), LEVELS)


def datum_names(fit: FitResult) -> list[str]:
    """Names of the data: their row, their observable, or both."""
    rows, names = row_names(fit), [spoken_name(name) for name in observables(fit)]
    if len(names) == 1:
        return rows
    return names if len(rows) == 1 else [f"{name}, {row}" for name in names for row in rows]


def _plot(fit: FitResult, group: str, title: str, colour: str, width: str | None) -> Figure:
    names, rows = observables(fit), row_names(fit)
    if rows == ["1"]:  # the number of a row that has no other is no name
        rows = [""]
    count = len(rows)
    observed = observed_values(fit).reshape(len(names), count)
    quantiles = predictive_quantiles(fit, group).reshape(len(LEVELS), len(names), count)
    size = inches(width)
    longest = LONGEST if size >= SMALL else LONGEST_SMALL
    with look(size):
        if count <= MOST_LABELLED:
            letters = max(len(shortened(name, longest)) for name in rows)
            margin = 0.25 + (0.085 if size >= SMALL else 0.07) * letters
            height = 1.35 + 0.26 * max(count, 3) + (len(names) - 1) * (0.75 + 0.26 * count)
            figure = new_figure(size, height, left=margin, bottom=0.85)
        else:
            figure = new_figure(
                size, 0.9 + 0.52 * size + 3.0 * (len(names) - 1), left=0.12 * size + 0.12, bottom=0.85
            )
        panels = figure.subplots(len(names), 1, squeeze=False)[:, 0]
        if len(names) > 1:
            figure.subplots_adjust(hspace=0.75 / (0.26 * max(count, 3)) if count <= MOST_LABELLED else 0.35)
        for i, (name, ax) in enumerate(zip(names, panels, strict=True)):
            _panel(ax, name, observed[i], quantiles[:, i], [shortened(row, longest) for row in rows], colour)
        key_below(figure, panels[-1], 3)
        set_title(figure, fit, title)
    return figure


def _panel(
    ax: Axes, name: str, observed: FloatArray, quantiles: FloatArray, rows: list[str], colour: str
) -> None:
    """One observable: its data and their predictive distributions."""
    quantity = lookup(name)
    unit, symbol = (quantity.unit, quantity.symbol) if quantity else ("1", name)
    scale = scale_for(unit, quantiles.ravel(), observed)
    count = len(observed)
    order = np.arange(count) if count <= MOST_LABELLED else np.argsort(quantiles[2], kind="stable")
    bands, points = scale.shown(quantiles[:, order]), scale.shown(observed[order])
    label = scale.label(f"{spoken_name(name)} {figure_text(symbol)}")
    if count <= MOST_LABELLED:
        _labelled(ax, bands, points, rows, colour)
        axis: Axis = ax.xaxis
        ax.set_xlabel(label)
        if scale.logarithmic:
            ax.set_xscale("log")
    else:
        _dense(ax, bands, points, colour)
        axis = ax.yaxis
        ax.set_ylabel(label)
        ax.set_xlabel(f"{count} rows of data, ordered by prediction")
        if scale.logarithmic:
            ax.set_yscale("log")
    low, high = ax.get_xlim() if axis is ax.xaxis else ax.get_ylim()
    if high > low:
        ticks(axis, scale, low, high, most=5)


def _labelled(ax: Axes, bands: FloatArray, points: FloatArray, names: list[str], colour: str) -> None:
    y = np.arange(len(points))[::-1]
    ax.hlines(y, bands[0], bands[4], color=colour, alpha=0.35, linewidth=7.0, label="5–95 %")
    ax.hlines(y, bands[1], bands[3], color=colour, alpha=0.9, linewidth=7.0, label="25–75 %")
    ax.plot(bands[2], y, "|", color="white", markersize=7.0, markeredgewidth=1.4)
    ax.plot(
        points,
        y,
        "o",
        color=OBSERVED,
        markersize=6.0,
        markeredgecolor="white",
        linestyle="",
        label="observed",
    )
    ax.set_yticks(y, names, parse_math=False)
    ax.set_ylim(-0.7, len(points) - 0.3)
    ax.grid(axis="x")


def _dense(ax: Axes, bands: FloatArray, points: FloatArray, colour: str) -> None:
    x = np.arange(1, len(points) + 1)
    ax.fill_between(
        x, bands[0], bands[4], step="mid", color=colour, alpha=0.25, linewidth=0.0, label="5–95 %"
    )
    ax.fill_between(
        x, bands[1], bands[3], step="mid", color=colour, alpha=0.5, linewidth=0.0, label="25–75 %"
    )
    ax.plot(x, points, ".", color=OBSERVED, markersize=4.0, linestyle="", label="observed")
    ax.set_xlim(0.5, len(points) + 0.5)
