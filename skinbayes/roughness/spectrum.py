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


_PLATEAU_NODES, _PLATEAU_WEIGHTS = gauss_unit(12)
_FRACTAL_NODES, _FRACTAL_WEIGHTS = gauss_unit(36)
_SPLIT = _PLATEAU_NODES.size


def _power_integral(length: FloatArray, exponent: Floats) -> FloatArray:
    """``∫ exp(exponent · t) dt`` from 0 to ``length``; exact also where the exponent vanishes."""
    return np.asarray(length * exprel(exponent * length))


@dataclass(frozen=True, eq=False, kw_only=True)
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
    >>> surface = SelfAffineSpectrum(rms_height=22.4e-6, hurst_exponent=0.78, wavevector_min=1e3,
    ...     wavevector_rolloff=6.345e3, wavevector_max=1e9)
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
            )
            possible = possible & (height * q1 < np.inf)
            return np.where(possible, np.square(height) / (2 * np.pi * mean_square), np.nan)

    def _unit_moment(self, exponent: float) -> FloatArray:
        """``∫ q^exponent C dq / C0`` in closed form."""
        q0, q_r, q1 = self.wavevector_min, self.wavevector_rolloff, self.wavevector_max
        order = exponent + 1
        plateau = _power_integral(np.log(q_r / q0), order)
        fractal = _power_integral(np.log(q1 / q_r), order - 2 - 2 * self.hurst_exponent)
        # exp and log instead of **, which rounds differently for scalars and arrays
        return np.asarray(np.exp(order * np.log(q0)) * plateau + np.exp(order * np.log(q_r)) * fractal)

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
        q0, q_r, q1 = self._band(axes)
        plateau = with_axes(self.plateau_power, axes)
        with np.errstate(all="ignore"):
            decay = np.power(np.maximum(q / q_r, 1.0), -2 - 2 * with_axes(self.hurst_exponent, axes))
            inside = np.where(np.isnan(q), np.nan, (q >= q0) & (q <= q1))
            return np.asarray(plateau * decay * inside)[()]

    def partial_moment(self, exponent: float) -> FloatArray:
        """``∫ q^exponent C(q) dq`` over the band in closed form, batch shape, m^(3 − exponent)."""
        with np.errstate(all="ignore"):
            return np.asarray(self.plateau_power * self._unit_moment(exponent))[()]

    def slope_quadrature(self, saturation: Floats, wavevector: FloatArray | None = None) -> SlopeQuadrature:
        """A rule for ``∫ q³ C f dq``, see `SlopeQuadrature`.

        Gauss–Legendre in ln q on the plateau and on the fractal part up to ``saturation``, the closed form above.

        Parameters
        ----------
        saturation : 1/m, broadcasts with the batch; f = 1 above it
        wavevector : upper ends, 1/m, shape ``(..., K)``; None for the full band

        Returns
        -------
        rule : shapes ``(..., n)`` and ``(...)``, or ``(..., K, n)`` and ``(..., K)``
        """
        axes = 0 if wavevector is None else 1
        q0, q_r, q1 = self._band(axes)
        slope = 2 - 2 * with_axes(self.hurst_exponent, axes)
        plateau_power, saturation = with_axes(self.plateau_power, axes), with_axes(saturation, axes)
        with np.errstate(all="ignore"):
            top = q1 if wavevector is None else np.minimum(np.maximum(wavevector, q0), q1)
            end = np.maximum(np.minimum(top, saturation), q0)
            knee = np.minimum(q_r, end)
            lengths = np.log(knee / q0), np.log(end / knee)
            starts = np.log(q0 / q_r), np.log(knee / q_r)
            # ln(q/q_r) at the nodes: those of the plateau, then those of the fractal part
            log_ratio = np.empty((*np.shape(knee), _SPLIT + _FRACTAL_NODES.size))
            parts = log_ratio[..., :_SPLIT], log_ratio[..., _SPLIT:]
            for part, start, length, points in zip(
                parts, starts, lengths, (_PLATEAU_NODES, _FRACTAL_NODES), strict=True
            ):
                np.multiply(length[..., None], points, out=part)
                part += start[..., None]
            # ∫ q³ C dq = C0 q_r⁴ ∫ (q/q_r)^κ dln q with κ = 4 on the plateau and 2 − 2H above it
            scale = plateau_power * np.square(np.square(q_r))
            weights = np.empty((*np.broadcast_shapes(knee.shape, scale.shape), log_ratio.shape[-1]))
            np.multiply(parts[0], 4.0, out=weights[..., :_SPLIT])
            np.multiply(parts[1], slope[..., None], out=weights[..., _SPLIT:])
            np.exp(weights, out=weights)
            weights[..., :_SPLIT] *= (scale * lengths[0])[..., None] * _PLATEAU_WEIGHTS
            weights[..., _SPLIT:] *= (scale * lengths[1])[..., None] * _FRACTAL_WEIGHTS
            nodes = np.exp(log_ratio)
            nodes *= q_r[..., None]
            # f = 1 from ``end`` on
            turn = np.maximum(np.minimum(q_r, top), end)
            plateau = np.square(np.square(end / q_r)) * _power_integral(np.log(turn / end), 4.0)
            fractal = np.exp(slope * np.log(turn / q_r)) * _power_integral(np.log(top / turn), slope)
            remainder = scale * (plateau + fractal)
        return SlopeQuadrature(nodes, weights, remainder)

    def _band(self, axes: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """q0, q_r, q1 with ``axes`` new last axes."""
        ends = self.wavevector_min, self.wavevector_rolloff, self.wavevector_max
        q0, q_r, q1 = (with_axes(end, axes) for end in ends)
        return q0, q_r, q1
