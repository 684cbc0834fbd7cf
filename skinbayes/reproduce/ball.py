"""The ball and the cylinder that stands for it (Sect. 6.1, Fig. 11)."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import cylinder_of_sphere, line_contact, sphere_contact
from skinbayes.lubrication import lubricated_films, lubricated_point_films
from skinbayes.phrases import number
from skinbayes.reproduce import formulas
from skinbayes.reproduce.choices import HYDRODYNAMIC
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes
from skinbayes.reproduce.words import farthest_from_one


@computes("radius-constant")
def _radius_constant(paper: Paper) -> float:
    return float(_cylinder(paper)[1]) / paper["ball-radius"]


@computes("load-constant")
def _load_constant(paper: Paper) -> float:
    scale = (paper.tissue_modulus * paper["ball-load"] ** 2 / paper["ball-radius"]) ** (1 / 3)
    return _cylinder(paper)[0] / scale


def _cylinder(paper: Paper) -> tuple[float, float]:
    """Load per length, N/m, and radius, m, of the cylinder that stands for the ball of the experiments in water."""
    load, radius = cylinder_of_sphere(
        paper["ball-load"], paper["ball-radius"], reduced_modulus=paper.tissue_modulus
    )
    return float(load), float(radius)


def smooth_sphere(paper: Paper, products: FloatArray = HYDRODYNAMIC) -> FloatArray:
    """Friction of the smooth sphere of Fig. 11 at speeds times viscosity in N/m."""
    films = lubricated_point_films(
        products,
        normal_force=paper["fig11-load"],
        sphere_radius=paper["fig11-radius"],
        reduced_modulus=paper["fig11-modulus"],
    )
    return films.couette + films.pressure_flow


def _sphere(paper: Paper) -> FloatArray:
    return paper.once("smooth sphere", lambda: smooth_sphere(paper))


def smooth_cylinder(paper: Paper, products: FloatArray = HYDRODYNAMIC) -> FloatArray:
    """Friction of the cylinder that stands for it."""
    load, radius = cylinder_of_sphere(
        paper["fig11-load"], paper["fig11-radius"], reduced_modulus=paper["fig11-modulus"]
    )
    films = lubricated_films(
        products,
        load_per_length=float(load),
        cylinder_radius=float(radius),
        reduced_modulus=paper["fig11-modulus"],
    )
    return films.couette + films.pressure_flow


def _exponent(friction: FloatArray) -> float:
    """Exponent of friction between the ends of the hydrodynamic window."""
    return float(np.log(friction[-1] / friction[0]) / np.log(HYDRODYNAMIC[-1] / HYDRODYNAMIC[0]))


@computes("slope-cylinder")
def _slope_cylinder(paper: Paper) -> Found:
    friction = smooth_cylinder(paper)
    local = np.diff(np.log(friction)) / np.diff(np.log(HYDRODYNAMIC))
    return Found(
        _exponent(friction),
        f"Smooth, from ηv = 0.001 to 0.1 N/m; the local exponent drifts from {number(local[0], 2)} to {number(local[-1], 2)}.",
    )


@computes("slope-sphere")
def _slope_sphere(paper: Paper) -> float:
    return _exponent(_sphere(paper))


@computes("slopes-alike")
def _alike(paper: Paper) -> float:
    return _exponent(_sphere(paper)) / _exponent(smooth_cylinder(paper))


@computes("sphere-like-cylinder")
def _like(paper: Paper) -> Found:
    ratio = _sphere(paper) / smooth_cylinder(paper)
    return Found(
        farthest_from_one(ratio),
        f"{number(ratio[0])} at ηv = 0.001 N/m, {number(ratio[-1])} at 0.1 N/m: the drag around the contact.",
    )


@computes("sphere-pressure")
def _pressure(paper: Paper) -> Found:
    return Found(
        paper.pressure,
        "A misprint: E* for E*². The unit of the printed formula is not that of a pressure.",
        formulas.sphere_pressure(paper["ball-load"], paper.tissue_modulus, paper["ball-radius"]),
    )


@computes("sphere-pressure-corrected")
def _corrected(paper: Paper) -> Found:
    case = paper["ball-load"], paper.tissue_modulus, paper["ball-radius"]
    return Found(paper.pressure, formula=formulas.sphere_pressure_of_appendix(*case))


@computes("sphere-radius")
def _radius(paper: Paper) -> Found:
    contact = sphere_contact(paper["ball-load"], paper["ball-radius"], reduced_modulus=paper.tissue_modulus)
    case = paper["ball-load"], paper.tissue_modulus, paper["ball-radius"]
    return Found(float(contact.contact_radius), formula=formulas.sphere_contact_radius(*case))


@computes("cylinder-pressure")
def _line_pressure(paper: Paper) -> Found:
    load, radius = _cylinder(paper)
    line = line_contact(load, radius, reduced_modulus=paper.tissue_modulus)
    return Found(
        float(line.mean_pressure), formula=formulas.cylinder_pressure(load, paper.tissue_modulus, radius)
    )


@computes("cylinder-width")
def _line_width(paper: Paper) -> Found:
    load, radius = _cylinder(paper)
    line = line_contact(load, radius, reduced_modulus=paper.tissue_modulus)
    return Found(
        2 * float(line.half_width), formula=formulas.cylinder_width(load, paper.tissue_modulus, radius)
    )


@computes("eq-9-radius")
def _eq9_radius(paper: Paper) -> Found:
    return Found(_cylinder(paper)[1], formula=formulas.RADIUS_CONSTANT * paper["ball-radius"])


@computes("eq-9-load")
def _eq9_load(paper: Paper) -> Found:
    scale = (paper.tissue_modulus * paper["ball-load"] ** 2 / paper["ball-radius"]) ** (1 / 3)
    return Found(_cylinder(paper)[0], formula=formulas.LOAD_CONSTANT * scale)


@computes("equal-pressures")
def _equal_pressures(paper: Paper) -> Found:
    load, radius = _cylinder(paper)
    line = line_contact(load, radius, reduced_modulus=paper.tissue_modulus)
    return Found(float(line.mean_pressure), formula=paper.pressure)


@computes("equal-squeeze-out")
def _squeeze(paper: Paper) -> Found:
    load, radius = _cylinder(paper)
    width = 2 * float(line_contact(load, radius, reduced_modulus=paper.tissue_modulus).half_width)
    contact = sphere_contact(paper["ball-load"], paper["ball-radius"], reduced_modulus=paper.tissue_modulus)
    return Found(float(contact.contact_radius), formula=width * np.sqrt(2 / 3))
