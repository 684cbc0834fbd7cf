"""``predict stribeck``: the figures of Sect. 6 through the command line, the parts, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from command_line import run
from numpy.testing import assert_allclose, assert_array_equal

from skinbayes.contact import LayeredSkin
from skinbayes.lubrication import stribeck_curve
from skinbayes.problem import load_problem
from skinbayes.roughness import SelfAffineSpectrum

PARTS = (
    "friction_coefficient_boundary",
    "friction_coefficient_couette",
    "friction_coefficient_pressure_flow",
)


@pytest.fixture(scope="module")
def curve() -> dict[str, np.ndarray]:
    """The cylinder of Eq. 9, which the paper calculates with."""
    problem = load_problem("stribeck", settings={"contact": "line"})
    found = problem.predict(problem.prior_medians())
    return {**found, "speed_viscosity_product": problem.conditions.values["speed_viscosity_product"]}


def test_the_case_of_the_paper(curve):
    speed, friction = curve["speed_viscosity_product"], curve["friction_coefficient"]
    # sigma_f A/(A0 p) with A/A0 = 6.48e-4 at 6.83 kPa; at the mean Hertz pressure of 0.2 N A/p is the same
    assert friction[0] == pytest.approx(15e6 * 6.48e-4 / 6830, rel=3e-3)
    assert friction.min() == pytest.approx(0.108, abs=0.002)
    assert speed[friction.argmin()] == pytest.approx(0.024, rel=0.25)
    half = np.interp(-friction[0] / 2, -friction[: friction.argmin()], np.log(speed[: friction.argmin()]))
    assert np.exp(half) == pytest.approx(1.63e-3, rel=0.06)
    rising = speed > 0.05
    slope = np.polyfit(np.log(speed[rising]), np.log(friction[rising]), 1)[0]
    assert 0.4 < slope < 0.6


def test_the_ball_itself_needs_more_speed_and_has_more_friction(capsys, curve):
    chosen = load_problem("stribeck").forward.chosen
    assert chosen["contact"] == "point" and set(chosen.values()) == {"point", "none", "elastic"}
    command = ("predict", "stribeck", "--set", "speed_viscosity_product=0.025 N/m", "--json")
    ball = run(capsys, *command).document()["prediction"]
    cylinder = run(capsys, *command, "--set", "contact=line").document()["prediction"]
    ratio = ball["friction_coefficient"][0] / cylinder["friction_coefficient"][0]
    assert ratio == pytest.approx(1.18, abs=0.02)  # docs/equations.md, from 1440 cells
    # more flow resistance and shear stress in rough gaps: docs/equations.md
    for kind in ("gap", "patir-cheng"):
        factors = run(capsys, *command, "--set", "contact=line", "--set", f"flow_factors={kind}").document()
        more = factors["prediction"]["friction_coefficient"][0] / cylinder["friction_coefficient"][0]
        assert 1.1 < more < 1.4
    refused = run(capsys, *command, "--set", "contact=ellipse")
    assert refused.status == 2 and "'point' or 'line'" in refused.errors


def test_parts_add_up_and_films_grow(curve):
    assert_allclose(sum(curve[part] for part in PARTS), curve["friction_coefficient"], rtol=1e-12)
    assert (np.diff(curve["friction_coefficient_boundary"]) < 0).all()
    assert (np.diff(curve["asperity_load_fraction"]) <= 0).all() and curve["asperity_load_fraction"][
        0
    ] > 0.999
    assert (np.diff(curve["minimum_film_thickness"]) > 0).all()
    assert (curve["minimum_film_thickness"][10:] <= curve["central_film_thickness"][10:]).all()


def test_other_parameters_against_the_physics(capsys):
    settings = {
        "young_modulus_bulk": "60 kPa",
        "young_modulus_layer": "3 MPa",
        "layer_thickness": "50 um",
        "rms_height": "12 um",
        "normal_force": "1 N",
        "sphere_radius": "12 mm",
        "frictional_shear_stress": "4 MPa",
        "velocity_shift_factor": "3",
    }
    arguments = [part for name, text in settings.items() for part in ("--set", f"{name}={text}")]
    found = run(
        capsys, "predict", "stribeck", *arguments, "--set", "speed_viscosity_product=2 mN/m", "--json"
    ).document()["prediction"]
    skin = LayeredSkin(young_modulus_layer=3e6, young_modulus_bulk=60e3, layer_thickness=50e-6)
    surface = SelfAffineSpectrum(
        rms_height=12e-6,
        hurst_exponent=0.78,
        wavevector_min=1e3,
        wavevector_rolloff=6.345e3,
        wavevector_max=1e9,
    )
    direct = stribeck_curve(
        3 * 2e-3,
        sphere_radius=12e-3,
        normal_force=1.0,
        skin=skin,
        spectrum=surface,
        frictional_shear_stress=4e6,
    )
    assert_allclose(found["friction_coefficient"], direct.friction_coefficient, rtol=1e-6)
    assert_allclose(found["central_film_thickness"], direct.central_film, rtol=1e-6)


def test_viscosity_and_speed_are_another_way_to_say_the_product(capsys, tmp_path):
    rows = tmp_path / "rows.csv"
    rows.write_text(
        "viscosity [Pa s],sliding_speed [mm/s],normal_force [N]\n1,20,0.2\n1,20,0.4\n0.1,200,0.2\n"
    )
    found = run(capsys, "predict", "stribeck", "--conditions", str(rows), "--json").document()["prediction"][
        "friction_coefficient"
    ]
    one = run(
        capsys, "predict", "stribeck", "--set", "speed_viscosity_product=0.02 N/m", "--json"
    ).document()["prediction"]
    assert_allclose([found[0], found[2]], one["friction_coefficient"][0], rtol=1e-9)
    assert abs(found[1] / found[0] - 1) > 0.01
    refused = run(
        capsys, "predict", "stribeck", "--set", "viscosity=1 Pa s", "--set", "speed_viscosity_product=1 N/m"
    )
    assert refused.status == 2 and "exclude each other" in refused.errors


def test_beyond_the_theory_is_refused_with_the_reason(capsys):
    refused = run(capsys, "predict", "stribeck", "--set", "speed_viscosity_product=10 N/m")
    assert refused.status == 2 and refused.output == ""
    assert "thicker than the inlet of the ball" in refused.errors
    doubtful = run(capsys, "predict", "stribeck", "--set", "speed_viscosity_product=0.01 N/m", "--json")
    assert doubtful.status == 0 and "note:" in doubtful.errors and "Hertz" in doubtful.errors


def test_rows_and_batch_agree_to_the_last_bit(tmp_path):
    model = tmp_path / "ball.toml"
    text = load_problem("stribeck").spec.text
    free = 'young_modulus_bulk = { lognormal = ["20 kPa", 0.3] }'
    fixed = next(line for line in text.splitlines() if line.startswith("young_modulus_bulk"))
    model.write_text(text.replace(fixed, free).replace("points = 31", "points = 2"))
    problem = load_problem(model)
    theta = problem.draw_prior(np.random.default_rng(2), 3)
    batch = problem.predict(theta)["friction_coefficient"]
    assert batch.shape == (3, 2)
    for row, vector in zip(batch, theta, strict=True):
        assert_array_equal(row, problem.predict(vector)["friction_coefficient"])
