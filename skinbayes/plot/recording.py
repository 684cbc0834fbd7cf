"""The picture of a recording: both forces, where strokes are, what was taken of them, and what friction came out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.plot.style import BLUE, GREY, SMALL, VERMILLION, inches, look, new_figure
from skinbayes.recordings import FrictionRow, ReducedRecording

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TAKEN, NOT_TAKEN = "#CFE3F2", "#F3C9B5"
"""Colours behind what was taken, and behind strokes that were left out for a fault."""


def plot_recording(one: ReducedRecording, width: str | None = None) -> Figure:
    """Draw a recording with what was taken of it.

    Parameters
    ----------
    one : a reduced recording
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        Tangential force, normal force, and friction coefficient of each row with its 90 % interval, against time.
    """
    size = inches(width)
    with look(size):
        figure = new_figure(
            size,
            4.4 if size >= SMALL else 4.0,
            left=0.95 if size >= SMALL else 0.8,
            right=0.15,
            bottom=0.5,
            top=0.1,
        )
        grid = figure.add_gridspec(3, 1, height_ratios=(1.3, 0.8, 1.3), hspace=0.22)
        force, load, friction = (figure.add_subplot(grid[place]) for place in range(3))
        view = one.preview
        for ax, values, color, label in (
            (force, view.tangential_force, BLUE, "tangential\nforce [N]"),
            (load, view.normal_force, GREY, "normal\nforce [N]"),
        ):
            _marked(ax, one)
            ax.fill_between(
                view.time, values[0], values[1], color=color, linewidth=0.5, edgecolor=color, zorder=2
            )
            ax.set_ylabel(label)
            ax.tick_params(labelbottom=False)
        force.axhline(0.0, color=GREY, linewidth=0.8, linestyle="--", zorder=1)
        low = min(0.0, float(np.nanquantile(view.normal_force[0], 0.01)))
        load.set_ylim(low, 1.15 * float(np.nanmax(view.normal_force[1])))
        _points(friction, one, size)
        for ax in (force, load, friction):
            ax.set_xlim(view.time[0], view.time[-1])
            ax.grid(True, axis="y")
        figure.align_ylabels([force, load, friction])
        return figure


def _marked(ax: Axes, one: ReducedRecording) -> None:
    for row in one.rows:
        if row.by_recipe:
            continue
        begin, end = (row.start, row.stop) if row.left_out else (row.begin, row.end)
        ax.axvspan(
            one.times[begin],
            one.times[end],
            color=NOT_TAKEN if row.left_out else TAKEN,
            linewidth=0,
            zorder=0,
        )


def _points(ax: Axes, one: ReducedRecording, size: float) -> None:
    marker = 4.0 if size >= SMALL else 3.0
    used: list[FrictionRow] = one.used
    for direction, filled, label in ((1, BLUE, "forward"), (-1, "white", "backward")):
        rows = [row for row in used if row.direction == direction]
        if rows:
            ax.errorbar(
                [row.time for row in rows],
                [row.friction_coefficient for row in rows],
                yerr=[1.645 * row.standard_error for row in rows],
                fmt="o", color=BLUE, markerfacecolor=filled, markersize=marker, elinewidth=0.9, label=label, zorder=3,
            )  # fmt: skip
    peaks = [row for row in used if np.isfinite(row.static_friction_coefficient)]
    if peaks:
        ax.plot(
            [one.times[row.begin] for row in peaks],
            [row.static_friction_coefficient for row in peaks],
            "^", color=VERMILLION, markersize=marker, label="static peak", zorder=2,
        )  # fmt: skip
    values = [row.friction_coefficient for row in used] + [row.static_friction_coefficient for row in peaks]
    errors = [1.645 * row.standard_error for row in used]
    span = max(max(values) - min(values), 2 * max(errors), 0.02 * max(values))
    ax.set_ylim(max(0.0, min(values) - max(errors) - 0.15 * span), max(values) + max(errors) + 0.45 * span)
    ax.set_ylabel("friction\ncoefficient")
    ax.set_xlabel("time [s]")
    ax.legend(loc="upper right", ncols=3, handletextpad=0.3, columnspacing=1.0, borderaxespad=0.1)
