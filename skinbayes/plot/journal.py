"""Figures as files for print: their exact width, fonts inside, no title but that of a fit that has not converged."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from skinbayes.plot.style import NOT_CONVERGED, look

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = ("pdf", "svg", "png")

DENSITY = 600
"""Pixels of an inch of a PNG, as journals ask for drawings of lines."""

LARGEST = 9.0
"""Largest letters, point: on screens they may be larger."""

EDGE = 0.02
"""White above and below what is drawn, inch."""


def journal_file(figure: Figure, form: str) -> bytes:
    """A figure as the content of a file.

    Journals print captions, not titles: the title is left off, with the room that it took, unless it says that the fit has
    not converged. The width is that of the figure. PDF holds its fonts (TrueType), SVG letters as outlines; neither a date.

    Parameters
    ----------
    figure : any figure of this package; its title is taken off
    form : one of :data:`FORMATS`
    """
    from matplotlib import rc_context
    from matplotlib.text import Text
    from matplotlib.transforms import Bbox

    if not figure.get_suptitle().startswith(NOT_CONVERGED):
        figure.suptitle("")
    width = float(figure.get_size_inches()[0])
    buffer = io.BytesIO()
    with look(width), rc_context({"pdf.fonttype": 42, "svg.fonttype": "path", "svg.hashsalt": "skinbayes"}):
        figure.canvas.draw()
        for text in figure.findobj(Text):
            if float(text.get_fontsize()) > LARGEST:
                text.set_fontsize(LARGEST)
        drawn = figure.get_tightbbox()
        metadata = {
            "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
            "svg": {"Date": None, "Creator": None},
        }
        figure.savefig(
            buffer,
            format=form,
            dpi=DENSITY,
            bbox_inches=Bbox([[0.0, drawn.y0 - EDGE], [width, drawn.y1 + EDGE]]),
            metadata=metadata.get(form),
        )
    return buffer.getvalue()
