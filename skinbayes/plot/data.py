"""Data and model against the condition that varies: the one picture of a fit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.fit.predicted import observables, observed_values
from skinbayes.forward import Profile
from skinbayes.plot.predictive import LEVELS, plot_predictive, predictive_quantiles
from skinbayes.plot.profile_bands import MOST_CURVES, Band, profile_bands, with_discrepancy
from skinbayes.plot.rows import effect_at_rows, group_columns, varying, varying_conditions
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
from skinbayes.vocabulary import STANDARD_DEVIATION_SUFFIX, suggestions

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


def plot_data(fit: FitResult, width: str | None = None, abscissa: str | None = None) -> Figure:
    """Draw the data and what the fitted model says of them against the condition that varies: load, speed, humidity, time.

    Parameters
    ----------
    fit : any fit
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted
    abscissa : condition to draw against, one of :func:`data_abscissas`; the first if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each observable. Rows that share all other conditions share a curve: the line is the median of the model,
        the band holds 90 % of the posterior (a darker one half, where there is one curve), pale bars at the rows 90 % of what
        would be measured there, scatter and effects of groups included. With a discrepancy along the abscissa the curve
        contains it, and a dashed line is the median of the theory alone. Where each row has conditions of its own there are
        only bars, as in :func:`plot_predictive`. Dots are the data, with their standard deviations where these are known;
        small open ones, where groups have effects, are the data without them: what the curve should go through. Where nothing
        varies, or the model is gone, this is :func:`plot_predictive`.

    Raises
    ------
    InputError
        ``abscissa`` is no condition that differs between rows.
    """
    offered = data_abscissas(fit)
    if abscissa is not None and abscissa not in offered:
        known = (
            f"these data can be drawn against {', '.join(offered)}"
            if offered
            else "no condition of these data differs"
        )
        raise InputError(f"abscissa: found {abscissa!r}; {known}.{suggestions(abscissa, list(offered))}")
    if not offered or fit.problem is None:
        return plot_predictive(fit, width)
    name = abscissa or next(iter(offered))
    along = offered[name]
    names = observables(fit)
    observed = observed_values(fit).reshape(len(names), -1)
    expected = predictive_quantiles(fit).reshape(len(LEVELS), len(names), -1)
    size = inches(width)
    bands = [_bands(fit, fit.problem, name, along, observable) for observable in names]
    bare = _without_effects(fit, fit.problem)
    several = max(len(found) for found in bands) > 1
    # long names of rows take several lines of the key
    rows = max(sum(1 + len(band.label) // letters_of_key(size) for band in found) for found in bands)
    extra = (bare is not None) + any(band.theory is not None for found in bands for band in found)
    below = 0.6 + 0.2 * (rows + 1 + extra if several else 2 + (extra + 1) // 2)
    with look(size):
        figure = new_figure(
            size, 0.4 + below + 0.47 * size * len(names), left=0.12 * size + 0.12, right=0.15, bottom=below, top=0.4,
            between=(0.0, 0.2), panels=(1, len(names)),
        )  # fmt: skip
        axes = figure.subplots(len(names), 1, squeeze=False, sharex=True)[:, 0]
        for i, (ax, observable) in enumerate(zip(axes, names, strict=True)):
            _panel(
                ax,
                fit,
                _View(
                    name,
                    along,
                    observable,
                    observed[i],
                    expected[:, i],
                    bands[i],
                    None if bare is None else bare[i],
                ),
            )
        unit, label = axis_name(name)
        axes[-1].set_xlabel(axis_scale(name, scale_for(unit, along)).label(label))
        key_below(figure, axes[0], 1 if several else 2)
        set_title(figure, fit, f"Data and model against {label}")
    return figure


def data_abscissas(fit: FitResult) -> dict[str, FloatArray]:
    """What the data of a fit can be drawn against: name to the value of each row, ``(N,)``, SI; the usual one first."""
    found = varying(fit)
    if found is None or fit.problem is None:
        return {}
    return {found[0]: found[1]} | {
        name: values for name, values in varying_conditions(fit.problem).items() if name != found[0]
    }


@dataclass(frozen=True)
class _View:
    """What one panel shows, SI."""

    abscissa: str
    along: FloatArray
    observable: str
    observed: FloatArray
    expected: FloatArray
    bands: list[Band]
    without_effects: FloatArray | None = None


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
    return (
        [with_discrepancy(fit, problem, profile, band) for band in bands]
        if few or len(along) > MOST_BARS
        else []
    )


def _without_effects(fit: FitResult, problem: Problem) -> FloatArray | None:
    """The data less the posterior median of the effects of their groups, ``(observables, N)``, SI; None without effects."""
    columns = group_columns(fit)
    if not columns:
        return None
    names = observables(fit)
    values = observed_values(fit).reshape(len(names), -1)
    effect = sum(
        (np.median(effect_at_rows(fit, column), axis=0) for column in columns),
        start=np.zeros(values.shape[1]),
    )
    logarithmic = problem.noise_is_logarithmic.reshape(len(names), -1)[:, :1]
    return np.asarray(np.where(logarithmic, values * np.exp(-effect), values - effect))


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
    if view.without_effects is not None and view.bands:
        ax.plot(
            x_scale.shown(view.along), y_scale.shown(view.without_effects), "o", markersize=3.0, markerfacecolor="none",
            markeredgecolor="#5A5A5A", markeredgewidth=0.6, zorder=2.9, label="less effects of groups",
        )  # fmt: skip
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
        x, (low, q25, median, q75, high) = x_scale.shown(band.abscissa), y_scale.shown(band.quantiles)
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
        if single:
            ax.fill_between(x, q25, q75, color=colour, alpha=0.35, linewidth=0.0)
        ax.plot(x, median, color=colour, label="median" if single else wrapped(ax, band.label))
        if band.theory is not None:
            ax.plot(
                x, y_scale.shown(band.theory), color="#1A1A1A" if single else colour, linewidth=0.9, linestyle=(0, (4, 2)),
                label="theory alone" if single else "",
            )  # fmt: skip
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
    known = fit.groups["constant_data"]
    y_error, x_error = (
        scale.shown(known[name + STANDARD_DEVIATION_SUFFIX].values[rows])
        if name + STANDARD_DEVIATION_SUFFIX in known
        else None
        for name, scale in ((view.observable, scales[1]), (view.abscissa, scales[0]))
    )
    ax.errorbar(
        scales[0].shown(view.along[rows]), scales[1].shown(view.observed[rows]), y_error, x_error, fmt="o", color=colour,
        markersize=5.0, markeredgecolor="white", markeredgewidth=0.6, elinewidth=0.9, zorder=3, label=label,
    )  # fmt: skip
