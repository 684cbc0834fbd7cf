"""A smooth curve through values at equal distances."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from skinbayes.arrays import FloatArray


def natural_spline(place: FloatArray, values: FloatArray) -> FloatArray:
    """The natural cubic spline through ``values`` at equal distances between 0 and 1; constant beyond.

    Parameters
    ----------
    place : where, shape ``(..., K)``
    values : at the knots, shape ``(..., 1, n)`` or ``(..., K, n)``, the knots last

    Returns
    -------
    ndarray
        Shape ``(..., K)``. Linear in the values, so that one set of curves through a 1 at each knot serves a whole batch.
    """
    count = values.shape[-1]
    basis = CubicSpline(np.linspace(0.0, 1.0, count), np.eye(count), bc_type="natural")
    return np.asarray((basis(np.clip(place, 0.0, 1.0)) * values).sum(axis=-1))
