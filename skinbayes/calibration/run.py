"""Simulate and fit many times, here or on a cluster."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from skinbayes.calibration.directory import CALIBRATION
from skinbayes.calibration.result import Calibration, OddsCalibration
from skinbayes.calibration.simulation import RANKED_DRAWS, Simulated, Simulation
from skinbayes.defaults import EFFECTIVE_SAMPLE_SIZE, SEED
from skinbayes.errors import InputError
from skinbayes.fit.assemble import require_data
from skinbayes.fit.result_folder import ResultFolder, stated
from skinbayes.sampling.many_tasks import done_tasks
from skinbayes.sampling.options import whole

if TYPE_CHECKING:
    from skinbayes.problem import JointProblem, Problem


@overload
def calibrate(
    problem: Problem | JointProblem, other: None = None, *positional: Any, **options: Any
) -> Calibration: ...


@overload
def calibrate(
    problem: Problem | JointProblem, other: Problem | JointProblem, *positional: Any, **options: Any
) -> OddsCalibration: ...


def calibrate(
    problem: Problem | JointProblem,
    other: Problem | JointProblem | None = None,
    simulations: int = 200,
    seed: int = SEED,
    ess: float = EFFECTIVE_SAMPLE_SIZE,
    cores: int = 1,
    scheduler: str | None = None,
    directory: str | Path | None = None,
    progress: Callable[[int, int], None] | None = None,
    preparing: Callable[[int, int], None] | None = None,
    **options: Any,
) -> Calibration | OddsCalibration:
    """Simulation-based calibration of the whole way from prior to result.

    Again and again parameters are drawn from the prior, data are simulated with them at the rows of the model's own data, and
    these are fitted as any data are, stopping rule and all. Over many simulations the truth then is a draw of the posterior
    like any other: its rank among independent posterior draws is uniform, a 90 % interval holds it in 90 % of the
    simulations, and of two models each is right as often as its probability says. A fit that does not converge, or ends in an
    error, is counted and shown.

    The rank is that among 199 draws of the result, evenly spaced among those that are nearly independent; among draws that
    equal the truth any place is as likely. The likelihood of all data is ranked too (Modrák et al. 2023): it sees what no
    parameter alone shows, such as data that were left out.

    Parameters
    ----------
    problem : a problem with data, or several experiments
    other : another model of the same data: then data are drawn from both, as often from one as from the other, and it is the
        probability of the models that is calibrated
    simulations : how many
    seed : non-negative integer; one seed gives the same numbers with any number of processes, continued or not
    ess : effective sample size wanted of each fit in every parameter
    cores : processes that share the simulations
    scheduler : address of a dask scheduler whose workers share them instead, such as ``"tcp://node1:8786"``; needs
        ``pip install 'skinbayes[cluster]'`` there and here
    directory : where simulations are kept; those of the same calibration that are there already are not made again
    progress : called with the number of simulations done and their total
    preparing : called with the number done and their total while tables are built before
    options : further options of :func:`skinbayes.sample`, such as ``max_steps`` or ``engine``

    Returns
    -------
    Calibration or OddsCalibration
        The latter of two models.

    Raises
    ------
    InputError
        The model has no data or nothing to infer, the models are not of the same data, ``directory`` holds something else, or
        the scheduler cannot be used.
    MachineError
        The disk is full, or a worker died again and again; simulations done before are kept.

    References
    ----------
    Talts et al. 2018, arXiv:1804.06788; Modrák et al. 2023, doi 10.1214/23-BA1404; Säilynoja, Bürkner & Vehtari 2022, doi
    10.1007/s11222-022-10090-6; Schad et al. 2022, doi 10.1037/met0000472.

    Examples
    --------
    >>> import skinbayes as sb
    >>> problem = sb.build_problem(
    ...     "constant", {"friction_coefficient [1]": [0.4, 0.5]},
    ...     parameters={"typical_friction_coefficient": {"uniform": [0, 1]}},
    ...     noise={"family": "gaussian", "noise_scale": 0.1},
    ... )  # fmt: skip
    >>> result = sb.calibrate(problem, simulations=2, ess=400)
    >>> result.failed, len(result.ranks("typical_friction_coefficient"))
    (0, 2)
    """
    whole("simulations", simulations, 1)
    whole("cores", cores, 1)
    whole("seed", seed, 0)
    problems = (problem,) if other is None else (problem, other)
    for one in problems:
        require_data(one)
        one.prepare(preparing, cores)
    if other is not None and other.data_fingerprint != problem.data_fingerprint:
        raise InputError(
            f"{other.spec.path}: '{other.name}' is not of the same data as '{problem.name}'; expected two models of one data set"
        )
    simulation = Simulation(problems, seed, {"ess": ess, **options})
    asked = {
        "models": [one.name for one in problems],
        "fingerprints": [one.fingerprint for one in problems],
        "model_texts": [one.spec.text for one in problems],
        "seed": seed,
        "options": stated(simulation.options),
        "ranked_draws": RANKED_DRAWS,
    }  # fmt: skip
    with ExitStack() as stack:
        kept = (
            None
            if directory is None
            else stack.enter_context(ResultFolder(Path(directory), CALIBRATION, asked))
        )
        found: dict[Hashable, Simulated] = {} if kept is None else kept.done
        missing = [number for number in range(simulations) if number not in found]
        done = simulations - len(missing)
        for _, simulated in done_tasks(simulation, missing, cores, scheduler):
            if kept is None:
                found[simulated.number] = simulated
            else:
                kept.add(simulated)
            done += 1
            if progress is not None:
                progress(done, simulations)
        ordered = tuple(found[number] for number in range(simulations))
    if other is not None:
        return OddsCalibration((problem.name, other.name), ordered, seed)
    return Calibration(problem.name, problem.names, ordered, seed)
