"""A series of friction against time as data: parameters come back, the likelihood is smooth, batches are their rows.

The series are simulated here, with the noise that their model file states.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from small_models import write_model

import skinbayes as sb
from skinbayes.fit import sample
from skinbayes.problem import Problem, load_problem

FIXED = {
    "frictional_shear_stress": '"15 MPa"',
    "evaporation_rate": '"0.1743 um/s"',
    "young_modulus_layer": '"7 MPa"',
    "young_modulus_layer_dry": '"1 GPa"',
    "young_modulus_bulk": '"20 kPa"',
    "layer_thickness": '"20 um"',
    "yield_stress": '"50 MPa"',
    "nominal_pressure": '"6.83 kPa"',
    "surface_tension": '"72 mN/m"',
    "contact_angle_skin": '"80 deg"',
    "contact_angle_counterface": '"0 deg"',
    "wetting_time": '"30 s"',
    "initial_film": '"90 um"',
}
TRUTH = {
    "frictional_shear_stress": 15e6, "evaporation_rate": 1.743e-7, "young_modulus_layer": 7e6, "initial_film": 90e-6,
    "surface_tension": 0.072, "layer_thickness": 20e-6, "rms_height": 22.4e-6, "contact_angle_counterface": 0.1,
    "young_modulus_layer_dry": 1e9, "yield_stress": 50e6, "film_spread": 2e-7, "hardening_film": 1e-6,
    "noise_scale": 0.05, "evaporation_rate[left forearm]": 1.743e-7, "evaporation_rate[right forearm]": 1.9e-7,
}  # fmt: skip
NOISE = '{ half_normal = 0.2, source = "for the test" }'
TIMES = np.linspace(0.0, 708.0, 60)


def model(
    folder: Path, free: dict[str, str], times: np.ndarray = TIMES, labels: list[str] | None = None, noise: str = NOISE
) -> Problem:  # fmt: skip
    """A problem whose data were drawn from it at the true parameters, seed 3."""
    entries = {**FIXED, "noise_scale": noise, **free}
    scale = entries.pop("noise_scale")
    lines = "\n".join(f"{name} = {text}" for name, text in entries.items())
    path = write_model(
        folder,
        f'title = "A drop on skin"\nforward = "drying"\n'
        f'[data]\nfile = "mine.csv"\nobservable = "friction_coefficient"\n'
        f'[surface]\nname = "paper_reference"\n'
        f'[noise]\nfamily = "lognormal"\nnoise_scale = {scale}\n[parameters]\n{lines}\n',
    )

    def bound(friction: np.ndarray) -> Problem:
        site = labels or ["left forearm"] * len(times)
        rows = [f"{s},{t!r},{m!r}" for s, t, m in zip(site, times.tolist(), friction.tolist(), strict=True)]
        header = "body_site,time [s],friction_coefficient [1]"
        (folder / "mine.csv").write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
        return load_problem(path)

    blank = bound(np.ones(len(times)))
    return bound(blank.simulate(truth(blank), np.random.default_rng(3)))


def truth(problem: Problem) -> np.ndarray:
    return np.array([TRUTH[name] for name in problem.names])


def covers(fit: sb.Fit, problem: Problem, fraction: float = 0.99) -> None:
    for name, value in zip(problem.names, truth(problem), strict=True):
        low, high = np.quantile(fit.draws(name), [(1 - fraction) / 2, (1 + fraction) / 2])
        assert low < value < high, name


def test_rate_and_shear_stress_come_back(tmp_path: Path) -> None:
    problem = model(
        tmp_path,
        {
            "frictional_shear_stress": '{ lognormal = ["12 MPa", 0.5] }',
            "evaporation_rate": '{ lognormal = ["0.17 um/s", 0.15] }',
        },
    )
    fit = sample(problem, seed=1, ess=200, ensembles=2, walkers=32, block_steps=50, steps_over_tau=20)
    assert fit.converged
    covers(fit, problem)
    # 60 points of 5 % noise tell the level to 5 %/√60 and the time of the fall to about a step of 12 s in 516 s
    summary = fit.summary()
    spread = np.log(summary["q95"] / summary["q05"]) / 3.29
    assert spread["frictional_shear_stress"] == pytest.approx(0.05 / np.sqrt(60), rel=0.35)
    assert 1e-3 < spread["evaporation_rate"] < 12 / 516


LINES = {
    "evaporation_rate": '{ lognormal = ["0.17 um/s", 0.15] }',
    "initial_film": '{ lognormal = ["90 um", 0.2] }',
    "young_modulus_layer": '{ lognormal = ["7 MPa", 0.5] }',
    "surface_tension": '{ lognormal = ["70 mN/m", 0.1] }',
    "rms_height": '{ lognormal = ["22.4 um", 0.3] }',
    "contact_angle_counterface": '{ uniform = ["0 deg", "30 deg"] }',
    "film_spread": '{ lognormal = ["0.2 um", 0.5] }',
    "yield_stress": '{ lognormal = ["50 MPa", 0.4] }',
    "hardening_film": '{ lognormal = ["1 um", 0.5] }',
}


def worst_bend(problem: Problem, seed: int, reach: float) -> tuple[float, float]:
    """Largest change of the gradient of the log-likelihood between neighbours on a random line, at two spacings."""
    direction = np.random.default_rng(seed).normal(size=len(problem.names)) * reach

    def bend(count: int) -> float:
        places = np.linspace(-1.0, 1.0, count)
        value = problem.log_likelihood(truth(problem) * np.exp(places[:, np.newaxis] * direction))
        return float(np.max(np.abs(np.diff(np.diff(value) / np.diff(places)))))

    return bend(121), bend(241)


@pytest.mark.parametrize("seed", range(3))
def test_the_likelihood_has_no_kinks(seed: int, tmp_path: Path) -> None:
    free = {name: text for name, text in LINES.items() if name != "hardening_film"}
    coarse, fine = worst_bend(model(tmp_path, free), seed, 0.01)
    # where the gradient is continuous its changes halve with the step; a kink would keep its own
    assert fine < 0.6 * coarse


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "reach"), [(0, 0.01), (1, 0.01), (2, 0.02), (3, 0.02)])
def test_the_likelihood_of_a_hardening_layer_has_no_kinks(seed: int, reach: float, tmp_path: Path) -> None:
    coarse, fine = worst_bend(model(tmp_path, LINES), seed, reach)
    assert fine < 0.6 * coarse


def test_a_batch_and_its_rows_agree_to_the_last_bit(tmp_path: Path) -> None:
    problem = model(tmp_path, LINES, times=np.linspace(0.0, 600.0, 13))
    theta = truth(problem) * np.exp(0.1 * np.random.default_rng(5).normal(size=(7, len(problem.names))))
    batch, whole = problem.log_likelihood(theta, pointwise=True), problem.predict(theta)
    for i, one in enumerate(theta):
        np.testing.assert_array_equal(batch[i], problem.log_likelihood(one, pointwise=True))
        for name, values in problem.predict(one).items():
            np.testing.assert_array_equal(whole[name][i], values)


def test_two_runs_with_their_own_rate_in_one_table(tmp_path: Path) -> None:
    times = np.repeat(np.linspace(0.0, 560.0, 8), 2)
    sites = ["left forearm", "right forearm"] * 8
    free = (
        '{ by = "body_site", "left forearm" = { lognormal = ["0.17 um/s", 0.2] }, '
        '"right forearm" = { lognormal = ["0.19 um/s", 0.2] } }'
    )
    both = model(
        tmp_path, {"evaporation_rate": free, "young_modulus_layer": '{ lognormal = ["7 MPa", 0.5] }'}, times, sites
    )  # fmt: skip
    theta = truth(both) * np.exp(0.1 * np.random.default_rng(6).normal(size=(5, len(both.names))))
    found = both.predict(theta)
    for site in ("left forearm", "right forearm"):
        folder = tmp_path / site.split()[0]
        folder.mkdir()
        alone = model(
            folder,
            {
                "evaporation_rate": '{ lognormal = ["0.17 um/s", 0.2] }',
                "young_modulus_layer": '{ lognormal = ["7 MPa", 0.5] }',
            },
            times[::2],
        )
        columns = {"evaporation_rate": f"evaporation_rate[{site}]"}
        order = [both.names.index(columns.get(name, name)) for name in alone.names]
        rows = np.array(sites) == site
        for name, values in alone.predict(theta[:, order]).items():
            np.testing.assert_array_equal(found[name][:, rows], values)
    # one vector at a time, the groups of rows included
    for i, one in enumerate(theta):
        np.testing.assert_array_equal(
            both.log_likelihood(theta, pointwise=True)[i], both.log_likelihood(one, pointwise=True)
        )


def test_looking_at_a_series_before_sampling(tmp_path: Path) -> None:
    problem = model(tmp_path, {"evaporation_rate": '{ lognormal = ["0.17 um/s", 0.15] }'}, noise="0.05")
    curves = {profile.name: profile for profile in problem.forward.profiles}
    time, friction = problem.profile(curves["friction_coefficient_against_time"], truth(problem)[np.newaxis])
    predicted = problem.predict(truth(problem))["friction_coefficient"]
    # away from the steps a curve is the prediction at its rows
    flat = (TIMES > 40) & (TIMES < 530)
    np.testing.assert_allclose(np.interp(TIMES[flat], time, friction[0]), predicted[flat], rtol=0.02)
    assert time[0] < 30 and time[-1] > 550


def test_what_a_series_determines_is_found_without_a_word_from_numpy(tmp_path: Path) -> None:
    # some directions move for some draws of the prior only
    free = {name: text for name, text in LINES.items() if name not in ("hardening_film", "surface_tension")}
    problem = model(tmp_path, {**free, "frictional_shear_stress": '{ loguniform = ["0.5 MPa", "500 MPa"] }'})
    said = " ".join(problem.check().sentences())
    # the exponents lie at the edge of what is called a ratio, and the last bits of a processor decide
    assert re.search("frictional_shear_stress (/|and) yield_stress", said)
    assert "nan" not in said
