"""A lubricated ball on skin that relaxes as a statistical model, from a table and from the solver; indentation beside it."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from small_models import write_model

from skinbayes.errors import InputError
from skinbayes.forward import Tables, forward_model
from skinbayes.problem import Problem, load_problem

MODEL = """
format = 1
title = "A ball in two liquids on skin that relaxes"
forward = "stribeck"

[options]
contact = "{contact}"
substrate = "{substrate}"

[data]
file = "rows.csv"
observable = "friction_coefficient"

[rheology]
file = "flow.csv"
by = "liquid"

[surface]
name = "paper_reference"

[parameters]
frictional_shear_stress = {{ lognormal = ["15 MPa", 0.5] }}
young_modulus_layer = "7 MPa"
young_modulus_bulk = {{ lognormal = ["30 kPa", 0.1] }}
layer_thickness = "20 um"
sphere_radius = "8 mm"
normal_force = "0.2 N"
{parameters}

[noise]
family = "lognormal"
noise_scale = {{ half_normal = 0.3 }}
"""

ROWS = """liquid,sliding_speed [mm/s],viscosity [Pa s],friction_coefficient [1]
thin,10,0.05,1.2
thin,50,0.05,0.5
thick,10,2,0.2
thick,50,1.5,0.3
"""

FLOW = """liquid,shear_rate [1/s],viscosity [Pa s]
thick,1,2
thick,100,1.5
thick,10000,0.4
thin,1,0.05
thin,100,0.05
"""

MATERIALS = {
    "constant_loss": 'loss_tangent_bulk = { uniform = [0.0, 0.3] }\nloss_tangent_layer = "0.1"',
    "standard_linear_solid": (
        'relaxation_strength_bulk = { uniform = [0.0, 0.6] }\nrelaxation_time_bulk = "0.2 s"\nrelaxation_strength_layer = "0.2"'
    ),
}


def small(
    folder: Path, substrate: str, *, contact: str = "line", flow: bool = False, more: str = ""
) -> Problem:
    (folder / "rows.csv").write_text(ROWS, encoding="utf-8")
    (folder / "flow.csv").write_text(FLOW, encoding="utf-8")
    text = MODEL.format(contact=contact, substrate=substrate, parameters=MATERIALS[substrate] + "\n" + more)
    if not flow:
        text = text.replace('[rheology]\nfile = "flow.csv"\nby = "liquid"\n', "")
    return load_problem(write_model(folder, text))


@pytest.mark.parametrize(
    ("substrate", "flow"),
    [("constant_loss", True), pytest.param("standard_linear_solid", False, marks=pytest.mark.slow)],
)
def test_table_and_solver_give_the_same_friction(tmp_path: Path, substrate: str, flow: bool) -> None:
    """Over the prior, with and without flow curves: within 1 %."""
    problem = small(tmp_path, substrate, flow=flow)
    assert "memory of the tissue" in problem.model.accuracy
    theta = problem.draw_prior(np.random.default_rng(1), 3)
    inputs = problem.inputs(theta)
    few = problem.inputs(theta[:1])  # the solver takes its time
    direct = problem.forward.evaluate(few, problem.tables)
    found = problem.model.evaluate(inputs, problem.tables)
    assert set(found) == set(problem.forward.observables) == set(direct)
    for name in ("friction_coefficient", "friction_coefficient_hysteresis", "central_film_thickness"):
        assert_allclose(found[name][:1], direct[name], rtol=0.01, err_msg=name)
    parts = [
        found[f"friction_coefficient_{part}"]
        for part in ("boundary", "couette", "pressure_flow", "hysteresis")
    ]
    assert_allclose(sum(parts), found["friction_coefficient"], rtol=1e-12)
    assert_allclose(
        problem.model.abscissa(few, problem.tables), problem.forward.abscissa(few, problem.tables), rtol=0.01
    )
    one = problem.model.evaluate(problem.inputs(theta[1:2]), problem.tables)
    assert_array_equal(one["friction_coefficient"][0], found["friction_coefficient"][1])
    flags, wanted = problem.model.flags(few, problem.tables), problem.forward.flags(few, problem.tables)
    for name, flag in wanted.items():
        assert_array_equal(flags[name], flag, err_msg=name)
    again = pickle.loads(pickle.dumps(problem.model))
    assert_array_equal(
        again.evaluate(inputs, problem.tables)["friction_coefficient"], found["friction_coefficient"]
    )
    curve = problem.profiles[0]
    products, friction = problem.profile(curve, theta, row=2)
    held = {name: np.broadcast_to(value, (3, 4))[:, 2:3] for name, value in inputs.items()}
    held["viscosity"] = np.array([[products[30]]]) / held["sliding_speed"]
    at_speed = problem.forward.evaluate(held, Tables())["friction_coefficient"]
    assert_allclose(friction[:, 30:31], at_speed, rtol=0.01)


@pytest.mark.parametrize("contact", ["line", "point"])
@pytest.mark.parametrize("substrate", list(MATERIALS))
def test_without_loss_it_is_the_elastic_forward_model(substrate: str, contact: str) -> None:
    """To 1e-6; the cylinders of a ball are then the same, and their ratio is 1."""
    inputs = {
        "frictional_shear_stress": 15e6, "sphere_radius": 8e-3, "normal_force": 0.2, "young_modulus_layer": 7e6,
        "young_modulus_bulk": 30e3, "layer_thickness": 20e-6, "sliding_speed": 0.01, "viscosity": 2.0,
    }  # fmt: skip
    surface = {"rms_height": 22.4e-6, "hurst_exponent": 0.86, "wavevector_min": 3e3, "wavevector_rolloff": 6e3,
               "wavevector_max": 1e7}  # fmt: skip
    loss = {"loss_tangent_bulk": 0.0} if substrate == "constant_loss" else {
        "relaxation_strength_bulk": 0.0, "relaxation_time_bulk": 1.0
    }  # fmt: skip
    found = []
    for options, more in (({}, {}), ({"substrate": substrate}, loss)):
        model = forward_model("stribeck").with_options({"contact": contact, **options})
        given = {**model.defaults({*inputs, *more}), **inputs, **surface, **more}
        arrays = {name: np.array([[value]]) for name, value in given.items()}
        found.append(model.evaluate(arrays, Tables()))
    for name, value in found[0].items():
        assert_allclose(found[1][name], value, rtol=1e-6, err_msg=name)
    assert_allclose(found[1]["friction_coefficient_hysteresis"], 0.0, atol=1e-15)


def test_what_a_table_does_not_hold_is_solved_row_by_row(tmp_path: Path) -> None:
    problem = small(tmp_path, "constant_loss", more="poisson_ratio_bulk = { uniform = [0.4, 0.5] }")
    assert (
        "Each row is solved by itself" in problem.model.accuracy
        and "poisson_ratio_bulk" in problem.model.accuracy
    )


def test_speed_and_viscosity_are_needed_apart(tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_text(
        "speed_viscosity_product [N/m],friction_coefficient [1]\n1e-3,0.5\n", encoding="utf-8"
    )
    text = MODEL.format(contact="line", substrate="constant_loss", parameters=MATERIALS["constant_loss"])
    text = text.replace('[rheology]\nfile = "flow.csv"\nby = "liquid"\n', "")
    with pytest.raises(InputError, match=r"needs viscosity .*speed and viscosity act apart"):
        load_problem(write_model(tmp_path, text))


def test_what_elastic_skin_does_not_take_is_refused(tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_text(ROWS, encoding="utf-8")
    text = MODEL.format(contact="line", substrate="elastic", parameters=MATERIALS["constant_loss"])
    text = text.replace('[rheology]\nfile = "flow.csv"\nby = "liquid"\n', "")
    with pytest.raises(InputError, match="loss_tangent_bulk"):
        load_problem(write_model(tmp_path, text))
    with pytest.raises(InputError, match="substrate"):
        load_problem(write_model(tmp_path, text.replace('"elastic"', '"prony"')))


def test_loss_beside_a_friction_that_adds_is_three_lines(tmp_path: Path) -> None:
    """The lines of docs/elastic-or-viscoelastic.md, put into the shipped model."""
    root = Path(__file__).resolve().parents[2]
    page = (root / "docs" / "elastic-or-viscoelastic.md").read_text(encoding="utf-8")
    options, parameters = page.split("```toml\n")[1].split("```")[0].split("\n\n")
    text = (root / "models" / "finger-stribeck-additive.toml").read_text(encoding="utf-8")
    for old, new in (('options = { contact = "line" }', options), ("[parameters]\n", parameters)):
        assert old in text
        text = text.replace(old, new)
    problem = load_problem(write_model(tmp_path, text))
    elastic = load_problem("finger-stribeck-additive")
    assert set(problem.names) == {*elastic.names, "loss_tangent_bulk"}
    inputs = {name: value[:, :1] for name, value in problem.inputs(problem.prior_medians()[None]).items()}
    without = {**inputs, "additive_friction": np.zeros((1, 1))}
    thin = Tables(problem.tables.spectrum)
    found, less = (
        problem.forward.evaluate({**one, "viscosity": np.array([[1.0]])}, thin)["friction_coefficient"]
        for one in (inputs, without)
    )
    assert_allclose(found - less, inputs["additive_friction"], rtol=1e-9)


def test_shipped_ball_predicts() -> None:
    """`stribeck-ball-viscoelastic` at its middle: loss adds to friction what the direct curve of its cylinder adds."""
    problem = load_problem("stribeck-ball-viscoelastic")
    found = problem.predict(problem.prior_medians())
    assert (found["friction_coefficient"] > found["friction_coefficient_hysteresis"]).all()
    assert 0.05 < found["friction_coefficient_hysteresis"][0] < 0.1


def test_shipped_indentation_loses_what_a_cycle_loses() -> None:
    from skinbayes.contact import ConstantLossMaterial, indentation_cycle

    problem = load_problem("indentation-ball")
    theta = problem.prior_medians()
    values = dict(zip(problem.names, theta, strict=True))
    found = problem.predict(theta)
    tissue = ConstantLossMaterial(
        modulus=values["young_modulus_bulk"], tan_delta=values["loss_tangent_bulk"], reference_frequency=10.0
    )
    cycle = indentation_cycle(2.5e-3, 5e-3, sphere_radius=8e-3, material=tissue)
    assert_allclose(found["indentation_loss_fraction"], cycle.loss_fraction, atol=1e-5)
    assert_allclose(found["indentation_force"][-1], cycle.force[400], rtol=1e-9)
    relaxing = forward_model("indentation").with_options({"substrate": "standard_linear_solid"})
    assert relaxing.observables == ("indentation_force", "indentation_loss_fraction")
