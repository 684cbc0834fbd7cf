"""Quadrature against the measure q³ C(q) dq of a tabulated spectrum."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.roughness._rules import gauss_unit

_PANEL_WIDTH = 0.7  # largest width of a panel, in ln q
_PANEL_NODES, _ = gauss_unit(8)
_CELL_NODES, _CELL_WEIGHTS = gauss_unit(8)


class ProductRule:
    """Nodes on panels of ln q, and weights that integrate polynomials on each panel against q³ C dq.

    f in ``∫ q³ C f dq`` is smooth, C is not: so f is replaced on each panel by the polynomial through its
    values at the nodes, and the integrals of the Lagrange polynomials against q³ C are done cell by cell of
    the table, once.

    Parameters
    ----------
    table : nodes of the table, 1/m, shape ``(K,)``
    power : C(q) in m^4 as a function of q
    """

    def __init__(self, table: FloatArray, power: Callable[[FloatArray], FloatArray]) -> None:
        self._power = power
        first, last = float(np.log(table[0])), float(np.log(table[-1]))
        count = int(np.ceil((last - first) / _PANEL_WIDTH))
        edges = np.linspace(first, last, count + 1)
        self._edges, self._width = edges[:-1], (last - first) / count
        self.nodes: FloatArray = np.exp(self._edges[:, None] + self._width * _PANEL_NODES).reshape(-1)
        # cells end at the nodes of the table and at the edges of panels
        self._breaks = np.union1d(np.log(table), edges)
        left, right = self._breaks[:-1], self._breaks[1:]
        self._panel = np.clip(np.searchsorted(edges, (left + right) / 2) - 1, 0, count - 1)
        fractions = self._fractions(left, right, self._panel)
        starts = np.searchsorted(self._panel, np.arange(count))
        per_panel = np.add.reduceat(fractions, starts, axis=0)
        self.full: FloatArray = per_panel.reshape(-1)
        # what lies left of each cell within its panel
        before = np.cumsum(fractions, axis=0) - fractions
        self._before = before - before[starts][self._panel]
        self._cell_count = left.size

    def _fractions(self, left: FloatArray, right: FloatArray, panel: FloatArray) -> FloatArray:
        """Integrals of the Lagrange polynomials of ``panel`` against q³ C from ``left`` to ``right`` (of ln q)."""
        points = left[..., None] + (right - left)[..., None] * _CELL_NODES
        q = np.exp(points)
        measure = (right - left)[..., None] * _CELL_WEIGHTS * q**4 * self._power(q)
        place = (points - self._edges[panel][..., None]) / self._width
        return np.asarray((measure[..., None] * _lagrange(place)).sum(axis=-2))

    def up_to(self, wavevector: FloatArray) -> FloatArray:
        """Weights for the integral from the first node to ``wavevector`` (1/m), shape ``(..., K, n)``."""
        with np.errstate(all="ignore"):
            end = np.clip(np.log(wavevector), self._breaks[0], self._breaks[-1])
        cell = np.clip(np.searchsorted(self._breaks, end, side="right") - 1, 0, self._cell_count - 1)
        panel = self._panel[cell]
        partial = self._before[cell] + self._fractions(self._breaks[cell], end, panel)
        per_panel = self.full.reshape(-1, _PANEL_NODES.size)
        panels = np.arange(per_panel.shape[0])[:, None]
        here = panel[..., None, None]
        weights = np.where(panels < here, per_panel, np.where(panels == here, partial[..., None, :], 0.0))
        return np.asarray(weights.reshape((*end.shape, -1)))


def _lagrange(place: FloatArray) -> FloatArray:
    """Values of the Lagrange polynomials of the panel nodes at ``place`` (0 … 1), shape ``(..., 8)``."""
    values = np.empty((*place.shape, _PANEL_NODES.size))
    for k, node in enumerate(_PANEL_NODES):
        others = np.delete(_PANEL_NODES, k)
        values[..., k] = np.prod((place[..., None] - others) / (node - others), axis=-1)
    return values
