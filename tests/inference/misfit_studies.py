"""Simulated sweeps that a theory misses by a smooth curve, and drying series whose noise has a memory: does σ_f stay covered?"""

from __future__ import annotations

from typing import Any

import numpy as np
from importance import importance_sample

import skinbayes as sb
from skinbayes.problem import Problem

SIMULATIONS = 100

ROWS, TIMES = 30, 60

MISFITS = ("power law", "bump", "step")


def sweep(friction: np.ndarray, **discrepancy: Any) -> Problem:
    """An elastomer under rising load; only σ_f and what scatters are unknown."""
    load = np.geomspace(0.01, 1.0, ROWS)
    return sb.build_problem(
        "friction",
        {
            "normal_force [N]": load,
            "nominal_contact_area [m^2]": np.full(ROWS, 16e-6),
            "friction_coefficient [1]": friction,
        },
        parameters={
            "frictional_shear_stress": {"lognormal": ["100 kPa", 1.0]},
            "young_modulus": "130 kPa",
            "rms_height": "5 um",
            "hurst_exponent": 0.8,
            "wavevector_min": "1.6e3 1/m",
            "wavevector_rolloff": "3e4 1/m",
            "wavevector_max": "1e7 1/m",
        },
        noise={"family": "lognormal", "noise_scale": {"half_normal": 0.2}},
        **discrepancy,
    )


def misfit(kind: str, rng: np.random.Generator) -> np.ndarray:
    """A smooth curve of ln μ that is no draw of a Gaussian process."""
    x = np.linspace(-1.0, 1.0, ROWS)
    height = rng.choice([-1.0, 1.0]) * rng.uniform(0.1, 0.4)
    if kind == "power law":
        return height * x
    centre = rng.uniform(-0.7, 0.7)
    if kind == "bump":
        return height * np.exp(-0.5 * ((x - centre) / rng.uniform(0.25, 0.5)) ** 2)
    return 0.5 * height * np.tanh((x - centre) / rng.uniform(0.2, 0.5))


def sweep_levels(simulations: int, seed: int) -> dict[str, np.ndarray]:
    """Posterior probability of less than the true σ_f, with the discrepancy and with independent noise alone."""
    rng = np.random.default_rng(seed)
    base = sweep(np.ones(ROWS))
    (place,) = (i for i, name in enumerate(base.names) if name == "frictional_shear_stress")
    found: dict[str, list[float]] = {"independent": [], "discrepancy": []}
    for i in range(simulations):
        truth = base.prior_medians()
        truth[place] *= np.exp(0.5 * rng.normal())
        curve = misfit(MISFITS[i % len(MISFITS)], rng)
        data = base.predict_data(truth) * np.exp(curve + 0.03 * rng.normal(size=ROWS))
        found["independent"].append(_level(sweep(data), truth[place], place, rng))
        with_curve = sweep(data, discrepancy={"along": "normal_force"})
        found["discrepancy"].append(_level(with_curve, truth[place], place, rng))
    return {name: np.array(values) for name, values in found.items()}


def series(friction: np.ndarray, correlation: dict[str, Any] | None = None) -> Problem:
    """Skin that dries under a ball; only σ_f and what scatters are unknown."""
    parameters = {
        "frictional_shear_stress": {"lognormal": ["15 MPa", 0.5]},
        "young_modulus_layer": "7 MPa",
        "yield_stress": "50 MPa",
        "young_modulus_layer_dry": "1 GPa",
        "young_modulus_bulk": "20 kPa",
        "layer_thickness": "20 um",
        "nominal_pressure": "6.83 kPa",
        "contact_angle_counterface": "20 deg",
        "contact_angle_skin": "80 deg",
        "surface_tension": "72 mN/m",
        "initial_film": "80 um",
        "evaporation_rate": "0.17 um/s",
        "wetting_time": "0 s",
    }
    noise: dict[str, Any] = {"family": "lognormal", "noise_scale": {"half_normal": 0.2}}
    if correlation is not None:
        noise["correlation"] = correlation
    return sb.build_problem(
        "drying",
        {"time [s]": np.linspace(5.0, 600.0, TIMES), "friction_coefficient [1]": friction},
        parameters=parameters,
        noise=noise,
        surface="paper_reference",
    )


def series_levels(simulations: int, seed: int) -> dict[str, np.ndarray]:
    """The same for drying series with AR(1) noise of 0.8 and a drift, with that noise in the model and with independent noise."""
    rng = np.random.default_rng(seed)
    base = series(np.ones(TIMES))
    (place,) = (i for i, name in enumerate(base.names) if name == "frictional_shear_stress")
    found: dict[str, list[float]] = {"independent": [], "correlated": []}
    for _ in range(simulations):
        truth = base.prior_medians()
        truth[place] *= np.exp(0.3 * rng.normal())
        noise = np.empty(TIMES)
        noise[0] = rng.normal()
        for i in range(1, TIMES):
            noise[i] = 0.8 * noise[i - 1] + 0.6 * rng.normal()
        drift = 0.1 * rng.normal() * np.linspace(0.0, 1.0, TIMES)
        data = base.predict_data(truth) * np.exp(0.05 * noise + drift)
        found["independent"].append(_level(series(data), truth[place], place, rng))
        model = series(data, {"along": "time", "drift": 0.1})
        found["correlated"].append(_level(model, truth[place], place, rng))
    return {name: np.array(values) for name, values in found.items()}


def _level(problem: Problem, truth: float, place: int, rng: np.random.Generator) -> float:
    found = importance_sample(problem, rng)
    return float(found.levels(problem.target().transform.forward(_at(problem, place, truth))[0])[place])


def _at(problem: Problem, place: int, value: float) -> np.ndarray:
    vector = problem.prior_medians()
    vector[place] = value
    return vector[np.newaxis]
