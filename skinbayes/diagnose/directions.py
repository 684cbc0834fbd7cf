"""From sensitivities to findings: which directions a group of rows informs, and which changes nobody notices."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.diagnose.combinations import (
    WEAK,
    Decomposition,
    decompose,
    nice,
    normalised,
    simplest_basis,
    typical,
    with_derived,
)
from skinbayes.diagnose.findings import Combination, Equivalent, Freedom, RowGroup
from skinbayes.diagnose.formulas import change, product
from skinbayes.diagnose.rule import UNCHANGED
from skinbayes.diagnose.sensitivities import IntArray, Sensitivities

INFORMED = float(np.sqrt(1.0 / UNCHANGED**2 - 1.0))
"""Singular value at which the posterior standard deviation is 0.9 of the prior one."""


def spread_ratios(parts: Decomposition, functionals: FloatArray) -> list[float]:
    """Posterior over prior standard deviation of linear functionals of the scaled parameters, medians over the points.

    ``functionals`` has shape ``(F, D)``, or ``(B, F, D)`` if they differ from point to point.
    """
    along = np.matmul(functionals, np.swapaxes(parts.vectors, 1, 2))
    variance = (along**2 / (1.0 + parts.values[:, None, :] ** 2)).sum(axis=2) / (along**2).sum(axis=2)
    return [float(value) for value in np.median(np.sqrt(variance), axis=0)]


def group_finding(
    found: Sensitivities, label: str, noise: FloatArray, rows: IntArray, count: int
) -> RowGroup:
    """What the rows ``rows``, ``count`` data, determine, given the noise of each row of the problem (shape ``(N,)``)."""
    scaled = found.scaled(noise, rows)
    parts = decompose(scaled)
    counts = (parts.values >= INFORMED).sum(axis=1)
    rank = int(np.median(counts))
    vectors = simplest_basis(parts.vectors[:, :rank, :]) if rank else []
    combinations = [_combination(found, vector, parts, rows) for vector in vectors]
    low, high = np.quantile(counts, [0.05, 0.95])
    effect = np.quantile(np.linalg.norm(scaled, axis=1), 0.9, axis=0)
    return RowGroup(
        label=label,
        rows=count,
        directions=rank,
        directions_range=(round(float(low)), round(float(high))),
        spread_ratios=tuple(
            float(v) for v in np.median(1.0 / np.sqrt(1.0 + parts.values[:, :rank] ** 2), axis=0)
        ),
        combinations=tuple(c for c in combinations if c.nameable),
        silent=tuple(name for name, size in zip(found.names, effect, strict=True) if size < INFORMED),
    )


def _combination(
    found: Sensitivities, vector: FloatArray, parts: Decomposition, rows: IntArray
) -> Combination:
    rest, powers = with_derived(vector, found.derived_for(rows))
    names = (*found.names, *powers)
    logs = (*found.logarithmic, *(True for _ in powers))
    effects = np.quantile(np.abs(rest), 0.9, axis=0)  # the largest entry of vector is one
    strong = np.concatenate([effects >= WEAK, np.ones(len(powers), dtype=bool)])
    exponents = np.column_stack([rest / found.prior_spread, *powers.values()])
    exponents = normalised(exponents, strong, np.array(logs))
    low, middle, high = np.quantile(exponents, [0.05, 0.5, 0.95], axis=0)
    shown = {names[i]: i for i in np.flatnonzero(strong)}
    fractions = {name: nice(exponents[:, i]) for name, i in shown.items()}
    written = {name: (low[i], middle[i], high[i], fractions[name]) for name, i in shown.items() if logs[i]}
    typed = {name: fractions[name] or float(middle[i]) for name, i in shown.items()}  # no fraction is 0
    audible = (
        np.quantile(np.linalg.norm(parts.values[:, :, None] * parts.vectors, axis=1), 0.9, axis=0) >= INFORMED
    )
    small = (effects > 1e-3) & (effects < WEAK) & audible
    weak = tuple(name for name, is_small in zip(found.names, small, strict=True) if is_small)
    return Combination(
        text=product(written, [name for name, i in shown.items() if not logs[i]]),
        exponents=typed,
        ranges={name: (float(low[i]), float(high[i])) for name, i in shown.items()},
        exact=not weak
        and all(high[i] - typed[name] < 0.005 and typed[name] - low[i] < 0.005 for name, i in shown.items()),
        constant=all(high[i] - low[i] <= 2.0 * 0.05 * max(1.0, abs(middle[i])) for i in shown.values()),
        weak=weak,
        spread_ratio=spread_ratios(parts, vector[:, None, :])[0],
    )


def _renamed(
    combination: Combination, parameter: str, derived: str, power: float, found: Sensitivities
) -> str:
    """The text of a combination with ``derived`` ∝ ``parameter``^``power`` in the place of ``parameter``."""
    other = {name for name, log in zip(found.names, found.logarithmic, strict=True) if not log}
    written: dict[str, tuple[float, float, float, float | None]] = {}
    for name, value in combination.exponents.items():
        if name not in other:
            factor = 1.0 / power if name == parameter else 1.0
            low, high = sorted(factor * end for end in combination.ranges[name])
            exponent = factor * value
            written[derived if name == parameter else name] = (
                low,
                exponent,
                high,
                nice(np.array([exponent])),
            )
    return product(written, [name for name in combination.exponents if name in other])


def equivalents(found: Sensitivities, groups: tuple[RowGroup, ...]) -> tuple[Equivalent, ...]:
    """Derived quantities that are a power of one parameter of a named combination, the same for all rows."""
    result = []
    for name, slopes in found.derived.items():
        flat = slopes if slopes.ndim == 3 else slopes[:, None, :]
        strong = typical((flat * found.prior_spread).reshape(-1, flat.shape[-1])) >= 0.01
        if strong.sum() != 1:
            continue
        column = int(np.flatnonzero(strong)[0])
        power = nice(flat[:, :, column].ravel())
        parameter = found.names[column]
        reads = [
            _renamed(c, parameter, name, power, found)
            for group in groups
            for c in group.combinations
            if power is not None and parameter in c.exponents and len(c.exponents) > 1 and c.constant
        ]
        if power is not None and reads and found.logarithmic[column]:
            result.append(Equivalent(name, parameter, power, tuple(dict.fromkeys(reads))))
    return tuple(result)


def freedoms(found: Sensitivities, scaled: FloatArray, columns: IntArray) -> tuple[Freedom, ...]:
    """Directions among the influential parameters that are not informed, if they move more than one of them."""
    if not len(columns):
        return ()
    inner = scaled[:, :, columns]
    parts = decompose(inner)
    rank = int(np.median((parts.values >= INFORMED).sum(axis=1)))
    if rank == len(columns):
        return ()
    found_freedoms = []
    for vector in simplest_basis(parts.vectors[:, rank:, :]):
        moved = np.flatnonzero(typical(vector) >= WEAK)
        if len(moved) < 2:
            continue
        total = np.linalg.norm(np.einsum("bnd,bd->bn", inner, vector), axis=1)
        terms = np.linalg.norm(np.linalg.norm(inner, axis=1) * vector, axis=1)
        relative = np.array([found.logarithmic[columns[i]] for i in moved])
        steps = (vector * found.prior_spread[columns])[:, moved]
        largest = np.abs(steps[:, relative] if relative.any() else steps).max(axis=1, keepdims=True)
        # a member of the batch that does not move here has no proportion
        steps, largest = (x[largest[:, 0] > 0] for x in (steps, largest))
        steps = (
            steps / largest * (np.log(1.1) if relative.any() else 0.1 * found.prior_spread[columns[moved[0]]])
        )
        steps *= np.where(steps[:, :1] < 0.0, -1.0, 1.0)
        middle = np.median(steps, axis=0)
        deviation = np.quantile(np.abs(steps - middle), 0.9, axis=0)
        amounts = np.where(relative, np.expm1(middle), middle)
        constant = bool((deviation <= 0.1 * np.abs(middle).max()).all())
        moved_names = [found.names[columns[i]] for i in moved]
        found_freedoms.append(
            Freedom(
                changes=dict(zip(moved_names, (float(a) for a in amounts), strict=True)),
                text=change(moved_names, amounts, relative.tolist(), constant),
                exact=bool(np.quantile(total / np.maximum(terms, 1e-300), 0.9) < 1e-4),
                constant=constant,
            )
        )
    return tuple(found_freedoms)
