"""Figures of a page: image data, alternative text and a caption that says how to read them."""

from __future__ import annotations

import io
from base64 import b64encode
from dataclasses import dataclass
from typing import TYPE_CHECKING

from skinbayes.plot import plot_corner, plot_predictive, plot_prior_posterior, plot_profile, plot_trace
from skinbayes.plot.style import look

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure

    from skinbayes.fit import Fit

DENSITY = 220
"""Dots per inch of ordinary figures: more than two image pixels for each pixel of the page."""

MOST_PIXELS = 1800
"""Width beyond which large figures are drawn with fewer dots per inch."""


@dataclass(frozen=True)
class Picture:
    """One figure of a page.

    Attributes
    ----------
    key : identifier on the page
    heading, alternative, caption : texts
    data : PNG as base64
    width, height : of the image, pixels
    large : True if it must not be shrunk to the width of a phone
    """

    key: str
    heading: str
    alternative: str
    caption: str
    data: str
    width: int
    height: int
    large: bool


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
    width, height = figure.get_size_inches()
    dots = min(DENSITY, int(MOST_PIXELS / width))
    buffer = io.BytesIO()
    with look():
        figure.savefig(buffer, format="png", dpi=dots)
    if not fit.converged:
        alternative = f"NOT CONVERGED. {alternative}"
    return Picture(
        key=key,
        heading=heading,
        alternative=alternative,
        caption=caption,
        data=b64encode(_with_palette(buffer)).decode("ascii"),
        width=int(width * dots),
        height=int(height * dots),
        large=float(width) > 6.5,
    )


def _with_palette(buffer: io.BytesIO) -> bytes:
    """The same image with 256 colours, a third of the size."""
    from PIL import Image

    small = io.BytesIO()
    with Image.open(buffer) as image:
        image.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(small, format="PNG")
    return small.getvalue()
