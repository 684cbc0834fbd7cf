"""Skin in humid air (Appendix A, Figs. 16 and 17) through the command line: limits, the paper, a table of the user's own."""

from __future__ import annotations

import math

import numpy as np
import pytest
from command_line import run
from plain_contact import PlainContact

from skinbayes.contact import LayeredSkin, gap_distribution
from skinbayes.roughness import SelfAffineSpectrum
from skinbayes.wetting import (
    capillary_state_in_humid_air,
    surface_tension_of_water,
    young_modulus_at_humidity,
    young_modulus_from_table,
)

LOAD, SHEAR = 6830.0, 15e6
MODELS = ("humid-air", "humid-air:sharp")
ELASTIC = "yield_stress=inf Pa"
NO_BRIDGES = "contact_angle_counterface=102 deg"


@pytest.fixture
def predict(capsys):
    def at(model: str, *pairs: str, rows=None) -> tuple[np.ndarray, dict[str, np.ndarray], str]:
        model, _, closure = model.partition(":")
        pairs = (*pairs, f"closure={closure}") if closure else pairs
        words = [word for pair in pairs for word in ("--set", pair)]
        words += [] if rows is None else ["--conditions", rows]
        outcome = run(capsys, "predict", model, "--json", *words)
        assert outcome.status == 0, outcome.errors
        found = outcome.document()
        values = {k: np.array(v, dtype=float) for k, v in found["prediction"].items()}
        return np.array(found["conditions"].get("relative_humidity", [])), values, outcome.errors

    return at


def table(folder, header: str, *rows: tuple[float, ...]):
    path = folder / "rows.csv"
    lines = [",".join(repr(float(x)) for x in row) for row in rows]
    path.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("model", MODELS)
def test_dry_skin_is_plastic_and_saturated_skin_flooded(predict, model):
    humidity, found, _ = predict(model)
    friction, capillary_pressure = found["friction_coefficient"], found["capillary_pressure"]
    assert (humidity[1], humidity[-1]) == (pytest.approx(0.1), 1.0)
    # every contact has yielded: μ = σ_f/σ_Y, and what the bridges add to the load
    assert friction[1] == pytest.approx(SHEAR / 50e6 * (1 + capillary_pressure[1] / LOAD), rel=1e-3)
    assert friction[1] == pytest.approx(0.3, rel=0.02)
    flooded, _ = PlainContact(layer=7e6).area(LOAD)
    assert friction[-1] == pytest.approx(SHEAR * flooded / LOAD, rel=1e-4)
    assert friction[-1] == pytest.approx(1.42, abs=0.005)
    assert capillary_pressure[-1] == 0.0
    assert found["kelvin_radius"][-1] == np.inf
    np.testing.assert_allclose(friction, SHEAR / LOAD * found["relative_contact_area"], rtol=1e-12)


@pytest.mark.parametrize("model", MODELS)
def test_figure_16(predict, model):
    humidity, stiff, _ = predict(model, "young_modulus_layer=70 MPa", ELASTIC)
    logs = np.log10(stiff["relative_contact_area"])
    inside = (humidity > 0.12) & (humidity < 1)
    assert np.all((logs[inside] > -4.2) & (logs[inside] < -4.0))
    _, soft, notes = predict(model, "young_modulus_layer=7 MPa", ELASTIC)
    nearly_dry = (humidity > 0.12) & (humidity <= 0.2)
    assert np.all(soft["relative_contact_area"][nearly_dry] > 0.6)
    assert np.all(soft["relative_contact_area"][humidity >= 0.95] < 5e-3)
    assert "rely neither" in notes
    # soft skin pulled into complete contact has yielded all over, and has no more area than there is
    _, yielding, _ = predict(model, "young_modulus_layer=7 MPa")
    assert np.all(yielding["relative_contact_area"] <= 1.0)
    both = (x["relative_contact_area"][nearly_dry] for x in (yielding, soft))
    np.testing.assert_allclose(*both, rtol=0.01)


def test_a_hundredfold_is_what_yielding_makes_of_dry_skin(predict):
    at = ("young_modulus_layer=1 GPa", "relative_humidity=10 %")
    (yielding,) = predict("humid-air", *at)[1]["relative_contact_area"]
    _, elastic, _ = predict("humid-air", *at, ELASTIC)
    pressure = LOAD + elastic["capillary_pressure"][0]
    assert elastic["relative_contact_area"][0] == pytest.approx(
        PlainContact(layer=1e9).area(pressure)[0], rel=1e-4
    )
    assert yielding == pytest.approx(sum(PlainContact(layer=1e9).area(pressure, yield_stress=50e6)), rel=1e-4)
    assert yielding > 20 * elastic["relative_contact_area"][0]


OTHER = {
    "warm, half soft": ({"layer": 20e6, "bulk": 30e3, "thickness": 30e-6}, 9e3, 40, 20, 308.15, 0.6, 0.42, 20e6),
    "cold, stiff, rough": ({"layer": 0.3e9, "height": 35e-6, "hurst": 0.85}, 4e3, 70, 10, 278.15, 0.35, 1.0, 60e6),
    "soft and humid": ({"layer": 6e6, "nu_layer": 0.45, "low": 2e3, "rolloff": 1e4}, 12e3, 80, 60, 293.15, 0.97, 0.5, 5e6),
}  # fmt: skip
NAMES = {
    "layer": "young_modulus_layer={!r} Pa", "bulk": "young_modulus_bulk={!r} Pa", "thickness": "layer_thickness={!r} m",
    "nu_layer": "poisson_ratio_layer={!r}", "height": "rms_height={!r} m", "hurst": "hurst_exponent={!r}",
    "low": "wavevector_min={!r} 1/m", "rolloff": "wavevector_rolloff={!r} 1/m",
}  # fmt: skip


@pytest.mark.parametrize("closure", ["gaussian", "sharp"])
@pytest.mark.parametrize("case", OTHER)
def test_other_skin_against_direct_calls_and_independent_code(predict, case, closure):
    plain, load, first, second, kelvin, humidity, correction, limit = OTHER[case]
    words = [NAMES[name].format(value) for name, value in plain.items()]
    words += [f"nominal_pressure={load} Pa", f"area_correction={correction}", f"yield_stress={limit} Pa"]
    words += [f"contact_angle_skin={first} deg", f"contact_angle_counterface={second} deg"]
    words += [f"temperature={kelvin} K", f"relative_humidity={humidity}", "frictional_shear_stress=8 MPa"]
    found = predict("humid-air" if closure == "gaussian" else "humid-air:sharp", *words)[1]
    capillary_pressure, radius = found["capillary_pressure"][0], found["kelvin_radius"][0]
    body = PlainContact(**plain)
    skin = LayeredSkin(
        young_modulus_layer=body.layer,
        young_modulus_bulk=body.bulk,
        poisson_ratio_layer=body.nu_layer,
        poisson_ratio_bulk=body.nu_bulk,
        layer_thickness=body.thickness,
    )
    surface = SelfAffineSpectrum(
        rms_height=plain.get("height", 22.4e-6),
        hurst_exponent=body.hurst,
        wavevector_min=body.low,
        wavevector_rolloff=body.rolloff,
        wavevector_max=body.high,
    )
    state = capillary_state_in_humid_air(
        humidity,
        kelvin,
        nominal_pressure=load,
        spectrum=surface,
        skin=skin,
        contact_angle_skin=math.radians(first),
        contact_angle_counterface=math.radians(second),
        area_correction=correction,
        closure=closure,
    )
    assert capillary_pressure == pytest.approx(state.capillary_pressure, rel=1e-9)
    assert capillary_pressure > 0.01 * load
    # Kelvin's equation for a mole of water, and Eqs. 5 to 7 with the public gap distribution
    volume = 18.015e-6 / (1 - 2.07e-4 * (kelvin - 293.15) + 0.0018) if kelvin > 280 else 18.016e-6
    assert surface_tension_of_water(kelvin) / radius * volume == pytest.approx(
        8.314462618 * kelvin * math.log(1 / humidity), rel=0.01
    )
    gaps = gap_distribution(
        load + capillary_pressure, surface, skin=skin, area_correction=correction, closure=closure
    )
    wet = (
        gaps.cumulative(radius * sum(map(math.cos, map(math.radians, (first, second)))))
        - gaps.contact_fraction
    )
    assert capillary_pressure == pytest.approx(surface_tension_of_water(kelvin) / radius * wet, rel=1e-8)
    area = sum(body.area(load + capillary_pressure, correction=correction, yield_stress=limit))
    assert found["relative_contact_area"][0] == pytest.approx(area, rel=2e-4)
    assert found["friction_coefficient"][0] == pytest.approx(8e6 * area / load, rel=2e-4)


def test_a_table_of_moduli_of_the_users_own(predict, tmp_path):
    humidity = np.array([0.2, 0.45, 0.6, 0.75, 0.9, 1.0])
    moduli = young_modulus_from_table(humidity, [0.1, 0.5, 0.8, 1.0], table_modulus=[2e9, 8e8, 3e7, 8e6])
    rows = table(
        tmp_path,
        "relative_humidity [%],young_modulus_layer [MPa]",
        *zip(100 * humidity, moduli / 1e6, strict=True),
    )
    along, found, _ = predict("humid-air", rows=rows)
    np.testing.assert_allclose(along, humidity, rtol=1e-15)
    for i in range(len(humidity)):
        words = (f"relative_humidity={float(humidity[i])!r}", f"young_modulus_layer={float(moduli[i])!r} Pa")
        for name, values in predict("humid-air", *words)[1].items():
            assert values[0] == pytest.approx(found[name][i], rel=1e-12), (name, i)
    # the table of the user and the curve of the model file are not the same
    others = moduli / young_modulus_at_humidity(
        humidity, 1e9, young_modulus_wet=7e6, transition_humidity=0.89, sharpness=1.5
    )
    assert np.all(np.abs(np.log(others)) > 0.05)


@pytest.mark.parametrize("model", MODELS)
def test_bridges_matter_little_below_90_percent_as_in_appendix_a(predict, model):
    humidity, found, _ = predict(model)
    below = humidity < 0.905
    # 13 % of the load at 90 %, where the appendix shows with 70 MPa that they are negligible, and less below
    assert np.all(found["capillary_pressure"][below] < 0.15 * LOAD)
    assert np.all(found["friction_coefficient"][below] < 0.35)
    modulus = young_modulus_at_humidity(
        0.9, 1e9, young_modulus_wet=7e6, transition_humidity=0.89, sharpness=1.5
    )
    assert modulus == pytest.approx(70e6, rel=0.05)
    shipped = predict(model, "relative_humidity=90 %")[1]
    fixed = predict(model, "relative_humidity=90 %", f"young_modulus_layer={float(modulus)!r} Pa")[1]
    assert shipped["friction_coefficient"][0] == pytest.approx(fixed["friction_coefficient"][0], rel=1e-9)
    assert predict(model, "relative_humidity=99 %")[1]["friction_coefficient"][0] > 1.5


def test_humidity_and_load_that_both_differ_from_row_to_row(predict, tmp_path):
    pairs = [(0.3, 5e3), (0.8, 9e3), (0.3, 9e3), (0.95, 5e3)]
    rows = table(tmp_path, "relative_humidity [1],nominal_pressure [Pa]", *pairs)
    _, found, _ = predict("humid-air", rows=rows)
    for i, (humidity, load) in enumerate(pairs):
        alone = predict("humid-air", f"relative_humidity={humidity}", f"nominal_pressure={load} Pa")[1]
        for name, values in alone.items():
            assert values[0] == pytest.approx(found[name][i], rel=1e-12), name


def test_no_bridges_on_polypropylene(predict):
    humidity, found, notes = predict("humid-air", NO_BRIDGES)
    assert notes == ""
    assert np.all(found["capillary_pressure"] == 0.0)
    # only the layer softens: friction rises with humidity up to that of flooded skin
    assert np.all(np.diff(found["friction_coefficient"]) > -1e-12)
    moduli = young_modulus_at_humidity(
        humidity, 1e9, young_modulus_wet=7e6, transition_humidity=0.89, sharpness=1.5
    )
    for i in (0, 13, 18, 19):
        area = sum(PlainContact(layer=moduli[i]).area(LOAD, yield_stress=50e6))
        assert found["relative_contact_area"][i] == pytest.approx(area, rel=1e-4)


def test_notes_on_what_theory_cannot_say(predict):
    both = predict("humid-air", "transition_humidity=0.7")[2]
    assert "3 of 20 rows: bridges pull with more than 0.5 of the load" in both
    assert "2 of 20 rows: bridges span less than 0.3 nm" in both
    assert predict("humid-air", "relative_humidity=50 %")[2] == ""
    assert "0.3 nm" not in predict("humid-air", "relative_humidity=15 %")[2]


# -- what the user typed wrong -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("header", "row", "said"),
    [
        ("relative_humidity [%],young_modulus_layer [MPa]", (130, 20), ("relative_humidity", "130", "between 0 and 1")),
        ("relative_humidity [K],young_modulus_layer [MPa]", (50, 20), ("relative_humidity", "K")),
        ("relative_humidity [%],young_modulus_layer [um]", (50, 20), ("young_modulus_layer", "um", "Pa")),
        ("relative_humidity [%],young_modulus_layer", (50, 20), ("young_modulus_layer", "unit")),
        ("relative_humidity [%],young_modulus_layer [MPa]", (50, -20), ("young_modulus_layer", "> 0")),
    ],
)  # fmt: skip
def test_tables_that_cannot_be(capsys, tmp_path, header, row, said):
    outcome = run(capsys, "predict", "humid-air", "--conditions", table(tmp_path, header, row))
    assert outcome.status == 2
    assert outcome.output == ""
    for word in said:
        assert word in outcome.errors


@pytest.mark.parametrize(
    ("pair", "said"),
    [
        ("relative_humidity=130 %", "relative_humidity"),
        ("temperature=-5 degC", "from 273.15"),
        ("transition_humidity=1.0", "transition_humidity"),
        ("young_modulus_layer_wet=7", "young_modulus_layer_wet"),
    ],
)
def test_settings_that_cannot_be(capsys, pair, said):
    outcome = run(capsys, "predict", "humid-air", "--set", pair)
    assert outcome.status == 2
    assert said in outcome.errors


def test_a_modulus_and_its_curve_exclude_each_other(capsys):
    words = ("--set", "young_modulus_layer=7 MPa", "--set", "transition_humidity=0.6")
    outcome = run(capsys, "predict", "humid-air", *words)
    assert outcome.status == 2
    assert "exclude each other" in outcome.errors
