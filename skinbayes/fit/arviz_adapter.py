"""The one place that knows which ArviZ is installed: below 1 (InferenceData) or from 1 on (DataTree)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray

if TYPE_CHECKING:
    import xarray


def arviz() -> Any:
    """Import ArviZ (seconds; so only where it is needed) without its notice about the coming version."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FutureWarning)
        import arviz as az
    return az


def to_arviz(groups: Mapping[str, xarray.Dataset]) -> Any:
    """Return the groups as ``InferenceData`` (ArviZ below 1) or ``xarray.DataTree`` (from 1 on)."""
    az = arviz()
    if int(az.__version__.split(".")[0]) < 1:
        return az.InferenceData(**dict(groups))
    import xarray

    return xarray.DataTree.from_dict(dict(groups))


def effective_sizes_and_r_hat(samples: FloatArray) -> dict[str, FloatArray]:
    """``ess_bulk``, ``ess_tail`` and, of several chains, ``r_hat``, each ``(D,)``, from samples ``(chains, draws, D)``."""
    import xarray

    az = arviz()
    chains = xarray.Dataset({"x": (("chain", "draw", "part"), samples)})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # too few draws are said in words
        found = {
            "ess_bulk": az.ess(chains, method="bulk"),
            "ess_tail": az.ess(chains, method="tail"),
        }
        if len(samples) > 1:
            found["r_hat"] = az.rhat(chains)
    return {name: np.asarray(values["x"].values, dtype=float) for name, values in found.items()}
