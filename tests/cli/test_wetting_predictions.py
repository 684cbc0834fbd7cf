"""The paper's numbers for wet and drying skin (Sect. 5, Figs. 7–10) through the command line, and others besides."""

from __future__ import annotations

import math

import numpy as np
import pytest
from command_line import run
from plain_contact import PlainContact

from skinbayes.contact import LayeredSkin, gap_distribution, mean_separation
from skinbayes.roughness import SelfAffineSpectrum, named_surface
from skinbayes.wetting import capillary_state, drying_curve, film_contact

LOAD = 6830.0
NO_BRIDGES = "contact_angle_counterface=102 deg"


@pytest.fixture
def predict(capsys):
    def at(model: str, *pairs: str, rows=None) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        model, _, closure = model.partition(":")
        pairs = (*pairs, f"closure={closure}") if closure else pairs
        words = [word for pair in pairs for word in ("--set", pair)]
        words += [] if rows is None else ["--conditions", rows]
        outcome = run(capsys, "predict", model, "--json", *words)
        assert outcome.status == 0 and outcome.errors == ""
        found = outcome.document()
        return tuple({k: np.array(v) for k, v in found[key].items()} for key in ("conditions", "prediction"))

    return at


# -- capillary bridges ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("model", "angle", "strength", "film", "separation"),
    [
        ("capillary-film", 0, 0.62, 5.8e-6, 11.05e-6),
        ("capillary-film", 20, 0.585, 5.8e-6, 11.15e-6),
        ("capillary-film:sharp", 0, 0.75, 9.7e-6, 10.7e-6),
        ("capillary-film:sharp", 20, 0.705, 9.7e-6, 10.8e-6),
    ],
)
def test_skin_on_glass(predict, model, angle, strength, film, separation):
    rows, found = predict(model, f"contact_angle_counterface={angle} deg")
    films, reached = rows["film_thickness"], found["capillary_pressure"] / LOAD
    top = np.argmax(reached)
    assert reached[top] == pytest.approx(strength, abs=0.006)
    # the maximum is broad, most of all with sharp gaps, and the grid has steps of 0.25 µm
    assert films[top] == pytest.approx(film, abs=0.5e-6)
    assert found["mean_separation"][top] == pytest.approx(separation, abs=0.06e-6)
    assert found["mean_separation"][-1] == pytest.approx(13.5e-6, abs=0.05e-6)
    flooded = films > 13.55e-6
    assert np.all(reached[flooded] == 0)
    assert np.all(reached[~flooded] > 0)
    # nothing but water and contact where the gap is full
    np.testing.assert_allclose((found["wet_area"] + found["relative_contact_area"])[flooded], 1.0, rtol=1e-12)


def test_skin_on_polypropylene_has_no_bridges(predict):
    _, found = predict("capillary-film", NO_BRIDGES)
    assert np.all(found["capillary_pressure"] == 0)
    elastic, _ = PlainContact().area(LOAD)
    np.testing.assert_allclose(found["relative_contact_area"], elastic, rtol=1e-4)
    np.testing.assert_allclose(found["mean_separation"], 13.524e-6, rtol=1e-4)


OTHER_SKIN = {
    "thin film, stiff layer": ({"layer": 15e6, "bulk": 40e3, "thickness": 30e-6}, 12e3, 40, 10, 0.8e-6, 0.42),
    "rough, light load": ({"height": 35e-6, "hurst": 0.85, "nu_bulk": 0.45}, 3e3, 60, 30, 4e-6, 1.0),
    "soft, short waves": ({"layer": 4e6, "bulk": 10e3, "low": 2e3, "rolloff": 1e4}, 5e3, 85, 45, 6e-6, 0.5),
}  # fmt: skip
NAMES = {
    "layer": "young_modulus_layer={!r} Pa", "bulk": "young_modulus_bulk={!r} Pa",
    "thickness": "layer_thickness={!r} m", "nu_bulk": "poisson_ratio_bulk={!r}", "height": "rms_height={!r} m",
    "hurst": "hurst_exponent={!r}", "low": "wavevector_min={!r} 1/m", "rolloff": "wavevector_rolloff={!r} 1/m",
}  # fmt: skip


@pytest.mark.parametrize("closure", ["gaussian", "sharp"])
@pytest.mark.parametrize("case", OTHER_SKIN)
def test_other_skin_against_scalars_and_independent_code(predict, case, closure):
    plain, load, first, second, film, correction = OTHER_SKIN[case]
    words = [NAMES[name].format(value) for name, value in plain.items()]
    words += [f"nominal_pressure={load} Pa", f"area_correction={correction}", f"film_thickness={film!r} m"]
    words += [f"contact_angle_skin={first} deg", f"contact_angle_counterface={second} deg"]
    model = "capillary-film" if closure == "gaussian" else "capillary-film:sharp"
    found = {name: values[0] for name, values in predict(model, *words)[1].items()}
    body = PlainContact(**plain)
    skin = LayeredSkin(
        young_modulus_layer=body.layer,
        young_modulus_bulk=body.bulk,
        poisson_ratio_layer=body.nu_layer,
        poisson_ratio_bulk=body.nu_bulk,
        layer_thickness=body.thickness,
    )
    height = plain.get("height", 22.4e-6)
    surface = SelfAffineSpectrum(
        rms_height=height,
        hurst_exponent=body.hurst,
        wavevector_min=body.low,
        wavevector_rolloff=body.rolloff,
        wavevector_max=body.high,
    )
    state = capillary_state(
        film,
        load,
        spectrum=surface,
        skin=skin,
        surface_tension=0.072,
        contact_angle_skin=math.radians(first),
        contact_angle_counterface=math.radians(second),
        area_correction=correction,
        closure=closure,
    )
    for name, value in found.items():
        assert value == pytest.approx(getattr(state, name), rel=1e-9), name
    assert found["capillary_pressure"] > 0.1 * load
    # the water adds up, and the load carries the contact
    assert found["wet_area"] * found["mean_separation_wet"] == pytest.approx(film, rel=1e-9)
    pressure = load + found["capillary_pressure"]
    elastic, _ = body.area(pressure, correction=correction)
    assert found["relative_contact_area"] == pytest.approx(elastic, rel=2e-4)
    assert found["mean_separation"] == pytest.approx(
        mean_separation(pressure, surface, skin=skin, area_correction=correction), rel=1e-3
    )
    # Eqs. 5 to 7: the capillary pressure belongs to a Kelvin length up to which the gaps hold the water
    kelvin = (
        0.072
        * sum(map(math.cos, map(math.radians, (first, second))))
        * found["wet_area"]
        / found["capillary_pressure"]
    )
    gaps = gap_distribution(pressure, surface, skin=skin, area_correction=correction, closure=closure)
    water = gaps.cumulative(kelvin) - found["relative_contact_area"]
    assert water == pytest.approx(found["wet_area"], rel=1e-3)


def test_rows_that_differ_in_more_than_the_film(predict, tmp_path):
    films, loads = np.array([2.0, 9.0, 4.0, 6.0, 11.0]), np.array([5.0, 9.0, 5.0, 9.0, 5.0])
    rows = tmp_path / "rows.csv"
    lines = [f"{film},{load}" for film, load in zip(films, loads, strict=True)]
    rows.write_text(
        "\n".join(["film_thickness [um],nominal_pressure [kPa]", *lines]) + "\n", encoding="utf-8"
    )
    _, found = predict("capillary-film", rows=rows)
    for i, (film, load) in enumerate(zip(films, loads, strict=True)):
        alone = predict("capillary-film", f"film_thickness={film} um", f"nominal_pressure={load} kPa")[1]
        for name, values in found.items():
            assert values[i] == pytest.approx(alone[name][0], rel=1e-7), name


def test_a_film_too_thin_for_the_theory_is_one_message(capsys):
    outcome = run(capsys, "predict", "capillary-film", "--set", "film_thickness=0.001 nm")
    assert outcome.status == 2
    assert "relative_contact_area has no finite value" in outcome.errors


# -- drying --------------------------------------------------------------------------------------------------------------


def test_the_timeline_of_figure_7(predict):
    rows, found = predict("drying")
    time, friction = rows["time"], found["friction_coefficient"]
    before, flooded = time < 30, (time >= 30) & (time <= 465)
    np.testing.assert_allclose(friction[before], 0.300, atol=1e-3)
    np.testing.assert_allclose(friction[flooded], 1.42, atol=0.005)
    assert friction[time == 475] > 1.5
    top = np.argmax(friction)
    assert 2.3 < friction[top] < 2.4
    assert 490 <= time[top] <= 515
    # 30 s + 90 µm at 0.1743 µm/s = 546.4 s
    assert friction[time == 545] > 1
    np.testing.assert_allclose(friction[time >= 550], 0.300, atol=1e-3)
    np.testing.assert_allclose(friction, 15e6 / LOAD * found["relative_contact_area"], rtol=1e-12)
    np.testing.assert_allclose(
        found["film_thickness"][flooded], 90e-6 - 1.743e-7 * (time[flooded] - 30), rtol=1e-9
    )
    assert np.all(found["film_thickness"][before | (time >= 555)] < 1e-12)


def test_drying_on_polypropylene_has_no_peak(predict):
    rows, found = predict("drying", NO_BRIDGES)
    wet = rows["time"] >= 30
    assert np.all(np.diff(found["friction_coefficient"][wet]) < 1e-9)
    assert found["friction_coefficient"][wet][0] == pytest.approx(1.42, abs=0.005)


OTHER_DRYING = {
    "slow and stiff": {
        "young_modulus_layer": 12e6, "young_modulus_layer_dry": 0.4e9, "yield_stress": 30e6, "nominal_pressure": 9e3,
        "frictional_shear_stress": 8e6, "initial_film": 40e-6, "evaporation_rate": 0.9e-7, "wetting_time": 12.0,
        "film_spread": 0.6e-6, "contact_angle_counterface": 0.3, "hardening_film": None,
    },
    "hardening layer": {
        "young_modulus_layer": 5e6, "young_modulus_layer_dry": 2e9, "yield_stress": 80e6, "nominal_pressure": 4e3,
        "frictional_shear_stress": 20e6, "initial_film": 60e-6, "evaporation_rate": 1.4e-7, "wetting_time": 45.0,
        "film_spread": 0.3e-6, "contact_angle_counterface": 0.0, "hardening_film": 1.5e-6,
    },
}  # fmt: skip
UNITS = {
    "film": "m",
    "modulus": "Pa",
    "stress": "Pa",
    "pressure": "Pa",
    "time": "s",
    "angle": "rad",
    "spread": "m",
}


def words_of(case: dict[str, float | None]) -> list[str]:
    def unit(name: str) -> str:
        return "m/s" if name == "evaporation_rate" else next(u for key, u in UNITS.items() if key in name)

    return [f"{name}={value!r} {unit(name)}" for name, value in case.items() if value is not None]


@pytest.mark.parametrize("case", OTHER_DRYING)
def test_other_drying_against_scalars_and_independent_code(predict, case):
    given = OTHER_DRYING[case]
    rows, found = predict("drying", *words_of(given))
    time, friction = rows["time"], found["friction_coefficient"]
    layer, load, shear = (
        given[k] for k in ("young_modulus_layer", "nominal_pressure", "frictional_shear_stress")
    )
    skin, surface = (
        LayeredSkin(young_modulus_layer=layer, young_modulus_bulk=20e3, layer_thickness=20e-6),
        named_surface("paper_reference"),
    )
    contact = film_contact(
        load,
        surface,
        skin=skin,
        surface_tension=0.072,
        contact_angle_skin=math.radians(80),
        contact_angle_counterface=given["contact_angle_counterface"],
        young_modulus_layer_dry=given["young_modulus_layer_dry"],
        yield_stress=given["yield_stress"],
        hardening_film=given["hardening_film"],
    )
    for i in range(0, len(time), 7):
        one = drying_curve(
            time[i],
            given["wetting_time"],
            initial_film=given["initial_film"],
            evaporation_rate=given["evaporation_rate"],
            contact=contact,
            frictional_shear_stress=shear,
            nominal_pressure=load,
            film_spread=given["film_spread"],
        )
        for name, values in found.items():
            assert values[i] == pytest.approx(getattr(one, name), rel=1e-10, abs=1e-18), (name, time[i])
    # dry before and after, flooded in between, by other code
    dry = sum(
        PlainContact(layer=given["young_modulus_layer_dry"]).area(load, yield_stress=given["yield_stress"])
    )
    wet = sum(PlainContact(layer=layer).area(load, yield_stress=given["yield_stress"]))
    assert friction[0] == pytest.approx(shear * dry / load, rel=1e-4)
    gone = (
        time
        > given["wetting_time"]
        + (given["initial_film"] + 8 * given["film_spread"]) / given["evaporation_rate"]
    )
    assert gone.any()
    np.testing.assert_allclose(friction[gone], friction[0], rtol=1e-9)
    start = np.flatnonzero(time >= given["wetting_time"])[0]
    assert friction[start] == pytest.approx(shear * wet / load, rel=1e-4)
    assert friction.max() > 1.2 * friction[start]


def test_film_of_a_droplet_and_evaporation_into_a_room(predict):
    _, plain = predict("drying", "initial_film=78.125 um", "time=300 s")
    _, droplet = predict("drying", "droplet_volume=50 ul", "time=300 s")
    # 50 mm³ on 80 mm × 8 mm
    assert droplet["film_thickness"][0] == pytest.approx(plain["film_thickness"][0], rel=1e-12)
    _, room = predict("drying", "relative_humidity=50 %", "time=300 s")
    # (5.629 − 0.5 · 2.339) kPa · 8.9e-5 / 2.272e6, vapour pressures of tables for 35 and 20 °C
    rate = (5629 - 0.5 * 2339) * 8.9e-5 / 2.272e6
    assert room["film_thickness"][0] == pytest.approx(90e-6 - 270 * rate, rel=1e-4)
    _, windy = predict("drying", "relative_humidity=50 %", "air_speed=0.5 m/s", "time=200 s")
    rate *= (8.9e-5 + 0.5 * 7.8e-5) / 8.9e-5
    assert windy["film_thickness"][0] == pytest.approx(90e-6 - 170 * rate, rel=1e-4)


def test_two_ways_to_say_the_same_exclude_each_other(capsys):
    words = ("--set", "droplet_volume=50 ul", "--set", "initial_film=90 um")
    outcome = run(capsys, "predict", "drying", *words)
    assert outcome.status == 2
    assert "exclude each other" in outcome.errors


def test_series_of_two_runs_in_one_table(predict, tmp_path):
    rows = tmp_path / "runs.csv"
    times = (100.0, 500.0, 510.0, 530.0)
    lines = [f"{time},{rate}" for time in times for rate in (174.3, 180.0)]
    rows.write_text("\n".join(["time [s],evaporation_rate [nm/s]", *lines]) + "\n", encoding="utf-8")
    _, both = predict("drying", rows=rows)
    for start, rate in ((0, 174.3), (1, 180.0)):
        for i, time in enumerate(times):
            alone = predict("drying", f"evaporation_rate={rate} nm/s", f"time={time} s")[1]
            for name, values in both.items():
                assert values[start + 2 * i] == pytest.approx(alone[name][0], rel=1e-12)
