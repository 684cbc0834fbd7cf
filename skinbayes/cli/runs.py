"""A fit by the name of its run, or by that of its model, which is sampled if that was not done yet."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit
    from skinbayes.problem import JointProblem, Problem

RUNS = Path("runs")
"""Folder of the runs of models, unless told otherwise."""


@dataclass(frozen=True)
class Wanted:
    """How models are sampled of which there is no run.

    Attributes
    ----------
    data : what ``--data`` says
    seed, ess, cores : as ``fit`` takes them
    folder : where the runs of models are, or come to be
    """

    data: tuple[str, ...]
    seed: int
    ess: int
    cores: int
    folder: Path


def run_directory(model: str, seed: int, folder: Path = RUNS) -> Path:
    """Where the run of a model is, or comes to be, unless told otherwise."""
    return folder / f"{model}-seed{seed}"


def fits_of(names: tuple[str, ...], wanted: Wanted) -> list[Fit | JointFit]:
    """The fits of runs and models; all names are looked at before a model is sampled.

    Raises
    ------
    InputError
        A name is neither a run nor a model, or what stands where a model would be sampled is something else.
    KeyboardInterrupt
        Interrupted; the same again goes on from there.
    """
    from skinbayes.cli.options import data_of
    from skinbayes.fit.storage import load_any_fit
    from skinbayes.problem import JointProblem, Problem
    from skinbayes.problem.load import load_any_problem

    if len(names) < 2:
        raise InputError(f"{len(names)} run or model given; a comparison needs at least two")
    found: list[Fit | JointFit | Problem | JointProblem] = [
        load_any_fit(name) if is_run(name) else load_any_problem(name, data_of(name, wanted.data))
        for name in names
    ]
    models = [entry for entry in found if isinstance(entry, (Problem, JointProblem))]
    if wanted.data and not models:
        raise InputError("--data: all names are runs, which have their data; expected it with a model")
    places = [run_directory(problem.name, wanted.seed, wanted.folder) for problem in models]
    for place in places:
        if places.count(place) > 1:
            raise InputError(
                f"{place}: two of the models have this name; sample one of them with 'fit -o' and name its run"
            )
    return [
        _sampled(entry, wanted) if isinstance(entry, (Problem, JointProblem)) else entry for entry in found
    ]


def is_run(name: str) -> bool:
    """Whether a name is that of a run; a model is a file (.toml) or shipped."""
    from skinbayes.files.locate import shipped_names

    if name in shipped_names("models") or name.endswith(".toml"):
        return False
    if not Path(name).exists():
        raise InputError(
            f"{name}: neither a run nor a model; expected a folder that 'skinbayes fit' wrote, a model file (.toml) or the name "
            "of a shipped model (see 'skinbayes models')"
        )
    return True


def _sampled(problem: Problem | JointProblem, wanted: Wanted) -> Fit | JointFit:
    """The fit of a model from its run directory, where a run that was begun is ended."""
    from skinbayes.cli.output import say
    from skinbayes.cli.progress import fit_progress
    from skinbayes.fit import sample

    directory = run_directory(problem.name, wanted.seed, wanted.folder)
    known = directory.is_dir() and any(directory.iterdir())
    with fit_progress(problem.name) as (count, progress):
        fit = sample(
            problem, seed=wanted.seed, ess=wanted.ess, cores=wanted.cores, directory=directory, resume=known,
            progress=progress, preparing=count,
        )  # fmt: skip
    say(f"{problem.name}: {'read from' if known else 'sampled into'} {directory}", err=True)
    return fit
