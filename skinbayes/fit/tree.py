"""From draws to the groups of the ArviZ schema, as xarray datasets."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.problem.subsets import one_row_of_each_level
from skinbayes.units import product_unit
from skinbayes.vocabulary import QUANTITIES, STANDARD_DEVIATION_SUFFIX, lookup

if TYPE_CHECKING:
    import xarray

    from skinbayes.files.parameter_block import ParameterSpec
    from skinbayes.problem import Problem
    from skinbayes.problem.populations import Named
    from skinbayes.problem.shared_scatter import SharedScatter

PERSON = "person"
"""Kind of what belongs to the levels of a population, and of what treatments do to it."""

CHUNK = 500
"""Parameter vectors predicted at a time."""

CHUNK_NUMBERS = 1_000_000
"""Numbers predicted at a time at most: with more than 2,000 rows of data fewer vectors are taken."""

KEPT_NUMBERS = 4_000_000
"""Draws times rows that are kept of what differs by row (32 MB): with more than 400 rows not every draw is."""

MOST_ROWS_EACH = 400
"""With more rows than this, what is derived for each row stands in a group of its own, apart from the parameters."""

CURVE_POINTS = 41
"""Points at which a curve of the discrepancy is kept."""

FLAG_DRAWS = 500
"""Draws of which the edge of the theory is looked at."""


def posterior_groups(
    problem: Problem,
    draws: FloatArray,
    log_density: FloatArray,
    rng: np.random.Generator,
    step: int | None = None,
) -> dict[str, xarray.Dataset]:
    """Groups that follow from posterior draws.

    Parameters
    ----------
    problem : the problem
    draws : shape ``(chain, draw, D)``, SI
    log_density : log posterior density in the sampled (unconstrained) coordinates, shape ``(chain, draw)``
    rng : for the predictive draws
    step : of what differs by row one draw in so many is kept; as many as `KEPT_NUMBERS` allows if omitted

    Returns
    -------
    dict
        ``posterior`` (parameters, derived quantities, effects of groups), ``sample_stats``, ``posterior_predictive``,
        ``log_likelihood`` (pointwise), ``log_likelihood_left_out`` (by levels of grouping columns), ``discrepancy`` (curves
        that the theory misses, and drifts) and ``validity`` (share of the draws in which a row is at the edge of the theory);
        with more than 400 rows ``derived_by_row``. What differs by row is kept of evenly spaced draws, as many as
        `KEPT_NUMBERS` allows: its coordinate ``draw`` says which.
    """
    effects = None if problem.shared is None else _at(draws, lambda theta: problem.draw_effects(theta, rng))
    step = step or thinning(problem.conditions.n_rows, draws)
    kept, kept_effects = draws[:, ::step], None if effects is None else effects[:, ::step]
    pointwise = partial(problem.log_likelihood, pointwise=True)
    groups = {
        "posterior": _parameters(problem, draws, effects),
        "sample_stats": dataset_of({"lp": (("chain", "draw"), log_density)}, draws),
        "posterior_predictive": _rows(problem, _simulated(problem, kept, rng, kept_effects), kept, step),
        "log_likelihood": _rows(problem, _at(kept, pointwise), kept, step),
    }
    if by_row := _derived_by_row(problem, kept):
        groups["derived_by_row"] = dataset_of(by_row, kept, {"row": problem.conditions.row_labels()}, step)
    if problem.correlated is not None and kept_effects is not None:
        groups |= _discrepancy(problem.correlated, kept, kept_effects, step)
    left_out = {
        column: (
            ("chain", "draw", f"{column}_level"),
            _at(kept, partial(problem.log_likelihood_left_out, column=column)),
        )
        for column in columns_to_leave_out(problem)
    }
    if left_out:
        labels = problem.conditions.labels
        levels = {f"{column}_level": list(dict.fromkeys(labels[column].tolist())) for column in left_out}
        groups["log_likelihood_left_out"] = dataset_of(left_out, kept, levels, step)
    if flags := _flags(problem, draws):
        groups["validity"] = dataset_of(flags, draws, {"row": problem.conditions.row_labels()})
    return groups


def _discrepancy(
    shared: SharedScatter, draws: FloatArray, effects: FloatArray, step: int
) -> dict[str, xarray.Dataset]:
    """Curves of the discrepancy along each of its columns, and the drift of each series, on the scale on which data scatter."""
    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {}
    flat = effects.reshape(-1, effects.shape[-1])
    for axis, values, curves in shared.curves(flat, CURVE_POINTS):
        level = [f"{axis.within}_level"] if axis.within else []
        coordinates |= {f"{axis.column}_point": values} | {name: list(axis.levels) for name in level}
        shape = (*draws.shape[:2], *((len(axis.levels),) if level else ()), CURVE_POINTS)
        dimensions = ("chain", "draw", *level, f"{axis.column}_point")
        variables[f"discrepancy_along_{axis.column}"] = (dimensions, curves.reshape(shape))
    if shared.scatter.drift:
        coordinates["series"] = list(shared.series)
        variables["drift"] = (("chain", "draw", "series"), effects[..., shared.scatter.drift_effects])
    return {"discrepancy": dataset_of(variables, draws, coordinates, step)} if variables else {}


def weighted_group(names: Sequence[str], draws: FloatArray, log_weights: FloatArray) -> xarray.Dataset:
    """The draws of an engine whose draws have weights, as it made them: ``theta`` and ``log_weight``."""
    variables = {
        "theta": (("chain", "draw", "parameter"), draws),
        "log_weight": (("chain", "draw"), log_weights),
    }
    return dataset_of(variables, draws, {"parameter": list(names)})


def columns_to_leave_out(problem: Problem) -> list[str]:
    """Grouping columns whose levels are worth leaving out one at a time: several levels, at least one of several rows."""
    if len(problem.observations) != 1:
        return []
    counts = {name: len(set(values.tolist())) for name, values in problem.conditions.labels.items()}
    return [name for name, count in counts.items() if 1 < count < problem.conditions.n_rows]


def _flags(problem: Problem, draws: FloatArray) -> dict[str, Any]:
    """Fraction of the draws in which each row's prediction lies at the edge of the theory, by flag."""
    flat = draws.reshape(-1, draws.shape[-1])
    found = problem.flags(flat[:: max(1, len(flat) // FLAG_DRAWS)])
    return {name: (("row",), values.mean(axis=0), {"units": "1"}) for name, values in found.items()}


def prior_groups(
    problem: Problem, draws: FloatArray, rng: np.random.Generator, step: int | None = None
) -> dict[str, xarray.Dataset]:
    """``prior`` and ``prior_predictive`` groups of draws from the prior, shape ``(1, draw, D)``; see `posterior_groups`."""
    step = step or thinning(problem.conditions.n_rows, draws)
    predictive = _simulated(problem, draws[:, ::step], rng, None)
    return {
        "prior": _parameters(problem, draws),
        "prior_predictive": _rows(problem, predictive, draws[:, ::step], step),
    }


def data_groups(problem: Problem) -> dict[str, xarray.Dataset]:
    """``observed_data`` and ``constant_data`` (the conditions and grouping columns) groups."""
    import xarray

    coordinates = {"row": problem.conditions.row_labels()}
    observed = {o.name: (("row",), o.values) for o in problem.observations}
    constant: dict[str, Any] = {
        name: (("row",), values)
        for name, values in (*problem.conditions.values.items(), *problem.conditions.covariates.items())
    }
    constant |= {
        name: (("row",), values.astype(object)) for name, values in problem.conditions.labels.items()
    }
    constant |= {
        o.name + STANDARD_DEVIATION_SUFFIX: (("row",), o.spread)
        for o in problem.observations
        if o.spread.any()
    }
    constant |= {
        name + STANDARD_DEVIATION_SUFFIX: (("row",), spread * problem.conditions.values[name])
        for name, spread in problem.input_spread.items()
    }
    if (
        problem.correlated is not None
    ):  # also columns along which rows are correlated that the forward model does not take
        constant |= {
            name: (("row",), values)
            for name, values in problem.correlated.along.items()
            if name not in constant
        }
    groups = {
        "observed_data": xarray.Dataset(observed, coords=coordinates),
        "constant_data": xarray.Dataset(constant, coords=coordinates),
    }
    for group in groups.values():
        _add_units(group)
    return groups


def free_parameters(
    free: Sequence[ParameterSpec], draws: FloatArray
) -> tuple[dict[str, Any], dict[str, list[str]]]:
    """Variables and coordinates of free parameters; their levels are a dimension."""
    variables: dict[str, Any] = {}
    coordinates: dict[str, list[str]] = {}
    for name in dict.fromkeys(parameter.name for parameter in free):
        entries = [(i, p) for i, p in enumerate(free) if p.name == name]
        if entries[0][1].by is None:
            variables[name] = (("chain", "draw"), draws[..., entries[0][0]])
        else:
            # two parameters may be free in different levels of one column: each has its own dimension then
            dimension = f"{entries[0][1].by}"
            levels = [str(p.level) for _, p in entries]
            if coordinates.setdefault(dimension, levels) != levels:
                dimension = f"{name}_{dimension}"
                coordinates[dimension] = levels
            variables[name] = (("chain", "draw", dimension), draws[..., [i for i, _ in entries]])
    return variables, coordinates


def _parameters(problem: Problem, draws: FloatArray, effects: FloatArray | None = None) -> xarray.Dataset:
    """Free parameters (levels of a grouping column as a dimension), derived quantities and effects of groups."""
    variables, coordinates = free_parameters(problem.free, draws)
    derived = _derived(problem, draws)
    labels = problem.conditions.row_labels()
    for name, values in derived.items():
        if values.shape[-1] not in (1, problem.conditions.n_rows):
            chosen = problem.conditions.matching(problem.spec.derived[name].rows)
            coordinates[f"{name}_row"] = [row for row, use in zip(labels, chosen, strict=True) if use]
            variables.setdefault(name, (("chain", "draw", f"{name}_row"), values))
        elif values.shape[-1] == 1:
            variables.setdefault(name, (("chain", "draw"), values[..., 0]))
        else:
            coordinates["row"] = labels
            variables.setdefault(name, (("chain", "draw", "row"), values))
    groups = problem.groups
    if groups is not None and effects is not None:
        for column, members in zip(groups.columns, groups.levels, strict=True):
            name, dimension = f"{column}_effect", f"{column}_level"
            coordinates[dimension] = list(members)
            variables[name] = (("chain", "draw", dimension), effects[..., groups.effects_of(column)])
    people: list[Named] = []
    if problem.populations is not None:
        people = problem.populations.people(draws.reshape(-1, draws.shape[-1]), problem.conditions)
    for one in people:
        coordinates[f"{one.name}_level"] = list(one.levels)
        values = np.broadcast_to(one.values, (draws.shape[0] * draws.shape[1], len(one.levels)))
        variables[one.name] = (("chain", "draw", f"{one.name}_level"), values.reshape(*draws.shape[:2], -1))
    dataset = dataset_of(variables, draws, coordinates)
    units = {one.name: one.unit for one in people}
    for key, variable in dataset.data_vars.items():
        own = next((p for p in problem.free if p.name == key), None)
        variable.attrs["kind"] = (
            "parameter" if own else "effect" if str(key).endswith("_effect") else "derived"
        )
        if own is not None:
            variable.attrs["units"] = own.unit
        if key in units:
            variable.attrs |= {"kind": PERSON, "units": units[str(key)]}
        block = problem.spec.derived.get(str(key))
        if block is not None:
            factors = [
                (QUANTITIES[name.partition("[")[0]].unit, power) for name, power in block.product.items()
            ]
            variable.attrs["units"] = product_unit(factors)
            variable.attrs |= {"long_name": block.meaning, "symbol": block.symbol or str(key)}
    return dataset


def _simulated(
    problem: Problem, draws: FloatArray, rng: np.random.Generator, effects: FloatArray | None
) -> FloatArray:
    """Data simulated from each draw, with its effects of groups or new ones, shape ``(chain, draw, M)``."""
    flat = draws.reshape(-1, draws.shape[-1])
    given = None if effects is None else effects.reshape(len(flat), -1)
    count = _chunk(problem)
    parts = [
        problem.simulate(flat[i : i + count], rng, None if given is None else given[i : i + count])
        for i in range(0, len(flat), count)
    ]
    return np.concatenate(parts).reshape(*draws.shape[:2], -1)


def thinning(rows: int, draws: FloatArray) -> int:
    """One draw of so many is kept of what differs by row; 1 with few rows."""
    numbers = draws.shape[0] * draws.shape[1] * rows
    return max(1, ceil(numbers / KEPT_NUMBERS))


def _chunk(problem: Problem) -> int:
    return max(1, min(CHUNK, CHUNK_NUMBERS // problem.conditions.n_rows))


def _derived(problem: Problem, draws: FloatArray) -> dict[str, FloatArray]:
    """Derived quantities at all draws, ``(chain, draw, ·)``; with many rows only what the rows of a level share."""
    if problem.conditions.n_rows <= MOST_ROWS_EACH:
        return _derived_at(problem, draws)
    some = draws.reshape(-1, draws.shape[-1])[:2]
    shared = {name for name, values in problem.derived(some).items() if values.shape[-1] == 1}
    found = _derived_at(one_row_of_each_level(problem), draws)
    return {name: values[..., :1] for name, values in found.items() if name in shared}


def _derived_by_row(problem: Problem, draws: FloatArray) -> dict[str, Any]:
    """What is derived for each row and stands apart from the parameters because there are many rows."""
    count = problem.conditions.n_rows
    found = _derived_at(problem, draws) if count > MOST_ROWS_EACH else {}
    return {
        name: (("chain", "draw", "row"), values)
        for name, values in found.items()
        if values.shape[-1] == count
    }


def _at(draws: FloatArray, function: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """A function of parameter vectors ``(B, D)`` at all draws, shape ``(chain, draw, ·)``."""
    return function(draws.reshape(-1, draws.shape[-1])).reshape(*draws.shape[:2], -1)


def _derived_at(problem: Problem, draws: FloatArray) -> dict[str, FloatArray]:
    """Derived quantities at all draws, ``(chain, draw, ·)``."""
    flat = draws.reshape(-1, draws.shape[-1])
    # what does not depend on free parameters comes as one row for the whole batch
    return {
        name: np.array(np.broadcast_to(values, (len(flat), values.shape[-1]))).reshape(*draws.shape[:2], -1)
        for name, values in problem.derived(flat).items()
    }


def _rows(problem: Problem, values: FloatArray, draws: FloatArray, step: int) -> xarray.Dataset:
    parts = np.split(values, len(problem.observations), axis=-1)
    variables = {
        name: (("chain", "draw", "row"), part) for name, part in zip(problem.observables, parts, strict=True)
    }
    return dataset_of(variables, draws, {"row": problem.conditions.row_labels()}, step)


def dataset_of(
    variables: dict[str, Any],
    draws: FloatArray,
    coordinates: dict[str, list[str]] | None = None,
    step: int = 1,
) -> xarray.Dataset:
    """Variables of draws, of which one in ``step`` of the posterior's is here."""
    import xarray

    chains = {"chain": np.arange(draws.shape[0]), "draw": step * np.arange(draws.shape[1])}
    dataset = xarray.Dataset(variables, coords={**chains, **(coordinates or {})})
    _add_units(dataset)
    if step > 1:
        dataset.attrs["kept"] = f"one draw in {step}"
    return dataset


def _add_units(dataset: xarray.Dataset) -> None:
    for name, variable in dataset.data_vars.items():
        quantity = lookup(str(name))
        if quantity is not None:
            variable.attrs.update(units=quantity.unit, symbol=quantity.symbol, long_name=quantity.meaning)
