"""Data over posterior bands of the model, one small panel for each person, liquid or other level of a column."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.fit.predicted import observables, observed_values
from skinbayes.plot.predictive import LEVELS
from skinbayes.plot.profile_bands import curve_at_row
from skinbayes.plot.rows import (
    RowPredictions,
    effect_draws,
    followed_profile,
    group_columns,
    label_columns,
    levels_of_rows,
    row_predictions,
    telling_columns,
    varying,
)
from skinbayes.plot.scales import Scale, scale_for, ticks
from skinbayes.plot.style import (
    GONE,
    OBSERVED,
    POSTERIOR,
    SMALL,
    inches,
    key_below,
    look,
    new_figure,
    sentence_figure,
    set_title,
    shortened,
)
from skinbayes.plot.symbols import axis_name, spoken_name
from skinbayes.statistics.quantiles import finite_quantiles

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult
    from skinbayes.problem import Problem

COLUMNS = 3

MOST_PANELS = 24
"""Levels drawn; of more, those with the most rows."""

LONGEST, LONGEST_SMALL = 30, 16
"""Letters of the name of a level above its panel, in wide and in narrow figures."""

USUAL = 7.8
"""Width, inch."""

OTHERS, TYPICAL = "#BDBDBD", "#5A5A5A"


def plot_levels(
    fit: FitResult,
    column: str | None = None,
    predictions: RowPredictions | None = None,
    width: str | None = None,
) -> Figure:
    """Draw the data of each level of a grouping column over what the model says of them.

    Parameters
    ----------
    fit : a fit with its problem
    column : grouping column, such as ``person``; the first with effects if omitted
    predictions : from :func:`skinbayes.plot.rows.row_predictions`, to compute them once for several figures
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each level, on common axes: the points of the level, those of all others in grey, and the model at the
        level's own rows joined in order of the abscissa – median, 25–75 % and 5–95 % of the posterior, with the effect of the
        level if it has one and without that of other columns. The thin line is a typical curve: the posterior median of the
        parameters at the row in the middle. A sentence if there is nothing to draw.

    Raises
    ------
    InputError
        ``column`` is no grouping column.
    """
    columns = telling_columns(fit)
    if column is not None and column not in label_columns(fit):
        known = (
            f"these data can be drawn by {', '.join(columns)}" if columns else "no column groups these data"
        )
        raise InputError(f"column: {column!r} is no grouping column; {known}")
    column = column or next(iter(columns), None)
    title = (
        f"Data and model, {spoken_name(column)} by {spoken_name(column)}"
        if column
        else "Data and model by group"
    )
    if fit.problem is None:
        return sentence_figure(fit, title, GONE, width)
    abscissa = varying(fit)
    if column is None or column not in columns or abscissa is None:
        reason = "all rows have the same conditions" if abscissa is None else "no column groups them"
        return sentence_figure(fit, title, f"The data cannot be drawn by group: {reason}.", width)
    view = _view(fit, fit.problem, column, abscissa, predictions or row_predictions(fit, fit.problem))
    size = inches(width, USUAL)
    below = 0.9 if size >= SMALL else 1.15
    columns_drawn = COLUMNS if size >= SMALL else COLUMNS - 1
    rows = -(-len(view.levels) // columns_drawn)
    with look(size):
        tall = 0.45 + below + (1.75 if size >= SMALL else 1.35) * rows
        figure = new_figure(
            size, tall, left=0.55 + 0.026 * size, right=0.12, bottom=below, top=0.6, between=(0.12, 0.32),
            panels=(columns_drawn, rows),
        )  # fmt: skip
        axes = figure.subplots(rows, columns_drawn, sharex=True, sharey=True, squeeze=False).reshape(-1)
        for ax, level in zip(axes, view.levels, strict=False):
            _panel(ax, view, level, LONGEST if size >= SMALL else LONGEST_SMALL)
        for ax in axes[len(view.levels) :]:
            ax.set_axis_off()
        # the lowest panel of each column has the numbers of the axis below it
        for ax in axes[max(0, len(view.levels) - columns_drawn) : len(view.levels)]:
            ax.tick_params(labelbottom=True)
        _dress(axes[0], view)
        figure.supxlabel(
            view.x_label,
            y=(below - 0.43) / figure.get_size_inches()[1],
            fontsize=10.0 if size >= SMALL else 8.0,
            va="center",
        )
        figure.supylabel(view.y_label, x=0.02, fontsize=10.0 if size >= SMALL else 8.0)
        key_below(figure, axes[0], 5)
        set_title(figure, fit, title)
    return figure


@dataclass(frozen=True)
class _View:
    """Everything a panel shows, in the units shown."""

    levels: list[str]
    of_row: NDArray[np.str_]
    x: FloatArray
    y: FloatArray
    bands: FloatArray
    typical: tuple[FloatArray, FloatArray] | None
    x_scale: Scale
    y_scale: Scale
    x_label: str
    y_label: str
    effects: dict[str, str]


def _view(
    fit: FitResult,
    problem: Problem,
    column: str,
    abscissa: tuple[str, FloatArray],
    predictions: RowPredictions,
) -> _View:
    observable = observables(fit)[0]
    y = observed_values(fit)[: len(abscissa[1])]
    bands = finite_quantiles(predictions.with_effects(observable, column), LEVELS)
    (x_unit, x_name), (y_unit, y_name) = axis_name(abscissa[0]), axis_name(observable)
    x_scale, y_scale = scale_for(x_unit, abscissa[1]), scale_for(y_unit, bands[2], y)
    of_row = levels_of_rows(fit, column)
    typical = _typical(fit, problem)
    effects = {}
    if column in group_columns(fit):
        names, draws = effect_draws(fit, column)
        middle = np.median(draws, axis=0)
        shown = (
            [f"× {np.exp(m):.2f}" for m in middle]
            if predictions.logarithmic[observable]
            else [f"{m:+.2g}" for m in middle]
        )
        effects = dict(zip(names, shown, strict=True))
    return _View(
        _ordered(of_row, abscissa[1]), of_row, x_scale.shown(abscissa[1]), y_scale.shown(y), y_scale.shown(bands),
        typical and (x_scale.shown(typical[0]), y_scale.shown(typical[1])), x_scale, y_scale,
        x_scale.label(x_name), y_scale.label(y_name), effects,
    )  # fmt: skip


def _ordered(of_row: NDArray[np.str_], x: FloatArray) -> list[str]:
    """Levels in the order of their median abscissa if they part it, else by name; at most so many as can be drawn."""
    names, counts = np.unique(of_row, return_counts=True)
    kept = [str(names[i]) for i in np.argsort(-counts, kind="stable")[:MOST_PANELS]]
    coordinate = np.log(x) if (x > 0.0).all() else x
    medians = {name: float(np.median(coordinate[of_row == name])) for name in kept}
    parted = np.var([medians[str(name)] for name in of_row if str(name) in medians]) > 0.5 * np.var(
        coordinate
    )
    return sorted(kept, key=lambda name: medians[name]) if parted else sorted(kept)


def _typical(fit: FitResult, problem: Problem) -> tuple[FloatArray, FloatArray] | None:
    """The curve of the posterior median at the row whose conditions are nearest to the middle of all."""
    middle = np.median(fit.theta(), axis=0)
    followed = followed_profile(problem, middle)
    if followed is None:
        return None
    ranks = [np.argsort(np.argsort(values)) for values in problem.conditions.values.values()]
    count = problem.conditions.n_rows
    row = int(np.argmin(sum((np.abs(rank - 0.5 * (count - 1)) for rank in ranks), start=np.zeros(count))))
    grid, curve = curve_at_row(problem, followed[0], middle[np.newaxis], row)
    return grid, curve[0]


def _panel(ax: Axes, view: _View, level: str, longest: int) -> None:
    own = view.of_row == level
    order = np.flatnonzero(own)[np.argsort(view.x[own], kind="stable")]
    x, bands = view.x[order], view.bands[:, order]
    if view.typical is not None:
        ax.plot(*view.typical, color=TYPICAL, linewidth=0.7, label="typical curve")
    ax.plot(
        view.x[~own], view.y[~own], ".", color=OTHERS, markersize=2.6, label="all others", rasterized=True
    )
    if len(order) > 1:
        ax.fill_between(x, bands[0], bands[4], color=POSTERIOR, alpha=0.25, linewidth=0.0, label="5–95 %")
        ax.fill_between(x, bands[1], bands[3], color=POSTERIOR, alpha=0.45, linewidth=0.0, label="25–75 %")
        ax.plot(x, bands[2], color=POSTERIOR, linewidth=1.2)
    else:
        ax.vlines(x, bands[0], bands[4], color=POSTERIOR, alpha=0.35, linewidth=5.0, label="5–95 %")
        ax.vlines(x, bands[1], bands[3], color=POSTERIOR, alpha=0.8, linewidth=5.0, label="25–75 %")
    ax.plot(
        x, view.y[order], "o", color=OBSERVED, markersize=3.6, markeredgecolor="white", markeredgewidth=0.4, label="measured"
    )  # fmt: skip
    effect = f"   {view.effects[level]}" if level in view.effects else ""
    ax.set_title(
        shortened(level, longest) + effect,
        fontsize=9.0 if longest == LONGEST else 7.5,
        loc="left",
        pad=3.0,
        parse_math=False,
    )
    ax.grid()


def _dress(ax: Axes, view: _View) -> None:
    """Limits and ticks, which all panels share."""
    shown = np.concatenate([view.y, view.bands[2]])
    if view.typical is not None:
        x, y = view.typical
        shown = np.concatenate([shown, y[(x >= view.x.min()) & (x <= view.x.max())]])
    for scale, setter, limits, axis, values in (
        (view.x_scale, ax.set_xscale, ax.set_xlim, ax.xaxis, view.x),
        (view.y_scale, ax.set_yscale, ax.set_ylim, ax.yaxis, shown[np.isfinite(shown)]),
    ):
        low, high = float(values.min()), float(values.max())
        if scale.logarithmic:
            setter("log")
            margin = (high / low) ** 0.06
            low, high = low / margin, high * margin
        else:
            margin = 0.06 * (high - low) or 1.0
            low, high = low - margin, high + margin
        limits(low, high)
        ticks(axis, scale, low, high, most=4 if axis is ax.xaxis else 5)
