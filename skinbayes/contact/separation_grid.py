"""Wavevectors at which the separation is summed, and what the solid contributes at each.

With φ(q) = 1/(q E_eff(q)) and dV = π q³ C E_eff² dq the theory's ``ū = √π ∫ q² C E_eff w I(wp) dq`` is the Stieltjes
integral ``ū = (1/√π) ∫ φ d[√V Q(p/√V)]``, and by parts

``ū = (1/√π) { φ(q1) √V(q1) Q(p/√V(q1)) + ∫ (−dφ/dln q) √V Q(p/√V) dln q }``.

The integrand starts like √V where the first form diverges like 1/√V, so that Gauss rules converge.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.solid import ElasticSolid
from skinbayes.contact.variance import twice_stress_variance
from skinbayes.roughness._fields import with_axes
from skinbayes.roughness._rules import gauss_unit
from skinbayes.roughness.spectrum import PowerSpectrum, SelfAffineSpectrum


class Places(NamedTuple):
    """Places in a band: shares (0 … 1) of its parts, in a measure that `resolve` stretches over ln q.

    Attributes
    ----------
    plateau : fractions of the plateau, strictly between 0 and 1, dimensionless, shape ``(P,)``
    fractal : fractions of the fractal part, strictly between 0 and 1, dimensionless, shape ``(F,)``
    whole : fractions of the band of a spectrum that is a table, strictly between 0 and 1, dimensionless, shape ``(T,)``
    """

    plateau: FloatArray
    fractal: FloatArray
    whole: FloatArray


class Band(NamedTuple):
    """Wavevectors of a band and what belongs to them; n = P + F + 2 with the knee and the end, or T + 1 with the end.

    Attributes
    ----------
    wavevector : q, 1/m, shape ``(..., n)``
    stretch : dln q by d(share), dimensionless, shape ``(..., n)``; 0 at the knee and at the end
    twice_variance : V of all wavevectors up to q, Pa², shape ``(..., n)``
    """

    wavevector: FloatArray
    stretch: FloatArray
    twice_variance: FloatArray


_INNER, _INNER_WEIGHTS = gauss_unit(4)
_NO_VARIANCE = 1e-300  # Pa²; a plateau without length has V = 0 there, with weight 0

# places of the fractal part crowd about q = 0.6/d within 1.5 of ln q, where a stiff layer makes V rise by decades; without a
# layer about the knee
_LAYER_PLACE, _LAYER_WIDTH = np.log(0.6), 1.5


def resolve(spectrum: PowerSpectrum, skin: ElasticSolid, places: Places) -> Band:
    """Wavevectors at given places of the band, with V; silences no warnings."""
    if isinstance(spectrum, SelfAffineSpectrum):
        q, stretch, twice_variance = _self_affine(spectrum, skin, places.plateau, places.fractal)
    else:
        start, end = (np.log(with_axes(q, 1)) for q in (spectrum.wavevector_min, spectrum.wavevector_max))
        q = np.exp(join(start + (end - start) * places.whole, end))
        stretch = join((end - start) * np.ones_like(places.whole), 0 * end)
        twice_variance = twice_stress_variance(spectrum, skin, wavevector=q)
    return Band(q, stretch, np.maximum(twice_variance, _NO_VARIANCE))


def _self_affine(
    spectrum: SelfAffineSpectrum,
    skin: ElasticSolid,
    plateau_fraction: FloatArray,
    fractal_fraction: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    ends = (spectrum.wavevector_min, spectrum.wavevector_rolloff, spectrum.wavevector_max)
    first, knee, last = (np.log(with_axes(end, 1)) for end in ends)
    low, high, zero = knee - first, last - knee, 0 * knee
    length = with_axes(skin.transition_length, 1)
    layer = np.where(np.isfinite(length), _LAYER_PLACE - np.log(length) - knee, zero)
    # everything in ln(q/q_r) = layer + width sinh(angle)
    start, stop = np.arcsinh(-layer / _LAYER_WIDTH), np.arcsinh((high - layer) / _LAYER_WIDTH)
    angle = start + (stop - start) * fractal_fraction
    plateau, fractal = low * (plateau_fraction - 1), layer + _LAYER_WIDTH * np.sinh(angle)
    stretch = join(
        low * np.ones_like(plateau_fraction), zero, _LAYER_WIDTH * (stop - start) * np.cosh(angle), zero
    )
    # V on the cells in between, ∫ q⁴ C E_eff² dln q
    edges = join(-low, plateau, zero, fractal, high)
    fractal_slope = 2 - 2 * with_axes(spectrum.hurst_exponent, 1)
    slope = join(np.full(plateau_fraction.size + 1, 4.0), fractal_slope * np.ones(fractal_fraction.size + 1))
    width = np.diff(edges)[..., None]
    place = edges[..., :-1, None] + width * _INNER
    flat = (*place.shape[:-2], place.shape[-2] * _INNER.size)
    stiffness = skin.inverse_response(np.exp(knee + place.reshape(flat)), 1)
    power = np.exp(slope[..., None] * place) * (width * _INNER_WEIGHTS)
    terms = np.ascontiguousarray(
        power * np.square(stiffness).reshape(*stiffness.shape[:-1], *place.shape[-2:])
    )
    sums = np.cumsum(terms.sum(axis=-1), axis=-1)
    modulus = with_axes(skin.surface_modulus, 1)
    scale = np.pi * with_axes(spectrum.plateau_power, 1) * np.square(np.square(np.exp(knee)) * modulus)
    return np.exp(knee + edges[..., 1:]), stretch, scale * sums


class SeparationGrid(NamedTuple):
    """Nodes of ``ū = Σ weight Q(p/√V)``; the last node is the upper end of the band.

    Attributes
    ----------
    log_twice_variance : ln V, V in Pa², shape ``(..., n)``
    inverse_twice_variance : 1/V, 1/Pa², shape ``(..., n)``
    weight : m, shape ``(..., n)``
    """

    log_twice_variance: FloatArray
    inverse_twice_variance: FloatArray
    weight: FloatArray


def _crowded(count: int) -> tuple[FloatArray, FloatArray]:
    """Gauss–Legendre in s for integrals over the fraction ``s²(1 + c)/(s + c)``: dense at 0, where integrands start like √V."""
    s, weights = gauss_unit(count)
    c = 0.1
    return np.square(s) * (1 + c) / (s + c), weights * (1 + c) * s * (s + 2 * c) / np.square(s + c)


_PLATEAU, _PLATEAU_WEIGHTS = _crowded(20)
_FRACTAL, _FRACTAL_WEIGHTS = _crowded(52)
_WHOLE, _WHOLE_WEIGHTS = _crowded(128)
_PLACES = Places(_PLATEAU, _FRACTAL, _WHOLE)
_WEIGHTS = np.concatenate([_PLATEAU_WEIGHTS, [0.0], _FRACTAL_WEIGHTS, [0.0]])
_TABLE_WEIGHTS = np.append(_WHOLE_WEIGHTS, 0.0)


def separation_grid(spectrum: PowerSpectrum, skin: ElasticSolid) -> SeparationGrid:
    """The grid for a spectrum and a skin, each scalar or batched; silences no warnings."""
    q, stretch, twice_variance = resolve(spectrum, skin, _PLACES)
    compliance, fall = skin.compliance_fall(q)
    measure = stretch * (_WEIGHTS if isinstance(spectrum, SelfAffineSpectrum) else _TABLE_WEIGHTS)
    weight = fall * measure * np.sqrt(twice_variance / np.pi)
    weight[..., -1] = compliance[..., -1] * np.sqrt(twice_variance[..., -1] / np.pi)
    return SeparationGrid(np.log(twice_variance), 1 / twice_variance, weight)


def join(*parts: FloatArray) -> FloatArray:
    """The parts one after the other along the last axis; their leading axes broadcast."""
    shape = np.broadcast_shapes(*(part.shape[:-1] for part in parts))
    return np.concatenate([np.broadcast_to(part, (*shape, part.shape[-1])) for part in parts], axis=-1)
