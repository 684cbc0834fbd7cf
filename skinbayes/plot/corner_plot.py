"""Posterior of each parameter and of each pair of parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.plot.numbers import interval, quantity
from skinbayes.plot.scales import Scale, plain_number, round_values, scale_for
from skinbayes.plot.style import POSTERIOR, look, new_figure, sentence_figure, set_title
from skinbayes.plot.symbols import figure_symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from skinbayes.arrays import FloatArray
    from skinbayes.fit import Fit

TITLE = "Posterior of parameters and pairs"

DRAWS = 8000
"""Draws that contours and histograms are made of; the quantiles in the titles are those of all draws."""

LARGEST = 15.0
"""Largest width and height, inch."""


def plot_corner(fit: Fit) -> Figure:
    """Draw the posterior of each free parameter and of each pair, positive ones on logarithmic axes.

    Parameters
    ----------
    fit : any fit

    Returns
    -------
    matplotlib.figure.Figure
        Each panel on the diagonal names a parameter, its median, and its 5 % and 95 % quantiles, the same as in
        :meth:`Fit.summary`. Parameters that do not vary are left out and named below the title.
    """
    import corner

    labels = [label for label in fit.names if _varies(fit.draws(label))]
    constant = [fit.symbol(label) for label in fit.names if label not in labels]
    if not labels:
        return sentence_figure(fit, TITLE, "No parameter varies: there is nothing to draw.")
    scales = [scale_for(fit.unit(label), fit.draws(label)) for label in labels]
    columns = []
    for label, scale in zip(labels, scales, strict=True):
        shown = scale.shown(fit.draws(label))
        columns.append(np.log10(shown) if scale.logarithmic else shown)
    draws = np.stack(columns, axis=-1)
    draws = draws[:: max(1, len(draws) // DRAWS)]
    count = len(labels)
    ranges = [_range(column) for column in draws.T]
    size = 4.0 if count == 1 else min(LARGEST, 1.2 + 1.25 * count)
    font = 9.0 if count <= 8 else max(6.0, 72.0 * size / count / 12.0)
    with look():
        figure = new_figure(size, size)
        axes = figure.subplots(count, count, squeeze=False)
        corner.corner(
            draws, fig=figure, bins=30, range=ranges, color=POSTERIOR, smooth=1.0, smooth1d=1.0, max_n_ticks=3,
            quantiles=[0.05, 0.5, 0.95], levels=(0.5, 0.9), plot_datapoints=False, fill_contours=True,
            hist_kwargs={"linewidth": 1.4},
        )  # fmt: skip
        for row in range(count):
            for column in range(row + 1):
                _dress(axes[row, column], row, column, count, scales, ranges, font)
            text = _panel_title(fit, labels[row])
            axes[row, row].set_title(text, fontsize=font, loc="left", linespacing=1.25)
        for i, label in enumerate(labels):
            axes[count - 1, i].set_xlabel(scales[i].label(figure_symbol(fit, label)), fontsize=font)
            if i > 0:
                axes[i, 0].set_ylabel(scales[i].label(figure_symbol(fit, label)), fontsize=font)
        figure.align_labels()
        figure.subplots_adjust(
            left=0.9 / size,
            right=1.0 - 0.15 / size,
            bottom=0.85 / size,
            top=1.0 - 1.15 / size,
            wspace=0.09,
            hspace=0.09,
        )
        set_title(figure, fit, TITLE)
        notes = ["dashed: 5 %, 50 % and 95 %"] + (
            ["contours: 50 % and 90 % of the probability"] if count > 1 else []
        )
        if constant:
            notes.append(f"constant, not drawn: {', '.join(constant)}")
        figure.text(
            1.0 - 0.15 / size, 1.0 - 0.45 / size, "\n".join(notes),
            ha="right", va="top", fontsize=max(font, 8.0), linespacing=1.4, parse_math=False,
        )  # fmt: skip
    return figure


def _varies(draws: FloatArray) -> bool:
    low, high = np.quantile(draws, [0.001, 0.999])
    return bool(np.isfinite(draws).all() and high - low > 1e-9 * max(abs(low), abs(high)))


def _range(column: FloatArray) -> tuple[float, float]:
    low, high = np.quantile(column, [0.001, 0.999])
    margin = 0.03 * (high - low)
    return float(low - margin), float(high + margin)


def _panel_title(fit: Fit, label: str) -> str:
    q05, median, q95 = (float(q) for q in np.quantile(fit.draws(label), [0.05, 0.5, 0.95]))
    unit = fit.unit(label)
    range_text = interval(q05, q95, unit, typical=median, joint=" – ")
    return f"{figure_symbol(fit, label)}\n{quantity(median, unit)}\n{range_text}"


def _dress(
    ax: Axes,
    row: int,
    column: int,
    count: int,
    scales: list[Scale],
    ranges: list[tuple[float, float]],
    font: float,
) -> None:
    ax.spines[["top", "right"]].set_visible(True)
    ax.tick_params(labelsize=font)
    if row == count - 1:
        _axis(ax.xaxis, scales[column], ranges[column])
        ax.tick_params(axis="x", rotation=45)
    else:
        _axis(ax.xaxis, scales[column], ranges[column])
        ax.tick_params(axis="x", labelbottom=False)
    if row != column:
        _axis(ax.yaxis, scales[row], ranges[row])
        ax.tick_params(axis="y", labelleft=column == 0)


def _axis(axis: Axis, scale: Scale, limits: tuple[float, float]) -> None:
    """Ticks at round numbers; corner sees log10 of what a logarithmic axis shows."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator

    if not scale.logarithmic:
        axis.set_major_locator(MaxNLocator(3))
        axis.set_major_formatter(FuncFormatter(lambda value, _: plain_number(value)))
        return
    values = round_values(10.0 ** limits[0], 10.0 ** limits[1], most=3)
    axis.set_major_locator(FixedLocator([float(np.log10(v)) for v in values]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: plain_number(float(f"{10.0**value:.3g}"))))
