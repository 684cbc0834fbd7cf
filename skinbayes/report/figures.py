"""Figures of a page: image data, alternative text and a caption that says how to read them."""

from __future__ import annotations

import io
import re
from base64 import b64encode
from dataclasses import dataclass
from typing import TYPE_CHECKING

from skinbayes.plot import plot_corner, plot_predictive, plot_prior_posterior, plot_profile, plot_trace
from skinbayes.plot.style import look

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

    from skinbayes.fit import Fit

PAGE_DENSITY = 92
"""Pixels of the page for an inch of a large figure, so that its text is as large as that of the others."""

MOST_PIXELS = 1800
"""Width of a large figure, image pixels: two for each pixel of the page, less where it has many panels."""

LARGE = 6.5
"""Width above which a figure is not shrunk to the page but scrolls, inch."""


@dataclass(frozen=True)
class Picture:
    """One figure of a page.

    Attributes
    ----------
    key : identifier on the page
    heading, alternative, caption : texts
    kind : media type of the image: vectors, or pixels if there is much to draw
    data : the image as base64
    width, height : on the page, pixels
    large : True if it must not be shrunk to the width of a phone
    narrowest : width below which a large figure scrolls rather than shrinks, pixels
    """

    key: str
    heading: str
    alternative: str
    caption: str
    kind: str
    data: str
    width: int
    height: int
    large: bool
    narrowest: int


def pictures(fit: Fit) -> dict[str, Picture]:
    """All figures of a page by key."""
    made = [
        _picture(
            "predictive", plot_predictive, fit, "Data against the fitted model",
            "Observed values with the ranges that the fitted model predicts for each row of data.",
            "Dots are the measured values. The bars are what the fitted model would give if the experiment were repeated, "
            "scatter included: dark for the middle half, light for 90 %. A model that fits has about nine dots in ten on its "
            "bars.",
        ),
        _picture(
            "prior-posterior", plot_prior_posterior, fit, "Prior against posterior",
            "Density of each parameter before and after the data.",
            "Dashed grey is what was assumed before the data, blue what is known after them. Where both agree the data said "
            "nothing, and the panel says 'not updated'.",
        ),
        _picture(
            "corner", plot_corner, fit, "Parameters and pairs",
            "Posterior density of each parameter and of each pair of parameters.",
            "Diagonal: each parameter with its median and 90 % interval. Below it: pairs; the inner contour holds half of the "
            "probability, the outer one 90 %. A thin slanted ridge means that only a combination of the two is known.",
        ),
        _picture(
            "trace", plot_trace, fit, "Draws against time",
            "Draws of each parameter in the order in which they were made, one independent ensemble beside the other.",
            "A check of the sampler: all ensembles should fill the same band from beginning to end, without drift or steps. "
            "Dashed lines: 5 %, 50 % and 95 % of all draws.",
        ),
    ]  # fmt: skip
    if fit.problem is not None and fit.problem.forward.profiles:
        made.append(
            _picture(
                "profile", plot_profile, fit, fit.problem.forward.profiles[0].title,
                "Curves of the forward model with their posterior bands.",
                "Zooming in from left to right, ever finer roughness is resolved and less of the nominal area turns out to "
                "touch. Friction is made in what is left at the right edge. Lines are posterior medians, bands hold 90 % of "
                "the probability.",
            )
        )  # fmt: skip
    return {picture.key: picture for picture in made}


def _picture(
    key: str, draw: Callable[[Fit], Figure], fit: Fit, heading: str, alternative: str, caption: str
) -> Picture:
    figure = draw(fit)
    width, height = (float(size) for size in figure.get_size_inches())
    large = width > LARGE
    if not fit.converged:
        alternative = f"NOT CONVERGED. {alternative}"
    return Picture(
        key=key,
        heading=heading,
        alternative=alternative,
        caption=caption,
        kind="image/png" if large else "image/svg+xml",
        data=b64encode(_pixels(figure, width) if large else _vectors(figure)).decode("ascii"),
        width=int(width * PAGE_DENSITY),
        height=int(height * PAGE_DENSITY),
        large=large,
        narrowest=int(0.75 * width * PAGE_DENSITY),
    )


def _pixels(figure: Figure, width: float) -> bytes:
    buffer = io.BytesIO()
    with look():
        figure.savefig(
            buffer,
            format="png",
            dpi=min(2 * PAGE_DENSITY, int(MOST_PIXELS / width)),
            pil_kwargs={"compress_level": 9},
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
