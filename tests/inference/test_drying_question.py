"""Does the peak need capillary bridges? Comparison finds the model that made the series, in both directions."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from small_models import write_model

from skinbayes.comparison import compare, stacking_weights
from skinbayes.comparison.scores import score
from skinbayes.fit import Fit, sample
from skinbayes.problem import Problem, load_problem

PAGE = Path(__file__).parents[2] / "docs" / "drying.md"
NO_BRIDGES = '{ fixed = "112 deg", source = "no bridges: the cosines sum to less than 0" }'
HARDENING = '{ lognormal = ["1 um", 0.7], source = "unknown" }'
TRUTH = {
    "frictional_shear_stress": 15e6, "evaporation_rate": 1.743e-7, "initial_film": 90e-6, "young_modulus_layer": 7e6,
    "yield_stress": 50e6, "rms_height": 22.4e-6, "contact_angle_counterface": 0.2, "film_spread": 3e-7,
    "hardening_film": 1e-6, "noise_scale": 0.06, "contact_angle_skin": 1.3963,
}  # fmt: skip
KNOWN = {
    "young_modulus_layer": "7 MPa", "yield_stress": "50 MPa", "rms_height": "22.4 um", "initial_film": "90 um",
    "film_spread": "0.3 um", "contact_angle_skin": "80 deg",
}  # fmt: skip


def page_model(bridges: bool, fixed: dict[str, str]) -> str:
    """The model file of the page, changed as the page says."""
    text = re.findall(r"^```toml\n(format = 1.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)[0]
    for name, value in fixed.items():
        text = re.sub(rf"^{name} = .*$", f'{name} = "{value}"', text, flags=re.M)
    if bridges:
        return text
    text = re.sub(
        r"^contact_angle_counterface = .*$", f"contact_angle_counterface = {NO_BRIDGES}", text, flags=re.M
    )
    return text.replace("[parameters]\n", f"[parameters]\nhardening_film = {HARDENING}\n")


def write_series(folder: Path, times: np.ndarray, friction: np.ndarray) -> None:
    rows = [f"{t!r},{m!r}" for t, m in zip(times.tolist(), friction.tolist(), strict=True)]
    text = "\n".join(["time [s],friction_coefficient [1]", *rows])
    (folder / "my-series.csv").write_text(text + "\n", encoding="utf-8")


def both(folder: Path, times: np.ndarray, made_by: str, fixed: dict[str, str]) -> dict[str, Problem]:
    """The two models of one series, which one of them made."""
    write_series(folder, times, np.ones(times.size))
    paths = {
        name: write_model(folder, page_model(name == "bridges", fixed), f"{name}.toml")
        for name in ("bridges", "hardening")
    }
    maker = load_problem(paths[made_by])
    truth = np.array([TRUTH[name] for name in maker.names])
    write_series(folder, times, maker.simulate(truth, np.random.default_rng(2)))
    return {name: load_problem(path) for name, path in paths.items()}


def best(fits: dict[str, Fit]) -> tuple[str, float, float]:
    """Best model, and by how much in units of the standard error, and its stacking weight."""
    result = compare(list(fits.values()), refit=False)
    # `compare` leaves weights blank where a term is unreliable, and refits of these models take minutes
    weights = dict(
        zip(fits, stacking_weights(np.stack([score(f).single.pointwise for f in fits.values()])), strict=True)
    )
    first, second = sorted(result.models, key=lambda model: -model.elpd_loo)
    return first.name, abs(second.elpd_difference) / second.elpd_difference_se, weights[first.name]


# before the drop, flooded, and closely about the fall
TIMES = np.concatenate([[5.0, 15.0], np.arange(100.0, 440.0, 60.0), np.arange(450.0, 580.0, 10.0)])


@pytest.mark.parametrize("made_by", ["bridges", "hardening"])
def test_the_model_that_made_the_series_is_found(made_by: str, tmp_path: Path) -> None:
    problems = both(tmp_path, TIMES, made_by, {**KNOWN, "contact_angle_counterface": "10 deg"})
    fits = {
        name: sample(problem, seed=1, ess=100, ensembles=2, walkers=16, block_steps=50, max_steps=100)
        for name, problem in problems.items()
    }
    name, errors, weight = best(fits)
    assert name == made_by
    assert errors > 2
    assert weight > 0.9


@pytest.mark.slow
@pytest.mark.parametrize("made_by", ["bridges", "hardening"])
def test_so_it_is_with_all_that_the_page_leaves_free(made_by: str, tmp_path: Path) -> None:
    times = np.concatenate([np.linspace(0.0, 25.0, 4), np.linspace(40.0, 600.0, 56)])
    problems = both(tmp_path, times, made_by, {})
    fits = {name: sample(problem, seed=1, ess=400, max_steps=2000) for name, problem in problems.items()}
    # the tail of hardening_film takes long where that model is wrong; the comparison does not hang on it
    assert fits[made_by].converged
    name, errors, weight = best(fits)
    assert name == made_by and weight > 0.9
    if made_by == "bridges":
        assert errors > 2
    else:
        # bridges are pale on a skin that is rough enough: prediction alone then hardly tells them from none, but such
        # a skin contradicts its prior, as the page says
        assert errors > 1
        highest = problems["bridges"].prior_transform(np.full(problems["bridges"].dimension, 0.95))
        rough = problems["bridges"].names.index("rms_height")
        assert np.quantile(fits["bridges"].draws("rms_height"), 0.05) > highest[rough]
    # what made the series is found again
    fit, problem = fits[made_by], problems[made_by]
    for parameter in problem.names:
        low, high = np.quantile(fit.draws(parameter), [0.005, 0.995])
        assert low < TRUTH[parameter] < high, parameter


def test_the_page_is_a_model_that_can_be_checked(tmp_path: Path) -> None:
    lines = re.findall(r"^```\n(time \[s\].*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)[0]
    (tmp_path / "my-series.csv").write_text(lines, encoding="utf-8")
    problem = load_problem(write_model(tmp_path, page_model(True, {})))
    assert problem.observed is not None and problem.observed.tolist() == [0.31, 0.29, 1.38, 1.45]
    assert np.isfinite(
        problem.forward.evaluate(problem.inputs(problem.prior_medians()[None]), problem.tables)[
            "friction_coefficient"
        ]
    ).all()
    # the hardening model of the page has no peak, the plain one has
    write_series(tmp_path, np.linspace(440.0, 620.0, 91), np.ones(91))
    for bridges in (True, False):
        problem = load_problem(write_model(tmp_path, page_model(bridges, KNOWN)))
        theta = np.array([TRUTH[name] for name in problem.names])[None]
        found = problem.forward.evaluate(problem.inputs(theta), problem.tables)["friction_coefficient"][0]
        assert (found.max() > 1.2 * found[0]) == bridges
        assert found[-1] == pytest.approx(0.3, rel=1e-3)
