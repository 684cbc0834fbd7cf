"""One look for all figures: colours that colour-blind readers can tell apart, text that a phone can show."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
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

_SETTINGS: Any = {
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


def new_figure(
    width: float = WIDTH,
    height: float = 3.2,
    *,
    left: float = 0.2,
    right: float = 0.2,
    bottom: float = 0.6,
    top: float = 0.4,
    between: tuple[float, float] = (0.2, 0.2),
    panels: tuple[int, int] = (1, 1),
) -> Figure:
    """A figure without a window: it can be saved anywhere, and pyplot never hears of it.

    Parameters
    ----------
    width, height : size, inch
    left, right, bottom, top : margins, inch (given rather than computed: automatic layout takes as long as drawing)
    between : horizontal and vertical distance between panels, inch
    panels : number of columns and rows
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    columns, rows = panels
    panel_width = (width - left - right - between[0] * (columns - 1)) / columns
    panel_height = (height - bottom - top - between[1] * (rows - 1)) / rows
    figure.subplots_adjust(
        left / width, bottom / height, 1.0 - right / width, 1.0 - top / height,
        between[0] / panel_width, between[1] / panel_height,
    )  # fmt: skip
    return figure


def set_title(figure: Figure, fit: Fit, text: str) -> None:
    """Write the title; a fit that has not converged is named so, in another colour and weight."""
    figure.suptitle(
        text if fit.converged else f"{NOT_CONVERGED} – {text}",
        y=1.0 - 0.1 / figure.get_size_inches()[1],
        fontsize=11.0,
        color="#1A1A1A" if fit.converged else "#B03A00",
        fontweight="normal" if fit.converged else "bold",
    )


def key_below(figure: Figure, ax: Axes, columns: int) -> None:
    """The key of a figure at its lower edge."""
    handles, texts = ax.get_legend_handles_labels()
    figure.legend(
        handles, texts, loc="lower center", ncols=columns, bbox_to_anchor=(0.5, 0.0), borderaxespad=0.2
    )


def sentence_figure(fit: Fit, title: str, sentence: str) -> Figure:
    """A figure that says in words why there is nothing to draw."""
    from textwrap import fill

    with look():
        figure = new_figure(height=1.4)
        set_title(figure, fit, title)
        figure.text(0.5, 0.4, fill(sentence, 60), ha="center", va="center", parse_math=False)
    return figure
