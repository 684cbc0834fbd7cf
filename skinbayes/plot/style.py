"""One look for all figures: colours that colour-blind readers can tell apart, text that a phone can show."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from textwrap import fill, wrap
from typing import TYPE_CHECKING, Any, Protocol

from skinbayes.errors import InputError
from skinbayes.plot.symbols import figure_text
from skinbayes.units import parse_quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult

BLACK, ORANGE, SKY, GREEN, YELLOW, BLUE, VERMILLION, PURPLE = (
    "#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7",
)  # fmt: skip
"""Palette of Okabe and Ito (2008), https://jfly.uni-koeln.de/color/."""

SERIES = (BLUE, ORANGE, GREEN, PURPLE, SKY, VERMILLION)
"""Colours of curves in order; yellow is left out because it is faint on white."""

GREY = "#8A8A8A"
"""Of what is compared with, and of zero."""

PRIOR, POSTERIOR, OBSERVED = GREY, BLUE, VERMILLION

WIDTH = 5.2
"""Width of a figure, inch: shown 340 pixels wide on a phone, its text is still about 9 pixels high."""

SMALL = 4.4
"""Figures narrower than this, inch, are for a column of a journal or a phone: smaller text, fewer words."""

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
    "axes.axisbelow": True,
    "grid.color": "#E6E6E6",
    "grid.linewidth": 0.6,
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


_SMALL_SETTINGS: Any = {
    "font.size": 8.0,
    "axes.titlesize": 8.0,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "legend.fontsize": 7.5,
    "legend.handlelength": 1.4,
    "legend.columnspacing": 1.2,
    "lines.linewidth": 1.2,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
}


@contextmanager
def look(width: float = WIDTH) -> Iterator[None]:
    """Settings of all figures while one of a width in inches is drawn; those of the user come back afterwards."""
    import matplotlib

    with matplotlib.rc_context({**_SETTINGS, **(_SMALL_SETTINGS if width < SMALL else {})}):
        yield


def inches(width: str | None, usual: float = WIDTH) -> float:
    """Width of a figure in inches.

    Parameters
    ----------
    width : a length with its unit, such as ``"84 mm"``; None for the usual width
    usual : the usual width, inch

    Raises
    ------
    InputError
        No length, or one that no page has.

    Examples
    --------
    >>> round(inches("84 mm"), 3), inches(None)
    (3.307, 5.2)
    """
    if width is None:
        return usual
    value = parse_quantity(width, "m", where="width")
    if not 0.06 <= value <= 0.6:
        raise InputError(
            f"width: found {width!r}; expected 60 to 600 mm, such as the 84 mm of a column of a journal"
        )
    return value / 0.0254


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


def width_of(ax: Axes) -> float:
    """Width of the figure of a panel, inch."""
    return float(ax.figure.bbox.width / ax.figure.dpi)


def shortened(name: str, longest: int) -> str:
    """A name of at most so many letters."""
    return name if len(name) <= longest else name[: longest - 1] + "…"


def wrapped(ax: Axes, label: str) -> str:
    """The name of a curve in as many lines as the width of the figure asks for."""
    return "\n".join(figure_text(line) for line in wrap(label, letters_of_key(width_of(ax))))


def letters_of_key(width: float) -> int:
    """Letters of one line of a key with one column."""
    return int(12 * width)


class Sampled(Protocol):
    """What has converged or not: a fit, or a comparison of fits."""

    @property
    def converged(self) -> bool:
        """Whether its numbers are final."""


def set_title(figure: Figure, fit: Sampled, text: str) -> None:
    """Write the title as large as fits; a fit that has not converged is named so, in another colour and weight."""
    width, height = figure.get_size_inches()
    title = text if fit.converged else f"{NOT_CONVERGED} – {text}"
    letters = len(re.sub(r"\\mathregular|[${}_]", "", title))
    # a letter is about 0.62 of its size wide, in bold 0.7
    largest = 72.0 * (width - 0.2) / (letters * (0.62 if fit.converged else 0.7))
    figure.suptitle(
        title,
        y=1.0 - 0.1 / height,
        fontsize=min(11.0 if width >= SMALL else 9.0, largest),
        color="#1A1A1A" if fit.converged else "#B03A00",
        fontweight="normal" if fit.converged else "bold",
    )


def key_below(figure: Figure, ax: Axes, columns: int) -> None:
    """The key of a figure at its lower edge."""
    handles, texts = ax.get_legend_handles_labels()
    most = columns if width_of(ax) >= SMALL else min(columns, 2)
    figure.legend(
        handles, texts, loc="lower center", ncols=most, bbox_to_anchor=(0.5, 0.0), borderaxespad=0.2
    )


GONE = "The model or its data are gone, so that nothing can be computed from this result."


def sentence_figure(fit: FitResult, title: str, sentence: str, width: str | None = None) -> Figure:
    """A figure that says in words why there is nothing to draw."""
    size = inches(width)
    with look(size):
        figure = new_figure(size, 1.4)
        set_title(figure, fit, title)
        figure.text(0.5, 0.4, fill(sentence, int(11.5 * size)), ha="center", va="center", parse_math=False)
    return figure
