"""A power spectrum given as a table."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import exprel

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.roughness._fields import Floats, as_field, with_axes
from skinbayes.roughness._product_rule import ProductRule
from skinbayes.roughness.profile import isotropic_from_profile, profile_from_isotropic
from skinbayes.roughness.spectrum import SlopeQuadrature


@dataclass(frozen=True, eq=False, init=False)
class TabulatedSpectrum:
    """A measured isotropic two-dimensional spectrum C(q) (Eq. 1 of the paper), a power law between nodes.

    ``⟨h²⟩ = 2π ∫ q C dq``; C is zero outside the table. Use `from_profile` for the one-dimensional spectrum
    of line scans.

    Attributes
    ----------
    wavevector : 1/m, shape ``(K,)``, strictly increasing, K ≥ 2
    node_power : C at ``wavevector``, m^4, shape ``(K,)``, > 0; given as ``power``
    scale : factor on the variance of heights, dimensionless, any batch shape; (h/h_table)² rescales the rms
        height. Not positive gives nan.

    Raises
    ------
    InputError
        if the table is not as described; the message says which entry

    References
    ----------
    Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, doi 10.1088/2051-672X/aa51f8.

    Examples
    --------
    >>> from skinbayes.roughness import rms_height
    >>> table = TabulatedSpectrum([1e3, 1e4, 1e5], [1e-16, 1e-18, 1e-21])
    >>> print(f"{rms_height(table):.4e}")
    4.4858e-05
    """

    wavevector: FloatArray
    node_power: FloatArray
    scale: Floats

    def __init__(self, wavevector: ArrayLike, power: ArrayLike, *, scale: ArrayLike = 1.0) -> None:
        for name, values in (("wavevector", wavevector), ("node_power", power)):
            own = np.array(values, dtype=np.float64)  # quadrature weights are kept, so nobody may write here
            own.flags.writeable = False
            object.__setattr__(self, name, own)
        object.__setattr__(self, "scale", as_field(scale))
        check_table(self.wavevector, self.node_power, "power", "m^4")

    @classmethod
    def from_profile(
        cls, wavevector: ArrayLike, profile_power: ArrayLike, *, scale: ArrayLike = 1.0
    ) -> TabulatedSpectrum:
        """The isotropic surface whose straight profiles have the one-dimensional spectrum C1D(q).

        ``C(q) = −(1/π) ∫_q^∞ C1D′(k) / sqrt(k² − q²) dk``, the inverse of
        ``C1D(q) = 2 ∫_q^∞ k C(k)/sqrt(k² − q²) dk``, where ``⟨h²⟩ = 2 ∫_0^∞ C1D dq``. C1D is a power law
        between its nodes and goes on with the last one beyond the table, as the instrument stops there and
        the roughness does not; the result is then cut at the last node.

        Parameters
        ----------
        wavevector : 1/m, shape ``(K,)``, strictly increasing, K ≥ 2
        profile_power : C1D, m^3, shape ``(K,)``, > 0
        scale : factor on the variance of heights, dimensionless, any batch shape

        Returns
        -------
        spectrum : two-dimensional spectrum on the same nodes

        Raises
        ------
        InputError
            if the table is not as described, if C1D rises at its end, or if no isotropic surface has such
            profiles (C would be negative, as it happens when C1D is noisy: average it over bands first)

        References
        ----------
        Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, doi 10.1088/2051-672X/aa51f8.

        Examples
        --------
        >>> spectrum = TabulatedSpectrum.from_profile([1e3, 1e4, 1e5], [1e-12, 1e-14, 1e-16])
        >>> print(f"{spectrum.power(1e4):.4e}")  # C = C1D/(2q) where C1D falls as 1/q²
        5.0000e-19
        """
        nodes, values = as_field(wavevector), as_field(profile_power)
        check_table(nodes, values, "profile_power", "m^3")
        return cls(nodes, isotropic_from_profile(nodes, values), scale=scale)

    @property
    def wavevector_min(self) -> Floats:
        """First node, 1/m."""
        return self.wavevector[0]

    @property
    def wavevector_max(self) -> Floats:
        """Last node, 1/m."""
        return self.wavevector[-1]

    @cached_property
    def _exponent(self) -> FloatArray:
        """``dln C/dln q`` of each cell, shape ``(K − 1,)``."""
        return np.diff(np.log(self.node_power)) / np.diff(np.log(self.wavevector))

    @cached_property
    def _factor(self) -> FloatArray:
        """``scale``, with nan for what is not a positive finite number."""
        good = (self.scale > 0) & np.isfinite(self.scale)
        return np.where(good, self.scale, np.nan)[()]

    def power(self, wavevector: ArrayLike) -> FloatArray:
        """C(q), Eq. 1 of the paper.

        Parameters
        ----------
        wavevector : 1/m, shape ``(K,)`` or ``(..., K)``, or a scalar

        Returns
        -------
        power : m^4, batch shape of ``scale`` plus the axis of ``wavevector``; zero outside the table
        """
        q = np.asarray(wavevector, dtype=np.float64)
        return (with_axes(self._factor, min(q.ndim, 1)) * self._unscaled(q))[()]

    def profile_power(self, wavevector: ArrayLike) -> FloatArray:
        """One-dimensional spectrum of straight profiles of the surface, what `from_profile` takes.

        ``C1D(q) = 2 ∫_q^∞ k C(k)/sqrt(k² − q²) dk`` over the table, where ``⟨h²⟩ = 2 ∫_0^∞ C1D dq``. Profiles have
        waves longer than any of the surface, which they cross at an angle: below the first node C1D is finite.

        Parameters
        ----------
        wavevector : of profiles, 1/m, shape ``(n,)`` or a scalar, > 0

        Returns
        -------
        profile_power : C1D, m^3, batch shape of ``scale`` plus that of ``wavevector``; zero above the table

        References
        ----------
        Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, doi 10.1088/2051-672X/aa51f8.

        Examples
        --------
        >>> spectrum = TabulatedSpectrum([1e3, 1e8], [1e-12, 1e-32])
        >>> print(f"{spectrum.profile_power(1e5) / (np.pi / 2 * 1e-20 * 1e5):.5f}")  # C ∝ q^−4: C1D = (π/2) q C
        1.00000
        """
        q = np.asarray(wavevector, dtype=np.float64)
        found = profile_from_isotropic(self.wavevector, self._exponent, self.node_power[:-1], q.reshape(-1))
        return (with_axes(self._factor, q.ndim) * found.reshape(q.shape))[()]

    def _unscaled(self, q: FloatArray) -> FloatArray:
        cell = np.clip(np.searchsorted(self.wavevector, q, side="right") - 1, 0, self.wavevector.size - 2)
        with np.errstate(all="ignore"):
            value = self.node_power[cell] * np.power(q / self.wavevector[cell], self._exponent[cell])
        inside = (q >= self.wavevector[0]) & (q <= self.wavevector[-1])
        return np.where(inside, value, np.where(np.isnan(q), np.nan, 0.0))

    def partial_moment(self, exponent: float) -> FloatArray:
        """``∫ q^exponent C(q) dq`` over the table in closed form, shape of ``scale``, m^(3 − exponent)."""
        left, length = self.wavevector[:-1], np.diff(np.log(self.wavevector))
        cells = self.node_power[:-1] * left ** (exponent + 1) * length
        total = np.sum(cells * exprel((exponent + 1 + self._exponent) * length))
        return np.asarray(self._factor * total)[()]

    def slope_quadrature(self, saturation: Floats, wavevector: FloatArray | None = None) -> SlopeQuadrature:
        """A rule for ``∫ q³ C f dq``, see `SlopeQuadrature`.

        The nodes lie on panels of ln q that do not depend on ``saturation``; the weights integrate the
        polynomial through the values of f on a panel against q³ C exactly, kinks of the table included.

        Parameters
        ----------
        saturation : not needed here
        wavevector : upper ends, 1/m, shape ``(..., K)``; None for the full band

        Returns
        -------
        rule : nodes ``(n,)`` or ``(1, n)``, weights ``(..., n)`` or ``(..., K, n)``, remainder zero
        """
        rule = self._rule
        if wavevector is None:
            weights = with_axes(self._factor, 1) * rule.full
            return SlopeQuadrature(rule.nodes, weights, np.zeros(weights.shape[:-1]))
        weights = with_axes(self._factor, 2) * rule.up_to(np.asarray(wavevector, dtype=np.float64))
        return SlopeQuadrature(rule.nodes[None, :], weights, np.zeros(weights.shape[:-1]))

    @cached_property
    def _rule(self) -> ProductRule:
        return ProductRule(self.wavevector, self._unscaled)


def check_table(wavevector: FloatArray, power: FloatArray, name: str, unit: str) -> None:
    """Refuse a table that is not a strictly increasing list of wavevectors (1/m) with positive values."""
    if np.ndim(wavevector) != 1 or np.shape(wavevector) != np.shape(power) or np.size(wavevector) < 2:
        raise InputError(
            f"A spectrum needs two lists of the same length, at least 2; wavevector has shape "
            f"{np.shape(wavevector)} and {name} {np.shape(power)}."
        )
    for label, values, its_unit in (("wavevector", wavevector, "1/m"), (name, power, unit)):
        wrong = np.flatnonzero(~(np.isfinite(values) & (values > 0)))
        if wrong.size:
            i = int(wrong[0])
            raise InputError(
                f"{label}, entry {i + 1}, is {values[i]:g} {its_unit}, but must be finite and > 0 {its_unit}."
            )
    steps = np.flatnonzero(np.diff(wavevector) <= 0)
    if steps.size:
        i = int(steps[0])
        raise InputError(
            f"wavevector must increase from entry to entry, but entry {i + 2} is {wavevector[i + 1]:g} 1/m "
            f"after {wavevector[i]:g} 1/m."
        )
