"""Results on disk: one netCDF file in the ArviZ schema, and the run directory that ``fit`` writes."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from skinbayes.errors import InputError
from skinbayes.fit.result import Fit

if TYPE_CHECKING:
    from skinbayes.problem import Problem

RESULT = "result.nc"
SUMMARY = "summary.csv"
RUN = "run.json"
STEPS = "steps"
"""Folder of the sampler's step store inside a run directory."""


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


def write_run(directory: Path, problem: Problem) -> None:
    """Put model file, data and spectrum beside the run, so that it can be read when the originals are gone."""
    directory.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(problem.spec.path, directory / "model.toml")
    note: dict[str, str | None] = {
        "model": problem.name,
        "fingerprint": problem.fingerprint,
        "data": None,
        "surface": None,
    }
    if problem.dataset is not None:
        source = Path(problem.dataset.path)
        folder = directory / "data"
        folder.mkdir(exist_ok=True)
        shutil.copyfile(source, folder / source.name)
        provenance = source.with_name("provenance.toml")
        if source.name == "data.csv" and provenance.exists():
            shutil.copyfile(provenance, folder / provenance.name)
            note["data"] = "data"
        else:
            note["data"] = f"data/{source.name}"
    if problem.spec.surface_file is not None:
        shutil.copyfile(problem.spec.surface_file, directory / "spectrum.csv")
        note["surface"] = "spectrum.csv"
    (directory / RUN).write_text(json.dumps(note, indent=1) + "\n", encoding="utf-8")


def _rebuild(path: Path, provenance: Mapping[str, object]) -> Problem | None:
    """The problem of a stored run, from the copies beside it or, for a bare file, from the shipped models."""
    from skinbayes.problem import load_problem

    try:
        if path.is_dir():
            note = json.loads((path / RUN).read_text(encoding="utf-8"))
            settings = {"surface": str(path / note["surface"])} if note["surface"] else {}
            problem = load_problem(path / "model.toml", path / note["data"], settings)
        else:
            problem = load_problem(str(provenance["model_path"]))
    except (InputError, OSError, ValueError, KeyError):
        return None
    return problem if list(problem.names) == provenance["names"] else None
