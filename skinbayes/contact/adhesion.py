"""Contact of a ball that sticks: JKR for soft and wide contacts, DMT for hard and small ones, and which of them holds."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, BoolArray, FloatArray, floats


class AdhesiveSphere(NamedTuple):
    """Contact of a sphere that sticks.

    Attributes
    ----------
    contact_radius : m
    carried_force : load that makes the same contact without adhesion, Hertz; what the contact carries beside the tension, N
    indentation : approach of distant points, m
    pull_off_force : force that tears the sphere off, N
    """

    contact_radius: FloatArray
    carried_force: FloatArray
    indentation: FloatArray
    pull_off_force: FloatArray


def jkr_contact(
    normal_force: ArrayLike,
    sphere_radius: ArrayLike,
    *,
    reduced_modulus: ArrayLike,
    work_of_adhesion: ArrayLike,
) -> AdhesiveSphere:
    """Contact of a smooth sphere that sticks wherever it touches, Johnson, Kendall and Roberts.

    ``a³ = 3 R F1/(4 E*)`` with ``F1 = F + 3πwR + √(6πwR F + (3πwR)²)``, indentation ``a²/R − √(2πwa/E*)``, pull-off force
    ``(3/2)πwR``.

    Parameters
    ----------
    normal_force : F, N, any shape; negative for a pull, down to −(3/2)πwR
    sphere_radius : R, m, > 0, broadcasts
    reduced_modulus : E*, Pa, > 0, broadcasts
    work_of_adhesion : w, of the contact as a whole, J/m^2, ≥ 0, broadcasts; 0 is Hertz

    Returns
    -------
    contact : `AdhesiveSphere` of broadcast shape, the stable one under a given load; nan beyond the pull-off force and where
        an argument is impossible

    Notes
    -----
    For a `tabor_parameter` above 5, so for all soft solids of millimetres. w is what the contact as a whole gains per area: rough
    surfaces hold a small part of what smooth ones do. Through stratum corneum it is that of the tissue, as for Hertz. Not in the
    paper, whose Sect. 5 has the pull of water bridges on a contact that keeps its size.

    References
    ----------
    Johnson, Kendall & Roberts, Proc. R. Soc. A 324 (1971) 301, doi 10.1098/rspa.1971.0141.

    Examples
    --------
    A ball of 8 mm on tissue of 20 kPa with 85 mJ/m², under 0.02 N:

    >>> contact = jkr_contact(0.02, 8e-3, reduced_modulus=20e3 / 0.75, work_of_adhesion=0.085)
    >>> print(f"{1e3 * contact.contact_radius:.3f} mm, carries {contact.carried_force:.4f} N")
    2.142 mm, carries 0.0437 N
    """
    force, radius, modulus, work = floats(normal_force, sphere_radius, reduced_modulus, work_of_adhesion)
    with np.errstate(all="ignore"):
        possible = _possible(radius, modulus, work)
        carried = np.where(possible, jkr_carried_force(force, radius, work), np.nan)
        contact = np.cbrt(0.75 * carried * radius / modulus)
        depth = np.square(contact) / radius - np.sqrt(2 * np.pi * work * contact / modulus)
        pull_off = np.where(possible, 1.5 * np.pi * work * radius, np.nan)
        return _shaped(contact, carried, depth, pull_off)


def dmt_contact(
    normal_force: ArrayLike,
    sphere_radius: ArrayLike,
    *,
    reduced_modulus: ArrayLike,
    work_of_adhesion: ArrayLike,
) -> AdhesiveSphere:
    """Contact of a sphere that is attracted from around its contact, Derjaguin, Muller and Toporov.

    Hertz's contact under ``F1 = F + 2πwR``; the pull-off force is 2πwR.

    Parameters
    ----------
    normal_force : F, N, any shape; negative for a pull, down to −2πwR
    sphere_radius : R, m, > 0, broadcasts
    reduced_modulus : E*, Pa, > 0, broadcasts
    work_of_adhesion : w, J/m^2, ≥ 0, broadcasts; 0 is Hertz

    Returns
    -------
    contact : `AdhesiveSphere` of broadcast shape; nan beyond the pull-off force and where an argument is impossible

    Notes
    -----
    For a `tabor_parameter` below 0.1: hard solids and tips of nanometres. No ball on skin is of this kind. Not in the paper,
    whose Sect. 5 has another attraction from around the contact, that of water bridges.

    References
    ----------
    Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975) 314, doi 10.1016/0021-9797(75)90018-1.

    Examples
    --------
    >>> contact = dmt_contact(0.0, 10e-9, reduced_modulus=50e9, work_of_adhesion=0.05)
    >>> print(f"{1e9 * contact.contact_radius:.2f} nm, carries {1e9 * contact.carried_force:.2f} nN")
    0.78 nm, carries 3.14 nN
    """
    force, radius, modulus, work = floats(normal_force, sphere_radius, reduced_modulus, work_of_adhesion)
    with np.errstate(all="ignore"):
        pull_off = np.where(_possible(radius, modulus, work), 2 * np.pi * work * radius, np.nan)
        carried = np.where(force + pull_off >= 0.0, force + pull_off, np.nan)
        contact = np.cbrt(0.75 * carried * radius / modulus)
        return _shaped(contact, carried, np.square(contact) / radius, pull_off)


def tabor_parameter(
    sphere_radius: ArrayLike,
    reduced_modulus: ArrayLike,
    *,
    work_of_adhesion: ArrayLike,
    range_of_attraction: ArrayLike = 0.3e-9,
) -> FloatArray:
    """How far a sphere stretches before it comes off, over the range of the attraction: ``μ_T = (R w²/(E*² z0³))^(1/3)``.

    Parameters
    ----------
    sphere_radius : R, m, > 0, any shape
    reduced_modulus : E*, Pa, > 0, broadcasts
    work_of_adhesion : w, J/m^2, ≥ 0, broadcasts
    range_of_attraction : z0, m, > 0, broadcasts; a few tenths of a nanometre for molecules, the height of the gap for bridges of
        water

    Returns
    -------
    tabor_parameter : μ_T, dimensionless, broadcast shape; nan where an argument is impossible

    Notes
    -----
    Above 5 `jkr_contact` holds, below 0.1 `dmt_contact`; between them neither does. The ball on the skin of Sect. 4 of the
    paper has 1e5.

    References
    ----------
    Greenwood, Proc. R. Soc. A 453 (1997) 1277, doi 10.1098/rspa.1997.0070.

    Examples
    --------
    >>> print(f"{tabor_parameter(8e-3, 20e3 / 0.75, work_of_adhesion=0.085):.1e}")
    1.4e+05
    """
    radius, modulus, work, reach = floats(
        sphere_radius, reduced_modulus, work_of_adhesion, range_of_attraction
    )
    with np.errstate(all="ignore"):
        found = np.cbrt(radius * np.square(work / modulus)) / reach
        possible = _possible(radius, modulus, work) & (reach > 0.0)
        return np.asarray(np.where(possible, found, np.nan))[()]


def jkr_carried_force(force: FloatArray, radius: FloatArray, work: FloatArray) -> FloatArray:
    """F1 of `jkr_contact`, N, of arrays; nan beyond the pull-off force; silences no warnings."""
    third = 3 * np.pi * work * radius
    root = np.sqrt(third * (2 * force + third))
    return np.asarray(np.where(work > 0.0, force + third + root, np.where(force >= 0.0, force, np.nan)))


def _possible(radius: FloatArray, modulus: FloatArray, work: FloatArray) -> BoolArray:
    return np.asarray((np.minimum(radius, modulus) > 0.0) & (work >= 0.0))


def _shaped(*fields: FloatArray) -> AdhesiveSphere:
    return AdhesiveSphere(*(np.asarray(part)[()] for part in np.broadcast_arrays(*fields)))
