"""The one place that knows which ArviZ is installed: below 1 (InferenceData) or from 1 on (DataTree)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray

if TYPE_CHECKING:
    import xarray

POWER = 0.01
"""By how much the power of prior or likelihood differs from 1."""


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


def power_scaling(
    draws: FloatArray, log_prior: FloatArray, log_likelihood: FloatArray
) -> dict[str, FloatArray]:
    """How much the distribution of each parameter changes as prior or likelihood are raised to a power near 1.

    Kallioinen, Paananen, Bürkner & Vehtari 2024, doi 10.1007/s11222-023-10366-5: the cumulative Jensen–Shannon distance for each
    doubling of the power.

    Parameters
    ----------
    draws : of D parameters, shape ``(N, D)``
    log_prior, log_likelihood : at each draw, shape ``(N,)``

    Returns
    -------
    dict
        ``prior`` and ``likelihood``, each ``(D,)``
    """
    import xarray

    az = arviz()
    groups = {
        "posterior": xarray.Dataset({"x": (("chain", "draw", "part"), draws[np.newaxis])}),
        "log_prior": xarray.Dataset({"x": (("chain", "draw"), log_prior[np.newaxis])}),
        "log_likelihood": xarray.Dataset({"x": (("chain", "draw"), log_likelihood[np.newaxis])}),
    }
    data, found = to_arviz(groups), {}
    for name in ("prior", "likelihood"):
        if np.ptp(groups[f"log_{name}"]["x"].values) < 1e-9:  # a flat component changes nothing
            found[name] = np.zeros(draws.shape[1])
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if hasattr(az, "psens"):
                values = az.psens(data, component=name, delta=POWER)
            else:
                values = az.psense(data, group=name, alphas=(1 / (1 + POWER), 1 + POWER))
        found[name] = np.asarray(values["x"].values, dtype=float)
    return found


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
