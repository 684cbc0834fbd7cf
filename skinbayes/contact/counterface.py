"""Skin against a counterface that yields as well."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.homogeneous import HomogeneousSolid
from skinbayes.contact.solid import ElasticSolid
from skinbayes.roughness._fields import with_axes


@dataclass(frozen=True, eq=False)
class SolidPair:
    """Two elastic half-spaces in contact as one that is pressed by a rigid surface, ``1/E_eff(q) = 1/E1(q) + 1/E2``.

    Exact for frictionless contact of small slopes: at each wavevector the deflections of the two surfaces under one pressure add
    (Eq. 4 of the paper gives that of skin). Together with the sum of both spectra it is contact of two rough elastic solids.

    Attributes
    ----------
    skin : moduli in Pa, lengths in m
    counterface : of one material; it broadcasts with the skin

    References
    ----------
    Johnson, Contact Mechanics (1985), Sects. 4.2 and 13.1, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> rubber = HomogeneousSolid(young_modulus=2e6)
    >>> pair = SolidPair(rubber, rubber)
    >>> print(f"{pair.contact_modulus / rubber.contact_modulus:.2f}")
    0.50
    """

    skin: ElasticSolid
    counterface: HomogeneousSolid

    @property
    def contact_modulus(self) -> FloatArray:
        """Plane-strain modulus of both at q → 0, Pa, batch shape."""
        return in_series(self.skin.contact_modulus, self.counterface.contact_modulus)

    @property
    def surface_modulus(self) -> FloatArray:
        """Plane-strain modulus of both at q → ∞, Pa, batch shape."""
        return in_series(self.skin.surface_modulus, self.counterface.surface_modulus)

    @property
    def transition_length(self) -> FloatArray:
        """That of the skin, m, batch shape."""
        return np.asarray(self.skin.transition_length)

    def inverse_response(self, wavevector: FloatArray, axes: int) -> FloatArray:
        """1/S(q) relative to both at q → ∞, dimensionless, with ``axes`` new last axes for the wavevector (1/m)."""
        skin, other = (with_axes(1 / one.surface_modulus, axes) for one in (self.skin, self.counterface))
        return np.asarray((skin + other) / (skin / self.skin.inverse_response(wavevector, axes) + other))

    def compliance_fall(self, wavevector: FloatArray) -> tuple[FloatArray, FloatArray]:
        """φ = 1/(q E_eff), m/Pa, and ``−dφ/dln q``, batch shape plus the axis of ``wavevector`` (1/m)."""
        pairs = zip(
            self.skin.compliance_fall(wavevector), self.counterface.compliance_fall(wavevector), strict=True
        )
        compliance, fall = (np.asarray(one + other) for one, other in pairs)
        return compliance, fall


def in_series(first: FloatArray, second: FloatArray) -> FloatArray:
    """Modulus of two solids one behind the other, ``1/(1/E1 + 1/E2)``, Pa."""
    return np.asarray(1 / (1 / first + 1 / second))[()]
