"""What stands in the columns of a data set: labels of any name, quantities nobody asked for, forces, columns of Python."""

from pathlib import Path

import numpy as np
import pandas as pd
import pint
import pytest

from skinbayes import InputError
from skinbayes.files import Dataset, as_dataset, load_dataset

UREG = pint.UnitRegistry()


def read(folder: Path, text: str, **options: str) -> Dataset:
    path = folder / "mine.csv"
    path.write_text(text, encoding="utf-8")
    return load_dataset(path, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "name", ["session", "sex", "operator", "repeat", "subject", "Hand (left/right)", "group", "日付"]
)
@pytest.mark.parametrize("cells", [("1", "2"), ("a", "b")])
def test_a_column_without_unit_holds_labels(name: str, cells: tuple[str, str], tmp_path: Path) -> None:
    text = f"{name},normal_force [N]\n{cells[0]},1\n{cells[1]},2\n"
    assert read(tmp_path, text).labels(name) == cells


@pytest.mark.parametrize("name", ["load", "friction_coefficient", "mu_sd", "Temp (C)", "weight", "CoF.mean"])
def test_a_quantity_without_unit_is_no_label(name: str, tmp_path: Path) -> None:
    assert read(tmp_path, "a,normal_force [N]\nx,1\n").labels("a") == ("x",)
    for cell in ("1", "high"):
        with pytest.raises(InputError, match=r"write '|Write '|write '|has no unit"):
            read(tmp_path, f"{name},sphere_radius [mm]\n{cell},8\n")


def test_numbers_under_nearly_the_name_of_a_quantity_are_no_labels(tmp_path: Path) -> None:
    assert read(tmp_path, "slidingspeeds,sphere_radius [mm]\nfast,8\n").labels("slidingspeeds") == ("fast",)
    with pytest.raises(InputError, match="'sliding_speed'"):
        read(tmp_path, 'slidingspeeds,sphere_radius [mm]\n"0,5",8\n,9\n')


def test_labels_are_on_one_line(tmp_path: Path) -> None:
    data = read(tmp_path, '"body\nsite",normal_force [N]\n"volar\r\nforearm",1\n')
    assert data.labels("body site") == ("volar forearm",)


def test_unknown_quantities_are_carried_as_they_are_written(tmp_path: Path) -> None:
    data = read(tmp_path, "normal_force [mN],sebum [ug/cm^2],pH [1]\n500,12.5,\n400,-,5\n")
    assert data.columns["sebum"].tolist()[0] == 12.5 and np.isnan(data.columns["sebum"][1])
    assert dict(data.units) == {"normal_force": "N", "sebum": "ug/cm^2", "pH": "1"}


def test_friction_force_over_normal_force(tmp_path: Path) -> None:
    text = "normal_force [mN],friction_force [N],friction_force_standard_deviation [mN]\n200,0.1,4\n500,0,5\n"
    data = read(tmp_path, text)
    assert data.columns["friction_coefficient"].tolist() == [0.5, 0.0]
    np.testing.assert_allclose(
        data.columns["friction_coefficient_standard_deviation"], [0.02, 0.01], rtol=1e-15
    )
    given = read(
        tmp_path,
        text.replace("\n", ",mu [1]\n", 1)
        .replace("mu", "friction_coefficient")
        .replace("4\n", "4,9\n")
        .replace("5\n", "5,8\n"),
    )
    assert given.columns["friction_coefficient"].tolist() == [9, 8]
    assert "friction_coefficient_standard_deviation" not in given.columns


def test_spreads_of_both_forces_against_random_numbers(tmp_path: Path) -> None:
    text = (
        "normal_force [N],normal_force_standard_error [N],friction_force [N],friction_force_standard_error [N]\n"
        "0.5,0.01,0.4,0.005\n"
    )
    found = read(tmp_path, text).columns["friction_coefficient_standard_error"][0]
    rng = np.random.default_rng(4)
    ratio = rng.normal(0.4, 0.005, 200_000) / rng.normal(0.5, 0.01, 200_000)
    # 1/sqrt(2N) of a standard deviation is 0.16 %; four of them, and 0.1 % of the second order
    assert found == pytest.approx(ratio.std(), rel=0.008)


def test_the_number_of_measurements_has_two_names(tmp_path: Path) -> None:
    for name in ("n", "n [1]", "number_of_measurements", "number_of_measurements [-]"):
        data = read(tmp_path, f"normal_force [N],{name}\n1,5\n")
        assert data.columns["number_of_measurements"].tolist() == [5.0]


def test_missing_values_are_kept_where_asked(tmp_path: Path) -> None:
    text = "person,sex,normal_force [N],skin_hydration [1]\nA,m,1,\nB,,2,40\nC,f,,30\nD,f,4,20\n"
    assert read(tmp_path, "note,normal_force [N]\n,1\na,2\n").labels("note") == ("", "a")
    with pytest.raises(InputError, match=r"2 problems(.|\n)*missing = \"drop\""):
        read(tmp_path, text)
    data = read(tmp_path, text, missing="keep")
    assert data.n_rows == 4 and data.labels("sex") == ("m", "", "f")
    assert data.complete({"person"}, drop=False) is data
    with pytest.raises(
        InputError, match=r"line 4, column 'normal_force': found no value.*missing = \"drop\""
    ):
        data.complete({"person", "normal_force"}, drop=False)
    dropped = data.complete({"person", "normal_force"}, drop=True)
    assert dropped.labels("person") == ("A", "B", "D") and dropped.dropped == (4,)
    again = dropped.complete({"sex", "normal_force", "no such column"}, drop=True)
    assert again.labels("person") == ("A", "D") and again.dropped == (3, 4) and again.lines == (2, 5)
    with pytest.raises(InputError, match="no row has a value in each of the columns"):
        data.select({"person": ["C"]}).complete({"normal_force"}, drop=True)


FRAME = {
    "session": [1, 2, 3],
    "sex": pd.Categorical(["m", "f", "m"]),
    "note": ['a, "b"', "#7", "x;y"],
    "normal_force [mN]": [500, 480.5, 0.1],
    "sliding_speed": UREG.Quantity([8.0, 9.0, 10.0], "mm/s"),
    "temperature": UREG.Quantity([20.0, 21.0, 22.0], "degC"),
    "temperature_standard_deviation": UREG.Quantity([0.5, 0.5, 0.25], "degC"),
    "friction_coefficient": np.array([1.31, 1.12, 1 / 3]),
    "sebum [ug/cm^2]": [1.0, 2.0, 3.0],
}


def test_columns_of_python() -> None:
    data = Dataset.from_columns(FRAME, name="mine")
    assert data.columns["normal_force"].tolist() == [0.5, 0.4805, 0.0001]
    assert data.columns["sliding_speed"].tolist() == pytest.approx([0.008, 0.009, 0.01], rel=1e-15)
    assert data.columns["temperature"].tolist() == pytest.approx([293.15, 294.15, 295.15], rel=1e-15)
    assert data.columns["temperature_standard_deviation"].tolist() == [0.5, 0.5, 0.25]
    assert data.columns["friction_coefficient"].tolist() == [1.31, 1.12, 1 / 3]
    assert data.labels("session") == ("1", "2", "3") and data.labels("sex") == ("m", "f")
    assert (data.key, str(data.path), data.lines, data.in_memory) == ("mine", "mine", (1, 2, 3), True)
    bare = {name: values for name, values in FRAME.items() if not hasattr(values, "magnitude")}
    frame = pd.DataFrame(bare)
    assert as_dataset(frame).fingerprint == load_dataset(bare).fingerprint
    assert as_dataset(data) is data


@pytest.mark.parametrize("odd", [False, True])
def test_written_and_read_again(odd: bool, tmp_path: Path) -> None:
    data = Dataset.from_columns(FRAME | ({"a;b\tc, d": ["x", "y", "z"]} if odd else {}), missing="keep")
    assert read(tmp_path, data.to_csv()).fingerprint == data.fingerprint
    assert data.sha256 == load_dataset(tmp_path / "mine.csv").sha256
    shipped = load_dataset("fehlberg2025-finger-stribeck")
    assert read(tmp_path, shipped.to_csv()).fingerprint == shipped.fingerprint


@pytest.mark.parametrize(
    ("columns", "fragments"),
    [
        ({"load": [1.0], "sphere_radius": [1.0]}, ("data: unknown column 'load'", "'normal_force [N]'")),
        ({"normal_force": [1, -2]}, ("data, row 2, column 'normal_force': found -2 N", "expected > 0 N")),
        ({"normal_force": [1, None]}, ("data, row 2", "an empty cell")),
        ({"normal_force": ["1 N"]}, ("data, row 1", "'1 N', which is not a number")),
        ({"normal_force [Pa]": [1]}, ("data: column 'normal_force'", "wrong dimension", "a force in N")),
        ({"normal_force": UREG.Quantity([1.0], "Pa")}, ("'normal_force'", "wrong dimension", "a force in N")),
        ({"normal_force [N]": UREG.Quantity([1.0], "N")}, ("unit of their own", "bare name")),
        ({"sebum": UREG.Quantity([1.0], "kg")}, ("'sebum'", "unit into the header")),
        (
            {"normal_force": [1, 2], "person": ["A"]},
            ("different lengths", "'normal_force [N]' 2, 'person' 1"),
        ),
        ({"normal_force": [[1.0]]}, ("shape (1, 1)", "one for each row")),
        ({"normal_force": 1.0}, ("shape ()", "one for each row")),
        ({"normal_force": []}, ("0 rows",)),
        ({}, ("0 columns",)),
        ({"person": ["A\x1b"], "normal_force": [1]}, ("row 1, column 'person'", "printable")),
        (3, ("found int", "data frame")),
        (pd.DataFrame([[1.0, 2.0]], columns=["normal_force [N]"] * 2), ("appears twice",)),
    ],
)
def test_columns_of_python_that_are_refused(columns: object, fragments: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as caught:
        as_dataset(columns)  # type: ignore[arg-type]
    for fragment in fragments:
        assert fragment in str(caught.value)
