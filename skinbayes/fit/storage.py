"""Results on disk: one netCDF file in the ArviZ schema, and the run directory that ``fit`` writes."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.atomic import write_atomically
from skinbayes.errors import InputError
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
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    image = io.BytesIO()  # in memory, because HDF5 does not survive a full disk
    with h5netcdf.File(image, "w") as file:
        for name, group in fit.groups.items():
            dataset = (
                group.assign_attrs(skinbayes=json.dumps(fit.provenance)) if name == "posterior" else group
            )
            dataset.dump_to_store(H5NetCDFStore(file.create_group(name)))
    write_atomically(path, image.getvalue())
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
