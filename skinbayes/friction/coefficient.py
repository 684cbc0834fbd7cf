"""From the area of real contact to the friction coefficient."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray, floats


def friction_coefficient(
    frictional_shear_stress: ArrayLike, relative_contact_area: ArrayLike, *, nominal_pressure: ArrayLike
) -> FloatArray:
    """Friction coefficient at a constant frictional shear stress, ``μ = σ_f A/(A0 p0)`` (Sect. 4 of the paper).

    Parameters
    ----------
    frictional_shear_stress : σ_f, Pa, ≥ 0, any shape
    relative_contact_area : A/A0, dimensionless, ≥ 0, broadcasts
    nominal_pressure : p0, Pa, > 0, broadcasts

    Returns
    -------
    friction_coefficient : μ, dimensionless, broadcast shape; nan where an argument is impossible

    Notes
    -----
    Adhesive friction only: ploughing and hysteresis of the tissue (about 0.05 for skin) are not included.
    Where all contacts have yielded A/A0 = p0/σ_Y and μ = σ_f/σ_Y, whatever the roughness and the moduli.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 4).

    Examples
    --------
    >>> print(f"{friction_coefficient(15e6, 6.48133e-4, nominal_pressure=6830.0):.4f}")
    1.4234
    """
    with np.errstate(all="ignore"):
        return coefficient(*floats(frictional_shear_stress, relative_contact_area, nominal_pressure))


def coefficient(shear: FloatArray, area: FloatArray, pressure: FloatArray) -> FloatArray:
    """`friction_coefficient` of arrays; silences no warnings."""
    possible = (np.minimum(shear, area) >= 0.0) & (pressure > 0.0)
    return np.where(possible, shear * area / pressure, np.nan)[()]
