"""What contact mechanics asks of a solid: a modulus, and how its surface yields to each wavevector."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any, Protocol

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.roughness._fields import Floats, remembering_numbers, with_axes

_UNITS = {"thickness": "m", "thicknesses": "m", "times": "s"}
"""Of a field, by the last word of its name; the others are moduli."""


class ElasticSolid(Protocol):
    """A half-space that roughness and countersurfaces press into, isotropic in the plane of its surface.

    Solids are frozen dataclasses of numbers in SI that broadcast, such as `LayeredSkin` and `HomogeneousSolid`; all of contact,
    wetting and lubrication takes any of them. Impossible values give nan, see `validate_solid` for a message instead.

    Viscoelastic skin becomes one at the frequency of a contact, see `ViscoelasticSkin.at_frequency`.

    References
    ----------
    Persson, J. Chem. Phys. 115 (2001) 3840, doi 10.1063/1.1388626.
    """

    @property
    def contact_modulus(self) -> FloatArray:
        """Plane-strain modulus E* on the scale of the contact as a whole, that of q → 0, Pa, batch shape."""

    @property
    def surface_modulus(self) -> FloatArray:
        """Plane-strain modulus at q → ∞, which S is relative to, Pa, batch shape; unchecked: an impossible one has S = nan."""

    @property
    def transition_length(self) -> FloatArray:
        """Length d, m, batch shape, about whose inverse S changes; S is 1 where qd is large. inf if S is 1 everywhere."""

    def inverse_response(self, wavevector: FloatArray, axes: int) -> FloatArray:
        """1/S(q), dimensionless, with ``axes`` new last axes for the wavevector (1/m); silences no warnings."""

    def compliance_fall(self, wavevector: FloatArray) -> tuple[FloatArray, FloatArray]:
        """φ = 1/(q E_eff), m/Pa, and ``−dφ/dln q``, batch shape plus the axis of ``wavevector`` (1/m)."""


def validate_solid(solid: Any) -> None:
    """Refuse a solid that cannot exist.

    Evaluation itself never raises: impossible members of a batch give nan. Call this where a person typed the
    numbers.

    Parameters
    ----------
    solid : a solid, moduli in Pa, lengths in m, scalar or batched

    Raises
    ------
    InputError
        if a modulus (Pa), a thickness (m) or a time (s) is not a finite positive number, a Poisson ratio not in (−1,
        0.5], or relaxation times do not rise

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4).

    Examples
    --------
    >>> from skinbayes.contact import HomogeneousSolid
    >>> validate_solid(HomogeneousSolid(young_modulus=-20e3))
    Traceback (most recent call last):
        ...
    skinbayes.errors.InputError: young_modulus is -20000 Pa, but must be a finite number > 0 Pa.
    """
    for name in (entry.name for entry in fields(solid)):
        if is_dataclass(part := getattr(solid, name)):
            try:
                validate_solid(part)
            except InputError as error:
                raise InputError(f"{name}: {error}") from None
            continue
        ratio, unit = name.startswith("poisson_ratio"), _UNITS.get(name.rpartition("_")[2], "Pa")
        for value in np.ravel(getattr(solid, name)).tolist():
            if ratio and not -1 < value <= 0.5:
                raise InputError(f"{name} is {value:g}, but must be larger than -1 and at most 0.5.")
            if not ratio and not (np.isfinite(value) and value > 0):
                raise InputError(f"{name} is {value:g} {unit}, but must be a finite number > 0 {unit}.")
        if name == "relaxation_times" and not np.all(np.diff(getattr(solid, name)) > 0):
            raise InputError(f"{name} is {getattr(solid, name)} s, but must rise from one to the next.")


def reduced_modulus(young_modulus: ArrayLike, poisson_ratio: ArrayLike) -> FloatArray:
    """Plane-strain modulus ``E* = E/(1 − ν²)`` (beside Eq. 4 of the paper).

    Parameters
    ----------
    young_modulus : E, Pa, > 0, any shape
    poisson_ratio : ν, dimensionless, −1 < ν ≤ 0.5, broadcasts

    Returns
    -------
    reduced_modulus : Pa, broadcast shape; nan where an argument is impossible

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 4.2, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> print(f"{reduced_modulus(20e3, 0.5):.1f}")
    26666.7
    """
    modulus, ratio = np.asarray(young_modulus, dtype=np.float64), np.asarray(poisson_ratio, dtype=np.float64)
    with np.errstate(all="ignore"):
        return plane_strain(modulus, ratio)


def plane_strain(modulus: Floats, ratio: Floats) -> FloatArray:
    """`reduced_modulus` of arrays; silences no warnings."""
    return np.where(modulus > 0.0, modulus / _stiffening(ratio), np.nan)[()]


@remembering_numbers
def _stiffening(ratio: FloatArray) -> FloatArray:
    """1 − ν², nan where it is impossible."""
    return np.where((ratio > -1) & (ratio <= 0.5), 1 - ratio * ratio, np.nan)


def surface_response(solid: ElasticSolid, wavevector: ArrayLike) -> FloatArray:
    """Response S(q) of a half-space, relative to one of the material at its surface (Eq. 4 of the paper).

    A normal stress of wavevector q displaces the surface by ``−2 S(q)/(q E0*)`` times its amplitude.
    ``S(0) = E0*/E1*``, ``S(∞) = 1``; S = 1 for a homogeneous solid.

    Parameters
    ----------
    solid : moduli in Pa, thickness in m
    wavevector : q, 1/m, ≥ 0, shape ``(K,)`` or ``(..., K)``, or a scalar

    Returns
    -------
    surface_response : dimensionless, batch shape of ``solid`` plus the axis of ``wavevector``; nan where an argument is
        impossible

    Notes
    -----
    Frictionless contact: the shear stress at the surface is neglected.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4).

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> print(surface_response(wet, [0.0, 1e5, 1e9]).round(6))
    [350.         1.703063   1.      ]
    """
    q = _wavevector(wavevector)
    with np.errstate(all="ignore"):
        return np.asarray(1 / solid.inverse_response(q, min(q.ndim, 1)))[()]


def effective_modulus(solid: ElasticSolid, wavevector: ArrayLike) -> FloatArray:
    """Plane-strain modulus felt by wavevector q, ``E_eff(q) = E0*/S(q)`` (Eqs. 3 and 4 of the paper).

    Parameters
    ----------
    solid : moduli in Pa, thickness in m
    wavevector : q, 1/m, ≥ 0, shape ``(K,)`` or ``(..., K)``, or a scalar

    Returns
    -------
    effective_modulus : Pa, batch shape of ``solid`` plus the axis of ``wavevector``; from E1* at q = 0 to E0*
        at large q; nan where an argument is impossible

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4).

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> print(f"{effective_modulus(wet, 0.0):.1f} {effective_modulus(wet, 1e9):.0f}")
    26666.7 9333333
    """
    q = _wavevector(wavevector)
    axes = min(q.ndim, 1)
    with np.errstate(all="ignore"):
        return np.asarray(with_axes(solid.surface_modulus, axes) * solid.inverse_response(q, axes))[()]


def _wavevector(wavevector: ArrayLike) -> FloatArray:
    """The wavevectors as an array, nan in place of negative ones."""
    q = np.asarray(wavevector, dtype=np.float64)
    return np.where(q < 0, np.nan, q)
