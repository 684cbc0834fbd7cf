"""Drag of a film on a ball: the two integrals that friction needs, up to a given radius."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.lubrication.drag import DragIntegrals
from skinbayes.lubrication.flow_factors import FlowFactors, TrivialFlowFactors
from skinbayes.lubrication.point_grid import PointGrid
from skinbayes.lubrication.rheology import Rheology

_EMPTY = 1e-12  # P_f of a cavity after rounding


def point_drag_integrals(
    grid: PointGrid,
    film: FloatArray,
    fluid: FloatArray,
    number: FloatArray,
    *,
    end: float,
    height: float,
    flow_factors: FlowFactors | None = None,
    rheology: Rheology | None = None,
    speed: FloatArray | None = None,
) -> DragIntegrals:
    """Integrate the drag over the films within r < ``end``: without an end both integrals grow as the logarithm of the radius.

    In the cavity the volume that passed the break at the same y, S = H + Φ_s, fills the fraction θ = S_c/S of the width.
    Between two cells the film is taken as linear, and ∫H dP_f is exact for that and for the flow that passes.

    Parameters
    ----------
    grid : cells, dimensionless
    film : H, dimensionless, shape ``(K, n)``
    fluid : P_f, dimensionless, shape ``(K, n)``
    number : λ, dimensionless, shape ``(K,)``
    end : radius, in units of the contact's, dimensionless, > 0
    height : unit of H, a²/R, m
    flow_factors, rheology : None for trivial ones and for a Newtonian liquid
    speed : v, m/s, shape ``(K,)``; needed with a rheology

    Returns
    -------
    drag : `DragIntegrals`: ∫(φ_f + φ_fs) θ (η/η0)/H dA and ∫(2 − φ_fp) H ∂P_f/∂x dA, dimensionless, shape ``(K,)`` each

    References
    ----------
    Persson & Scaraggi, Eur. Phys. J. E 34 (2011) 113, doi 10.1140/epje/i2011-11113-9.

    Examples
    --------
    A film of even thickness without pressure: the area over the thickness.

    >>> import numpy as np
    >>> from skinbayes.lubrication.point_grid import point_grid
    >>> grid = point_grid(12, 6, 0.1, 10.0)
    >>> even = np.full((1, 72), 0.5)
    >>> drag = point_drag_integrals(grid, even, even, np.ones(1), end=2.0, height=1e-4)
    >>> print(drag.couette.round(4), drag.pressure_flow.round(4))
    [25.1327] [0.]
    """
    factors = flow_factors if flow_factors is not None else TrivialFlowFactors()
    separation = film * height
    phi, _, shear, _ = factors.flow(separation)
    weights = factors.friction(separation)
    thickness = np.ones_like(film)
    if rheology is not None and speed is not None:
        thickness = rheology.relative(speed[:, None] / np.maximum(separation, 1e-300))[0]
    inside = _inside(grid, end)
    wet = fluid > _EMPTY
    filled = _filled(grid, film + shear / height, wet)
    couette = (weights.shear * thickness * filled / film) @ (grid.area * inside)

    left, right = grid.left, grid.right
    low, high = film[:, left], film[:, right]
    both = low + high
    uneven = np.maximum(np.abs(high - low) / both, 1e-4)
    conduct = ((phi / thickness)[:, left] + (phi / thickness)[:, right]) / 2
    # P_f changes most where the film is thinnest: a film that narrows adds to the mean of the ends
    push = number[:, None] * (grid.width_along / grid.width * grid.distance) * 2 / both / conduct
    climb = 2 * low * high / both * (fluid[:, right] - fluid[:, left])
    climb += np.where(wet[:, left] | wet[:, right], push * (np.arctanh(uneven) / uneven - 1), 0.0)
    slopes = 2 - (weights.pressure[:, left] + weights.pressure[:, right]) / 2
    share = grid.width_along * (inside[left] + inside[right])  # both halves of the plane
    return DragIntegrals(np.asarray(couette), np.asarray((slopes * climb) @ share))


def _inside(grid: PointGrid, end: float) -> FloatArray:
    """Part of each cell that lies within ``end`` of the middle of the ball, shape ``(n,)``."""
    if grid.centre == 0:
        return np.repeat(np.diff(np.minimum(grid.faces, end) ** 2) / np.diff(grid.faces**2), grid.rays)
    angle = grid.angle[: grid.rays]
    edge = np.sqrt(end**2 - (grid.centre * np.sin(angle)) ** 2) - grid.centre * np.cos(angle)
    faces = grid.faces[:, None]
    return np.asarray(np.diff(np.minimum(faces, edge) ** 2, axis=0) / np.diff(faces**2, axis=0)).ravel()


def _filled(grid: PointGrid, volume: FloatArray, wet: BoolArray) -> FloatArray:
    """θ of the cells, shape ``(K, n)``, from the volume dragged along, S, and where there is pressure."""
    across = grid.radius * np.sin(grid.angle)
    filled = np.ones_like(volume)
    for row, (passed, full) in enumerate(zip(volume, wet, strict=True)):
        breaks = full[grid.left] != full[grid.right]
        if breaks.any():
            place, amount = ((z[grid.left] + z[grid.right])[breaks] / 2 for z in (across, passed))
            order = np.argsort(place)
            carried = np.interp(across, place[order], amount[order])
            filled[row] = np.where(full, 1.0, np.minimum(1.0, carried / passed))
    return filled
