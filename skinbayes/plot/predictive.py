"""Observed data against what the model predicts for them, before and after the fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.plot.scales import scale_for, ticks
from skinbayes.plot.style import OBSERVED, POSTERIOR, PRIOR, WIDTH, key_below, look, new_figure, set_title
from skinbayes.plot.symbols import figure_text, spoken_name
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from skinbayes.fit import Fit

MOST_LABELLED = 40
"""Up to so many rows each has its name; beyond, rows are ordered by prediction and have none."""

LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)


def plot_predictive(fit: Fit) -> Figure:
    """Draw observed values on their posterior predictive distributions.

    Parameters
    ----------
    fit : any fit

    Returns
    -------
    matplotlib.figure.Figure
        For each row of data the median and the 25–75 % and 5–95 % ranges of data simulated from the posterior, noise
        included, and the observed value.
    """
    return _plot(fit, "posterior_predictive", "Data against the fitted model", POSTERIOR)


def plot_prior_predictive(fit: Fit) -> Figure:
    """Draw observed values on their prior predictive distributions: what the model expected before it saw the data.

    Parameters
    ----------
    fit : any fit

    Returns
    -------
    matplotlib.figure.Figure
        As :func:`plot_predictive`, from the prior.
    """
    return _plot(fit, "prior_predictive", "Data against what the priors allow", PRIOR)


def predictive_quantiles(fit: Fit, group: str = "posterior_predictive") -> FloatArray:
    """5, 25, 50, 75 and 95 % quantiles of the finite predictive draws of each row, shape ``(5, N)``, SI."""
    draws = predictive_draws(fit, group)
    return np.stack(
        [
            np.quantile(column[np.isfinite(column)], LEVELS)
            if np.isfinite(column).any()
            else np.full(5, np.nan)
            for column in draws.T
        ],
        axis=1,
    )


def predictive_draws(fit: Fit, group: str = "posterior_predictive") -> FloatArray:
    """All predictive draws, shape ``(draws, N)``, SI."""
    values = fit.groups[group][fit.provenance["observable"]].values
    return np.asarray(values, dtype=float).reshape(-1, values.shape[-1])


def observed_values(fit: Fit) -> FloatArray:
    """The data, shape ``(N,)``, SI."""
    return np.asarray(fit.groups["observed_data"][fit.provenance["observable"]].values, dtype=float)


def row_names(fit: Fit) -> list[str]:
    """Names of the rows of data."""
    return [str(row) for row in fit.groups["observed_data"]["row"].values]


def _plot(fit: Fit, group: str, title: str, colour: str) -> Figure:
    observed = observed_values(fit)
    quantiles = predictive_quantiles(fit, group)
    name = str(fit.provenance["observable"])
    quantity = lookup(name)
    unit, symbol = (quantity.unit, quantity.symbol) if quantity else ("1", name)
    scale = scale_for(unit, quantiles.ravel(), observed)
    count = len(observed)
    order = np.arange(count) if count <= MOST_LABELLED else np.argsort(quantiles[2], kind="stable")
    bands, points = scale.shown(quantiles[:, order]), scale.shown(observed[order])
    label = scale.label(f"{spoken_name(name)} {figure_text(symbol)}")
    with look():
        if count <= MOST_LABELLED:
            names = [_shortened(name) for name in row_names(fit)]
            margin = 0.25 + 0.085 * max(len(name) for name in names)
            figure = new_figure(WIDTH, 1.35 + 0.26 * max(count, 3), left=margin, bottom=0.85)
            ax = figure.subplots()
            _labelled(ax, bands, points, names, colour)
            axis: Axis = ax.xaxis
            ax.set_xlabel(label)
            if scale.logarithmic:
                ax.set_xscale("log")
        else:
            figure = new_figure(WIDTH, 3.6, left=0.75, bottom=0.85)
            ax = figure.subplots()
            _dense(ax, bands, points, colour)
            axis = ax.yaxis
            ax.set_ylabel(label)
            ax.set_xlabel(f"{count} rows of data, ordered by prediction")
            if scale.logarithmic:
                ax.set_yscale("log")
        low, high = ax.get_xlim() if axis is ax.xaxis else ax.get_ylim()
        if high > low:
            ticks(axis, scale, low, high, most=5)
        key_below(figure, ax, 3)
        set_title(figure, fit, title)
    return figure


def _shortened(name: str) -> str:
    return name if len(name) <= 24 else name[:23] + "…"


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
    ax.grid(axis="x", color="#E2E2E2", linewidth=0.6)
    ax.set_axisbelow(True)


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
