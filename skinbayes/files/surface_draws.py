"""Draws of the roughness of a surface: the posterior of an earlier fit, or a table of the user's own."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import load_dataset
from skinbayes.files.reading import open_file
from skinbayes.files.table import LARGEST_TABLE
from skinbayes.roughness.spectrum import SELF_AFFINE_PARAMETERS
from skinbayes.sealed import DamagedFile, checked
from skinbayes.vocabulary import QUANTITIES

ROUGHNESS = SELF_AFFINE_PARAMETERS
"""The parameters of a surface that are drawn."""

RESULT = "result.nc"
"""Of a run directory."""

MOST_DRAWS = 4000
"""Draws that are taken, evenly spaced: quantiles and correlations need no more."""

FEWEST_DRAWS = 100


@dataclass(frozen=True, eq=False)
class SurfaceDraws:
    """What is known of a self-affine surface, as draws.

    Attributes
    ----------
    draws : each of the five roughness parameters that vary to its values, shape ``(n,)``, SI
    fixed : the others to their value, SI
    source : where the draws come from, for people
    file : run directory, result file or CSV; None if there is none
    """

    draws: Mapping[str, FloatArray]
    fixed: Mapping[str, float]
    source: str
    file: Path | None = None

    def text(self) -> str:
        """The draws as the CSV that `read_surface_draws` reads, every number with all its digits."""
        count = len(next(iter(self.draws.values())))
        columns = [
            self.draws.get(name, np.full(count, self.fixed.get(name, np.nan))).tolist() for name in ROUGHNESS
        ]
        header = ",".join(f"{name} [{QUANTITIES[name].unit}]" for name in ROUGHNESS)
        rows = (",".join(map(repr, row)) for row in zip(*columns, strict=True))
        return "\n".join((header, *rows, ""))


def surface_draws(
    values: Mapping[str, FloatArray], fixed: Mapping[str, float], where: str, file: Path | None = None
) -> SurfaceDraws:
    """Draws of a surface, thinned; ``where`` says whose they are.

    Raises
    ------
    InputError
        One of the five roughness parameters is missing, nothing varies, or there are too few draws.
    """
    if missing := [name for name in ROUGHNESS if name not in values and name not in fixed]:
        raise InputError(
            f"{where}: it says nothing about {', '.join(missing)}; expected all of {', '.join(ROUGHNESS)}"
        )
    varying = {
        name: np.ravel(values[name]) for name in ROUGHNESS if name in values and np.ptp(values[name]) > 0
    }
    constant = {
        name: float(fixed[name] if name in fixed else np.ravel(values[name])[0])
        for name in ROUGHNESS
        if name not in varying
    }
    if not varying:
        raise InputError(f"{where}: all draws are the same; give the five numbers in [parameters] instead")
    count = len(next(iter(varying.values())))
    if count < FEWEST_DRAWS:
        raise InputError(f"{where}: {count} draws; expected at least {FEWEST_DRAWS}")
    step = -(-count // MOST_DRAWS)
    kept = {name: np.ascontiguousarray(column[::step], dtype=float) for name, column in varying.items()}
    return SurfaceDraws(kept, constant, Path(where).name, file)


def holds_draws(path: Path) -> bool:
    """Whether a path is that of draws of a surface, and not of a spectrum."""
    if path.is_dir() or path.suffix == ".nc":
        return True
    try:
        with open_file(path, LARGEST_TABLE, "a CSV file") as file:
            return b"rms_height [" in file.read(4096)
    except InputError:
        return False  # who reads it as a spectrum says what is wrong


def read_surface_draws(path: str | Path) -> SurfaceDraws:
    """Draws of the roughness of a surface from an earlier fit or a CSV.

    Parameters
    ----------
    path : directory of a run, its ``result.nc``, or a CSV with a column for each of the five roughness parameters

    Raises
    ------
    InputError
        There is no such run, it did not converge, it is damaged, or it is not one of a self-affine surface.
    """
    path = Path(path)
    if not path.exists():
        raise InputError(f"{path}: no such file or folder; expected a run of a surface, or a CSV of draws")
    if path.suffix != ".nc" and not path.is_dir():
        columns = load_dataset(path).columns
        numbers = {name: np.asarray(columns[name], dtype=float) for name in ROUGHNESS if name in columns}
        return surface_draws(numbers, {}, str(path), path)
    file = path / RESULT if path.is_dir() else path
    try:
        checked(file)
        values, provenance = _posterior(file)
    except (DamagedFile, OSError, KeyError, ValueError) as error:
        raise InputError(f"{path}: no usable result of a fit ({error}); expected a finished run") from None
    if not provenance.get("sampling", {}).get("converged"):
        raise InputError(
            f"{path}: this fit did not converge, so that its draws are not the posterior; resume it first"
        )
    if "power_spectral_density" not in (observed := provenance.get("observables", ())):
        raise InputError(
            f"{path}: a fit of {', '.join(observed) or 'other data'}, which would count twice if they are those of this model; "
            "expected a fit of a power spectrum (power_spectral_density), or a CSV of draws"
        )
    if provenance.get("options", {}).get("shape") == "free-form":
        raise InputError(
            f"{path}: a fit of a free form, which five roughness parameters do not give; expected one of the self-affine shape"
        )
    fixed = {
        name: float(entry["value"])
        for name, entry in provenance.get("fixed", {}).items()
        if name in ROUGHNESS
    }
    return surface_draws(values, fixed, str(path), path)


def _posterior(file: Path) -> tuple[dict[str, FloatArray], dict[str, Any]]:
    """Roughness parameters among the draws of a result, and where it comes from."""
    import h5py

    with h5py.File(file, "r", locking=False) as content:
        group = content["posterior"]
        values = {name: np.asarray(group[name], dtype=float) for name in ROUGHNESS if name in group}
        provenance = json.loads(group.attrs["skinbayes"])
    for name, draws in values.items():
        if draws.ndim != 2:
            raise ValueError(f"{name} differs between levels of a column")
    return values, provenance
