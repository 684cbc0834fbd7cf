"""Fits put together by hand, to draw what a sampler would take long to find."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray

from skinbayes.fit import Fit
from skinbayes.vocabulary import QUANTITIES

NAMES = (
    "frictional_shear_stress", "young_modulus_layer", "yield_stress", "layer_thickness", "rms_height", "hurst_exponent",
    "poisson_ratio_layer", "noise_scale", "wavevector_min", "wavevector_rolloff", "wavevector_max", "surface_tension",
    "viscosity", "velocity_shift_factor", "film_thickness",
)  # fmt: skip

MEDIANS = (15e6, 7e6, 50e6, 20e-6, 22e-6, 0.8, 0.4, 0.1, 1e3, 6e3, 1e9, 0.07, 1e-3, 20.0, 1e-6)


def made_up_fit(
    parameters: int = 3,
    rows: int = 4,
    constant: tuple[str, ...] = (),
    converged: bool = True,
    row_names: list[str] | None = None,
    not_updated: tuple[str, ...] = (),
) -> Fit:
    """A fit with ``parameters`` lognormal parameters and ``rows`` data about 0.5; it has no problem."""
    rng = np.random.default_rng(5)
    chains, length, prior_length = 4, 300, 2000
    posterior: dict[str, Any] = {}
    prior: dict[str, Any] = {}
    for name, median in zip(NAMES[:parameters], MEDIANS, strict=False):
        attributes = {"units": QUANTITIES[name].unit, "symbol": QUANTITIES[name].symbol, "kind": "parameter"}
        width = 0.0 if name in constant else 0.5 if name in not_updated else 0.1
        draws = median * np.exp(width * rng.normal(size=(chains, length)))
        posterior[name] = xarray.DataArray(draws, dims=("chain", "draw"), attrs=attributes)
        before = median * np.exp(0.5 * rng.normal(size=(1, prior_length)))
        prior[name] = xarray.DataArray(before, dims=("chain", "draw"), attrs=attributes)
    names = row_names or [str(i + 1) for i in range(rows)]
    predicted = np.exp(0.1 * rng.normal(size=(chains, length, rows)) + np.linspace(-1.0, 0.0, rows))
    expected = np.exp(rng.normal(size=(1, prior_length, rows)) - 0.5)
    observed = np.exp(0.1 * rng.normal(size=rows) + np.linspace(-1.0, 0.0, rows))
    coordinates = {"row": names}
    observable = "friction_coefficient"
    groups = {
        "posterior": xarray.Dataset(posterior),
        "prior": xarray.Dataset(prior),
        "posterior_predictive": xarray.Dataset(
            {observable: (("chain", "draw", "row"), predicted)}, coordinates
        ),
        "prior_predictive": xarray.Dataset({observable: (("chain", "draw", "row"), expected)}, coordinates),
        "observed_data": xarray.Dataset({observable: (("row",), observed)}, coordinates),
    }
    sampling = {
        "converged": converged,
        "ess_bulk": [1200.0] * parameters,
        "ess_tail": [1100.0] * parameters,
        "r_hat": [1.001] * parameters,
    }
    provenance = {
        "model": "made-up",
        "names": list(NAMES[:parameters]),
        "observables": [observable],
        "sampling": sampling,
    }
    return Fit(groups, provenance)
