"""Features of drying skin as data: the paper's run in words, peaks that are not there, no kinks, several observables."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.emulation import Box
from skinbayes.forward import forward_model
from skinbayes.forward.base import Tables
from skinbayes.problem import load_problem
from skinbayes.wetting import bridge_table, film_contact, skin_groups

PEAK = ("peak_time", "peak_friction", "peak_width")


def paper_inputs(**changed: float | list[float]) -> dict[str, np.ndarray]:
    problem = sb.load_problem("drying")
    inputs = {name: value for name, value in problem.inputs(np.zeros((1, 0))).items() if name != "time"}
    return {
        **inputs,
        **{name: np.atleast_2d(np.asarray(value, dtype=float)) for name, value in changed.items()},
    }


@pytest.mark.parametrize(
    ("closure", "time", "height", "width"),
    [("gaussian", 513.2, 2.31, 66.6), ("sharp", 492.5, 2.49, 55.9)],
)
def test_the_run_of_the_paper(closure: str, time: float, height: float, width: float) -> None:
    found = (
        forward_model("drying-features").with_options({"closure": closure}).evaluate(paper_inputs(), Tables())
    )
    # the features are those of the series of the same closure
    series = sb.load_problem("drying", settings={"closure": closure})
    clock = np.linspace(440.0, 560.0, 2401)
    given = {**paper_inputs(), "time": clock[np.newaxis]}
    friction = series.forward.evaluate(given, Tables())["friction_coefficient"][0]
    half = (friction.max() + found["wet_plateau"][0, 0]) / 2
    assert found["peak_time"][0, 0] == pytest.approx(clock[friction.argmax()], abs=0.06)
    assert found["peak_friction"][0, 0] == pytest.approx(friction.max(), rel=1e-6)
    assert found["peak_width"][0, 0] == pytest.approx(np.ptp(clock[friction > half]), abs=0.2)
    assert [found[name][0, 0] for name in PEAK] == pytest.approx([time, height, width], rel=0.005)
    # 90 um at 1.743e-7 m/s, put on after 30 s
    assert found["dry_time"][0, 0] == pytest.approx(30 + 90e-6 / 1.743e-7, rel=1e-12)
    assert found["dry_friction"][0, 0] == pytest.approx(0.3, rel=1e-3)


def test_rows_are_told_apart_and_deduplicated_rows_share_a_curve() -> None:
    model = forward_model("drying-features")
    angles = np.radians([0.0, 102.0, 0.0])
    found = model.evaluate(paper_inputs(contact_angle_counterface=angles), Tables())
    assert found["wet_plateau"].shape == (1, 3)
    for name in model.observables:
        assert found[name][0, 0] == found[name][0, 2] or name in PEAK
    assert np.isfinite(found["peak_time"][0, [0, 2]]).all()
    assert all(np.isnan(found[name][0, 1]) for name in PEAK)
    assert np.isfinite([found[name][0, 1] for name in ("wet_plateau", "dry_friction", "dry_time")]).all()


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"contact_angle_counterface": np.radians(102.0)}, "no capillary bridges"),
        ({"surface_tension": 1e-30, "contact_angle_counterface": np.radians(102.0)}, "no capillary bridges"),
        ({"hardening_film": 20e-6, "film_spread": 3e-6}, "hardening"),
        ({"initial_film": 3e-6}, "thinner than that of the peak"),
    ],
)
def test_what_is_missing_is_explained(changed: dict[str, float], words: str) -> None:
    inputs = paper_inputs(**changed)
    model = forward_model("drying-features")
    assert model.explain is not None
    said = model.explain(inputs, Tables())
    assert len(said) == 1 and words in said[0]
    missing = [bool(np.isnan(model.evaluate(inputs, Tables())[name])[0, 0]) for name in PEAK]
    assert missing == [words != "thinner than that of the peak"] * 3


def test_nothing_is_said_of_a_plain_peak() -> None:
    model = forward_model("drying-features")
    assert model.explain is not None
    assert model.explain(paper_inputs(), Tables()) == []


def test_latent_heat_slows_evaporation_down() -> None:
    model = forward_model("drying-features")
    weather = {"surface_temperature": 308.15, "air_temperature": 293.15, "relative_humidity": 0.5}
    inputs = {n: v for n, v in paper_inputs(**weather).items() if n != "evaporation_rate"}
    inputs["latent_heat"] = np.array([[2.272e6, 2.418e6]])
    lasts = model.evaluate({**inputs, "air_speed": np.zeros((1, 1))}, Tables())["dry_time"][0] - 30.0
    assert lasts[0] == pytest.approx(90e-6 / 1.747e-7, rel=1e-3)
    assert lasts[1] / lasts[0] == pytest.approx(2.418 / 2.272, rel=1e-12)


STEPS = {
    "evaporation_rate": 0.1, "initial_film": 0.1, "young_modulus_layer": 0.2, "surface_tension": 0.1, "rms_height": 0.1,
    "film_spread": 0.3, "yield_stress": 0.2, "frictional_shear_stress": 0.3,
}  # fmt: skip


@pytest.mark.parametrize("seed", range(3))
def test_features_have_no_kinks(seed: int) -> None:
    model, middle = forward_model("drying-features"), paper_inputs()
    direction = {n: w * np.random.default_rng([seed, i]).normal() for i, (n, w) in enumerate(STEPS.items())}

    def bends(count: int) -> np.ndarray:
        places = np.linspace(-0.1, 0.1, count)
        line = {n: middle[n] * np.exp(places[:, np.newaxis] * w) for n, w in direction.items()}
        found = model.evaluate({**middle, **line}, Tables())
        slopes = [np.diff(np.log(found[name][:, 0])) / np.diff(places) for name in model.observables]
        return np.array([np.max(np.abs(np.diff(slope))) / np.max(np.abs(slope)) for slope in slopes])

    coarse, fine = bends(31), bends(61)
    # where the gradient is continuous its changes halve with the step; a kink would keep its own
    assert np.all((fine < 0.65 * coarse) | (fine < 2e-3))


def test_four_numbers_in_words(tmp_path: Path) -> None:
    problem = sb.load_problem("drying-glass")
    assert problem.observables == ("wet_plateau", "dry_friction", "dry_time", "peak_width")
    theta = problem.prior_medians()
    found = problem.predict(theta)
    spread = {"wet_plateau": 0.1, "dry_friction": 0.05, "dry_time": 50.0, "peak_width": 50.0}
    told = {"wet_plateau": 1.4, "dry_friction": 0.3, "dry_time": 530.0, "peak_width": 100.0}
    expected = sum(
        -0.5 * ((told[n] - found[n][0]) / s) ** 2 - np.log(s) - 0.5 * np.log(2 * np.pi)
        for n, s in spread.items()
    )
    # the width of the peak comes from a table good to a few 1e-4
    assert problem.log_likelihood(theta) == pytest.approx(expected, abs=0.01)


def test_sharp_gaps_explain_the_same_words() -> None:
    sharp, smooth = (
        load_problem("drying-glass", settings={"closure": "sharp"}),
        sb.load_problem("drying-glass"),
    )
    assert sharp.fingerprint != smooth.fingerprint
    assert sharp.data_fingerprint == smooth.data_fingerprint
    assert sharp.names == smooth.names


def test_times_alone_do_not_ask_for_the_shear_stress() -> None:
    problem = sb.load_problem("drying-timing")
    assert problem.observables == ("dry_time", "peak_width")
    theta = problem.prior_medians()
    for shear_stress in ("1 MPa", "100 MPa"):
        other = load_problem("drying-timing", settings={"frictional_shear_stress": shear_stress})
        assert other.log_likelihood(theta) == problem.log_likelihood(theta)


def test_polypropylene_falls_without_a_peak() -> None:
    problem = sb.load_problem("drying-polypropylene")
    found = problem.predict(np.zeros(0))
    time, friction = problem.conditions.values["time"], found["friction_coefficient"]
    assert np.all(np.diff(friction[time > 31.0]) < 1e-9)
    assert friction[(time > 31.0) & (time < 450.0)] == pytest.approx(1.42, abs=0.005)
    assert friction[-1] == pytest.approx(0.3, rel=1e-3)


def test_a_table_of_bridges_stands_for_the_solutions(tmp_path: Path) -> None:
    problem = sb.load_problem("drying-glass")
    draws = problem.draw_prior(np.random.default_rng(3), 48)
    quick = problem.predict(draws)
    inputs = problem.inputs(draws)
    exact = problem.forward.evaluate(inputs, Tables())
    assert problem.model.accuracy and problem.model is not problem.forward
    for name in problem.forward.observables:
        wrong = np.abs(quick[name] / exact[name] - 1)
        assert np.nanquantile(wrong, 0.9) < 2e-3, name


def test_a_table_knows_its_box() -> None:
    from skinbayes.contact import LayeredSkin
    from skinbayes.roughness import SelfAffineSpectrum

    moduli = np.array([5e6, 9e6, 12e6])
    surface, skin = (
        SelfAffineSpectrum(
            rms_height=22.4e-6,
            hurst_exponent=0.78,
            wavevector_min=1e3,
            wavevector_rolloff=6.345e3,
            wavevector_max=1e9,
        ),
        LayeredSkin(young_modulus_layer=moduli, young_modulus_bulk=20e3, layer_thickness=20e-6),
    )
    load, height, wetting_tension = np.full(3, 6830.0), np.full(3, 22.4e-6), np.full(3, 0.0845)
    groups = skin_groups(
        load, wetting_tension, height=height, spectrum=surface, skin=skin, area_correction=np.array(0.42)
    )
    table = bridge_table(Box.around({n: x[:2] for n, x in groups.items()}), depth=6830.0 / 20e3 / 1e-7)
    assert table is not None
    assert table.covers(groups).tolist() == [True, True, False]

    def contact(table):
        return film_contact(
            6830.0,
            surface,
            skin=skin,
            surface_tension=0.0845,
            contact_angle_skin=np.pi / 2,
            contact_angle_counterface=0.0,
            young_modulus_layer_dry=1e9,
            yield_stress=50e6,
            table=table,
        )

    films = np.broadcast_to(np.linspace(0.3e-6, 12e-6, 40), (3, 40))
    with_table, without = (contact(t).average(films, np.array(1e-7))[0] for t in (table, None))
    np.testing.assert_allclose(with_table, without, rtol=2e-3)
    # what the table does not cover is solved as without it
    np.testing.assert_array_equal(with_table[2], without[2])
