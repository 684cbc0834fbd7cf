"""Elastic response of a stiff layer on a soft half-space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.roughness._fields import Floats, as_field, with_axes

SATURATION = 10.0
"""qd above which S is taken as 1 when stresses are summed over wavevectors; S² − 1 is below 4e-7 there."""

_DEEP = 400.0  # of qd, where e^(−2qd) is 0 in floating point


@dataclass(frozen=True, eq=False, kw_only=True)
class LayeredSkin:
    """Stratum corneum bonded to deeper tissue, a layer on a half-space (Fig. 5 of the paper).

    Both are linear elastic and isotropic.
    All fields broadcast. Impossible values give nan, see `validate_skin` for a message instead.

    Attributes
    ----------
    young_modulus_layer : E0, Pa, > 0
    young_modulus_bulk : E1, Pa, > 0
    poisson_ratio_layer : ν0, dimensionless, −1 < ν0 ≤ 0.5; incompressible if not given
    poisson_ratio_bulk : ν1, dimensionless, −1 < ν1 ≤ 0.5; incompressible if not given
    layer_thickness : d, m, > 0

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4).

    Examples
    --------
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> print(f"{wet.layer_thickness:.0e}")
    2e-05
    """

    young_modulus_layer: Floats
    young_modulus_bulk: Floats
    poisson_ratio_layer: Floats = 0.5
    poisson_ratio_bulk: Floats = 0.5
    layer_thickness: Floats

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            object.__setattr__(self, name, as_field(getattr(self, name)))


def validate_skin(skin: LayeredSkin) -> None:
    """Refuse a skin that cannot exist.

    Evaluation itself never raises: impossible members of a batch give nan. Call this where a person typed the
    numbers.

    Parameters
    ----------
    skin : scalar or batched

    Raises
    ------
    InputError
        if a modulus (Pa) or the thickness (m) is not a finite positive number or a Poisson ratio not in (−1,
        0.5]

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4).

    Examples
    --------
    >>> validate_skin(LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=-20e3, layer_thickness=20e-6))
    Traceback (most recent call last):
        ...
    skinbayes.errors.InputError: young_modulus_bulk is -20000 Pa, but must be a finite number > 0 Pa.
    """
    for name, unit in (("young_modulus_layer", "Pa"), ("young_modulus_bulk", "Pa"), ("layer_thickness", "m")):
        for value in np.ravel(getattr(skin, name)).tolist():
            if not (np.isfinite(value) and value > 0):
                raise InputError(f"{name} is {value:g} {unit}, but must be a finite number > 0 {unit}.")
    for name in ("poisson_ratio_layer", "poisson_ratio_bulk"):
        for value in np.ravel(getattr(skin, name)).tolist():
            if not -1 < value <= 0.5:
                raise InputError(f"{name} is {value:g}, but must be larger than -1 and at most 0.5.")


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
        possible = (modulus > 0) & (ratio > -1) & (ratio <= 0.5)
        return np.where(possible, modulus / (1 - ratio * ratio), np.nan)[()]


class _Contrast(NamedTuple):
    """What Eq. 4 needs of the materials: ``S = (c + mn g(1+e) + 4mxe)/(a + b g + mn g² − 4mx²e)``, g = 1 − e, e = exp(−2x).

    Every term is formed without subtracting nearly equal numbers, which 1 − m, 1 − n and 1 − mn are for a stiff layer.
    """

    at_zero: FloatArray  # c = 1 − mn
    ground: FloatArray  # a = (1 − m)(1 − n)
    linear: FloatArray  # b = (1 − m)n + (1 − n)m
    product: FloatArray  # mn
    four_m: FloatArray  # 4m


def _contrast(skin: LayeredSkin) -> _Contrast:
    nu0, nu1 = skin.poisson_ratio_layer, skin.poisson_ratio_bulk
    stiff, soft = skin.young_modulus_layer, skin.young_modulus_bulk
    possible = (np.minimum(stiff, soft) > 0) & (skin.layer_thickness > 0)
    possible = possible & (np.minimum(nu0, nu1) > -1) & (np.maximum(nu0, nu1) <= 0.5)
    shear_ratio = np.where(possible, stiff / soft * ((1 + nu1) / (1 + nu0)), np.nan)
    four = 4 - 4 * nu0
    one_minus_m = four / (shear_ratio + (3 - 4 * nu0))
    one_minus_n = four / (1 + shear_ratio * (3 - 4 * nu1))
    m, n = 1 - one_minus_m, 1 - one_minus_n
    linear = one_minus_m * n + one_minus_n * m
    return _Contrast(one_minus_m + m * one_minus_n, one_minus_m * one_minus_n, linear, m * n, 4 * m)


def inverse_response(skin: LayeredSkin, wavevector: FloatArray, axes: int) -> FloatArray:
    """1/S(q) with ``axes`` new last axes for the wavevector, see `surface_response`; silences no warnings."""
    at_zero, ground, linear, product, four_m = (with_axes(x, axes) for x in _contrast(skin))
    # beyond _DEEP the half-space is not felt, and inf times 0 has no value
    x = np.minimum(wavevector * with_axes(skin.layer_thickness, axes), _DEEP)
    rise = np.expm1(-2 * x)  # −g
    bending = four_m * (x * (1 + rise))
    part = product * rise
    numerator = at_zero - part * (2 + rise) + bending
    denominator = ground + rise * (part - linear) - bending * x
    return np.asarray(denominator / numerator)


def _wavevector(wavevector: ArrayLike) -> FloatArray:
    """The wavevectors as an array, nan in place of negative ones."""
    q = np.asarray(wavevector, dtype=np.float64)
    return np.where(q < 0, np.nan, q)


def surface_response(skin: LayeredSkin, wavevector: ArrayLike) -> FloatArray:
    """Response S(q) of the layered half-space, relative to one of the layer's material (Eq. 4 of the paper).

    A normal stress of wavevector q displaces the surface by ``−2 S(q)/(q E0*)`` times its amplitude.
    ``S(0) = E0*/E1*``, ``S(∞) = 1``. With x = qd, e = exp(−2x):
    ``S = [1 + 4mxe − mne²] / [1 − (m + n + 4mx²)e + mne²]``.

    Parameters
    ----------
    skin : moduli in Pa, thickness in m
    wavevector : q, 1/m, ≥ 0, shape ``(K,)`` or ``(..., K)``, or a scalar

    Returns
    -------
    surface_response : dimensionless, batch shape of ``skin`` plus the axis of ``wavevector``; nan where an argument is impossible

    Notes
    -----
    Relative error below 2e-11 for 1 ≤ E0/E1 ≤ 1e7 and below 1e-9 down to E0/E1 = 1e-7 (Eq. 4 evaluated as
    printed loses six to eight digits for a stiff layer). Frictionless contact: the shear stress at the
    surface is neglected.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4).

    Examples
    --------
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> print(surface_response(wet, [0.0, 1e5, 1e9]).round(6))
    [350.         1.703063   1.      ]
    """
    q = _wavevector(wavevector)
    with np.errstate(all="ignore"):
        return np.asarray(1 / inverse_response(skin, q, min(q.ndim, 1)))[()]


def effective_modulus(skin: LayeredSkin, wavevector: ArrayLike) -> FloatArray:
    """Plane-strain modulus felt by wavevector q, ``E_eff(q) = E0*/S(q)`` (Eqs. 3 and 4 of the paper).

    Parameters
    ----------
    skin : moduli in Pa, thickness in m
    wavevector : q, 1/m, ≥ 0, shape ``(K,)`` or ``(..., K)``, or a scalar

    Returns
    -------
    effective_modulus : Pa, batch shape of ``skin`` plus the axis of ``wavevector``; from E1* at q = 0 to E0*
        at large q; nan where an argument is impossible

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4).

    Examples
    --------
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> print(f"{effective_modulus(wet, 0.0):.1f} {effective_modulus(wet, 1e9):.0f}")
    26666.7 9333333
    """
    q = _wavevector(wavevector)
    axes = min(q.ndim, 1)
    layer = with_axes(reduced_modulus(skin.young_modulus_layer, skin.poisson_ratio_layer), axes)
    with np.errstate(all="ignore"):
        return np.asarray(layer * inverse_response(skin, q, axes))[()]
