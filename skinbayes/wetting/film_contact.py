"""Contact area of skin over the thickness of the water film, from flooded over bridged to dry."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import prod
from typing import cast

import numpy as np

from skinbayes.arrays import ArrayLike, BoolArray, FloatArray, floats
from skinbayes.contact import (
    AREA_CORRECTION,
    ElasticSolid,
    LayeredSkin,
    total_contact_area,
    twice_stress_variance,
)
from skinbayes.contact.gaps import CLOSURES
from skinbayes.emulation.chebyshev import coefficients, lobatto, series, values_between
from skinbayes.errors import InputError
from skinbayes.roughness import rms_height
from skinbayes.roughness.spectrum import PowerSpectrum
from skinbayes.wetting._bridged import Bridged
from skinbayes.wetting._gaps import Closure, GapSource, batch_shapes, map_skin, map_spectrum
from skinbayes.wetting._uneven import uneven_average
from skinbayes.wetting.bridge_table import BridgeTable
from skinbayes.wetting.capillary import cosine_sum

FILM_FLOOR = 1e-7
"""Film below which skin counts as dry, m."""

_FILMS, _POINTS, _MODULI = 32, 256, 12
_NO_SPREAD = 1e-12  # m
_CLOSED = 1e-30  # stands for a flooded film of 0, m: where contact is complete there is no gap


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmContact:
    """Contact area against the local thickness of the film: dry below the first film, flooded from the last on.

    Attributes
    ----------
    film : from the floor to the flooded film, ascending, m, shape ``S + (n,)``
    area : A/A0 at ``film``, dimensionless, shape ``S + (n,)``
    dry_area : A/A0 without water, dimensionless, shape ``S``

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5).
    """

    film: FloatArray
    area: FloatArray
    dry_area: FloatArray

    def average(self, film: FloatArray, spread: FloatArray) -> tuple[FloatArray, FloatArray]:
        """A/A0 and its derivative along the film, 1/m, averaged over a track with an uneven film.

        Parameters
        ----------
        film : mean film, m, may be negative after the film is gone, and infinite, shape ``S + (T,)``
        spread : standard deviation of the film over the track, m, ≥ 0, shape ``S``

        Returns
        -------
        area, slope : dimensionless and 1/m, shape ``S + (T,)``; nan where an argument is impossible
        """
        films, wide = np.asarray(film, dtype=np.float64), np.asarray(spread, dtype=np.float64)
        width = np.where((wide >= 0) & (wide < np.inf), np.maximum(wide, _NO_SPREAD), np.nan)
        batch = np.broadcast_shapes(films.shape[:-1], self.dry_area.shape, width.shape)
        shape = (*batch, films.shape[-1])
        place, wide = (
            np.broadcast_to(films, shape).reshape(prod(batch), shape[-1]),
            np.broadcast_to(width[..., None], shape).reshape(prod(batch), shape[-1]),
        )
        edge, local = (
            np.broadcast_to(x, (*batch, x.shape[-1])).reshape(-1, x.shape[-1]) for x in (self.film, self.area)
        )
        dry = np.broadcast_to(self.dry_area, batch).reshape(-1)
        area, slope = uneven_average(edge, local, dry, place, wide)
        return area.reshape(shape), slope.reshape(shape)


def film_contact(
    nominal_pressure: ArrayLike,
    spectrum: PowerSpectrum,
    *,
    skin: ElasticSolid,
    surface_tension: ArrayLike,
    contact_angle_skin: ArrayLike,
    contact_angle_counterface: ArrayLike,
    young_modulus_layer_dry: ArrayLike | None = None,
    yield_stress: ArrayLike,
    area_correction: ArrayLike = AREA_CORRECTION,
    closure: Closure = "gaussian",
    film_floor: ArrayLike = FILM_FLOOR,
    hardening_film: ArrayLike | None = None,
    hardening_sharpness: ArrayLike = 2.0,
    table: BridgeTable | None = None,
) -> FilmContact:
    """Contact area of drying skin against the film, flooded, bridged and dry (Sect. 5 and Figs. 8 and 9 of the paper).

    Flooded skin carries p0 alone, bridged skin p0 and the capillary pressure of `capillary_state`, dry skin p0 with the modulus
    of dry stratum corneum, other solids with their own; the area of each is elastoplastic. Skin counts as dry below
    ``film_floor``.

    Parameters
    ----------
    nominal_pressure : p0, Pa, > 0, batch shape
    spectrum : power spectrum, C in m^4, scalar or batched
    skin : wet skin, moduli in Pa, thickness in m; broadcasts with the spectrum
    surface_tension : γ_w, N/m, ≥ 0, batch shape
    contact_angle_skin : θ1, rad, 0 … π, batch shape
    contact_angle_counterface : θ2, rad, 0 … π, batch shape
    young_modulus_layer_dry : E0 of the dry layer, Pa, > 0, batch shape; None for a solid that does not harden as it dries
    yield_stress : σ_Y, Pa, > 0, batch shape; inf is purely elastic
    area_correction : γ, dimensionless, 0 < γ ≤ 1, batch shape
    closure : P(u) from Gaussians (default) or from sharp gaps, see `gap_distribution`
    film_floor : film below which skin is dry, m, > 0, batch shape; at most half of the flooded film is used
    hardening_film : film at which ln E0 is half way between wet and dry, m, > 0, batch shape; None keeps the layer wet
        down to the floor. E0 is the wet one where the gap is flooded.
    hardening_sharpness : k of the weight ``w^k/(1 + w^k)``, w = film over ``hardening_film``, of the wet modulus,
        dimensionless, > 0, batch shape
    table : curves solved beforehand by `bridge_table`, for the Gaussian closure; skins that it does not cover are solved as
        without it

    Returns
    -------
    contact : `FilmContact` with S the batch shape; nan where a parameter is impossible, and but for the dry area where the
        capillary pressure on the way down to the floor exceeds the load more than a thousand times

    Notes
    -----
    The floor matters: at a fixed wet modulus the capillary pressure grows without bound as the film goes to zero, since water
    then sits in gaps of nanometres, and μ would pass through a second, spurious peak. With the paper's skin p_a is smallest at
    a film of 27 nm and exceeds its maximum in the µm range again below 0.2 nm. How skin hardens as it dries is not known; the
    curve in ln E0 is a description.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5).

    Examples
    --------
    >>> from math import radians
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> contact = film_contact(6830.0, named_surface("paper_reference"), skin=wet, surface_tension=0.0727,
    ...     contact_angle_skin=radians(80.0), contact_angle_counterface=0.0, young_modulus_layer_dry=1e9,
    ...     yield_stress=50e6)
    >>> print(f"{contact.dry_area:.3e} {contact.area.max():.3e} {contact.area[-1]:.3e}")
    1.366e-04 1.056e-03 6.481e-04
    """
    if closure not in CLOSURES:
        raise InputError(f"closure is {closure!r}, but must be one of {', '.join(map(repr, CLOSURES))}.")
    if young_modulus_layer_dry is None and hardening_film is not None:
        raise InputError(
            "hardening_film is given, but not young_modulus_layer_dry, the modulus that it leads to."
        )
    if young_modulus_layer_dry is not None and not isinstance(skin, LayeredSkin):
        raise InputError("young_modulus_layer_dry is given, but the solid has no layer that could harden.")
    arguments = floats(
        nominal_pressure, surface_tension, contact_angle_skin, contact_angle_counterface, area_correction
    )
    limit, floor, power = floats(yield_stress, film_floor, hardening_sharpness)
    dry = None if young_modulus_layer_dry is None else np.asarray(young_modulus_layer_dry, dtype=np.float64)
    half = None if hardening_film is None else np.asarray(hardening_film, dtype=np.float64)
    load, tension, first, second, gamma = arguments
    shapes = [x.shape for x in (*arguments, dry, limit, floor, power, half) if x is not None]
    batch = np.broadcast_shapes(*shapes, *batch_shapes(spectrum, skin))

    def flat(value: FloatArray) -> FloatArray:
        return np.ascontiguousarray(np.broadcast_to(value, batch)).reshape(-1)

    with np.errstate(all="ignore"):
        wetting_tension = np.where(tension >= 0, tension, np.nan) * np.maximum(cosine_sum(first, second), 0.0)
        surface, gamma = map_spectrum(spectrum, flat), flat(gamma) if gamma.size > 1 else gamma.reshape(())
        height = np.broadcast_to(rms_height(surface), (prod(batch),))
        load, wetting_tension, limit = (
            flat(x) for x in (np.where((load > 0) & (load < np.inf), load, np.nan), wetting_tension, limit)
        )
        dry = None if dry is None else flat(dry)
        flat_skin = map_skin(skin, flat)
        bridged = Bridged(load, wetting_tension, GapSource(surface, flat_skin, gamma, closure), height, table)

        lowest = np.where(flat(floor) > 0, flat(floor), np.nan)
        if half is None and closure == "gaussian":
            films, log_pressure = bridged.path(_FILMS, lowest)
            films = np.where(films[:, -1:] == 0, _CLOSED * (1 + lobatto(_FILMS)), films)
            log_area = _finer(_log_area(bridged.source, limit, np.exp(log_pressure)))
            log_films = _finer(np.log(films))
            grid = _ascending(np.exp(log_films), films)
        else:
            flooded = np.maximum(bridged.flooded()[0], _CLOSED)
            start = np.minimum(lowest, flooded / 2)[:, None]
            films = start + (flooded[:, None] - start) * lobatto(_FILMS)
            grid = start + (flooded[:, None] - start) * lobatto(_POINTS)

            log_area = (
                _finer(_log_area(bridged.source, limit, np.exp(bridged.log_pressure(films))))
                if half is None or dry is None
                else _hardened(films, grid, bridged, dry, limit, flat(half), flat(power))
            )
        fine = np.exp(log_area)
        stiff = bridged if dry is None else bridged.with_layer(dry)
        dry_area = np.exp(_log_area(stiff.source, limit, load[:, None]))[:, 0]
        doubtful = (
            wetting_tension
            + lowest
            + (0.0 if half is None else np.where(_possible(flat(half), flat(power)), 0.0, np.nan))
        )
        dry_area = np.where(np.isnan(doubtful), np.nan, dry_area)
        fine = np.where(np.isnan(dry_area)[:, None], np.nan, fine)
        grid, fine = (np.where(np.isfinite(x), x, np.nan).reshape(*batch, _POINTS) for x in (grid, fine))
        return FilmContact(
            film=grid, area=fine, dry_area=np.broadcast_to(dry_area, load.shape).reshape(batch)[()]
        )


@lru_cache(maxsize=1)
def _finer_weights() -> FloatArray:
    """Values at more nodes from those at a few, transposed."""
    return np.ascontiguousarray(values_between(_FILMS, 2 * lobatto(_POINTS) - 1).T)


def _finer(values: FloatArray) -> FloatArray:
    """The same curve at more points, shape ``(B, points)``."""
    # one product for each member: a product of all rows at once may round differently
    return np.asarray((values[:, None, :] @ _finer_weights())[:, 0, :])


def _ascending(grid: FloatArray, films: FloatArray) -> FloatArray:
    """Films from the first to the last of ``films`` that always rise: towards the flooded one they meet to the last digits."""
    step = 1e-8 * films[:, -1:] * np.arange(_POINTS)
    grid[:, 0] = films[:, 0]
    grid = np.maximum.accumulate(grid - step, axis=1) + step
    grid = np.minimum(grid, films[:, -1:] * (1 - 1e-8 * np.arange(_POINTS)[::-1]))
    return grid


def _log_area(source: GapSource, limit: FloatArray, pressure: FloatArray) -> FloatArray:
    """ln A/A0 under pressures, Pa, of shape ``(B, F)`` with the yield stress ``limit``, Pa, of shape ``(B,)``."""
    twice_variance = np.asarray(twice_stress_variance(source.spectrum, source.skin))
    return np.log(
        total_contact_area(
            pressure,
            twice_variance[..., None],
            yield_stress=limit[..., None],
            area_correction=np.asarray(source.area_correction)[..., None],
        )
    )


def _hardened(
    films: FloatArray,
    grid: FloatArray,
    bridged: Bridged,
    dry: FloatArray,
    limit: FloatArray,
    half: FloatArray,
    power: FloatArray,
) -> FloatArray:
    """ln A/A0 on a grid of films of shape ``(B, points)`` whose layer hardens, between skins of a few moduli and ``films``."""
    wet = np.broadcast_to(np.asarray(cast(LayeredSkin, bridged.source.skin).young_modulus_layer), dry.shape)
    # each skin with all its moduli, one after the other
    rows = np.repeat(np.arange(dry.size), _MODULI)
    moduli = wet[:, None] * np.exp(np.log(dry / wet)[:, None] * lobatto(_MODULI))
    many = bridged.select(rows).with_layer(moduli.reshape(-1))
    # without any bridges all films press alike
    distinct = films if (bridged.wetting_tension > 0).any() else films[:, :1]
    pressure = np.exp(many.log_pressure(distinct[rows]))
    areas = np.broadcast_to(_log_area(many.source, limit[rows], pressure), (rows.size, _FILMS))
    curves = _finer(areas).reshape(dry.size, _MODULI, _POINTS)
    parts = coefficients(np.ascontiguousarray(np.moveaxis(curves, 1, 2)).reshape(-1, _MODULI, 1))[..., 0]
    # ln of the wet fraction w^k/(1 + w^k) of ln E0, which may be too small for a number itself
    steep = np.where(_possible(half, power), power, np.nan)[:, None]
    log_fraction = -np.logaddexp(0.0, steep * np.log(half[:, None] / grid))
    left = -np.expm1(log_fraction - log_fraction[:, -1:])  # 0 where the gap is flooded
    return series(parts[..., None], 2 * left.reshape(-1, 1) - 1).reshape(grid.shape)


def _possible(half: FloatArray, power: FloatArray) -> BoolArray:
    return (half > 0) & (half < np.inf) & (power > 0) & (power < np.inf)
