"""Rows of the same conditions tell scatter from misfit: found where it is, and seldom where there is none."""

from __future__ import annotations

import json
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from skinbayes.fit import Fit, sample
from skinbayes.fit.misfit import conditions
from skinbayes.problem import load_problem
from skinbayes.report import digest, quality
from skinbayes.statistics.repeats import lack_of_fit

CONDITION = np.repeat(np.arange(8), 3)
"""Eight conditions, three rows each."""


def of_right_model(rng: np.random.Generator, sets: int) -> np.ndarray:
    """Residuals of data about a mean and of a scatter that the posterior knows badly."""
    scatter = np.exp(0.15 * rng.normal(size=(sets, 1)))
    return scatter * (rng.normal(size=(sets, 24)) + 0.2 * rng.normal(size=(sets, 1)))


def test_many_conditions_take_little_memory() -> None:
    """A matrix of rows times conditions would take 800 MB."""
    rows = 10_000
    condition = np.arange(rows) // 2 * 2 % (rows - 10)
    condition = np.unique(condition, return_inverse=True)[1]
    noise = np.random.default_rng(4).normal(size=(120, rows))
    tracemalloc.start()
    found = lack_of_fit(noise[0], noise[1:], condition)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert found is not None and found.degrees_of_freedom == rows - condition.max() - 1
    # residuals of rows that share a condition, one condition after the other
    within = sum(
        np.square(noise[0, condition == k] - noise[0, condition == k].mean()).sum() for k in range(50)
    )
    first = condition < 50
    part = lack_of_fit(noise[0, first], noise[1:, first], condition[first])
    assert part is not None and part.scatter == pytest.approx(np.sqrt(within / part.degrees_of_freedom))
    assert peak < 200e6


def test_a_right_model_is_seldom_suspected() -> None:
    found = 0
    for seed in range(300):
        data = of_right_model(np.random.default_rng(seed), 401)
        found += lack_of_fit(data[0], data[1:], CONDITION).found
    # 5 % of 300 are 15 ± 3.8
    assert 3 <= found <= 27


@pytest.mark.parametrize("size", [0.2, 5.0])
def test_misfit_is_found_whatever_scatter_was_fitted(size: float) -> None:
    """The simulated data may scatter more or less than the repeats: only the ratio counts."""
    found = 0
    for seed in range(50):
        rng = np.random.default_rng(seed)
        data = np.linspace(-1.5, 1.5, 8)[CONDITION] + 0.5 * rng.normal(size=24)
        one = lack_of_fit(data, size * of_right_model(rng, 400), CONDITION)
        found += one.found
        assert one.conditions == 8 and one.degrees_of_freedom == 16
    assert found >= 48


def test_the_numbers_are_those_of_an_analysis_of_variance() -> None:
    from scipy.stats import f_oneway

    rng = np.random.default_rng(5)
    data = rng.normal(size=24)
    data -= data.mean()
    # of equal widths the statistic is that of the F-test but for the degree of freedom of the mean
    simulated = rng.normal(size=(4000, 24))
    simulated /= simulated.std(axis=0)
    one = lack_of_fit(data, simulated, CONDITION)
    table = data.reshape(8, 3)
    assert one.scatter == pytest.approx(np.sqrt(table.var(axis=1, ddof=1).mean()), rel=1e-12)
    assert one.misfit == pytest.approx(np.sqrt(np.mean(table.mean(axis=1) ** 2)), rel=1e-12)
    assert one.allowed == pytest.approx(one.scatter / np.sqrt(3), rel=1e-12)
    f = f_oneway(*table).statistic
    assert one.misfit**2 * 24 / 7 / one.scatter**2 == pytest.approx(f, rel=1e-9)


def test_without_repeats_there_is_nothing_to_say() -> None:
    data = of_right_model(np.random.default_rng(1), 400)
    assert lack_of_fit(data[0], data[1:], np.arange(24)) is None
    assert lack_of_fit(data[0], data[1:], np.minimum(np.arange(24), 21)) is None  # two degrees of freedom
    assert lack_of_fit(np.zeros(24), data[1:], CONDITION) is None


MODEL = """
title = "A load series in pairs"
forward = "constant"
[data]
file = "pairs.csv"
observable = "friction_coefficient"
[parameters]
typical_friction_coefficient = { lognormal = [0.5, 1.0] }
[noise]
family = "lognormal"
noise_scale = { half_normal = 0.5 }
"""


def pairs(folder: Path, exponent: float) -> Fit:
    """Friction ∝ load^exponent with 5 % scatter, two rows at each of eight loads, for a model that knows no load."""
    rng = np.random.default_rng(2)
    load = np.repeat(np.geomspace(0.1, 3.0, 8), 2)
    friction = 0.5 * load**exponent * np.exp(0.05 * rng.normal(size=16))
    rows = [
        f"{x!r},{y!r},{i % 2}\n"
        for i, (x, y) in enumerate(zip(load.tolist(), friction.tolist(), strict=True))
    ]
    header = "normal_force [N],friction_coefficient [1],repetition\n"
    (folder / "pairs.csv").write_text(header + "".join(rows), encoding="utf-8")
    (folder / "pairs.toml").write_text(MODEL, encoding="utf-8")
    return sample(load_problem(folder / "pairs.toml"), seed=1, importance=True)


@pytest.mark.parametrize(("exponent", "misfit"), [(-0.2, True), (0.0, False)])
def test_terminal_page_and_json_say_it(exponent: float, misfit: bool, tmp_path: Path) -> None:
    fit = pairs(tmp_path, exponent)
    assert conditions(fit.problem).tolist() == np.repeat(np.arange(8), 2).tolist()
    one = fit.repeats["friction_coefficient"]
    assert one.found == misfit == quality.misfit(fit)
    assert one.scatter == pytest.approx(0.05, rel=0.6) and one.degrees_of_freedom == 8
    said = " ".join(quality.verdict(fit))
    assert ("MORE than repeats allow" if misfit else "no more than repeats allow") in said
    document = json.loads(json.dumps(digest(fit)))["repeats"]["friction_coefficient"]
    assert document["found"] == misfit and document["conditions"] == 8
