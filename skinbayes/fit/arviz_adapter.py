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


def standard_error(pointwise: FloatArray) -> float:
    """Standard error of a sum over N data: √(N · variance); NaN for a single datum. ArviZ's own differs by version."""
    count = len(pointwise)
    return float(np.sqrt(count * pointwise.var(ddof=1))) if count > 1 else float("nan")


def loo(groups: Mapping[str, xarray.Dataset]) -> dict[str, Any]:
    """Pareto-smoothed importance-sampling leave-one-out cross-validation, over the data of all observables.

    Vehtari, Gelman and Gabry 2017, doi 10.1007/s11222-016-9696-4.

    Returns
    -------
    dict
        ``elpd`` (expected log predictive density), ``se``, ``p`` (effective number of parameters), ``pointwise`` ``(N,)``,
        ``pareto_k`` ``(N,)``, and ``good_k``: above it an estimate is not reliable.
    """
    densities = [variable.values for variable in groups["log_likelihood"].data_vars.values()]
    joined = np.concatenate([values.reshape(*values.shape[:2], -1) for values in densities], axis=-1)
    return _left_out(_same_draws(groups, "log_likelihood"), joined)


def leave_level_out(groups: Mapping[str, xarray.Dataset], column: str) -> dict[str, Any]:
    """The same for all data of one level of a grouping column at a time, from ``log_likelihood_left_out``.

    With the density of the data of a level given all others and the parameters, the importance of a draw for the posterior
    without that level is one over it, as it is for a single datum.

    Returns
    -------
    dict
        As :func:`loo`, one entry for each level, and ``levels``
    """
    variable = groups["log_likelihood_left_out"][column]
    found = _left_out(_same_draws(groups, "log_likelihood_left_out"), variable.values)
    return found | {"levels": tuple(str(level) for level in variable[f"{column}_level"].values)}


def _same_draws(groups: Mapping[str, xarray.Dataset], name: str) -> xarray.Dataset:
    """The posterior at the draws of a group, which are not all where there are many rows of data."""
    return groups["posterior"].sel(draw=groups[name]["draw"])


def _left_out(posterior: xarray.Dataset, log_density: FloatArray) -> dict[str, Any]:
    """Leave-one-out of whatever the densities ``(chain, draw, N)`` are of."""
    import xarray

    az = arviz()
    needed = {
        "posterior": posterior,
        "log_likelihood": xarray.Dataset({"left_out": (("chain", "draw", "part"), log_density)}),
    }
    with warnings.catch_warnings():
        # bad Pareto k are reported in words, part by part
        warnings.simplefilter("ignore")
        result = az.loo(to_arviz(needed), pointwise=True)
    elpd = result.elpd_loo if hasattr(result, "elpd_loo") else result.elpd
    p = result.p_loo if hasattr(result, "p_loo") else result.p
    pointwise = (result.loo_i if hasattr(result, "loo_i") else result.elpd_i).values.reshape(-1)
    return {
        "elpd": float(elpd),
        "se": standard_error(pointwise),
        "p": float(p),
        "pointwise": pointwise,
        "pareto_k": result.pareto_k.values.reshape(-1),
        "good_k": float(getattr(result, "good_k", 0.7)),
    }
