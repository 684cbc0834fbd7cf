"""Perfectly dry and saturated air, and skin that is warmer than the air, through the command line."""

import numpy as np
import pytest
from command_line import run

from skinbayes import load_problem
from skinbayes.wetting import humidity_at_surface

MODEL = """
format = 1
title = "A climate chamber"
forward = "humid-air"

[data]
file = "rows.csv"
observable = "friction_coefficient"

[surface]
name = "paper_reference"

[parameters]
frictional_shear_stress = { lognormal = ["15 MPa", 0.7], source = "made up" }
yield_stress = { fixed = "50 MPa", source = "made up" }
young_modulus_layer_dry = { fixed = "1 GPa", source = "made up" }
young_modulus_layer_wet = { lognormal = ["7 MPa", 0.25], source = "made up" }
transition_humidity = { beta = [14, 6], source = "made up" }
transition_sharpness = { fixed = 1.5, source = "made up" }
young_modulus_bulk = { fixed = "20 kPa", source = "made up" }
layer_thickness = { fixed = "20 um", source = "made up" }
nominal_pressure = { fixed = "6.83 kPa", source = "made up" }
TEMPERATURES
contact_angle_skin = { ANGLE, source = "made up" }
contact_angle_counterface = { fixed = "0 deg", source = "made up" }

[noise]
family = "lognormal"
noise_scale = { fixed = 0.1, source = "made up" }
"""
ALIKE = 'temperature = { fixed = "23 degC", source = "made up" }'
WARM = (
    'air_temperature = { fixed = "20 degC", source = "made up" }\n'
    'surface_temperature = { fixed = "32 degC", source = "made up" }'
)
WET, FREE = 'fixed = "80 deg"', 'uniform = ["70 deg", "179 deg"]'


def write(folder, rows, temperatures=ALIKE, angle=WET):
    lines = ["relative_humidity [%],friction_coefficient [1]", *(f"{x!r},{y!r}" for x, y in rows)]
    (folder / "rows.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    model = folder / "chamber.toml"
    model.write_text(MODEL.replace("TEMPERATURES", temperatures).replace("ANGLE", angle), encoding="utf-8")
    return model


@pytest.mark.parametrize("humidities", [(30, 100), (0, 1e-7, 100)])
def test_rows_at_the_ends_are_rows_like_others(capsys, tmp_path, humidities):
    model = write(tmp_path, [(h, 0.3 + h / 90) for h in humidities], WARM if humidities[0] else ALIKE)
    checked, prior = (run(capsys, command, model) for command in ("check", "prior"))
    assert checked.status == 0 and prior.status == 0, checked.errors + prior.errors
    assert "All of 1000 prior draws give finite predictions" in checked.output


@pytest.mark.parametrize("angle", [WET, FREE])
@pytest.mark.parametrize("temperatures", [ALIKE, WARM])
def test_the_table_holds_at_both_ends(tmp_path, angle, temperatures):
    rows = [(h, 1.0) for h in (0.0, 1e-8, 0.5, 30.0, 90.0, 99.999, 100.0)]
    problem = load_problem(write(tmp_path, rows, temperatures, angle))
    draws = problem.draw_prior(np.random.default_rng(5), 40)
    by_table = problem.predict(draws)["capillary_pressure"] + 6830.0
    solved = problem.forward.evaluate(problem.inputs(draws), problem.tables)["capillary_pressure"] + 6830.0
    assert problem.model.prepare is None
    # the accuracy that `humid_table` states, 2 % where bridges pull hard
    np.testing.assert_allclose(by_table, solved, rtol=0.02)
    gentle = solved < 1.5 * 6830
    assert np.sqrt(np.mean(np.square(by_table[gentle] / solved[gentle] - 1))) < 1e-3
    if temperatures is ALIKE:
        np.testing.assert_array_equal(by_table[:, -1], 6830.0)


def test_warm_skin_sees_drier_air(capsys):
    def friction(*pairs):
        words = [word for pair in pairs for word in ("--set", pair)]
        outcome = run(capsys, "predict", "humid-air", "--json", *words)
        assert outcome.status == 0, outcome.errors
        return outcome.document()["prediction"]["friction_coefficient"][0]

    warm = friction("relative_humidity=90 %", "air_temperature=20 degC", "surface_temperature=32 degC")
    humidity = float(
        humidity_at_surface(relative_humidity=0.9, air_temperature=293.15, surface_temperature=305.15)
    )
    assert warm == pytest.approx(friction(f"relative_humidity={humidity!r}", "temperature=32 degC"), rel=1e-9)
    # at 99 % in the air the layer of cold skin is soft, that of warm skin is not
    wet = friction("relative_humidity=99 %", "air_temperature=20 degC", "surface_temperature=20 degC")
    assert (
        friction("relative_humidity=99 %", "air_temperature=20 degC", "surface_temperature=32 degC")
        < 0.5 * wet
    )
    same = friction("relative_humidity=85 %", "air_temperature=25 degC", "surface_temperature=25 degC")
    assert same == pytest.approx(friction("relative_humidity=85 %", "temperature=25 degC"), rel=1e-12)
    # on cold skin water condenses
    cold = friction("relative_humidity=90 %", "air_temperature=30 degC", "surface_temperature=20 degC")
    assert cold == pytest.approx(friction("relative_humidity=100 %"), rel=1e-12)


@pytest.mark.parametrize(
    ("pairs", "said"),
    [
        (("air_temperature=20 degC",), "air_temperature and surface_temperature"),
        (("temperature=20 degC", "air_temperature=20 degC"), "exclude each other"),
        (("air_temperature=-3 degC", "surface_temperature=32 degC"), "air_temperature: found"),
        (("air_temperature=20 degC", "surface_temperature=-1 degC"), "surface_temperature: found"),
    ],
)
def test_temperatures_that_cannot_be(capsys, pairs, said):
    outcome = run(capsys, "predict", "humid-air", *(word for pair in pairs for word in ("--set", pair)))
    assert outcome.status == 2
    assert said in outcome.errors


def test_a_row_without_prediction_is_named_with_the_reason(capsys, tmp_path):
    text = (tmp_path / "film.toml", tmp_path / "rows.csv")
    text[0].write_text(
        """
format = 1
title = "Films"
forward = "capillary-film"

[data]
file = "rows.csv"
observable = "relative_contact_area"

[surface]
name = "paper_reference"

[parameters]
young_modulus_layer = { lognormal = ["7 MPa", 0.3], source = "made up" }
young_modulus_bulk = { fixed = "20 kPa", source = "made up" }
layer_thickness = { fixed = "20 um", source = "made up" }
nominal_pressure = { fixed = "6.83 kPa", source = "made up" }
surface_tension = { fixed = "72 mN/m", source = "made up" }
contact_angle_skin = { fixed = "80 deg", source = "made up" }
contact_angle_counterface = { fixed = "0 deg", source = "made up" }

[noise]
family = "lognormal"
noise_scale = { fixed = 0.1, source = "made up" }
""",
        encoding="utf-8",
    )
    text[1].write_text(
        "film_thickness [um],relative_contact_area [1]\n6,0.001\n0,0.0006\n9,0.001\n", encoding="utf-8"
    )
    for command in ("check", "prior"):
        outcome = run(capsys, command, text[0])
        assert outcome.status == 2
        assert "row 2" in outcome.errors and "film_thickness is 0" in outcome.errors
        assert "row 1" not in outcome.errors
