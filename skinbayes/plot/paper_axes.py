"""What the figures of the paper have in common: panels, axes, curves that are set apart without colour too."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from skinbayes.plot.style import SMALL, WIDTH, inches, look, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


WET, DRY, OTHER, PRINTED = "#0072B2", "#D55E00", "#009E73", "#1A1A1A"
"""Wet and dry skin as in the paper, a second theory, and what is printed."""

DOTS = (0, (1, 2))

TWO_PANELS = 6.5
"""Width of a figure with two panels, inch."""

DASHES = ("-", "--", "-.", ":")


@dataclass(frozen=True)
class PaperFigure:
    """A figure of the paper, drawn again.

    Attributes
    ----------
    key : name of its file, ``"fig06"``
    draw : makes it of a `Paper`; ``width`` as text, None for that of a screen
    heading : what it shows
    alternative : text for those who cannot see it
    caption : how to read it, what is computed and what is printed
    """

    key: str
    draw: Callable[..., Figure]
    heading: str
    alternative: str
    caption: str


@contextmanager
def panels(
    width: str | None, columns: int = 1, *, height: float = 3.0, key: int = 0, top: float = 0.15
) -> Iterator[tuple[Figure, Sequence[Axes]]]:
    """A figure with panels beside each other, or below where the page is narrow; ``key`` is the lines of a key below."""
    size = inches(width, WIDTH if columns == 1 else TWO_PANELS)
    stacked = columns > 1 and size < SMALL
    grid = (1, columns) if stacked else (columns, 1)
    small = size < SMALL
    with look(size):
        left, bottom, between = (0.66, 0.45, 0.75) if small else (0.8, 0.55, 0.85)
        room = key * (0.19 if small else 0.23) + (0.1 if key else 0.0)
        panel = height * (0.8 if small else 1.0)
        figure = new_figure(
            size, panel * grid[1] + room, left=left, right=0.2, bottom=bottom + room, top=top,
            between=(between, 0.6), panels=grid,
        )  # fmt: skip
        axes = figure.subplots(grid[1], grid[0], squeeze=False).reshape(-1).tolist()
        for ax in axes:
            ax.grid()
        yield figure, axes


def friction_axes(ax: Axes, low: float = 0.05) -> None:
    """Axes of a Stribeck curve; powers of ten alone are labelled."""
    from matplotlib.ticker import NullFormatter

    ax.set(
        xlabel="speed × viscosity ηv [N/m]",
        ylabel="friction coefficient",
        xscale="log",
        yscale="log",
        ylim=(low, 2.5),
    )
    ax.yaxis.set_minor_formatter(NullFormatter())


def key_in(ax: Axes, **where: Any) -> None:
    """The key inside of a panel, on a white ground so that curves below do not disturb it."""
    ax.legend(frameon=True, framealpha=0.9, edgecolor="none", **where)


def printed_line(ax: Axes, value: float, text: str, place: float = 0.02) -> None:
    """A printed number as a thin line with its text above, from a place between 0 and 1 on."""
    ax.axhline(value, color=PRINTED, linewidth=0.8, linestyle=DOTS)
    ax.annotate(text, (place, value), xycoords=("axes fraction", "data"), xytext=(0, 2), textcoords="offset points",
                va="bottom", fontsize="small")  # fmt: skip


def printed_place(ax: Axes, value: float, text: str) -> None:
    """A printed number on the horizontal axis, with its text to the right."""
    ax.axvline(value, color=PRINTED, linewidth=0.8, linestyle=DOTS)
    ax.annotate(text, (value, 0.98), xycoords=("data", "axes fraction"), xytext=(3, 0), textcoords="offset points",
                va="top", fontsize="small")  # fmt: skip


def letters(axes: Sequence[Axes]) -> None:
    """(a), (b) in the upper left corner of each panel."""
    for ax, letter in zip(axes, "abcd", strict=False):
        ax.text(0.03, 0.96, f"({letter})", transform=ax.transAxes, va="top", fontweight="bold")
