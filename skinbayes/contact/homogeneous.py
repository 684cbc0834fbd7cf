"""A solid of one material all the way down."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.solid import plane_strain
from skinbayes.roughness._fields import Floats, hold_floats, with_axes


@dataclass(frozen=True, eq=False, kw_only=True)
class HomogeneousSolid:
    """Elastomer, gel or phantom: a linear elastic, isotropic half-space, S = 1 at every wavevector.

    All fields broadcast. Impossible values give nan, see `validate_solid` for a message instead.

    Attributes
    ----------
    young_modulus : E, Pa, > 0
    poisson_ratio : ν, dimensionless, −1 < ν ≤ 0.5; incompressible if not given

    References
    ----------
    Persson, J. Chem. Phys. 115 (2001) 3840, doi 10.1063/1.1388626.

    Examples
    --------
    >>> rubber = HomogeneousSolid(young_modulus=2e6)
    >>> print(f"{rubber.contact_modulus:.4g}")
    2.667e+06
    """

    young_modulus: Floats
    poisson_ratio: Floats = 0.5

    def __post_init__(self) -> None:
        hold_floats(self)

    @property
    def contact_modulus(self) -> FloatArray:
        """E*, Pa, batch shape."""
        return plane_strain(self.young_modulus, self.poisson_ratio)

    surface_modulus = contact_modulus

    @property
    def transition_length(self) -> FloatArray:
        """There is none: inf, m."""
        return np.asarray(np.inf)

    def inverse_response(self, wavevector: FloatArray, axes: int) -> FloatArray:
        """1/S(q) = 1, dimensionless, with ``axes`` new last axes for the wavevector (1/m)."""
        return np.where(np.isnan(with_axes(self.contact_modulus, axes)) | np.isnan(wavevector), np.nan, 1.0)

    def compliance_fall(self, wavevector: FloatArray) -> tuple[FloatArray, FloatArray]:
        """φ = 1/(q E*), m/Pa, and ``−dφ/dln q``, which is φ, batch shape plus the axis of ``wavevector`` (1/m)."""
        compliance = np.asarray(1 / (wavevector * with_axes(self.contact_modulus, 1)))
        return compliance, compliance
