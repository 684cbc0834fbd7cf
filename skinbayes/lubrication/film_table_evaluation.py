"""Friction from a table of films, for many parameter vectors and rows at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.lubrication.effective_viscosity import EffectiveViscosity
from skinbayes.lubrication.film_axes import FILM_PARAMETERS, film_parameters
from skinbayes.lubrication.film_contraction import (
    BOUNDARY,
    CENTRAL,
    COUETTE,
    FRACTION,
    MINIMUM,
    PRESSURE_FLOW,
    ContractedFilms,
    contract,
)
from skinbayes.lubrication.film_table import FilmTable
from skinbayes.lubrication.film_viscosity import viscosity_of_films
from skinbayes.lubrication.flow_curves import LiquidRows
from skinbayes.lubrication.stribeck import LARGEST_STRAIN, THICKEST_FILM

_POINTS = 8192  # of vectors times rows worked on at a time: arrays stay in the cache
_COEFFICIENTS = (
    1 << 21
)  # numbers, at most, that the axes are summed up to at a time: 32 vectors of 165 rows in one piece
_STILL = -1e4  # ln of a speed of 0
_FRICTION, _EVERYTHING = (
    (BOUNDARY, COUETTE, PRESSURE_FLOW),
    (CENTRAL, BOUNDARY, COUETTE, PRESSURE_FLOW, MINIMUM, FRACTION),
)


class TabulatedFriction(NamedTuple):
    """Friction of lubricated balls from a table; all of the broadcast shape of the arguments, nan outside the table.

    Attributes
    ----------
    friction_coefficient : μ, sum of the three parts, dimensionless
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
    """

    friction_coefficient: FloatArray
    boundary: FloatArray
    couette: FloatArray
    pressure_flow: FloatArray
    asperity_load_fraction: FloatArray
    minimum_film: FloatArray
    central_film: FloatArray
    strain: FloatArray
    outside_table: NDArray[np.bool_]
    too_strained: NDArray[np.bool_]
    film_beyond_ball: NDArray[np.bool_]


def tabulated_friction(
    table: FilmTable,
    speed_viscosity_product: ArrayLike,
    *,
    parameters: Mapping[str, ArrayLike],
    frictional_shear_stress: ArrayLike,
    velocity_shift_factor: ArrayLike = 1.0,
    everything: bool = False,
    thickest_film: float = THICKEST_FILM,
    largest_strain: float = LARGEST_STRAIN,
) -> TabulatedFriction:
    """Friction coefficient of a ball on lubricated rough skin, as `stribeck_curve` gives it, from a table (Sect. 6 of the paper).

    Parameters
    ----------
    table : `FilmTable`
    speed_viscosity_product : ηv, N/m, ≥ 0, shape ``(N,)`` or ``(B, N)``, or a scalar; at 0 there is boundary friction
    parameters : `FILM_PARAMETERS` or `HOMOGENEOUS_PARAMETERS` by name, SI (Pa, m, N), each a
        scalar or of shape ``(B, 1)``, ``(N,)`` or ``(B, N)``
    frictional_shear_stress : σ_f, Pa, ≥ 0, broadcasts
    velocity_shift_factor : a, dimensionless, > 0, broadcasts; the theory is evaluated at a ηv
    everything : also give films and load fraction
    thickest_film, largest_strain : 3π ηv/f_N and b/Rc, dimensionless, beyond which nothing is predicted

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
    >>> from skinbayes.lubrication import build_film_table
    >>> from skinbayes.roughness import named_surface
    >>> ball = {"young_modulus_layer": 7e6, "young_modulus_bulk": 20e3, "rms_height": 22.4e-6, "sphere_radius": 8e-3,
    ...         "normal_force": 0.2, "layer_thickness": 20e-6}
    >>> ranges = {name: (value, value) for name, value in ball.items()}
    >>> table = build_film_table(ranges, named_surface("paper_reference"), checked=0)
    >>> print(tabulated_friction(table, [1e-6, 1e-3, 2e-2], parameters=ball,
    ...     frictional_shear_stress=15e6).friction_coefficient.round(3))
    [1.423 0.915 0.109]
    """
    arguments = _arguments(
        parameters, speed_viscosity_product, frictional_shear_stress, velocity_shift_factor
    )

    def part(vectors: slice) -> TabulatedFriction:
        logs, (product, stress, shift) = arguments.part(vectors)
        films = contract(table, logs, 6 if everything else 4)
        return _friction(
            films,
            logs[0] + logs[2],
            _logarithm(product) + np.where(shift > 0, np.log(shift), np.nan),
            stress,
            everything,
            thickest_film,
            largest_strain,
        )

    return TabulatedFriction(*arguments.collect(part, table.coefficients.shape[-1]))


def tabulated_friction_of_liquids(
    table: FilmTable,
    sliding_speed: ArrayLike,
    *,
    liquids: LiquidRows,
    parameters: Mapping[str, ArrayLike],
    frictional_shear_stress: ArrayLike,
    velocity_shift_factor: ArrayLike = 1.0,
    everything: bool = False,
    thickest_film: float = THICKEST_FILM,
    largest_strain: float = LARGEST_STRAIN,
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
    liquids : the liquid of each of N rows, from `liquid_rows`
    parameters : `FILM_PARAMETERS` or `HOMOGENEOUS_PARAMETERS` by name, SI (Pa, m, N), each a
        scalar or of shape ``(B, 1)``, ``(N,)`` or ``(B, N)``
    frictional_shear_stress : σ_f, Pa, ≥ 0, broadcasts
    velocity_shift_factor : a, dimensionless, > 0, broadcasts; the shear rate is that of the speed without it
    everything : also give films and load fraction
    thickest_film, largest_strain : 3π ηv/f_N and b/Rc, dimensionless, beyond which nothing is predicted

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
    >>> from skinbayes.lubrication import FlowCurve, build_film_table, liquid_rows
    >>> from skinbayes.roughness import named_surface
    >>> ball = {"young_modulus_layer": 7e6, "young_modulus_bulk": 20e3, "rms_height": 22.4e-6, "sphere_radius": 8e-3,
    ...         "normal_force": 0.2, "layer_thickness": 20e-6}
    >>> ranges = {name: (value, value) for name, value in ball.items()}
    >>> table = build_film_table(ranges, named_surface("paper_reference"), checked=0)
    >>> liquids = liquid_rows([FlowCurve([10.0, 100.0, 1000.0], [25.0, 23.5, 15.0])] * 2)
    >>> friction, viscosity = tabulated_friction_of_liquids(table, [1e-3, 1e-2], liquids=liquids,
    ...     parameters=ball, frictional_shear_stress=15e6)
    >>> print(friction.friction_coefficient.round(3), viscosity.viscosity.round(1), viscosity.unmeasured)
    [0.108 0.325] [25.  24.6] [False False]
    """
    arguments = _arguments(parameters, sliding_speed, frictional_shear_stress, velocity_shift_factor)
    rows = liquids.liquid.size
    if arguments.shape[1] != rows:
        raise InputError(
            f"There are flow curves for {rows} rows, but the arguments have {arguments.shape[1]} rows."
        )

    def part(vectors: slice) -> tuple[FloatArray | NDArray[np.bool_], ...]:
        logs, (speed, stress, shift) = arguments.part(vectors)
        films = contract(table, logs, 6 if everything else 4)
        log_speed = _logarithm(speed)
        log_shift = np.where(shift > 0, np.log(shift), np.nan)
        log_viscosity, log_rate = viscosity_of_films(films, log_speed, log_shift, liquids)
        log_product = log_viscosity + log_speed + log_shift
        friction = _friction(
            films, logs[0] + logs[2], log_product, stress, everything, thickest_film, largest_strain
        )
        good = np.isfinite(friction.friction_coefficient)
        unmeasured = good & ((log_rate < liquids.lowest) | (log_rate > liquids.highest))
        rate, viscosity = (np.where(good, np.exp(x), np.nan) for x in (log_rate, log_viscosity))
        return *friction, viscosity, rate, unmeasured

    found = arguments.collect(part, table.coefficients.shape[-1])
    return TabulatedFriction(*found[:-3]), EffectiveViscosity(*found[-3:])


class _Arguments:
    """Arguments brought to the shapes (B, 1) and (B, N), handed out in parts and put together again."""

    def __init__(self, parameters: list[FloatArray], others: list[FloatArray]) -> None:
        shapes = [np.shape(x) for x in (*parameters, *others)]
        self.given = np.broadcast_shapes(*shapes)
        vectors, rows = (1, 1, *self.given)[-2:]
        self.shape = (vectors, rows)
        if len(self.given) > 2:
            raise InputError(
                f"Arguments have the shape {self.given}, but need at most two axes: vectors and rows."
            )
        with np.errstate(all="ignore"):
            self.logs = [
                np.log(np.broadcast_to(x, (vectors, np.shape(x)[-1] if np.ndim(x) else 1)).astype(np.float64))
                for x in parameters
            ]
        self.others = [np.broadcast_to(x, self.shape) for x in others]

    def part(self, vectors: slice) -> tuple[list[FloatArray], list[FloatArray]]:
        return [x[vectors] for x in self.logs], [np.ascontiguousarray(x[vectors]) for x in self.others]

    def collect(
        self, function: Callable[[slice], tuple[FloatArray | NDArray[np.bool_], ...]], columns: int
    ) -> list[Any]:
        vectors, rows = self.shape
        by_row = any(x.shape[1] > 1 for x in self.logs)
        step = max(
            1, min(_POINTS // max(rows, 1), _COEFFICIENTS // (columns * (max(rows, 1) if by_row else 1)))
        )
        with np.errstate(all="ignore"):
            parts = [function(slice(first, first + step)) for first in range(0, max(vectors, 1), step)]
        whole = parts[0] if len(parts) == 1 else [np.concatenate(x) for x in zip(*parts, strict=True)]
        return [np.broadcast_to(x, self.shape).reshape(self.given)[()] for x in whole]


def _arguments(parameters: Mapping[str, ArrayLike], *others: ArrayLike) -> _Arguments:
    parameters = film_parameters(parameters, 1.0)
    wrong = sorted(set(parameters) ^ set(FILM_PARAMETERS))
    if wrong:
        raise InputError(
            f"The parameters of a film are {', '.join(FILM_PARAMETERS)}; missing or unknown: {', '.join(wrong)}."
        )
    named = [np.asarray(parameters[name], dtype=np.float64) for name in FILM_PARAMETERS]
    return _Arguments(named, [np.asarray(x, dtype=np.float64) for x in others])


def _logarithm(values: FloatArray) -> FloatArray:
    """ln of speeds; that of 0 is so far below any other that exp of it is 0, but leaves arithmetic sound."""
    return np.maximum(np.log(values), _STILL)


def _friction(
    films: ContractedFilms,
    log_stiffness: FloatArray,
    log_product: FloatArray,
    shear_stress: FloatArray,
    everything: bool,
    thickest_film: float,
    largest_strain: float,
) -> TabulatedFriction:
    """Friction at ln(aηv), shape ``(B, N)``; ``log_stiffness`` is ln E0 h, Pa m."""
    scales = films.scales
    log_number = log_product + scales.number_per_product
    strained = scales.strain > np.log(largest_strain)
    beyond = log_number + 2 * scales.strain > np.log(thickest_film)
    held = films.inside & ~(log_number > films.smooth.highest)
    good = held & ~strained & ~beyond & np.isfinite(log_number) & (shear_stress >= 0)
    log_number = np.where(good, log_number, films.anchor)
    wanted = _EVERYTHING if everything else _FRICTION
    logs = dict(zip(wanted, films.log_outputs(log_number, wanted), strict=True))
    missing = np.where(good, 0.0, np.nan)
    boundary = shear_stress * np.exp(logs[BOUNDARY] - log_stiffness) + missing
    couette = np.exp(logs[COUETTE] + (log_number + scales.strain)) * (1 / (3 * np.pi)) + missing
    pressure = np.exp(logs[PRESSURE_FLOW] + scales.strain) * (1 / np.pi) + missing
    nothing = np.broadcast_to(np.nan, good.shape)
    return TabulatedFriction(
        boundary + couette + pressure,
        boundary,
        couette,
        pressure,
        np.minimum(np.exp(logs[FRACTION]), 1.0) + missing if everything else nothing,
        np.exp(logs[MINIMUM] + scales.height) + missing if everything else nothing,
        np.exp(logs[CENTRAL] + scales.height) + missing if everything else nothing,
        np.broadcast_to(np.exp(scales.strain), good.shape),
        ~held,
        np.broadcast_to(strained, good.shape),
        beyond,
    )
