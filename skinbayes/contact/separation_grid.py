"""Wavevectors at which the separation is summed, and what the layered skin contributes at each.

With φ(q) = 1/(q E_eff(q)) and dV = π q³ C E_eff² dq the theory's ``ū = √π ∫ q² C E_eff w I(wp) dq`` is the Stieltjes
integral ``ū = (1/√π) ∫ φ d[√V Q(p/√V)]``, and by parts

``ū = (1/√π) { φ(q1) √V(q1) Q(p/√V(q1)) + ∫ (−dφ/dln q) √V Q(p/√V) dln q }``.

The integrand starts like √V where the first form diverges like 1/√V, so that Gauss rules converge.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.layered import LayeredSkin, _contrast, inverse_response, reduced_modulus
from skinbayes.contact.variance import stress_variance
from skinbayes.roughness._fields import with_axes
from skinbayes.roughness._rules import gauss_unit
from skinbayes.roughness.spectrum import PowerSpectrum, SelfAffineSpectrum


class _Panel(NamedTuple):
    """Nodes on [0, 1] with their weights, quadratically dense at 0, where integrands start like a square root."""

    nodes: FloatArray
    weights: FloatArray


def _panel(count: int, crowded: float) -> _Panel:
    """Gauss–Legendre in s, place ``s²(1 + c)/(s + c)``: the crowding at 0 reaches up to about s = c."""
    s, weights = gauss_unit(count)
    nodes = np.square(s) * (1 + crowded) / (s + crowded)
    return _Panel(nodes, weights * (1 + crowded) * s * (s + 2 * crowded) / np.square(s + crowded))


_PLATEAU, _FRACTAL, _TABLE = _panel(20, 0.1), _panel(52, 0.1), _panel(128, 0.1)
_INNER, _INNER_WEIGHTS = gauss_unit(4)
_NO_VARIANCE = 1e-300  # Pa²; a plateau without length has V = 0 at its nodes, with weight 0

# nodes of the fractal part crowd about q = 0.6/d within 1.5 of ln q, where a stiff layer makes V rise by decades
_LAYER_PLACE, _LAYER_WIDTH = np.log(0.6), 1.5


class SeparationGrid(NamedTuple):
    """Nodes of ``ū = Σ weight Q(p/√V)``; the last node is the upper end of the band.

    Attributes
    ----------
    log_variance : ln V, V in Pa², shape ``(..., n)``
    inverse_variance : 1/V, 1/Pa², shape ``(..., n)``
    weight : m, shape ``(..., n)``
    """

    log_variance: FloatArray
    inverse_variance: FloatArray
    weight: FloatArray


def separation_grid(spectrum: PowerSpectrum, skin: LayeredSkin) -> SeparationGrid:
    """The grid for a spectrum and a skin, each scalar or batched; silences no warnings."""
    if isinstance(spectrum, SelfAffineSpectrum):
        q, measure, variance = _self_affine(spectrum, skin)
    else:
        start, end = (np.log(with_axes(q, 1)) for q in (spectrum.wavevector_min, spectrum.wavevector_max))
        q = np.exp(join(start + (end - start) * _TABLE.nodes, end))
        measure = (end - start) * _TABLE.weights
        variance = stress_variance(spectrum, skin, q)
    variance = np.maximum(variance, _NO_VARIANCE)
    compliance, fall = compliance_fall(skin, q)
    weight = np.empty(np.broadcast_shapes(variance.shape, fall.shape))
    weight[..., :-1] = fall[..., :-1] * measure
    weight[..., -1] = compliance[..., -1]
    weight *= np.sqrt(variance / np.pi)
    return SeparationGrid(np.log(variance), 1 / variance, weight)


def _self_affine(
    spectrum: SelfAffineSpectrum, skin: LayeredSkin
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Nodes with the end of the band, the measure dln q of the nodes, and V up to the nodes and the end."""
    ends = (spectrum.wavevector_min, spectrum.wavevector_rolloff, spectrum.wavevector_max)
    first, knee, last = (np.log(with_axes(end, 1)) for end in ends)
    low, high = knee - first, last - knee
    layer = _LAYER_PLACE - np.log(with_axes(skin.layer_thickness, 1)) - knee
    # everything in ln(q/q_r); t = t_layer + width sinh(θ)
    start, stop = np.arcsinh(-layer / _LAYER_WIDTH), np.arcsinh((high - layer) / _LAYER_WIDTH)
    angle = start + (stop - start) * _FRACTAL.nodes
    fractal = layer + _LAYER_WIDTH * np.sinh(angle)
    fractal_measure = _LAYER_WIDTH * (stop - start) * np.cosh(angle) * _FRACTAL.weights
    plateau, zero = low * (_PLATEAU.nodes - 1), np.zeros_like(knee)
    nodes = join(plateau, fractal, high)
    measure = join(low * _PLATEAU.weights, fractal_measure)
    # V on the cells between nodes, ∫ q⁴ C E_eff² dln q
    edges = join(-low, plateau, zero, fractal, high)
    slope = 2 - 2 * with_axes(spectrum.hurst_exponent, 1)
    cells = _PLATEAU.nodes.size + 1
    exponent = join(
        np.broadcast_to(4.0, (cells,)),
        np.broadcast_to(slope, (*slope.shape[:-1], edges.shape[-1] - cells - 1)),
    )
    width = np.diff(edges)[..., None]
    place = edges[..., :-1, None] + width * _INNER
    flat = (*place.shape[:-2], -1)
    stiffness = inverse_response(skin, np.exp(knee + place.reshape(flat)), 1)
    log_power = (exponent[..., None] * place).reshape(flat)
    terms = np.exp(log_power) * np.square(stiffness) * (width * _INNER_WEIGHTS).reshape(flat)
    sums = np.ascontiguousarray(terms).reshape(*terms.shape[:-1], -1, _INNER.size).sum(axis=-1)
    # two cells meet at the knee, which is no node
    sums = np.delete(np.cumsum(sums, axis=-1), cells - 1, axis=-1)
    modulus = with_axes(reduced_modulus(skin.young_modulus_layer, skin.poisson_ratio_layer), 1)
    scale = np.pi * with_axes(spectrum.plateau_power, 1) * np.square(np.square(np.exp(knee)) * modulus)
    return np.exp(knee + nodes), measure, scale * sums


def join(*parts: FloatArray) -> FloatArray:
    """The parts one after the other along the last axis; their leading axes broadcast."""
    shape = np.broadcast_shapes(*(part.shape[:-1] for part in parts))
    return np.concatenate([np.broadcast_to(part, (*shape, part.shape[-1])) for part in parts], axis=-1)


def compliance_fall(skin: LayeredSkin, wavevector: FloatArray) -> tuple[FloatArray, FloatArray]:
    """φ = 1/(q E_eff), m/Pa, and ``−dφ/dln q``, batch shape of ``skin`` plus the axis of ``wavevector``."""
    at_zero, ground, linear, product, four_m = (with_axes(x, 1) for x in _contrast(skin))
    x = wavevector * with_axes(skin.layer_thickness, 1)
    rise = np.expm1(-2 * x)
    decay = 1 + rise
    bending = four_m * (x * decay)
    numerator = at_zero - product * (rise * (2 + rise)) + bending
    denominator = ground + rise * (product * rise - linear) - bending * x
    numerator_slope = x * decay * (4 * product * decay + four_m * (1 - 2 * x))
    denominator_slope = 2 * x * decay * (linear - 2 * product * rise - four_m * (x * (1 - x)))
    stiffening = denominator_slope / denominator - numerator_slope / numerator  # dln E_eff/dln q
    layer = with_axes(reduced_modulus(skin.young_modulus_layer, skin.poisson_ratio_layer), 1)
    compliance = numerator / (wavevector * layer * denominator)
    return np.asarray(compliance), np.asarray(compliance * (1 + stiffening))
