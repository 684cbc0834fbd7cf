"""Elastic response of skin with more than one layer: stratum corneum, dermis, fat and what lies below."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.layers import layered_modulus
from skinbayes.contact.solid import plane_strain
from skinbayes.roughness._fields import Floats, hold_floats, with_axes

_STEP = 1e-30  # of ln q along the imaginary axis: a derivative without a difference


@dataclass(frozen=True, eq=False, kw_only=True)
class StackedSkin:
    """Any number of bonded layers on a half-space, each linear elastic and isotropic: `LayeredSkin` for more than one layer.

    From the surface down along the last axis. Impossible values give nan, see `validate_solid` for a message instead.

    Attributes
    ----------
    young_moduli : E of each layer and, last, of the half-space, Pa, > 0, shape ``(L + 1,)`` or batch shape plus ``(L + 1,)``
    poisson_ratios : ν of each, dimensionless, −1 < ν ≤ 0.5, likewise; incompressible if not given
    thicknesses : d of each but the half-space, m, > 0, shape ``(L,)`` or batch shape plus ``(L,)``

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4, for one layer).

    Examples
    --------
    >>> from skinbayes.contact import effective_modulus
    >>> skin = StackedSkin(young_moduli=[7e6, 80e3, 15e3], thicknesses=[20e-6, 1.2e-3])
    >>> print(effective_modulus(skin, [10.0, 1e4, 1e9]).round())
    [  20000.  120018. 9333333.]
    """

    young_moduli: Floats
    poisson_ratios: Floats = 0.5
    thicknesses: Floats

    def __post_init__(self) -> None:
        hold_floats(self)

    @property
    def contact_modulus(self) -> FloatArray:
        """E* of the half-space below the layers, Pa, batch shape; what a ball feels depends on its contact, see
        `layered_sphere_contact`.
        """
        return plane_strain(self._young[..., -1], self._poisson[..., -1])

    @property
    def surface_modulus(self) -> FloatArray:
        """E0* of the uppermost layer, Pa, batch shape."""
        return np.asarray(self._young[..., 0] / (1 - np.square(self._poisson[..., 0])))

    @property
    def transition_length(self) -> FloatArray:
        """d of the uppermost layer, m, batch shape: below it the others are not felt."""
        return np.asarray(self.thicknesses)[..., 0]

    def inverse_response(self, wavevector: FloatArray, axes: int) -> FloatArray:
        """1/S(q), dimensionless, with ``axes`` new last axes for the wavevector (1/m); silences no warnings."""
        held = np.where(wavevector > 0, wavevector, 1.0)
        relative = self._modulus(held, axes) / with_axes(self.surface_modulus, axes)
        at_zero = with_axes(self.contact_modulus / self.surface_modulus, axes)
        return np.asarray(np.where(wavevector > 0, relative, np.where(wavevector == 0, at_zero, np.nan)))

    def compliance_fall(self, wavevector: FloatArray) -> tuple[FloatArray, FloatArray]:
        """φ = 1/(q E_eff), m/Pa, and ``−dφ/dln q``, batch shape plus the axis of ``wavevector`` (1/m)."""
        compliance = 1 / (wavevector * self._modulus(wavevector * (1 + 1j * _STEP), 1))
        # exp(i step) = 1 + i step, of which the modulus has got its part and q not yet
        return np.asarray(compliance.real), np.asarray(compliance.real - compliance.imag / _STEP)

    def layer_by_layer(self) -> tuple[list[FloatArray], list[FloatArray], list[FloatArray]]:
        """Moduli, Pa, Poisson ratios and thicknesses, m, from the surface down, each of batch shape, nan if impossible."""
        moduli, ratios, thick = (
            [part[..., i] for i in range(part.shape[-1])]
            for part in (self._young, self._poisson, np.asarray(self.thicknesses))
        )
        return moduli, ratios, thick

    @property
    def _young(self) -> FloatArray:
        """Young's moduli, nan in a stack that cannot be."""
        young, thick, ratios = (
            np.asarray(x) for x in (self.young_moduli, self.thicknesses, self.poisson_ratios)
        )
        possible = (
            np.all(young > 0, axis=-1)
            & np.all(thick > 0, axis=-1)
            & np.all(np.atleast_1d((ratios > -1) & (ratios <= 0.5)), axis=-1)
        )
        return np.where(possible[..., None], young, np.nan)

    @property
    def _poisson(self) -> FloatArray:
        return np.broadcast_to(
            self.poisson_ratios,
            np.broadcast_shapes(np.shape(self.poisson_ratios), np.shape(self.young_moduli)),
        )

    def _modulus(self, wavevector: Any, axes: int) -> Any:
        young, ratios, thick = self._young, self._poisson, np.asarray(self.thicknesses)
        found = layered_modulus(
            wavevector,
            moduli=[with_axes(young[..., i], axes) for i in range(young.shape[-1])],
            poisson_ratios=[with_axes(ratios[..., i], axes) for i in range(young.shape[-1])],
            thicknesses=[with_axes(thick[..., i], axes) for i in range(thick.shape[-1])],
        )
        return found if np.ndim(wavevector) or axes else found[..., 0]
