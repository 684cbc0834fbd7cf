"""Gauss–Legendre rules on the unit interval."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray


def gauss_unit(count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of the Gauss–Legendre rule with ``count`` points on [0, 1], shapes ``(count,)``."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1) / 2, weights / 2
