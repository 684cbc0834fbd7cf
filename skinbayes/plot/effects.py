"""What is left between data and model: by level of each grouping column, and against the conditions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import observables, observed_values
from skinbayes.plot.rows import (
    RowPredictions,
    effect_draws,
    group_columns,
    levels_of_rows,
    row_predictions,
    telling_columns,
    varying,
    varying_conditions,
)
from skinbayes.plot.scales import axis_scale, plain_number, round_values, scale_for, ticks
from skinbayes.plot.style import (
    GONE,
    OBSERVED,
    POSTERIOR,
    SMALL,
    WIDTH,
    inches,
    key_below,
    look,
    new_figure,
    sentence_figure,
    set_title,
    shortened,
)
from skinbayes.plot.symbols import axis_name, figure_text, spoken_name
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult

MOST_LEVELS = 30
"""Levels drawn in one panel; of more, the lowest and the highest."""

MOST_CONDITIONS = 3

LONGEST, LONGEST_SMALL = 26, 18
"""Letters of the name of a level, in wide and in narrow figures."""


def plot_effects(
    fit: FitResult, predictions: RowPredictions | None = None, width: str | None = None
) -> Figure:
    """Draw the effect of each level of each grouping column, and the residuals of its rows about the model without it.

    Parameters
    ----------
    fit : a fit with its problem
    predictions : from :func:`skinbayes.plot.rows.row_predictions`, to compute them once for several figures
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each column, its levels ordered by effect: bars hold 50 % and 90 % of the posterior of the effect. Dots are
        the rows: observed over predicted (their difference, where the noise is not logarithmic), effects of other columns
        counted as predicted, so that they scatter about the bar of their level. A column without effects has dots only.
        A sentence if there is nothing to draw.
    """
    columns = telling_columns(fit)
    title = "Effects of groups and residuals" if group_columns(fit) else "Residuals by group"
    if fit.problem is None:
        return sentence_figure(fit, title, GONE, width)
    if not columns:
        return sentence_figure(fit, title, "No column groups these data.", width)
    predictions = predictions or row_predictions(fit, fit.problem)
    counts = [min(MOST_LEVELS, len(set(levels_of_rows(fit, column)))) for column in columns]
    above, between, below = 0.7, 0.75, 0.95
    height = above + below + between * (len(columns) - 1) + 0.24 * sum(counts)
    size = inches(width, WIDTH + 1.4)
    letters = LONGEST if size >= SMALL else LONGEST_SMALL
    longest = max(
        len(shortened(level, letters)) for column in columns for level in levels_of_rows(fit, column)
    )
    with look(size):
        figure = new_figure(
            size, height, left=0.3 + (0.078 if size >= SMALL else 0.066) * longest, bottom=below, top=above,
            between=(0.0, between), panels=(1, len(columns)),
        )  # fmt: skip
        grid = figure.add_gridspec(len(columns), 1, height_ratios=counts)
        # the mean height of the panels is what distances are fractions of
        grid.update(hspace=between / (0.24 * float(np.mean(counts))))
        axes: list[Axes] = []
        for i, column in enumerate(columns):
            ax = figure.add_subplot(grid[i], sharex=axes[0] if axes else None)
            axes.append(ax)
            _levels(ax, fit, column, predictions, letters)
        ratio_axis(axes[0].xaxis, axes[0].get_xlim(), predictions.logarithmic[observables(fit)[0]])
        axes[-1].set_xlabel(_residual_name(observables(fit)[0], predictions))
        key_below(figure, axes[0], 3)
        set_title(figure, fit, title)
    return figure


def _levels(ax: Axes, fit: FitResult, column: str, predictions: RowPredictions, letters: int) -> None:
    observable = observables(fit)[0]
    of_row = levels_of_rows(fit, column)
    others = [name for name in group_columns(fit) if name != column]
    residuals = predictions.residuals(observable, observed_values(fit)[: len(of_row)], *others)
    names = list(dict.fromkeys(of_row.tolist()))
    if column in group_columns(fit):
        levels, draws = effect_draws(fit, column)
        quantiles = dict(
            zip(levels, np.quantile(draws, [0.05, 0.25, 0.5, 0.75, 0.95], axis=0).T, strict=True)
        )
        centre = {name: float(quantiles[name][2]) for name in names}
    else:
        quantiles = {}
        centre = {name: float(np.nanmedian(residuals[of_row == name])) for name in names}
    names.sort(key=lambda name: centre[name])
    if len(names) > MOST_LEVELS:
        names = names[: MOST_LEVELS // 2] + names[-MOST_LEVELS // 2 :]
    if quantiles:
        low, q25, middle, q75, high = np.array([quantiles[name] for name in names]).T
        y = np.arange(len(names))
        ax.hlines(y, low, high, color=POSTERIOR, alpha=0.35, linewidth=7.0, label="effect, 5–95 %")
        ax.hlines(y, q25, q75, color=POSTERIOR, alpha=0.9, linewidth=7.0, label="25–75 %")
        ax.plot(middle, y, "|", color="white", markersize=7.0, markeredgewidth=1.4)
    for y_position, name in enumerate(names):
        own = residuals[of_row == name]
        ax.plot(
            own, np.full(len(own), y_position), "o", color=OBSERVED, markersize=3.2, alpha=0.75, markeredgewidth=0.0,
            label="rows" if y_position == 0 else None,
        )  # fmt: skip
    ax.axvline(0.0, color="#1A1A1A", linewidth=0.8, linestyle=(0, (4, 3)))
    ax.set_yticks(np.arange(len(names)), [shortened(name, letters) for name in names], parse_math=False)
    ax.set_ylim(-0.7, len(names) - 0.3)
    ax.set_title(f"by {spoken_name(column)}", loc="left", pad=4.0)
    ax.grid(axis="x")


def plot_residuals(
    fit: FitResult, predictions: RowPredictions | None = None, width: str | None = None
) -> Figure:
    """Draw what is left between data and model, effects of groups taken off, against the abscissa and the conditions.

    Parameters
    ----------
    fit : a fit with its problem
    predictions : from :func:`skinbayes.plot.rows.row_predictions`, to compute them once for several figures
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each of the abscissa of the curve and up to two further conditions that vary between rows (of several
        observables, the abscissa for each): observed over predicted, or their difference, and the median of each sixth of the
        rows. A trend is something that the model misses. A sentence if there is nothing to draw.
    """
    title = "What is left between data and model"
    if fit.problem is None:
        return sentence_figure(fit, title, GONE, width)
    abscissa = varying(fit)
    if abscissa is None:
        return sentence_figure(
            fit,
            title,
            "All rows have the same conditions: there is nothing to draw residuals against.",
            width,
        )
    names = observables(fit)
    predictions = predictions or row_predictions(fit, fit.problem)
    observed = observed_values(fit).reshape(len(names), -1)
    against = dict([abscissa])
    if len(names) == 1:
        against |= {k: v for k, v in varying_conditions(fit.problem).items() if k not in against}
    pairs = [(name, x) for name in names for x in list(against)[:MOST_CONDITIONS]]
    size = inches(width)
    with look(size):
        figure = new_figure(
            size,
            0.55 + 2.15 * len(pairs),
            left=0.85,
            bottom=0.6,
            top=0.5,
            between=(0.0, 0.62),
            panels=(1, len(pairs)),
        )
        axes = figure.subplots(len(pairs), 1, squeeze=False)[:, 0]
        for ax, (name, x) in zip(axes, pairs, strict=True):
            residuals = predictions.residuals(name, observed[names.index(name)], *group_columns(fit))
            _against(ax, against[x], x, residuals)
            ratio_axis(ax.yaxis, ax.get_ylim(), predictions.logarithmic[name])
            ax.set_ylabel(
                _residual_name(name, predictions).replace(" over ", "\nover ").replace(" less ", "\nless ")
            )
        set_title(figure, fit, title)
    return figure


def _against(ax: Axes, values: FloatArray, name: str, residuals: FloatArray) -> None:
    unit, label = axis_name(name)
    scale = axis_scale(name, scale_for(unit, values))
    x = scale.shown(values)
    ax.plot(x, residuals, "o", color=OBSERVED, markersize=3.6, alpha=0.75, markeredgewidth=0.0)
    ax.axhline(0.0, color="#1A1A1A", linewidth=0.8, linestyle=(0, (4, 3)))
    pieces = np.array_split(np.argsort(x, kind="stable"), 6) if len(x) >= 24 else []
    for piece in pieces:
        ends = [float(x[piece].min()), float(x[piece].max())]
        ax.plot(
            ends,
            [float(np.nanmedian(residuals[piece]))] * 2,
            color=POSTERIOR,
            linewidth=2.4,
            solid_capstyle="butt",
        )
    if scale.logarithmic:
        ax.set_xscale("log")
    ticks(ax.xaxis, scale, *ax.get_xlim(), most=5)
    reach = 1.1 * float(np.nanmax(np.abs(residuals))) or 1.0
    ax.set_ylim(-reach, reach)
    ax.set_xlabel(scale.label(label))
    ax.grid()


def _residual_name(name: str, predictions: RowPredictions) -> str:
    known = lookup(name)
    symbol, unit = (figure_text(known.symbol), known.unit) if known else (spoken_name(name), "1")
    if predictions.logarithmic[name]:
        return f"{symbol}, observed over predicted"
    return f"{symbol}, observed less predicted" + ("" if unit == "1" else f" [{unit}]")


def ratio_axis(axis: Axis, limits: tuple[float, float], logarithmic: bool) -> None:
    """Ticks of an axis that holds ln of a ratio: the ratio; a difference has its own numbers."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator

    if not logarithmic:
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
        return
    ends = float(np.exp(limits[0])), float(np.exp(limits[1]))
    if ends[1] / ends[0] > 4.0:
        values = round_values(*ends, most=6)
    else:
        values = [
            v for v in MaxNLocator(6, steps=[1, 2, 2.5, 5, 10]).tick_values(*ends) if ends[0] < v < ends[1]
        ]
    axis.set_major_locator(FixedLocator([float(np.log(value)) for value in values]))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain_number(float(f"{np.exp(value):.3g}"))))
