"""Hertz contact of a cylinder with a flat, and the cylinder that slides like a sphere."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray, floats
from skinbayes.contact.hertz import sphere_contact

SQUEEZE_OUT_RATIO = np.sqrt(3 / 8)
"""Half-width of a strip over the radius of a disk, dimensionless, that squeezes out fluid in the same time (r0 = w √(2/3))."""


class HertzLine(NamedTuple):
    """Hertz contact of a cylinder.

    Attributes
    ----------
    half_width : b, m
    mean_pressure : load over contact area, Pa
    maximum_pressure : p_H, pressure on the central line, Pa
    """

    half_width: FloatArray
    mean_pressure: FloatArray
    maximum_pressure: FloatArray


class EquivalentCylinder(NamedTuple):
    """A cylinder that stands for a sphere or an ellipsoid.

    Attributes
    ----------
    load_per_length : f_N, N/m
    cylinder_radius : Rc, m
    """

    load_per_length: FloatArray
    cylinder_radius: FloatArray


def line_contact(
    load_per_length: ArrayLike, cylinder_radius: ArrayLike, *, reduced_modulus: ArrayLike
) -> HertzLine:
    """Smooth elastic contact of a rigid cylinder with a half-space (second line above Eq. 9 of the paper).

    ``b² = 4 f_N Rc/(π E*)``, ``p_H = E* b/(2 Rc)``, mean pressure f_N/(2b) = (π/4) p_H.

    Parameters
    ----------
    load_per_length : f_N, N/m, ≥ 0, any shape
    cylinder_radius : Rc, m, > 0, broadcasts
    reduced_modulus : E*, Pa, > 0, broadcasts

    Returns
    -------
    contact : `HertzLine` of broadcast shape; nan where an argument is impossible

    Notes
    -----
    Valid for b much smaller than Rc: at b/Rc = 0.48, the case of the paper, the circle is already 7 % deeper at the edge of
    the contact than its parabola.

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 4.2, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> contact = line_contact(21.92, 4.533e-3, reduced_modulus=20e3 / 0.75)
    >>> print(f"{contact.half_width:.3e} m, {contact.maximum_pressure:.0f} Pa")
    2.178e-03 m, 6407 Pa
    """
    load, radius, modulus = floats(load_per_length, cylinder_radius, reduced_modulus)
    with np.errstate(all="ignore"):
        load = np.where((load >= 0) & (radius > 0) & (modulus > 0), load, np.nan)
        half_width = np.sqrt(4 * load * radius / (np.pi * modulus))
        peak = modulus * half_width / (2 * radius)
        return HertzLine(half_width[()], (np.pi / 4 * peak)[()], peak[()])


def cylinder_of_sphere(
    normal_force: ArrayLike, sphere_radius: ArrayLike, *, reduced_modulus: ArrayLike
) -> EquivalentCylinder:
    """Cylinder that slides on a lubricated elastic solid nearly like a sphere does (Eq. 9 of the paper).

    It has the mean Hertz pressure of the sphere, and a strip of its contact width squeezes out fluid in the same
    time as the circular contact: ``r0 = w √(2/3)`` with w = 2b. Hence ``Rc = C R`` and ``f_N = C′ (E* F_N²/R)^(1/3)``,
    C = (π²/32)(3/2)^(3/2) = 0.5666 and C′ = 6^(1/6)/π = 0.4291, which the code leaves to the two conditions.

    Parameters
    ----------
    normal_force : F_N, N, > 0, any shape
    sphere_radius : R, m, > 0, broadcasts
    reduced_modulus : E*, Pa, > 0, broadcasts

    Returns
    -------
    cylinder : `EquivalentCylinder` of broadcast shape; nan where an argument is impossible

    Notes
    -----
    The mean pressure of the sphere contains E*², see `skinbayes.contact.sphere_contact`.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6.1).

    Examples
    --------
    >>> cylinder = cylinder_of_sphere(0.2, 8e-3, reduced_modulus=20e3 / 0.75)
    >>> print(f"{cylinder.cylinder_radius:.3e} m, {cylinder.load_per_length:.2f} N/m")
    4.533e-03 m, 21.92 N/m
    """
    sphere = sphere_contact(normal_force, sphere_radius, reduced_modulus=reduced_modulus)
    return cylinder_of_contact(sphere.mean_pressure, sphere.contact_radius, reduced_modulus=reduced_modulus)


def cylinder_of_contact(
    mean_pressure: ArrayLike, effective_contact_radius: ArrayLike, *, reduced_modulus: ArrayLike
) -> EquivalentCylinder:
    """Cylinder with a given mean Hertz pressure whose strip squeezes out fluid like a disk (conditions of Eq. 9).

    ``b = r √(3/8)``, ``Rc = E* b/(2 p_H)`` with p_H = 4p̄/π, ``f_N = 2b p̄``.

    Parameters
    ----------
    mean_pressure : p̄, Pa, > 0, any shape
    effective_contact_radius : r, m, > 0, broadcasts; r0 of a sphere, r_e of an ellipse
    reduced_modulus : E*, Pa, > 0, broadcasts

    Returns
    -------
    cylinder : `EquivalentCylinder` of broadcast shape; nan where an argument is impossible

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6.1, Appendix B).

    Examples
    --------
    >>> cylinder = cylinder_of_contact(5031.9, 3.5569e-3, reduced_modulus=20e3 / 0.75)
    >>> print(f"{cylinder.cylinder_radius:.3e} m, {cylinder.load_per_length:.2f} N/m")
    4.533e-03 m, 21.92 N/m
    """
    radius, pressure, modulus = floats(effective_contact_radius, mean_pressure, reduced_modulus)
    with np.errstate(all="ignore"):
        radius = np.where((radius > 0) & (pressure > 0) & (modulus > 0), radius, np.nan)
        half_width = radius * SQUEEZE_OUT_RATIO
        cylinder_radius = modulus * half_width / (2 * (4 / np.pi) * pressure)
        return EquivalentCylinder((2 * half_width * pressure)[()], cylinder_radius[()])
