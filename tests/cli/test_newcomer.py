"""What a newcomer sees: names of curves, lists that fit the terminal, messages about files that are not there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.cli.output import print_table
from skinbayes.errors import InputError
from skinbayes.plot.profile_bands import _in_common, _load
from skinbayes.problem.inputs import Conditions


def _conditions() -> Conditions:
    return Conditions(
        {"sphere_radius": np.array([4e-3, 4e-3, 8e-3, 8e-3])},
        {"state": np.array(["dry", "wet", "dry", "wet"]), "body_site": np.array(["arm"] * 4)},
        4,
    )


@pytest.mark.parametrize(
    ("rows", "said"), [([0, 2], "dry"), ([1, 3], "wet"), ([0, 1], "R = 4 mm"), ([0, 3], "")]
)
def test_rows_are_named_by_what_only_they_share(rows: list[int], said: str) -> None:
    assert _in_common(_conditions(), rows) == said


def test_a_pressure_that_varies_along_a_curve_is_not_given_as_one(tmp_path: Path) -> None:
    data = tmp_path / "loads.csv"
    rows = "".join(f"dry,{load},8,0.3\nwet,{load},8,1.4\n" for load in (100, 200, 400))
    data.write_text("state,normal_force [mN],sphere_radius [mm],friction_coefficient [1]\n" + rows)
    problem = sb.load_problem("forearm-glass", data=data)
    middle = problem.prior_medians()[np.newaxis]
    assert _load(problem, middle, [0, 2, 4]) == ""
    assert "kPa" in _load(problem, middle, [0, 1])


def test_a_data_file_that_is_not_there_is_met_with_the_one_beside_it(tmp_path: Path) -> None:
    (tmp_path / "load.csv").write_text("state\n")
    with pytest.raises(InputError, match=r"nor an existing file\. Did you mean 'load.csv'"):
        sb.load_problem("forearm-glass", data=tmp_path / "load2.csv")


def test_a_table_too_wide_is_a_list_whose_lines_end_with_words(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    print_table(("name", "value", "text"), [("a" * 25, "b" * 25, "one two three four five six seven eight")])
    print_table(("name", "value"), [("a", "b"), ("long", "c")])
    lines = capsys.readouterr().out.splitlines()
    assert [line for line in lines if line != line.rstrip()] == []
    assert lines[0].startswith("name: ") and lines[1].startswith("  value: ")
    assert all(line.startswith("  ") for line in lines[1:4])
