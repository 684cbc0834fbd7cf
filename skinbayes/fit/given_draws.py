"""Draws of anybody's sampler, in the forms in which they come, as draws of a problem."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.fit.assemble import assembled, require_data
from skinbayes.sampling.draws import Draws

if TYPE_CHECKING:
    import xarray

    from skinbayes.problem import JointProblem, Problem

WANTED = 400.0
"""Effective sample size from which quantiles can be used, Vehtari et al. (2021), doi 10.1214/20-BA1221."""

ENGINE = "draws given"
"""Name of the engine in the result."""


def fit_parts(
    problem: Problem | JointProblem, samples: Any, log_weights: ArrayLike | None, seed: int
) -> tuple[dict[str, xarray.Dataset], dict[str, Any]]:
    """Groups and provenance of a result from draws, see :meth:`skinbayes.Fit.from_draws`."""
    require_data(problem)
    theta = _theta(problem, samples)
    position = problem.target().transform.forward(theta.reshape(-1, theta.shape[-1])).reshape(theta.shape)
    lower, upper = np.array([p.prior.support for p in problem.free if p.prior]).T
    inside = np.isfinite(position) & (theta >= lower) & (theta <= upper)
    if not inside.all():
        # named here, where parameters have names and units
        place = int(np.argwhere(~inside)[0, -1])
        parameter, wrong = problem.free[place], theta[~inside[..., place], place]
        raise InputError(
            f"draws of {parameter.label}: {wrong.size} of {theta[..., place].size} lie where its prior has no mass, the first is "
            f"{wrong[0]:g} {parameter.unit}; expected draws from the posterior, in SI units"
        )
    weights = None if log_weights is None else np.asarray(log_weights, dtype=float)
    return assembled(problem, Draws(position, weights), ENGINE, seed, WANTED)


def _theta(problem: Problem | JointProblem, samples: Any) -> FloatArray:
    """Parameter vectors, shape ``(chains, draws, D)``."""
    found = getattr(samples, "posterior", samples)  # InferenceData, DataTree
    if not isinstance(found, Mapping) and not hasattr(found, "columns"):
        array = np.asarray(found, dtype=float)
        array = array[np.newaxis] if array.ndim == 2 else array
        if array.ndim != 3 or array.shape[-1] != problem.dimension:
            raise InputError(
                f"draws: an array of shape {np.shape(found)} found; expected (draws, {problem.dimension}) or "
                f"(chains, draws, {problem.dimension}), the parameters being {', '.join(problem.names)}"
            )
        return array
    columns = [_of_parameter(found, label) for label in problem.names]
    shapes = {label: column.shape for label, column in zip(problem.names, columns, strict=True)}
    if len(set(shapes.values())) > 1:
        raise InputError(f"draws: as many of each parameter expected; shapes found: {shapes}")
    return np.stack(columns, axis=-1)


def _of_parameter(found: Any, label: str) -> FloatArray:
    """Draws of one parameter by its label, or by its name with levels as a dimension, shape ``(chains, draws)``."""
    name, _, level = label.partition("[")
    values = found.get(label, found.get(name))
    extra = [d for d in getattr(values, "dims", ()) if d not in ("chain", "draw")]
    if values is not None and label not in found and level:
        level = level.removesuffix("]")
        if len(extra) != 1 or level not in values[extra[0]].values.astype(str):
            values = None
        else:
            values = values.isel({extra[0]: values[extra[0]].values.astype(str).tolist().index(level)})
    if values is None:
        raise InputError(f"draws: none of {label}; found those of {', '.join(map(str, found))}")
    if hasattr(values, "dims") and {"chain", "draw"} <= set(values.dims):
        values = values.transpose("chain", "draw", ...)
    array = np.asarray(values, dtype=float)
    array = array[np.newaxis] if array.ndim == 1 else array
    if array.ndim != 2:
        raise InputError(f"draws of {label}: shape {array.shape} found; expected (draws,) or (chains, draws)")
    return array
