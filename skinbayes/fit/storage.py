"""Results on disk: one netCDF file in the ArviZ schema, and the run directory that ``fit`` writes."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from skinbayes.errors import FingerprintMismatch, InputError
from skinbayes.fit.result import Fit

if TYPE_CHECKING:
    from skinbayes.files.dataset import Dataset
    from skinbayes.problem import Problem

RESULT = "result.nc"
SUMMARY = "summary.csv"
RUN = "run.json"
STEPS = "steps"
"""Folder of the sampler's step store inside a run directory."""

YARDSTICK_MODELS = "yardstick-models"
"""Folder of the user's own yardsticks inside a run directory."""


def save_fit(fit: Fit, path: Path) -> Path:
    """Write a fit as netCDF; the file appears whole or not at all."""
    temporary = path.with_name(path.name + ".part")
    mode: Literal["w", "a"] = "w"
    for name, group in fit.groups.items():
        dataset = group.assign_attrs(skinbayes=json.dumps(fit.provenance)) if name == "posterior" else group
        dataset.to_netcdf(temporary, mode=mode, group=name, engine="h5netcdf")
        mode = "a"
    temporary.replace(path)
    return path


def load_fit(path: str | Path) -> Fit:
    """Read a fit.

    Parameters
    ----------
    path : a netCDF file written by :meth:`Fit.save`, or a run directory written by ``skinbayes fit``

    Raises
    ------
    InputError
        Nothing there, or not a result of skinbayes.
    """
    import xarray

    path = Path(path)
    file = path / RESULT if path.is_dir() else path
    if not file.exists():
        hint = (
            "; the run is not finished: continue it with 'skinbayes fit ... --resume'"
            if (path / STEPS).is_dir()
            else ""
        )
        raise InputError(f"{path}: no result found ({file.name} is missing){hint}")
    try:
        names = _group_names(file)
        groups = {name: xarray.load_dataset(file, group=name, engine="h5netcdf") for name in names}
        provenance = json.loads(groups["posterior"].attrs.pop("skinbayes"))
    except (OSError, KeyError, ValueError) as error:
        raise InputError(f"{file}: not a result written by skinbayes ({error})") from None
    return Fit(groups=groups, provenance=provenance, problem=_rebuild(path, provenance))


def _group_names(file: Path) -> list[str]:
    import h5py

    with h5py.File(file, "r") as opened:
        return [name for name, item in opened.items() if isinstance(item, h5py.Group)]


def claim_run(directory: Path, problem: Problem, resume: bool) -> None:
    """Make the directory of a run and put model file, data and spectrum into it, so that it can be read on its own.

    Nothing is written into a directory that holds another run.

    Parameters
    ----------
    directory : the run directory
    problem : what is to be sampled
    resume : the directory may hold a run of this problem, finished or not

    Raises
    ------
    InputError
        It holds a run that is not to be continued or cannot be, or it cannot be written.
    """
    try:
        holds_result = (directory / RESULT).exists()
        if not resume and (holds_result or (directory / STEPS).is_dir()):
            raise InputError(
                f"{directory}: holds {'a result' if holds_result else 'an unfinished run'} already; "
                "give another folder, or continue it with --resume"
            )
        stored = _read_note(directory)
        if stored is not None and resume and stored.get("fingerprint") != problem.fingerprint:
            raise FingerprintMismatch(
                f"{directory}: holds a run of '{stored.get('model')}' with another model, data, prior or version than "
                f"'{problem.name}' here; give another folder"
            )
        for path in _own_yardsticks(problem):
            if not path.is_file():
                raise InputError(
                    f"{problem.spec.path}: yardsticks: no file {path}; expected a model file to compare with"
                )
        if stored is None or not resume:
            directory.mkdir(parents=True, exist_ok=True)
            _write_inputs(directory, problem)
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


def _read_note(directory: Path) -> dict[str, Any] | None:
    """What ``run.json`` says, None if there is no run; a damaged one counts as another run."""
    try:
        note = json.loads((directory / RUN).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except ValueError:
        return {}
    return note if isinstance(note, dict) else {}


def _write_inputs(directory: Path, problem: Problem) -> None:
    _copy(problem.spec.path, directory / "model.toml")
    note: dict[str, Any] = {
        "model": problem.name,
        "fingerprint": problem.fingerprint,
        "data": None,
        "surface": None,
        "rheology": None,
        "settings": {name: text for name, text in problem.settings.items() if name != "surface"},
    }
    if "surface" in problem.settings and problem.surface_file is None:
        note["settings"]["surface"] = problem.settings["surface"]
    if problem.dataset is not None:
        source = Path(problem.dataset.path)
        folder = directory / "data"
        folder.mkdir(exist_ok=True)
        _copy(source, folder / source.name)
        note["rows"] = {column: list(labels) for column, labels in problem.dataset.selection.items()}
        provenance = source.with_name("provenance.toml")
        if source.name == "data.csv" and provenance.exists():
            _copy(provenance, folder / provenance.name)
            note["data"] = "data"
        else:
            note["data"] = f"data/{source.name}"
    if problem.spec.rheology is not None and Path(problem.spec.rheology).is_file():
        _copy(Path(problem.spec.rheology), directory / "rheology.csv")
        note["rheology"] = "rheology.csv"
    if problem.surface_file is not None:
        _copy(problem.surface_file, directory / "spectrum.csv")
        note["surface"] = "spectrum.csv"
    for path in _own_yardsticks(problem):
        (directory / YARDSTICK_MODELS).mkdir(exist_ok=True)
        _copy(path, directory / YARDSTICK_MODELS / path.name)
    # last, so that a directory with this file is complete
    (directory / RUN).write_text(json.dumps(note, indent=1) + "\n", encoding="utf-8")


def _copy(source: Path, copy: Path) -> None:
    # the user may point at the copies of an earlier run in this very directory
    if not (copy.exists() and copy.samefile(source)):
        shutil.copyfile(source, copy)


def _rebuild(path: Path, provenance: Mapping[str, Any]) -> Problem | None:
    """The problem of a stored run, from the copies beside it or, for a bare file, from the shipped models."""
    from skinbayes.files.dataset import load_dataset
    from skinbayes.problem import load_problem

    try:
        if path.is_dir():
            note = json.loads((path / RUN).read_text(encoding="utf-8"))
            settings = dict(note.get("settings") or {})
            if note["surface"]:
                settings["surface"] = str(path / note["surface"])
            rheology = path / note["rheology"] if note.get("rheology") else None
            data: Path | Dataset = path / note["data"]
            if "rows" in note:  # which need not be those that the model file selects
                dataset = load_dataset(path / note["data"])
                data = dataset.select(note["rows"]) if note["rows"] else dataset
            problem = load_problem(path / "model.toml", data, settings, rheology=rheology)
            copies = [
                str(path / YARDSTICK_MODELS / Path(name).name) if Path(name).suffix == ".toml" else name
                for name in problem.spec.yardsticks
            ]
            problem = replace(problem, spec=replace(problem.spec, yardsticks=tuple(copies)))
        else:
            problem = load_problem(str(provenance["model_path"]))
    except (InputError, OSError, ValueError, KeyError):
        return None
    return _renamed(problem, provenance) if _is_same(problem, provenance) else None


def _renamed(problem: Problem, provenance: Mapping[str, Any]) -> Problem:
    """The problem under the names it was fitted with, not those of the copies in the run directory."""
    spec = replace(
        problem.spec,
        name=str(provenance["model"]),
        title=str(provenance.get("title", problem.spec.title)),
        description=str(provenance.get("description", problem.spec.description)),
    )
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
