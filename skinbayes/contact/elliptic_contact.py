"""Hertz contact of a doubly curved body with a flat, and the cylinder that slides like it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import elliprd

from skinbayes.arrays import ArrayLike, FloatArray, floats
from skinbayes.contact.hertz import sphere_contact
from skinbayes.contact.line_contact import EquivalentCylinder, cylinder_of_contact

_ROUNDS, _SLOPES = 60, (1.4, 2.1)  # d ln(R2/R1)/d ln(a/b) is 1.5 for the circle and tends to 2


class HertzEllipse(NamedTuple):
    """Hertz contact of a doubly curved body.

    Attributes
    ----------
    semi_axis_along : half-width in the sliding direction, m
    semi_axis_across : half-width perpendicular to it, m
    mean_pressure : load over contact area, Pa
    maximum_pressure : pressure at the centre, Pa
    effective_radius : r_e of Appendix B, ``2/r_e² = 1/a² + 1/b²``, m
    """

    semi_axis_along: FloatArray
    semi_axis_across: FloatArray
    mean_pressure: FloatArray
    maximum_pressure: FloatArray
    effective_radius: FloatArray


class EllipseFactors(NamedTuple):
    """What an elliptic contact has that a circular one of the same R_e has not (Appendix B of the paper).

    Attributes
    ----------
    radius_ratio : larger over smaller radius of curvature, dimensionless
    size : F1, √(ab) over the radius of the circular contact, dimensionless
    effective_size : G1, r_e over the radius of the circular contact, dimensionless
    cylinder_radius : C_e/C, dimensionless
    cylinder_load : C′_e/C′, dimensionless
    """

    radius_ratio: FloatArray
    size: FloatArray
    effective_size: FloatArray
    cylinder_radius: FloatArray
    cylinder_load: FloatArray


def _moments(flatness: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(K − E)/e² and [(a/b)² E − K]/e² for b/a, with Carlson's R_D: no difference of nearly equal numbers, 0/0 neither."""
    square = np.square(flatness)
    return elliprd(0, square, 1) / 3, elliprd(0, 1, square) / 3


def ellipse_factors(axis_ratio: ArrayLike) -> EllipseFactors:
    """F1, G1 and the cylinder factors C_e/C, C′_e/C′ against a/b (Appendix B, Eq. B1 and Fig. 19 of the paper).

    ``F1³ = (4/(π e²)) (b/a)^(3/2) √{[(a/b)² E(e) − K(e)] [K(e) − E(e)]}``, e² = 1 − b²/a²;
    ``G1 = F1/√m``, ``C_e/C = F1³/√m``, ``C′_e/C′ = 1/(F1 √m)`` with m = (a/b + b/a)/2.

    Parameters
    ----------
    axis_ratio : a/b, dimensionless, > 0, any shape; longer over shorter semi-axis (the inverse gives the same factors)

    Returns
    -------
    factors : `EllipseFactors` of the same shape; all 1 for the circle; nan where a/b is not positive

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Appendix B).
    Johnson, Contact Mechanics (1985), Sect. 4.2, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> factors = ellipse_factors(2.0)
    >>> print(f"{factors.size:.4f} {factors.cylinder_radius:.4f} {factors.cylinder_load:.4f}")
    0.9854 0.8558 0.9077
    """
    ratio = np.asarray(axis_ratio, dtype=np.float64)
    with np.errstate(all="ignore"):
        flatness = np.where(ratio > 0, np.minimum(ratio, 1 / ratio), np.nan)
        short, long = _moments(flatness)
        size = np.cbrt(4 / np.pi * flatness**1.5 * np.sqrt(short * long))
        mean = np.sqrt((flatness + 1 / flatness) / 2)
        factors = long / short, size, size / mean, size**3 / mean, 1 / (size * mean)
        return EllipseFactors(*(np.asarray(factor)[()] for factor in factors))


def elliptic_contact(
    normal_force: ArrayLike,
    radius_along: ArrayLike,
    *,
    radius_across: ArrayLike,
    reduced_modulus: ArrayLike,
) -> HertzEllipse:
    """Smooth elastic contact of a rigid body with two radii of curvature (Appendix B of the paper).

    ``p̄ = (2/3π)(6 F_N E*²/R_e²)^(1/3)/F1²``, ``√(ab) = (3 F_N R_e/(4E*))^(1/3) F1``, R_e = √(R1 R2). The ratio a/b solves
    ``R2/R1 = [(a/b)² E(e) − K(e)]/[K(e) − E(e)]``.

    Parameters
    ----------
    normal_force : F_N, N, ≥ 0, any shape
    radius_along : R1, radius of curvature in the plane of sliding, m, > 0, broadcasts
    radius_across : R2, radius of curvature perpendicular to it, m, > 0, broadcasts
    reduced_modulus : E*, Pa, > 0, broadcasts

    Returns
    -------
    contact : `HertzEllipse` of broadcast shape; nan where an argument is impossible

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 4.2, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> contact = elliptic_contact(0.2, 8e-3, radius_across=16e-3, reduced_modulus=20e3 / 0.75)
    >>> print(f"{contact.semi_axis_along:.4e} m, {contact.semi_axis_across:.4e} m")
    3.1496e-03 m, 4.9947e-03 m
    """
    along, across = floats(radius_along, radius_across)
    with np.errstate(all="ignore"):
        along, across = np.where(along > 0, along, np.nan), np.where(across > 0, across, np.nan)
        circle = sphere_contact(normal_force, np.sqrt(along * across), reduced_modulus=reduced_modulus)
        ratio = _axis_ratio(np.maximum(along, across) / np.minimum(along, across))
        factors = ellipse_factors(ratio)
        mean = circle.mean_pressure / np.square(factors.size)
        size, stretch = circle.contact_radius * factors.size, np.sqrt(ratio)
        longer, shorter = size * stretch, size / stretch
        first = np.where(across >= along, shorter, longer)
        second = np.where(across >= along, longer, shorter)
        effective = circle.contact_radius * factors.effective_size
        return HertzEllipse(*(np.asarray(part)[()] for part in (first, second, mean, 1.5 * mean, effective)))


def _axis_ratio(radius_ratio: FloatArray) -> FloatArray:
    """a/b ≥ 1 for R2/R1 ≥ 1: secant steps for ln(a/b), of which ln(R2/R1) is a nearly straight, rising function."""
    target = np.asarray(np.log(radius_ratio))
    old, new = np.zeros_like(target), target * (2 / 3)
    old_level, new_level = np.zeros_like(target), _log_radius_ratio(new)
    for _ in range(_ROUNDS):
        slope = np.clip(np.nan_to_num((new_level - old_level) / (new - old), nan=1.5), *_SLOPES)
        step = (target - new_level) / slope
        old, old_level, new = new, new_level, new + step
        if not np.any(np.abs(step) > 1e-15 * (1 + np.abs(new))):
            break
        new_level = _log_radius_ratio(new)
    return np.asarray(np.exp(new))


def _log_radius_ratio(log_axis_ratio: FloatArray) -> FloatArray:
    short, long = _moments(np.exp(-log_axis_ratio))
    return np.asarray(np.log(long / short))


def cylinder_of_ellipse(
    normal_force: ArrayLike,
    radius_along: ArrayLike,
    *,
    radius_across: ArrayLike,
    reduced_modulus: ArrayLike,
) -> EquivalentCylinder:
    """Cylinder that slides nearly like a body with two radii of curvature (Eq. B1 of the paper).

    ``Rc = C_e R_e``, ``f_N = C′_e (E* F_N²/R_e)^(1/3)`` from the same two conditions as Eq. 9, with r_e for the radius of
    the disk.

    Parameters
    ----------
    normal_force : F_N, N, > 0, any shape
    radius_along : R1, radius of curvature in the plane of sliding, m, > 0, broadcasts
    radius_across : R2 ≥ R1, radius of curvature perpendicular to it, m, broadcasts
    reduced_modulus : E*, Pa, > 0, broadcasts

    Returns
    -------
    cylinder : `EquivalentCylinder` of broadcast shape; nan where an argument is impossible or R2 < R1

    Notes
    -----
    For sliding along the shorter axis of the contact only: along the longer one fluid leaves sideways and a cylinder
    is no model.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Appendix B).

    Examples
    --------
    >>> cylinder = cylinder_of_ellipse(0.2, 8e-3, radius_across=16e-3, reduced_modulus=20e3 / 0.75)
    >>> print(f"{cylinder.cylinder_radius:.3e} m, {cylinder.load_per_length:.2f} N/m")
    5.970e-03 m, 18.67 N/m
    """
    contact = elliptic_contact(
        normal_force, radius_along, radius_across=radius_across, reduced_modulus=reduced_modulus
    )
    with np.errstate(all="ignore"):
        possible = np.asarray(radius_across) >= np.asarray(radius_along)
        radius = np.where(possible, contact.effective_radius, np.nan)
    return cylinder_of_contact(contact.mean_pressure, radius, reduced_modulus=reduced_modulus)
