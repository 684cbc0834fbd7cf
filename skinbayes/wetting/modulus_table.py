"""A measured table of the modulus of the stratum corneum against humidity."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from skinbayes.arrays import ArrayLike, FloatArray, floats
from skinbayes.errors import InputError


def young_modulus_from_table(
    relative_humidity: ArrayLike, table_humidity: ArrayLike, *, table_modulus: ArrayLike
) -> FloatArray:
    """Young's modulus of the stratum corneum from a table of your own, ln E0 interpolated against RH (for Fig. 17 of the paper).

    A cubic in each interval that neither overshoots nor turns between the points (Fritsch and Carlson).

    Parameters
    ----------
    relative_humidity : RH, dimensionless, 0 … 1, any shape
    table_humidity : RH of the points, ascending, dimensionless, 0 … 1, shape ``(K,)`` with K ≥ 2
    table_modulus : E0 of the points, Pa, > 0, shape ``(K,)``

    Returns
    -------
    young_modulus : Pa, shape of ``relative_humidity``; nan beyond the ends of the table

    Raises
    ------
    InputError
        The table has fewer than two points, does not ascend, or has an impossible value.

    References
    ----------
    Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980) 238, doi 10.1137/0717021 (Sect. 4).

    Examples
    --------
    >>> moduli = young_modulus_from_table([0.3, 0.6, 0.75, 0.99], [0.3, 0.6, 0.9], table_modulus=[1e9, 4e8,
    ...     1e7])
    >>> print((moduli / 1e6).round(1))
    [1000.   400.    99.3    nan]
    """
    places, moduli = floats(table_humidity, table_modulus)
    if places.ndim != 1 or places.shape != moduli.shape or places.size < 2:
        raise InputError(
            f"table of moduli: {places.size} humidities and {moduli.size} moduli; expected as many of each, two at least"
        )
    if not ((places >= 0) & (places <= 1)).all() or not (np.diff(places) > 0).all():
        raise InputError("table of moduli: the humidities must ascend and lie between 0 and 1 (100 %)")
    if not ((moduli > 0) & (moduli < np.inf)).all():
        raise InputError("table of moduli: the moduli must be positive and finite")
    curve = PchipInterpolator(places, np.log(moduli), extrapolate=False)
    return np.asarray(np.exp(curve(np.asarray(relative_humidity, dtype=np.float64))))[()]
