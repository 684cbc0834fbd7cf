"""Mean separation at every magnification, the raw material of the gap distribution.

What touches at magnification ζ = q/q0 feels the pressure p(ζ) = p/A(ζ) and has the mean separation

``ū(ζ) = (1/√π) ∫ φ d[√v Q(p(ζ)/√v)]``, ``v = V(q) − V(ζ)``, φ = 1/(q E_eff), over the wavevectors above ζ.

The band is cut into cells, each with a node in its middle. ū(ζ) is summed at the edges of cells and interpolated to the
middles; areas and heights are exact at both.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.special import exprel

from skinbayes.arrays import FloatArray
from skinbayes.contact._rows import as_rows, blocks
from skinbayes.contact.area import relative_contact_area
from skinbayes.contact.correction import IndexArray
from skinbayes.contact.separation_grid import Places, join, resolve
from skinbayes.contact.separation_tables import closing_function
from skinbayes.contact.solid import ElasticSolid, effective_modulus
from skinbayes.roughness._fields import with_axes
from skinbayes.roughness.spectrum import PowerSpectrum, SelfAffineSpectrum
from skinbayes.roughness.tabulated import TabulatedSpectrum

_PLATEAU, _FRACTAL, _WHOLE = 8, 32, 48  # cells

# Σ_ab f_a RULE_ab φ_b = ∫ f dφ over a cell for parabolas through the values at 0, ½ and 1
_RULE = np.array([[-3.0, 4.0, -1.0], [-4.0, 0.0, 4.0], [1.0, -4.0, 3.0]]) / 6
# the same for f = √x times a line, from its values at ½ and 1: where v starts at 0
_START = np.array([[-72.0, 32.0, 40.0], [30.0, -88.0, 58.0]]) / 105 * np.sqrt([[2.0], [1.0]])


class GapCells(NamedTuple):
    """The separation resolved over magnifications, on n nodes with the two ends of the band.

    Attributes
    ----------
    area : A(ζ)/A0, dimensionless, shape ``(..., n)``
    separation : ū(ζ), m, shape ``(..., n)``
    mean_square : mean square height of what is above ζ, m², shape ``(..., n)`` without the axis of pressures
    """

    area: FloatArray
    separation: FloatArray
    mean_square: FloatArray


class _Pairs(NamedTuple):
    """Every edge with every node above it, edge by edge, for N cells; all index arrays.

    Attributes
    ----------
    node, edge : node and edge (a node too) of each pair, shape ``(pairs,)``
    cell : number of the edge, shape ``(pairs,)``
    start : first pair of each edge, shape ``(N,)``
    """

    node: IndexArray
    edge: IndexArray
    cell: IndexArray
    start: IndexArray


@lru_cache(maxsize=4)
def _pairs(cells: int) -> _Pairs:
    edges = 2 * np.arange(cells)
    lengths = 2 * cells - edges
    start = np.cumsum(lengths) - lengths
    cell = np.repeat(np.arange(cells), lengths)
    node = np.arange(cell.size) - start[cell] + edges[cell] + 1
    return _Pairs(node, edges[cell], cell, start)


def _fractions(cells: int) -> FloatArray:
    """Places of the nodes between the ends of a part of the band: crowded at both ends, less so at the upper one."""
    place = np.arange(1, 2 * cells) / (2 * cells)
    lower = 1 - np.square(place) * 1.1 / (place + 0.1)
    return 1 - np.square(lower) * 1.5 / (lower + 0.5)


_PLACES = Places(_fractions(_PLATEAU), _fractions(_FRACTAL), _fractions(_WHOLE))


def resolve_gaps(
    pressure: FloatArray, spectrum: PowerSpectrum, skin: ElasticSolid, area_correction: FloatArray
) -> GapCells:
    """Area and separation at all magnifications for ``pressure`` of shape ``(..., K)``; γ has the shape of the batch."""
    parts = [_PLATEAU, _FRACTAL] if isinstance(spectrum, SelfAffineSpectrum) else [_WHOLE]
    band = resolve(spectrum, skin, _PLACES)
    q = join(with_axes(spectrum.wavevector_min, 1), band.wavevector)
    twice_variance = join(np.zeros(1), band.twice_variance)
    mean_square = _mean_square_above(spectrum, q)
    gamma = with_axes(area_correction, 1)
    area = relative_contact_area(
        pressure[..., None], twice_variance[..., None, :], area_correction=with_axes(gamma, 1)
    )
    area[..., 0] = 1 + 0 * area[..., 0]  # V = 0
    at_edges = _separation(
        pressure, area, twice_variance, 1 / (q * effective_modulus(skin, q)), area_correction
    )
    # ū(ζ)/h_rms(ζ) varies slowly until it falls to 0 at the end
    height = np.sqrt(mean_square)[..., None, :]
    above = height[..., :-1:2]
    # a fractal part without length has no height: all of it is the end
    ratio = join(np.where(above == 0, 0.0 * at_edges, at_edges / above), np.zeros(1))
    cuts = np.cumsum([0, *parts])
    pieces = [_halve(ratio[..., a : b + 1]) for a, b in pairwise(cuts)]
    separation = join(*(piece[..., :-1] for piece in pieces), np.zeros(1)) * height
    return GapCells(area, separation, mean_square)


def _separation(
    pressure: FloatArray,
    area: FloatArray,
    twice_variance: FloatArray,
    compliance: FloatArray,
    area_correction: FloatArray,
) -> FloatArray:
    """ū at all edges but the last, shape ``(..., K, N)``."""
    cells = twice_variance.shape[-1] // 2
    pairs = _pairs(cells)
    batch = area.shape[:-2]
    twice_variance = as_rows(twice_variance, batch)
    weight = _weights(as_rows(compliance, batch), cells, pairs)
    above = np.maximum(twice_variance[:, pairs.node] - twice_variance[:, pairs.edge], 1e-300)
    weight *= np.sqrt(above / np.pi)
    log_above, inverse = np.log(above), 1 / above
    closing = closing_function(
        as_rows(area_correction[..., None], batch)[:, 0] if area_correction.ndim else area_correction
    )
    local = np.log(pressure[..., None] / area[..., :-1:2]).reshape(
        len(twice_variance), pressure.shape[-1], cells
    )
    found = np.empty(local.shape)
    for rows, columns in blocks(len(local), local.shape[1], pairs.node.size):
        part = 2 * np.take(local[rows, columns], pairs.cell, axis=-1)
        terms = closing.of(rows)(log_above[rows, None] - part, np.exp(part) * inverse[rows, None])
        terms *= weight[rows, None]
        found[rows, columns] = np.add.reduceat(terms, pairs.start, axis=-1)
    return found.reshape(*batch, found.shape[1], cells)


def _weights(compliance: FloatArray, cells: int, pairs: _Pairs) -> FloatArray:
    """Weight of each pair in ``∫ √v Q (−dφ)`` plus the boundary term, shape ``(..., pairs)``."""
    inside = [compliance[..., k : k + 2 * cells - 1 : 2] for k in range(3)]
    rule = [-(a * inside[0] + b * inside[1] + c * inside[2]) for a, b, c in _RULE]
    start = [-(a * inside[0] + b * inside[1] + c * inside[2]) for a, b, c in _START]
    # the upper edge of a cell is the lower edge of the next; the last one has the boundary term
    carried = join(rule[0][..., 1:], compliance[..., -1:])
    total = np.zeros(compliance.shape)
    total[..., 1::2] = rule[1]
    total[..., 2::2] = rule[2] + carried
    weight = np.take(total, pairs.node, axis=-1)
    weight[..., pairs.start] = start[0]
    weight[..., pairs.start + 1] = start[1] + carried
    return weight


def _halve(values: FloatArray) -> FloatArray:
    """Values at edges, and between them by cubic interpolation in the number of the edge."""
    fine = np.empty((*values.shape[:-1], 2 * values.shape[-1] - 1))
    fine[..., ::2] = values
    fine[..., 3:-3:2] = (
        9 * (values[..., 1:-2] + values[..., 2:-1]) - values[..., :-3] - values[..., 3:]
    ) / 16
    first, last = values[..., :4], values[..., :-5:-1]
    for place, v in ((1, first), (-2, last)):
        fine[..., place] = (5 * v[..., 0] + 15 * v[..., 1] - 5 * v[..., 2] + v[..., 3]) / 16
    return fine


def _mean_square_above(spectrum: PowerSpectrum, q: FloatArray) -> FloatArray:
    """``2π ∫ q′ C dq′`` from each q to the end, for a spectrum that is a power law between the nodes (its own included)."""
    own = spectrum.wavevector if isinstance(spectrum, TabulatedSpectrum) else np.empty(0)
    points = np.union1d(q, own) if own.size else q
    log_q = np.log(points)
    inside = np.clip(points, with_axes(spectrum.wavevector_min, 1), with_axes(spectrum.wavevector_max, 1))
    density = np.square(points) * spectrum.power(inside)
    left, right = density[..., :-1], density[..., 1:]
    # places of a part without length are not ascending to the last bit
    steps = np.maximum(np.diff(log_q), 0.0)
    fractions = 2 * np.pi * left * steps * exprel(np.log(right / left))
    above = join(np.cumsum(fractions[..., ::-1], axis=-1)[..., ::-1], np.zeros(1))
    return above if not own.size else np.take(above, np.searchsorted(points, q), axis=-1)
