"""Figures of a page: image data, alternative text and a caption that says how to read them."""

from __future__ import annotations

import io
import re
from base64 import b64encode
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from skinbayes.plot.style import look
from skinbayes.report.drawings import Drawing, drawings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.comparison import Comparison
    from skinbayes.fit import Fit

PAGE_DENSITY = 92
"""Pixels of the page for an inch of a figure."""

MOST_PIXELS = 1800
"""Width of an image of pixels: two for each pixel of the page, less where it has many panels."""

LARGE = 6.5
"""Width above which a figure is made of pixels and may be wider than the text, inch."""

MOST_VECTOR_PANELS = 12
"""Figures with more panels are made of pixels."""

MOST_VECTOR_BYTES = 1_000_000
"""So are figures of which vectors would take more: with thousands of rows a page would hold tens of megabytes."""

NARROW = "84 mm"
"""Width of the figures for phones, that of a column of a journal."""


def pictures(fit: Fit) -> dict[str, dict[str, Any]]:
    """All figures of a page by key, in its order: texts of the drawing, images for screens and for phones."""
    return {drawing.key: picture(fit, drawing) for drawing in drawings(fit)}


def picture(fit: Fit | Comparison, drawing: Drawing) -> dict[str, Any]:
    """Texts of a drawing and its images for screens and for phones."""
    return drawn(fit, drawing, "" if fit.converged else "NOT CONVERGED. ")


def drawn(what: Any, drawing: Drawing, warning: str = "") -> dict[str, Any]:
    """The same of anything that a drawing can be made of; ``warning`` stands before its alternative text."""
    texts = vars(drawing) | {"alternative": f"{warning}{drawing.alternative}"}
    return placed(texts, drawing.draw(what, width=None), drawing.draw(what, width=NARROW))


def placed(texts: Mapping[str, Any], wide: Figure, narrow: Figure) -> dict[str, Any]:
    """Key, heading, alternative and caption of a figure with its images for screens and for phones."""
    return {
        **texts,
        "wide": _image(wide),
        "narrow": _image(narrow),
        "large": float(wide.get_size_inches()[0]) > LARGE,  # may be wider than the text
    }


def _image(figure: Figure) -> dict[str, Any]:
    """Media type (vectors, or pixels if there is much to draw), the image as base64, and its size on the page in pixels."""
    width, height = (float(size) for size in figure.get_size_inches())
    vectors = b"" if len(figure.axes) > MOST_VECTOR_PANELS or width > LARGE else _vectors(figure)
    pixels = not 0 < len(vectors) <= MOST_VECTOR_BYTES
    return {
        "kind": "image/png" if pixels else "image/svg+xml",
        "data": b64encode(_pixels(figure, width) if pixels else vectors).decode("ascii"),
        "width": int(width * PAGE_DENSITY),
        "height": int(height * PAGE_DENSITY),
    }


def _pixels(figure: Figure, width: float) -> bytes:
    buffer = io.BytesIO()
    with look():
        figure.savefig(
            buffer,
            format="png",
            dpi=min(3 * PAGE_DENSITY, int(MOST_PIXELS / width)),
            pil_kwargs={"compress_level": 6},  # 9 takes twice the time of everything for 3 % less
        )
    return buffer.getvalue()


def _vectors(figure: Figure) -> bytes:
    """The figure as SVG without date, coordinates to a hundredth of a point."""
    from matplotlib import rc_context

    buffer = io.StringIO()
    with look(), rc_context({"svg.hashsalt": "skinbayes", "svg.fonttype": "path"}):
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    paths = re.compile(r' d="[^"]+"')
    return paths.sub(lambda path: _EXCESS.sub(r"\1", path.group()), buffer.getvalue()).encode()


_EXCESS = re.compile(r"(\.[0-9]{2})[0-9]+")
