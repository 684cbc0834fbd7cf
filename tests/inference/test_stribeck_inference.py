"""The lubricated ball as a statistical model: from a table of films and from the film solver, with measured flow curves."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from skinbayes.errors import InputError
from skinbayes.forward import forward_model
from skinbayes.problem import Problem, load_problem

MODEL = """
format = 1
title = "A ball in two liquids"
forward = "stribeck"

[options]
contact = "line"

[data]
file = "mine.csv"
observable = "friction_coefficient"

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
{more}
"""

ROWS = """liquid,sliding_speed [mm/s],friction_coefficient [1]
thin,10,1.2
thin,100,0.5
thick,10,0.2
thick,100,0.3
thick,300,0.4
"""

FLOW = """liquid,shear_rate [1/s],viscosity [Pa s]
thick,1,2
thick,100,1.5
thick,10000,0.4
thin,100,0.05
thin,1,0.05
"""

RHEOLOGY = """
[rheology]
file = "flow.csv"
by = "liquid"
"""


def write(
    folder: Path, parameters: str = "", more: str = RHEOLOGY, rows: str = ROWS, flow: str = FLOW
) -> Path:
    (folder / "mine.csv").write_text(rows, encoding="utf-8")
    (folder / "flow.csv").write_text(flow, encoding="utf-8")
    path = folder / "mine.toml"
    path.write_text(MODEL.format(parameters=parameters, more=more), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory) -> Problem:
    return load_problem(write(tmp_path_factory.mktemp("ball")))


THETA = np.array([[15e6, 30e3, 0.2], [8e6, 35e3, 0.1], [30e6, 24e3, 0.4]])


def direct(problem: Problem, theta: np.ndarray) -> dict[str, np.ndarray]:
    return problem.forward.evaluate(problem.inputs(theta), problem.tables)


def test_the_table_is_the_film_solver(problem: Problem) -> None:
    seen: list[tuple[int, int]] = []
    model = problem.prepare(lambda done, total: seen.append((done, total)))
    assert seen and seen[-1][0] == seen[-1][1]
    assert problem.prepare() is model and model is not problem.forward
    assert "table of films" in model.accuracy and "%" in model.accuracy
    found, exact = problem.predict(THETA), direct(problem, THETA)
    assert set(found) == set(exact)
    # 80 places of the direct solver against 96 in the table: each within 0.3 % of many more
    for name in ("friction_coefficient", "central_film_thickness", "friction_coefficient_couette"):
        assert_allclose(found[name], exact[name], rtol=7e-3)
    assert found["friction_coefficient"].std() > 0.1


def test_rows_of_a_batch_are_those_of_single_vectors(problem: Problem) -> None:
    batch = problem.log_likelihood(THETA)
    for i, theta in enumerate(THETA):
        assert_array_equal(problem.log_likelihood(theta), batch[i])
    assert_array_equal(pickle.loads(pickle.dumps(problem)).log_likelihood(THETA), batch)


def test_the_viscosity_is_that_of_the_film(problem: Problem) -> None:
    found = problem.predict(THETA)
    speed = problem.conditions.values["sliding_speed"]
    abscissa = problem.model.abscissa(problem.inputs(THETA), problem.tables)
    film = found["central_film_thickness"]
    thick = problem.tables.flow_curves[2]
    expected = thick.viscosity((speed / film)[:, 2:])
    assert_allclose((abscissa / speed)[:, 2:], expected, rtol=1e-3)
    assert_allclose((abscissa / speed)[:, :2], 0.05, rtol=1e-9)


def test_flags_of_table_and_solver_agree(problem: Problem) -> None:
    found = problem.flags(THETA)
    exact = problem.forward.flags(problem.inputs(THETA), problem.tables)
    assert set(found) == set(exact) == set(problem.forward.flag_meanings)
    for name, flag in exact.items():
        assert_array_equal(found[name], np.broadcast_to(flag, (3, 5)), err_msg=name)
    # 10 mm/s over some tens of micrometres lies beyond the 100 1/s up to which the thin liquid was measured
    assert found["shear_rate_unmeasured"][:, :2].all() and not found["shear_rate_unmeasured"][:, 2:].any()
    assert found["strained"].all() and not found["largely_strained"].any()
    assert any("its viscosity was not measured" in line for line in problem.explain(THETA[0]))


def test_beyond_the_table_parameters_are_impossible(problem: Problem) -> None:
    prior = problem.free[1].prior
    inside, outside = prior.quantile(2e-5), prior.quantile(1e-7)
    theta = np.array([[15e6, inside, 0.2], [15e6, outside, 0.2]])
    assert np.isfinite(problem.log_likelihood(theta)).tolist() == [True, False]
    assert np.isfinite(problem.log_prior(theta)).all()


def test_shift_and_additive_friction(tmp_path: Path) -> None:
    rows = "speed_viscosity_product [N/m],friction_coefficient [1]\n1e-4,1.2\n2e-3,0.9\n3e-2,0.2\n"
    terms = "velocity_shift_factor = { lognormal = [1, 1] }\nadditive_friction = { half_normal = 0.1 }"
    problem = load_problem(write(tmp_path, terms, "", rows))
    assert problem.names[2:4] == ("velocity_shift_factor", "additive_friction")
    theta = np.array([[15e6, 30e3, 1.0, 0.0, 0.2], [15e6, 30e3, 2.5, 0.1, 0.2]])
    found = problem.predict(theta)["friction_coefficient"]
    shifted = "speed_viscosity_product [N/m]\n2.5e-4\n5e-3\n7.5e-2\n"
    (tmp_path / "rows.csv").write_text(shifted, encoding="utf-8")
    other = load_problem(tmp_path / "mine.toml", conditions=tmp_path / "rows.csv")
    expected = other.predict(theta[0])["friction_coefficient"]  # by the film solver
    assert_allclose(found[1] - 0.1, expected, rtol=7e-3)
    assert_allclose(found, direct(problem, theta)["friction_coefficient"], rtol=7e-3)


def test_without_a_table(tmp_path: Path) -> None:
    rows = "speed_viscosity_product [N/m],friction_coefficient [1]\n1e-4,1.2\n2e-3,0.9\n"
    varying = "hurst_exponent = { uniform = [0.7, 0.85] }"
    problem = load_problem(write(tmp_path, varying, "", rows))
    theta = np.array([[15e6, 30e3, 0.78, 0.2], [15e6, 30e3, 0.72, 0.2]])
    found = problem.predict(theta)["friction_coefficient"]
    assert "hurst_exponent" in problem.model.accuracy and "slow" in problem.model.accuracy
    assert_array_equal(found, direct(problem, theta)["friction_coefficient"])
    assert found[0, 1] != found[1, 1]


@pytest.mark.parametrize(
    ("parameters", "more", "rows", "flow", "fragments"),
    [
        ("viscosity = '1 Pa s'", RHEOLOGY, ROWS, FLOW, ("viscosity", "twice", "[rheology]")),
        ("", RHEOLOGY, ROWS.replace("thick,300", "thin and thick,300"), FLOW, ("thin and thick", "no flow curve")),
        ("", RHEOLOGY, ROWS.replace("liquid", "source"), FLOW, ("no column 'liquid'", "flow curve")),
        ("", RHEOLOGY, ROWS, FLOW.replace("thin,1,", "thin,100,"), ("thin", "shear_rate")),
        ("", RHEOLOGY, ROWS, FLOW.replace("shear_rate [1/s]", "sliding_speed [m/s]"), ("no column 'shear_rate'",)),
        ("", RHEOLOGY.replace('"liquid"', '"fluid"'), ROWS, FLOW, ("no column 'fluid'", "liquid")),
        ("", RHEOLOGY.replace("file", "dataset"), ROWS, FLOW, ("rheology", "flow.csv")),
        ("", "", ROWS, FLOW, ("needs", "viscosity and sliding_speed")),
    ],
)  # fmt: skip
def test_flow_curves_that_cannot_be(
    tmp_path: Path, parameters: str, more: str, rows: str, flow: str, fragments: tuple[str, ...]
) -> None:
    with pytest.raises(InputError) as caught:
        load_problem(write(tmp_path, parameters, more, rows, flow))
    for fragment in fragments:
        assert fragment in str(caught.value)


def test_only_lubrication_has_a_use_for_flow_curves(tmp_path: Path) -> None:
    users = [name for name in ("stribeck", "friction", "drying") if forward_model(name).uses_flow_curves]
    assert users == ["stribeck"]
    path = write(tmp_path)
    text = path.read_text(encoding="utf-8").replace('forward = "stribeck"', 'forward = "friction"')
    text = text.replace('[options]\ncontact = "line"\n', "")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="no use for flow curves"):
        load_problem(path)


def test_a_prediction_for_other_rows_needs_their_liquid(problem: Problem, tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_text("liquid,sliding_speed [m/s]\nthick,0.05\n", encoding="utf-8")
    other = load_problem(problem.spec.path, conditions=tmp_path / "rows.csv")
    found = other.predict(THETA[0])["friction_coefficient"]
    assert found.shape == (1,) and 0.1 < found[0] < 0.5
    assert_allclose(problem.predict(THETA[0], other.conditions)["friction_coefficient"], found, rtol=7e-3)


@pytest.mark.parametrize(
    "name",
    [
        "finger-stribeck", "finger-stribeck-free-roughness", "finger-stribeck-shift", "finger-stribeck-additive",
        "finger-stribeck-covariates", "finger-stribeck-pad",
    ],
)  # fmt: skip
def test_finger_models_share_everything_but_their_hypothesis(name: str) -> None:
    plain, problem = load_problem("finger-stribeck"), load_problem(name)
    assert problem.conditions.n_rows == 165 and problem.groups.columns == ("person", "liquid")
    assert problem.spec.baseline_models == ("finger-null", "finger-descriptive")
    assert len(set(problem.tables.flow_curves)) == 15
    shared = {p.label: p.prior_text for p in plain.free} | {"rms_height": None}
    for parameter in problem.free:
        if parameter.label in shared and parameter.label != "rms_height":
            assert parameter.prior_text == shared[parameter.label]
        assert parameter.source


def test_the_ball_of_the_paper_waits_for_data(tmp_path: Path) -> None:
    problem = load_problem("stribeck-ball")
    assert problem.observed is None
    assert np.isfinite(problem.predict(problem.prior_medians())["friction_coefficient"]).all()
    with pytest.raises(InputError, match="--data"):
        _ = problem.observables
    (tmp_path / "mine.csv").write_text(
        "speed_viscosity_product [N/m],speed_viscosity_product_standard_deviation [N/m],friction_coefficient [1],"
        "friction_coefficient_standard_deviation [1]\n1e-3,5e-5,1.0,0.02\n2e-2,1e-3,0.15,0.01\n",
        encoding="utf-8",
    )
    bound = load_problem("stribeck-ball", data=tmp_path / "mine.csv")
    assert bound.dimension == 6 and bound.input_spread["speed_viscosity_product"].tolist() == [0.05, 0.05]
