"""From the draws of any engine to the groups and the provenance of a result."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.fit.diagnostics import complete
from skinbayes.fit.joint_groups import joint_groups
from skinbayes.fit.netcdf import FORMAT
from skinbayes.fit.references import references
from skinbayes.fit.tree import data_groups, posterior_groups, prior_groups, weighted_group
from skinbayes.problem.joint import JointProblem
from skinbayes.sampling.draws import Draws
from skinbayes.version import __version__

if TYPE_CHECKING:
    import xarray

    from skinbayes.problem import Problem

MOST_DRAWS = 10_000
"""Draws of equal weight that a result keeps, of all chains together."""

PRIOR_DRAWS = 4000


def require_data(problem: Problem | JointProblem) -> None:
    """Refuse a problem without data or without anything to infer.

    Raises
    ------
    InputError
        It has no data, or no free parameter.
    """
    if isinstance(problem, JointProblem):
        if not problem.dimension:
            raise InputError(f"{problem.spec.path}: nothing to infer: the model needs at least one prior")
        return
    if not problem.observations and problem.spec.observables:
        raise InputError(
            f"{problem.spec.path}: '{problem.name}' explains data that you bring; give them with --data FILE.csv"
        )
    if not problem.observations or problem.dimension == 0:
        raise InputError(
            f"{problem.spec.path}: nothing to infer: the model needs [data] and at least one prior"
        )


def assembled(
    problem: Problem | JointProblem,
    draws: Draws,
    engine: str,
    seed: int,
    wanted: float,
    package: str | None = None,
) -> tuple[dict[str, xarray.Dataset], dict[str, Any]]:
    """Groups and provenance of a result.

    Parameters
    ----------
    problem : what was sampled
    draws : in the coordinates of its target
    engine : name of what made them
    seed : of the run; the streams for resampling, predictive draws and the prior are spawned from it
    wanted : effective sample size asked for
    package : library whose version is to be kept
    """
    target = problem.target()
    equal = draws.equally_weighted(MOST_DRAWS, np.random.default_rng([seed, 7]))
    density = draws.log_density
    # resampled draws are in another order, even where there are as many of them
    if density is None or draws.log_weights is not None or density.shape != equal.shape[:2]:
        density = target.log_density(equal.reshape(-1, draws.dimension)).reshape(equal.shape[:2])
    rng = np.random.default_rng([seed, 1])  # apart from the streams of the ensembles
    theta = _parameters(problem, equal)
    weighted = None if draws.log_weights is None else (_parameters(problem, draws.samples), draws.log_weights)
    if isinstance(problem, JointProblem):
        prior = problem.draw_prior(rng, PRIOR_DRAWS)[np.newaxis]
        groups = joint_groups(problem, theta, density, rng, prior, weighted)
        provenance = _joint_provenance(problem, package)
        cited = {r.key: r for one in problem.experiments.values() for r in references(one, engine)}
    else:
        groups = posterior_groups(problem, theta, density, rng)
        groups |= prior_groups(problem, problem.draw_prior(rng, PRIOR_DRAWS)[np.newaxis], rng)
        groups |= data_groups(problem)
        if weighted is not None:
            groups["weighted_posterior"] = weighted_group(problem.names, *weighted)
        provenance = _provenance(problem, package)
        cited = {r.key: r for r in references(problem, engine)}
    found = complete(draws, problem.names, wanted)
    if (first := found.get("first_invalid")) is not None:
        values = _parameters(problem, np.asarray(first)[np.newaxis])[0]
        found["first_invalid"] = dict(zip(problem.names, values, strict=True))
    sampling = {"engine": engine, "seed": seed, **found, "log_evidence": draws.log_evidence}
    provenance["references"] = [_plain(vars(reference)) for reference in cited.values()]
    return groups, provenance | {"sampling": _plain(sampling)}


def _parameters(problem: Problem | JointProblem, position: FloatArray) -> FloatArray:
    flat = problem.target().transform.inverse(position.reshape(-1, position.shape[-1]))
    return flat.reshape(position.shape)


def _plain(value: Any) -> Any:
    """A diagnostic as a file of text can hold it."""
    if isinstance(value, Mapping):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def _provenance(problem: Problem, package: str | None) -> dict[str, Any]:
    dataset = problem.dataset
    data: dict[str, Any] = {"fingerprint": problem.data_fingerprint}
    if dataset is not None:
        # a folder with provenance is known by its own name, a file by its own
        data |= {"key": dataset.key, "name": dataset.shown, "sha256": dataset.sha256, "rows": dataset.n_rows}
        if dataset.provenance is not None:
            data["origin"] = dataset.provenance.model_dump()
    return {
        **_common_provenance(problem, package),
        "model_path": problem.name if problem.spec.shipped else str(problem.spec.path),
        "derived_symbols": {
            name: block.symbol for name, block in problem.spec.derived.items() if block.symbol
        },
        "observables": list(problem.observables),
        "noise": dict(problem.spec.noise),
        "accuracy": problem.model.accuracy,
        "options": dict(problem.forward.chosen),
        "data": data,
    }


def _common_provenance(problem: Problem | JointProblem, package: str | None) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "model": problem.name,
        "model_text": problem.spec.text,
        "title": problem.spec.title,
        "description": problem.spec.description,
        "names": list(problem.names),
        "fixed": {p.label: {"value": p.value, "source": p.source} for p in problem.fixed},
        "tied": {p.label: {"text": p.prior_text, "source": p.source} for p in problem.tied},
        "priors": {p.label: {"text": p.prior_text, "unit": p.unit, "source": p.source} for p in problem.free},
        "fingerprint": problem.fingerprint,
        "versions": _versions(package),
    }


def _joint_provenance(problem: JointProblem, package: str | None) -> dict[str, Any]:
    """That of all experiments, and under ``experiments`` that of each."""
    each = {
        name: _provenance(one, package) | {"places": problem.places[name].tolist()}
        for name, one in problem.experiments.items()
    }
    keys = " and ".join(str(entry["data"].get("key", name)) for name, entry in each.items())
    return {
        **_common_provenance(problem, package),
        "model_path": str(problem.spec.path),
        "observables": [],
        "noise": {},
        "accuracy": "",
        "data": {"fingerprint": problem.data_fingerprint, "key": keys, "rows": len(problem.observed)},
        "experiments": each,
    }


def _versions(package: str | None) -> dict[str, str]:
    found = {"python": sys.version.split()[0], "skinbayes": __version__}
    for name in ("skinbayes", "numpy", "scipy", package, "arviz", "xarray", "h5py"):
        try:
            found |= {name: version(name)} if name else {}
        except PackageNotFoundError:
            continue
    return found
