"""Capillary bridges between rough skin and a smooth countersurface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, BoolArray, FloatArray, floats
from skinbayes.contact import (
    AREA_CORRECTION,
    ElasticSolid,
    mean_separation,
    relative_contact_area,
    twice_stress_variance,
)
from skinbayes.contact.gaps import CLOSURES
from skinbayes.errors import InputError
from skinbayes.roughness.spectrum import PowerSpectrum
from skinbayes.wetting._curve import solve_curve
from skinbayes.wetting._gaps import Closure, GapSource, batch_shapes, map_skin, map_spectrum
from skinbayes.wetting._refine import filled_at, refine_films, roots_at_gaps

Branch = Literal["approach", "retreat"]

_ROUNDING = 1e-15  # of a sum of two cosines
_BEYOND = np.log(
    4.0
)  # of ln film; the capillary pressure outgrows a film that is much thinner than the last of a curve
_NARROW = 1e-13  # m; in gaps up to it, which mean nothing, the area is linear and the film quadratic to 2e-5


@dataclass(frozen=True, eq=False, kw_only=True)
class CapillaryState:
    """Skin held together by capillary bridges. All fields have the same shape.

    Attributes
    ----------
    film_thickness : water between the surfaces per nominal area, m; at most the mean separation
    kelvin_gap : d_K, gap up to which the interface is wet, m; inf where it is flooded
    capillary_pressure : p_a, attraction per nominal area, Pa
    total_pressure : p = p0 + p_a, Pa
    relative_contact_area : A/A0 at p, elastic, dimensionless
    wet_area : fraction of the nominal area that is wet, real contact not counted, dimensionless
    mean_separation : ū at p, real contact counted with u = 0, m
    mean_separation_wet : mean gap of the wet area, m; nan where contact is so close that nothing is wet
    flooded : 1 where the film fills the whole gap, else 0, dimensionless
    solutions : number of total pressures that satisfy the equations at this d_K, dimensionless; more than 1 is
        hysteresis; nan where they were not counted

    References
    ----------
    Persson, J. Phys.: Condens. Matter 20 (2008) 315007, doi 10.1088/0953-8984/20/31/315007.
    """

    film_thickness: FloatArray
    kelvin_gap: FloatArray
    capillary_pressure: FloatArray
    total_pressure: FloatArray
    relative_contact_area: FloatArray
    wet_area: FloatArray
    mean_separation: FloatArray
    mean_separation_wet: FloatArray
    flooded: FloatArray
    solutions: FloatArray


def kelvin_gap(
    kelvin_radius: ArrayLike, contact_angle_skin: ArrayLike, *, contact_angle_counterface: ArrayLike
) -> FloatArray:
    """Kelvin length, the largest gap that a bridge can span, ``d_K = r_K (cos θ1 + cos θ2)`` (Eq. 5 of the paper).

    Parameters
    ----------
    kelvin_radius : r_K, m, ≥ 0, any shape; counted positive, where the paper counts it negative
    contact_angle_skin : θ1, rad, 0 … π, broadcasts
    contact_angle_counterface : θ2, rad, 0 … π, broadcasts

    Returns
    -------
    kelvin_gap : m, broadcast shape; 0 where cos θ1 + cos θ2 ≤ 0, as there are no bridges; nan where an argument is
        impossible

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Eq. 5).

    Examples
    --------
    >>> from math import radians
    >>> print(kelvin_gap(1e-9, radians(80.0), contact_angle_counterface=[0.0, radians(102.0)]))
    [1.17364818e-09 0.00000000e+00]
    """
    radius = np.asarray(kelvin_radius, dtype=np.float64)
    with np.errstate(all="ignore"):
        wetting = np.maximum(cosine_sum(contact_angle_skin, contact_angle_counterface), 0.0)
        # without bridges an infinite radius, that of saturated air, makes no difference
        radius = np.where(radius >= 0, np.where(wetting == 0, 1.0, radius), np.nan)
        return np.asarray(radius * wetting)[()]


def capillary_state(
    film_thickness: ArrayLike,
    nominal_pressure: ArrayLike,
    *,
    spectrum: PowerSpectrum,
    skin: ElasticSolid,
    surface_tension: ArrayLike,
    contact_angle_skin: ArrayLike,
    contact_angle_counterface: ArrayLike,
    area_correction: ArrayLike = AREA_CORRECTION,
    closure: Closure = "gaussian",
    refine: bool = True,
) -> CapillaryState:
    """Contact, wet area and separations of skin with a given amount of water in the gap (Eqs. 5 to 7 of the paper).

    Water fills all gaps up to d_K. It pulls with the Laplace pressure ``p_K = γ_w (cos θ1 + cos θ2)/d_K``, spread evenly
    over the nominal area: ``p = p0 + p_K F(d_K; p)``, where F is the fraction of the area with gaps up to d_K at the pressure
    p. d_K follows from ``film = ∫_0^(d_K) u P(u; p) du``. From the film of the mean separation ū(p0) on the gap is
    flooded, and nothing pulls.

    Parameters
    ----------
    film_thickness : film, average over the nominal area, m, > 0, shape ``(F,)`` or ``(..., F)``, or a scalar
    nominal_pressure : p0, Pa, > 0, batch shape
    spectrum : power spectrum, C in m^4, scalar or batched
    skin : moduli in Pa, thickness in m; broadcasts with the spectrum
    surface_tension : γ_w, N/m, ≥ 0, batch shape
    contact_angle_skin : θ1, receding, rad, 0 … π, batch shape
    contact_angle_counterface : θ2, receding, rad, 0 … π, batch shape
    area_correction : γ of `relative_contact_area`, dimensionless, 0 < γ ≤ 1, batch shape
    closure : P(u) from Gaussians (default) or from sharp gaps, see `gap_distribution`
    refine : False leaves the interpolated solution, whose area and pressure are within 1e-4 for the Gaussian closure (a
        few percent for the sharp one), and does not count solutions; True solves with the gap distribution at each
        pressure itself, to 1e-11

    Returns
    -------
    state : `CapillaryState`, batch shape, plus the axis of ``film_thickness`` if it has one; nan where a parameter is
        impossible

    Notes
    -----
    No bridges form where cos θ1 + cos θ2 ≤ 0 (skin on polypropylene). Then p = p0, and the water is taken to fill the
    narrowest gaps all the same, up to ``kelvin_gap``; that water would rather leave them changes nothing but the wet area.
    The capillary pressure sets in with a kink where the sum of cosines passes 0.

    The solution is the one that is reached from the flooded gap as water evaporates: d_K falls from infinity and p is
    continuous from p0. For films of micrometres on skin it is the only one. For films well below a nanometre per nominal
    area the capillary pressure of a soft layer grows faster than the film falls: several d_K may belong to a film, of which the
    largest is taken, and below some film (0.024 nm for the paper's skin) the result is nan or lies in a gap that is nearly
    closed. Where the capillary pressure exceeds the load many times over, thin films are interpolated poorly (``refine=False``,
    up to tens of percent at a film of 0.3 % of the flooded one).

    Contact is elastic. The mean field gives the area within 1 % of boundary elements with local tractions, but ū is 3 to
    20 % too small there.

    References
    ----------
    Persson, J. Phys.: Condens. Matter 20 (2008) 315007, doi 10.1088/0953-8984/20/31/315007.
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5, Eqs. 5 to 7).

    Examples
    --------
    >>> from math import radians
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> state = capillary_state(6e-6, 6830.0, spectrum=named_surface("paper_reference"), skin=wet,
    ...     surface_tension=0.0727, contact_angle_skin=radians(80.0), contact_angle_counterface=0.0)
    >>> print(f"{state.capillary_pressure / 6830.0:.3f} {state.mean_separation:.3e}")
    0.629 1.103e-05
    """
    case = _flatten(film_thickness, nominal_pressure, spectrum, skin, surface_tension, contact_angle_skin,
                    contact_angle_counterface, area_correction, closure)  # fmt: skip
    with np.errstate(all="ignore"):
        separation, film = case.separation, case.wanted
        possible = (film > 0) & np.isfinite(separation * case.wetting_tension)[:, None]
        flooded = possible & (film >= separation[:, None])
        # where there is nothing to solve, half of the flooded film stands in
        inside = np.where(possible & ~flooded, film, separation[:, None] / 2)
        thinnest = inside.min(axis=1, initial=np.inf)
        curve = solve_curve(case.source, case.pressure, case.wetting_tension, separation, thinnest)
        z, found = curve.at(inside)
        x, reference = found[0], curve.reference[:, None]
        if refine:
            # films a little beyond the end of the curve are sought from there
            last = np.broadcast_to(curve.end[:, None], z.shape)
            ends = curve.along(last)
            beyond = np.isnan(z) & (ends[0] - np.log(inside) < _BEYOND)
            x, z = np.where(beyond, ends[1], x), np.where(beyond, last, z)
            x, z = refine_films(
                case.source, case.pressure, case.wetting_tension, inside, x, z, curve.reference
            )
            gap = reference / np.expm1(z)
            solutions = roots_at_gaps(case.source, case.pressure, case.wetting_tension, gap, False)[1]
            filled, mean = filled_at(case.source, x, gap)
            wet = np.where(np.isnan(x), np.nan, filled.area)
        else:
            gap, solutions = reference / np.expm1(z), np.full(film.shape, np.nan)
            wet, mean = np.exp(found[1]), np.exp(found[2])
        return _finish(case, _Solved(gap, wet, mean, inside, solutions), flooded, possible)


def capillary_state_at_gap(
    kelvin_gap: ArrayLike,
    nominal_pressure: ArrayLike,
    *,
    spectrum: PowerSpectrum,
    skin: ElasticSolid,
    surface_tension: ArrayLike,
    contact_angle_skin: ArrayLike,
    contact_angle_counterface: ArrayLike,
    area_correction: ArrayLike = AREA_CORRECTION,
    closure: Closure = "gaussian",
    branch: Branch = "approach",
    count: bool = True,
) -> CapillaryState:
    """Contact, wet area and separations of skin whose bridges span a given gap (Eqs. 5 to 7 of the paper).

    As `capillary_state`, with the Kelvin length d_K given instead of the film, as it is in equilibrium with humid air.

    Parameters
    ----------
    kelvin_gap : d_K, m, ≥ 0, shape ``(F,)`` or ``(..., F)``, or a scalar; inf is flooded, 0 the limit of narrow gaps, in which
        the capillary pressure is ``γ_w (cos θ1 + cos θ2) P(u → 0; p)``
    nominal_pressure : p0, Pa, > 0, batch shape
    spectrum : power spectrum, C in m^4, scalar or batched
    skin : moduli in Pa, thickness in m; broadcasts with the spectrum
    surface_tension : γ_w, N/m, ≥ 0, batch shape
    contact_angle_skin : θ1, rad, 0 … π, batch shape
    contact_angle_counterface : θ2, rad, 0 … π, batch shape
    area_correction : γ of `relative_contact_area`, dimensionless, 0 < γ ≤ 1, batch shape
    closure : P(u) from Gaussians (default) or from sharp gaps, see `gap_distribution`
    branch : which pressure to take if several satisfy the equations: "approach" the smallest, which surfaces reach that
        come together; "retreat" the largest, from which surfaces in close contact come apart. Between the two lies the
        hysteresis of snapping together and apart.
    count : False does not count solutions, which is several times faster on the branch "approach"

    Returns
    -------
    state : `CapillaryState`, batch shape, plus the axis of ``kelvin_gap`` if it has one; nan where a parameter is
        impossible

    Notes
    -----
    ``p − p0 − p_K F(d_K; p)`` holds to 1e-12 of p. Roots are told apart on a ladder of pressures in steps of 13 %; a pair
    closer than that is taken for none.

    References
    ----------
    Persson, J. Phys.: Condens. Matter 20 (2008) 315007, doi 10.1088/0953-8984/20/31/315007.
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5, Eqs. 5 to 7).

    Examples
    --------
    >>> from math import radians
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> surface = named_surface("paper_reference")
    >>> state = capillary_state_at_gap(14e-6, 6830.0, spectrum=surface, skin=wet, surface_tension=0.0727,
    ...     contact_angle_skin=radians(80.0), contact_angle_counterface=0.0)
    >>> print(f"{state.film_thickness:.3e} {state.wet_area:.3f} {state.solutions:.0f}")
    5.596e-06 0.705 1
    """
    if branch not in ("approach", "retreat"):
        raise InputError(f"branch is {branch!r}, but must be 'approach' or 'retreat'.")
    case = _flatten(kelvin_gap, nominal_pressure, spectrum, skin, surface_tension, contact_angle_skin,
                    contact_angle_counterface, area_correction, closure)  # fmt: skip
    with np.errstate(all="ignore"):
        possible = (case.wanted >= 0) & np.isfinite(case.separation * case.wetting_tension)[:, None]
        flooded = possible & (case.wanted == np.inf)
        wanted = np.where(possible & ~flooded, case.wanted, case.separation[:, None])
        gap = np.maximum(wanted, _NARROW)
        x, solutions = roots_at_gaps(
            case.source, case.pressure, case.wetting_tension, gap, branch == "retreat", count
        )
        filled, mean = filled_at(case.source, x, gap)
        solved = _Solved(gap, filled.area, mean, filled.film, solutions)
        return _finish(case, solved, flooded, possible, wanted / gap)


class _Case(NamedTuple):
    """Arguments flattened to B members, with F films or gaps each, ``wanted``, m, shape ``(B, F)``."""

    source: GapSource
    pressure: FloatArray
    wetting_tension: FloatArray
    separation: FloatArray
    wanted: FloatArray
    shape: tuple[int, ...]


class _Solved(NamedTuple):
    """Solutions of shape ``(B, F)``; members that are flooded or impossible hold anything."""

    gap: FloatArray
    wet: FloatArray
    mean: FloatArray
    film: FloatArray
    solutions: FloatArray


def cosine_sum(contact_angle_skin: ArrayLike, contact_angle_counterface: ArrayLike) -> FloatArray:
    """cos θ1 + cos θ2; nan for impossible angles."""
    angles = floats(contact_angle_skin, contact_angle_counterface)
    first, second = (np.cos(np.where((x >= 0) & (x <= np.pi), x, np.nan)) for x in angles)
    # two right angles, or 80 and 100 degrees, sum to 0 but for rounding
    return np.where(np.abs(first + second) < _ROUNDING, 0.0, first + second)


def _flatten(
    wanted: ArrayLike,
    nominal_pressure: ArrayLike,
    spectrum: PowerSpectrum,
    skin: ElasticSolid,
    surface_tension: ArrayLike,
    contact_angle_skin: ArrayLike,
    contact_angle_counterface: ArrayLike,
    area_correction: ArrayLike,
    closure: Closure,
) -> _Case:
    if closure not in CLOSURES:
        raise InputError(f"closure is {closure!r}, but must be one of {', '.join(map(repr, CLOSURES))}.")
    films, pressure, tension, gamma = floats(wanted, nominal_pressure, surface_tension, area_correction)
    with np.errstate(all="ignore"):
        wetting = np.maximum(cosine_sum(contact_angle_skin, contact_angle_counterface), 0.0)
        wetting_tension = np.where((tension >= 0) & (tension < np.inf), tension, np.nan) * wetting
        pressure = np.where(pressure > 0, pressure, np.nan)
    shapes = [
        *batch_shapes(spectrum, skin),
        pressure.shape,
        wetting_tension.shape,
        gamma.shape,
        films.shape[:-1],
    ]
    batch = np.broadcast_shapes(*shapes)

    def flat(value: FloatArray) -> FloatArray:
        return np.broadcast_to(value, batch).reshape(-1)

    source = GapSource(
        map_spectrum(spectrum, flat), map_skin(skin, flat), flat(gamma) if gamma.ndim else gamma, closure
    )
    pressure = flat(pressure)
    separation = mean_separation(
        pressure[:, None], source.spectrum, skin=source.skin, area_correction=source.area_correction
    )[:, 0]
    columns = films.shape[-1] if films.ndim else 1
    rows = np.broadcast_to(films, (*batch, columns)).reshape(len(pressure), columns)
    return _Case(
        source, pressure, flat(wetting_tension), separation, rows, (*batch, columns) if films.ndim else batch
    )


def _finish(
    case: _Case, solved: _Solved, flooded: BoolArray, possible: BoolArray, narrower: FloatArray | float = 1.0
) -> CapillaryState:
    """The state: what was solved, the dry load where the gap is flooded, nan where an argument is impossible.

    Gaps are ``narrower`` by that factor than those that were solved.
    """

    attraction = np.where(flooded, 0.0, case.wetting_tension[:, None] / solved.gap * solved.wet)
    known = possible & np.isfinite(attraction)

    def choose(bridged: FloatArray, full: FloatArray) -> FloatArray:
        value = np.where(flooded, full, np.where(known, bridged, np.nan))
        return np.asarray(value.reshape(case.shape))[()]

    load, separation = case.pressure[:, None], case.separation[:, None]
    twice_variance = np.asarray(twice_stress_variance(case.source.spectrum, case.source.skin))
    gamma = np.asarray(case.source.area_correction)
    twice_variance, gamma = (x[:, None] if x.ndim else x for x in (twice_variance, gamma))
    pressure = load + attraction
    area = relative_contact_area(pressure, twice_variance, area_correction=gamma)
    return CapillaryState(
        film_thickness=choose(solved.film * np.square(narrower), separation),
        kelvin_gap=choose(solved.gap * narrower, np.full_like(load, np.inf)),
        capillary_pressure=choose(attraction, attraction),
        total_pressure=choose(pressure, pressure),
        relative_contact_area=choose(area, area),
        wet_area=choose(solved.wet * narrower, 1 - area),
        mean_separation=choose(solved.mean, separation),
        mean_separation_wet=choose(solved.film / solved.wet * narrower, separation / (1 - area)),
        flooded=choose(0.0 * solved.gap, 1 + 0.0 * load),
        solutions=choose(solved.solutions, 1 + 0.0 * load),
    )
