"""Results on disk: one netCDF file in the ArviZ schema, and the run directory that ``fit`` writes."""

from __future__ import annotations

import hashlib
import warnings
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.atomic import write_atomically
from skinbayes.errors import FingerprintMismatch, InputError, RepairWarning
from skinbayes.fit.manifest import (
    RESULT,
    RUN,
    STEPS,
    SUMMARY,
    Manifest,
    read_manifest,
    trouble,
    write_manifest,
)
from skinbayes.fit.netcdf import read_result, result_image
from skinbayes.fit.result import Fit
from skinbayes.sealed import DamagedFile, put_aside

if TYPE_CHECKING:
    from collections.abc import Mapping

    from skinbayes.files.dataset import Dataset
    from skinbayes.problem import Problem

YARDSTICK_MODELS = "yardstick-models"
"""Folder of the user's own yardsticks inside a run directory."""


def save_fit(fit: Fit, path: Path) -> Path:
    """Write a fit as netCDF; the file appears whole or not at all, and shows any damage when it is read."""
    _write(path, result_image(fit.groups, fit.provenance))
    return path


def save_run(fit: Fit, directory: Path, manifest: Manifest) -> None:
    """Write result and summary of a run into its directory, and their checksums into what ``claim_run`` gave."""
    table = fit.summary(derived=True).to_csv(index_label="parameter")
    written = {
        RESULT: _write(directory / RESULT, result_image(fit.groups, fit.provenance)),
        SUMMARY: _write(directory / SUMMARY, table.encode()),
    }
    # last: a result that is listed is one that was finished
    write_manifest(directory, replace(manifest, files={**manifest.files, **written}))


def _write(path: Path, content: bytes) -> str:
    """Write a file and return its sha256, that of the content as it was meant."""
    write_atomically(path, content)
    return hashlib.sha256(content).hexdigest()


def load_fit(path: str | Path) -> Fit:
    """Read a fit.

    Every file that is read was written with a checksum, and none is used that does not fit it.

    Parameters
    ----------
    path : a netCDF file written by :meth:`Fit.save`, or a run directory written by ``skinbayes fit``

    Raises
    ------
    InputError
        Nothing there, not a result of skinbayes, or a file of it was damaged or changed.

    Warns
    -----
    RepairWarning
        The model of an undamaged run directory cannot be built again, as after a change of skinbayes: the fit has no ``problem``.
    """
    path = Path(path)
    run = path if path.is_dir() else None
    file = path if run is None else run / RESULT
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
    provenance = dict(provenance)
    return Fit(groups=groups, provenance=provenance, problem=_rebuild(run, manifest, provenance))


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
        raise InputError(f"{run / RUN}: missing; {_again(run)}. {alone}")
    for name, what in wrong.items():
        raise InputError(f"{run / name}: {what}. Put the original back, or {_again(run)}. {alone}")
    return manifest


def claim_run(directory: Path, problem: Problem, resume: bool) -> Manifest:
    """Make the directory of a run and put model file, data and spectrum into it, so that it can be read on its own.

    Nothing is written into a directory that holds another run.

    Parameters
    ----------
    directory : the run directory
    problem : what is to be sampled
    resume : the directory may hold a run of this problem, finished or not

    Returns
    -------
    Manifest
        what ``run.json`` says

    Raises
    ------
    InputError
        It holds a run that is not to be continued or cannot be, or it cannot be written.

    Warns
    -----
    RepairWarning
        Copies of model and data were damaged or missing; they were written again, and what was there was put aside.
    """
    try:
        holds_result = (directory / RESULT).exists()
        if not resume and (holds_result or (directory / STEPS).is_dir()):
            raise InputError(
                f"{directory}: holds {'a result' if holds_result else 'an unfinished run'} already; "
                "give another folder, or continue it with --resume"
            )
        stored = _held(directory, problem, resume)
        for path in _own_yardsticks(problem):
            if not path.is_file():
                raise InputError(
                    f"{problem.spec.path}: yardsticks: no file {path}; expected a model file to compare with"
                )
        wrong = {} if stored is None or not resume else trouble(directory, stored)
        for name in wrong:
            if not (directory / name).exists():
                _warn(f"{directory / name}: missing; written again from the model and data that were given")
        if stored is not None and resume and not wrong:
            return stored
        directory.mkdir(parents=True, exist_ok=True)
        return _write_inputs(directory, problem)
    except InputError:
        raise
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise InputError(
            f"{directory}: cannot be used for a run ({reason}); expected a folder that can be written"
        ) from None


def _own_yardsticks(problem: Problem) -> list[Path]:
    """Yardsticks that are no shipped models."""
    return [Path(name) for name in problem.spec.yardsticks if Path(name).suffix == ".toml"]


def _held(directory: Path, problem: Problem, resume: bool) -> Manifest | None:
    """What ``run.json`` says; None if there is none, or if it was damaged and the steps are of this problem all the same."""
    from skinbayes.sampling.store import stored_fingerprint

    try:
        stored, damage = read_manifest(directory), None
    except DamagedFile as error:
        stored, damage = None, error
    found = stored.fingerprint if stored is not None else stored_fingerprint(directory / STEPS)
    if resume and found is not None and found != problem.fingerprint:
        name = "" if stored is None else f" of '{stored.model}'"
        raise FingerprintMismatch(
            f"{directory}: holds a run{name} with another model, data, prior or version than "
            f"'{problem.name}' here; give another folder"
        )
    if damage is not None:
        if not resume or found is None:
            raise InputError(
                f"{directory / RUN}: damaged ({damage}), and the steps beside it do not tell whose run it was; "
                "give another folder"
            )
        put_aside(directory / RUN)
        _warn(f"{directory / RUN}: damaged ({damage}); written again")
    return stored


def _write_inputs(directory: Path, problem: Problem) -> Manifest:
    files = {"model.toml": _copy(problem.spec.path, directory / "model.toml")}
    note: dict[str, Any] = {"data": None, "surface": None, "rheology": None, "rows": None}
    settings = {name: text for name, text in problem.settings.items() if name != "surface"}
    if "surface" in problem.settings and problem.surface_file is None:
        settings["surface"] = problem.settings["surface"]
    if problem.dataset is not None:
        source = Path(problem.dataset.path)
        folder = directory / "data"
        folder.mkdir(exist_ok=True)
        note["data"] = f"data/{source.name}"
        files[note["data"]] = _copy(source, folder / source.name)
        note["rows"] = {column: list(labels) for column, labels in problem.dataset.selection.items()}
        provenance = source.with_name("provenance.toml")
        if source.name == "data.csv" and provenance.exists():
            files["data/provenance.toml"] = _copy(provenance, folder / provenance.name)
            note["data"] = "data"
    if problem.spec.rheology is not None and Path(problem.spec.rheology).is_file():
        files["rheology.csv"] = _copy(Path(problem.spec.rheology), directory / "rheology.csv")
        note["rheology"] = "rheology.csv"
    if problem.surface_file is not None:
        files["spectrum.csv"] = _copy(problem.surface_file, directory / "spectrum.csv")
        note["surface"] = "spectrum.csv"
    for path in _own_yardsticks(problem):
        (directory / YARDSTICK_MODELS).mkdir(exist_ok=True)
        files[f"{YARDSTICK_MODELS}/{path.name}"] = _copy(path, directory / YARDSTICK_MODELS / path.name)
    manifest = Manifest(problem.name, problem.fingerprint, **note, settings=settings, files=files)
    # last, so that a directory with this file is complete
    write_manifest(directory, manifest)
    return manifest


def _copy(source: Path, copy: Path) -> str:
    """Copy a file, put aside what else is there, and return the sha256 of the content."""
    content = source.read_bytes()
    # the user may point at the copies of an earlier run in this very directory
    if copy.exists() and not copy.samefile(source) and copy.read_bytes() != content:
        aside = put_aside(copy)
        _warn(
            f"{copy}: damaged, or changed since the run was made; renamed to {aside.name}, and written again "
            "from the model and data that were given"
        )
    return _write(copy, content)


def _warn(message: str) -> None:
    warnings.warn(message, RepairWarning, stacklevel=3)


def _rebuild(run: Path | None, manifest: Manifest | None, provenance: Mapping[str, Any]) -> Problem | None:
    """The problem of a stored run, from the copies beside it or, for a bare file, from the shipped models."""
    from skinbayes.problem import load_problem

    reason = "what they say is not what was fitted"
    try:
        shipped = str(provenance["model_path"])
        problem = _from_copies(run, manifest) if run and manifest else load_problem(shipped)
        if _is_same(problem, provenance):
            return _renamed(problem, provenance)
    except (InputError, OSError, ValueError, KeyError) as error:
        reason = str(error)
    if run is not None:
        _warn(
            f"{run}: the model cannot be built again from the undamaged copies of model and data ({reason}). "
            "The numbers are read as they were computed; what needs the model is left out"
        )
    return None


def _from_copies(run: Path, manifest: Manifest) -> Problem:
    from skinbayes.files.dataset import load_dataset
    from skinbayes.problem import load_problem

    settings = dict(manifest.settings)
    if manifest.surface is not None:
        settings["surface"] = str(run / manifest.surface)
    rheology = None if manifest.rheology is None else run / manifest.rheology
    data: Dataset | None = None
    if manifest.data is not None:
        data = load_dataset(run / manifest.data)
        # which need not be those that the model file selects
        data = data.select(manifest.rows) if manifest.rows else data
    problem = load_problem(run / "model.toml", data, settings, rheology=rheology)
    copies = [
        str(run / YARDSTICK_MODELS / Path(name).name) if Path(name).suffix == ".toml" else name
        for name in problem.spec.yardsticks
    ]
    return replace(problem, spec=replace(problem.spec, yardsticks=tuple(copies)))


def _renamed(problem: Problem, provenance: Mapping[str, Any]) -> Problem:
    """The problem under the names it was fitted with, not those of the copies in the run directory."""
    spec = replace(problem.spec, name=str(provenance["model"]))
    key = str(provenance["data"].get("key", ""))
    dataset = None if problem.dataset is None else replace(problem.dataset, key=key or problem.dataset.key)
    return replace(problem, spec=spec, dataset=dataset)


def _is_same(problem: Problem, provenance: Mapping[str, Any]) -> bool:
    """Whether a problem is the one that was fitted; unlike the fingerprint this survives a new version of skinbayes."""
    try:
        return bool(
            list(problem.names) == provenance["names"]
            and problem.data_fingerprint == provenance["data"]["fingerprint"]
            and {p.label: p.value for p in problem.fixed}
            == {label: entry["value"] for label, entry in provenance["fixed"].items()}
            and {p.label: p.prior_text for p in problem.free}
            == {label: entry["text"] for label, entry in provenance["priors"].items()}
        )
    except (KeyError, TypeError):
        return False
