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


def test_the_program_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
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
    exec(blocks("python")[0], known)
    first, *people = capsys.readouterr().out.splitlines()
    assert first.startswith("cream/none: 0.7") and first.endswith("probability 1.00")
    assert len(people) == 7
    assert np.log(known["wide"][1] / known["wide"][0])[1] > np.log(known["wide"][1] / known["wide"][0])[0]
