"""Friction from a table of films, for many parameter vectors and rows at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, BoolArray, FloatArray, floats
from skinbayes.errors import InputError
from skinbayes.lubrication.effective_viscosity import EffectiveViscosity
from skinbayes.lubrication.film_axes import FILM_PARAMETERS, film_parameters
from skinbayes.lubrication.film_contraction import ContractedFilms, contract
from skinbayes.lubrication.film_table import (
    BOUNDARY,
    CENTRAL,
    COUETTE,
    FRACTION,
    HYSTERESIS,
    MINIMUM,
    PRESSURE_FLOW,
    FilmTable,
)
from skinbayes.lubrication.film_viscosity import viscosity_of_films
from skinbayes.lubrication.flow_curves import LiquidRows
from skinbayes.lubrication.stribeck import LARGEST_STRAIN, THICKEST_FILM
from skinbayes.lubrication.viscoelastic_correction import RememberingTissue, contract_remembering
from skinbayes.lubrication.viscoelastic_stribeck import SPHERE_OVER_CYLINDER

_POINTS = 8192  # of vectors times rows worked on at a time: arrays stay in the cache
_COEFFICIENTS = (
    1 << 21
)  # numbers, at most, that the axes are summed up to at a time: 32 vectors of 165 rows in one piece
_STILL = -1e4  # ln of a speed of 0: so far below any other that exp of it is 0, but leaves arithmetic sound
_FRICTION, _EVERYTHING = (
    (BOUNDARY, COUETTE, PRESSURE_FLOW),
    (CENTRAL, BOUNDARY, COUETTE, PRESSURE_FLOW, MINIMUM, FRACTION),
)


class TabulatedFriction(NamedTuple):
    """Friction of lubricated balls from a table; all of the broadcast shape of the arguments, nan outside the table.

    Attributes
    ----------
    friction_coefficient : μ, sum of its parts, dimensionless
    boundary : shear stress of the areas of real contact, dimensionless
    couette : shear flow of the liquid, dimensionless
    pressure_flow : pressure flow of the liquid, dimensionless
    asperity_load_fraction : fraction of the load that asperities carry, dimensionless; nan if not asked for
    minimum_film : smallest mean separation, m; nan if not asked for
    central_film : mean separation under the middle of the ball, m; nan if not asked for
    strain : b/Rc of the Hertz contact, dimensionless
    outside_table : the table does not hold the parameters, or λ is above 2e4
    too_strained : b/Rc is above the largest strain
    film_beyond_ball : 3π ηv/f_N is above the thickest film
    hysteresis : friction of the loss of the tissue, dimensionless; 0 if it is elastic
    """

    friction_coefficient: FloatArray
    boundary: FloatArray
    couette: FloatArray
    pressure_flow: FloatArray
    asperity_load_fraction: FloatArray
    minimum_film: FloatArray
    central_film: FloatArray
    strain: FloatArray
    outside_table: BoolArray
    too_strained: BoolArray
    film_beyond_ball: BoolArray
    hysteresis: FloatArray


@dataclass(frozen=True, eq=False, kw_only=True)
class LubricatedBalls:
    """Balls on lubricated rough skin whose friction is read from a table of films; all broadcast with the speeds.

    Attributes
    ----------
    parameters : `FILM_PARAMETERS` or `HOMOGENEOUS_PARAMETERS` by name, SI (Pa, m, N), each a
        scalar or of shape ``(B, 1)``, ``(N,)`` or ``(B, N)``
    frictional_shear_stress : σ_f, Pa, ≥ 0, broadcasts
    velocity_shift_factor : a, dimensionless, > 0, broadcasts; the theory is evaluated at a ηv, the shear rate of a liquid is that
        of the speed without it
    everything : also give films and load fraction
    thickest_film, largest_strain : 3π ηv/f_N and b/Rc, dimensionless, beyond which nothing is predicted
    tissue : memory of tissue that is not elastic; ``parameters`` are then moduli |E| at v/b
    """

    parameters: Mapping[str, ArrayLike]
    frictional_shear_stress: ArrayLike
    velocity_shift_factor: ArrayLike = 1.0
    everything: bool = False
    thickest_film: float = THICKEST_FILM
    largest_strain: float = LARGEST_STRAIN
    tissue: RememberingTissue | None = None


def tabulated_friction(
    table: FilmTable,
    speed_viscosity_product: ArrayLike,
    *,
    balls: LubricatedBalls,
) -> TabulatedFriction:
    """Friction coefficient of a ball on lubricated rough skin, as `stribeck_curve` gives it, from a table (Sect. 6 of the paper).

    Parameters
    ----------
    table : `FilmTable`
    speed_viscosity_product : ηv, N/m, ≥ 0, shape ``(N,)`` or ``(B, N)``, or a scalar; at 0 there is boundary friction
    balls : `LubricatedBalls`

    Returns
    -------
    friction : `TabulatedFriction`

    Notes
    -----
    Parameters that are the same in all rows cost less as ``(B, 1)``. The rows of a batch are the same to the last bit as
    those of its vectors one by one.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6).

    Examples
    --------
    >>> from skinbayes.lubrication import FilmTablePlan, build_film_table
    >>> from skinbayes.roughness import named_surface
    >>> ball = {"young_modulus_layer": 7e6, "young_modulus_bulk": 20e3, "rms_height": 22.4e-6, "sphere_radius": 8e-3,
    ...         "normal_force": 0.2, "layer_thickness": 20e-6}
    >>> ranges = {name: (value, value) for name, value in ball.items()}
    >>> table = build_film_table(FilmTablePlan(ranges, spectrum=named_surface("paper_reference"), checked=0))
    >>> print(tabulated_friction(table, [1e-6, 1e-3, 2e-2], balls=LubricatedBalls(parameters=ball,
    ...     frictional_shear_stress=15e6)).friction_coefficient.round(3))
    [1.423 1.007 0.132]
    """
    return TabulatedFriction(*_tabulated(table, speed_viscosity_product, balls, None))


def tabulated_friction_of_liquids(
    table: FilmTable,
    sliding_speed: ArrayLike,
    *,
    balls: LubricatedBalls,
    liquids: LiquidRows,
) -> tuple[TabulatedFriction, EffectiveViscosity]:
    """Friction of a ball on lubricated rough skin with liquids of measured flow curves, from a table (Sect. 6 of the paper).

    The viscosity is that at the shear rate v/u of the film which it makes: ``u = u(a η(v/u) v)`` with the mean separation u
    under the middle of the ball. As ``d ln u/d ln λ ≤ 1``, there is one solution where the shear stress η γ̇ of the liquid
    rises with the shear rate. Where it was measured to fall there may be several: the thickest film is taken, the one that
    a rising speed meets first, unless two lie closer than an eighth of the range of ln η.

    Parameters
    ----------
    table : `FilmTable`
    sliding_speed : v, m/s, ≥ 0, shape ``(N,)`` or ``(B, N)``; at 0 there is boundary friction
    balls : `LubricatedBalls`
    liquids : the liquid of each of N rows, from `liquid_rows`

    Returns
    -------
    friction : `TabulatedFriction`
    viscosity : `EffectiveViscosity`, nan where there is no friction

    Notes
    -----
    One viscosity for the whole film is a simplification. Compared with the viscosity at the local shear rate of every place
    (``rheology`` of `stribeck_curve`; E1 = 40 kPa, 0.5 N, rms roughness 10 or 22 µm, 0.01 to 0.3 m/s), friction is within
    0.2 % for the mixtures of honey and water of Fehlberg et al. (2025), 2 % for honey and honey with glycerin or 3 g of starch,
    6 % for honey with 6 g of starch – and off by factors of 0.14 to 2.5 for the hand creams, whose viscosity falls nearly as
    the shear rate rises.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6, Appendix C).

    Examples
    --------
    >>> from skinbayes.lubrication import FilmTablePlan, FlowCurve, build_film_table, liquid_rows
    >>> from skinbayes.roughness import named_surface
    >>> ball = {"young_modulus_layer": 7e6, "young_modulus_bulk": 20e3, "rms_height": 22.4e-6, "sphere_radius": 8e-3,
    ...         "normal_force": 0.2, "layer_thickness": 20e-6}
    >>> ranges = {name: (value, value) for name, value in ball.items()}
    >>> table = build_film_table(FilmTablePlan(ranges, spectrum=named_surface("paper_reference"), checked=0))
    >>> liquids = liquid_rows([FlowCurve([10.0, 100.0, 1000.0], [25.0, 23.5, 15.0])] * 2)
    >>> friction, viscosity = tabulated_friction_of_liquids(table, [1e-3, 1e-2],
    ...     balls=LubricatedBalls(parameters=ball, frictional_shear_stress=15e6), liquids=liquids)
    >>> print(friction.friction_coefficient.round(3), viscosity.viscosity.round(1), viscosity.unmeasured)
    [0.127 0.313] [25.  24.5] [False False]
    """
    found = _tabulated(table, sliding_speed, balls, liquids)
    return TabulatedFriction(*found[:-3]), EffectiveViscosity(*found[-3:])


def _tabulated(
    table: FilmTable, speed: ArrayLike, balls: LubricatedBalls, liquids: LiquidRows | None
) -> list[Any]:
    """Fields of a `TabulatedFriction`, with liquids those of an `EffectiveViscosity` after them; by parts of the vectors."""
    named = film_parameters(balls.parameters, 1.0)
    if wrong := sorted(set(named) ^ set(FILM_PARAMETERS)):
        raise InputError(
            f"The parameters of a film are {', '.join(FILM_PARAMETERS)}; missing or unknown: {', '.join(wrong)}."
        )
    parameters = [np.asarray(named[name], dtype=np.float64) for name in FILM_PARAMETERS]
    others = floats(speed, balls.frictional_shear_stress, balls.velocity_shift_factor)
    tissue = balls.tissue
    memory = [] if tissue is None else floats(tissue.strength, tissue.place, tissue.loss)
    given = np.broadcast_shapes(*(x.shape for x in (*parameters, *others, *memory)))
    if len(given) > 2:
        raise InputError(f"Arguments have the shape {given}, but need at most two axes: vectors and rows.")
    vectors, rows = shape = (1, 1, *given)[-2:]
    if liquids is not None and rows != liquids.liquid.size:
        raise InputError(
            f"There are flow curves for {liquids.liquid.size} rows, but the arguments have {rows} rows."
        )
    with np.errstate(all="ignore"):
        logs = [
            np.log(np.broadcast_to(x, (vectors, x.shape[-1] if x.ndim else 1)).astype(np.float64))
            for x in parameters
        ]
        whole_rows = [np.broadcast_to(x, shape) for x in others]
        memory = [np.broadcast_to(x, (vectors, x.shape[-1] if x.ndim else 1)) for x in memory]
        held = table.coefficients.shape[-1] * (max(rows, 1) if any(x.shape[1] > 1 for x in logs) else 1)
        pieces = _COEFFICIENTS // (
            1 if tissue is None else 4
        )  # a correction is as large again, and smooth films are beside it
        step = max(1, min(_POINTS // max(rows, 1), pieces // held))
        parts = [
            _part(
                table,
                [x[first : first + step] for x in logs],
                [np.ascontiguousarray(x[first : first + step]) for x in whole_rows],
                balls,
                liquids,
                [x[first : first + step] for x in memory],
            )
            for first in range(0, max(vectors, 1), step)
        ]
    whole = parts[0] if len(parts) == 1 else [np.concatenate(x) for x in zip(*parts, strict=True)]
    return [np.broadcast_to(x, shape).reshape(given)[()] for x in whole]


def _part(
    table: FilmTable,
    logs: list[FloatArray],
    others: list[FloatArray],
    balls: LubricatedBalls,
    liquids: LiquidRows | None,
    memory: list[FloatArray],
) -> tuple[FloatArray | BoolArray, ...]:
    speed, stress, shift = others
    if balls.tissue is None:
        films = contract(table, logs, 6 if balls.everything else 4)
    else:
        films = contract_remembering(table, balls.tissue, logs, memory)
    log_speed = np.maximum(np.log(speed), _STILL)
    log_shift = np.where(shift > 0, np.log(shift), np.nan)
    if liquids is None:
        return _friction(films, logs[0] + logs[2], log_speed + log_shift, stress, balls)
    log_viscosity, log_rate = viscosity_of_films(films, log_speed, log_shift, liquids)
    friction = _friction(films, logs[0] + logs[2], log_viscosity + log_speed + log_shift, stress, balls)
    good = np.isfinite(friction.friction_coefficient)
    unmeasured = good & ((log_rate < liquids.lowest) | (log_rate > liquids.highest))
    rate, viscosity = (np.where(good, np.exp(x), np.nan) for x in (log_rate, log_viscosity))
    return *friction, viscosity, rate, unmeasured


def _friction(
    films: ContractedFilms,
    log_stiffness: FloatArray,
    log_product: FloatArray,
    shear_stress: FloatArray,
    balls: LubricatedBalls,
) -> TabulatedFriction:
    """Friction at ln(aηv), shape ``(B, N)``; ``log_stiffness`` is ln E0 h, Pa m."""
    scales = films.scales
    log_number = log_product + scales.number_per_product
    strained = scales.strain > np.log(balls.largest_strain)
    beyond = log_number + 2 * scales.strain > np.log(balls.thickest_film)
    held = films.inside & ~(log_number > films.smooth.highest)
    good = held & ~strained & ~beyond & np.isfinite(log_number) & (shear_stress >= 0)
    log_number = np.where(good, log_number, films.anchor)
    wanted = _EVERYTHING if balls.everything else _FRICTION
    if films.log_loss is not None:
        wanted = (*wanted, HYSTERESIS)
    logs = dict(zip(wanted, films.log_outputs(log_number, wanted), strict=True))
    missing = np.where(good, 0.0, np.nan)
    boundary = shear_stress * np.exp(logs[BOUNDARY] - log_stiffness) + missing
    couette = np.exp(logs[COUETTE] + (log_number + scales.strain)) * (1 / (3 * np.pi)) + missing
    pressure = np.exp(logs[PRESSURE_FLOW] + scales.strain) * (1 / np.pi) + missing
    if films.end is not None:  # it is the whole drag of the liquid
        pressure = pressure - couette
    nothing = np.broadcast_to(np.nan, good.shape)
    total, hysteresis = boundary + couette + pressure, missing
    if films.log_loss is not None:
        weak = np.exp(logs[HYSTERESIS] + scales.strain + films.log_loss) * (8 / (3 * np.pi))
        hysteresis = SPHERE_OVER_CYLINDER * weak + missing
        total = total + hysteresis
    return TabulatedFriction(
        total,
        boundary,
        couette,
        pressure,
        np.minimum(np.exp(logs[FRACTION]), 1.0) + missing if balls.everything else nothing,
        np.exp(logs[MINIMUM] + scales.height) + missing if balls.everything else nothing,
        np.exp(logs[CENTRAL] + scales.height) + missing if balls.everything else nothing,
        np.broadcast_to(np.exp(scales.strain), good.shape),
        ~held,
        np.broadcast_to(strained, good.shape),
        beyond,
        hysteresis,
    )
