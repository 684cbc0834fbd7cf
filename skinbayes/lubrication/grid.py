"""Nodes of the line contact and the deflection that pressures at them cause."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.moving_kernel import hat_integrals

_EDGES = np.array([-1.0, 1.0])  # of the Hertz contact, where films and pressures change fastest
_TURNS = np.linspace(-16.0, 16.0, 641)


class LineGrid(NamedTuple):
    """Places across a line contact of half-width 1, graded towards its edges.

    Attributes
    ----------
    position : X = x/b, rising, dimensionless, shape ``(N,)``
    spacing : differences of X, dimensionless, shape ``(N − 1,)``
    weight : of the trapezoidal rule, dimensionless, shape ``(N,)``
    kernel : deflection at each node by a unit pressure at each node, dimensionless, shape ``(N, N)``, columns contiguous
    """

    position: FloatArray
    spacing: FloatArray
    weight: FloatArray
    kernel: FloatArray


def line_grid(inlet: float, outlet: float, count: int, edge_width: float) -> LineGrid:
    """Nodes from ``−inlet`` to ``outlet``, equally spaced in ``arsinh((X+1)/ε) + arsinh((X−1)/ε)``.

    The spacing is finest, and even, within ε of the edges of the Hertz contact, and grows in proportion to the distance
    from them: every scale between ε and the inlet gets the same number of nodes.

    Parameters
    ----------
    inlet : distance of the first node from the middle of the contact, dimensionless, > 1
    outlet : distance of the last node, dimensionless, > 1
    count : N, number of nodes, dimensionless
    edge_width : ε, dimensionless, > 0

    Returns
    -------
    grid : `LineGrid`

    References
    ----------
    Johnson, Contact Mechanics (1985), Chap. 2, doi 10.1017/CBO9781139171731 (deflection under a line pressure).

    Examples
    --------
    >>> grid = line_grid(4.0, 2.0, 65, 0.1)
    >>> print(grid.position[[0, -1]], f"{grid.spacing.min():.4f} {grid.spacing.max():.3f}")
    [-4.  2.] 0.0236 0.434
    """
    fine = np.unique(np.concatenate([edge + edge_width * np.sinh(_TURNS) for edge in _EDGES]))
    fine = np.concatenate([[-inlet], fine[(fine > -inlet) & (fine < outlet)], [outlet]])
    level = np.arcsinh((fine[:, None] - _EDGES) / edge_width).sum(axis=1)
    position = np.interp(np.linspace(level[0], level[-1], count), level, fine)
    for _ in range(4):  # Newton: the interpolation is close already
        offset = (position[:, None] - _EDGES) / edge_width
        miss = np.arcsinh(offset).sum(axis=1) - np.linspace(level[0], level[-1], count)
        position = position - miss * edge_width / (1 / np.hypot(offset, 1)).sum(axis=1)
    position[[0, -1]] = -inlet, outlet
    spacing = np.diff(position)
    weight = np.zeros(count)
    weight[:-1] += spacing / 2
    weight[1:] += spacing / 2
    return LineGrid(position, spacing, weight, np.asfortranarray(log_kernel(position)))


def log_kernel(position: FloatArray) -> FloatArray:
    """``(1/π) ∫ φ_j(X′) ln|X_i − X′| dX′`` for the piecewise linear hat functions φ_j, integrated exactly.

    Parameters
    ----------
    position : X of the nodes, rising, dimensionless, shape ``(N,)``

    Returns
    -------
    kernel : dimensionless, shape ``(N, N)``; the deflection is minus the kernel times the pressures

    References
    ----------
    Johnson, Contact Mechanics (1985), Chap. 2, doi 10.1017/CBO9781139171731.

    Examples
    --------
    A pressure 1 on [0, 1] seen from its end: ∫ ln X′ dX′ = −1.

    >>> import numpy as np
    >>> print((np.pi * log_kernel(np.linspace(0.0, 1.0, 5))).sum(axis=1)[0].round(12))
    -1.0
    """
    offset = position[:, None] - position
    with np.errstate(divide="ignore"):
        logarithm = np.where(offset == 0, 0.0, np.log(np.abs(offset)))
    # integrals of ln|t| over t, once and twice
    once = offset * (logarithm - 1)
    twice = np.square(offset) * (logarithm / 2 - 0.75)
    return hat_integrals(position, once, twice) / np.pi
