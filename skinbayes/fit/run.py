"""Sample a problem and gather the result."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import asdict
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.errors import InputError
from skinbayes.fit.references import references
from skinbayes.fit.result import Fit
from skinbayes.fit.storage import RESULT, STEPS, SUMMARY, claim_run
from skinbayes.fit.tree import data_groups, posterior_groups, prior_groups

if TYPE_CHECKING:
    import xarray

    from skinbayes.problem import Problem
    from skinbayes.sampling.chains import Chains
    from skinbayes.sampling.ensembles import Progress

DEFAULT_SEED = 1
"""Seed when none is given: the same command gives the same draws."""

DRAWS_PER_CHAIN = 2500
"""Posterior draws kept of each ensemble; nearly independent, so four ensembles give quantiles to about 0.01 sd."""

PRIOR_DRAWS = 4000


def sample(
    problem: Problem,
    seed: int = DEFAULT_SEED,
    ess: float = 2000.0,
    cores: int = 1,
    directory: str | Path | None = None,
    resume: bool = False,
    progress: Callable[[Progress], None] | None = None,
    **options: Any,
) -> Fit:
    """Sample the posterior of a problem with emcee until the stopping rule is met.

    Several independent ensembles start from draws of the prior, led towards the posterior where those do not find it (see
    ``skinbayes.statistics.annealing``), and run until autocorrelation time, effective sample size and R-hat over ensembles
    agree that enough has been sampled (see ``skinbayes.sampling.stopping``). One seed gives the same draws
    bit for bit on any number of cores, resumed or not.

    Parameters
    ----------
    problem : a problem with data and at least one free parameter
    seed : non-negative integer
    ess : effective sample size wanted in every parameter
    cores : worker processes that share the ensembles
    directory : where to keep steps and result; None keeps everything in memory
    resume : continue the run in ``directory``
    progress : called after every block of steps
    options : further fields of ``skinbayes.sampling.SamplerOptions`` (``max_steps``, ``walkers``, ``ensembles``, …)

    Returns
    -------
    Fit
        Also when the run ended without converging: then ``fit.converged`` is False.

    Raises
    ------
    InputError
        The model has no data or nothing to infer, an option is out of range, or the stored run is another one.
    KeyboardInterrupt
        Interrupted; with ``directory`` the steps so far are kept.
    """
    from skinbayes.sampling.ensembles import run_ensembles
    from skinbayes.sampling.options import SamplerOptions
    from skinbayes.sampling.store import SampleStore

    if not problem.observations and problem.spec.observables:
        raise InputError(
            f"{problem.spec.path}: '{problem.name}' explains data that you bring; give them with --data FILE.csv"
        )
    if not problem.observations or problem.dimension == 0:
        raise InputError(
            f"{problem.spec.path}: nothing to infer: the model needs [data] and at least one prior"
        )
    settings = SamplerOptions(
        seed=seed, ess=ess, cores=cores, **{"costly": problem.forward.costly, **options}
    )
    settings.walkers_for(problem.dimension)  # refuses too few before anything is written
    folder = None if directory is None else Path(directory)
    if folder is not None:
        claim_run(folder, problem, resume)
    started, processor = time.perf_counter(), time.process_time()
    problem.prepare(cores=cores)  # before work is shared out, so that it is done once
    target = problem.target()
    store = None if folder is None else SampleStore(folder / STEPS, resume=resume)
    chains = run_ensembles(target, settings, store=store, progress=progress)
    sampled = time.perf_counter()
    groups = _groups(problem, chains, seed)
    seconds = {
        "sampling": sampled - started,
        "total": time.perf_counter() - started,
        "processor": time.process_time() - processor,
    }
    provenance = _provenance(problem, chains, settings) | {"seconds": seconds}
    fit = Fit(groups=groups, provenance=provenance, problem=problem)
    if folder is not None:
        fit.save(folder / RESULT)
        fit.summary(derived=True).to_csv(folder / SUMMARY, index_label="parameter")
    return fit


def _groups(problem: Problem, chains: Chains, seed: int) -> dict[str, xarray.Dataset]:
    positions, log_density = chains.draws(DRAWS_PER_CHAIN)
    transform = problem.target().transform
    draws = transform.inverse(positions.reshape(-1, positions.shape[-1])).reshape(positions.shape)
    rng = np.random.default_rng([seed, 1])  # apart from the streams of the ensembles
    return {
        **posterior_groups(problem, draws, log_density, rng),
        **prior_groups(problem, rng, PRIOR_DRAWS),
        **data_groups(problem),
    }


def _provenance(problem: Problem, chains: Chains, settings: Any) -> dict[str, Any]:
    report = chains.report
    dataset = problem.dataset
    data: dict[str, Any] = {"fingerprint": problem.data_fingerprint}
    if dataset is not None:
        # a folder with provenance is known by its own name, a file by its own
        name = dataset.path.name if dataset.path.stem == dataset.key else dataset.key
        data |= {"key": dataset.key, "name": name, "sha256": dataset.sha256, "rows": dataset.n_rows}
        if dataset.provenance is not None:
            data["origin"] = dataset.provenance.model_dump()
    return {
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "model": problem.name,
        "model_path": str(problem.spec.path) if not _is_shipped(problem) else problem.name,
        "model_text": problem.spec.text,
        "title": problem.spec.title,
        "description": problem.spec.description,
        "names": list(problem.names),
        "fixed": {p.label: {"value": p.value, "source": p.source} for p in problem.fixed},
        "priors": {p.label: {"text": p.prior_text, "unit": p.unit, "source": p.source} for p in problem.free},
        "derived_symbols": {
            name: block.symbol for name, block in problem.spec.derived.items() if block.symbol
        },
        "fingerprint": problem.fingerprint,
        "observables": list(problem.observables),
        "noise": dict(problem.spec.noise),
        "accuracy": problem.model.accuracy,
        "data": data,
        "references": [asdict(reference) for reference in references(problem)],
        "versions": _versions(),
        "sampling": {
            "converged": report.converged,
            "verdict": report.sentence(),
            "missing": list(report.missing),
            "seed": settings.seed,
            "ensembles": settings.ensembles,
            "walkers": int(chains.positions.shape[2]),
            "steps": chains.steps,
            "burn_in": report.burn_in,
            "thinning": chains.thinning(),
            "evaluations": chains.evaluations,
            "invalid": chains.invalid,
            "first_invalid": _first_invalid(problem, chains),
            "acceptance_fraction": [float(value) for value in chains.acceptance_fraction()],
            "tau": [float(value) for value in report.tau],
            "ess_bulk": [float(value) for value in report.ess_bulk],
            "ess_tail": [float(value) for value in report.ess_tail],
            "r_hat": [float(value) for value in report.r_hat],
        },
    }


def _first_invalid(problem: Problem, chains: Chains) -> dict[str, float] | None:
    """The first parameters, SI, for which the forward model gave no finite answer while sampling."""
    if not chains.invalid:
        return None
    theta = problem.target().transform.inverse(chains.first_invalid[np.newaxis])[0]
    return dict(zip(problem.names, (float(value) for value in theta), strict=True))


def _is_shipped(problem: Problem) -> bool:
    from skinbayes.files.locate import shipped_folder

    return problem.spec.path.parent == shipped_folder("models")


def _versions() -> dict[str, str]:
    found = {"python": sys.version.split()[0]}
    for package in ("skinbayes", "numpy", "scipy", "emcee", "arviz", "xarray", "h5py"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            from skinbayes import __version__

            if package == "skinbayes":
                found[package] = __version__
    return found
