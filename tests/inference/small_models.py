"""Small models built on the shipped physics, written as a user would write them."""

from __future__ import annotations

from pathlib import Path

from numpy.testing import assert_array_equal

from skinbayes.fit import Fit
from skinbayes.problem import Problem, load_problem

SKIN = """
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
"""

FINGER = """
title = "Fingers"
forward = "friction"
[data]
dataset = "fehlberg2025-finger-stribeck"
observable = "friction_coefficient"
rows = {{ liquid = ["water"] }}
[surface]
name = "paper_reference"
[parameters]
young_modulus_bulk = "20 kPa"
layer_thickness = "173 um"
{parameters}
[noise]
{noise}
"""


def write_model(folder: Path, text: str, name: str = "mine.toml") -> Path:
    """Write a model file and return its path."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def finger(folder: Path, parameters: str, noise: str, name: str = "mine.toml") -> Problem:
    """Friction of eleven wet fingers with the given ``[parameters]`` and ``[noise]``."""
    return load_problem(write_model(folder, FINGER.format(parameters=parameters, noise=noise), name))


def two_parameters(folder: Path) -> Problem:
    """Shear stress and scatter free, all else fixed."""
    return finger(
        folder,
        'frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }\nyoung_modulus_layer = "7 MPa"',
        'family = "lognormal"\nnoise_scale = { half_normal = 0.5 }',
        "two.toml",
    )


def three_parameters(folder: Path) -> Problem:
    """Shear stress, modulus of the layer and scatter free."""
    return finger(
        folder,
        'frictional_shear_stress = { loguniform = ["0.5 MPa", "500 MPa"] }\n'
        'young_modulus_layer = { lognormal = ["7 MPa", 0.5] }',
        'family = "lognormal"\nnoise_scale = { half_normal = 0.5 }',
        "three.toml",
    )


def student(folder: Path) -> Problem:
    """As three parameters, with Student's t of an absolute scale.

    The prior of the shear stress is narrower: with three decades, "no friction at all and a wide scatter" is a mode of its
    own that keeps about 0.5 % of the posterior.
    """
    return finger(
        folder,
        'frictional_shear_stress = { lognormal = ["10 MPa", 0.7] }\n'
        'young_modulus_layer = { lognormal = ["7 MPa", 0.3] }',
        'family = "student_t"\nnoise_scale = { half_normal = 0.5 }\ndegrees_of_freedom = 3',
        "student.toml",
    )


def same_draws(first: Fit, second: Fit) -> None:
    assert set(first.groups) == set(second.groups)
    for name, group in first.groups.items():
        for variable in group.data_vars:
            assert_array_equal(
                group[variable].values, second.groups[name][variable].values, err_msg=f"{name}.{variable}"
            )
