"""Fit many data sets, here or on a cluster."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.atomic import write_atomically
from skinbayes.defaults import EFFECTIVE_SAMPLE_SIZE, MOST_DRAWS, SEED
from skinbayes.each.problems import share_preparation
from skinbayes.each.result import DRAWS, RUNS, TABLE, EachFit, OneFit
from skinbayes.each.task import FitTask, Fitted, Task, seed_of
from skinbayes.errors import InputError, cannot_write
from skinbayes.fit.assemble import require_data
from skinbayes.fit.result_folder import Kind, ResultFolder, stated
from skinbayes.problem.problem import Problem
from skinbayes.sampling.many_tasks import done_tasks
from skinbayes.sampling.options import whole

FITS: Kind[OneFit] = Kind(
    word="set of fits",
    manifest="each.json",
    lines="fits.jsonl",
    version="skinbayes fits of each 1",
    key=lambda one: one.name,
    to_dict=OneFit.to_dict,
    from_dict=OneFit.from_dict,
    again="fitted again",
)

LONGEST_STEM = 60
"""Characters of the name of a file."""


def fit_each(
    problems: Mapping[str, Problem | InputError],
    seed: int = SEED,
    ess: float = EFFECTIVE_SAMPLE_SIZE,
    cores: int = 1,
    scheduler: str | None = None,
    directory: str | Path | None = None,
    draws: int = MOST_DRAWS,
    runs: bool = False,
    progress: Callable[[int, int], None] | None = None,
    preparing: Callable[[int, int], None] | None = None,
    **options: Any,
) -> EachFit:
    """Fit one model to many data sets, each by itself.

    Each fit is the one that :func:`skinbayes.sample` makes of its problem with the seed that the table says. What all of
    them need, such as tables of films, is made once. A fit that ends in an error costs nothing but itself: it is counted, and
    the table says why.

    Parameters
    ----------
    problems : name to problem, as :func:`skinbayes.problems_of_each` makes them
    seed : non-negative integer; each fit has a seed of its own, from this one and its name
    ess : effective sample size wanted in every parameter of every fit
    cores : processes that share the fits
    scheduler : address of a dask scheduler whose workers share them instead, such as ``"tcp://node1:8786"``; needs
        ``pip install 'skinbayes[cluster]'`` there and here
    directory : where results are kept: ``results.csv``, and the draws of each fit; fits of the same data that are there
        already are not made again
    draws : how many are kept of each fit, evenly spaced; 0 for none
    runs : keep a run directory of each fit too, in ``directory``, which every command takes as it takes any run
    progress : called with the number of fits done and their total
    preparing : called with the number done and their total while tables are built before
    options : further options of :func:`skinbayes.sample`, such as ``max_steps`` or ``engine``

    Returns
    -------
    EachFit
        With ``table()``, one line a fit.

    Raises
    ------
    InputError
        No problem, one without data or anything to infer, an option out of range, ``directory`` holds something else, or the
        scheduler cannot be used.
    MachineError
        The disk is full, or a worker died again and again; fits done before are kept.

    Examples
    --------
    >>> import skinbayes as sb
    >>> data = {"person": ["A", "A", "B", "B"], "friction_coefficient": [0.4, 0.5, 0.8, 0.9]}
    >>> problem = sb.build_problem(
    ...     "constant", data, parameters={"typical_friction_coefficient": {"uniform": [0, 2]}},
    ...     noise={"family": "gaussian", "noise_scale": 0.1},
    ... )  # fmt: skip
    >>> fits = sb.fit_each(sb.problems_of_each(problem, column="person"), seed=1, ess=400)
    >>> fits.sentence(), fits.table().shape[0]
    ('2 fits: all converged.', 2)
    """
    for name, value, least in (("cores", cores, 1), ("seed", seed, 0), ("draws", draws, 0)):
        whole(name, value, least)
    usable = {name: problem for name, problem in problems.items() if isinstance(problem, Problem)}
    if not usable:
        raise InputError("no problem given; expected at least one")
    if runs and directory is None:
        raise InputError("run directories asked for without a directory; expected directory")
    for problem in usable.values():
        require_data(problem)
    first = next(iter(usable.values()))
    options = {"ess": ess, **options}
    asked = {
        "models": [first.name],
        "seed": seed,
        "draws": draws,
        "runs": runs,
        "options": stated(options),
    }
    found: dict[str, OneFit] = {}
    kept: dict[str, dict[str, FloatArray]] = {}
    with ExitStack() as stack:
        folder = (
            None if directory is None else stack.enter_context(ResultFolder(Path(directory), FITS, asked))
        )
        if folder is not None:
            found = {
                name: folder.done[name]
                for name, problem in usable.items()
                if name in folder.done and folder.done[name].fingerprint == problem.fingerprint
            }
        for name, error in problems.items():
            if isinstance(error, InputError):
                found[name] = OneFit(name, "", 0, seed_of(seed, name), failure=str(error)[:500])
        missing = {name: problem for name, problem in usable.items() if name not in found}
        share_preparation(missing.values(), preparing, cores)
        tasks, models = _tasks(missing, seed)
        work = FitTask(tuple(models), options, draws, runs)
        stems = _file_stems(problems)
        for _, fitted in done_tasks(work, tasks, cores, scheduler):
            one = replace(fitted.one, file=stems[fitted.one.name])
            if folder is not None:
                _store(folder.path, one, fitted)
                folder.add(one)
            elif fitted.draws:
                with np.load(io.BytesIO(fitted.draws)) as stored:
                    kept[one.name] = dict(stored)
            found[one.name] = one
            if progress is not None:
                progress(len(found), len(problems))
        result = EachFit(
            first.name, tuple(found[name] for name in problems), None if folder is None else folder.path, kept
        )
        if folder is not None:
            try:
                write_atomically(folder.path / TABLE, result.to_csv().encode())
            except OSError as error:
                raise cannot_write(folder.path / TABLE, error) from None
    return result


def _tasks(problems: Mapping[str, Problem], seed: int) -> tuple[list[Task], list[Any]]:
    """Tasks without what is prepared, and each prepared model once."""
    models: list[Any] = []
    tasks = []
    for name, problem in problems.items():
        place = next((i for i, model in enumerate(models) if model is problem.model), len(models))
        if place == len(models):
            models.append(problem.model)
        tasks.append(Task(name, replace(problem), place, seed_of(seed, name)))
    return tasks, models


def _file_stems(names: Mapping[str, Any]) -> dict[str, str]:
    """A file name for each, without what file systems do not take; those that would be the same are numbered."""
    found: dict[str, str] = {}
    taken: set[str] = set()
    for name in names:
        stem = re.sub(r"[^\w.-]+", "_", name).strip("._")[:LONGEST_STEM] or "fit"
        free, number = stem, 1
        while free.casefold() in taken:
            number += 1
            free = f"{stem}-{number}"
        taken.add(free.casefold())
        found[name] = free
    return found


def _store(directory: Path, one: OneFit, fitted: Fitted) -> None:
    """Write draws and run directory of a fit; before its line, so that a fit with a line is whole."""
    files = {f"{DRAWS}/{one.file}.npz": fitted.draws} if fitted.draws else {}
    files |= {f"{RUNS}/{one.file}/{name}": content for name, content in fitted.run.items()}
    for name, content in files.items():
        path = directory / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(path, content)
        except OSError as error:
            raise cannot_write(path, error) from None
