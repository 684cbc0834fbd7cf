"""Shear thinning, flow and friction factors (Appendix C, Figs. 20 and 21)."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from skinbayes.arrays import FloatArray
from skinbayes.lubrication import (
    GapFactors,
    ShearThinning,
    gap_flow_factors,
    tabulated_flow_factors,
    thinned_viscosity,
)
from skinbayes.phrases import number
from skinbayes.reproduce.choices import RISING, SHEAR_RATE
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes
from skinbayes.reproduce.stribeck import features, plain_curve, skin_curve
from skinbayes.reproduce.words import falling, largest_change


def _oils(paper: Paper) -> FloatArray:
    """The viscosities of Fig. 21, Pa s: a decade each."""
    ends = np.log10([paper["thinning-viscosity-least"], paper["thinning-viscosity-most"]]).round()
    return 10.0 ** np.arange(ends[0], ends[1] + 1)


def _thinned(paper: Paper, viscosity: float, rate: float) -> float:
    found = thinned_viscosity(
        viscosity, rate, scale=paper["thinning-scale"], exponent=paper["thinning-exponent"]
    )
    return float(found)


def _critical_rate(paper: Paper, viscosity: float) -> float:
    """Shear rate of half the viscosity, 1/s."""

    def miss(log_rate: float) -> float:
        return _thinned(paper, viscosity, float(np.exp(log_rate))) / viscosity - 0.5

    return float(np.exp(brentq(miss, -20.0, 40.0, xtol=1e-12)))


@computes("critical-shear-rate")
def _rate(paper: Paper) -> float:
    return _critical_rate(paper, paper["flow-viscosity"])


@computes("viscosity-law")
def _law(paper: Paper) -> Found:
    thick, scale, power = paper["flow-viscosity"], paper["thinning-scale"], paper["thinning-exponent"]
    formula = thick / (1 + thick / scale * SHEAR_RATE**power)
    return Found(_thinned(paper, thick, SHEAR_RATE), formula=formula)


@computes("critical-rate-law")
def _rate_law(paper: Paper) -> Found:
    thick = paper["thinning-viscosity-most"]
    formula = (paper["thinning-scale"] / thick) ** (1 / paper["thinning-exponent"])
    return Found(_critical_rate(paper, thick), formula=formula)


def _smooth(paper: Paper) -> GapFactors:
    """Factors of smooth surfaces: one gap everywhere."""
    return gap_flow_factors([paper["rms-height-printed"]], [1.0])


@computes("smooth-pressure-flow")
def _phi_p(paper: Paper) -> Found:
    return Found(_smooth(paper).pressure_flow, formula=1.0)


@computes("smooth-shear-flow")
def _phi_s(paper: Paper) -> Found:
    return Found(_smooth(paper).shear_flow / paper["rms-height-printed"], formula=0.0)


@computes("smooth-shear-stress")
def _phi_f(paper: Paper) -> Found:
    return Found(_smooth(paper).shear_stress, formula=1.0)


@computes("smooth-pressure-stress")
def _phi_fp(paper: Paper) -> Found:
    return Found(_smooth(paper).pressure_stress, formula=1.0)


@computes("thinning-sets-in-earlier")
def _earlier(paper: Paper) -> float:
    return falling(np.array([_critical_rate(paper, float(oil)) for oil in _oils(paper)]))


def thinning_curves(paper: Paper) -> tuple[FloatArray, FloatArray]:
    """The viscosities of Fig. 21, Pa s, and friction of each, a row for each viscosity."""
    law = {"scale": paper["thinning-scale"], "exponent": paper["thinning-exponent"]}
    oils = _oils(paper)

    def curves() -> FloatArray:
        thinning = (ShearThinning(float(oil), **law) for oil in oils)
        return np.array([skin_curve(paper, "line", rheology=one).friction_coefficient for one in thinning])

    return oils, paper.once("thinning oils", curves)


@computes("thinning-matters-little")
def _little(paper: Paper) -> float:
    plain = plain_curve(paper).friction_coefficient
    return largest_change((thinning_curves(paper)[1] / plain).ravel())


def flow_factor_curves(paper: Paper) -> tuple[FloatArray, FloatArray]:
    """Friction with trivial factors, and with those of the gaps (Fig. 20)."""
    full = paper.once(
        "cylinder with flow factors",
        lambda: (
            skin_curve(
                paper, "line", flow_factors=tabulated_flow_factors(paper.surface, paper.wet)
            ).friction_coefficient
        ),
    )
    return plain_curve(paper).friction_coefficient, full


@computes("flow-factors-matter-little")
def _factors(paper: Paper) -> Found:
    trivial, full = flow_factor_curves(paper)
    places = [features(paper.products, friction) for friction in (trivial, full)]
    return Found(
        largest_change(full / trivial),
        f"Half of the plateau is reached at {number(places[1].half / places[0].half, 2)} of the speed, and the smallest friction "
        f"is {number(places[1].least)} in place of {number(places[0].least)}.",
    )


@computes("flow-factors-while-rising")
def _rising(paper: Paper) -> float:
    trivial, full = flow_factor_curves(paper)
    return largest_change((full / trivial)[paper.products >= RISING])
