"""``skinbayes digitised``: from a synthetic figure to a data set that loads; the points lie on a formula."""

from __future__ import annotations

import hashlib
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import Outcome, run

from skinbayes.errors import InputError
from skinbayes.files import load_dataset

ABSCISSA = [1e-2, 1e-1, 1.0, 10.0]
AXES = ("--abscissa", "speed_viscosity_product [mN/m]", "--ordinate", "friction_coefficient [1]")
ERRORS = ("--abscissa-error", "2 %", "--ordinate-error", "0.03")


def ordinate(abscissa: float, shift: float) -> float:
    return 0.5 + shift - 0.1 * math.log10(abscissa)


def series(name: str, shift: float) -> dict[str, Any]:
    """100 pixels for each decade from 1e-3, 200 for each unit of the ordinate."""
    points = [(x, ordinate(x, shift)) for x in ABSCISSA]
    data = [{"x": 50 + 100 * (math.log10(x) + 3), "y": 450 - 200 * y, "value": [x, y]} for x, y in points]
    return {"name": name, "axesName": "XY", "data": data}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the same figure as a project and as CSV files."""
    calibration = [
        {"px": px, "py": py, "dx": dx, "dy": dy}
        for px, py, dx, dy in ((50, 450, "1e-3", "0"), (650, 450, "1e3", "0"), (50, 450, "1e-3", "0"), (50, 50, "1e-3", "2"))
    ]  # fmt: skip
    axes = {"name": "XY", "type": "XYAxes", "isLogX": True, "isLogY": False, "calibrationPoints": calibration}
    sets = [series("circles", 0.0), series("a=b", 0.2)]
    content = {"version": [4, 2], "axesColl": [axes], "datasetColl": sets}
    (tmp_path / "wpd.json").write_text(json.dumps(content))
    (tmp_path / "circles.csv").write_text("".join(f"{x!r},{ordinate(x, 0.0)!r}\n" for x in ABSCISSA))
    logs = "".join(f"{math.log10(x)!r}\t{ordinate(x, 0.0)!r}\n" for x in ABSCISSA)
    (tmp_path / "logs.csv").write_text(logs)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_project_becomes_a_data_set(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    done = run(
        capsys, "digitised", "wpd.json", *AXES, "--set-name", "circles", "--constant", "sphere_radius=8 mm",
        "--constant", "liquid=glycerol", "-o", "ball.csv",
    )  # fmt: skip
    assert done.status == 0 and "ball.csv (4 rows)" in done.output
    assert "2.3 % of the value" in done.output and "0.005, which is 1 pixel" in done.output
    header = (folder / "ball.csv").read_text().splitlines()[0]
    assert header == (
        "speed_viscosity_product [N/m],speed_viscosity_product_standard_deviation [N/m],"
        "friction_coefficient [1],friction_coefficient_standard_deviation [1],sphere_radius [m],liquid"
    )
    data = load_dataset("ball.csv")
    product = np.asarray(data.columns["speed_viscosity_product"])
    assert product == pytest.approx(1e-3 * np.array(ABSCISSA), rel=1e-8)
    spread = np.asarray(data.columns["speed_viscosity_product_standard_deviation"])
    assert spread == pytest.approx(product * math.log(10) / 100, rel=1e-5)
    assert data.columns["friction_coefficient"] == pytest.approx([ordinate(x, 0.0) for x in ABSCISSA])
    assert data.columns["friction_coefficient_standard_deviation"] == pytest.approx(np.full(4, 1 / 200))
    assert data.columns["sphere_radius"].tolist() == [0.008] * 4
    assert data.labels("liquid") == ("glycerol",)


def test_a_folder_is_a_data_set_once_its_origin_is_known(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ("digitised", "wpd.json", *AXES, "--set-name", "circles", "-o", "ball")
    assert run(capsys, *arguments).status == 0
    assert load_dataset("ball/data.csv").n_rows == 4
    with pytest.raises(InputError, match=r"provenance\.toml, line \d+: title"):
        load_dataset("ball")
    origin = folder / "ball" / "provenance.toml"
    text = origin.read_text()
    assert "doi = []" in text and "10." not in text.split("how_read")[0]
    for key in ("title", "where", "licence", "digitised_by"):
        assert f'{key} = ""' in text
        text = text.replace(f'{key} = ""', f'{key} = "made up for a test"')
    origin.write_text(text.replace("authors = []", 'authors = ["A. Author"]'))
    provenance = load_dataset("ball").provenance
    assert provenance is not None and provenance.digitised_by == "made up for a test"
    export = hashlib.sha256((folder / "wpd.json").read_bytes()).hexdigest()
    assert export in provenance.how_read and "'circles'" in provenance.how_read
    assert "mN/m to N/m" in provenance.transformation and "1 pixel" in provenance.spread
    # written again, the data change and the completed origin stays
    assert run(capsys, *arguments).status == 2
    again = run(capsys, *arguments, "--pixel-error", "3", "--overwrite")
    assert again.status == 0 and "kept as it was" in again.output
    assert "made up for a test" in origin.read_text()
    new = hashlib.sha256((folder / "ball" / "data.csv").read_bytes()).hexdigest()
    assert new in again.output
    with pytest.raises(InputError, match="sha256"):
        load_dataset("ball")


def test_several_data_sets_get_labels(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    done = run(
        capsys, "digitised", "wpd.json", *AXES, "--set-name", "a=b", "--set-name", "circles=young",
        "--label-column", "person", "-o", "both.csv", "--json",
    )  # fmt: skip
    document = done.document()
    assert document["sets"] == {"a=b": 4, "young": 4} and document["rows"] == 8
    assert document["columns"]["person"] == ["a=b"] * 4 + ["young"] * 4
    assert document["units"]["speed_viscosity_product"] == "N/m"
    assert document["sha256"] == load_dataset("both.csv").sha256
    assert load_dataset("both.csv").labels("person") == ("a=b", "young")


def test_a_csv_needs_stated_errors(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    refused = run(capsys, "digitised", "circles.csv", *AXES, "-o", "new.csv")
    assert refused.status == 2 and "--abscissa-error" in refused.errors
    half = run(capsys, "digitised", "circles.csv", *AXES, *ERRORS[:2], "-o", "new.csv")
    assert half.status == 2 and "--ordinate-error" in half.errors
    assert not (folder / "new.csv").exists()
    assert run(capsys, "digitised", "circles.csv", *AXES, *ERRORS, "-o", "new.csv").status == 0
    data = load_dataset("new.csv")
    product = np.asarray(data.columns["speed_viscosity_product"])
    assert data.columns["speed_viscosity_product_standard_deviation"] == pytest.approx(0.02 * product)
    assert data.columns["friction_coefficient_standard_deviation"] == pytest.approx(np.full(4, 0.03))


def test_an_export_of_logarithms(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    common = (*AXES, "--logarithmic-abscissa")
    assert run(capsys, "digitised", "logs.csv", *common, *ERRORS, "-o", "new.csv").status == 0
    data = load_dataset("new.csv")
    assert data.columns["speed_viscosity_product"] == pytest.approx(1e-3 * np.array(ABSCISSA), rel=1e-8)
    assert "10 to the power of the values read" in (folder / "new.provenance.toml").read_text()
    twice = run(capsys, "digitised", "wpd.json", *common, "--set-name", "circles", "-o", "other.csv")
    assert twice.status == 2 and "leave out --logarithmic-abscissa" in twice.errors


def test_alone_it_lists_what_there_is(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    listed = run(capsys, "digitised", "wpd.json")
    assert listed.status == 0 and "circles" in listed.output and "log, linear" in listed.output
    document = run(capsys, "digitised", "wpd.json", "--json").document()
    assert [one["name"] for one in document["sets"]] == ["circles", "a=b"]
    assert document["sets"][0]["minimum"] == pytest.approx([1e-2, ordinate(10.0, 0.0)])
    assert run(capsys, "digitised", "circles.csv", "--json").document()["sets"][0]["axes"] is None


REFUSED: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "no output": (("wpd.json", *AXES), ("--output missing",)),
    "no ordinate": (("wpd.json", *AXES[:2], "-o", "n.csv"), ("--ordinate missing",)),
    "unknown quantity": (
        ("wpd.json", "--abscissa", "speed_viscosity [N/m]", *AXES[2:], "-o", "n.csv"),
        ("--abscissa", "'speed_viscosity'", "Did you mean 'speed_viscosity_product'"),
    ),
    "no unit": (("wpd.json", "--abscissa", "time", *AXES[2:], "-o", "n.csv"), ("'time' has no unit", "[s]")),
    "wrong unit": (
        ("wpd.json", "--abscissa", "time [mm]", *AXES[2:], "-o", "n.csv"), ("wrong dimension", "a time in s")
    ),
    "same quantity": (
        ("circles.csv", "--abscissa", "time [s]", "--ordinate", "time [s]", *ERRORS[:2], "--ordinate-error", "1 s",
         "-o", "n.csv"),
        ("both 'time'",),
    ),
    "two data sets without label": (("wpd.json", *AXES, "-o", "n.csv"), ("2 data sets", "--label-column", "person")),
    "unknown label column": (
        ("wpd.json", *AXES, "--label-column", "load", "-o", "n.csv"), ("'load'", "Did you mean 'normal_force'")
    ),
    "same label twice": (
        ("wpd.json", *AXES, "--set-name", "circles=x", "--set-name", "a=b=x", "--label-column", "person", "-o", "n.csv"),
        ("the same label",),
    ),
    "unknown data set": (("wpd.json", *AXES, "--set-name", "squares", "-o", "n.csv"), ("'squares'", "'circles'")),
    "pixels of a csv": (
        ("circles.csv", *AXES, "--pixel-error", "1", "-o", "n.csv"), ("--pixel-error", "holds no pixels")
    ),
    "pixels and stated errors": (
        ("wpd.json", *AXES, *ERRORS, "--set-name", "circles", "--pixel-error", "1", "-o", "n.csv"), ("one or the other",)
    ),
    "negative pixels": (("wpd.json", *AXES, "--pixel-error", "-1", "-o", "n.csv"), ("--pixel-error", "x>0")),
    "odd constant": (
        ("circles.csv", *AXES, *ERRORS, "--constant", "sphere_radius", "-o", "n.csv"), ("expected NAME=VALUE",)
    ),
    "impossible constant": (
        ("circles.csv", *AXES, *ERRORS, "--constant", "sphere_radius=-8 mm", "-o", "n.csv"), ("found -8 mm", "> 0 m")
    ),
    "constant of the figure": (
        ("circles.csv", *AXES, *ERRORS, "--constant", "friction_coefficient=1", "-o", "n.csv"), ("from the figure",)
    ),
    "onto itself": (("circles.csv", *AXES, *ERRORS, "-o", "circles.csv", "--overwrite"), ("the export itself",)),
    "odd output": (("circles.csv", *AXES, *ERRORS, "-o", "n.txt"), ("--output", ".csv, or a folder")),
    "impossible value": (
        ("logs.csv", *AXES, *ERRORS, "-o", "n.csv"), ("logs.csv, line 1, abscissa", "found -2 mN/m", ">= 0 N/m")
    ),
    "a fraction of zero": (
        ("logs.csv", "--abscissa", "friction_coefficient_pressure_flow [1]", *AXES[2:], *ERRORS, "-o", "n.csv"),
        ("logs.csv, line 3", "expected > 0", "absolute error with --abscissa-error"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_does_not_fit_is_refused(case: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments, words = REFUSED[case]
    before = sorted(path.name for path in folder.iterdir())
    found: Outcome = run(capsys, "digitised", *arguments)
    assert found.status == 2 and found.output == ""
    for word in words:
        assert word in found.errors
    assert sorted(path.name for path in folder.iterdir()) == before
