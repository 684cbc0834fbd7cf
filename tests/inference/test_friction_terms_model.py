"""Terms of dry friction in a model file: off unless asked for, limits, what `check` says of loads, truths that come back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from simulated_coverage import failed_tests, recover
from small_models import write_model

from skinbayes.contact import jkr_contact, total_contact_area, twice_stress_variance
from skinbayes.contact.layered import LayeredSkin
from skinbayes.errors import InputError
from skinbayes.friction import friction_coefficient
from skinbayes.problem import Problem, load_problem
from skinbayes.problem.check import check_problem
from skinbayes.problem.template import data_template
from skinbayes.roughness import SelfAffineSpectrum

MODEL = """
title = "Friction against load"
forward = "friction"
[data]
file = "mine.csv"
observable = "friction_coefficient"
[parameters]
hurst_exponent = 0.8
wavevector_min = "1e3 1/m"
wavevector_rolloff = "1e3 1/m"
wavevector_max = "1e6 1/m"
{parameters}
[noise]
family = "lognormal"
noise_scale = {noise}
"""

SKIN = """
young_modulus_layer = "7 MPa"
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
rms_height = "20 um"
"""

SMOOTH = """
young_modulus = "100 kPa"
rms_height = "1 nm"
"""

BALL = 'sphere_radius = "8 mm"\nfrictional_shear_stress = "10 MPa"\n'
LOADS = np.geomspace(0.02, 2.0, 8)


def problem(
    folder: Path, parameters: str, columns: dict[str, object] | None = None, noise: str = "0.1"
) -> Problem:
    columns = {"normal_force [N]": LOADS} if columns is None else columns
    rows = zip(*columns.values(), strict=True)
    lines = [
        ",".join([*columns, "friction_coefficient [1]"]),
        *(",".join(map(str, [*row, 1.0])) for row in rows),
    ]
    (folder / "mine.csv").write_text("\n".join(lines), encoding="utf-8")
    return load_problem(write_model(folder, MODEL.format(parameters=parameters, noise=noise)))


def friction(folder: Path, parameters: str, columns: dict[str, object] | None = None) -> np.ndarray:
    return problem(folder, parameters, columns).predict_data([])


def test_without_terms_nothing_changes_to_the_last_bit(tmp_path: Path) -> None:
    skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    surface = SelfAffineSpectrum(
        rms_height=20e-6, hurst_exponent=0.8, wavevector_min=1e3, wavevector_rolloff=1e3, wavevector_max=1e6
    )
    found = problem(tmp_path, SKIN + BALL)
    pressure = found.derived([])["nominal_pressure"][0]
    area = total_contact_area(pressure, twice_stress_variance(surface, skin), yield_stress=np.inf)
    assert_array_equal(found.predict_data([]), friction_coefficient(10e6, area, nominal_pressure=pressure))
    assert "friction_coefficient_boundary" not in found.derived([])


OFF = {
    "shear_pressure_coefficient": "shear_pressure_coefficient = 0",
    "work_of_adhesion": 'work_of_adhesion = "0 J/m^2"',
    "loss_tangent_bulk": "loss_tangent_bulk = 0",
    "dwell": 'initial_contact_fraction = 1\ncontact_growth_time = "10 s"',
    "occlusion": 'occluded_modulus_ratio = 1\nocclusion_time = "10 s"',
    "run_in": "run_in_ratio = 1\nrun_in_cycles = 5",
}


@pytest.mark.parametrize("term", OFF)
def test_a_term_of_no_size_is_none(tmp_path: Path, term: str) -> None:
    columns = {"normal_force [N]": LOADS, "dwell_time [s]": np.arange(8.0), "cycle [1]": np.arange(1, 9)}
    assert_allclose(
        friction(tmp_path, SKIN + BALL + OFF[term], columns),
        friction(tmp_path, SKIN + BALL, columns),
        rtol=1e-14,
    )


def test_parts_add_up_and_rows_agree_with_the_batch(tmp_path: Path) -> None:
    terms = """
shear_pressure_coefficient = { half_normal = 0.3 }
work_of_adhesion = { loguniform = ["1 mJ/m^2", "100 mJ/m^2"] }
loss_tangent_bulk = { half_normal = 0.2 }
initial_contact_fraction = { uniform = [0, 1] }
contact_growth_time = { lognormal = ["10 s", 0.7] }
run_in_ratio = { lognormal = [1, 0.5] }
run_in_cycles = { lognormal = [10, 1] }
"""
    columns = {"normal_force [N]": LOADS, "dwell_time [s]": np.arange(8.0), "cycle [1]": np.arange(1, 9)}
    found = problem(tmp_path, SKIN + BALL + terms, columns)
    theta = found.draw_prior(np.random.default_rng(3), 5)
    whole, derived = found.predict_data(theta), found.derived(theta)
    parts = [derived[f"friction_coefficient_{name}"] for name in ("boundary", "pressure", "hysteresis")]
    assert_array_equal(sum(parts), whole)
    assert all((part > 0).all() for part in parts)
    assert_array_equal(whole, np.concatenate([found.predict_data(one)[np.newaxis] for one in theta]))


def test_a_smooth_ball_that_sticks_rubs_with_all_of_its_contact(tmp_path: Path) -> None:
    work = 'work_of_adhesion = "50 mJ/m^2"'
    found = friction(tmp_path, SMOOTH + BALL + work)
    contact = jkr_contact(LOADS, 8e-3, reduced_modulus=100e3 / 0.75, work_of_adhesion=0.05)
    assert_allclose(found, 10e6 * np.pi * contact.contact_radius**2 / LOADS, rtol=1e-9)


def test_a_rough_ball_that_sticks_rubs_as_under_the_load_that_it_carries(tmp_path: Path) -> None:
    terms = "shear_pressure_coefficient = 0.1\nloss_tangent_bulk = 0.15\n"
    carried = jkr_contact(LOADS, 8e-3, reduced_modulus=1.0, work_of_adhesion=0.05).carried_force
    sticking = friction(tmp_path, SKIN + BALL + terms + 'work_of_adhesion = "50 mJ/m^2"') * LOADS
    heavier = friction(tmp_path, SKIN + BALL + terms, {"normal_force [N]": carried}) * carried
    assert_allclose(sticking, heavier, rtol=1e-12)


def test_occlusion_is_a_softer_layer(tmp_path: Path) -> None:
    columns = {"normal_force [N]": [0.2] * 3, "dwell_time [s]": [0, 20, 1e6]}
    found = friction(
        tmp_path, SKIN + BALL + 'occluded_modulus_ratio = 0.04\nocclusion_time = "20 s"', columns
    )
    for row, modulus in ((0, "7 MPa"), (2, "0.28 MPa")):
        soft = SKIN.replace("7 MPa", modulus)
        assert friction(tmp_path, soft + BALL, columns)[row] == pytest.approx(found[row], rel=1e-12)
    assert found[0] < found[1] < found[2]


def said_of_loads(folder: Path, parameters: str, columns: dict[str, object] | None = None) -> list[str]:
    said = check_problem(problem(folder, parameters, columns)).predictions
    return [one for one in said if "as the load to the power" in one]


def test_powers_of_the_load(tmp_path: Path) -> None:
    # a smooth flat -1, a smooth ball -1/3, rough skin in which the area goes as the load 0
    flat = said_of_loads(
        tmp_path, SMOOTH + 'frictional_shear_stress = "10 kPa"\nnominal_contact_area = "1 cm^2"'
    )
    assert flat == [
        "Over the loads of the data (20 mN to 2 N) the prediction at the prior medians goes as the load to the power -1.00."
    ]
    ball = SMOOTH + BALL.replace("10 MPa", "10 kPa")
    assert "power -0.33." in said_of_loads(tmp_path, ball)[0]
    assert "power 0.00." in said_of_loads(tmp_path, SKIN + BALL)[0]
    parts = said_of_loads(tmp_path, ball + "shear_pressure_coefficient = 0.2\nloss_tangent = 0.158")[0]
    assert "rises with the pressure" in parts and "power 0.00;" in parts
    assert "loss of the tissue" in parts and parts.endswith("power 0.33.")
    assert not said_of_loads(tmp_path, ball, {"normal_force [N]": [0.2] * 4})


def test_what_a_term_needs(tmp_path: Path) -> None:
    for given, missing in (
        ("run_in_ratio = 0.5", "run_in_cycles and cycle"),
        ('contact_growth_time = "9 s"', "initial_contact_fraction and dwell_time"),
        ("loss_tangent = 0.1", "young_modulus"),
    ):
        with pytest.raises(InputError, match=f"no effect without {missing}"):
            problem(tmp_path, SKIN + BALL + given)
    with pytest.raises(
        InputError, match="work_of_adhesion enlarges the contact of a ball, and nominal_contact_area"
    ):
        problem(tmp_path, SKIN + BALL + 'work_of_adhesion = "5 mJ/m^2"\nnominal_contact_area = "1 cm^2"')
    path = write_model(
        tmp_path, MODEL.format(parameters=SKIN + BALL + OFF["dwell"] + "\n" + OFF["run_in"], noise="0.1")
    )
    assert data_template(path).header == "dwell_time [s],cycle [1],normal_force [N],friction_coefficient [1]"


def test_a_hard_tip_is_marked(tmp_path: Path) -> None:
    tip = (
        SMOOTH.replace("100 kPa", "3 GPa") + BALL.replace("8 mm", "20 nm") + 'work_of_adhesion = "50 mJ/m^2"'
    )
    loads = {"normal_force [N]": [1e-8, 2e-8]}
    assert "Tabor parameter" in problem(tmp_path, tip, loads).explain([])[-1]
    soft = problem(tmp_path, SMOOTH + BALL + 'work_of_adhesion = "50 mJ/m^2"').explain([])
    assert "Tabor" not in " ".join(soft)


DWELL = {"normal_force [N]": [0.5] * 16, "dwell_time [s]": [0, 1, 2, 4, 7, 12, 20, 40] * 2}
CYCLES = {"normal_force [N]": [0.5] * 20, "cycle [1]": [1, 2, 3, 5, 8, 12, 20, 30, 50, 80] * 2}
SHEAR = BALL.replace('"10 MPa"', '{ lognormal = ["10 MPa", 1.0] }')
STUDIES = {
    "load": (
        SMOOTH
        + BALL.replace('"10 MPa"', '{ lognormal = ["10 kPa", 1.0] }')
        + "shear_pressure_coefficient = { half_normal = 0.3 }\nloss_tangent = { half_normal = 0.2 }",
        {"normal_force [N]": np.tile(LOADS, 2)},
    ),
    "adhesion": (
        SMOOTH
        + BALL.replace('"10 MPa"', '{ lognormal = ["10 kPa", 1.0] }')
        + 'work_of_adhesion = { loguniform = ["3 mJ/m^2", "300 mJ/m^2"] }',
        {"normal_force [N]": np.tile(LOADS, 2)},
    ),
    "dwell": (
        SKIN + SHEAR + "initial_contact_fraction = { uniform = [0.05, 1] }\ncontact_growth_time = { lognormal = ['10 s', 0.7] }",
        DWELL,
    ),
    "occlusion": (
        SKIN + SHEAR + "occluded_modulus_ratio = { lognormal = [0.1, 1.0] }\nocclusion_time = { lognormal = ['10 s', 0.7] }",
        DWELL,
    ),
    "run_in": (SKIN + SHEAR + "run_in_ratio = { lognormal = [1, 0.5] }\nrun_in_cycles = { lognormal = [10, 1] }", CYCLES),
}  # fmt: skip


def made(folder: Path, study: str) -> Problem:
    parameters, columns = STUDIES[study]
    return problem(folder, parameters, columns, "{ lognormal = [0.05, 0.3] }")


@pytest.mark.parametrize("study", STUDIES)
@pytest.mark.parametrize("simulations", [8, pytest.param(100, marks=pytest.mark.slow)])
def test_truths_are_covered(tmp_path: Path, study: str, simulations: int) -> None:
    """Each of five tests of a parameter fails by chance in one of 2000."""
    count = (
        3 if (simulations, study) == (8, "occlusion") else simulations
    )  # each skin has an integral of its own there
    found = recover(made(tmp_path, study), count, seed=5)
    assert found.sizes.min() > 200
    failed = {name: failed_tests(found.levels[:, i]) for i, name in enumerate(found.names)}
    assert not any(failed.values()), failed
