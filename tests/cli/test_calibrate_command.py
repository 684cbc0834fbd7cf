"""``skinbayes calibrate``: JSON document, page, table, and going on where it was."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import run

MODEL = """
format = 1
title = "Two data about a constant <b>"
description = "One number is measured twice with a known error; enough to see what a calibration prints, and quickly."
forward = "constant"
[data]
file = "mine.csv"
observable = "friction_coefficient"
[parameters]
typical_friction_coefficient = { uniform = [0, 1], source = "weak on purpose here" }
[noise]
family = "gaussian"
noise_scale = { fixed = 0.1, source = "known in this test" }
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    (tmp_path / "mine.csv").write_text("friction_coefficient [1]\n0.4\n0.5\n")
    path = tmp_path / "mine.toml"
    path.write_text(MODEL)
    return path


def test_document_page_and_table(capsys: pytest.CaptureFixture[str], model: Path, tmp_path: Path) -> None:
    page, folder = tmp_path / "page.html", tmp_path / "run"
    arguments = ("calibrate", model, "--ess", "100", "-o", folder)
    outcome = run(capsys, *arguments, "--simulations", "2", "--report", page, "--json")
    assert outcome.status == 0, outcome.errors
    document = outcome.document()
    entry = document["parameters"]["typical_friction_coefficient"]
    assert len(entry["ranks"]) == document["simulations"] == 2
    assert {"p", "coverage_50", "coverage_90"} <= set(entry)
    assert document["failed"] == 0
    text = page.read_text(encoding="utf-8")
    assert text.count("<figure") == 4
    assert "Nothing speaks against calibration in 2 simulations" in text
    # the same command goes on: two of three are there
    before = (folder / "simulations.jsonl").read_bytes()
    again = run(capsys, *arguments, "--simulations", "3")
    assert (folder / "simulations.jsonl").read_bytes().startswith(before)
    assert again.status == 0
    assert "in 3 simulations" in " ".join(again.output.split())
    assert "typical_friction_coefficient" in again.output


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["contact-area"], "nothing to infer"),
        (["forearm-glass", "finger-water"], "is not of the same data as"),
        (["forearm-glass", "--simulations", "0"], "--simulations"),
    ],
)
def test_what_cannot_be_done_is_explained(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, arguments: list[str], message: str
) -> None:
    outcome = run(capsys, "calibrate", *arguments, "-o", tmp_path / "run")
    assert outcome.status == 2
    assert message in outcome.errors
    assert not (tmp_path / "run").exists()
