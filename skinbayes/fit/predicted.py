"""What was observed, and what the draws of a fit predict for it, as arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.statistics.noise_families import noise_family

if TYPE_CHECKING:
    from skinbayes.fit.result import FitResult


def observables(fit: FitResult) -> tuple[str, ...]:
    """Names of what was observed."""
    return tuple(fit.provenance["observables"])


def observed_values(fit: FitResult) -> FloatArray:
    """The data, one observable after the other, shape ``(M,)``, SI."""
    observed = fit.groups["observed_data"]
    return np.concatenate([np.asarray(observed[name].values, dtype=float) for name in observables(fit)])


def row_names(fit: FitResult) -> list[str]:
    """Names of the rows of data."""
    return [str(row) for row in fit.groups["observed_data"]["row"].values]


def predictive_draws(fit: FitResult, group: str = "posterior_predictive") -> FloatArray:
    """All predictive draws, one observable after the other, shape ``(draws, M)``, SI."""
    parts = [fit.groups[group][name].values for name in observables(fit)]
    return np.concatenate(
        [np.asarray(values, dtype=float).reshape(-1, values.shape[-1]) for values in parts], axis=-1
    )


def is_logarithmic(fit: FitResult, observable: str) -> bool:
    """Whether residuals of an observable are those of its logarithm."""
    noise = fit.provenance.get("noise", {}).get(observable)
    return noise is not None and bool(noise_family(str(noise)).logarithmic)
