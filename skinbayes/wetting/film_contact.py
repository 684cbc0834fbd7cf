"""Contact area of skin over the thickness of the water film, from flooded over bridged to dry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact import (
    AREA_CORRECTION,
    LayeredSkin,
    elastoplastic_contact_area,
    mean_separation,
    stress_variance,
)
from skinbayes.roughness.spectrum import PowerSpectrum
from skinbayes.wetting._chebyshev import clenshaw, coefficients, lobatto, polynomials
from skinbayes.wetting._gaps import Closure, batch_shapes
from skinbayes.wetting._mixture import upper_tail
from skinbayes.wetting.capillary import capillary_state
from skinbayes.wetting.humidity import softened_modulus

FILM_FLOOR = 1e-7
"""Film below which skin counts as dry, m."""

_FILMS, _POINTS, _MODULI = 32, 256, 12
_NO_SPREAD = 1e-12  # m
_TERMS = 1 << 14  # treated at a time


@dataclass(frozen=True, eq=False)
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
        film : mean film, m, may be negative after the film is gone, shape ``S + (T,)``
        spread : standard deviation of the film over the track, m, shape ``S``

        Returns
        -------
        area, slope : dimensionless and 1/m, shape ``S + (T,)``
        """
        width = np.maximum(np.asarray(spread), _NO_SPREAD)[..., None, None]
        # area is a sum of one step and of ramps, whose averages over a normal distribution are closed forms
        grades = np.diff(self.area) / np.diff(self.film)
        zero = np.zeros_like(grades[..., :1])
        turns = np.diff(np.concatenate([zero, grades, zero], axis=-1))[..., None, :]
        edge = self.film[..., None, :]
        films = np.asarray(film)[..., None]
        shape = np.broadcast_shapes(films.shape[:-1], edge.shape[:-1], width.shape[:-1])
        films = np.broadcast_to(films, (*shape, 1))
        area, slope = np.empty((2, *shape))
        step = max(1, _TERMS * shape[-1] // max(1, area.size * edge.shape[-1]))
        for first in range(0, shape[-1], step):
            block = slice(first, first + step)
            distance = (films[..., block, :] - edge) / width
            bell = np.exp(-0.5 * np.square(distance)) / np.sqrt(2 * np.pi)
            below = upper_tail(np.abs(distance), bell)
            below = np.where(distance > 0, 1 - below, below)
            jump = (self.area[..., 0] - self.dry_area)[..., None]
            slope[..., block] = (turns * below).sum(axis=-1) + jump * bell[..., 0] / width[..., 0]
            ramps = (turns * (width * (distance * below + bell))).sum(axis=-1)
            area[..., block] = self.dry_area[..., None] + jump * below[..., 0] + ramps
        return area, slope


def film_contact(
    nominal_pressure: ArrayLike,
    spectrum: PowerSpectrum,
    skin: LayeredSkin,
    surface_tension: ArrayLike,
    contact_angle_skin: ArrayLike,
    contact_angle_counterface: ArrayLike,
    young_modulus_layer_dry: ArrayLike,
    yield_stress: ArrayLike,
    area_correction: ArrayLike = AREA_CORRECTION,
    closure: Closure = "gaussian",
    film_floor: ArrayLike = FILM_FLOOR,
    hardening_film: ArrayLike | None = None,
    hardening_sharpness: ArrayLike = 2.0,
) -> FilmContact:
    """Contact area of drying skin against the film, flooded, bridged and dry (Sect. 5 and Figs. 8 and 9 of the paper).

    Flooded skin carries p0 alone, bridged skin p0 and the pull of `capillary_state`, dry skin p0 with the modulus of dry stratum
    corneum; the area of each is elastoplastic. Skin counts as dry below ``film_floor``.

    Parameters
    ----------
    nominal_pressure : p0, Pa, > 0, batch shape
    spectrum : power spectrum, C in m^4, scalar or batched
    skin : wet skin, moduli in Pa, thickness in m; broadcasts with the spectrum
    surface_tension : γ_w, N/m, ≥ 0, batch shape
    contact_angle_skin : θ1, rad, 0 … π, batch shape
    contact_angle_counterface : θ2, rad, 0 … π, batch shape
    young_modulus_layer_dry : E0 of the dry layer, Pa, > 0, batch shape
    yield_stress : σ_Y, Pa, > 0, batch shape; inf is purely elastic
    area_correction : γ, dimensionless, 0 < γ ≤ 1, batch shape
    closure : P(u) from Gaussians (default) or from sharp gaps, see `gap_distribution`
    film_floor : film below which skin is dry, m, > 0, batch shape; at most half of the flooded film is used
    hardening_film : film at which ln E0 is half way between wet and dry, m, > 0, batch shape; None keeps the layer wet
        down to the floor. E0 is the wet one where the gap is flooded.
    hardening_sharpness : k of the weight ``w^k/(1 + w^k)``, w = film over ``hardening_film``, of the wet modulus,
        dimensionless, > 0, batch shape

    Returns
    -------
    contact : `FilmContact` with S the batch shape; nan where a parameter is impossible

    Notes
    -----
    The floor matters: at a fixed wet modulus the pull grows without bound as the film goes to zero, since water then sits in
    gaps of nanometres, and μ would pass through a second, spurious peak. With the paper's skin p_a is smallest at a film of 27 nm
    and exceeds its maximum in the µm range again below 0.2 nm. How skin hardens as it dries is not known; the curve in ln E0 is
    a description.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5).

    Examples
    --------
    >>> from math import radians
    >>> from skinbayes.roughness import named_surface
    >>> wet = LayeredSkin(7e6, 20e3, 0.5, 0.5, 20e-6)
    >>> contact = film_contact(
    ...     6830.0, named_surface("paper_reference"), wet, 0.0727, radians(80.0), 0.0, 1e9, 50e6
    ... )
    >>> print(f"{contact.dry_area:.3e} {contact.area.max():.3e} {contact.area[-1]:.3e}")
    1.366e-04 1.056e-03 6.481e-04
    """
    arguments = [
        np.asarray(x, dtype=np.float64)
        for x in (
            nominal_pressure,
            surface_tension,
            contact_angle_skin,
            contact_angle_counterface,
            area_correction,
        )
    ]
    dry, limit, floor, power = (
        np.asarray(x, dtype=np.float64)
        for x in (young_modulus_layer_dry, yield_stress, film_floor, hardening_sharpness)
    )
    half = None if hardening_film is None else np.asarray(hardening_film, dtype=np.float64)
    load, tension, first, second, gamma = arguments
    shapes = [x.shape for x in (*arguments, dry, limit, floor, power)] + (
        [] if half is None else [half.shape]
    )
    batch = np.broadcast_shapes(*shapes, *batch_shapes(spectrum, skin))

    def area_of(pressure: FloatArray, layer: LayeredSkin) -> FloatArray:
        variance = np.asarray(stress_variance(spectrum, layer))
        parts = (x[..., None] for x in (variance, limit, gamma))
        return np.asarray(elastoplastic_contact_area(pressure, *parts).total)

    def pressed(films: FloatArray, layer: LayeredSkin) -> FloatArray:
        state = capillary_state(
            films, load, spectrum, layer, tension, first, second, gamma, closure, refine=False
        )
        return area_of(np.asarray(state.total_pressure), layer)

    with np.errstate(all="ignore"):
        flooded = np.asarray(mean_separation(load[..., None], spectrum, skin, gamma))
        start = np.minimum(np.where(floor > 0, floor, np.nan)[..., None], flooded / 2)
        films = np.broadcast_to(start + (flooded - start) * lobatto(_FILMS), (*batch, _FILMS))
        if half is None:
            log_area = np.log(np.broadcast_to(pressed(films, skin), films.shape))
        else:
            log_area = _hardened(films, skin, dry, half, power, pressed)
        log_area = np.ascontiguousarray(log_area).reshape(-1, _FILMS)
        # the same curve at more points
        points = lobatto(_POINTS)
        weights = polynomials(2 * points - 1, _FILMS)[0]
        parts = coefficients(log_area[..., None])[..., 0]
        fine = np.exp(parts[:, None, :] @ weights.T).reshape(*batch, _POINTS)
        grid = np.broadcast_to(start + (flooded - start) * points, (*batch, _POINTS))
        stiff = _with_layer(skin, dry)
        dry_area = np.broadcast_to(area_of(load[..., None], stiff)[..., 0], batch)
        return FilmContact(grid, fine, dry_area[()])


def _hardened(
    films: FloatArray,
    skin: LayeredSkin,
    dry: FloatArray,
    half: FloatArray,
    power: FloatArray,
    pressed: Callable[[FloatArray, LayeredSkin], FloatArray],
) -> FloatArray:
    """ln A/A0 at films of shape ``S + (n,)`` whose layer hardens, interpolated between skins of a few moduli."""
    wet = np.asarray(skin.young_modulus_layer)
    steps = np.log(dry / wet)
    moduli = [wet * np.exp(steps * share) for share in lobatto(_MODULI)]
    curves = [np.broadcast_to(np.log(pressed(films, _with_layer(skin, e))), films.shape) for e in moduli]
    parts = coefficients(np.stack([curve.reshape(-1) for curve in curves], axis=-1)[..., None])[..., 0]
    wetness = films / np.where(half > 0, half, np.nan)[..., None]
    one = np.ones(())
    share = softened_modulus(one, np.e * one, wetness, np.where(power > 0, power, np.nan)[..., None])
    wet_share = np.log(share)
    left = 1 - wet_share / wet_share[..., -1:]  # 0 where the gap is flooded
    return clenshaw(parts, 2 * left.reshape(-1, 1) - 1)[0].reshape(films.shape)


def _with_layer(skin: LayeredSkin, modulus: FloatArray) -> LayeredSkin:
    return LayeredSkin(
        modulus,
        skin.young_modulus_bulk,
        skin.poisson_ratio_layer,
        skin.poisson_ratio_bulk,
        skin.layer_thickness,
    )
