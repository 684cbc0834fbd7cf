"""A fit beside models without theory: does the physics earn its keep?"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.comparison.ranking import AgainstBaselines, beside
from skinbayes.comparison.scores import score
from skinbayes.errors import FingerprintMismatch, InputError

if TYPE_CHECKING:
    from skinbayes.fit import Fit
    from skinbayes.problem import Problem

FOLDER = "baselines"
"""Folder inside a run directory that holds the fits of its baseline models."""

BaselineProgress = Callable[[str, Any], None]
"""Called with the name of a baseline model and the sampler's progress while it is sampled."""


def against_baselines(
    fit: Fit, directory: str | Path | None = None, progress: BaselineProgress | None = None
) -> AgainstBaselines | None:
    """Put a fit beside the baseline models that its model file names.

    A baseline model is fitted to the same rows with the same seed, unless that has been done before.

    Parameters
    ----------
    fit : the fit
    directory : the run directory of the fit; baseline models are stored in its folder ``baselines``. None keeps nothing
    progress : called with the name of a baseline model and the sampler's progress while it is sampled

    Returns
    -------
    Baseline models or None
        None if the model names none, or its model file and data are not at hand

    Raises
    ------
    InputError
        A baseline model is no model of these data.
    """
    problem = fit.problem
    if problem is None or not problem.spec.baseline_models:
        return None
    others = [
        _fitted(name, problem, fit, None if directory is None else Path(directory), progress)
        for name in problem.spec.baseline_models
    ]
    fits = [fit, *others]
    return beside(fit, [score(entry) for entry in fits], fits)


def _fitted(
    name: str, problem: Problem, fit: Fit, directory: Path | None, progress: BaselineProgress | None
) -> Fit:
    """The fit of a baseline model to the data of a problem, stored or new."""
    from skinbayes.fit import load_fit, sample
    from skinbayes.problem import load_problem

    baseline_model = load_problem(name, data=problem.dataset)
    if baseline_model.data_fingerprint != problem.data_fingerprint:
        raise InputError(
            f"{problem.spec.path}: baseline_models: '{baseline_model.name}' does not explain the same data as '{problem.name}'; "
            f"expected a model of {', '.join(problem.observables)} with the same use of known spreads"
        )
    folder = None if directory is None else directory / FOLDER / baseline_model.name
    for inside in () if folder is None else (folder.parent, folder):
        if inside.is_symlink():
            raise InputError(
                f"{inside}: a link found, a folder of the run itself expected; nothing is written through links"
            )
    resume = folder is not None and folder.is_dir()
    if folder is not None and resume:
        try:
            stored = load_fit(folder)
        except InputError:  # an unfinished run, to be continued below
            stored = None
        if stored is not None and stored.provenance["fingerprint"] == baseline_model.fingerprint:
            return stored
        if stored is not None:
            resume = _cleared(folder)
    report = None if progress is None else (lambda state: progress(baseline_model.name, state))
    seed = int(fit.provenance["sampling"]["seed"])
    try:
        return sample(baseline_model, seed=seed, directory=folder, resume=resume, progress=report)
    except FingerprintMismatch:
        if folder is None or not resume:
            raise
        return sample(baseline_model, seed=seed, directory=folder, resume=_cleared(folder), progress=report)


def _cleared(folder: Path) -> bool:
    """Remove a fit of an earlier version of a baseline model, which was computed by this module; nothing is left to resume."""
    shutil.rmtree(folder)
    return False
