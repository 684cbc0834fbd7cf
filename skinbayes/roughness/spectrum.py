"""Surface roughness power spectra: what every spectrum offers, and the self-affine one.

Convention: ``C(q)`` is the power spectrum of a surface (Eq. 1 of the paper), isotropic and two-dimensional,
so that the mean square height is ``2π ∫ q C(q) dq``. Heights are in m, wavevectors in 1/m (2π over the
wavelength), C in m^4.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
from scipy.special import exprel

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.roughness._fields import Floats, hold_floats, remembering_numbers, with_axes
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

        ``saturation`` (1/m, batch shape) is the wavevector above which f equals 1. Silences no warnings.
        """
        ...


_PLATEAU, _FRACTAL = gauss_unit(12), gauss_unit(36)
_ON_PLATEAU = np.arange(48) < 12  # of the nodes
# shares of the plateau and of the fractal part at each node and weights of both rules, 0 in the other part
_PLATEAU_NODES, _PLATEAU_WEIGHTS = (np.append(part, np.zeros(36)) for part in _PLATEAU)
_FRACTAL_NODES, _FRACTAL_WEIGHTS = (np.append(np.zeros(12), part) for part in _FRACTAL)


def _power_integral(length: FloatArray, exponent: Floats) -> FloatArray:
    """``∫ exp(exponent · t) dt`` from 0 to ``length``; exact also where the exponent vanishes."""
    return np.asarray(length * exprel(exponent * length))


def _unit_moment(exponent: float, hurst: Floats, q0: Floats, q_r: Floats, q1: Floats) -> FloatArray:
    """``∫ q^exponent C dq / C0`` in closed form."""
    order = exponent + 1
    plateau = _power_integral(np.log(q_r / q0), order)
    fractal = _power_integral(np.log(q1 / q_r), order - 2 - 2 * hurst)
    # exp and log instead of **, which rounds differently for scalars and arrays
    return np.asarray(np.exp(order * np.log(q0)) * plateau + np.exp(order * np.log(q_r)) * fractal)


class _Form(NamedTuple):
    """What does not depend on the height of a self-affine surface."""

    mean_square: FloatArray  # 2π ∫ q C dq / C0, 1/m²; nan where the form is impossible
    fourth_power: FloatArray  # q_r⁴
    first: FloatArray  # ln(q0/q_r)
    last: FloatArray  # ln(q1/q_r)
    slope: FloatArray  # of ln(q⁴C) above q_r, 2 − 2H


class _Whole(NamedTuple):
    """What a plateau that is integrated to its end contributes at each node, see `_plateau`; shapes ``(..., n)``."""

    place: FloatArray
    measure: FloatArray
    slope: FloatArray


@remembering_numbers
def _form(hurst: FloatArray, q0: FloatArray, q_r: FloatArray, q1: FloatArray) -> tuple[_Form, _Whole]:
    with np.errstate(all="ignore"):
        possible = (hurst > 0) & (hurst <= 1) & (q0 > 0) & (q_r >= q0) & (q1 >= q_r) & (q1 > q0)
        mean_square = np.where(possible, 2 * np.pi * _unit_moment(1.0, hurst, q0, q_r, q1), np.nan)
        first, slope = np.log(q0 / q_r), 2 - 2 * hurst
        form = _Form(mean_square, np.square(np.square(q_r)), first, np.log(q1 / q_r), slope)
        return form, _Whole(*_plateau(first, 0 * first), _slopes(slope))


def _plateau(first: FloatArray, knee: FloatArray) -> tuple[FloatArray, FloatArray]:
    """ln(q/q_r) at the nodes and their weights in ln q, for a plateau from ``first`` to ``knee`` and no fractal part."""
    length = (knee - first)[..., None]
    place = np.where(_ON_PLATEAU, first[..., None], knee[..., None]) + length * _PLATEAU_NODES
    return place, length * _PLATEAU_WEIGHTS


def _slopes(fractal: FloatArray) -> FloatArray:
    """dln(q⁴C)/dln q at the nodes."""
    return np.where(_ON_PLATEAU, 4.0, fractal[..., None])


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
        hold_floats(self)

    @cached_property
    def plateau_power(self) -> FloatArray:
        """C0, the power of the plateau, m^4, batch shape; nan where the parameters are impossible."""
        with np.errstate(all="ignore"):
            return self._plateau_power(self._form()[0])

    def _plateau_power(self, form: _Form) -> FloatArray:
        possible = (self.rms_height > 0.0) & (self.rms_height * self.wavevector_max < np.inf)
        return np.where(possible, np.square(self.rms_height) / form.mean_square, np.nan)

    def _form(self) -> tuple[_Form, _Whole]:
        return _form(self.hurst_exponent, self.wavevector_min, self.wavevector_rolloff, self.wavevector_max)

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
        ends = self.wavevector_min, self.wavevector_rolloff, self.wavevector_max
        q0, q_r, q1 = (with_axes(end, axes) for end in ends)
        plateau = with_axes(self.plateau_power, axes)
        with np.errstate(all="ignore"):
            decay = np.power(np.maximum(q / q_r, 1.0), -2 - 2 * with_axes(self.hurst_exponent, axes))
            inside = np.where(np.isnan(q), np.nan, (q >= q0) & (q <= q1))
            return np.asarray(plateau * decay * inside)[()]

    def partial_moment(self, exponent: float) -> FloatArray:
        """``∫ q^exponent C(q) dq`` over the band in closed form, batch shape, m^(3 − exponent)."""
        with np.errstate(all="ignore"):
            moment = _unit_moment(
                exponent,
                self.hurst_exponent,
                self.wavevector_min,
                self.wavevector_rolloff,
                self.wavevector_max,
            )
            return np.asarray(self.plateau_power * moment)[()]

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
        q_r = with_axes(self.wavevector_rolloff, axes)
        form, (place, measure, slopes) = self._form()
        parts = [with_axes(part, axes) for part in form] if axes else form
        _, fourth_power, first, last, slope = parts
        # everything in ln(q/q_r)
        top = last if wavevector is None else np.minimum(np.maximum(np.log(wavevector / q_r), first), last)
        end = np.maximum(np.minimum(top, np.log(with_axes(saturation, axes) / q_r)), first)
        # f = 1 from ``end`` on; ``turn`` is where the rest of the plateau ends
        turn, length = end, end[..., None]
        if axes or np.count_nonzero(end < 0.0):
            knee = np.minimum(end, 0.0)
            (place, measure), slopes = _plateau(first, knee), _slopes(slope)
            turn, length = np.maximum(np.minimum(top, 0.0), end), (end - knee)[..., None]
        place = place + length * _FRACTAL_NODES
        # ∫ q³ C dq = C0 q_r⁴ ∫ (q/q_r)^κ dln q with κ = 4 on the plateau and 2 − 2H above it
        scale = with_axes(self._plateau_power(form), axes) * fourth_power
        weights = np.exp(slopes * place) * (scale[..., None] * (measure + length * _FRACTAL_WEIGHTS))
        remainder = np.exp(slope * turn) * _power_integral(top - turn, slope)
        if turn is not end:
            remainder = np.exp(4.0 * end) * _power_integral(turn - end, 4.0) + remainder
        nodes, remainder = np.exp(place) * q_r[..., None], scale * remainder
        return SlopeQuadrature(nodes, weights, remainder)


SELF_AFFINE_PARAMETERS = tuple(field.name for field in fields(SelfAffineSpectrum))
"""Names of the five numbers that make a self-affine spectrum."""
