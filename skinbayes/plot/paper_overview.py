"""How far each number of the paper is off, at a glance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.plot.style import BLUE, GREY, SMALL, VERMILLION, WIDTH, inches, key_below, look, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.reproduce import Compared

OVERVIEW = {
    "key": "overview",
    "heading": "How far each number is off",
    "alternative": "A row of dots for each subject: most near zero, ten set apart as not agreeing.",
    "caption": "Computed over printed, less 1, of every number; ranges count from their nearer end. The axis is linear "
    "within 1 % and logarithmic beyond. A number that is printed as rough may be off by more and agree.",
}
"""Texts of the figure."""

LINEAR = 1.0
"""Part of the axis that is linear, percent."""


def plot_overview(rows: Sequence[Compared], width: str | None = None) -> Figure:
    """Draw the relative difference of each number, subject by subject.

    Parameters
    ----------
    rows : everything that is compared
    width : as text with its unit; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        A row for each subject
    """
    numbers = [row for row in rows if row.statement.role == "number" and row.relative_difference is not None]
    groups = list(dict.fromkeys(row.statement.group for row in numbers))
    size = inches(width, WIDTH)
    with look(size):
        figure = new_figure(
            size,
            0.32 * len(groups) + 1.4,
            left=1.35 if size < SMALL else 1.75,
            bottom=0.9,
            top=0.15,
            right=0.25,
        )
        ax = figure.subplots()
        places = [groups.index(row.statement.group) for row in numbers]
        off = np.array([100 * (row.relative_difference or 0.0) for row in numbers])
        heights, agrees = np.array(_apart(off.tolist(), places)), np.array([row.agrees for row in numbers])
        for shown, colour, marker, name in (
            (agrees, BLUE, "o", "agrees"),
            (~agrees, VERMILLION, "X", "does not agree"),
        ):
            ax.plot(
                off[shown],
                heights[shown],
                marker,
                color=colour,
                markersize=5.5,
                markeredgewidth=0.0,
                label=name,
            )
        ax.axvline(0.0, color=GREY, linewidth=0.8)
        ax.set_xscale("symlog", linthresh=LINEAR, linscale=0.5)
        ticks = (-100, -10, -1, 0, 1, 10, 100)
        ax.set_xticks(ticks, [f"{tick:+d}".replace("-", "−").replace("+0", "0") for tick in ticks])
        ax.minorticks_off()
        ax.set(xlim=(-130, 130), ylim=(len(groups) - 0.4, -0.6), xlabel="computed against printed [%]")
        ax.set_yticks(range(len(groups)), groups)
        ax.grid(axis="x")
        key_below(figure, ax, 2)
    return figure


def _apart(off: Sequence[float], places: Sequence[int]) -> list[float]:
    """Heights at which dots of one row that lie on each other can be seen."""
    taken: dict[tuple[int, int], int] = {}
    heights = []
    for value, place in zip(off, places, strict=True):
        cell = (place, round(4 * float(np.arcsinh(value))))
        taken[cell] = taken.get(cell, -1) + 1
        step = (taken[cell] + 1) // 2 * (1 if taken[cell] % 2 else -1)
        heights.append(place + 0.14 * max(-3, min(3, step)))
    return heights
