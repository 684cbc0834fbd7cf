"""Surface roughness power spectra: what every spectrum offers, and the self-affine one.

Convention: ``C(q)`` is the power spectrum of a surface (Eq. 1 of the paper), isotropic and two-dimensional,
so that the mean square height is ``2π ∫ q C(q) dq``. Heights are in m, wavevectors in 1/m (2π over the
wavelength), C in m^4.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from scipy.special import exprel

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.roughness._fields import Floats, as_field, with_axes
from skinbayes.roughness._rules import gauss_unit


class SlopeQuadrature(NamedTuple):
    """A quadrature rule for ``∫ q³ C(q) f(q) dq`` over a band, for functions f that are smooth in ln q.

    The integral is ``sum(weights * f(nodes), axis=-1) + remainder``; the remainder belongs to the part of the
    band where f is known to be 1.

    Attributes
    ----------
    nodes : wavevectors, 1/m, shape ``(..., n)``
    weights : m^2 × 1/m^2 (dimensionless), broadcasts against ``nodes``
    remainder : dimensionless, shape ``(...)``
    """

    nodes: FloatArray
    weights: FloatArray
    remainder: FloatArray


class PowerSpectrum(Protocol):
    """What the rest of skinbayes asks of a roughness power spectrum.

    A spectrum may hold a whole batch; its *batch shape* is the common shape of its parameters.
    """

    @property
    def wavevector_min(self) -> Floats:
        """Smallest wavevector q0 of the band, 1/m, batch shape."""
        ...

    @property
    def wavevector_max(self) -> Floats:
        """Largest wavevector q1 of the band, 1/m, batch shape."""
        ...

    def power(self, wavevector: ArrayLike) -> FloatArray:
        """C(q) in m^4 at ``wavevector`` (1/m), shape ``(K,)`` or ``(..., K)``; zero outside the band."""
        ...

    def partial_moment(self, exponent: float) -> FloatArray:
        """``∫ q^exponent C(q) dq`` over the band, batch shape, m^(3 − exponent)."""
        ...

    def slope_quadrature(self, saturation: Floats, wavevector: FloatArray | None = None) -> SlopeQuadrature:
        """A rule for ``∫ q³ C f dq`` from q0 to q1, or to each ``wavevector`` (shape ``(..., K)``).

        ``saturation`` (1/m, batch shape) is the wavevector above which f equals 1.
        """
        ...


_PLATEAU_NODES, _PLATEAU_WEIGHTS = gauss_unit(16)
_LOWER_NODES, _LOWER_WEIGHTS = gauss_unit(24)
_UPPER_NODES, _UPPER_WEIGHTS = gauss_unit(16)
_SPLIT = 0.05  # where the panel that ends at the saturation wavevector begins, in units of it


def _power_integral(length: FloatArray, exponent: Floats) -> FloatArray:
    """``∫ exp(exponent · t) dt`` from 0 to ``length``; exact also where the exponent vanishes."""
    return np.asarray(length * exprel(exponent * length))


@dataclass(frozen=True, eq=False)
class SelfAffineSpectrum:
    """Self-affine fractal surface with a plateau at long wavelengths.

    ``C(q) = C0`` for q0 ≤ q < q_r and ``C(q) = C0 (q/q_r)^(−2(1+H))`` for q_r ≤ q ≤ q1, zero elsewhere; C0
    follows from the rms height by ``h_rms² = 2π ∫ q C dq`` (Eq. 1 of the paper with the surface of its Sect.
    3). All parameters broadcast. Impossible parameters give nan, see `validate_spectrum` for a message
    instead.

    Attributes
    ----------
    rms_height : h_rms, m, > 0
    hurst_exponent : H, dimensionless, 0 < H ≤ 1
    wavevector_min : q0, 1/m, > 0
    wavevector_rolloff : q_r, 1/m, q0 ≤ q_r ≤ q1; equal to q0 if there is no plateau
    wavevector_max : q1, 1/m, > q0

    References
    ----------
    Persson et al., J. Phys.: Condens. Matter 17 (2005) R1, doi 10.1088/0953-8984/17/1/R01.

    Examples
    --------
    >>> from skinbayes.roughness import rms_slope
    >>> surface = SelfAffineSpectrum(22.4e-6, 0.78, 1e3, 6.345e3, 1e9)
    >>> print(f"{surface.power([1e3])[0]:.4e} {rms_slope(surface):.5f}")
    1.7576e-18 2.79993
    """

    rms_height: Floats
    hurst_exponent: Floats
    wavevector_min: Floats
    wavevector_rolloff: Floats
    wavevector_max: Floats

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            object.__setattr__(self, name, as_field(getattr(self, name)))

    @cached_property
    def plateau_power(self) -> FloatArray:
        """C0, the power of the plateau, m^4, batch shape; nan where the parameters are impossible."""
        q0, q_r, q1 = self.wavevector_min, self.wavevector_rolloff, self.wavevector_max
        height, hurst = self.rms_height, self.hurst_exponent
        with np.errstate(all="ignore"):
            mean_square = self._unit_moment(1.0)
            possible = (
                (height > 0) & (hurst > 0) & (hurst <= 1) & (q0 > 0) & (q_r >= q0) & (q1 >= q_r) & (q1 > q0)
            ) & (np.isfinite(height) & np.isfinite(q1))
            return np.where(possible, np.square(height) / (2 * np.pi * mean_square), np.nan)[()]

    def _unit_moment(self, exponent: float) -> FloatArray:
        """``∫ q^exponent C dq / C0`` in closed form."""
        q0, q_r, q1 = self.wavevector_min, self.wavevector_rolloff, self.wavevector_max
        plateau = _power_integral(np.log(q_r / q0), exponent + 1)
        fractal = _power_integral(np.log(q1 / q_r), exponent - 1 - 2 * self.hurst_exponent)
        return np.asarray(q0 ** (exponent + 1) * plateau + q_r ** (exponent + 1) * fractal)

    def power(self, wavevector: ArrayLike) -> FloatArray:
        """C(q), Eq. 1 of the paper.

        Parameters
        ----------
        wavevector : 1/m, shape ``(K,)`` or ``(..., K)``, or a scalar

        Returns
        -------
        power : m^4, batch shape plus the axis of ``wavevector``; zero outside the band
        """
        q = np.asarray(wavevector, dtype=np.float64)
        axes = min(q.ndim, 1)
        q0, q_r, q1 = (
            with_axes(x, axes) for x in (self.wavevector_min, self.wavevector_rolloff, self.wavevector_max)
        )
        with np.errstate(all="ignore"):
            decay = np.maximum(q / q_r, 1.0) ** (-2 - 2 * with_axes(self.hurst_exponent, axes))
            inside = (q >= q0) & (q <= q1)
            return np.where(
                inside, with_axes(self.plateau_power, axes) * decay, 0.0 * with_axes(self.plateau_power, axes)
            )[()]

    def partial_moment(self, exponent: float) -> FloatArray:
        """``∫ q^exponent C(q) dq`` over the band in closed form, batch shape, m^(3 − exponent)."""
        with np.errstate(all="ignore"):
            return np.asarray(self.plateau_power * self._unit_moment(exponent))[()]

    def slope_quadrature(self, saturation: Floats, wavevector: FloatArray | None = None) -> SlopeQuadrature:
        """A rule for ``∫ q³ C f dq``, see `SlopeQuadrature`.

        Gauss–Legendre in ln q on the plateau, on the fractal part up to a twentieth of ``saturation``, and
        from there to ``saturation``; the closed form above it.

        Parameters
        ----------
        saturation : 1/m, broadcasts with the batch; f = 1 above it
        wavevector : upper ends, 1/m, shape ``(..., K)``; None for the full band

        Returns
        -------
        rule : shapes ``(..., n)`` and ``(...)``, or ``(..., K, n)`` and ``(..., K)``
        """
        axes = 0 if wavevector is None else 1
        q0, q_r, q1 = (
            with_axes(x, axes) for x in (self.wavevector_min, self.wavevector_rolloff, self.wavevector_max)
        )
        slope = 2 - 2 * with_axes(self.hurst_exponent, axes)
        plateau_power, saturation = with_axes(self.plateau_power, axes), with_axes(saturation, axes)
        with np.errstate(all="ignore"):
            top = q1 if wavevector is None else np.minimum(np.maximum(wavevector, q0), q1)
            end = np.maximum(np.minimum(top, saturation), q0)
            knee = np.minimum(q_r, end)
            split = np.minimum(np.maximum(_SPLIT * saturation, knee), end)
            scale = plateau_power * q_r**4
            # plateau: ∫ q³ C f dq = C0 ∫ q⁴ f dln q
            length = np.log(knee / q0)
            plateau = _outer(q0, np.exp(_outer(length, _PLATEAU_NODES)))
            nodes, weights = (
                [plateau],
                [_outer(plateau_power * length, _PLATEAU_WEIGHTS) * np.square(np.square(plateau))],
            )
            # fractal part: C0 q_r⁴ ∫ (q/q_r)^(2−2H) f dln q
            panels = ((knee, split, _LOWER_NODES, _LOWER_WEIGHTS), (split, end, _UPPER_NODES, _UPPER_WEIGHTS))
            for left, right, points, point_weights in panels:
                length = np.log(right / left)
                log_ratio = np.log(left / q_r)[..., None] + _outer(length, points)
                nodes.append(_outer(q_r, np.exp(log_ratio)))
                weights.append(_outer(scale * length, point_weights) * np.exp(slope[..., None] * log_ratio))
            # f = 1 from here on
            mid = np.maximum(np.minimum(q_r, top), end)
            remainder = plateau_power * end**4 * _power_integral(np.log(mid / end), 4.0)
            remainder = remainder + scale * (mid / q_r) ** slope * _power_integral(np.log(top / mid), slope)
        return SlopeQuadrature(_joined(nodes), _joined(weights), np.asarray(remainder))


def _outer(batch: FloatArray, points: FloatArray) -> FloatArray:
    return np.asarray(batch)[..., None] * points


def _joined(parts: list[FloatArray]) -> FloatArray:
    """The panels side by side on the last axis, with a common leading shape."""
    leading = np.broadcast_shapes(*(part.shape[:-1] for part in parts))
    return np.concatenate([np.broadcast_to(part, leading + part.shape[-1:]) for part in parts], axis=-1)
