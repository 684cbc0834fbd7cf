"""Curves of the forward model over the posterior: which rows share one, and its quantiles."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import is_logarithmic, row_names
from skinbayes.plot.discrepancy import curves_of
from skinbayes.plot.numbers import quantity
from skinbayes.plot.predictive import LEVELS
from skinbayes.problem.covariates import factor_key
from skinbayes.statistics.quantiles import finite_quantiles
from skinbayes.vocabulary import QUANTITIES

if TYPE_CHECKING:
    from skinbayes.fit.result import FitResult
    from skinbayes.forward import Profile
    from skinbayes.problem import Problem
    from skinbayes.problem.inputs import Conditions

DRAWS = 200
"""Posterior draws that a band is made of."""

MOST_CURVES = 4

MOST_KINDS = 200
"""Kinds of rows whose curves are looked at to find the lowest and the highest."""

SAME = 1e-3
"""Rows whose curves agree within this relative difference share one curve."""


@dataclass(frozen=True)
class Band:
    """One curve.

    Attributes
    ----------
    label : whose curve it is
    rows : the rows that share it
    abscissa : shape ``(K,)``, SI
    quantiles : 5, 25, 50, 75 and 95 % quantiles of the ordinate, shape ``(5, K)``, SI
    theory : where ``quantiles`` contain a discrepancy, the median without it, shape ``(K,)``, SI
    """

    label: str
    rows: list[int]
    abscissa: FloatArray
    quantiles: FloatArray
    theory: FloatArray | None = None


def profile_bands(fit: FitResult, problem: Problem, profile: Profile) -> list[Band]:
    """The curves of one profile, at most four, each for a group of rows that share it."""
    theta = fit.theta()
    middle = np.median(theta, axis=0, keepdims=True)
    theta = theta[:: max(1, len(theta) // DRAWS)]
    groups = _groups(problem, profile, middle)
    shared = len(groups) == 1
    names, bands = row_names(fit), []
    for position, rows in groups:
        abscissa, curves = curve_at_row(problem, profile, theta, rows[0])
        # where the theory gives no value for some of the draws, the others make the band
        quantiles = finite_quantiles(curves, LEVELS)
        label = position + _row_text(problem, names, rows, shared) + _load(problem, middle, rows)
        bands.append(Band(label, rows, abscissa, quantiles))
    return bands


def with_discrepancy(fit: FitResult, problem: Problem, profile: Profile, band: Band) -> Band:
    """The band with the discrepancy along its abscissa in it, draw by draw.

    The band as it is if there is none, or where there are others that depend on more than the abscissa.
    """
    curves = curves_of(fit)
    if len(curves) != 1 or curves[0].column != profile.abscissa or len(curves[0].levels) != 1:
        return band
    posterior, kept = fit.groups["posterior"], fit.groups["discrepancy"]
    # curves may have been kept of one in several draws
    places = np.searchsorted(posterior["draw"].values, kept["draw"].values)
    shape = (posterior.sizes["chain"], posterior.sizes["draw"], len(fit.names))
    theta = fit.theta().reshape(shape)[:, places].reshape(-1, len(fit.names))
    few = slice(None, None, max(1, len(theta) // DRAWS))
    grid, theory = curve_at_row(problem, profile, theta[few], band.rows[0])
    missed = np.array([np.interp(grid, curves[0].x, draw) for draw in curves[0].draws[few, 0]])
    logarithmic = is_logarithmic(fit, profile.ordinate)
    whole = theory * np.exp(missed) if logarithmic else theory + missed
    return replace(band, quantiles=finite_quantiles(whole, LEVELS), theory=finite_quantiles(theory, [0.5])[0])


def curve_at_row(
    problem: Problem, profile: Profile, theta: FloatArray, row: int
) -> tuple[FloatArray, FloatArray]:
    """A curve at the conditions of one row: abscissa ``(K,)`` and ordinate ``(B, K)``, SI.

    Where the abscissa is an input and the ordinate what the model predicts, this is the prediction, of the prepared and so
    much faster model, with what the problem adds to it (discrepancy, covariates); else it is the curve as it is offered.
    """
    model = problem.model
    if profile.abscissa not in model.input_names() or profile.ordinate not in model.observables:
        return problem.profile(profile, theta, row)
    given = problem.inputs(theta)
    # what else could say where on the curve a row lies must not; what the abscissa needs beside it stays
    ways = [
        way for ways in model.alternatives() if any(profile.abscissa in way for way in ways) for way in ways
    ]
    beside = {
        name
        for way in ways
        if profile.abscissa in way and set(way) <= {*given, profile.abscissa}
        for name in way
    }
    instead = {name for way in ways for name in way} - beside
    inputs = {
        name: np.ascontiguousarray(
            np.broadcast_to(value, (len(value), problem.conditions.n_rows))[:, row, np.newaxis]
        )
        for name, value in given.items()
        if name not in instead
    }
    tables = replace(problem.tables, flow_curves=None)
    grid = profile.grid({name: value[:, 0] for name, value in inputs.items()}, problem.tables.at_row(row))
    # what acts as a power of the abscissa runs along the curve too
    for covariate in problem.spec.covariates:
        key = factor_key(covariate.acts_on) if covariate.acts_on in problem.observables else covariate.acts_on
        if covariate.column == profile.abscissa and key in inputs:
            exponent = given[f"covariate_exponent[{covariate.name}]"]
            at_row = problem.conditions.covariates[covariate.column][row]
            inputs[key] = inputs[key] * (grid / at_row) ** exponent
    found = problem.evaluate({**inputs, profile.abscissa: grid[np.newaxis]}, tables)[profile.ordinate]
    return grid, np.array(np.broadcast_to(found, (len(theta), len(grid))))


def _groups(problem: Problem, profile: Profile, middle: FloatArray) -> list[tuple[str, list[int]]]:
    """Rows that share a curve at the posterior median, and a word for each group."""
    groups: list[tuple[FloatArray, list[int]]] = []
    by_values: dict[tuple[float, ...], list[int]] = {}
    wanted = problem.forward.input_names()
    differing = [
        values[0]
        for name, values in problem.inputs(middle).items()
        if values.shape[-1] > 1 and name != profile.abscissa and name in wanted
    ]
    for row in range(problem.conditions.n_rows):
        same = by_values.setdefault(tuple(float(values[row]) for values in differing), [])
        same.append(row)
    # rows of the same inputs share a curve without it being computed again, and others may still do
    for rows_of_one in _spread_out(by_values):
        grid, curve = curve_at_row(problem, profile, middle, rows_of_one[0])
        both = np.concatenate([grid, curve[0]])
        for known, rows in groups:
            if np.allclose(known, both, rtol=SAME, atol=0.0, equal_nan=True):
                rows[:] = sorted([*rows, *rows_of_one])
                break
        else:
            groups.append((both, list(rows_of_one)))
    if len(groups) <= MOST_CURVES:
        return [("", rows) for _, rows in groups]
    groups.sort(key=lambda group: float(group[0][np.isfinite(group[0])][-1]))
    chosen = (("lowest: ", groups[0]), ("middle: ", groups[len(groups) // 2]), ("highest: ", groups[-1]))
    return [(word, rows) for word, (_, rows) in chosen]


def _spread_out(by_values: dict[tuple[float, ...], list[int]]) -> list[list[int]]:
    """Rows of the same inputs, all kinds of them or, of very many, some evenly spaced in the order of their inputs."""
    if len(by_values) <= MOST_KINDS:
        return list(by_values.values())
    ordered = sorted(by_values)
    return [by_values[ordered[i]] for i in np.linspace(0, len(ordered) - 1, MOST_KINDS).round().astype(int)]


def _row_text(problem: Problem, names: list[str], rows: list[int], shared: bool) -> str:
    """Whose curve it is: what these rows have in common and no other row has, or else the rows themselves."""
    if shared:
        return "all rows" if len(names) > 1 else names[0]
    found = [names[row] if not names[row].isdigit() else f"row {names[row]}" for row in rows]
    if len(found) <= 3:
        return ", ".join(found)
    return _in_common(problem.conditions, rows) or f"{found[0]} and {len(found) - 1} more"


def _in_common(conditions: Conditions, rows: list[int]) -> str:
    """The label, all labels together or the condition that tells these rows from all others; empty if none does."""
    labels = [[str(value) for value in column] for column in conditions.labels.values()]
    telling = [column for column in labels if len(set(column)) > 1]
    if telling:
        telling.append([", ".join(parts) for parts in zip(*telling, strict=True)])
    for name, values in conditions.values.items():
        known = QUANTITIES[name]
        if np.ptp(values[rows]) > 0.02 * np.abs(values[rows]).max():
            continue  # three digits would not be the same
        telling.append([f"{known.symbol} = {quantity(float(value), known.unit, 3)}" for value in values])
    chosen = set(rows)
    for column in telling:
        inside = {column[row] for row in rows}
        if len(inside) == 1 and not any(
            value in inside for row, value in enumerate(column) if row not in chosen
        ):
            return inside.pop()
    return ""


def _load(problem: Problem, middle: FloatArray, rows: list[int]) -> str:
    """What presses the skin in these rows, in brackets: the nominal pressure, or the force; empty where it varies."""
    count = problem.conditions.n_rows
    known = {**problem.inputs(middle), **problem.derived(middle)}
    for name in ("nominal_pressure", "normal_force"):
        if name in known:
            values = known[name][0, rows] if known[name].shape[-1] == count else known[name][0, :1]
            said = {quantity(float(value), QUANTITIES[name].unit, 2) for value in values}
            return f" ({QUANTITIES[name].symbol} = {said.pop()})" if len(said) == 1 else ""
    return ""
