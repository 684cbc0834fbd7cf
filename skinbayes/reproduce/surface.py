"""Statements about the rough surface (Sect. 3)."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from skinbayes.phrases import number
from skinbayes.reproduce import formulas
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes
from skinbayes.reproduce.statements import printed_value
from skinbayes.roughness import (
    SelfAffineSpectrum,
    rms_height,
    rms_slope,
    total_area_ratio,
)


@computes("fractal-dimension")
def _dimension(paper: Paper) -> float:
    low, high = float(paper.surface.wavevector_rolloff) * 2, float(paper.surface.wavevector_max) / 2
    ends = np.log(paper.surface.power(np.array([low, high])))
    slope = (ends[1] - ends[0]) / np.log(high / low)
    hurst = -slope / 2 - 1
    return float(3 - hurst)


@computes("rms-height")
def _height(paper: Paper) -> Found:
    return Found(
        float(rms_height(paper.surface)),
        "An input; the plateau up to the roll-off, which is not printed, leaves it as it is.",
    )


@computes("rms-slope-of-four-numbers")
def _printed_slope(paper: Paper) -> Found:
    missing = printed_value("rms-slope-in-use") / float(rms_slope(paper.printed_surface))
    return Found(
        float(rms_slope(paper.printed_surface)),
        f"The four parameters and the slope do not belong together: heights at large wavevectors are {number(missing)} times "
        "too small. See the demonstration.",
    )


@computes("total-area-of-four-numbers")
def _printed_area(paper: Paper) -> Found:
    return Found(
        float(total_area_ratio(rms_slope(paper.printed_surface))),
        "As for the slope: 2.7 belongs to a slope of 2.8, not to the four parameters.",
    )


@computes("rms-slope-in-use")
def _slope(paper: Paper) -> Found:
    return Found(
        float(rms_slope(paper.surface)),
        f"Of paper_reference, whose plateau up to q_r = {number(float(paper.surface.wavevector_rolloff), 4)} 1/m was chosen "
        "so that it has this slope: a repair, no test.",
    )


@computes("total-area-in-use")
def _area(paper: Paper) -> float:
    return float(total_area_ratio(printed_value("rms-slope-in-use")))


@computes("eq-1")
def _normalised(paper: Paper) -> Found:
    mean_square = formulas.mean_square_height(paper.surface)
    return Found(mean_square / float(rms_height(paper.surface)) ** 2, formula=1.0)


def rolloff_of_slope(paper: Paper) -> float:
    """Wavevector up to which a plateau must reach for the printed height to have the printed slope, 1/m."""

    def miss(log_q: float) -> float:
        return float(rms_slope(with_other(paper, wavevector_rolloff=np.exp(log_q)))) - printed_value(
            "rms-slope-in-use"
        )

    return float(np.exp(brentq(miss, np.log(1.001 * paper["wavevector-min"]), np.log(1e5))))


def height_of_slope(paper: Paper) -> float:
    """Height, m, that has the printed slope without a plateau."""
    slope = float(rms_slope(paper.printed_surface))
    return paper["rms-height-printed"] * printed_value("rms-slope-in-use") / slope


def smallest_wavevector_of_slope(paper: Paper) -> float:
    """Smallest wavevector, 1/m, at which the printed height has the printed slope without a plateau."""

    def miss(log_q: float) -> float:
        q = float(np.exp(log_q))
        surface = with_other(paper, wavevector_min=q, wavevector_rolloff=q)
        return float(rms_slope(surface)) - printed_value("rms-slope-in-use")

    return float(np.exp(brentq(miss, np.log(1.001 * paper["wavevector-min"]), np.log(1e5))))


def with_other(paper: Paper, **other: float) -> SelfAffineSpectrum:
    """The surface of the four printed parameters with others in place of some, SI."""
    printed = {
        name: float(getattr(paper.printed_surface, name))
        for name in ("rms_height", "hurst_exponent", "wavevector_min", "wavevector_rolloff", "wavevector_max")
    }
    return SelfAffineSpectrum(**(printed | {name: float(value) for name, value in other.items()}))
