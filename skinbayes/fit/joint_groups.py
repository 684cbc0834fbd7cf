"""Groups of the result of several experiments: those of all together, and those of each under ``experiment.group``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.files.joint_model import EXPERIMENT
from skinbayes.fit.tree import (
    data_groups,
    dataset_of,
    free_parameters,
    posterior_groups,
    prior_groups,
    thinning,
    weighted_group,
)

if TYPE_CHECKING:
    import xarray

    from skinbayes.problem.joint import JointProblem

EACH = ("ess_bulk", "ess_tail", "r_hat")
"""Diagnostics that have one number for each parameter; an engine need not have them."""


def joint_groups(
    problem: JointProblem,
    draws: FloatArray,
    log_density: FloatArray,
    rng: np.random.Generator,
    prior: FloatArray,
    weighted: tuple[FloatArray, FloatArray] | None,
) -> dict[str, xarray.Dataset]:
    """Groups that follow from posterior draws of several experiments.

    Parameters
    ----------
    problem : the experiments
    draws : shape ``(chain, draw, D)``, SI
    log_density : log posterior density in the sampled coordinates, shape ``(chain, draw)``
    rng : for the predictive draws
    prior : draws from the prior, shape ``(1, draw, D)``, SI
    weighted : draws with weights as an engine made them, and ln of the weights; None if all weigh the same

    Returns
    -------
    dict
        ``posterior``, ``prior``, ``sample_stats``, ``weighted_posterior`` of the parameters of all; ``log_likelihood`` of all
        data, ``log_likelihood_left_out`` of whole experiments, ``observed_data`` and ``constant_data`` (which experiment a datum
        belongs to); and ``friction.posterior_predictive`` and all others of each experiment
    """
    rows = sum(one.conditions.n_rows for one in problem.experiments.values())
    step, prior_step = thinning(rows, draws), thinning(rows, prior)
    groups: dict[str, xarray.Dataset] = {}
    for name, one in problem.experiments.items():
        place = problem.places[name]
        own = {
            **posterior_groups(one, draws[..., place], log_density, rng, step),
            **prior_groups(one, prior[..., place], rng, prior_step),
            **data_groups(one),
        }
        if weighted is not None:
            own["weighted_posterior"] = weighted_group(one.names, weighted[0][..., place], weighted[1])
        groups |= {f"{name}.{key}": group for key, group in own.items()}
    if weighted is not None:
        groups["weighted_posterior"] = weighted_group(problem.names, *weighted)
    names = list(problem.experiments)
    pointwise = np.concatenate([_by_datum(groups[f"{name}.log_likelihood"]) for name in names], axis=-1)
    kept = draws[:, ::step]
    left_out = problem.log_likelihood_left_out(kept.reshape(-1, kept.shape[-1])).reshape(*kept.shape[:2], -1)
    datum = {"datum": problem.datum_labels()}
    counts = list(problem.counts().values())
    import xarray

    return groups | {
        "posterior": _parameters(problem, draws),
        "prior": _parameters(problem, prior),
        "sample_stats": dataset_of({"lp": (("chain", "draw"), log_density)}, draws),
        "log_likelihood": dataset_of({"data": (("chain", "draw", "datum"), pointwise)}, kept, datum, step),
        "log_likelihood_left_out": dataset_of(
            {EXPERIMENT: (("chain", "draw", f"{EXPERIMENT}_level"), left_out)},
            kept,
            {f"{EXPERIMENT}_level": names},
            step,
        ),
        "observed_data": xarray.Dataset({"data": (("datum",), problem.observed)}, coords=datum),
        "constant_data": xarray.Dataset(
            {EXPERIMENT: (("datum",), np.repeat(names, counts).astype(object))}, coords=datum
        ),
    }


def _by_datum(group: xarray.Dataset) -> FloatArray:
    return np.concatenate([variable.values for variable in group.data_vars.values()], axis=-1)


def _parameters(problem: JointProblem, draws: FloatArray) -> xarray.Dataset:
    variables, coordinates = free_parameters(problem.free, draws)
    dataset = dataset_of(variables, draws, coordinates)
    units = {p.name: p.unit for p in problem.free}
    for key, variable in dataset.data_vars.items():
        variable.attrs |= {"kind": "parameter", "units": units[str(key)]}
    return dataset


def of_experiment(
    groups: Mapping[str, xarray.Dataset], provenance: Mapping[str, Any], name: str
) -> tuple[dict[str, xarray.Dataset], dict[str, Any]]:
    """Groups and provenance of one experiment, as a fit of it alone has them; the draws are those of all experiments."""
    own = {key.removeprefix(f"{name}."): group for key, group in groups.items() if key.startswith(f"{name}.")}
    told = provenance["experiments"][name]
    sampling = dict(provenance["sampling"])
    sampling |= {key: [sampling[key][i] for i in told["places"]] for key in EACH if key in sampling}
    common = {
        key: provenance[key]
        for key in ("format", "created", "versions", "references", "seconds")
        if key in provenance
    }
    return own, {**told, **common, "sampling": sampling}
