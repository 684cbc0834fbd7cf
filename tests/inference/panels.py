"""Panels of people: friction of a constant level, and Stribeck curves, whose parameters are drawn from populations."""

from __future__ import annotations

from typing import Any

import numpy as np

from skinbayes.problem import Problem, build_problem
from skinbayes.problem.target import PosteriorTarget
from skinbayes.sampling.advance import advance
from skinbayes.sampling.hierarchical_moves import HierarchicalMoves
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.starts import initial_states

LEVEL = "typical_friction_coefficient"
SCALE, CONTRAST = f"population_scale[{LEVEL}]", f"contrast[{LEVEL}, after]"
CONTRAST_SCALE = f"contrast_scale[{LEVEL}, after]"

NOISE = 0.1


def constant_problem(
    people: np.ndarray, values: np.ndarray, population: dict[str, Any], noise: Any = NOISE, **columns: Any
) -> Problem:
    """ln of friction scatters about a level of each person."""
    return build_problem(
        "constant",
        {"person": people, **columns, "friction_coefficient": values},
        parameters={LEVEL: {"by": "person", "population": population}},
        noise={"family": "lognormal", "noise_scale": noise},
        name="panel",
    )


POPULATION = {"lognormal": [0.5, 1.0], "scale": {"half_normal": 0.5}}


def treated(
    rng: np.random.Generator, people: int = 8, repeats: int = 2, effect: float | None = None
) -> tuple[Problem, np.ndarray]:
    """A panel before and after a treatment, its truth drawn from the priors, and the truth in the order of the first names.

    ``effect`` of the treatment on ln of the level replaces that of the prior.
    """
    median, scale = 0.5 * np.exp(0.5 * rng.normal()), 0.4 * abs(rng.normal())
    contrast, spread = 0.3 * rng.normal(), 0.1 * abs(rng.normal())
    contrast = contrast if effect is None else effect
    who = np.repeat(np.arange(people), 2 * repeats)
    after = np.tile(np.repeat([False, True], repeats), people)
    level = np.log(median) + scale * rng.normal(size=people)[who]
    level += np.where(after, contrast + spread * rng.normal(size=people)[who], 0.0)
    problem = constant_problem(
        np.array([f"P{i}" for i in who]),
        np.exp(level + NOISE * rng.normal(size=len(who))),
        {
            "lognormal": [0.5, 0.5],
            "scale": {"half_normal": 0.4},
            "contrast": {
                "column": "treatment",
                "reference": "before",
                "effect": {"normal": [0, 0.3]},
                "scale": {"half_normal": 0.1},
            },
        },
        treatment=np.where(after, "after", "before"),
    )
    return problem, np.array([median, scale, contrast, spread])


def one_ensemble(target: PosteriorTarget, seed: int, steps: int, walkers: int = 64) -> np.ndarray:
    """Parameters of one ensemble after a quarter of its steps, in SI, shape ``(draws, D)``: later steps last."""
    state = initial_states(target, SamplerOptions(seed=seed, ensembles=2, walkers=walkers))[0]
    positions = advance(target, state, steps, HierarchicalMoves(target)).positions[steps // 4 :]
    return target.transform.inverse(positions.reshape(-1, positions.shape[-1]))


CURVE = {
    "plateau_friction_coefficient": (0.7, 0.5),
    "transition_speed_viscosity_product": (5e-3, 1.0),
    "transition_exponent": (1.0, 0.4),
    "rising_friction_coefficient": (0.05, 0.8),
}
"""Median and standard deviation of ln of the priors of the medians of the four populations."""


def curves(
    seed: int, people: int = 11, rows: int = 15
) -> tuple[Problem, dict[str, float], dict[str, np.ndarray]]:
    """Stribeck curves of people who differ in four parameters; the medians of the populations, and the values of the people."""
    rng = np.random.default_rng(seed)
    medians = {name: middle for name, (middle, _) in CURVE.items()}
    values = {name: middle * np.exp(0.3 * rng.normal(size=people)) for name, middle in medians.items()}
    who, x = np.repeat(np.arange(people), rows), np.tile(np.geomspace(1e-4, 1e-1, rows), people)
    ratio = (x / values["transition_speed_viscosity_product"][who]) ** values["transition_exponent"][who]
    rising = (
        values["rising_friction_coefficient"][who]
        * (x / values["transition_speed_viscosity_product"][who]) ** 0.5
    )
    friction = (values["plateau_friction_coefficient"][who] + ratio * rising) / (1.0 + ratio)
    problem = build_problem(
        "stribeck-descriptive",
        {
            "person": np.array([f"P{i:02d}" for i in who]),
            "speed_viscosity_product [N/m]": x,
            "normal_force [N]": np.ones(len(who)),
            "friction_coefficient": friction * np.exp(NOISE * rng.normal(size=len(who))),
        },
        parameters={
            **{
                name: {"by": "person", "population": {"lognormal": prior, "scale": {"half_normal": 0.5}}}
                for name, prior in CURVE.items()
            },
            "rising_exponent": 0.5,
        },
        noise={"family": "lognormal", "noise_scale": {"half_normal": 0.3}},
        name="curves",
    )
    return problem, medians, values
