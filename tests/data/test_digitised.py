"""Exports of WebPlotDigitizer, whole and damaged; the figure is synthetic."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import synthetic_figure as figure

from skinbayes.errors import InputError
from skinbayes.files import load_dataset
from skinbayes.files.digitised import read_digitised
from skinbayes.files.digitised_axes import ReadingError, parse_axis, parse_reading_error
from skinbayes.files.digitised_columns import digitised_table
from skinbayes.vocabulary import QUANTITIES


def expected(name: str) -> np.ndarray:
    return np.array([(x, figure.ordinate(x, name)) for x in figure.ABSCISSA])


def version_5() -> dict[str, Any]:
    return {**figure.project(), "version": [5, 0]}


@pytest.mark.parametrize("content", [figure.project, figure.old_project, version_5])
def test_projects_hold_the_points_and_the_axes(content: Callable[[], Any], tmp_path: Path) -> None:
    found = read_digitised(figure.write_json(tmp_path / "wpd.json", content()))
    assert [one.name for one in found.sets] == ["young", "old"]
    for one in found.sets:
        assert one.values == pytest.approx(expected(one.name), rel=1e-12)
        assert one.axes is not None and one.axes.logarithmic == (True, False)
        error = one.axes.reading_error(one.values, 1.0)
        assert error[:, 0] / one.values[:, 0] == pytest.approx(math.log(10) / 100, rel=1e-12)
        assert error[:, 1] == pytest.approx(1 / 200, rel=1e-12)


def test_an_archive_is_its_project(tmp_path: Path) -> None:
    data = json.dumps(figure.project()).encode()
    files = {"fig/info.json": b'{"version":[4,0]}', "fig/wpd.json": data, "fig/image.png": b"\x89PNG"}
    found = read_digitised(figure.write_archive(tmp_path / "fig.tar", files))
    assert found.kind.startswith("project archive") and found.kind.endswith("4.2")
    assert found.sets[1].values == pytest.approx(expected("old"), rel=1e-12)


def test_what_cannot_be_used_is_said(tmp_path: Path) -> None:
    found = read_digitised(figure.write_json(tmp_path / "wpd.json", figure.project()))
    assert found.left_out == {
        "Default Dataset": "it has no points",
        "bars": "its axes are BarAxes; expected XYAxes",
    }
    with pytest.raises(InputError, match="'bars' cannot be used: its axes are BarAxes"):
        found.select(["bars"])
    with pytest.raises(InputError, match=r"no data set is called 'yong'.*Did you mean 'young'"):
        found.select(["yong"])
    with pytest.raises(InputError, match="chosen twice"):
        found.select(["old", "old"])
    assert [one.name for one in found.select(["old", "young"])] == ["old", "young"]


def test_values_are_computed_where_none_are_stored(tmp_path: Path) -> None:
    content = figure.project()
    for point in content["datasetColl"][0]["data"]:
        del point["value"]
    found = read_digitised(figure.write_json(tmp_path / "wpd.json", content))
    assert found.sets[0].values == pytest.approx(expected("young"), rel=1e-12)


def test_values_tell_whether_a_tilt_was_ignored(tmp_path: Path) -> None:
    content = figure.project()
    axes = content["axesColl"][0]
    del axes["noRotation"]
    axes["calibrationPoints"][1]["py"] = 456  # tilted by 6 pixels on 600
    found = read_digitised(figure.write_json(tmp_path / "wpd.json", content))  # the values ignore it
    assert found.sets[0].axes is not None and found.sets[0].axes.matrix[0, 1] == 0.0
    axes["noRotation"] = False
    with pytest.raises(InputError, match=r"lie up to \d.*pixels from those that the calibration"):
        read_digitised(figure.write_json(tmp_path / "wpd.json", content))


def test_groups_of_points_become_data_sets(tmp_path: Path) -> None:
    content = figure.project()
    series = content["datasetColl"][0]
    series["groupNames"] = ["Primary", None]
    for i, point in enumerate(series["data"]):
        point |= {"tuple": i // 2, "group": i % 2}
    del series["data"][4]["group"]
    found = read_digitised(figure.write_json(tmp_path / "wpd.json", content))
    assert {one.name: len(one.values) for one in found.sets} == {
        "young, Primary": 2, "young, group 2": 2, "young": 1, "old": 5,
    }  # fmt: skip
    assert found.select(["young, group 2"])[0].values[:, 0] == pytest.approx([1e-4, 1e-2])


SINGLE = {
    "bare": "0.1,0.5\n0.2, 0.25\n",
    "with titles": "speed,friction\n0.1,0.5\n0.2,0.25\n",
    "with its name": "wet,\nX,Y\n0.1,0.5\n0.2,0.25\n",
    "named like a number": "10,\nX,Y\n0.1,0.5\n0.2,0.25\n",
    "semicolons": "0.1; 0.5\n0.2; 0.25\n",
    "decimal commas": "0,1; 0,5\n2,0e-1; 0,25\n",
    "tabs and decimal commas": "0,1\t0,5\n,2\t0,25\n",
    "quoted decimal commas": '"x";"y"\n"0,1";"0,5"\n"0,2";"0,25"\n',
    "with a mark and old line ends": "\ufeff0.1,0.5\r\n0.2,0.25\r\n\r\n",
}


@pytest.mark.parametrize("case", SINGLE)
def test_one_data_set_as_csv(case: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_bytes(SINGLE[case].encode())
    (found,) = read_digitised(path).sets
    assert found.values.tolist() == [[0.1, 0.5], [0.2, 0.25]]
    assert found.name == {"with its name": "wet", "named like a number": "10"}.get(case, "mine")
    assert found.axes is None


def test_all_data_sets_as_csv(tmp_path: Path) -> None:
    path = tmp_path / "wpd_datasets.csv"
    path.write_text(figure.all_sets_csv((5, 3)))
    young, old = read_digitised(path).sets
    assert young.values == pytest.approx(expected("young"), rel=1e-15)
    assert old.values == pytest.approx(expected("old")[:3], rel=1e-15)
    assert old.places[2] == "line 5 of 'old'"


# name of the case: content, and what the message has to contain
DAMAGED_CSV: dict[str, tuple[str | bytes, tuple[str, ...]]] = {
    "empty": ("", ("the file is empty",)),
    "blank": (" \n\n", ("the file is empty",)),
    "one column": ("1\n2\n", ("line 1", "single column", "expected two columns")),
    "three columns": ("1,2,3\n", ("line 1", "found 3 columns")),
    "four columns of numbers": ("1,2,3,4\n", ("line 1", "found 4 columns without a header", "decimal separators")),
    "names above both columns": ("a,b,c,d\n1,2,3,4\n", ("line 1", "'a', 'b', 'c', 'd'", "nothing above the second")),
    "no number": ("1,2\n3,oops\n", ("line 2", "column 2 (ordinate)", "'oops'", "expected a number")),
    "missing cell": ("1,2\n,3\n", ("line 2", "column 1 (abscissa)", "an empty cell")),
    "half a point": ("a,,b,\nX,Y,X,Y\n1,2,3,\n", ("line 3", "column 4 (ordinate of 'b')", "an empty cell")),
    "ragged": ("1,2\n1,2,3\n", ("line 2", "found 3 cells", "expected 2")),
    "commas for everything": ("x,y\n0,1,0,5\n", ("line 2", "found 4 cells", "decimal separators")),
    "both separators": ("1.5;2\n1,5;3\n", ("line 2", "'1,5'", "cannot be told")),
    "infinite": ("1,2\n1e999,2\n", ("line 2", "'1e999'", "expected a number")),
    "several problems": ("1,2\na,b\n", ("2 problems", "line 2, column 1", "line 2, column 2")),
    "titles only": ("x,y\n", ("no points",)),
    "date": ("2020/01/01,1\n", ("line 1", "column 1 (abscissa)", "'2020/01/01'", "expected a number")),
    "open quotes": ('1,2\n"3,4\n', ("line 2", "quotation marks")),
    "code page": ("Jörg,\n1,2\n".encode("cp437"), ("line 1", "UTF-8")),
    "binary": (b"1,2\n\0\0\n", ("line 2", "zero byte")),
}  # fmt: skip


@pytest.mark.parametrize("case", DAMAGED_CSV)
def test_damaged_csv(case: str, tmp_path: Path) -> None:
    content, words = DAMAGED_CSV[case]
    path = tmp_path / "bad.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError) as caught:
        read_digitised(path)
    for word in ("bad.csv", *words):
        assert word in str(caught.value)


def changed(change: Callable[[Any], Any], start: Callable[[], Any] = figure.project) -> str:
    content = start()
    change(content)
    return json.dumps(content)


def test_values_that_were_typed_over_are_refused(tmp_path: Path) -> None:
    content = figure.project()
    points = content["datasetColl"][1]["data"]
    points[0]["metadata"] = {"label": "first", "overrides": {"x": None, "y": None}}
    points[1]["metadata"] = ["second"]
    path = figure.write_json(tmp_path / "wpd.json", content)
    assert len(read_digitised(path).select(["old"])[0].values) == 5
    points[2]["metadata"] = {"overrides": {"y": 0.7}}
    with pytest.raises(InputError, match="'old', point 3: its value was typed over by hand"):
        read_digitised(figure.write_json(path, content))


DAMAGED_PROJECT: dict[str, tuple[str, tuple[str, ...]]] = {
    "cut off": (json.dumps(figure.project())[:200], ("line 1, column", "not valid JSON")),
    "a list": ("[1, 2]", ("version: found None", "format 3 or 4")),
    "no version": (changed(lambda c: c.pop("version")), ("version: found None",)),
    "version 6": (changed(lambda c: c.update(version=[6, 0])), ("found [6, 0]", "format 3 or 4")),
    "no axes": (changed(lambda c: c.pop("axesColl")), ("axesColl is missing",)),
    "no pixel": (changed(lambda c: c["datasetColl"][1]["data"][3].pop("x")), ("datasetColl[1].data[3].x is missing",)),
    "no number": (
        changed(lambda c: c["datasetColl"][0]["data"][0].update(y="low")), ("datasetColl[0].data[0].y", "'low'")
    ),
    "not finite": (
        changed(lambda c: c["datasetColl"][0]["data"][0].update(y=float("nan"))), ("datasetColl[0].data[0].y", "nan")
    ),
    "odd value": (
        changed(lambda c: c["datasetColl"][0]["data"][1].update(value=[1, "a"])), ("'young', point 2, value", "'a'")
    ),
    "other value": (
        changed(lambda c: c["datasetColl"][0]["data"][1].update(value=[1e-4, 5.0])), ("'young'", "pixels from those")
    ),
    "three points": (
        changed(lambda c: c["axesColl"][0]["calibrationPoints"].pop()), ("axes 'XY'", "3 calibration points", "four")
    ),
    "broken axis": (
        changed(lambda c: c["axesColl"][0]["calibrationPoints"].append(figure.calibration()[0])),
        ("5 calibration points", "without a break"),
    ),
    "decimal comma": (
        changed(lambda c: c["axesColl"][0]["calibrationPoints"][3].update(dy="0,5")),
        ("calibration point Y2", "'0,5'", "decimal point"),
    ),
    "date": (
        changed(lambda c: c["axesColl"][0]["calibrationPoints"][0].update(dx="2020/01/01")), ("point X1", "no date")
    ),
    "log of zero": (
        changed(lambda c: c["axesColl"][0]["calibrationPoints"][0].update(dx="0")), ("axes 'XY'", "X1", "> 0")
    ),
    "old, no pixel": (
        changed(lambda c: c["wpd"]["calibration"][2].pop("px"), figure.old_project), ("wpd.calibration[2].px is missing",)
    ),
    "old, no data": (
        changed(lambda c: c["wpd"].pop("dataSeries"), figure.old_project), ("wpd.dataSeries",)
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", DAMAGED_PROJECT)
def test_damaged_projects(case: str, tmp_path: Path) -> None:
    text, words = DAMAGED_PROJECT[case]
    path = tmp_path / "bad.json"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_digitised(path)
    for word in ("bad.json", *words):
        assert word in str(caught.value)


def test_damaged_archives(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"0 files called wpd\.json"):
        read_digitised(figure.write_archive(tmp_path / "a.tar", {"fig/info.json": b"{}"}))
    whole = figure.write_archive(tmp_path / "b.tar", {"b/wpd.json": b"{}", "c/wpd.json": b"{}"})
    with pytest.raises(InputError, match=r"2 files called wpd\.json"):
        read_digitised(whole)
    figure.write_archive(tmp_path / "c.tar", {"c/wpd.json": json.dumps(figure.project()).encode()})
    cut = tmp_path / "d.tar"
    cut.write_bytes((tmp_path / "c.tar").read_bytes()[:1000])
    with pytest.raises(InputError, match=r"d\.tar"):
        read_digitised(cut)


def test_missing_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        read_digitised(tmp_path / "none.json")
    with pytest.raises(InputError, match="cannot be read"):
        read_digitised(tmp_path)


def test_a_project_without_points_on_axes(tmp_path: Path) -> None:
    content = {**figure.project(), "datasetColl": figure.project()["datasetColl"][2:]}
    with pytest.raises(InputError, match="no data set that can be used"):
        read_digitised(figure.write_json(tmp_path / "wpd.json", content)).select([])


def test_stated_reading_errors() -> None:
    assert parse_reading_error("2%", QUANTITIES["time"], "here") == ReadingError(relative=0.02)
    assert parse_reading_error("3 %", QUANTITIES["friction_coefficient"], "here") == ReadingError(
        relative=0.03
    )
    assert parse_reading_error("0.03", QUANTITIES["friction_coefficient"], "here") == ReadingError(
        absolute=0.03
    )
    assert parse_reading_error("5 mm/s", QUANTITIES["sliding_speed"], "here").absolute == pytest.approx(0.005)
    assert parse_reading_error("1.5 degC", QUANTITIES["temperature"], "here").absolute == pytest.approx(1.5)
    for text, quantity in (
        ("0 %", "time"),
        ("-1 s", "time"),
        ("1", "time"),
        ("2 m", "time"),
        ("some", "time"),
    ):
        with pytest.raises(InputError, match=r"here: .*expected"):
            parse_reading_error(text, QUANTITIES[quantity], "here")


def test_units_and_logarithms_of_values_and_errors(tmp_path: Path) -> None:
    # the abscissa of this figure is log10 of a product in mN/m, on a linear axis with 0.02 for each pixel
    content = figure.project()
    axes = content["axesColl"][0]
    axes["isLogX"] = False
    for point, text in zip(axes["calibrationPoints"], ("-6", "6", "-6", "-6"), strict=True):
        point["dx"] = text
    for series in content["datasetColl"][:2]:
        for point in series["data"]:
            point["value"][0] = -6 + 0.02 * (point["x"] - 50)
    (one,) = read_digitised(figure.write_json(tmp_path / "wpd.json", content)).select(["young"])
    meanings = (
        parse_axis("speed_viscosity_product [mN/m]", "--abscissa", logarithmic=True),
        parse_axis("friction_coefficient [1]", "--ordinate"),
    )
    table = digitised_table({"young": one}, meanings, "wpd.json", pixel_error=0.5)
    values = np.asarray(table.columns["speed_viscosity_product"])
    assert values == pytest.approx(1e-3 * 10.0 ** np.array([-4.0, -2.0, 0.0, 2.0, 4.0]), rel=1e-12)
    spread = np.asarray(table.columns["speed_viscosity_product_standard_deviation"])
    assert spread / values == pytest.approx(math.log(10) * 0.02 * 0.5, rel=1e-12)
    assert table.columns["friction_coefficient_standard_deviation"] == pytest.approx(0.5 / 200, rel=1e-12)


def test_temperatures_have_an_offset_and_their_errors_none(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text("20,0.5\n30,0.6\n")
    meanings = (
        parse_axis("air_temperature [degC]", "--abscissa", error="0.5 degC"),
        parse_axis("relative_humidity [1]", "--ordinate", error="2 %"),
    )
    table = digitised_table({"t": read_digitised(path).sets[0]}, meanings, "t.csv")
    assert table.columns["air_temperature"] == pytest.approx([293.15, 303.15])
    assert table.columns["air_temperature_standard_deviation"] == pytest.approx([0.5, 0.5])
    assert table.columns["relative_humidity_standard_deviation"] == pytest.approx([0.01, 0.012])


def test_columns_of_spreads_load(tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(
        "speed_viscosity_product [mN/m],speed_viscosity_product_standard_deviation [N/m],"
        "temperature_standard_deviation [degC],friction_coefficient [1]\n2,1e-5,0.5,0.3\n"
    )
    data = load_dataset(path)
    assert data.columns["speed_viscosity_product_standard_deviation"].tolist() == [1e-5]
    assert data.columns["temperature_standard_deviation"].tolist() == [0.5]
    assert data.units["speed_viscosity_product_standard_deviation"] == "N/m"
    path.write_text("friction_coefficient [1],time_standard_deviation [s]\n0.3,0\n")
    with pytest.raises(InputError, match=r"line 2, column 'time_standard_deviation'.*expected > 0 s"):
        load_dataset(path)
