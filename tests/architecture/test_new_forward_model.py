"""A forward model is one file: dropped into the package it is found, bound, checked and sampled."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import skinbayes as sb
from skinbayes import forward

MODULE = '''
"""Forward model ``gliding``: friction force in proportion to the load, Amontons."""

from skinbayes.forward.base import ForwardModel


def _evaluate(inputs, table):
    return {"friction_coefficient": inputs["frictional_shear_stress"] / inputs["yield_stress"] + 0.0 * inputs["normal_force"]}


MODEL = ForwardModel(
    name="gliding",
    summary="a ratio of two stresses",
    observables=("friction_coefficient",),
    required=("frictional_shear_stress", "yield_stress", "normal_force"),
    optional={},
    evaluate=_evaluate,
    derived=lambda inputs, table: {},
    uses_surface=False,
)
'''

TOML = """
format = 1
title = "Gliding"
forward = "gliding"

[data]
file = "mine.csv"
observable = "friction_coefficient"

[parameters]
frictional_shear_stress = { lognormal = ["10 MPa", 1.0], source = "for the test" }
yield_stress = { fixed = "20 MPa", source = "for the test" }

[noise]
family = "lognormal"
noise_scale = { fixed = 0.1, source = "for the test" }
"""


@pytest.fixture
def dropped_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "gliding.py").write_text(MODULE, encoding="utf-8")
    (tmp_path / "gliding.toml").write_text(TOML, encoding="utf-8")
    (tmp_path / "mine.csv").write_text(
        "normal_force [mN],friction_coefficient [1]\n200,0.4\n300,0.6\n", encoding="utf-8"
    )
    monkeypatch.setattr(forward, "__path__", [*forward.__path__, str(tmp_path)])
    yield tmp_path
    sys.modules.pop("skinbayes.forward.gliding", None)
    forward.__dict__.pop("gliding", None)


def test_a_file_in_the_package_is_a_forward_model(dropped_in: Path) -> None:
    assert forward.forward_model("gliding").summary == "a ratio of two stresses"
    problem = sb.load_problem(dropped_in / "gliding.toml")
    assert problem.names == ("frictional_shear_stress",)
    assert problem.predict(np.array([10e6]))["friction_coefficient"].tolist() == [0.5, 0.5]


def test_its_posterior_is_the_one_known_in_closed_form(dropped_in: Path) -> None:
    problem = sb.load_problem(dropped_in / "gliding.toml")
    # ln(10 MPa) +- 1 meets two data ln(0.4), ln(0.6) +- 0.1: conjugate normal in ln of the stress
    precision = 1.0 + 2 / 0.1**2
    mean = (np.log(10e6) + (np.log(0.4 * 20e6) + np.log(0.6 * 20e6)) / 0.1**2) / precision
    u = np.linspace(mean - 0.5, mean + 0.5, 4001)
    density = problem.log_posterior(np.exp(u)[:, np.newaxis]) + u  # Jacobian of exp
    weight = np.exp(density - density.max())
    weight /= weight.sum()
    assert np.sum(weight * u) == pytest.approx(mean, rel=1e-9)
    assert np.sum(weight * (u - mean) ** 2) == pytest.approx(1 / precision, rel=1e-6)


def test_without_the_file_there_is_no_such_model() -> None:
    with pytest.raises(sb.InputError, match="no forward model 'gliding'"):
        forward.forward_model("gliding")
