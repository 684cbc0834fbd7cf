"""Viscosities that agree with the films they make, for many points of a table of films at once."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.lubrication.film_contraction import ContractedFilms
from skinbayes.lubrication.flow_curves import LiquidRows

_SCANNED = 8  # parts of the range of ln η searched for the thickest of several films
_ROUNDS, _CLOSE = 60, 1e-9  # of the iteration for ln η


def viscosity_of_films(
    films: ContractedFilms, log_speed: FloatArray, log_shift: FloatArray, liquids: LiquidRows
) -> tuple[FloatArray, FloatArray]:
    """ln η and ln v/u that belong together: Newton steps within a bracket that every step makes smaller.

    ``g(x) = ln η(v/u(x)) − x`` of x = ln η goes from ≥ 0 at the least to ≤ 0 at the largest viscosity of the liquid, and falls
    wherever the shear stress of the liquid rises with the shear rate. Points that are done are left alone: the result of a
    point does not depend on the others.

    Parameters
    ----------
    films : of B vectors and N rows
    log_speed, log_shift : ln v (v in m/s) and ln of the shift factor, shape ``(B, N)``
    liquids : of the N rows

    Returns
    -------
    log_viscosity : ln η, η in Pa s, shape ``(B, N)``; nan where the table does not hold the film
    log_rate : ln v/u, v/u in 1/s, shape ``(B, N)``
    """
    shape = log_speed.shape
    all_films, all_liquids = films.points(shape), liquids.at(np.tile(np.arange(shape[1]), shape[0]))
    offset = (log_speed + log_shift).reshape(-1) + all_films.scales.number_per_product
    known = np.isfinite(offset) & all_films.inside
    shear = log_speed.reshape(-1) - all_films.scales.height  # ln v over the unit of films
    low, high = all_liquids.least.copy(), all_liquids.most.copy()
    falling = np.flatnonzero(all_liquids.falling & known)
    if falling.size:
        low[falling], high[falling] = _uppermost(
            all_films.chosen(falling), shear.take(falling), offset.take(falling), all_liquids.at(falling)
        )
    place, rate = np.full(offset.shape, np.nan), np.full(offset.shape, np.nan)
    moving = np.flatnonzero(known)
    x = (low + high).take(moving) / 2
    low, high, offset, shear = (array.take(moving) for array in (low, high, offset, shear))
    at, of = all_films.chosen(moving), all_liquids.at(moving)
    for count in range(_ROUNDS):
        film, film_slope = at.log_central_film(offset + x)
        log_rate = shear - film
        value, slope = of.log_viscosity(log_rate)
        miss = value - x
        far = np.abs(miss) >= _CLOSE
        near = np.flatnonzero(~far)
        done = moving.take(near)
        place[done], rate[done] = value.take(near), log_rate.take(near)
        if near.size == moving.size:
            break
        low, high = np.where(miss > 0, x, low), np.where(miss < 0, x, high)
        step = x + miss / (1 + slope * film_slope)
        x = np.where((step >= low) & (step <= high), step, (low + high) / 2)
        if count and 4 * near.size >= moving.size:
            left = np.flatnonzero(far)
            moving = moving.take(left)
            x, low, high, offset, shear = (array.take(left) for array in (x, low, high, offset, shear))
            at, of = at.chosen(left), of.at(left)
    return place.reshape(shape), rate.reshape(shape)


def _uppermost(
    films: ContractedFilms, shear: FloatArray, offset: FloatArray, liquids: LiquidRows
) -> tuple[FloatArray, FloatArray]:
    """Bracket of the largest viscosity that agrees with its film, where a falling shear stress may allow several."""
    low, high = liquids.least, liquids.most
    step = (high - low) / _SCANNED
    searching = np.ones(offset.shape, dtype=bool)
    for count in range(1, _SCANNED):
        place = liquids.most - count * step
        film, _ = films.log_central_film(offset + place)
        value, _ = liquids.log_viscosity(shear - film)
        above = value < place
        high = np.where(searching & above, place, high)
        low = np.where(searching & ~above, place, low)
        searching = searching & above
    return low, high
