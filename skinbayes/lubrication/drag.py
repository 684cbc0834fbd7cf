"""Drag of a film on the cylinder: the two integrals that friction needs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.lubrication.flow_factors import FlowFactors, TrivialFlowFactors
from skinbayes.lubrication.grid import LineGrid
from skinbayes.lubrication.rheology import Rheology

_EMPTY = 1e-12  # P_f of a cavity after rounding


class DragIntegrals(NamedTuple):
    """Integrals of films at K speeds.

    Attributes
    ----------
    couette : ∫(φ_f + φ_fs) θ (η/η0)/H dX, dimensionless, shape ``(K,)``
    pressure_flow : ∫(2 − φ_fp) H dP_f, dimensionless, shape ``(K,)``; ∫H dP_f for smooth surfaces
    """

    couette: FloatArray
    pressure_flow: FloatArray


def drag_integrals(
    grid: LineGrid,
    film: FloatArray,
    fluid: FloatArray,
    number: FloatArray,
    height: float,
    flow_factors: FlowFactors | None = None,
    rheology: Rheology | None = None,
    speed: FloatArray | None = None,
    endless: bool = True,
) -> DragIntegrals:
    """Integrate the drag over the computed films, and over the parabola before and behind them.

    The cavity begins where the volume that flows, Q = λ H_c, no longer fills the gap: from there θ = H_c/H. Between the
    highest fluid pressure and the cavity H < H_c, so that θ = min(1, H_c/H) without a search for the place. Far out
    H ≈ h + X²/2, so that ``∫dX/H = √(2/h) [π/2 − atan(X/√(2h))]``, and in the inlet dP_f = λ dX/H². Within a cell the film
    is taken as linear, and the integrals are exact for that.

    Parameters
    ----------
    grid : places, dimensionless
    film : H, dimensionless, shape ``(K, N)``
    fluid : P_f, dimensionless, shape ``(K, N)``
    number : λ, dimensionless, shape ``(K,)``
    height : unit of H, b²/Rc, m
    flow_factors, rheology : None for trivial ones and for a Newtonian liquid
    speed : v, m/s, shape ``(K,)``; needed with a rheology
    endless : count the parabola before and behind, too

    Returns
    -------
    drag : `DragIntegrals`

    References
    ----------
    Persson & Scaraggi, Eur. Phys. J. E 34 (2011) 113, doi 10.1140/epje/i2011-11113-9.

    Examples
    --------
    A parabola H = (1 + X²)/2 with a cavity behind its middle: π in the inlet and, with θ = H_c/H, π/2 behind.

    >>> import numpy as np
    >>> from skinbayes.lubrication.grid import line_grid
    >>> grid = line_grid(20.0, 20.0, 2001, 0.3)
    >>> film, pressure = (1 + grid.position**2) / 2, 1e-9 * np.exp(-(grid.position**2))
    >>> print(f"{drag_integrals(grid, film[None], pressure[None], np.ones(1), 1.0).couette[0] / np.pi:.3f}")
    1.500
    """
    factors = flow_factors if flow_factors is not None else TrivialFlowFactors()
    separation = film * height
    phi, _, shear, _ = factors.flow(separation)
    weights = factors.friction(separation)
    thickness = np.ones_like(film)
    if rheology is not None and speed is not None:
        thickness = rheology.relative(speed[:, None] / np.maximum(separation, 1e-300))[0]
    mean = between(film)
    middle = film[:, 1:] * film[:, :-1] / mean
    spread = _spread(film)  # ∫dX/H of a cell over its width/mean
    fall = np.diff(fluid, axis=1)
    conduct = between(phi / thickness)

    peak = np.argmax(fluid[:, 1:-1], axis=1) + 1
    flow = (
        middle
        + between(shear) / height
        - conduct * middle * middle * mean * fall / (grid.spacing * number[:, None])
    )
    carried = flow[np.arange(film.shape[0]), peak]
    behind = np.arange(film.shape[1]) > peak[:, None]
    liquid = np.where(behind, np.minimum(1.0, carried[:, None] / (film + shear / height)), 1.0)
    stress = between(weights.shear * thickness * liquid)
    couette = (stress * spread / mean * grid.spacing).sum(axis=1)

    wet = (fluid[:, 1:] > _EMPTY) | (fluid[:, :-1] > _EMPTY)
    rise = np.where(wet, number[:, None] * grid.spacing * (spread - 1) / mean / conduct, 0.0)
    pressure_flow = (between(2 - weights.pressure) * (middle * fall + rise)).sum(axis=1)

    if not endless:
        return DragIntegrals(couette, pressure_flow)
    start, end = grid.position[0], grid.position[-1]
    tail = _tail(-start, film[:, 0] - start**2 / 2)
    return DragIntegrals(couette + tail + carried * 4 / (3 * end**3), pressure_flow + number * tail)


def between(values: FloatArray) -> FloatArray:
    """Means of neighbours along the last axis."""
    return np.asarray((values[..., 1:] + values[..., :-1]) / 2)


def _spread(film: FloatArray) -> FloatArray:
    """Arithmetic over logarithmic mean of neighbours, artanh(d)/d with d = (H2 − H1)/(H2 + H1)."""
    d = (film[:, 1:] - film[:, :-1]) / (film[:, 1:] + film[:, :-1])
    small = np.abs(d) < 1e-3
    return np.where(small, 1 + d * d / 3, np.arctanh(d) / np.where(small, 1.0, d))


def _tail(start: float, lift: FloatArray) -> FloatArray:
    """∫dX/(h + X²/2) from ``start`` on, for h of either sign but above −start²/2."""
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.sqrt(2 * np.abs(lift))
        above = 2 / root * np.arctan2(root, start)
        below = 2 / root * np.arctanh(np.minimum(root / start, 1 - 1e-12))
    return np.where(root > 1e-6 * start, np.where(lift > 0, above, below), 2 / start)
