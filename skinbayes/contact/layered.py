"""Elastic response of a stiff layer on a soft half-space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.solid import plane_strain
from skinbayes.roughness._fields import Floats, hold_floats, remembering_numbers, with_axes

_DEEP = 400.0  # of qd, where e^(−2qd) is 0 in floating point


@dataclass(frozen=True, eq=False, kw_only=True)
class LayeredSkin:
    """Stratum corneum bonded to deeper tissue, a layer on a half-space (Fig. 5 of the paper).

    Both are linear elastic and isotropic.
    All fields broadcast. Impossible values give nan, see `validate_solid` for a message instead.

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
        hold_floats(self)

    @property
    def contact_modulus(self) -> FloatArray:
        """E1*, Pa, batch shape: the layer is far thinner than a contact is wide."""
        return plane_strain(self.young_modulus_bulk, self.poisson_ratio_bulk)

    @property
    def surface_modulus(self) -> FloatArray:
        """E0*, Pa, batch shape."""
        return np.asarray(self.young_modulus_layer / (1 - np.square(self.poisson_ratio_layer)))

    @property
    def transition_length(self) -> FloatArray:
        """d, m, batch shape."""
        return np.asarray(self.layer_thickness)

    def inverse_response(self, wavevector: FloatArray, axes: int) -> FloatArray:
        """1/S(q), dimensionless, with ``axes`` new last axes for the wavevector (1/m); silences no warnings.

        With x = qd, e = exp(−2x): ``S = [1 + 4mxe − mne²] / [1 − (m + n + 4mx²)e + mne²]``. Relative error below 2e-11 for
        1 ≤ E0/E1 ≤ 1e7 and below 1e-9 down to E0/E1 = 1e-7 (Eq. 4 evaluated as printed loses six to eight digits for a stiff
        layer).
        """
        parts = Contrast(*(with_axes(x, axes) for x in _contrast(self)))
        return inverse_response_of(parts, wavevector * with_axes(self.layer_thickness, axes))

    def compliance_fall(self, wavevector: FloatArray) -> tuple[FloatArray, FloatArray]:
        """φ = 1/(q E_eff), m/Pa, and ``−dφ/dln q``, batch shape plus the axis of ``wavevector`` (1/m)."""
        at_zero, ground, linear, product, four_m = (with_axes(x, 1) for x in _contrast(self))
        x = wavevector * with_axes(self.layer_thickness, 1)
        rise = np.expm1(-2 * x)
        decay = 1 + rise
        bending = four_m * (x * decay)
        numerator = at_zero - product * (rise * (2 + rise)) + bending
        denominator = ground + rise * (product * rise - linear) - bending * x
        numerator_slope = x * decay * (4 * product * decay + four_m * (1 - 2 * x))
        denominator_slope = 2 * x * decay * (linear - 2 * product * rise - four_m * (x * (1 - x)))
        stiffening = denominator_slope / denominator - numerator_slope / numerator  # dln E_eff/dln q
        compliance = numerator / (wavevector * with_axes(self.surface_modulus, 1) * denominator)
        return np.asarray(compliance), np.asarray(compliance * (1 + stiffening))


class _Poisson(NamedTuple):
    """What Eq. 4 needs of the Poisson ratios alone."""

    shear: FloatArray  # (1 + ν1)/(1 + ν0), from a ratio of Young's moduli to one of shear moduli; nan if impossible
    layer: FloatArray  # f = 4(1 − ν0)
    square: FloatArray  # f²
    bulk: FloatArray  # 3 − 4ν1
    both: FloatArray  # 4(1 − ν1)


@remembering_numbers
def _poisson(nu0: FloatArray, nu1: FloatArray) -> _Poisson:
    possible = (np.minimum(nu0, nu1) > -1) & (np.maximum(nu0, nu1) <= 0.5)
    with np.errstate(all="ignore"):
        shear = np.where(possible, (1 + nu1) / (1 + nu0), np.nan)
    layer = 4 - 4 * nu0
    return _Poisson(shear, layer, layer * layer, 3 - 4 * nu1, 4 - 4 * nu1)


class Contrast(NamedTuple):
    """What Eq. 4 needs of the materials: ``S = (c + mn g(1+e) + 4mxe)/(a + b g + mn g² − 4mx²e)``, g = 1 − e, e = exp(−2x).

    All are multiplied by the denominators of m = M/(r + 3 − 4ν0) and n = N/R with the ratio r of the shear moduli,
    M = r − 1, R = 1 + (3 − 4ν1) r, N = R − f and R + M = 4(1 − ν1) r. Every term is formed without subtracting nearly equal
    numbers, which 1 − m, 1 − n and 1 − mn are for a stiff layer.
    """

    at_zero: FloatArray  # 1 − mn: f(R + M)
    ground: FloatArray  # (1 − m)(1 − n): f²
    linear: FloatArray  # (1 − m)n + (1 − n)m: f(R + M − f)
    product: FloatArray  # mn: MN
    four_m: FloatArray  # 4m: 4MR


def inverse_response_of(parts: Contrast, x: FloatArray) -> FloatArray:
    """1/S at x = qd, dimensionless, complex where the contrast is; shapes broadcast."""
    at_zero, ground, linear, product, four_m = parts
    # beyond _DEEP the half-space is not felt, and inf times 0 has no value
    x = np.minimum(x, _DEEP)
    rise = np.expm1(-2.0 * x)  # −g
    bending = four_m * (x * (1.0 + rise))
    part = product * rise
    numerator = at_zero - part * (2.0 + rise) + bending
    denominator = ground + rise * (part - linear) - bending * x
    return np.asarray(denominator / numerator)


def contrast(
    stiff: Any,
    soft: Any,
    *,
    poisson_ratio_layer: FloatArray,
    poisson_ratio_bulk: FloatArray,
) -> Contrast:
    """What Eq. 4 needs of Young's moduli (Pa, also complex) and Poisson ratios of layer and bulk; shapes broadcast."""
    shear, layer, square, bulk, both = _poisson(poisson_ratio_layer, poisson_ratio_bulk)
    ratio = stiff / soft * shear
    m, wide, total = ratio - 1.0, 1.0 + bulk * ratio, both * ratio
    return Contrast(layer * total, square, layer * (total - layer), m * (wide - layer), 4.0 * m * wide)


def _contrast(skin: LayeredSkin) -> Contrast:
    stiff, soft = skin.young_modulus_layer, skin.young_modulus_bulk
    smallest = np.minimum(np.minimum(stiff, soft), skin.layer_thickness)
    return contrast(
        np.where(smallest > 0.0, stiff, np.nan),
        np.asarray(soft),
        poisson_ratio_layer=np.asarray(skin.poisson_ratio_layer),
        poisson_ratio_bulk=np.asarray(skin.poisson_ratio_bulk),
    )
