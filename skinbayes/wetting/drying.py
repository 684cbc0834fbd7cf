"""Friction of skin while a water film evaporates."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.friction import friction_coefficient
from skinbayes.wetting._falling import falling_root
from skinbayes.wetting.film_contact import FilmContact

_SEARCH = 192
_NO_SPREAD = 1e-12  # m
_GONE = -40.0  # standard deviations below 0 at which nothing is left of a film
_EVEN = 1 / 3  # of a film that its spread can be: beyond, more of it would lie on the track than there is
_NO_PEAK = 1e-6  # height of a peak over the wet plateau, relative, below which there is none


class DryingCurve(NamedTuple):
    """Drying skin at given times.

    Attributes
    ----------
    film_thickness : mean film over the track, m
    relative_contact_area : A/A0 averaged over the track, dimensionless
    friction_coefficient : μ, dimensionless
    flooded_fraction : fraction of the track that is flooded, dimensionless
    dry_fraction : fraction of the track without film, dimensionless; the rest is bridged
    """

    film_thickness: FloatArray
    relative_contact_area: FloatArray
    friction_coefficient: FloatArray
    flooded_fraction: FloatArray
    dry_fraction: FloatArray


class DryingFeatures(NamedTuple):
    """What a drying curve looks like.

    Attributes
    ----------
    peak_time : time of the largest friction while the film gets thinner, s; nan without a peak
    peak_friction : μ there, dimensionless; nan without a peak
    peak_width : time between the half heights of the peak over the wet plateau, s; nan without a peak
    wet_plateau : μ of flooded skin, dimensionless
    dry_friction : μ of dry skin, dimensionless
    dry_time : time at which the mean film is gone, s; nan if nothing evaporates
    """

    peak_time: FloatArray
    peak_friction: FloatArray
    peak_width: FloatArray
    wet_plateau: FloatArray
    dry_friction: FloatArray
    dry_time: FloatArray


def drying_curve(
    time: ArrayLike,
    wetting_time: ArrayLike,
    *,
    initial_film: ArrayLike,
    evaporation_rate: ArrayLike,
    contact: FilmContact,
    frictional_shear_stress: ArrayLike,
    nominal_pressure: ArrayLike,
    film_spread: ArrayLike = 2e-7,
) -> DryingCurve:
    """Film, contact area and friction of skin that is wetted at some time and dries (Sect. 5 and Fig. 7 of the paper).

    Skin is dry before it is wetted. Then the film falls as ``film = initial_film − rate (t − t_wet)``, and
    ``μ = σ_f A/(A0 p0)`` with the contact area at that film. The film is uneven: over the track it is normally distributed
    about its mean with a standard deviation that does not change, since all of it evaporates alike.

    Parameters
    ----------
    time : t, s, shape ``(T,)`` or ``(..., T)``, or a scalar; may be infinite
    wetting_time : t_wet, s, batch shape; inf is never
    initial_film : film right after wetting, m, ≥ 0, batch shape; inf never dries
    evaporation_rate : ḋ, m/s, ≥ 0, batch shape
    contact : of `film_contact`, batch shape
    frictional_shear_stress : σ_f, Pa, ≥ 0, batch shape
    nominal_pressure : p0, Pa, > 0, batch shape
    film_spread : standard deviation of the film over the track, m, ≥ 0, batch shape. It smooths where skin floods and
        falls dry; without it friction has a kink and a jump there. A film that is thin when it is laid down is more even, to a
        third of itself: it cannot lie anywhere thicker than there is water for, and none at all leaves the skin dry.

    Returns
    -------
    curve : `DryingCurve`, batch shape, plus the axis of ``time`` if it has one; nan where a parameter is impossible

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5).

    Examples
    --------
    >>> from math import radians
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> from skinbayes.wetting import film_contact
    >>> surface = named_surface("paper_reference")
    >>> skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> contact = film_contact(6830.0, surface, skin=skin, surface_tension=0.0727,
    ...     contact_angle_skin=radians(80.0), contact_angle_counterface=0.0, young_modulus_layer_dry=1e9,
    ...     yield_stress=50e6)
    >>> curve = drying_curve([0.0, 200.0, 500.0, 600.0], 30.0, initial_film=90e-6, evaporation_rate=1.743e-7,
    ...     contact=contact, frictional_shear_stress=15e6, nominal_pressure=6830.0)
    >>> print(curve.friction_coefficient.round(3))
    [0.3   1.423 2.28  0.3  ]
    """
    scalar = np.ndim(time) == 0
    times = np.atleast_1d(np.asarray(time, dtype=np.float64))
    arguments = (wetting_time, initial_film, evaporation_rate, film_spread, nominal_pressure)
    start, film, rate, spread, load = (np.asarray(x, dtype=np.float64)[..., None] for x in arguments)
    with np.errstate(all="ignore"):
        possible = (film >= 0) & (rate >= 0) & (rate < np.inf) & (spread >= 0) & (spread < np.inf)
        elapsed = np.maximum(times - start, 0.0)
        mean = np.where(possible, film - np.where(rate > 0, rate * elapsed, 0.0 * np.isnan(elapsed)), np.nan)
        spread = np.minimum(spread, _EVEN * film)
        width = np.maximum(spread, _NO_SPREAD)
        wet = times >= start
        dry_area = np.asarray(contact.dry_area)[..., None]
        area = np.where(wet, contact.average(mean, spread[..., 0])[0], dry_area)
        low, high = contact.film[..., :1], contact.film[..., -1:]
        place = mean / width
        left = mean * ndtr(place) + width * np.exp(-0.5 * np.square(place)) / np.sqrt(2 * np.pi)
        film_left = np.where(place < _GONE, 0.0, left)
        friction = friction_coefficient(
            np.asarray(frictional_shear_stress)[..., None], area, nominal_pressure=load
        )
        found = (
            np.where(wet, film_left, 0.0),
            area,
            friction,
            np.where(wet, ndtr((mean - high) / width), 0.0),
            np.where(wet, ndtr((low - mean) / width), 1.0),
        )
        known = ~np.isnan(mean + area + friction)
        shown = np.broadcast_arrays(*(np.where(known, x, np.nan) for x in found))
        return DryingCurve(*((x[..., 0] if scalar else x.copy())[()] for x in shown))


def drying_features(
    wetting_time: ArrayLike,
    initial_film: ArrayLike,
    *,
    evaporation_rate: ArrayLike,
    contact: FilmContact,
    frictional_shear_stress: ArrayLike,
    nominal_pressure: ArrayLike,
    film_spread: ArrayLike = 2e-7,
) -> DryingFeatures:
    """Times and heights that characterise a drying curve (Sect. 5 and Fig. 7 of the paper).

    Parameters
    ----------
    wetting_time : t_wet, s, batch shape
    initial_film : film right after wetting, m, ≥ 0, batch shape; if it is thinner than the film of the peak the peak has passed,
        and its time lies before ``wetting_time``
    evaporation_rate : ḋ, m/s, ≥ 0, batch shape; at 0 there is neither a peak nor a time at which the skin is dry
    contact : of `film_contact`, batch shape
    frictional_shear_stress : σ_f, Pa, ≥ 0, batch shape
    nominal_pressure : p0, Pa, > 0, batch shape
    film_spread : standard deviation of the film over the track, m, ≥ 0, batch shape; that of a film laid down thick enough for
        it, see `drying_curve`

    Returns
    -------
    features : `DryingFeatures`, batch shape; nan where a parameter is impossible

    Notes
    -----
    The peak is the zero of the derivative of the averaged curve, the half heights are roots of it, each to 1e-9 of the film: none
    sits on a grid. The timing does not depend on σ_f.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5).

    Examples
    --------
    >>> from math import radians
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> from skinbayes.wetting import film_contact
    >>> surface = named_surface("paper_reference")
    >>> skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> contact = film_contact(6830.0, surface, skin=skin, surface_tension=0.0727,
    ...     contact_angle_skin=radians(80.0), contact_angle_counterface=0.0, young_modulus_layer_dry=1e9,
    ...     yield_stress=50e6)
    >>> features = drying_features(30.0, 90e-6, evaporation_rate=1.743e-7, contact=contact,
    ...     frictional_shear_stress=15e6, nominal_pressure=6830.0)
    >>> print(f"{features.peak_time:.1f} {features.peak_friction:.3f} {features.peak_width:.1f} {features.dry_time:.1f}")
    513.2 2.319 66.5 546.4
    """
    arguments = (wetting_time, initial_film, evaporation_rate, film_spread)
    start, film, rate, spread = (np.asarray(x, dtype=np.float64) for x in arguments)
    with np.errstate(all="ignore"):
        possible = (
            (film >= 0) & (film < np.inf) & (rate >= 0) & (rate < np.inf) & (spread >= 0) & (spread < np.inf)
        )
        possible = possible & np.isfinite(start)
        film, spread = np.where(possible, film, np.nan), np.where(possible, spread, np.nan)
        floor, flooded = (x + 0.0 * film for x in (contact.film[..., 0], contact.film[..., -1]))
        plateau, dry = contact.area[..., -1] + 0.0 * film, contact.dry_area + 0.0 * film
        low, high = floor - 4 * spread, flooded + 4 * spread
        grid = low[..., None] + (high - low)[..., None] * np.linspace(0.0, 1.0, _SEARCH)
        areas = contact.average(grid, spread)[0]
        top = np.clip(np.argmax(areas, axis=-1), 1, _SEARCH - 2)[..., None]
        left, right = (np.take_along_axis(grid, top + i, axis=-1)[..., 0] for i in (-1, 1))

        def slope(place: FloatArray) -> FloatArray:
            return contact.average(place[..., None], spread)[1][..., 0]

        peak = falling_root(slope, left, right)
        height = contact.average(peak[..., None], spread)[0][..., 0]
        middle = (height + plateau) / 2

        def above(place: FloatArray) -> FloatArray:
            return np.asarray(contact.average(place[..., None], spread)[0][..., 0] - middle)

        rise = falling_root(above, peak, high)
        # the crossing on the dry side nearest to the peak
        order = np.arange(_SEARCH)
        under = (areas < middle[..., None]) & (order < top)
        last = np.where(under.any(axis=-1), _SEARCH - 1 - under[..., ::-1].argmax(axis=-1), 0)[..., None]
        edge = np.take_along_axis(grid, last, axis=-1)[..., 0]
        fall = falling_root(lambda x: -above(x), edge, np.minimum(edge + (high - low) / (_SEARCH - 1), peak))
        dries = possible & (rate > 0)
        there = dries & (height > plateau * (1 + _NO_PEAK))
        friction = [
            friction_coefficient(frictional_shear_stress, x, nominal_pressure=nominal_pressure)
            for x in (height, plateau, dry)
        ]
        found = (
            np.where(there, start + (film - peak) / rate, np.nan),
            np.where(there, friction[0], np.nan),
            np.where(there, (rise - fall) / rate, np.nan),
            np.where(possible, friction[1], np.nan),
            np.where(possible, friction[2], np.nan),
            np.where(dries, start + film / rate, np.nan),
        )
        return DryingFeatures(*(x.copy()[()] for x in np.broadcast_arrays(*found)))
