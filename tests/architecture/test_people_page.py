"""The page on people says what is so: its model file is read, its program runs, its limits are limits."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from source_tree import ROOT

import skinbayes as sb

PAGE = (ROOT / "docs" / "people.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    found = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    return [text for word, text in found if word == language]


SAMPLED = "sb.sample(problem, seed=1, ess=100)"


@pytest.mark.parametrize(
    "sampled",
    [
        # a draft of the same program: enough for what it prints, not for the rule of convergence
        pytest.param(SAMPLED.replace("ess=100", "max_steps=100"), id="draft"),
        pytest.param(SAMPLED, id="as printed", marks=pytest.mark.slow),
    ],
)
def test_the_program_runs(
    sampled: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "cream.toml").write_text(blocks("toml")[0], encoding="utf-8")
    (tmp_path / "cream.csv").write_text(blocks("")[0], encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    problem = sb.load_problem("cream.toml")
    said = " ".join(problem.check().sentences())
    assert "6 of 6 levels of person were measured with and without the treatment" in said
    found = re.findall(r"`((?:population_scale|contrast)\[.*?\])`", PAGE)
    assert len(found) == 2 and set(found) <= set(problem.names)
    known: dict[str, np.ndarray] = {}
    (program,) = blocks("python")
    assert SAMPLED in program
    exec(program.replace(SAMPLED, sampled), known)
    assert known["fit"].converged or sampled != SAMPLED
    first, *people = capsys.readouterr().out.splitlines()
    assert first.startswith("cream/none: 0.7")
    # 100 steps hold on to where they began, which is wider than the posterior
    probability = float(first.rpartition("lower with probability ")[2])
    assert probability == 1.0 if sampled == SAMPLED else probability > 0.95
    assert len(people) == 7
    assert np.log(known["wide"][1] / known["wide"][0])[1] > np.log(known["wide"][1] / known["wide"][0])[0]
