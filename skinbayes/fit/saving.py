"""Results on disk: one netCDF file in the ArviZ schema."""

from __future__ import annotations

from pathlib import Path

from skinbayes.atomic import write_atomically
from skinbayes.fit.netcdf import result_image
from skinbayes.fit.result import FitResult


def save_fit(fit: FitResult, path: Path) -> Path:
    """Write a fit as netCDF; the file appears whole or not at all, and shows any damage when it is read."""
    write_atomically(path, result_image(fit.groups, fit.provenance))
    return path
