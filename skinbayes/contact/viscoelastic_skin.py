"""Skin whose layer and deeper tissue both relax, each in its own time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import ArrayLike, ComplexArray
from skinbayes.contact.constant_loss import ConstantLossMaterial
from skinbayes.contact.layered import LayeredSkin, contrast, inverse_response_of
from skinbayes.contact.viscoelastic import ViscoelasticMaterial
from skinbayes.roughness._fields import Floats, with_axes


@dataclass(frozen=True, eq=False, kw_only=True)
class ViscoelasticSkin:
    """Stratum corneum on deeper tissue (Fig. 5 of the paper), both linear viscoelastic.

    Attributes
    ----------
    layer : material of the layer, moduli in Pa
    bulk : material below it, moduli in Pa
    layer_thickness : d, m, > 0, batch shape

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4).

    Examples
    --------
    >>> from skinbayes.contact import ViscoelasticMaterial, standard_linear_solid
    >>> skin = ViscoelasticSkin(
    ...     layer=ViscoelasticMaterial(equilibrium_modulus=7e6),
    ...     bulk=standard_linear_solid(20e3, 28e3, relaxation_time=0.1),
    ...     layer_thickness=20e-6,
    ... )
    >>> print(skin.at_frequency(1e6).young_modulus_bulk.round(3))
    28000.0
    """

    layer: ViscoelasticMaterial | ConstantLossMaterial
    bulk: ViscoelasticMaterial | ConstantLossMaterial
    layer_thickness: Floats

    def complex_effective_modulus(
        self, wavevector: ArrayLike, *, angular_frequency: ArrayLike
    ) -> ComplexArray:
        """Plane-strain modulus felt by a stress of wavevector q and frequency ω, Eq. 4 with complex moduli.

        A solution for elastic solids holds for the amplitudes of oscillations in viscoelastic ones (correspondence
        principle). At a rigid rough surface that slides at v along x the frequency is ``q_x v``; the roughness of the skin itself
        rests in the skin and is loaded while it passes the contact, at about v/b.

        Parameters
        ----------
        wavevector : q, 1/m, ≥ 0, shape ``(K,)``, or a scalar
        angular_frequency : ω, 1/s (rad/s), shape ``(K,)`` or a scalar

        Returns
        -------
        complex_effective_modulus : Pa, batch shape plus the axis of the two; nan where an argument is impossible

        Examples
        --------
        >>> from skinbayes.contact import ViscoelasticMaterial, standard_linear_solid
        >>> skin = ViscoelasticSkin(
        ...     layer=ViscoelasticMaterial(equilibrium_modulus=7e6),
        ...     bulk=standard_linear_solid(20e3, 28e3, relaxation_time=0.1),
        ...     layer_thickness=20e-6,
        ... )
        >>> print(skin.complex_effective_modulus(np.array([1.0, 1e4]), angular_frequency=10.0).round())
        [32000.+5333.j 44654.+5384.j]
        """
        q, frequency = (np.asarray(x, dtype=np.float64) for x in (wavevector, angular_frequency))
        q, frequency = np.broadcast_arrays(q, frequency)
        axes = min(q.ndim, 1)
        ratios = (with_axes(np.asarray(part.poisson_ratio), axes) for part in (self.layer, self.bulk))
        thickness = with_axes(self.layer_thickness, axes)
        with np.errstate(all="ignore"):
            parts = contrast(
                self.layer.complex_modulus(frequency),
                self.bulk.complex_modulus(frequency),
                **dict(zip(("poisson_ratio_layer", "poisson_ratio_bulk"), ratios, strict=True)),
            )
            x = np.where((q >= 0) & (thickness > 0), q * thickness, np.nan)
            return np.asarray(self.layer.reduced_modulus(frequency) * inverse_response_of(parts, x))[()]

    def at_frequency(self, angular_frequency: ArrayLike) -> LayeredSkin:
        """Elastic skin with the moduli |E(ω)| of layer and tissue, for contact areas, separations and asperity laws.

        The roughness of skin rests in the skin: an asperity is loaded once, while it passes a contact of half-width b at
        the speed v, so that its frequency is v/b whatever its wavevector.

        Parameters
        ----------
        angular_frequency : ω, 1/s (rad/s), batch shape

        Returns
        -------
        skin : `LayeredSkin`, of batch shape

        Notes
        -----
        ``|E_eff|`` of complex moduli is that of the moduli's magnitudes where layer and tissue have the same tan δ; where one
        of them is elastic and the other has tan δ = 0.3, it differs by up to 1 %.

        Examples
        --------
        >>> from skinbayes.contact import ViscoelasticMaterial, constant_loss_solid, effective_modulus
        >>> material = constant_loss_solid(
        ...     20e3, 0.14, angular_frequency=1.0, lowest_frequency=1e-2, highest_frequency=1e4
        ... )
        >>> skin = ViscoelasticSkin(layer=material, bulk=material, layer_thickness=20e-6)
        >>> print(f"{effective_modulus(skin.at_frequency(10.0), 1e5) / effective_modulus(skin.at_frequency(1.0), 1e5):.4f}")
        1.2262
        """
        frequency = np.asarray(angular_frequency, dtype=np.float64)
        # one frequency for a batch of materials, or one for each of them: an axis of one point and then without it
        stiff, soft = (
            np.abs(part.complex_modulus(frequency[..., None]))[..., 0] for part in (self.layer, self.bulk)
        )
        return LayeredSkin(
            young_modulus_layer=stiff,
            young_modulus_bulk=soft,
            poisson_ratio_layer=self.layer.poisson_ratio,
            poisson_ratio_bulk=self.bulk.poisson_ratio,
            layer_thickness=self.layer_thickness,
        )
