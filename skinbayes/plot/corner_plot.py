"""Posterior of each parameter and of each pair of parameters."""

from __future__ import annotations

import re
from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.plot.numbers import interval, quantity
from skinbayes.plot.scales import Scale, plain_number, round_values, scale_for
from skinbayes.plot.style import POSTERIOR, SMALL, inches, look, new_figure, sentence_figure, set_title
from skinbayes.plot.symbols import figure_symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult

TITLE = "Posterior of parameters and pairs"

BINS = 30

LABEL = 0.55
"""Distance of axis labels from their panels, inch."""

ROOMY = 1.2
"""Width of the figure for each parameter from which on a panel has room for its title, inch."""

DRAWS = 8000
"""Draws that contours and histograms are made of; the quantiles in the titles are those of all draws."""

SMALLEST, LARGEST = 4.8, 15.0
"""Smallest and largest width and height, inch."""


def plot_corner(fit: FitResult, width: str | None = None) -> Figure:
    """Draw the posterior of each free parameter and of each pair, positive ones on logarithmic axes.

    Parameters
    ----------
    fit : any fit
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        Each panel on the diagonal names a parameter, its median, and its 5 % and 95 % quantiles, the same as in
        :meth:`Fit.summary`; where panels are too narrow for that, a list above them does. Parameters that do not vary are left
        out and named below.
    """
    labels = [label for label in fit.shown_names if _varies(fit.draws(label))]
    constant = [fit.symbol(label) for label in fit.shown_names if label not in labels]
    if not labels:
        return sentence_figure(fit, TITLE, "No parameter varies: there is nothing to draw.", width)
    columns = [_column(fit, label) for label in labels]
    count = len(columns)
    size = inches(width, min(LARGEST, max(SMALLEST, 1.5 + 1.25 * count)))
    form = _form(size, columns)
    notes = ["dashed: 5 %, 50 % and 95 %"] + (
        ["contours: 50 % and 90 % of the probability"] if count > 1 else []
    )
    if constant:
        notes.append(fill(f"constant, not drawn: {', '.join(constant)}", int(11 * size)))
    with look(size):
        # a wide figure is as high as wide; in a narrow one the panels are
        tall = size - form.left - 0.15 + form.top + form.bottom if form.listed else size
        figure = new_figure(
            size, tall, left=form.left, right=0.15, bottom=form.bottom, top=form.top, between=(form.gap, form.gap),
            panels=(count, count),
        )  # fmt: skip
        grid = figure.add_gridspec(count, count)
        for i, below in enumerate(columns):
            for j, beside in enumerate(columns[: i + 1]):
                ax = figure.add_subplot(grid[i, j])
                _diagonal(ax, below, form) if i == j else _pair(ax, beside, below)
                _dress(ax, beside, below if i != j else None, form, (i == count - 1, j == 0 and i > 0))
        set_title(figure, fit, TITLE)
        if form.listed:
            figure.text(
                0.5, 1.0 - 0.36 / tall, "\n".join(column.line for column in columns), ha="center", va="top",
                fontsize=7.5, linespacing=1.3,
            )  # fmt: skip
        figure.text(
            0.5, 0.08 / tall, "\n".join(notes), ha="center", va="bottom", fontsize=min(8.0, form.font + 1.0), linespacing=1.4,
            parse_math=False,
        )  # fmt: skip
    return figure


@dataclass(frozen=True)
class _Form:
    """How panels are dressed: by their width, for what does not fit would overlap.

    Attributes
    ----------
    listed : True if medians and intervals stand in a list above the panels, and units only there
    ticked : True if there is room for numbers on the axes
    upright : True if symbols below the panels have to stand on end
    ticks : most numbers on an axis
    font : size of text, point
    left, bottom, top, gap : margins and distance between panels, inch
    label : distance of axis labels from their panels, inch
    """

    listed: bool
    ticked: bool
    upright: bool
    ticks: int
    font: float
    left: float
    bottom: float
    top: float
    gap: float
    label: float


def _form(size: float, columns: list[_Column]) -> _Form:
    count = len(columns)
    if size / count >= ROOMY or (count == 1 and size >= SMALL):
        font = 9.0 if count <= 8 else max(6.0, 72.0 * size / count / 12.0)
        return _Form(False, True, False, 3, font, 0.9, 1.2, 0.95, 0.1, LABEL)
    # letters of the longest line of a symbol, without its markup
    letters = max(
        len(re.sub(r"\\mathregular|[${}_]", "", line)) for c in columns for line in c.symbol.split(" (")
    )
    label = 0.42 if size > 0.9 + 0.3 * count else 0.1
    left = label + 0.1 + 0.062 * letters
    panel = (size - 0.15 - left) / count
    ticked = label > 0.1
    return _Form(
        listed=True, ticked=ticked, upright=panel < 0.8, ticks=3 if panel > 0.7 else 2, font=7.0, left=left,
        bottom=1.1 if ticked else 0.9, top=0.5 + 0.137 * count, gap=0.05, label=label,
    )  # fmt: skip


@dataclass(frozen=True)
class _Column:
    """One parameter: its draws as drawn (log10 where the axis is logarithmic), their range and quantiles, and texts."""

    draws: FloatArray
    scale: Scale
    limits: tuple[float, float]
    quantiles: FloatArray
    axis_label: str
    symbol: str
    title: str
    line: str


def _column(fit: FitResult, label: str) -> _Column:
    scale, draws, unit = scale_for(fit.unit(label), fit.draws(label)), fit.draws(label), fit.unit(label)
    q05, median, q95 = (float(q) for q in fit.quantiles(label))
    symbol = figure_symbol(fit, label)
    range_text = interval(q05, q95, unit, typical=median, joint=" – ")

    def coordinate(values: FloatArray) -> FloatArray:
        shown = scale.shown(values)
        return np.log10(shown) if scale.logarithmic else shown

    drawn = coordinate(draws)
    low, high = (float(q) for q in np.quantile(drawn, [0.001, 0.999]))
    margin = 0.03 * (high - low)
    return _Column(
        draws=drawn[:: max(1, len(drawn) // DRAWS)],
        scale=scale,
        limits=(low - margin, high + margin),
        quantiles=coordinate(np.array([q05, median, q95])),
        axis_label=scale.label(symbol),
        symbol=symbol,
        title=f"{symbol}\n{quantity(median, unit)}\n{range_text}",
        line=f"{symbol}:  {quantity(median, unit)}  (90 %: {range_text})",
    )


def _varies(draws: FloatArray) -> bool:
    low, high = np.quantile(draws, [0.001, 0.999])
    return bool(np.isfinite(draws).all() and high - low > 1e-9 * max(abs(low), abs(high)))


def _diagonal(ax: Axes, column: _Column, form: _Form) -> None:
    from scipy.ndimage import gaussian_filter1d

    heights, edges = np.histogram(column.draws, bins=BINS, range=column.limits)
    ax.stairs(gaussian_filter1d(heights.astype(float), 1.0), edges, color=POSTERIOR, linewidth=1.4)
    for position in column.quantiles:
        ax.axvline(float(position), color=POSTERIOR, linewidth=0.8 if form.listed else 1.2, linestyle="--")
    if not form.listed:
        ax.set_title(column.title, fontsize=form.font, loc="left", linespacing=1.25)
    ax.set_ylim(bottom=0.0)
    ax.set_yticks([])


def _pair(ax: Axes, beside: _Column, below: _Column) -> None:
    import corner

    corner.hist2d(
        beside.draws, below.draws, ax=ax, bins=BINS, range=[beside.limits, below.limits], color=POSTERIOR, smooth=1.0,
        levels=(0.5, 0.9), plot_datapoints=False, plot_density=False, fill_contours=True,
    )  # fmt: skip


def _dress(ax: Axes, beside: _Column, below: _Column | None, form: _Form, outer: tuple[bool, bool]) -> None:
    """Limits, ticks and, at the outer panels, labels."""
    ax.spines[["top", "right"]].set_visible(True)
    ax.tick_params(labelsize=form.font)
    ax.set_xlim(beside.limits)
    _axis(ax.xaxis, beside.scale, beside.limits, form)
    ax.tick_params(axis="x", rotation=90 if form.upright else 45, labelbottom=outer[0] and form.ticked)
    box = ax.get_window_extent().transformed(ax.figure.dpi_scale_trans.inverted())  # inch
    if outer[0]:
        ax.set_xlabel(_label(beside, form), fontsize=form.font, rotation=90 if form.upright else 0)
        ax.xaxis.set_label_coords(0.5, -form.label / box.height)
        ax.xaxis.label.set_verticalalignment("top")
    if below is None:
        return
    ax.set_ylim(below.limits)
    _axis(ax.yaxis, below.scale, below.limits, form)
    ax.tick_params(axis="y", rotation=0 if form.listed else 45, labelleft=outer[1] and form.ticked)
    if outer[1]:
        ax.set_ylabel(_label(below, form), fontsize=form.font, rotation=0 if form.listed else 90)
        ax.yaxis.set_label_coords(-form.label / box.width, 0.5)
        if form.listed:
            ax.yaxis.label.set(ha="right", va="center")


def _label(column: _Column, form: _Form) -> str:
    """Name of an axis; where the list has the units, without the words of a level."""
    return column.symbol.replace(" (", "\n(") if form.listed else column.axis_label


def _axis(axis: Axis, scale: Scale, limits: tuple[float, float], form: _Form) -> None:
    """Ticks at round numbers, apart from each other and from the ends; logarithmic axes hold log10 of what they show."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator

    low, high = limits
    if scale.logarithmic:
        found = [float(np.log10(v)) for v in round_values(10.0**low, 10.0**high, most=form.ticks)]
    else:
        found = [float(v) for v in MaxNLocator(form.ticks).tick_values(low, high)]
    room, kept = (0.3 if form.listed else 0.15) * (high - low), list[float]()
    for position in found:
        clear = low + 0.06 * (high - low) <= position <= high - 0.06 * (high - low)
        if clear and (not kept or position - kept[-1] >= room):
            kept.append(position)
    axis.set_major_locator(FixedLocator(kept))
    axis.set_major_formatter(
        FuncFormatter(lambda v, _: plain_number(float(f"{10.0**v if scale.logarithmic else v:.3g}")))
    )
