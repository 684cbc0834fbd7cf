"""One result as netCDF groups in the ArviZ schema: written with a checksum, and read only if every byte fits it."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.errors import InputError
from skinbayes.fit.joint_groups import EACH, of_experiment
from skinbayes.fit.manifest import other_version
from skinbayes.sealed import DamagedFile, checked, sealed

if TYPE_CHECKING:
    import xarray

NEEDED = (
    "posterior",
    "sample_stats",
    "posterior_predictive",
    "log_likelihood",
    "prior",
    "prior_predictive",
    "observed_data",
    "constant_data",
)
"""Groups that every result has."""

NEEDED_OF_ALL = ("posterior", "sample_stats", "log_likelihood", "prior", "observed_data", "constant_data")
"""Groups that a result of several experiments has beside those of each."""

MOST_GROUPS = 100
MOST_VARIABLES = 100_000
"""Of one group; more would take minutes to open."""

FORMAT = 2
"""Of the provenance; 1, which had no number, knew one engine only."""

_RECORD: dict[str, type] = {
    "model": str,
    "title": str,
    "description": str,
    "model_path": str,
    "model_text": str,
    "fingerprint": str,
    "names": list,
    "observables": list,
    "noise": dict,
    "fixed": dict,
    "priors": dict,
    "data": dict,
    "sampling": dict,
    "versions": dict,
}
"""What the provenance of every result holds."""


def result_image(groups: Mapping[str, xarray.Dataset], provenance: Mapping[str, Any]) -> bytes:
    """The content of a result file. It is made in memory: HDF5 does not survive a disk that is full."""
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    image = io.BytesIO()
    with h5netcdf.File(image, "w") as file:
        for name, group in groups.items():
            note = {"skinbayes": json.dumps(provenance)} if name == "posterior" else {}
            group.assign_attrs(note).dump_to_store(H5NetCDFStore(file.create_group(name)))
    return sealed(image.getvalue())


def read_result(file: Path) -> tuple[dict[str, xarray.Dataset], dict[str, Any], str]:
    """Groups and provenance of a result file, and its sha256.

    Raises
    ------
    DamagedFile
        It is not what was written, or holds something else than a result.
    InputError
        It is of another version.
    PermissionError
        It must not be read.
    """
    import xarray

    try:
        digest = checked(file)
        names, provenance = _looked_through(file)
        groups = {name: xarray.load_dataset(file, group=name, engine="h5netcdf") for name in names}
        groups["posterior"].attrs.pop("skinbayes")
        _require_consistent(groups, provenance)
    except (DamagedFile, InputError, PermissionError):
        raise
    except (
        Exception
    ) as error:  # the libraries raise errors of many types about a file that was made to confuse them
        raise DamagedFile(f"{error}") from error
    return groups, provenance, digest


def _looked_through(path: Path) -> tuple[list[str], dict[str, Any]]:
    """Names of the groups and provenance; before anything large is read, because a file may declare more than it holds."""
    import h5py

    with h5py.File(path, "r", locking=False) as file:
        if len(file) > MOST_GROUPS:
            raise DamagedFile(f"{len(file)} groups found, {MOST_GROUPS} at most expected")
        names = list(file)
        if "posterior" not in names:
            raise DamagedFile("the group 'posterior' is missing")
        for name in names:
            group = file.get(name) if isinstance(file.get(name, getlink=True), h5py.HardLink) else None
            if not isinstance(group, h5py.Group) or len(group) > MOST_VARIABLES:
                raise DamagedFile(f"'{name:.80}' is no group of a result")
            for key in group:
                _require_stored(group, key)
        provenance = json.loads(file["posterior"].attrs["skinbayes"])
    if missing := [name for name in _needed(provenance) if name not in names]:
        raise DamagedFile(f"the group '{missing[0]}' is missing")
    if isinstance(provenance, dict) and (found := provenance.get("format", 1)) != FORMAT:
        raise other_version(path, found, FORMAT)
    return names, provenance


def _needed(provenance: Any) -> Sequence[str]:
    """Groups that a result has."""
    experiments = provenance.get("experiments") if isinstance(provenance, dict) else None
    if not isinstance(experiments, dict) or not experiments:
        return NEEDED
    return [*NEEDED_OF_ALL, *(f"{name}.{group}" for name in experiments for group in NEEDED)]


def _require_stored(group: Any, key: str) -> None:
    """Refuse a variable that is not numbers or text, or is not stored as a whole in this file."""
    import h5py

    hard = isinstance(group.get(key, getlink=True), h5py.HardLink)
    item = group[key] if hard else None
    if not isinstance(item, h5py.Dataset) or item.external or item.is_virtual or item.shape is None:
        raise DamagedFile(f"'{group.name:.80}/{key:.80}' is no variable of a result")
    if not (item.dtype.kind in "fiu" or h5py.check_string_dtype(item.dtype)):
        raise DamagedFile(f"'{group.name:.80}/{key:.80}' is neither numbers nor text")
    if item.id.get_storage_size() < item.nbytes:
        raise DamagedFile(f"'{group.name:.80}/{key:.80}' declares more than it holds")


def _require_consistent(groups: Mapping[str, xarray.Dataset], provenance: Any) -> None:
    """Refuse a result whose parts do not belong together."""
    if not isinstance(provenance, dict):
        raise DamagedFile("it does not say where it comes from")
    for key, kind in _RECORD.items():
        if not isinstance(provenance.get(key), kind):
            raise DamagedFile(f"its provenance has no usable '{key}'")
    names, sampling = provenance["names"], provenance["sampling"]
    for key in set(EACH) & set(sampling):
        values = np.asarray(sampling[key])
        if values.shape != (len(names),) or values.dtype.kind not in "fi":
            raise DamagedFile(f"'{key}' is not one number for each parameter")
    said = isinstance(sampling["verdict"], str) and isinstance(sampling["seed"], int)
    if not names or not said or not isinstance(sampling["converged"], bool):
        raise DamagedFile("it does not say what was sampled")
    posterior = groups["posterior"]
    for group in ("posterior", "prior"):
        for label in names:
            name, _, level = label.partition("[")
            found = groups[group][name]
            extra = {str(d): level.removesuffix("]") for d in found.dims if d not in ("chain", "draw")}
            if len(extra) != bool(level):
                raise DamagedFile(f"'{group}/{label:.80}' has other dimensions than its name says")
            _require_finite(found.sel(extra), f"{group}/{label}", ("chain", "draw"))
    if groups["sample_stats"]["lp"].shape != (posterior.sizes["chain"], posterior.sizes["draw"]):
        raise DamagedFile("'sample_stats/lp' has not one value for each draw")
    if "weighted_posterior" in groups:
        weighted = groups["weighted_posterior"]
        _require_finite(weighted["theta"], "weighted_posterior/theta", ("chain", "draw", "parameter"))
        if weighted["parameter"].values.tolist() != names or np.isnan(weighted["log_weight"].values).any():
            raise DamagedFile("the weighted draws are not those of its parameters")
    for name in provenance.get("experiments", {}):
        _require_consistent(*of_experiment(groups, provenance, name))
    for observable in provenance["observables"]:
        rows = groups["observed_data"][observable]
        _require_finite(rows, f"observed_data/{observable}", ("row",))
        for group in ("posterior_predictive", "prior_predictive", "log_likelihood"):
            found = groups[group][observable]
            fits = found.dims == ("chain", "draw", "row") and found.sizes["row"] == rows.size
            if not fits or found.dtype.kind != "f":
                raise DamagedFile(f"'{group}/{observable}' has not one number for each draw and row")


def _require_finite(values: xarray.DataArray, name: str, dimensions: tuple[str, ...]) -> None:
    if values.dims != dimensions or not values.size or values.dtype.kind != "f":
        raise DamagedFile(f"'{name}' is not numbers over {' and '.join(dimensions)}")
    if not np.isfinite(values.values).all():
        raise DamagedFile(f"'{name}' has values that are not finite")
