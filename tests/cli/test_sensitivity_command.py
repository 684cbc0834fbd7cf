"""``sensitivity``: what it prints, as text and as JSON, and where it cannot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_line import run
from linear_in_logarithms import Known

from skinbayes.fit import sample
from skinbayes.problem import load_problem


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    fit = sample(load_problem("finger-water"), ess=500, importance=True)
    return fit.save(tmp_path_factory.mktemp("run") / "fit.nc")


def test_text_has_a_row_for_each_prior_and_says_what_it_means(saved, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "170")  # a table, which a narrow terminal has no room for
    done = run(capsys, "sensitivity", saved)
    assert done.status == 0 and done.errors == ""
    for name in (*load_problem("finger-water").names, "all together"):
        assert f"\n {name} " in done.output
    assert (
        "a power near 1" in " ".join(done.output.split()) and "ln of the evidence changes by" in done.output
    )


def test_json_has_every_change_of_every_parameter(saved, capsys):
    document = run(capsys, "sensitivity", saved, "--json").document()
    assert document["model"] == "finger-water" and len(document["changed"]) == 12
    known = next(entry for entry in document["changed"] if entry["reliable"])
    assert len(known["shifts"]) == 5 and len(document["informed"]) == 5
    # a prior of three decades, stated for the logarithm, that the data cut down: half of it costs half the width
    narrower = document["changed"][0]
    assert narrower["labels"] == ["frictional_shear_stress"] and narrower["factor"] == 0.5
    assert narrower["log_evidence_change"] == pytest.approx(np.log(2.0), abs=0.1)


def test_without_model_or_data_it_says_so(tmp_path, capsys):
    path = Known().fit(500).save(tmp_path / "gone.nc")
    done = run(capsys, "sensitivity", path)
    assert done.status == 2 and "its model or data are gone" in done.errors
