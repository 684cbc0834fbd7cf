"""The page and the document of grouped data with a baseline model, from the command line."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from command_line import run
from test_report_page import Page, words

from skinbayes.comparison import against_baselines
from skinbayes.comparison.verdicts import DOUBT, LOSES, Statement
from skinbayes.fit import load_fit, sample
from skinbayes.problem import load_problem
from skinbayes.report import write_report

SCATTER = """
[noise]
family = "lognormal"
noise_scale = { half_normal = 0.5 }
[groups.person]
scale = { half_normal = 0.5 }
[groups.liquid]
scale = { half_normal = 0.5 }
"""

LAW = """
baseline_models = ["null.toml"]
title = "A plateau and a rise"
forward = "stribeck-descriptive"
[data]
file = "curve.csv"
observable = "friction_coefficient"
[parameters]
plateau_friction_coefficient = { lognormal = [0.8, 0.3] }
transition_speed_viscosity_product = "5 mN/m"
transition_exponent = 2
rising_friction_coefficient = 0.05
rising_exponent = 0.5
normal_force = "1 N"
"""

NULL = """
title = "People and liquids"
forward = "constant"
[data]
file = "curve.csv"
observable = "friction_coefficient"
[parameters]
typical_friction_coefficient = { lognormal = [0.5, 1.0] }
"""


@pytest.fixture(scope="module")
def grouped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of three people with four liquids, whose friction does not follow the law."""
    folder = tmp_path_factory.mktemp("grouped")
    rng = np.random.default_rng(6)
    lines = ["person,liquid,friction_coefficient [1],speed_viscosity_product [N/m]"]
    for person in ("ann", "bob", "cyd"):
        for place, liquid in enumerate(("water", "cream", "honey", "<tar>")):
            product = 10.0 ** (place - 3) * np.exp(0.3 * rng.normal())
            friction = 0.5 * np.exp(0.1 * place + 0.1 * rng.normal())
            lines.append(f"{person},{liquid},{friction:.5g},{product:.5g}")
    (folder / "curve.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "law.toml").write_text(LAW + SCATTER, encoding="utf-8")
    (folder / "null.toml").write_text(NULL + SCATTER, encoding="utf-8")
    briefly = {"max_steps": 100, "ensembles": 2, "walkers": 32, "importance": False}
    sample(load_problem(folder / "law.toml"), directory=folder / "run", **briefly)
    return folder / "run"


def test_document_has_groups_validity_ridges_and_priors(
    grouped: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    outcome = run(capsys, "report", grouped, "--no-baselines", "--json", "-o", tmp_path / "page.html")
    document = outcome.document()
    assert outcome.status == 0 and document["baseline_models"] is None and document["validity"] == {}
    assert list(document["groups"]) == ["person", "liquid"]
    effects = document["groups"]["liquid"]["effects"]
    assert list(effects) == ["water", "cream", "honey", "<tar>"]
    assert all(entry["q05"] < entry["median"] < entry["q95"] for entry in effects.values())
    assert set(document["priors"]) == set(load_fit(grouped).names)
    assert not (grouped / "baselines").exists()


def test_page_shows_groups_and_escapes_their_names(grouped: Path, tmp_path: Path) -> None:
    text = write_report(load_fit(grouped), tmp_path / "page.html").read_text(encoding="utf-8")
    page = Page(text)
    said = words(page.text)
    assert [figure["id"] for figure in page.all("figure")] == [
        "data", "effects", "predictive", "by-person", "by-liquid", "profile-speed-viscosity-product", "residuals",
        "prior-posterior", "corner", "trace",
    ]  # fmt: skip
    for heading in ("How people differ:", "The theory's misfit from liquid to liquid:", "Beside the noise:"):
        assert heading in said
    assert "marks no predictions as doubtful" in said
    assert "&lt;tar&gt;" in text and "<tar>" not in text
    assert "Baseline models" not in said


def test_a_fit_that_loses_says_so_at_the_top(grouped: Path, tmp_path: Path) -> None:
    losing = SimpleNamespace(
        statements=lambda: [
            Statement("'law' LOSES to 'null' in predicting a left-out liquid, by 7.1 ± 2.3.", LOSES),
            Statement("'law' equals 'null' in predicting a left-out datum."),
            Statement("'law': 1 of 4 liquids cannot be estimated by importance sampling.", DOUBT),
        ],
        headers=lambda: ["model", "one liquid left out"],
        rows=lambda: [["law", "-9.1 ± 3.0"], ["<null>", "-2.0 ± 3.0"], ["noise floor", ""]],
    )
    text = write_report(load_fit(grouped), tmp_path / "page.html", losing).read_text(encoding="utf-8")
    said = words(Page(text).text)
    assert said.index("LOSES TO A BASELINE MODEL") < said.index("by 7.1 ± 2.3") < said.index("In short")
    assert said.count("by 7.1 ± 2.3") == 2 and said.count("'law' equals 'null'") == 1
    assert "How far these numbers can be trusted" in said and "&lt;null&gt;" in text


def test_baseline_models_are_fitted_once_and_shown(
    grouped: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    outcome = run(capsys, "report", grouped, "--json", "-o", tmp_path / "page.html")
    baseline_models = outcome.document()["baseline_models"]
    assert outcome.status == 0
    assert {entry["baseline_model"] for entry in baseline_models["ranking"]} == {"null"}
    said = words(Page((tmp_path / "page.html").read_text(encoding="utf-8")).text)
    for sentence in baseline_models["sentences"]:
        assert words(sentence) in said
    assert baseline_models["loses"] == ("LOSES TO A BASELINE MODEL" in said)
    stored = grouped / "baselines" / "null" / "result.nc"
    made = stored.stat().st_mtime_ns
    again = against_baselines(load_fit(grouped), grouped)
    assert again is not None and again.to_dict()["ranking"] == baseline_models["ranking"]
    assert stored.stat().st_mtime_ns == made
