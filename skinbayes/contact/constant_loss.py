"""A material of constant loss angle by its equation, a power of the frequency: no band, no sum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import ArrayLike, ComplexArray, FloatArray
from skinbayes.contact.solid import plane_strain
from skinbayes.roughness._fields import Floats, hold_floats, with_axes


@dataclass(frozen=True, eq=False, kw_only=True)
class ConstantLossMaterial:
    """Linear viscoelastic, isotropic material of constant tan δ (spring-pot): ``E(ω) = |E| (iω/ω_r)^n``, ``tan δ = tan(nπ/2)``.

    The same as `constant_loss_solid` within its band. It neither comes to rest nor has an instantaneous modulus. Impossible
    values give nan.

    Attributes
    ----------
    modulus : |E| at the reference frequency, Young's modulus, Pa, > 0, batch shape
    tan_delta : tan δ, dimensionless, 0 ≤ tan δ < 1, batch shape; elastic at 0
    reference_frequency : ω_r, 1/s (rad/s), > 0, batch shape
    poisson_ratio : ν, dimensionless, −1 < ν ≤ 0.5; incompressible if not given

    References
    ----------
    Mainardi, Fractional Calculus and Waves in Linear Viscoelasticity (2010), Chap. 3, doi 10.1142/p614.

    Examples
    --------
    >>> tissue = ConstantLossMaterial(modulus=20e3, tan_delta=0.158, reference_frequency=1.0)
    >>> print(tissue.power.round(4), np.abs(tissue.complex_modulus([1.0, 10.0])).round())
    0.0998 [20000. 25165.]
    """

    modulus: Floats
    tan_delta: Floats
    reference_frequency: Floats
    poisson_ratio: Floats = 0.5

    def __post_init__(self) -> None:
        hold_floats(self)

    @property
    def power(self) -> FloatArray:
        """n, dimensionless, batch shape."""
        tangent = np.asarray(self.tan_delta)
        return np.asarray(np.where((tangent >= 0) & (tangent < 1), 2 / np.pi * np.arctan(tangent), np.nan))[
            ()
        ]

    def complex_modulus(self, angular_frequency: ArrayLike) -> ComplexArray:
        """Storage modulus E′ and loss modulus E″ as E′ + iE″.

        Parameters
        ----------
        angular_frequency : ω, 1/s (rad/s), ≥ 0, shape ``(K,)`` or batch shape plus ``(K,)``, or a scalar

        Returns
        -------
        complex_modulus : Pa, batch shape plus the axis of ``angular_frequency``; nan where an argument is impossible

        Examples
        --------
        >>> tissue = ConstantLossMaterial(modulus=20e3, tan_delta=0.158, reference_frequency=1.0)
        >>> print(f"{tissue.complex_modulus(1.0):.0f}")
        19755+3121j
        """
        frequency = np.asarray(angular_frequency, dtype=np.float64)
        axes = min(frequency.ndim, 1)
        modulus, reference, power = (
            with_axes(np.where(np.asarray(part) > 0, part, np.nan) if held else part, axes)
            for part, held in ((self.modulus, True), (self.reference_frequency, True), (self.power, False))
        )
        with np.errstate(all="ignore"):
            size = modulus * np.where(frequency >= 0, frequency / reference, np.nan) ** power
            return np.asarray(size * np.exp(0.5j * np.pi * power))[()]

    def loss_tangent(self, angular_frequency: ArrayLike) -> FloatArray:
        """tan δ, dimensionless, the same at all ω, 1/s; shapes as in `complex_modulus`."""
        modulus = self.complex_modulus(angular_frequency)
        return np.asarray(modulus.imag / modulus.real)[()]

    def reduced_modulus(self, angular_frequency: ArrayLike) -> ComplexArray:
        """Plane-strain modulus ``E(ω)/(1 − ν²)``, Pa, at ω, 1/s; shapes as in `complex_modulus`."""
        axes = min(np.ndim(angular_frequency), 1)
        with np.errstate(all="ignore"):
            factor = with_axes(plane_strain(1.0, self.poisson_ratio), axes)
        return np.asarray(factor * self.complex_modulus(angular_frequency))[()]
