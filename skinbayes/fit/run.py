"""Sample a problem and gather the result."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.errors import InputError
from skinbayes.fit.references import references
from skinbayes.fit.result import Fit
from skinbayes.fit.run_directory import RunDirectory
from skinbayes.fit.tree import data_groups, posterior_groups, prior_groups
from skinbayes.fit.verdict import verdict

if TYPE_CHECKING:
    import xarray

    from skinbayes.problem import Problem
    from skinbayes.sampling.chains import Chains
    from skinbayes.sampling.options import SamplerOptions
    from skinbayes.sampling.progress import Progress

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
    preparing: Callable[[int, int], None] | None = None,
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
    preparing : called with the number done and their total while tables are built before sampling
    options : further fields of ``skinbayes.sampling.SamplerOptions`` (``max_steps``, ``walkers``, ``ensembles``, …)

    Returns
    -------
    Fit
        Also when the run ended without converging: then ``fit.converged`` is False.

    Raises
    ------
    InputError
        The model has no data or nothing to infer, an option is out of range, or ``directory`` is neither new nor empty nor a
        run of this problem, or another process writes there.
    MachineError
        The disk is full, the directory was carried off, a worker process died twice, or memory did not suffice; steps
        stored before are kept, and the message says where.
    KeyboardInterrupt
        Interrupted; with ``directory`` the steps so far are kept.

    Warns
    -----
    RepairWarning
        Files of the run to be resumed were damaged or missing, and what was done about it.
    """
    from skinbayes.sampling.options import SamplerOptions

    if not problem.observations and problem.spec.observables:
        raise InputError(
            f"{problem.spec.path}: '{problem.name}' explains data that you bring; give them with --data FILE.csv"
        )
    if not problem.observations or problem.dimension == 0:
        raise InputError(
            f"{problem.spec.path}: nothing to infer: the model needs [data] and at least one prior"
        )
    settings = SamplerOptions(seed=seed, ess=ess, cores=cores, **{"costly": problem.costly, **options})
    settings.walkers_for(problem.dimension)  # refuses too few before anything is written
    if directory is None:
        return _fit(problem, settings, None, progress, preparing)
    with RunDirectory(Path(directory), problem, resume) as run:
        fit = _fit(problem, settings, run, progress, preparing)
        run.keep(fit)
    return fit


def _fit(
    problem: Problem,
    settings: SamplerOptions,
    run: RunDirectory | None,
    progress: Callable[[Progress], None] | None,
    preparing: Callable[[int, int], None] | None,
) -> Fit:
    from skinbayes.sampling.ensembles import run_ensembles

    started, processor = time.perf_counter(), time.process_time()
    problem.prepare(preparing, settings.cores)  # before work is shared out, so that it is done once
    if run is not None:
        run.check()  # a table may take minutes
    store = None if run is None else run.store
    chains = run_ensembles(problem.target(), settings, store=store, progress=progress)
    sampled = time.perf_counter()
    groups = _groups(problem, chains, settings.seed)
    seconds = {
        "sampling": sampled - started,
        "total": time.perf_counter() - started,
        "processor": time.process_time() - processor,
    }
    provenance = _provenance(problem, chains, settings) | {"seconds": seconds}
    return Fit(groups=groups, provenance=provenance, problem=problem)


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


def _provenance(problem: Problem, chains: Chains, settings: SamplerOptions) -> dict[str, Any]:
    from skinbayes.sampling.progress import steps_needed

    report = chains.report
    dataset = problem.dataset
    data: dict[str, Any] = {"fingerprint": problem.data_fingerprint}
    if dataset is not None:
        data |= {"key": dataset.key, "name": dataset.shown, "sha256": dataset.sha256, "rows": dataset.n_rows}
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
        "tied": {p.label: {"text": p.prior_text, "source": p.source} for p in problem.tied},
        "priors": {p.label: {"text": p.prior_text, "unit": p.unit, "source": p.source} for p in problem.free},
        "derived_symbols": {
            name: block.symbol for name, block in problem.spec.derived.items() if block.symbol
        },
        "fingerprint": problem.fingerprint,
        "observables": list(problem.observables),
        "noise": dict(problem.spec.noise),
        "accuracy": problem.model.accuracy,
        "data": data,
        "references": [reference.to_dict() for reference in references(problem)],
        "versions": _versions(),
        "sampling": {
            "converged": report.converged,
            "verdict": verdict(problem, chains, steps_needed(report, settings), settings.seed),
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
            from skinbayes.version import __version__

            if package == "skinbayes":
                found[package] = __version__
    return found
