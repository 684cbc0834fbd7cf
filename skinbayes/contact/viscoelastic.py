"""Linear viscoelastic materials: one sum of relaxing moduli for modulus, relaxation and creep, in frequency and in time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, ComplexArray, FloatArray
from skinbayes.contact.solid import plane_strain
from skinbayes.roughness._fields import Floats, hold_floats, with_axes

_HALVINGS = 60  # of a bracket of a retardation rate: down to rounding


class Creep(NamedTuple):
    """Creep compliance of a material, ``J(t) = 1/E_g + Σ J_k (1 − exp(−t/θ_k))``.

    Attributes
    ----------
    instantaneous : 1/E_g, 1/Pa, batch shape
    compliance : J_k, 1/Pa, > 0, batch shape plus ``(M,)``
    retardation_time : θ_k, s, rising, batch shape plus ``(M,)``
    """

    instantaneous: FloatArray
    compliance: FloatArray
    retardation_time: FloatArray


@dataclass(frozen=True, eq=False, kw_only=True)
class ViscoelasticMaterial:
    """Linear viscoelastic, isotropic material: a spring beside M Maxwell elements (generalised Maxwell model, Prony series).

    ``E(t) = E∞ + Σ E_k exp(−t/τ_k)``, ``E(ω) = E∞ + Σ E_k iωτ_k/(1 + iωτ_k)``. Such a sum dissipates at every frequency and obeys
    the relations of Kramers and Kronig whatever its numbers. With no elements it is elastic. Other models are sums of this
    kind: `standard_linear_solid`, `constant_loss_solid`, `material_of_dynamic_moduli`.

    Impossible values give nan, see `validate_solid` for a message instead.

    Attributes
    ----------
    equilibrium_modulus : E∞, Young's modulus of infinitely slow deformation, Pa, > 0, batch shape
    relaxing_moduli : E_k, Pa, > 0, shape ``(M,)`` or batch shape plus ``(M,)``; none if not given
    relaxation_times : τ_k, s, > 0, rising, shape ``(M,)`` or batch shape plus ``(M,)``
    poisson_ratio : ν, dimensionless, −1 < ν ≤ 0.5, the same at all frequencies; incompressible if not given

    Notes
    -----
    Skin and elastomers are nearly incompressible at all frequencies of sliding; a Poisson ratio that relaxes is not
    described.

    References
    ----------
    Mainardi, Fractional Calculus and Waves in Linear Viscoelasticity (2010), Chap. 2, doi 10.1142/p614.

    Examples
    --------
    >>> tissue = ViscoelasticMaterial(equilibrium_modulus=20e3, relaxing_moduli=[8e3], relaxation_times=[0.1])
    >>> print(tissue.complex_modulus([0.0, 10.0, 1e6]).round(1))
    [20000.+0.e+00j 24000.+4.e+03j 28000.+1.e-01j]
    """

    equilibrium_modulus: Floats
    relaxing_moduli: ArrayLike = ()
    relaxation_times: ArrayLike = ()
    poisson_ratio: Floats = 0.5

    def __post_init__(self) -> None:
        hold_floats(self)

    @property
    def _elements(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """E∞ with a last axis, E_k and τ_k, all nan where the material is impossible."""
        spring = np.asarray(self.equilibrium_modulus)[..., None]
        moduli, times = np.broadcast_arrays(self.relaxing_moduli, self.relaxation_times)
        ratio = np.asarray(self.poisson_ratio)
        possible = (
            np.isfinite(spring[..., 0])
            & (spring[..., 0] > 0)
            & (ratio > -1)
            & (ratio <= 0.5)
            & np.all(np.isfinite(moduli) & (moduli > 0) & np.isfinite(times) & (times > 0), axis=-1)
            & np.all(np.diff(times) > 0, axis=-1)
        )
        mask = np.where(possible, 1.0, np.nan)[..., None]
        return spring * mask, moduli * mask, times * mask

    @property
    def instantaneous_modulus(self) -> FloatArray:
        """E_g = E∞ + ΣE_k, Young's modulus of infinitely fast deformation (glassy modulus), Pa, batch shape."""
        spring, moduli, _ = self._elements
        return np.asarray(spring[..., 0] + moduli.sum(axis=-1))[()]

    def complex_modulus(self, angular_frequency: ArrayLike) -> ComplexArray:
        """Storage modulus E′ and loss modulus E″ as ``E′ + iE″ = E∞ + Σ E_k iωτ_k/(1 + iωτ_k)``.

        Parameters
        ----------
        angular_frequency : ω, 1/s (rad/s), shape ``(K,)`` or batch shape plus ``(K,)``, or a scalar; at −ω the
            conjugate of the modulus at ω

        Returns
        -------
        complex_modulus : Pa, batch shape plus the axis of ``angular_frequency``; nan where an argument is impossible

        Examples
        --------
        >>> print(ViscoelasticMaterial(equilibrium_modulus=1e6).complex_modulus(5.0))
        (1000000+0j)
        """
        frequency, spring, moduli, times = self._with_points(angular_frequency)
        with np.errstate(all="ignore"):
            turn = frequency * times
            # 1/(1 + 1/x²) and 1/(x + 1/x) hold at x = 0 and where x² overflows
            storage = spring + (moduli / (1 + 1 / np.square(turn))).sum(axis=-1)
            loss = (moduli / (turn + 1 / turn)).sum(axis=-1)
        return np.asarray(storage + 1j * loss)[()]

    def relaxation_modulus(self, time: ArrayLike) -> FloatArray:
        """Stress after a step of strain over the strain, ``E(t) = E∞ + Σ E_k exp(−t/τ_k)``.

        Parameters
        ----------
        time : t since the step, s, ≥ 0, shape ``(K,)`` or batch shape plus ``(K,)``, or a scalar

        Returns
        -------
        relaxation_modulus : Pa, batch shape plus the axis of ``time``; nan where an argument is impossible

        Examples
        --------
        >>> tissue = ViscoelasticMaterial(equilibrium_modulus=20e3, relaxing_moduli=[8e3], relaxation_times=[0.1])
        >>> print(tissue.relaxation_modulus([0.0, 0.1, 10.0]).round())
        [28000. 22943. 20000.]
        """
        seconds, spring, moduli, times = self._with_points(time)
        with np.errstate(all="ignore"):
            decay = np.where(seconds >= 0, np.exp(-seconds / times), np.nan)
        return np.asarray(spring + (moduli * decay).sum(axis=-1))[()]

    def creep_compliance(self, time: ArrayLike) -> FloatArray:
        """Strain after a step of stress over the stress, J(t), from 1/E_g to 1/E∞.

        Parameters
        ----------
        time : t since the step, s, ≥ 0, shape ``(K,)`` or batch shape plus ``(K,)``, or a scalar

        Returns
        -------
        creep_compliance : 1/Pa, batch shape plus the axis of ``time``; nan where an argument is impossible

        Examples
        --------
        >>> tissue = ViscoelasticMaterial(equilibrium_modulus=20e3, relaxing_moduli=[8e3], relaxation_times=[0.1])
        >>> print((1 / tissue.creep_compliance([0.0, 10.0])).round())
        [28000. 20000.]
        """
        creep = self.creep
        seconds = np.asarray(time, dtype=np.float64)
        axes = min(seconds.ndim, 1)
        with np.errstate(all="ignore"):
            rise = np.where(
                seconds[..., None] >= 0, -np.expm1(-seconds[..., None] / _inner(creep[2], axes)), np.nan
            )
        return np.asarray(with_axes(creep[0], axes) + (_inner(creep[1], axes) * rise).sum(axis=-1))[()]

    @cached_property
    def creep(self) -> Creep:
        """The same material as a spring in series with M Kelvin–Voigt elements, for responses to stress.

        The retardation rates are the zeros of E(s), s = iω, one between each two relaxation rates and one below them.
        """
        spring, moduli, times = np.broadcast_arrays(*self._elements)
        with np.errstate(all="ignore"):
            instantaneous = np.asarray(self.instantaneous_modulus)
            if not moduli.shape[-1]:
                return Creep(1 / instantaneous, moduli, moduli)
            high = 1 / times
            lowest = high[..., -1:] * (spring[..., -1:] / instantaneous[..., None])
            low = np.concatenate([high[..., 1:], lowest], axis=-1)
            # where on a logarithmic scale between the ends of its bracket each zero lies
            span = np.log(high / low)
            below, above = np.zeros_like(span), np.ones_like(span)
            for _ in range(_HALVINGS):
                place = (below + above) / 2
                turn = low * np.exp(place * span)
                product = turn[..., None] * times[..., None, :]
                level = spring + (moduli[..., None, :] * product / (product - 1)).sum(axis=-1)
                rising = level > 0
                below, above = np.where(rising, place, below), np.where(rising, above, place)
            rate = low * np.exp((below + above) / 2 * span)
            slope = (
                (moduli * times)[..., None, :] / np.square(1 - rate[..., None] * times[..., None, :])
            ).sum(axis=-1)
            return Creep(1 / instantaneous, 1 / (rate * slope), 1 / rate)

    def loss_tangent(self, angular_frequency: ArrayLike) -> FloatArray:
        """``tan δ = E″/E′``, dimensionless, at ω, 1/s; shapes as in `complex_modulus`."""
        modulus = self.complex_modulus(angular_frequency)
        return np.asarray(modulus.imag / modulus.real)[()]

    def reduced_modulus(self, angular_frequency: ArrayLike) -> ComplexArray:
        """Plane-strain modulus ``E(ω)/(1 − ν²)``, Pa, at ω, 1/s; shapes as in `complex_modulus`."""
        axes = min(np.ndim(angular_frequency), 1)
        with np.errstate(all="ignore"):
            factor = with_axes(plane_strain(1.0, self.poisson_ratio), axes)
        return np.asarray(factor * self.complex_modulus(angular_frequency))[()]

    def hysteresis_loss(self, angular_frequency: ArrayLike, *, strain_amplitude: ArrayLike) -> FloatArray:
        """Work that a cycle of uniaxial strain ``ε0 sin ωt`` turns into heat, ``π E″(ω) ε0²``.

        Parameters
        ----------
        angular_frequency : ω, 1/s (rad/s), shape ``(K,)`` or batch shape plus ``(K,)``, or a scalar
        strain_amplitude : ε0, dimensionless, broadcasts with the result

        Returns
        -------
        hysteresis_loss : J/m^3 of a cycle, batch shape plus the axis of ``angular_frequency``

        Examples
        --------
        >>> tissue = ViscoelasticMaterial(equilibrium_modulus=20e3, relaxing_moduli=[8e3], relaxation_times=[0.1])
        >>> print(f"{tissue.hysteresis_loss(10.0, strain_amplitude=0.1):.1f} J/m^3")
        125.7 J/m^3
        """
        amplitude = np.asarray(strain_amplitude, dtype=np.float64)
        return np.asarray(np.pi * self.complex_modulus(angular_frequency).imag * np.square(amplitude))[()]

    def _with_points(self, points: ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Frequencies or times with a last axis for the elements, and the elements with one for the points."""
        given = np.asarray(points, dtype=np.float64)
        axes = min(given.ndim, 1)
        spring, moduli, times = self._elements
        return given[..., None], with_axes(spring[..., 0], axes), _inner(moduli, axes), _inner(times, axes)


def _inner(values: FloatArray, axes: int) -> FloatArray:
    """``values`` with a new axis before the last one, if there is an axis of points."""
    return values[..., None, :] if axes else values
