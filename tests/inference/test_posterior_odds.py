"""A long study: the model that the evidence prefers is right as often as its probability says."""

from __future__ import annotations

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.problem import Problem

SIMULATIONS = 100

ALPHA = 1e-3
"""Probability that one of the nine tests fails though all probabilities are right; that any does is at most nine times that."""


def skin(by_state: bool) -> Problem:
    """Friction of dry and wet skin under four loads, of one shear stress or of one for each state."""
    stress = {"lognormal": ["15 MPa", 0.4]}
    stress = {"by": "state", "dry": stress, "wet": stress} if by_state else stress
    return sb.build_problem(
        "friction",
        {
            "state": ["dry", "wet"] * 4,
            "normal_force [N]": np.repeat([0.1, 0.3, 0.9, 2.7], 2),
            "sphere_radius [mm]": np.full(8, 8.0),
            "friction_coefficient [1]": np.ones(8),
        },
        parameters={
            "frictional_shear_stress": stress,
            "young_modulus_layer": {"by": "state", "dry": "1 GPa", "wet": "7 MPa"},
            "yield_stress": {"by": "state", "dry": "50 MPa", "wet": "inf Pa"},
            "young_modulus_bulk": "20 kPa",
            "layer_thickness": "20 um",
        },
        noise={"family": "lognormal", "noise_scale": {"lognormal": [0.2, 0.5]}},
        surface="paper_reference",
    )


@pytest.mark.slow
def test_the_model_preferred_is_right_as_often_as_its_probability_says() -> None:
    found = sb.calibrate(skin(False), skin(True), simulations=SIMULATIONS, seed=17, ess=400)
    print(found, found.p_values(), found.bins())
    assert min(found.p_values().values()) > ALPHA
    assert min(p for *_, p in found.bins()) > ALPHA
    assert found.failed == 0
