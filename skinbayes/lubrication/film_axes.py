"""Which combinations of parameters a lubricated ball depends on, and the axes of a table of films.

The dimensionless film depends on λ and on the asperity law in units of the contact. For a spectrum of given shape and a layer
of given thickness ``p_a = E0 h g(ū/h; E1/E0)``, so that three numbers remain: E1/E0, b through F R/E1, and h Rc/b², for which
h R stands at given b. All are products of powers: linear in the logarithms of the parameters.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import NamedTuple, TypeVar

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.contact.line_contact import cylinder_of_sphere, line_contact
from skinbayes.contact.solid import reduced_modulus
from skinbayes.errors import InputError

FILM_PARAMETERS = (
    "young_modulus_layer", "young_modulus_bulk", "rms_height", "sphere_radius", "normal_force", "layer_thickness",
)  # fmt: skip
"""Parameters of the film, in the order of all arrays; SI."""

HOMOGENEOUS_PARAMETERS = ("young_modulus", *FILM_PARAMETERS[2:5])
"""Parameters of the film of a ball on a homogeneous solid; SI."""

UNITS = ("Pa", "Pa", "m", "m", "N", "m")

# exponents of E1/E0, h R, d and F R/E1; the last is the only one with the normal force
_INVARIANTS = np.array(
    [
        [-1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        [0.0, -1.0, 0.0, 1.0, 1.0, 0.0],
    ]
)
_INVARIANT_NAMES = (
    "young_modulus_bulk / young_modulus_layer",
    "rms_height × sphere_radius",
    "layer_thickness",
    "normal_force × sphere_radius / young_modulus_bulk",
)

# nodes of an axis beyond the first four, by unit of ln: of the invariants and of the parameters themselves
_FIRST_NODES = 4
_INVARIANT_NODES = (0.8, 0.85, 0.7, 0.8)
_PARAMETER_NODES = (0.8, 1.0, 0.9, 1.1, 0.8, 0.7)

_STRAIN = "normal_force"  # what the name of the invariant F R/E1 starts with
_RADIUS = 3  # place of R among the parameters

_SLACK = 1e-9  # of ln: how far rounding may carry a parameter out of its range

FULLEST = 0.3
"""Largest p_H/√V, dimensionless, in a table: beyond, contact comes close to complete."""

_BEND = 0.4  # width over which the end of an axis turns from the range to the fullest contact
_NARROWEST = 0.8  # the end leaves this much of the axis, from −1


class Scales(NamedTuple):
    """ln of the scales of a lubricated ball; broadcast shape of the parameters.

    Attributes
    ----------
    number_per_product : ln λ/(ηv), λ/(ηv) in m/N
    strain : ln b/Rc, dimensionless
    height : ln b²/Rc, m
    """

    number_per_product: FloatArray
    strain: FloatArray
    height: FloatArray


def unit_contact(poisson_ratio_bulk: float) -> tuple[float, float]:
    """ln b and ln Rc (m) of a ball of 1 m on tissue of E1 = 1 Pa under 1 N; b goes as (F R/E1)^(1/3), Rc as R."""
    modulus = reduced_modulus(1.0, poisson_ratio_bulk)
    cylinder = cylinder_of_sphere(1.0, 1.0, reduced_modulus=modulus)
    line = line_contact(cylinder.load_per_length, cylinder.cylinder_radius, reduced_modulus=modulus)
    return float(np.log(line.half_width)), float(np.log(cylinder.cylinder_radius))


def film_scales(log_parameters: Sequence[FloatArray], poisson_ratio_bulk: float) -> Scales:
    """Scales of the contact of Eq. 9 of the paper; ``λ = 12 ηv Rc³/(E1* b⁴)``.

    Parameters
    ----------
    log_parameters : ln of the `FILM_PARAMETERS` in SI, six arrays that broadcast
    poisson_ratio_bulk : ν1, dimensionless

    Returns
    -------
    scales : `Scales`
    """
    _, bulk, _, radius, force, _ = log_parameters
    half_width, cylinder = unit_contact(poisson_ratio_bulk)
    modulus = float(np.log(reduced_modulus(1.0, poisson_ratio_bulk)))
    number = np.log(12.0) + 3 * cylinder - 4 * half_width - modulus
    return Scales(
        number + (5 * radius + bulk - 4 * force) / 3,
        half_width - cylinder + (force - bulk - 2 * radius) / 3,
        2 * half_width - cylinder + (2 * force - 2 * bulk - radius) / 3,
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmAxes:
    """Axes of a table: linear combinations of the ln of the `FILM_PARAMETERS`, each scaled to −1 … 1.

    Those of a homogeneous solid have E0 = E1 = E, and a thickness that does not matter.

    Attributes
    ----------
    names : what each axis is, A names
    combination : coordinates are ``combination @ ln p − offset``, dimensionless, shape ``(A, 6)``
    offset : dimensionless, shape ``(A,)``
    excluded : combinations of ln p that the table cannot vary, dimensionless, shape ``(R, 6)``
    excluded_at : their values, dimensionless, shape ``(R,)``
    reference : ln of the parameters (Pa, m, N) in the middle of their ranges, shape ``(6,)``
    low, high : ln of the ends of the ranges (Pa, m, N), shape ``(6,)`` each
    ended : the axis that ends where contact is fullest, the force or the roughness; -1 if all ranges end before,
        dimensionless
    side : 1.0 if it is the upper end of that axis, -1.0 if the lower one, dimensionless
    end : the coordinate of that end is ``end @ ln p − end_offset``, dimensionless, shape ``(6,)``
    end_offset : dimensionless
    counts : number of nodes of each axis, dimensionless, A integers
    homogeneous : the solid has no layer
    """

    names: tuple[str, ...]
    combination: FloatArray
    offset: FloatArray
    excluded: FloatArray
    excluded_at: FloatArray
    reference: FloatArray
    low: FloatArray
    high: FloatArray
    ended: int
    side: float
    end: FloatArray
    end_offset: float
    counts: tuple[int, ...]
    homogeneous: bool = False

    def coordinates(self, log_parameters: Sequence[FloatArray]) -> list[FloatArray]:
        """Coordinates, dimensionless, −1 … 1 inside; each has the common shape of the parameters that enter it."""
        found = [
            _combine(row, log_parameters) - shift
            for row, shift in zip(self.combination, self.offset, strict=True)
        ]
        if self.ended >= 0:
            stretch = 2 / (1 - self._end(log_parameters))
            found[self.ended] = self.side * ((1 + self.side * found[self.ended]) * stretch - 1)
        return found

    def _end(self, log_parameters: Sequence[FloatArray]) -> FloatArray:
        """The end as a lower one: the larger of −1 and the fullest contact, without a corner; below 1."""
        fullest = -self.side * (_combine(self.end, log_parameters) - self.end_offset)
        end = -1 + _BEND * np.logaddexp(0.0, (fullest + 1) / _BEND)
        return np.asarray(_NARROWEST - _BEND * np.logaddexp(0.0, (_NARROWEST - end) / _BEND))

    def contains(self, log_parameters: Sequence[FloatArray]) -> BoolArray:
        """Where the table holds the parameters, or similar ones; boolean of broadcast shape."""
        inside = np.ones(np.broadcast_shapes(*(np.shape(p) for p in log_parameters)), dtype=bool)
        for coordinate in self.coordinates(log_parameters):
            inside = inside & (np.abs(coordinate) <= 1 + _SLACK)
        for row, value in zip(self.excluded, self.excluded_at, strict=True):
            inside = inside & (np.abs(_combine(row, log_parameters) - value) <= _SLACK)
        return inside

    def representative(self, coordinates: FloatArray) -> FloatArray:
        """ln of parameters (SI, shape ``(..., 6)``) with given coordinates, shape ``(..., A)``; similar ones do the same."""
        at_reference = self.combination @ self.reference - self.offset
        free = np.where(self.high > self.low, self.combination, 0.0)
        inverse = np.linalg.pinv(free) if len(self.names) else np.zeros((6, 0))
        plain = np.array(coordinates, dtype=np.float64)
        if self.ended >= 0:
            # where the end is depends on the other axes only
            others = self.tied(self.reference + (plain - at_reference) @ inverse.T)
            shrink = (1 - self._end(list(np.moveaxis(others, -1, 0)))) / 2
            plain[..., self.ended] = self.side * ((1 + self.side * plain[..., self.ended]) * shrink - 1)
        return self.tied(self.reference + (plain - at_reference) @ inverse.T)

    def tied(self, log_parameters: FloatArray) -> FloatArray:
        """The same ln of parameters, shape ``(..., 6)``, with E0 = E1 if the solid is homogeneous."""
        if self.homogeneous:
            log_parameters[..., 0] = log_parameters[..., 1]
        return log_parameters


def _combine(row: FloatArray, log_parameters: Sequence[FloatArray]) -> FloatArray:
    parts = [
        factor * part if factor != 1 else part
        for factor, part in zip(row.tolist(), log_parameters, strict=True)
        if factor
    ]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return np.asarray(total)


def film_axes(
    ranges: Mapping[str, tuple[float, float]],
    poisson_ratio_bulk: float = 0.5,
    *,
    counts: Mapping[str, int] | None = None,
    largest_strain: float = np.inf,
    stress_scale: float | None = None,
    radius_matters: bool = False,
) -> FilmAxes:
    """Axes for parameters that vary within ranges: as few as the similarity of the problem allows (Sect. 6 of the paper).

    If no more parameters vary than combinations of them matter, they are the axes; else the combinations E1/E0, h R and
    F R/E1 are. The layer thickness, where it varies, is an axis of its own.

    Parameters
    ----------
    ranges : smallest and largest value of each of the `FILM_PARAMETERS`, or of the `HOMOGENEOUS_PARAMETERS`, SI (Pa, m, N);
        equal for a fixed one
    poisson_ratio_bulk : ν1, dimensionless
    counts : number of nodes of an axis, dimensionless, by its name; from the width of its range unless told otherwise
    largest_strain : b/Rc, dimensionless, beyond which no contact is wanted; it shortens the axis F R/E1
    radius_matters : the drag of a ball ends at its edge, so that R matters beside the combinations: an axis of its own where
        the others do not determine it
    stress_scale : √V/(E0 h_rms), 1/m, of the rough surface; with it an axis ends where contact is fullest

    Returns
    -------
    axes : `FilmAxes`

    Raises
    ------
    InputError
        if a range is missing, unknown, or not of two finite numbers > 0 in rising order

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6).

    Examples
    --------
    >>> fixed = {"young_modulus_layer": (7e6, 7e6), "sphere_radius": (8e-3, 8e-3), "layer_thickness": (2e-5, 2e-5)}
    >>> ranges = {**fixed, "young_modulus_bulk": (1e4, 1e5), "rms_height": (1e-5, 3e-5), "normal_force": (0.2, 0.2)}
    >>> film_axes(ranges).names
    ('young_modulus_bulk', 'rms_height')
    >>> film_axes({**ranges, "young_modulus_layer": (1e6, 1e7), "normal_force": (0.2, 0.5)}).names[2]
    'normal_force × sphere_radius / young_modulus_bulk'
    """
    low, high = range_logarithms(ranges)
    homogeneous = "young_modulus" in ranges
    if homogeneous:
        low[0] = high[0] = (low[1] + high[1]) / 2  # it goes with E1
    kept = [1, 3] if homogeneous else list(range(len(_INVARIANTS)))
    spoken = [
        name.removesuffix("_bulk") if homogeneous else name for name in (*_INVARIANT_NAMES, *FILM_PARAMETERS)
    ]
    invariants, invariant_names = _INVARIANTS[kept], [spoken[row] for row in kept]
    reference = (low + high) / 2
    varying = np.flatnonzero(high > low)
    influence = invariants[:, varying]
    rows = np.flatnonzero(np.abs(influence).any(axis=1))
    if len(varying) <= len(rows):
        names = tuple(spoken[len(_INVARIANTS) + place] for place in varying)
        chosen, inverse = _solve_for(influence, len(varying))
        combination = inverse @ invariants[chosen]
        density = [_PARAMETER_NODES[place] for place in varying]
    else:
        names = tuple(invariant_names[row] for row in rows)
        combination = invariants[rows]
        if radius_matters and _RADIUS in varying:
            names = (*names, FILM_PARAMETERS[_RADIUS])
            combination = np.vstack([combination, np.eye(6)[_RADIUS]])
        density = [*(_INVARIANT_NODES[kept[row]] for row in rows), *[0.0] * (len(names) - len(rows))]
    # the force last: it is the one that differs from row to row of a data set
    order = sorted(range(len(names)), key=lambda place: bool(combination[place, 4]))
    names = tuple(names[place] for place in order)
    combination = combination[order].reshape(-1, 6)
    start = np.where(combination > 0, combination * low, combination * high).sum(axis=1)
    end = np.where(combination > 0, combination * high, combination * low).sum(axis=1)
    strains = [place for place, name in enumerate(names) if name.startswith(_STRAIN)]
    if len(varying) > len(rows) and strains and largest_strain < np.inf:
        half_width, cylinder = unit_contact(poisson_ratio_bulk)
        most = 3 * (np.log(largest_strain) + cylinder + high[3] - half_width)
        end[strains[0]] = min(end[strains[0]], max(most, start[strains[0]] + 1e-3))
    half = (end - start) / 2
    everything = np.vstack([invariants, np.eye(6)[_RADIUS]]) if radius_matters else invariants
    excluded = _complement(everything[:, varying]) @ everything
    if homogeneous:
        excluded = np.vstack([excluded, _INVARIANTS[0]])  # E1/E0 is 1
    wanted = dict(counts or {})
    axes = FilmAxes(
        names=names,
        combination=combination / half[:, None],
        offset=(start + half) / half,
        excluded=excluded,
        excluded_at=excluded @ reference,
        reference=reference,
        low=low,
        high=high,
        ended=-1,
        side=1.0,
        end=np.zeros(6),
        end_offset=0.0,
        counts=tuple(
            wanted.get(name, _FIRST_NODES + int(np.ceil(2 * width * density[place])))
            for name, width, place in zip(names, half.tolist(), order, strict=True)
        ),
        homogeneous=homogeneous,
    )
    return axes if stress_scale is None else _with_end(axes, poisson_ratio_bulk, stress_scale)


def _with_end(axes: FilmAxes, poisson_ratio_bulk: float, stress_scale: float) -> FilmAxes:
    """End the axis of the force, or that of the roughness, where p_H/√V is `FULLEST`, if that is anywhere inside."""
    forced, rough = (
        [place for place, name in enumerate(axes.names) if name.startswith(start)]
        for start in ("normal_force", "rms_height")
    )
    # p_H = E1* (b/Rc)/2 and b/Rc goes as (F/(E1 R²))^(1/3)
    half_width, cylinder = unit_contact(poisson_ratio_bulk)
    modulus = float(np.log(reduced_modulus(1.0, poisson_ratio_bulk)))
    level = half_width - cylinder + modulus - np.log(2 * FULLEST * stress_scale)
    if forced:
        place, parameter, side = forced[0], 4, 1.0
        limit, limit_level = np.array([3.0, -2.0, 3.0, 2.0, 0.0, 0.0]), -3 * level  # of ln F
    elif rough:
        place, parameter, side = rough[0], 2, -1.0
        limit, limit_level = np.array([-1.0, 2 / 3, 0.0, -2 / 3, 1 / 3, 0.0]), level  # of ln h
    else:
        return axes
    weight = axes.combination[place, parameter]
    end = axes.combination[place] + weight * limit
    end[parameter] = 0.0
    end = np.where(np.abs(end) < 1e-12, 0.0, end)
    offset = float(axes.offset[place] - weight * limit_level)
    corners = np.array(list(product((-1.0, 1.0), repeat=len(axes.names))))
    fullest = -side * (axes.representative(corners) @ end - offset)
    if fullest.max() < -1 - 4 * _BEND:
        return axes
    return replace(axes, ended=place, side=side, end=end, end_offset=offset)


def range_logarithms(ranges: Mapping[str, tuple[float, float]]) -> tuple[FloatArray, FloatArray]:
    """ln of the ends of the ranges, SI, shape ``(6,)`` each; `InputError` if a range is missing or wrong."""
    ranges = film_parameters(ranges, (1.0, 1.0))
    unknown = sorted(set(ranges) ^ set(FILM_PARAMETERS))
    if unknown:
        raise InputError(
            f"The ranges of a table of films name {', '.join(sorted(ranges))}, but need exactly {', '.join(FILM_PARAMETERS)}."
        )
    ends = np.array([[float(end) for end in ranges[name]] for name in FILM_PARAMETERS])
    for name, unit, (low, high) in zip(FILM_PARAMETERS, UNITS, ends.tolist(), strict=True):
        if not 0 < low <= high < np.inf:
            raise InputError(
                f"{name} ranges from {low:g} to {high:g} {unit}, but needs two finite numbers > 0 {unit} in rising order."
            )
    return np.log(ends[:, 0]), np.log(ends[:, 1])


Given = TypeVar("Given")


def film_parameters(given: Mapping[str, Given], no_thickness: Given) -> dict[str, Given]:
    """`FILM_PARAMETERS` of what may be `HOMOGENEOUS_PARAMETERS`, SI; a thickness that does not matter is ``no_thickness``."""
    named = dict(given)
    if "young_modulus" in named and not {"young_modulus_layer", "young_modulus_bulk"} & set(named):
        named["young_modulus_layer"] = named["young_modulus_bulk"] = named.pop("young_modulus")
        named.setdefault("layer_thickness", no_thickness)
    return named


def _solve_for(influence: FloatArray, count: int) -> tuple[list[int], FloatArray]:
    """Rows that determine the varying parameters, and the matrix that does so."""
    for rows in combinations(range(len(influence)), count):
        block = influence[list(rows)]
        if abs(np.linalg.det(block)) > 0.5:
            return list(rows), np.round(np.linalg.inv(block)) + 0.0
    raise AssertionError("the parameters depend on each other")


def _complement(influence: FloatArray) -> FloatArray:
    """Combinations of the invariants that the varying parameters leave alone, shape ``(R, 4)``."""
    left, sizes, _ = (
        np.linalg.svd(influence) if influence.size else (np.eye(len(influence)), np.zeros(0), None)
    )
    rest = left[:, int(np.count_nonzero(sizes > 1e-9)) :].T
    return np.asarray(np.where(np.abs(rest) < 1e-12, 0.0, rest))
