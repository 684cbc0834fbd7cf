"""Memory of a viscoelastic solid that passes under a ball, on the cells of a point contact.

The solid passes at v towards positive x. With the creep compliance ``J(t) = J_0 + Σ J_k (1 − exp(−t/θ_k))`` the deflection of
an elastic solid of unit modulus, w(x, y), becomes ``J_0 w + Σ J_k w_k`` with ``w_k(x, y) = ∫₀^∞ exp(−s) w(x − ℓ_k s, y) ds``,
ℓ_k = vθ_k: each retardation time remembers the deflection upstream. In wavevectors that is ``2 p(q)/(|q| E*(q_x v))``.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.lubrication.point_grid import PointGrid

_SHORT, _LONG = 1e-7, 1e7  # lengths that are none, and that have no end
_DOUBLINGS = 24  # panels beyond the grid, each twice as long as the one before
_LARGE = 2.0  # length of a panel in memory lengths above which its moments are exact, below by Gauss's rule
_ENDS_AND_BETWEEN = np.array([0.0, (1 - 5**-0.5) / 2, (1 + 5**-0.5) / 2, 1.0])  # of a panel, Lobatto's rule
_POLYNOMIALS = np.linalg.inv(
    np.vander(_ENDS_AND_BETWEEN, increasing=True)
)  # coefficients of Lagrange's, (power, node)
_GAUSS = np.polynomial.legendre.leggauss(10)


class PointMemory(NamedTuple):
    """What a solid makes of the deflection W of an elastic one at the n cells of a grid, dimensionless.

    Attributes
    ----------
    deflection : ``J_0 W + Σ J_k W_k`` from W, shape ``(n, n)``
    slope : ``Σ J_k (W − W_k)/ℓ_k``, its slope ``∂/∂x`` but for ``J_0 ∂W/∂x``, from W, shape ``(n, n)``
    """

    deflection: FloatArray
    slope: FloatArray


class _Path(NamedTuple):
    """The way upstream of one cell, in P panels of four places each.

    Attributes
    ----------
    start, length : of the panels, distance upstream, dimensionless, shape ``(P,)``
    radial : deflections at the places from those of rings, the first two of them seen through the middle, shape
        ``(rings + 2, 4P)``
    angular : the same from those of rays, shape ``(4P, rays)``
    """

    start: FloatArray
    length: FloatArray
    radial: FloatArray
    angular: FloatArray


def point_memory(
    grid: PointGrid, *, instantaneous: float, compliance: FloatArray, length: FloatArray
) -> PointMemory:
    """Memory of a creep compliance on the cells of a grid.

    The elastic deflection is interpolated along the way upstream, by cubic polynomials across rings and by cosines around
    them, and falls as 1/r beyond the grid; panels end where the way crosses rings, and the exponential is integrated exactly.

    Parameters
    ----------
    grid : n cells, dimensionless
    instantaneous : J_0 times a modulus, dimensionless
    compliance : J_k times the same modulus, dimensionless, shape ``(M,)``
    length : ℓ_k = vθ_k in the unit of x, dimensionless, ≥ 0, shape ``(M,)``; may be infinite

    Returns
    -------
    memory : `PointMemory`

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 9.4, doi 10.1017/CBO9781139171731.

    Examples
    --------
    A cosine upstream, seen by a solid of one retardation time: exp(−s) turns cos x into (cos x + ℓ sin x)/(1 + ℓ²).

    >>> from skinbayes.lubrication.point_grid import point_grid
    >>> grid = point_grid(24, 12, 0.1, 20.0)
    >>> memory = point_memory(grid, instantaneous=0.0, compliance=np.ones(1), length=np.array([0.5]))
    >>> x = grid.radius * np.cos(grid.angle)
    >>> seen = memory.deflection @ np.cos(x) - (np.cos(x) + 0.5 * np.sin(x)) / 1.25
    >>> print(f"{np.abs(seen[grid.radius < 1]).max():.4f}")
    0.0002
    """
    count = grid.radius.size
    here = length < _SHORT
    passing = (length >= _SHORT) & (length <= _LONG)
    own = instantaneous + float(compliance[here].sum())
    weights, lengths = compliance[passing], length[passing]
    deflection, slope = own * np.eye(count), (weights / lengths).sum() * np.eye(count)
    for cell, path in enumerate(_paths(grid)) if lengths.size else ():
        shares = _shares(path, lengths)  # (M, 4P)
        for matrix, factor, sign in (deflection, weights, 1.0), (slope, weights / lengths, -1.0):
            rings = path.radial @ ((factor @ shares)[:, None] * path.angular)
            rings[2:4] += rings[1::-1, ::-1]  # what lies beyond the middle
            matrix[cell] += sign * rings[2:].ravel()
    return PointMemory(deflection, slope)


def _paths(grid: PointGrid) -> Iterator[_Path]:
    """Of all cells, in their order."""
    rays = grid.rays
    radii, step = (grid.faces[1:] + grid.faces[:-1]) / 2, np.pi / rays
    angles = (np.arange(rays) + 0.5) * step
    nodes = np.concatenate([-radii[1::-1], radii])  # the middle is seen through
    orders = np.arange(1, rays)
    at_rays = np.cos(orders[:, None] * angles)
    beyond = -radii[-1] * 2.0 ** np.arange(1, _DOUBLINGS)
    for radius in radii.tolist():
        for angle in angles.tolist():
            x, y = radius * np.cos(angle), radius * np.sin(angle)
            crossing = np.sqrt(np.square(radii[radii > y]) - y * y)
            ends = np.concatenate([-crossing, crossing, [0.0], beyond])
            ends = np.concatenate([[x], np.sort(ends[ends < x - 1e-9 * radius])[::-1]])
            begin, long = x - ends[:-1], -np.diff(ends)
            along = (ends[:-1, None] - long[:, None] * _ENDS_AND_BETWEEN).ravel()
            distance = np.hypot(along, y)
            turned = np.arctan2(y, along)
            angular = (1 + 2 * np.cos(turned[:, None] * orders) @ at_rays) / rays
            yield _Path(begin, long, _cubic(nodes, distance), angular)


def _cubic(nodes: FloatArray, place: FloatArray) -> FloatArray:
    """Cubic polynomials through the four nodes around each place, ``(nodes, places)``; beyond the last it falls as 1/r."""
    far = place > nodes[-1]
    inside = np.where(far, nodes[-1], place)
    first = np.clip(np.searchsorted(nodes, inside) - 2, 0, nodes.size - 4)
    near = nodes[first + np.arange(4)[:, None]]
    found = np.zeros((nodes.size, place.size))
    for a in range(4):
        weight = np.ones_like(place)
        for b in range(4):
            if a != b:
                weight *= (inside - near[b]) / (near[a] - near[b])
        found[first + a, np.arange(place.size)] = weight
    return found * np.where(far, nodes[-1] / place, 1.0)


def _shares(path: _Path, length: FloatArray) -> FloatArray:
    """``∫ exp(−s/ℓ) L(s) ds/ℓ`` of the polynomials L of all panels, shape ``(M, 4P)``."""
    z = path.length / length[:, None]
    fade = np.exp(-np.minimum(path.start / length[:, None], 700.0))
    moments = np.zeros((4, *z.shape))
    small = z < _LARGE
    places, parts = (_GAUSS[0] + 1) / 2, _GAUSS[1] / 2
    low, high = z[small], z[~small]
    kernel = low[:, None] * np.exp(-low[:, None] * places) * parts
    for power in range(4):
        moments[power][small] = kernel @ places**power
        before = moments[power - 1][~small] if power else None
        moments[power][~small] = -np.expm1(-high) if before is None else power / high * before - np.exp(-high)
    shares = np.einsum("pmk,pa->mka", moments, _POLYNOMIALS) * fade[..., None]
    return np.asarray(shares.reshape(length.size, -1))
