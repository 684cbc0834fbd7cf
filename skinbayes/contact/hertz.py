"""Hertz contact of a sphere with a flat."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray, floats


class HertzSphere(NamedTuple):
    """Hertz contact of a sphere.

    Attributes
    ----------
    contact_radius : m
    mean_pressure : load over contact area, Pa
    maximum_pressure : pressure at the centre, Pa
    indentation : approach of distant points, m
    """

    contact_radius: FloatArray
    mean_pressure: FloatArray
    maximum_pressure: FloatArray
    indentation: FloatArray


def sphere_contact(
    normal_force: ArrayLike, sphere_radius: ArrayLike, *, reduced_modulus: ArrayLike
) -> HertzSphere:
    """Smooth elastic contact of a rigid sphere with a half-space (above Eq. 9 of the paper).

    ``a³ = 3 F_N R/(4 E*)``, mean pressure ``F_N/(π a²) = (2/3π)(6 F_N E*²/R²)^(1/3)``, maximum 3/2 of it,
    indentation a²/R. (The paper prints E* without the square in the mean pressure.)

    Parameters
    ----------
    normal_force : F_N, N, ≥ 0, any shape
    sphere_radius : R, m, > 0, broadcasts
    reduced_modulus : E*, Pa, > 0, broadcasts; for skin that of the tissue, see
        `skinbayes.contact.reduced_modulus`

    Returns
    -------
    contact : `HertzSphere` of broadcast shape; nan where an argument is impossible

    Notes
    -----
    Valid for a contact radius much smaller than the sphere's; on skin it is often not small, and the layer is
    neglected.

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 4.2, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> contact = sphere_contact(0.5, 8e-3, reduced_modulus=20e3 / 0.75)
    >>> print(f"{contact.contact_radius:.4e} m, {contact.mean_pressure:.1f} Pa")
    4.8274e-03 m, 6829.4 Pa
    """
    force, radius, modulus = floats(normal_force, sphere_radius, reduced_modulus)
    with np.errstate(all="ignore"):
        contact_radius = np.cbrt(0.75 * _possible(force, radius, modulus) * radius / modulus)
        mean = mean_pressure(force, radius, modulus)
        return HertzSphere(
            contact_radius[()], mean[()], (1.5 * mean)[()], (np.square(contact_radius) / radius)[()]
        )


def sphere_of_contact(
    normal_force: ArrayLike, contact_radius: ArrayLike, *, reduced_modulus: ArrayLike
) -> FloatArray:
    """Radius of the sphere whose contact of Hertz has a given radius: `sphere_contact` the other way round.

    ``R = 4 E* a³/(3 F_N)``. Where a soft body of any shape touches a flat in a circle under the pressure of Hertz, the gap
    around the contact is that of this sphere: pressure and modulus determine it.

    Parameters
    ----------
    normal_force : F_N, N, > 0, any shape
    contact_radius : a, m, > 0, broadcasts
    reduced_modulus : E*, Pa, > 0, broadcasts

    Returns
    -------
    sphere_radius : R, m, of broadcast shape; nan where an argument is impossible

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 4.2, doi 10.1017/CBO9781139171731.

    Examples
    --------
    A finger pad of 50 kPa that touches 150 mm² under 1 N:

    >>> import numpy as np
    >>> print(f"{sphere_of_contact(1.0, np.sqrt(150e-6 / np.pi), reduced_modulus=50e3 / 0.75):.4f} m")
    0.0293 m
    """
    force, radius, modulus = floats(normal_force, contact_radius, reduced_modulus)
    with np.errstate(all="ignore"):
        found = 4 / 3 * modulus * radius**3 / _possible(force, radius, modulus)
        return np.asarray(np.where(found < np.inf, found, np.nan))[()]


def sphere_force(
    indentation: ArrayLike, sphere_radius: ArrayLike, *, reduced_modulus: ArrayLike
) -> FloatArray:
    """Load that presses a rigid sphere a given depth into an elastic half-space: `sphere_contact` the other way round.

    ``F_N = (4/3) E* √R δ^(3/2)``

    Parameters
    ----------
    indentation : δ, m, ≥ 0, any shape
    sphere_radius : R, m, > 0, broadcasts
    reduced_modulus : E*, Pa, > 0, broadcasts

    Returns
    -------
    force : F_N, N, of broadcast shape; nan where an argument is impossible

    Notes
    -----
    The sphere is taken as a paraboloid. That makes the force 0.9 % too large at δ = 0.09 R and 2.8 % at δ = 0.27 R, compared
    with the exact sphere.

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 4.2, doi 10.1017/CBO9781139171731. The exact sphere: Sneddon, International Journal
    of Engineering Science 3 (1965) 47, doi 10.1016/0020-7225(65)90019-4.

    Examples
    --------
    >>> print(f"{sphere_force(2.913e-3, 8e-3, reduced_modulus=20e3 / 0.75):.3f} N")
    0.500 N
    """
    depth, radius, modulus = floats(indentation, sphere_radius, reduced_modulus)
    with np.errstate(all="ignore"):
        depth = _possible(depth, radius, modulus)
        return np.asarray(4 / 3 * modulus * np.sqrt(radius) * depth * np.sqrt(depth))[()]


def mean_pressure(force: FloatArray, radius: FloatArray, modulus: FloatArray) -> FloatArray:
    """Mean pressure of `sphere_contact` alone, Pa, for its arguments as arrays; silences no warnings."""
    squared = 6.0 * _possible(force, radius, modulus) * np.square(modulus / radius)
    return np.asarray(2 / (3 * np.pi) * np.cbrt(squared))


def _possible(force: FloatArray, radius: FloatArray, modulus: FloatArray) -> FloatArray:
    """The force (or the depth), nan where any of the three is impossible."""
    return np.where((force >= 0.0) & (np.minimum(radius, modulus) > 0.0), force, np.nan)
