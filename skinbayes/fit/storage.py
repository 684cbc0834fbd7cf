"""Results on disk: one netCDF file in the ArviZ schema, and the run directory that ``fit`` writes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.errors import InputError, warn_of_repair
from skinbayes.fit.fit import Fit
from skinbayes.fit.joint_fit import JointFit
from skinbayes.fit.manifest import (
    BASELINE_MODELS,
    RESULT,
    RUN,
    STEPS,
    SUMMARY,
    DataNote,
    Manifest,
    read_manifest,
    trouble,
)
from skinbayes.fit.netcdf import read_result
from skinbayes.problem.joint import JointProblem
from skinbayes.problem.problem import Problem
from skinbayes.sealed import DamagedFile, file_digest
from skinbayes.version import __version__

if TYPE_CHECKING:
    from collections.abc import Mapping

    from skinbayes.files.dataset import Dataset


def load_fit(path: str | Path) -> Fit:
    """Read a fit.

    Every file that is read was written with a checksum, and none is used that does not fit it.

    Parameters
    ----------
    path : a netCDF file written by :meth:`Fit.save`, or a run directory written by ``skinbayes fit``

    Returns
    -------
    Fit
        With its problem, where model and data are at hand.

    Raises
    ------
    InputError
        Nothing there, not a result of skinbayes, or a file of it was damaged or changed.

    Warns
    -----
    RepairWarning
        The model cannot be built again, as after a change of skinbayes: the fit has no ``problem``. Or the table of the
        run, which is not read, was changed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import numpy as np
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-water")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 100))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     again = load_fit(fit.save(pathlib.Path(folder) / "fit.nc"))
    >>> np.array_equal(again.theta(), fit.theta())
    True
    """
    fit = load_any_fit(path)
    if isinstance(fit, JointFit):
        raise InputError(f"{path}: a fit of several experiments; in Python skinbayes.load_joint_fit reads it")
    return fit


def load_joint_fit(path: str | Path) -> JointFit:
    """Read a fit of several experiments.

    Parameters
    ----------
    path : a netCDF file written by :meth:`JointFit.save`, or a run directory written by ``skinbayes fit``

    Returns
    -------
    JointFit
        With its problem, where model and data are at hand.

    Raises
    ------
    InputError
        As :func:`load_fit` does, and for a fit of one experiment.

    Warns
    -----
    RepairWarning
        As :func:`load_fit` does.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import numpy as np
    >>> import skinbayes as sb
    >>> noise = {"family": "gaussian", "noise_scale": 0.1}
    >>> one = {"forward": "constant", "noise": noise, "data": {"friction_coefficient": [0.4]}}
    >>> problem = sb.build_joint_problem(
    ...     {"left": one, "right": one}, parameters={"typical_friction_coefficient": {"uniform": [0, 2]}}
    ... )
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     fit = sb.sample(problem, seed=1, ess=100, directory=pathlib.Path(folder) / "run")
    ...     again = load_joint_fit(pathlib.Path(folder) / "run")
    >>> np.array_equal(again.theta(), fit.theta())
    True
    """
    fit = load_any_fit(path)
    if isinstance(fit, Fit):
        raise InputError(f"{path}: a fit of one experiment; load_fit reads it")
    return fit


def load_any_fit(path: str | Path) -> Fit | JointFit:
    """Read a fit, of one experiment or of several; see :func:`load_fit`."""
    path = Path(path)
    run = path if path.is_dir() else None
    file = path if run is None else run / RESULT
    if run is None and not path.is_file():
        raise InputError(
            f"{path}: no result found: there is no such folder or file; expected a run that 'skinbayes fit' wrote"
        )
    if not file.is_file():
        raise InputError(f"{path}: no result found ({file.name} is missing){_unfinished(path)}")
    manifest = None if run is None else _undamaged(run)
    steps = f". The steps are kept: {_again(run)} from them" if run and (run / STEPS).is_dir() else ""
    try:
        groups, provenance, digest = read_result(file)
    except DamagedFile as error:
        raise InputError(f"{file}: damaged, or not a result written by skinbayes ({error}){steps}") from None
    except PermissionError as error:
        raise InputError(f"{file}: cannot be read ({error.strerror})") from None
    if run is not None and manifest is not None:
        if RESULT not in manifest.files:
            raise InputError(f"{run}: no finished result found{_unfinished(run)}")
        if digest != manifest.files[RESULT]:
            raise InputError(
                f"{file}: not the result of this run, or changed since (its sha256 is not the one in {RUN}){steps}"
            )
        if (table := run / SUMMARY).is_file() and file_digest(table) != manifest.files.get(SUMMARY):
            warn_of_repair(
                f"{table}: damaged, or changed since the run was made; the numbers of the run are in {file}"
            )
    provenance = dict(provenance)
    problem = _rebuild(file, run, manifest, provenance)
    if "experiments" in provenance:
        return JointFit(groups, provenance, problem if isinstance(problem, JointProblem) else None)
    return Fit(groups, provenance, problem if isinstance(problem, Problem) else None)


def _unfinished(path: Path) -> str:
    if not (path / STEPS).is_dir():
        return ""
    return "; the run is not finished: continue it with 'skinbayes fit ... --resume'"


def _again(run: Path) -> str:
    return (
        f"'skinbayes fit MODEL -o {run} --resume' with the model, data and options of the run writes it again"
    )


def _undamaged(run: Path) -> Manifest:
    """What ``run.json`` says, after the copies of model and data were compared with it."""
    alone = f"The numbers alone can be read from {run / RESULT}"
    try:
        manifest = read_manifest(run)
        wrong = {} if manifest is None else trouble(run, manifest)
    except DamagedFile as error:
        raise InputError(f"{run / RUN}: damaged ({error}); {_again(run)}. {alone}") from None
    except PermissionError as error:
        raise InputError(f"{error.filename}: cannot be read ({error.strerror})") from None
    if manifest is None:
        raise InputError(
            f"{run / RUN}: missing, so this is not a result written by skinbayes, or the file was lost: {_again(run)}. {alone}"
        )
    for name, what in wrong.items():
        raise InputError(f"{run / name}: {what}. Put the original back, or {_again(run)}. {alone}")
    return manifest


def _rebuild(
    file: Path, run: Path | None, manifest: Manifest | None, provenance: Mapping[str, Any]
) -> Problem | JointProblem | None:
    """The problem of a stored run, from the copies beside it or, for a bare file, from the shipped models."""
    from skinbayes.problem.load import load_any_problem

    reason, written = "what they say is not what was fitted", provenance["versions"].get("skinbayes")
    if run is None and written != __version__:
        reason = f"the file was written by version {written} of skinbayes, this is {__version__}"
    elif run is None:
        reason = "the model or its data are not what was fitted"
    try:
        shipped = str(provenance["model_path"])
        problem: Problem | JointProblem
        if run and manifest:
            problem = (_joint_from_copies if manifest.experiments else _from_copies)(run, manifest)
        else:
            problem = load_any_problem(shipped)
        # copies were compared with their checksums; of any other model file nothing is known
        if _is_same(problem, provenance) if run and manifest else _is_identical(problem, provenance):
            return _renamed(problem, provenance)
    except (InputError, OSError, ValueError, KeyError) as error:
        reason = str(error)
    copies = "" if run is None else " from the undamaged copies of model and data"
    warn_of_repair(
        f"{run or file}: the model cannot be built again{copies} ({reason}). "
        "The numbers are read as they were computed; what needs the model is left out"
    )
    return None


def _data_of(run: Path, note: DataNote | Manifest) -> Dataset | None:
    """The copy of the data of an experiment."""
    from skinbayes.files.dataset import load_dataset

    if note.data is None:
        return None
    data = load_dataset(run / note.data, missing="keep")
    # which need not be those that the model file selects
    return data.select(note.rows) if note.rows else data


def _settings(run: Path, manifest: Manifest) -> dict[str, str]:
    settings = dict(manifest.settings)
    if manifest.surface is not None:
        settings["surface"] = str(run / manifest.surface)
    return settings


def _joint_from_copies(run: Path, manifest: Manifest) -> JointProblem:
    from skinbayes.files.dataset import load_dataset
    from skinbayes.files.joint_model import load_joint_model
    from skinbayes.problem.joint_bind import bind_joint

    notes = manifest.experiments
    data = {name: found for name, note in notes.items() if (found := _data_of(run, note)) is not None}
    curves = {name: load_dataset(run / note.rheology) for name, note in notes.items() if note.rheology}
    spec = load_joint_model(run / "model.toml")
    return bind_joint(spec, data, settings=_settings(run, manifest), rheologies=curves)


def _from_copies(run: Path, manifest: Manifest) -> Problem:
    from skinbayes.problem import load_problem

    rheology = None if manifest.rheology is None else run / manifest.rheology
    problem = load_problem(
        run / "model.toml", _data_of(run, manifest), _settings(run, manifest), rheology=rheology
    )
    copies = [
        str(run / BASELINE_MODELS / Path(name).name) if Path(name).suffix == ".toml" else name
        for name in problem.spec.baseline_models
    ]
    return replace(problem, spec=replace(problem.spec, baseline_models=tuple(copies)))


def _renamed(problem: Problem | JointProblem, provenance: Mapping[str, Any]) -> Problem | JointProblem:
    """The problem under the names it was fitted with, not those of the copies in the run directory."""
    if isinstance(problem, JointProblem):
        told = provenance["experiments"]
        experiments = {}
        for name, one in problem.experiments.items():
            renamed = _renamed(one, told[name])
            experiments[name] = renamed if isinstance(renamed, Problem) else one
        return replace(
            problem, spec=replace(problem.spec, name=str(provenance["model"])), experiments=experiments
        )
    spec = replace(
        problem.spec,
        name=str(provenance["model"]),
        title=str(provenance.get("title", problem.spec.title)),
        description=str(provenance.get("description", problem.spec.description)),
    )
    key = str(provenance["data"].get("key", ""))
    dataset = None if problem.dataset is None else replace(problem.dataset, key=key or problem.dataset.key)
    return replace(problem, spec=spec, dataset=dataset)


def _is_identical(problem: Problem | JointProblem, provenance: Mapping[str, Any]) -> bool:
    """Whether everything that a posterior depends on is what it was, the noise and the version of skinbayes included."""
    return problem.fingerprint == provenance.get("fingerprint")


def _is_same(problem: Problem | JointProblem, provenance: Mapping[str, Any]) -> bool:
    """Whether a problem is the one that was fitted; unlike the fingerprint this survives a new version of skinbayes."""
    try:
        return bool(
            list(problem.names) == provenance["names"]
            and problem.data_fingerprint == provenance["data"]["fingerprint"]
            and {p.label: p.value for p in problem.fixed}
            == {label: entry["value"] for label, entry in provenance["fixed"].items()}
            and {p.label: p.prior_text for p in problem.tied}
            == {label: entry["text"] for label, entry in provenance.get("tied", {}).items()}
            and {p.label: p.prior_text for p in problem.free}
            == {label: entry["text"] for label, entry in provenance["priors"].items()}
        )
    except (KeyError, TypeError):
        return False
