"""Data and model against the condition that varies: the one picture of a fit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import observables, observed_values
from skinbayes.forward import Profile
from skinbayes.plot.predictive import LEVELS, plot_predictive, predictive_quantiles
from skinbayes.plot.profile_bands import MOST_CURVES, Band, profile_bands
from skinbayes.plot.rows import varying
from skinbayes.plot.scales import Scale, axis_scale, scale_for, ticks
from skinbayes.plot.style import (
    OBSERVED,
    POSTERIOR,
    SERIES,
    inches,
    key_below,
    letters_of_key,
    look,
    new_figure,
    set_title,
    wrapped,
)
from skinbayes.plot.symbols import axis_name
from skinbayes.vocabulary import STANDARD_DEVIATION_SUFFIX

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult
    from skinbayes.problem import Problem

IntArray: TypeAlias = NDArray[np.intp]

POINTS = 60
"""Abscissa values of a curve."""

MOST_BARS = 40
"""With more rows than this, each of other conditions, there are no bars row by row but a few curves."""


def plot_data(fit: FitResult, width: str | None = None) -> Figure:
    """Draw the data and what the fitted model says of them against the condition that varies: load, speed, humidity, time.

    Parameters
    ----------
    fit : any fit
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each observable. Rows that share all other conditions share a curve: the line is the median of the model,
        the band holds 90 % of the posterior, pale bars at the rows 90 % of what would be measured there, scatter included. Where
        each row has conditions of its own there are only bars, as in :func:`plot_predictive`. Dots are the data. Where nothing
        varies, or the model is gone, this is :func:`plot_predictive`.
    """
    view = None if fit.problem is None else varying(fit)
    if view is None or fit.problem is None:
        return plot_predictive(fit, width)
    name, along = view
    names = observables(fit)
    observed = observed_values(fit).reshape(len(names), -1)
    expected = predictive_quantiles(fit).reshape(len(LEVELS), len(names), -1)
    size = inches(width)
    bands = [_bands(fit, fit.problem, name, along, observable) for observable in names]
    several = max(len(found) for found in bands) > 1
    # long names of rows take several lines of the key
    rows = max(sum(1 + len(band.label) // letters_of_key(size) for band in found) for found in bands)
    below = 0.6 + 0.2 * (rows + 1 if several else 2)
    with look(size):
        figure = new_figure(
            size, 0.4 + below + 0.47 * size * len(names), left=0.12 * size + 0.12, right=0.15, bottom=below, top=0.4,
            between=(0.0, 0.2), panels=(1, len(names)),
        )  # fmt: skip
        axes = figure.subplots(len(names), 1, squeeze=False, sharex=True)[:, 0]
        for i, (ax, observable) in enumerate(zip(axes, names, strict=True)):
            _panel(ax, fit, _View(name, along, observable, observed[i], expected[:, i], bands[i]))
        unit, label = axis_name(name)
        axes[-1].set_xlabel(axis_scale(name, scale_for(unit, along)).label(label))
        key_below(figure, axes[0], 1 if several else 2)
        set_title(figure, fit, f"Data and model against {label}")
    return figure


@dataclass(frozen=True)
class _View:
    """What one panel shows, SI."""

    abscissa: str
    along: FloatArray
    observable: str
    observed: FloatArray
    expected: FloatArray
    bands: list[Band]


def _bands(fit: FitResult, problem: Problem, name: str, along: FloatArray, observable: str) -> list[Band]:
    """Curves of the model over the range of the data, one for each group of rows that share all other conditions.

    Empty if there is no such curve, or if rows have so many other conditions that bars say more.
    """
    if name not in problem.model.input_names():
        profile = next((p for p in problem.profiles if (p.abscissa, p.ordinate) == (name, observable)), None)
    else:
        even = bool((along <= 0.0).any()) or not scale_for("1", along).logarithmic
        space = np.linspace if even else np.geomspace
        grid = np.asarray(space(along.min(), along.max(), POINTS))
        # of the curve only names and grid are asked for: the ordinate is what the model predicts
        profile = Profile("data", "", name, observable, lambda *_: grid, lambda *_: grid)
    if profile is None:
        return []
    bands = profile_bands(fit, problem, profile)
    shown = sum(len(band.rows) for band in bands)
    few = len(bands) <= MOST_CURVES and shown == len(along) and shown > len(bands)
    return bands if few or len(along) > MOST_BARS else []


def _panel(ax: Axes, fit: FitResult, view: _View) -> None:
    (x_unit, _), (y_unit, y_name) = axis_name(view.abscissa), axis_name(view.observable)
    x_scale = axis_scale(view.abscissa, scale_for(x_unit, view.along))
    shown = [view.observed, *(view.expected[[0, 4]] if len(view.bands) < 2 else [])]
    y_scale = scale_for(y_unit, np.concatenate([*shown, *(band.quantiles[2] for band in view.bands)]))
    if view.bands:
        colours = _curves(ax, view, x_scale, y_scale)
    else:
        _bars(ax, view, x_scale, y_scale)
        colours = [(np.arange(len(view.along)), OBSERVED)]
    for i, (rows, colour) in enumerate(colours):
        _dots(ax, fit, view, rows, colour, (x_scale, y_scale), "measured" if i == 0 else None)
    if x_scale.logarithmic:
        ax.set_xscale("log")
    if y_scale.logarithmic:
        ax.set_yscale("log")
    elif min(ax.get_ylim()) < 0.5 * float(y_scale.shown(view.observed.min())) and view.observed.min() >= 0.0:
        ax.set_ylim(bottom=0.0)
    ticks(ax.xaxis, x_scale, *ax.get_xlim(), most=6, between=True)
    ticks(ax.yaxis, y_scale, *ax.get_ylim(), most=5, between=True)
    ax.set_ylabel(y_scale.label(y_name))
    ax.grid()


def _curves(ax: Axes, view: _View, x_scale: Scale, y_scale: Scale) -> list[tuple[IntArray, str]]:
    """Draw the curves; return which rows are drawn in which colour."""
    single = len(view.bands) == 1
    whole = sum(len(band.rows) for band in view.bands) == len(view.along)
    drawn = []
    for band, colour in zip(view.bands, [POSTERIOR] if single else SERIES, strict=False):
        x, (low, _, median, _, high) = x_scale.shown(band.abscissa), y_scale.shown(band.quantiles)
        if whole:
            at, ends = _expected(view, np.array(band.rows))
            ax.vlines(
                x_scale.shown(at), *y_scale.shown(ends), color=colour, alpha=0.2, linewidth=min(5.0, 240.0 / len(at)),
                label="90 % of measurements" if single else "",
            )  # fmt: skip
        ax.fill_between(
            x,
            low,
            high,
            color=colour,
            alpha=0.4,
            linewidth=0.0,
            label="90 % of the model" if single else "",
        )
        ax.plot(x, median, color=colour, label="median" if single else wrapped(ax, band.label))
        drawn.append((np.array(band.rows), OBSERVED if single else colour))
    return drawn if whole else [(np.arange(len(view.along)), OBSERVED)]


def _expected(view: _View, rows: IntArray) -> tuple[FloatArray, FloatArray]:
    """5 and 95 % quantiles of what would be measured at the different abscissas of some rows, in order."""
    at = np.unique(view.along[rows])
    ends = [view.expected[[0, 4]][:, rows[view.along[rows] == x]].mean(axis=1) for x in at]
    return at, np.array(ends).T


def _bars(ax: Axes, view: _View, x_scale: Scale, y_scale: Scale) -> None:
    x, (low, q25, _, q75, high) = x_scale.shown(view.along), y_scale.shown(view.expected)
    ax.vlines(x, low, high, color=POSTERIOR, alpha=0.3, linewidth=5.0, label="90 % of measurements")
    ax.vlines(x, q25, q75, color=POSTERIOR, alpha=0.7, linewidth=5.0, label="half of them")


def _dots(
    ax: Axes,
    fit: FitResult,
    view: _View,
    rows: IntArray,
    colour: str,
    scales: tuple[Scale, Scale],
    label: str | None,
) -> None:
    spread = view.observable + STANDARD_DEVIATION_SUFFIX
    known = fit.groups["constant_data"]
    errors = scales[1].shown(known[spread].values[rows]) if spread in known else None
    ax.errorbar(
        scales[0].shown(view.along[rows]), scales[1].shown(view.observed[rows]), errors, fmt="o", color=colour,
        markersize=5.0, markeredgecolor="white", markeredgewidth=0.6, elinewidth=0.9, zorder=3, label=label,
    )  # fmt: skip
