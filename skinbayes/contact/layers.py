"""Response of any number of bonded layers, elastic or viscoelastic, from one recursion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from skinbayes.arrays import ArrayLike, ComplexArray, FloatArray


def layered_modulus(
    wavevector: ArrayLike,
    *,
    moduli: Sequence[ArrayLike],
    poisson_ratios: Sequence[float],
    thicknesses: Sequence[float],
) -> FloatArray | ComplexArray:
    """Plane-strain modulus felt by wavevector q at the surface of any number of bonded layers on a half-space (Eq. 4 for one).

    From the half-space up, each layer turns the 2 × 2 stiffness of what lies below, tractions over displacements, into that
    of its own top; solutions that grow and that decay with depth are counted from the face at which they are largest, so
    that thick layers lose no digits.

    Parameters
    ----------
    wavevector : q, 1/m, > 0, shape ``(K,)``
    moduli : Young's moduli from the surface down, the half-space last, Pa; complex where they dissipate; each a number or
        of shape ``(K,)``
    poisson_ratios : ν of each, dimensionless, −1 < ν ≤ 0.5
    thicknesses : d of each but the half-space, m, > 0

    Returns
    -------
    layered_modulus : E_eff(q), Pa, shape ``(K,)``, complex if a modulus is

    Notes
    -----
    Agrees with `effective_modulus` of `LayeredSkin` to 1e-13 for E0/E1 up to 1e3 and to 1e-9 up to 1e7.

    References
    ----------
    Johnson, Contact Mechanics (1985), Chap. 2, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> print(layered_modulus([1e2, 1e5], moduli=[7e6, 1e5, 20e3], poisson_ratios=[0.5] * 3, thicknesses=[2e-5, 1e-3]).round())
    [  26734. 5556472.]
    """
    q = np.atleast_1d(np.asarray(wavevector, dtype=np.float64))
    shear = [np.asarray(m) / (2 * (1 + nu)) for m, nu in zip(moduli, poisson_ratios, strict=True)]
    with np.errstate(all="ignore"):
        unit = shear[0]
        u, t = _decaying(np.zeros_like(q), poisson_ratios[-1])
        stiffness = (shear[-1] / unit)[..., None, None] * t @ np.linalg.inv(u)
        for g, nu, d in zip(shear[-2::-1], poisson_ratios[-2::-1], thicknesses[::-1], strict=True):
            relative = np.asarray(g / unit)[..., None, None]
            x = q * d
            fall = np.exp(-x)[:, None, None]
            start_u, start_t = _decaying(0 * x, nu)
            down_u, down_t = _decaying(x, nu)
            reflected = -np.linalg.solve(
                relative * start_t * _TRACTIONS - stiffness @ (start_u * _DISPLACEMENTS),
                (relative * down_t - stiffness @ down_u) * fall,
            )
            displacement = start_u + fall * (down_u * _DISPLACEMENTS @ reflected)
            traction = relative * (start_t + fall * (down_t * _TRACTIONS @ reflected))
            stiffness = traction @ np.linalg.inv(displacement)
        compliance = np.linalg.inv(stiffness)[:, 1, 1]
        return np.asarray(-4 * unit / compliance)  # of tractions over 2Gq


# signs of horizontal and vertical parts of what is seen upside down
_DISPLACEMENTS, _TRACTIONS = np.array([[1.0], [-1.0]]), np.array([[-1.0], [1.0]])


def _decaying(x: FloatArray, nu: float) -> tuple[FloatArray, FloatArray]:
    """Displacements and tractions over 2Gq of the two solutions that decay with x = qz, without exp(−x), ``(K, 2, 2)``.

    Rows are horizontal and vertical, with the horizontal ones a quarter of a wavelength ahead.
    """
    one = np.ones_like(x)
    u = np.array([[one, -x], [-one, x + 3 - 4 * nu]])
    t = np.array([[-one, x + 1 - 2 * nu], [one, -(x + 2 - 2 * nu)]])
    return np.moveaxis(u, -1, 0), np.moveaxis(t, -1, 0)
