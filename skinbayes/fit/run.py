"""Sample a problem and gather the result."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from skinbayes.defaults import EFFECTIVE_SAMPLE_SIZE, SEED
from skinbayes.errors import InputError
from skinbayes.fit.assemble import assembled, require_data
from skinbayes.fit.fit import Fit
from skinbayes.fit.joint_fit import JointFit
from skinbayes.fit.run_directory import RunDirectory
from skinbayes.plugins import ENGINES as INSTALLED_ENGINES
from skinbayes.plugins import installed
from skinbayes.problem.joint import JointProblem

if TYPE_CHECKING:
    from skinbayes.problem import Problem
    from skinbayes.sampling.engines import Engine
    from skinbayes.sampling.progress import RunProgress


@overload
def sample(problem: Problem, *positional: Any, **options: Any) -> Fit: ...


@overload
def sample(problem: JointProblem, *positional: Any, **options: Any) -> JointFit: ...


def sample(
    problem: Problem | JointProblem,
    seed: int = SEED,
    ess: float = EFFECTIVE_SAMPLE_SIZE,
    cores: int = 1,
    directory: str | Path | None = None,
    resume: bool = False,
    progress: Callable[[RunProgress], None] | None = None,
    preparing: Callable[[int, int], None] | None = None,
    engine: str | Engine = "emcee",
    **options: Any,
) -> Fit | JointFit:
    """Sample the posterior of a problem until enough has been sampled.

    With ``emcee``, several independent ensembles start from draws of the prior, led towards the posterior where those do not
    find it (see ``skinbayes.statistics.annealing``), and run until autocorrelation time, effective sample size and R-hat over
    ensembles agree that enough has been sampled (see ``skinbayes.sampling.stopping``). One seed gives the same draws
    bit for bit on any number of cores, resumed or not. ``nested`` is nested sampling, which also gives the evidence.

    Parameters
    ----------
    problem : a problem with data and at least one free parameter, or several experiments
    seed : non-negative integer
    ess : effective sample size wanted in every parameter
    cores : worker processes that share the ensembles
    directory : where to keep steps and result; None keeps everything in memory
    resume : continue the run in ``directory``
    progress : called now and then with how far the run is
    preparing : called with the number done and their total while tables are built before sampling
    engine : ``"emcee"``, ``"nested"`` (nested sampling by dynesty, from ``pip install 'skinbayes[nested]'``), a name given to
        :func:`skinbayes.register_engine`, or an object with ``run``
    options : further options of the engine: of ``emcee`` the fields of ``skinbayes.sampling.SamplerOptions`` (``max_steps``,
        ``walkers``, ``ensembles``, …), of ``nested`` those of ``NestedOptions`` (``live_points``, …)

    Returns
    -------
    Fit or JointFit
        The latter of several experiments. Also when the run ended without converging: then ``fit.converged`` is False.

    Raises
    ------
    InputError
        The model has no data or nothing to infer, an option is out of range, there is no such engine or what it needs is not
        installed, or ``directory`` is neither new nor empty nor a run of this problem, or another process writes there.
    MachineError
        The disk is full, the directory was carried off, a worker process died twice, or memory did not suffice; steps
        stored before are kept, and the message says where.
    KeyboardInterrupt
        Interrupted; with ``directory`` the steps so far are kept.

    Warns
    -----
    RepairWarning
        Files of the run to be resumed were damaged or missing, and what was done about it.

    Examples
    --------
    >>> import skinbayes as sb
    >>> fit = sb.sample(sb.load_problem("finger-water"), seed=1, ess=500)
    >>> fit.converged, fit.provenance["sampling"]["ensembles"]
    (True, 4)
    """
    from skinbayes.sampling.engines import ENGINES, find_engine, options_for, register_engine
    from skinbayes.sampling.target import moved_together

    require_data(problem)
    if isinstance(engine, str) and engine not in ENGINES:
        broken = installed(INSTALLED_ENGINES, register_engine)[1]
        if engine in broken:
            raise InputError(f"engine '{engine}' is {broken[engine]}")
    name, chosen = find_engine(engine)
    settings = options_for(
        name, chosen, **{"seed": seed, "ess": ess, "cores": cores, "expensive": problem.expensive, **options}
    )
    settings.check(moved_together(problem.target()))  # before anything is written

    def fitted(run: RunDirectory | None) -> Fit | JointFit:
        started, processor = time.perf_counter(), time.process_time()
        problem.prepare(preparing, cores)  # before work is shared out, so that it is done once
        if run is not None:
            run.check()  # a table may take minutes
        draws = chosen.run(problem.target(), settings, None if run is None else run.store, progress)
        sampled = time.perf_counter()
        package = getattr(chosen, "package", None)
        groups, provenance = assembled(problem, draws, name, settings.seed, settings.ess, package)
        seconds = {
            "sampling": sampled - started,
            "total": time.perf_counter() - started,
            "processor": time.process_time() - processor,
        }
        provenance |= {"seconds": seconds}
        if isinstance(problem, JointProblem):
            return JointFit(groups, provenance, problem)
        return Fit(groups, provenance, problem)

    if directory is None:
        return fitted(None)
    with RunDirectory(Path(directory), problem, resume, name) as run:
        fit = fitted(run)
        run.keep(fit)
    return fit
