"""The elastomers: the shipped models are those whose numbers the pages give, and the power law is what it says."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.files.modelfile import load_model

DOCS = Path(__file__).parents[2] / "docs"


def test_the_shipped_model_is_that_of_the_page_on_evidence(tmp_path: Path) -> None:
    page = (DOCS / "evidence.md").read_text(encoding="utf-8")
    plain, curve = re.findall(r"^```toml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    (tmp_path / "dragon.toml").write_text(plain + curve, encoding="utf-8")
    shipped, paged = sb.load_problem("elastomer-dragon-skin"), sb.load_problem(tmp_path / "dragon.toml")
    theta = shipped.draw_prior(np.random.default_rng(1), 20)
    assert shipped.names == paged.names
    np.testing.assert_array_equal(shipped.log_posterior(theta), paged.log_posterior(theta))


def test_both_have_the_power_law_beside_them_and_it_is_one() -> None:
    for name, rows in (("elastomer-dragon-skin", 70), ("elastomer-sil-950", 59)):
        assert load_model(name).baseline_models == ("elastomer-power-law",)
        assert sb.load_problem(name).conditions.n_rows == rows
    problem = sb.load_problem("elastomer-power-law")
    values = {"typical_friction_coefficient": 2.0, "covariate_exponent[load]": -0.25}
    theta = problem.prior_medians()
    for name, value in values.items():
        theta[problem.names.index(name)] = value
    load = problem.conditions.covariates["normal_force"]
    np.testing.assert_allclose(problem.predict_data(theta), 2.0 * (load / 0.1) ** -0.25, rtol=1e-12)


def test_saturation_alone_falls_at_last_as_one_over_the_load() -> None:
    """What the page holds the data against: from 650 to 700 mN friction falls as the load to the power -0.67, not -1."""
    problem = sb.load_problem("elastomer-dragon-skin")
    theta = problem.prior_medians()
    theta[problem.names.index("rms_height")] = 1e-6
    friction, load = problem.predict_data(theta), problem.conditions.values["normal_force"]
    assert np.log(friction[69] / friction[64]) / np.log(load[69] / load[64]) == pytest.approx(-1, abs=0.01)
    data = problem.observations[0].values
    assert np.log(data[69] / data[64]) / np.log(load[69] / load[64]) == pytest.approx(-0.67, abs=0.005)


@pytest.mark.slow
def test_the_evidence_of_the_power_law_is_that_of_the_page() -> None:
    page = (DOCS / "elastomers.md").read_text(encoding="utf-8")
    shown = re.search(r"\| power law, with a curve \| ([\d.]+) \|[^|]*\| m = (-[\d.]+) ", page)
    assert shown is not None
    fit = sb.sample(sb.load_problem("elastomer-power-law"), seed=2)
    assert fit.converged
    assert fit.provenance["sampling"]["log_evidence"][0] == pytest.approx(float(shown[1]), abs=0.05)
    assert fit.summary().loc["covariate_exponent[load]", "median"] == pytest.approx(
        float(shown[2]), abs=0.015
    )
