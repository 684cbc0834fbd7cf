"""One look for all figures: colours that colour-blind readers can tell apart, text that a phone can show."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.fit import Fit

BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, VERMILLION, PURPLE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7",
)  # fmt: skip
"""Palette of Okabe and Ito (2008), https://jfly.uni-koeln.de/color/."""

SERIES = (BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILLION)
"""Colours of curves in order; yellow is left out because it is faint on white."""

PRIOR, POSTERIOR, OBSERVED = "#8A8A8A", BLUE, VERMILLION

WIDTH = 5.2
"""Width of a figure, inch: shown 340 pixels wide on a phone, its text is still about 9 pixels high."""

NOT_CONVERGED = "NOT CONVERGED"

_SETTINGS = {
    "font.family": "DejaVu Sans",  # comes with matplotlib and has the Greek letters
    "font.size": 10.0,
    "axes.titlesize": 10.0,
    "axes.labelsize": 10.0,
    "xtick.labelsize": 9.0,
    "ytick.labelsize": 9.0,
    "legend.fontsize": 9.0,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "lines.linewidth": 1.6,
    "mathtext.default": "regular",
    "figure.facecolor": "white",
    "axes.facecolor": "white",
    "savefig.facecolor": "white",
    "text.color": "#1A1A1A",
    "axes.labelcolor": "#1A1A1A",
    "xtick.color": "#1A1A1A",
    "ytick.color": "#1A1A1A",
}


@contextmanager
def look() -> Iterator[None]:
    """Settings of all figures while one is drawn; those of the user come back afterwards."""
    import matplotlib

    with matplotlib.rc_context(_SETTINGS):
        yield


def new_figure(width: float = WIDTH, height: float = 3.2, layout: str | None = "constrained") -> Figure:
    """A figure without a window (it can be saved anywhere, and pyplot never hears of it); size in inch."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout=layout)
    FigureCanvasAgg(figure)
    return figure


def set_title(figure: Figure, fit: Fit, text: str, **place: float) -> None:
    """Write the title; a fit that has not converged is named so, in another colour and weight."""
    title = text if fit.converged else f"{NOT_CONVERGED} – {text}"
    figure.suptitle(
        title,
        fontsize=11.0,
        color="#1A1A1A" if fit.converged else "#B03A00",
        fontweight="normal" if fit.converged else "bold",
        **place,
    )


def sentence_figure(fit: Fit, title: str, sentence: str) -> Figure:
    """A figure that says in words why there is nothing to draw."""
    from textwrap import fill

    with look():
        figure = new_figure(height=1.4)
        set_title(figure, fit, title)
        figure.text(0.5, 0.4, fill(sentence, 60), ha="center", va="center", parse_math=False)
    return figure
