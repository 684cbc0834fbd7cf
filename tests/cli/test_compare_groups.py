"""``compare`` of models of grouped data: whole groups left out, in words, in a table, as JSON and with refits."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_line import run

import skinbayes.comparison
from skinbayes.comparison import CrossCheck
from skinbayes.fit import sample
from skinbayes.problem import load_problem

MODEL = """
title = "People"
forward = "constant"
[data]
file = "people.csv"
observable = "friction_coefficient"
[parameters]
typical_friction_coefficient = { lognormal = [MEDIAN, 0.3] }
[noise]
family = "lognormal"
noise_scale = { half_normal = 0.5 }
[groups.person]
scale = 0.05
"""


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Five people, one of whom is unlike the others, in two models with other priors."""
    folder = tmp_path_factory.mktemp("people")
    values = 0.4 * np.exp(0.1 * np.random.default_rng(2).normal(size=(5, 5)))
    values[3] *= 3.0
    lines = [f"p{i},{value:.6f}" for i, row in enumerate(values) for value in row]
    (folder / "people.csv").write_text(
        "person,friction_coefficient [1]\n" + "\n".join(lines) + "\n", encoding="utf-8"
    )
    found = []
    for name, median in (("near", "0.4"), ("far", "0.1")):
        (folder / f"{name}.toml").write_text(MODEL.replace("MEDIAN", median), encoding="utf-8")
        problem = load_problem(folder / f"{name}.toml")
        sample(
            problem, seed=2, ess=1000, walkers=32, max_steps=800, importance=False, directory=folder / name
        )
        found.append(folder / name)
    return found


def test_groups_are_left_out(runs: list[Path], capsys: pytest.CaptureFixture[str]) -> None:
    outcome = run(capsys, "compare", *runs, "--no-refit", "--json")
    assert outcome.status == 0 and outcome.errors == ""
    near, far = sorted(outcome.document()["models"], key=lambda model: model["name"] != "near")
    for model in (near, far):
        entry = model["left_out"]["person"]
        assert {"elpd", "elpd_se", "difference", "difference_se", "unreliable_levels", "levels"} <= set(entry)
        assert set(entry["levels"]) == {f"p{i}" for i in range(5)}
        bad = [name for name, level in entry["levels"].items() if not level["reliable"]]
        assert entry["unreliable_levels"] == len(bad) and "p3" in bad
    assert near["left_out"]["person"]["difference"] == 0.0 > far["left_out"]["person"]["difference"]
    text = run(capsys, "compare", *runs, "--no-refit").output
    assert "one person left out at a time" in text
    assert "a person never measured" in " ".join(text.split())


def test_refits(runs: list[Path], capsys: pytest.CaptureFixture[str]) -> None:
    before = run(capsys, "compare", *runs, "--no-refit", "--json").document()["models"]
    outcome = run(capsys, "compare", *runs, "--json")
    assert outcome.status == 0
    for old, new in zip(before, outcome.document()["models"], strict=True):
        assert old["name"] == new["name"] and old["elpd_loo"] == new["elpd_loo"]
        for level, entry in new["left_out"]["person"]["levels"].items():
            previous = old["left_out"]["person"]["levels"][level]
            assert entry["refitted"] == (not previous["reliable"])
            assert (entry["elpd"] == previous["elpd"]) == previous["reliable"]


def test_blocks_and_the_cross_check(
    runs: list[Path], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        skinbayes.comparison, "cross_check", lambda fit, told: CrossCheck(fit.name, None, None, -1.5, 0.1)
    )
    asked = ("compare", *runs, "--no-refit", "--leave-out", "order in 5", "--leave-out", "person")
    document = run(capsys, *asked, "--json").document()
    entry = document["models"][0]["left_out"]
    # rows stand person by person, so that blocks of five are people: in closed form, and by the rule of products
    blocks, people = (entry[name]["levels"].values() for name in ("order in 5", "person"))
    for block, person in zip(blocks, people, strict=True):
        assert block["elpd"] == pytest.approx(person["elpd"], abs=1e-6) or not person["reliable"]
    outcome = run(capsys, *asked, "--cross-check")
    assert outcome.status == 0
    text = " ".join(outcome.output.split())
    assert "one block of rows left out at a time" in text
    assert "nested sampling gives ln Z" in text and "no evidence of its own" in text
    assert run(capsys, "compare", *runs, "--leave-out", "force in 3").status == 2
