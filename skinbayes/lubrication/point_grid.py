"""Cells around a point contact, the faces between them, and the deflection that pressures in them cause."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from skinbayes.arrays import BoolArray, FloatArray, IndexArray

# Far away P_f = λ f(ψ)/r³, ψ the angle from the inlet, f″ − 9f = −8 cos ψ. Film and gradient end together at the break.
_BREAK = float(brentq(lambda psi: np.tan(psi) + 3 * np.tanh(3 * psi), 1.7, 2.5))
_SMOOTH = float(-0.8 * np.cos(_BREAK) / np.cosh(3 * _BREAK))
_ANGLES, _CLOSE_ANGLES = 10, 48  # points of Gauss's rule in a sector, and in that of the place itself


class PointGrid(NamedTuple):
    """n cells of the half plane y > 0, and the F faces between them; y and −y are alike.

    Attributes
    ----------
    faces : radii of the edges of the rings, rising, dimensionless, shape ``(rings + 1,)``
    rays : number of cells in a ring, dimensionless
    radius, angle : of the middles of the cells, dimensionless and rad, shape ``(n,)``; the flow comes from angle π
    area : of the cells with their mirror images, dimensionless, shape ``(n,)``
    kernel : separation at each cell by a unit pressure in each cell and its mirror image, dimensionless, shape ``(n, n)``
    left, right : cells on both sides of each face, shape ``(F,)``
    distance : between the middles of the two cells, dimensionless, shape ``(F,)``
    width : of the faces, dimensionless, shape ``(F,)``
    width_along : width times the x component of the normal from left to right, dimensionless, shape ``(F,)``
    rim : cells of the last ring, in which the pressure is that of the far inlet, shape ``(n,)``
    centre : x of the middle of the rings, from that of the ball, dimensionless
    drag : slope ∂/∂x of the depth at each cell by unit pressures on a solid that has a memory, dimensionless, shape
        ``(n, n)``; None for an elastic one, whose slope does no work
    """

    faces: FloatArray
    rays: int
    radius: FloatArray
    angle: FloatArray
    area: FloatArray
    kernel: FloatArray
    left: IndexArray
    right: IndexArray
    distance: FloatArray
    width: FloatArray
    width_along: FloatArray
    rim: BoolArray
    centre: float = 0.0
    drag: FloatArray | None = None

    @property
    def parabola(self) -> FloatArray:
        """Gap under the ball at the cells where nothing is deflected, dimensionless, shape ``(n,)``."""
        along = 2 * self.radius * np.cos(self.angle) + self.centre
        return np.asarray((np.square(self.radius) + self.centre * along) / 2)

    def stretched(self, scale: float, centre: float) -> PointGrid:
        """The same cells, so many times as large, around another place."""
        return self._replace(
            faces=self.faces * scale,
            radius=self.radius * scale,
            area=self.area * scale**2,
            kernel=self.kernel * scale,
            distance=self.distance * scale,
            width=self.width * scale,
            width_along=self.width_along * scale,
            centre=centre,
        )


@lru_cache(maxsize=8)
def point_grid(rings: int, rays: int, edge_width: float, reach: float) -> PointGrid:
    """Cells between rings equally spaced in ``arsinh((r − 1)/ε)`` and rays at even angles from the outlet to the inlet.

    What changes fast does so across the edge of the contact of Hertz, r = 1, and smoothly around it.

    Parameters
    ----------
    rings, rays : numbers of cells outwards and from the outlet to the inlet, dimensionless
    edge_width : ε, dimensionless, > 0
    reach : radius of the last edge, dimensionless, > 1

    Returns
    -------
    grid : `PointGrid`; the same object for the same arguments

    References
    ----------
    Johnson, Contact Mechanics (1985), Chap. 3, doi 10.1017/CBO9781139171731 (deflection under a pressure).

    Examples
    --------
    >>> grid = point_grid(12, 6, 0.1, 10.0)
    >>> print(grid.radius.size, f"{grid.area.sum() / 100:.6f}", grid.faces[[0, -1]])
    72 3.141593 [ 0. 10.]
    """
    first, last = -np.arcsinh(1 / edge_width), np.arcsinh((reach - 1) / edge_width)
    faces = 1 + edge_width * np.sinh(np.linspace(first, last, rings + 1))
    faces[0], faces[-1] = 0.0, reach
    middle, step = (faces[1:] + faces[:-1]) / 2, np.pi / rays
    places = (np.arange(rays) + 0.5) * step
    sectors = sector_kernel(middle, faces, rays)
    apart = np.abs(np.subtract.outer(np.arange(rays), np.arange(rays)))
    mirrored = np.add.outer(np.arange(rays), np.arange(rays)) + 1
    kernel = sectors[:, :, apart] + sectors[:, :, np.minimum(mirrored, 2 * rays - mirrored)]
    index = np.arange(rings * rays).reshape(rings, rays)
    spacing, widths = np.diff(middle), np.diff(faces)
    outward = np.sin(places + step / 2) - np.sin(places - step / 2)  # ∫cos over a ray
    around = -np.sin(places[:-1] + step / 2)
    return PointGrid(
        faces=faces,
        rays=rays,
        radius=np.repeat(middle, rays),
        angle=np.tile(places, rings),
        area=np.repeat(step * np.diff(np.square(faces)), rays),
        kernel=np.ascontiguousarray(kernel.transpose(0, 2, 1, 3).reshape(index.size, index.size)),
        left=np.concatenate([index[:-1].ravel(), index[:, :-1].ravel()]),
        right=np.concatenate([index[1:].ravel(), index[:, 1:].ravel()]),
        distance=np.concatenate([np.repeat(spacing, rays), np.repeat(middle * step, rays - 1)]),
        width=np.concatenate([np.repeat(faces[1:-1] * step, rays), np.repeat(widths, rays - 1)]),
        width_along=np.append(np.outer(faces[1:-1], outward), np.outer(widths, around)),
        rim=np.repeat(np.arange(rings) == rings - 1, rays),
    )


def sector_kernel(radius: FloatArray, faces: FloatArray, rays: int) -> FloatArray:
    """``(2/π²) ∫dA/ρ`` over sectors between ``faces``, 0 to ``rays`` sectors away, seen from places at ``radius``.

    ``∫r′ dr′/ρ = ρ + r cosφ ln(r′ − r cosφ + ρ)`` is exact, the angle goes by Gauss's rule; in the sector of the place itself
    the logarithm is singular at φ = 0, and φ ∝ t⁴.

    Parameters
    ----------
    radius : of M places in the middle of a sector, dimensionless, shape ``(M,)``
    faces : radii of the edges of L rings, rising, dimensionless, shape ``(L + 1,)``
    rays : number of sectors of half a turn, dimensionless

    Returns
    -------
    kernel : dimensionless, shape ``(M, L, rays + 1)``

    References
    ----------
    Johnson, Contact Mechanics (1985), Chap. 3, doi 10.1017/CBO9781139171731.

    Examples
    --------
    Seen from the middle of a disk of radius 1, ∫dA/ρ = 2π:

    >>> import numpy as np
    >>> sectors = sector_kernel(np.array([1e-9]), np.array([0.0, 1.0]), 4)[0, 0]
    >>> print((np.pi**2 / 2 * (sectors[0] + 2 * sectors[1:-1].sum() + sectors[-1]) / np.pi).round(6))
    2.0
    """
    step = np.pi / rays
    nodes, weights = np.polynomial.legendre.leggauss(_ANGLES)
    close, close_weights = np.polynomial.legendre.leggauss(_CLOSE_ANGLES)
    close = (close + 1) / 2
    r, edge = radius[:, None, None], faces[None, :, None]
    result = np.empty((radius.size, faces.size - 1, rays + 1))
    for away in range(rays + 1):
        angles, fractions = (away + nodes / 2) * step, weights * step / 2
        if away == 0:  # both halves alike
            angles, fractions = step / 2 * close**4, close_weights * step * 2 * close**3
        along, across = edge - r * np.cos(angles), r * np.sin(angles)
        distance = np.hypot(along, across)
        # before the place the sum cancels, where it is (r sinφ)² over the difference
        before = along < 0
        term = np.where(before, np.square(across) / np.where(before, distance - along, 1.0), along + distance)
        result[:, :, away] = np.diff(distance + r * np.cos(angles) * np.log(term), axis=1) @ fractions
    return 2 / np.pi**2 * result


def far_inlet(angle: FloatArray) -> FloatArray:
    """``P_f r³/λ``, dimensionless, far from the contact, where H = r²/2, at angles (rad) from the outlet."""
    psi = np.pi - angle
    return np.where(psi < _BREAK, 0.8 * np.cos(psi) + _SMOOTH * np.cosh(3 * psi), 0.0)
