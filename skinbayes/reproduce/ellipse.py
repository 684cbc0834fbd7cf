"""The elliptic contact (Appendix B, Fig. 19)."""

from __future__ import annotations

import numpy as np

from skinbayes.contact import HertzEllipse, cylinder_of_ellipse, ellipse_factors, elliptic_contact
from skinbayes.reproduce import formulas
from skinbayes.reproduce.choices import AXIS_RATIO
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes


def _radii(paper: Paper) -> tuple[float, float]:
    """Radii of curvature, m, of the body that makes the ellipse, with the R_e of the ball; along and across sliding."""
    ratio = float(ellipse_factors(AXIS_RATIO).radius_ratio)
    return paper["ball-radius"] / np.sqrt(ratio), paper["ball-radius"] * np.sqrt(ratio)


def _contact(paper: Paper) -> HertzEllipse:
    along, across = _radii(paper)
    return elliptic_contact(
        paper["ball-load"], along, radius_across=across, reduced_modulus=paper.tissue_modulus
    )


def _mean() -> float:
    return (AXIS_RATIO + 1 / AXIS_RATIO) / 2


@computes("elliptic-factor")
def _factor(paper: Paper) -> Found:
    return Found(float(ellipse_factors(AXIS_RATIO).size), formula=formulas.ellipse(AXIS_RATIO)[0])


@computes("elliptic-size-factor")
def _size(paper: Paper) -> Found:
    return Found(float(ellipse_factors(AXIS_RATIO).effective_size), formula=formulas.ellipse(AXIS_RATIO)[1])


@computes("elliptic-pressure")
def _pressure(paper: Paper) -> Found:
    case = paper["ball-load"], paper.tissue_modulus, paper["ball-radius"]
    formula = formulas.sphere_pressure_of_appendix(*case) / formulas.ellipse(AXIS_RATIO)[0] ** 2
    return Found(float(_contact(paper).mean_pressure), formula=formula)


@computes("elliptic-radius")
def _radius(paper: Paper) -> Found:
    case = paper["ball-load"], paper.tissue_modulus, paper["ball-radius"]
    formula = formulas.sphere_contact_radius(*case) * formulas.ellipse(AXIS_RATIO)[1]
    return Found(float(_contact(paper).effective_radius), formula=formula)


@computes("elliptic-radius-of-axes")
def _of_axes(paper: Paper) -> Found:
    contact = _contact(paper)
    axes = np.array([contact.semi_axis_along, contact.semi_axis_across], dtype=float)
    return Found(float(contact.effective_radius), formula=float(np.mean(axes**-2.0) ** -0.5))


@computes("eq-b1-radius")
def _cylinder_radius(paper: Paper) -> Found:
    size = formulas.ellipse(AXIS_RATIO)[0]
    factor = formulas.RADIUS_CONSTANT * size**3 / np.sqrt(_mean())
    return Found(_cylinder(paper)[1], formula=factor * paper["ball-radius"])


@computes("eq-b1-load")
def _cylinder_load(paper: Paper) -> Found:
    size = formulas.ellipse(AXIS_RATIO)[0]
    scale = (paper.tissue_modulus * paper["ball-load"] ** 2 / paper["ball-radius"]) ** (1 / 3)
    return Found(_cylinder(paper)[0], formula=formulas.LOAD_CONSTANT / size / np.sqrt(_mean()) * scale)


def _cylinder(paper: Paper) -> tuple[float, float]:
    along, across = _radii(paper)
    load, radius = cylinder_of_ellipse(
        paper["ball-load"], along, radius_across=across, reduced_modulus=paper.tissue_modulus
    )
    return float(load), float(radius)


@computes("fig-19-radius")
def _fig19_radius(paper: Paper) -> Found:
    size = formulas.ellipse(AXIS_RATIO)[0]
    return Found(float(ellipse_factors(AXIS_RATIO).cylinder_radius), formula=size**3 / np.sqrt(_mean()))


@computes("fig-19-load")
def _fig19_load(paper: Paper) -> Found:
    size = formulas.ellipse(AXIS_RATIO)[0]
    return Found(float(ellipse_factors(AXIS_RATIO).cylinder_load), formula=1 / (size * np.sqrt(_mean())))


@computes("circle-is-circle")
def _circle(paper: Paper) -> Found:
    return Found(float(ellipse_factors(1.0).cylinder_radius), formula=1.0)
