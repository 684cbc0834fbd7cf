"""The pressure that holds rough layered skin at a given mean separation."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.correction import AREA_CORRECTION
from skinbayes.contact.separation import sum_separation_and_slope
from skinbayes.contact.separation_grid import separation_grid
from skinbayes.contact.solid import ElasticSolid
from skinbayes.roughness._fields import with_axes
from skinbayes.roughness.spectrum import PowerSpectrum

# ln(p/√V) between which the root is bracketed; below, ū is linear in ln p, above, it is less than 1e-290 m
_BRACKETS = np.concatenate([np.linspace(-24.0, -1.0, 21), np.linspace(-0.5, np.log(25.5), 12)])
_ROUNDS, _CLOSE = 40, 1e-12


def pressure_at_separation(
    separation: ArrayLike,
    spectrum: PowerSpectrum,
    *,
    skin: ElasticSolid,
    area_correction: ArrayLike = AREA_CORRECTION,
) -> FloatArray:
    """Nominal pressure at which the mean separation has a given value, the inverse of `mean_separation`.

    It is what the asperities carry where lubricated skin is held at that separation (Sect. 6.2 of the paper).

    Parameters
    ----------
    separation : ū, m, ≥ 0, shape ``(K,)`` or ``(..., K)``, or a scalar; 0 gives inf
    spectrum : power spectrum, C in m^4, scalar or batched
    skin : moduli in Pa, thickness in m; broadcasts with the spectrum
    area_correction : γ, dimensionless, 0 < γ ≤ 1, batch shape; 1 is plain Persson theory

    Returns
    -------
    nominal_pressure : Pa, batch shape, plus the axis of ``separation`` if it has one; falls with the
        separation, at large ones as exp(−ū/u0); nan where a parameter is impossible

    Notes
    -----
    Newton steps on ``ln(exp(ū/u0) − 1)`` over ln p, which is close to straight in both limits, within a bracket; ln p is
    exact to 1e-12 for the sum that `mean_separation` uses.

    References
    ----------
    Yang & Persson, J. Phys.: Condens. Matter 20 (2008) 215214, doi 10.1088/0953-8984/20/21/215214.

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> print(f"{pressure_at_separation(14e-6, named_surface('paper_reference'), skin=wet):.1f}")
    6290.6
    """
    target = np.asarray(separation, dtype=np.float64)
    gamma = np.asarray(area_correction, dtype=np.float64)
    with np.errstate(all="ignore"):
        grid = separation_grid(spectrum, skin)
        scale = grid.log_twice_variance[..., -1:] / 2
        decay = 2 * with_axes(gamma, 1) * grid.weight.sum(axis=-1, keepdims=True)  # u0

        def straight(mean: FloatArray) -> FloatArray:
            return mean / decay + np.log(-np.expm1(-mean / decay))

        table, slope = sum_separation_and_slope(_BRACKETS + scale, grid, gamma)
        slope = slope / (decay * -np.expm1(-table / decay))
        wanted = np.where(target > 0, target, np.nan)
        goal, level = straight(np.atleast_1d(wanted)), straight(table)
        place, low, high = _start(goal, level, slope)
        moving = np.isfinite(place)
        for _ in range(_ROUNDS):
            mean, slope = sum_separation_and_slope(place + scale, grid, gamma)
            step = (goal - straight(mean)) * (decay * -np.expm1(-mean / decay)) / slope
            place = np.where(moving, np.clip(place + step, low, high), place)
            moving &= np.abs(step) > _CLOSE
            if not moving.any():
                break
        pressure = np.exp(place + scale)
        pressure = pressure if target.ndim else pressure[..., 0]
        good = decay if target.ndim else decay[..., 0]
        return np.where(target == 0, good * np.inf, pressure)[()]


def _start(
    goal: FloatArray, level: FloatArray, slope: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """First guess of ln(p/√V) and its bracket, from the table by cubic interpolation of the inverse function."""
    shape = np.broadcast_shapes(goal.shape[:-1], level.shape[:-1])
    goal = np.broadcast_to(goal, (*shape, goal.shape[-1]))
    level, slope = (np.broadcast_to(x, (*shape, x.shape[-1])) for x in (level, slope))
    above = np.count_nonzero(level[..., None, :] > goal[..., None], axis=-1)
    cell = np.clip(above - 1, 0, _BRACKETS.size - 2)
    left, right = (np.take_along_axis(level, c, axis=-1) for c in (cell, cell + 1))
    start, end = (1 / np.take_along_axis(slope, c, axis=-1) for c in (cell, cell + 1))
    low, high = _BRACKETS[cell], _BRACKETS[cell + 1]
    width = right - left
    w = (goal - left) / width
    curved = w * (1 - w) * ((1 - w) * (start * width - (high - low)) - w * (end * width - (high - low)))
    inside = np.clip(low + w * (high - low) + curved, low, high)
    far = above == 0  # the function is a straight line there
    guess = np.where(far, low + (goal - left) * start, inside)
    return guess, np.where(far, -np.inf, low), high
