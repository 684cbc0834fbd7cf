"""Response of any number of bonded layers, elastic or viscoelastic, from one recursion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np

from skinbayes.arrays import ArrayLike, ComplexArray, FloatArray

Matrix: TypeAlias = "tuple[tuple[Any, Any], tuple[Any, Any]]"
"""2 × 2 arrays of numbers that broadcast."""


def layered_modulus(
    wavevector: ArrayLike,
    *,
    moduli: Sequence[ArrayLike],
    poisson_ratios: Sequence[ArrayLike],
    thicknesses: Sequence[ArrayLike],
) -> FloatArray | ComplexArray:
    """Plane-strain modulus felt by wavevector q at the surface of any number of bonded layers on a half-space (Eq. 4 for one).

    From the half-space up, each layer turns the 2 × 2 stiffness of what lies below, tractions over displacements, into that
    of its own top; solutions that grow and that decay with depth are counted from the face at which they are largest, so
    that thick layers lose no digits.

    Parameters
    ----------
    wavevector : q, 1/m, > 0, shape ``(K,)``, or any
    moduli : Young's moduli from the surface down, the half-space last, Pa; complex where they dissipate; each a number or
        an array that broadcasts with ``wavevector``
    poisson_ratios : ν of each, dimensionless, −1 < ν ≤ 0.5, likewise
    thicknesses : d of each but the half-space, m, > 0, likewise

    Returns
    -------
    layered_modulus : E_eff(q), Pa, of the broadcast shape, with one axis at least; complex if an argument is

    Notes
    -----
    Agrees with `effective_modulus` of `LayeredSkin` to 5e-13 for E0/E1 up to 1e3 and to 3e-9 up to 1e7.

    References
    ----------
    Johnson, Contact Mechanics (1985), Chap. 2, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> print(layered_modulus([1e2, 1e5], moduli=[7e6, 1e5, 20e3], poisson_ratios=[0.5] * 3, thicknesses=[2e-5, 1e-3]).round())
    [  26734. 5556472.]
    """
    q = np.atleast_1d(wavevector)
    ratios = [np.asarray(nu, dtype=np.float64) for nu in poisson_ratios]
    shear = [np.asarray(m) / (2 * (1 + nu)) for m, nu in zip(moduli, ratios, strict=True)]
    with np.errstate(all="ignore"):
        unit = shear[0]
        u, t = _decaying(np.zeros_like(q), ratios[-1])
        stiffness = _scaled(shear[-1] / unit, _product(t, _inverse(u)))
        for g, nu, d in zip(shear[-2::-1], ratios[-2::-1], thicknesses[::-1], strict=True):
            relative, x = g / unit, q * d
            fall = np.exp(-x)
            start_u, start_t = _decaying(0 * x, nu)
            down_u, down_t = _decaying(x, nu)
            hindered = _sum(
                _scaled(-relative, _upside_down(start_t, -1)), _product(stiffness, _upside_down(start_u, 1))
            )
            driven = _sum(_scaled(relative, down_t), _scaled(-1.0, _product(stiffness, down_u)))
            reflected = _scaled(fall, _product(_inverse(hindered), driven))
            displacement = _sum(start_u, _scaled(fall, _product(_upside_down(down_u, 1), reflected)))
            traction = _sum(start_t, _scaled(fall, _product(_upside_down(down_t, -1), reflected)))
            stiffness = _product(_scaled(relative, traction), _inverse(displacement))
        return np.asarray(-4 * unit / _inverse(stiffness)[1][1])  # of tractions over 2Gq


def _product(a: Matrix, b: Matrix) -> Matrix:
    (a00, a01), (a10, a11) = a
    (b00, b01), (b10, b11) = b
    return (
        (a00 * b00 + a01 * b10, a00 * b01 + a01 * b11),
        (a10 * b00 + a11 * b10, a10 * b01 + a11 * b11),
    )


def _inverse(a: Matrix) -> Matrix:
    (a00, a01), (a10, a11) = a
    determinant = a00 * a11 - a01 * a10
    return (a11 / determinant, -a01 / determinant), (-a10 / determinant, a00 / determinant)


def _sum(a: Matrix, b: Matrix) -> Matrix:
    (a00, a01), (a10, a11) = a
    (b00, b01), (b10, b11) = b
    return (a00 + b00, a01 + b01), (a10 + b10, a11 + b11)


def _scaled(factor: Any, a: Matrix) -> Matrix:
    (a00, a01), (a10, a11) = a
    return (factor * a00, factor * a01), (factor * a10, factor * a11)


def _upside_down(a: Matrix, sign: int) -> Matrix:
    """Displacements (sign 1) or tractions (−1) seen upside down: vertical ones change sign, or horizontal ones."""
    (a00, a01), (a10, a11) = a
    return (sign * a00, sign * a01), (-sign * a10, -sign * a11)


def _decaying(x: Any, nu: Any) -> tuple[Matrix, Matrix]:
    """Displacements and tractions over 2Gq of the two solutions that decay with x = qz, without exp(−x).

    Rows are horizontal and vertical, with the horizontal ones a quarter of a wavelength ahead.
    """
    one = np.ones_like(x)
    displacements = (one, -x), (-one, x + 3 - 4 * nu)
    tractions = (-one, x + 1 - 2 * nu), (one, -(x + 2 - 2 * nu))
    return displacements, tractions
