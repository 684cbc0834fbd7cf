"""What each candidate row of a design would tell."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.plot.style import BLUE, GREY, SMALL, VERMILLION, inches, look, new_figure, set_title, shortened
from skinbayes.plot.symbols import figure_text
from skinbayes.units import format_quantity
from skinbayes.vocabulary import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.fit.design import Design

MOST_DRAWN = 30
"""Candidates in the figure; of more the best."""


def plot_design(design: Design, width: str | None = None) -> Figure:
    """Draw the expected information of the candidates, the best on top.

    Parameters
    ----------
    design : from :meth:`skinbayes.Fit.design`
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        Dots with one standard error either way; those chosen are numbered in the order of their choice.
    """
    size = inches(width)
    rows = design.order[:MOST_DRAWN]
    names = [shortened(candidate_text(design, row), 40 if size >= SMALL else 24) for row in rows]
    turn = {one.row: place + 1 for place, one in enumerate(design.chosen)}
    places = np.arange(len(rows))
    with look(size):
        figure = new_figure(
            size, 0.22 * len(rows) + 1.25, left=0.3 + 0.072 * max(map(len, names)), right=0.3, bottom=0.55, top=0.5
        )  # fmt: skip
        ax = figure.subplots()
        ax.axvline(0.0, color=GREY, linewidth=0.8)
        for colour, chosen in ((BLUE, False), (VERMILLION, True)):
            here = [i for i in places if (rows[i] in turn) == chosen]
            ax.errorbar(
                [design.information[rows[i]] for i in here], here, xerr=[design.errors[rows[i]] for i in here],
                fmt="o", color=colour, markersize=4.5, elinewidth=1.2,
            )  # fmt: skip
        for i in places:
            if rows[i] in turn and len(turn) > 1:
                ax.annotate(
                    str(turn[rows[i]]), (design.information[rows[i]], i), (0, 5), textcoords="offset points",
                    ha="center", color=VERMILLION, fontsize=8.0,
                )  # fmt: skip
        ax.set_ylim(len(rows) - 0.5, -0.7)
        ax.set_yticks(places, [figure_text(name) for name in names])
        ax.grid(axis="x")
        ax.set_xlabel("expected information, nats")
        set_title(figure, design, "What would tell most?")
    return figure


def candidate_text(design: Design, row: int) -> str:
    """A candidate in words: the columns that tell candidates apart, with their units; its number if none does."""
    parts = []
    for name, values in design.columns.items():
        if len(set(values.tolist())) > 1:
            value = values[row].item()
            known = QUANTITIES.get(name)
            text = (
                value if isinstance(value, str) else format_quantity(value, known.unit if known else "1", 3)
            )
            symbol = known.symbol if known and known.symbol else name
            parts.append(text if isinstance(value, str) else f"{symbol} {text}")
    return ", ".join(parts) or f"row {row + 1}"
