"""From draws to the groups of the ArviZ schema, as xarray datasets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.units import product_unit
from skinbayes.vocabulary import QUANTITIES, STANDARD_DEVIATION_SUFFIX

if TYPE_CHECKING:
    import xarray

    from skinbayes.problem import Problem

CHUNK = 500
"""Parameter vectors predicted at a time, to bound memory with many rows of data."""


def posterior_groups(
    problem: Problem, draws: FloatArray, log_density: FloatArray, rng: np.random.Generator
) -> dict[str, xarray.Dataset]:
    """Groups that follow from posterior draws.

    Parameters
    ----------
    problem : the problem
    draws : shape ``(chain, draw, D)``, SI
    log_density : log posterior density in the sampled (unconstrained) coordinates, shape ``(chain, draw)``
    rng : for the predictive draws

    Returns
    -------
    dict
        ``posterior`` (parameters and derived quantities), ``sample_stats``, ``posterior_predictive`` and
        ``log_likelihood`` (pointwise)
    """
    predictive, pointwise = _predictive(problem, draws, rng)
    return {
        "posterior": _parameters(problem, draws),
        "sample_stats": _dataset({"lp": (("chain", "draw"), log_density)}, problem, draws),
        "posterior_predictive": _rows(problem, predictive, draws),
        "log_likelihood": _rows(problem, pointwise, draws),
    }


def prior_groups(problem: Problem, rng: np.random.Generator, count: int) -> dict[str, xarray.Dataset]:
    """``prior`` and ``prior_predictive`` groups of ``count`` draws."""
    draws = problem.draw_prior(rng, count)[np.newaxis]
    predictive, _ = _predictive(problem, draws, rng, pointwise=False)
    return {"prior": _parameters(problem, draws), "prior_predictive": _rows(problem, predictive, draws)}


def data_groups(problem: Problem) -> dict[str, xarray.Dataset]:
    """``observed_data`` and ``constant_data`` (the conditions and grouping columns) groups."""
    import xarray

    coordinates = {"row": problem.conditions.row_labels()}
    observed = {problem.observable: (("row",), np.asarray(problem.observed))}
    constant: dict[str, Any] = {
        name: (("row",), values) for name, values in problem.conditions.values.items()
    }
    constant |= {
        name: (("row",), values.astype(object)) for name, values in problem.conditions.labels.items()
    }
    if problem.observed_spread is not None and problem.observed_spread.any():
        constant[problem.observable + STANDARD_DEVIATION_SUFFIX] = (("row",), problem.observed_spread)
    groups = {
        "observed_data": xarray.Dataset(observed, coords=coordinates),
        "constant_data": xarray.Dataset(constant, coords=coordinates),
    }
    for group in groups.values():
        _add_units(group)
    return groups


def _parameters(problem: Problem, draws: FloatArray) -> xarray.Dataset:
    """Free parameters (levels of a grouping column as a dimension) and derived quantities."""
    variables: dict[str, Any] = {}
    coordinates: dict[str, list[str]] = {}
    for name in dict.fromkeys(parameter.name for parameter in problem.free):
        entries = [(i, p) for i, p in enumerate(problem.free) if p.name == name]
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
    derived = _in_chunks(problem.derived, draws)
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
    dataset = _dataset(variables, problem, draws, coordinates)
    for key, variable in dataset.data_vars.items():
        variable.attrs["kind"] = "parameter" if any(p.name == key for p in problem.free) else "derived"
        block = problem.spec.derived.get(str(key))
        if block is not None:
            factors = [(QUANTITIES[name].unit, power) for name, power in block.product.items()]
            variable.attrs["units"] = product_unit(factors)
            variable.attrs |= {"long_name": block.meaning, "symbol": block.symbol or str(key)}
    return dataset


def _predictive(
    problem: Problem, draws: FloatArray, rng: np.random.Generator, pointwise: bool = True
) -> tuple[FloatArray, FloatArray]:
    shape = (*draws.shape[:2], problem.conditions.n_rows)
    flat = draws.reshape(-1, draws.shape[-1])
    parts = [flat[i : i + CHUNK] for i in range(0, len(flat), CHUNK)]
    predictive = np.concatenate([problem.simulate(part, rng) for part in parts]).reshape(shape)
    if not pointwise:
        return predictive, np.empty(0)
    density = np.concatenate([problem.log_likelihood(part, pointwise=True) for part in parts]).reshape(shape)
    return predictive, density


def _in_chunks(function: Any, draws: FloatArray) -> dict[str, FloatArray]:
    flat = draws.reshape(-1, draws.shape[-1])
    parts = [function(flat[i : i + CHUNK]) for i in range(0, len(flat), CHUNK)]
    sizes = [min(CHUNK, len(flat) - i) for i in range(0, len(flat), CHUNK)]
    joined = {}
    for name in parts[0]:
        # what does not depend on free parameters comes as one row for the whole batch
        rows = [
            np.broadcast_to(part[name], (n, part[name].shape[-1]))
            for part, n in zip(parts, sizes, strict=True)
        ]
        joined[name] = np.concatenate(rows).reshape(*draws.shape[:2], -1)
    return joined


def _rows(problem: Problem, values: FloatArray, draws: FloatArray) -> xarray.Dataset:
    variables = {problem.observable: (("chain", "draw", "row"), values)}
    return _dataset(variables, problem, draws, {"row": problem.conditions.row_labels()})


def _dataset(
    variables: dict[str, Any],
    problem: Problem,
    draws: FloatArray,
    coordinates: dict[str, list[str]] | None = None,
) -> xarray.Dataset:
    import xarray

    chains = {"chain": np.arange(draws.shape[0]), "draw": np.arange(draws.shape[1])}
    dataset = xarray.Dataset(variables, coords={**chains, **(coordinates or {})})
    _add_units(dataset)
    return dataset


def _add_units(dataset: xarray.Dataset) -> None:
    for name, variable in dataset.data_vars.items():
        quantity = QUANTITIES.get(str(name))
        if quantity is not None:
            variable.attrs.update(units=quantity.unit, symbol=quantity.symbol, long_name=quantity.meaning)
