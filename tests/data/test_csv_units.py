"""Any unit that converts is accepted in a header, and the same experiment gives the same numbers."""

from pathlib import Path

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.files import load_dataset


def write(folder: Path, text: str, name: str = "mine.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_the_same_experiment_in_other_units(tmp_path: Path) -> None:
    si = load_dataset(
        write(
            tmp_path,
            "person,normal_force [N],sliding_speed [m/s],viscosity [Pa s],relative_humidity [1],temperature [K],"
            "contact_angle_skin [rad],nominal_contact_area [m^2]\nA,0.5,0.008,0.0005,0.5,293.15,1.5707963267948966,0.0004\n",
        )
    )
    lab = load_dataset(
        write(
            tmp_path,
            "contact_angle_skin [deg],normal_force [mN],sliding_speed [mm/s],viscosity [mPa s],relative_humidity [%],"
            "temperature [degC],nominal_contact_area [cm^2],person\n90,500,8,0.5,50,20,4,A\n",
        )
    )
    assert set(si.columns) == set(lab.columns)
    for name, unit in si.units.items():
        assert lab.units[name] == unit
        assert lab.columns[name].tolist() == pytest.approx(si.columns[name].tolist(), rel=1e-15)
    assert lab.columns["person"].tolist() == ["A"]


def test_byte_order_mark_windows_lines_quotes_and_comments(tmp_path: Path) -> None:
    plain = load_dataset(write(tmp_path, "person,normal_force [N]\nA,1\nB,2\n"))
    path = tmp_path / "windows.csv"
    path.write_bytes(
        b'\xef\xbb\xbf# by hand\r\n"person", "normal_force [N]"\r\n\r\n"A", 1 \r\n# pause\r\nB,+2.\r\n\r\n'
    )
    assert load_dataset(path).fingerprint == plain.fingerprint
    assert load_dataset(path).sha256 != plain.sha256


def test_labels_may_hold_commas_and_any_script(tmp_path: Path) -> None:
    data = load_dataset(
        write(tmp_path, 'liquid,normal_force [N]\n"honey, 10 g",1\nグリセリン,2\n<b>water</b>,3\n')
    )
    assert data.labels("liquid") == ("honey, 10 g", "グリセリン", "<b>water</b>")


def test_spread_columns(tmp_path: Path) -> None:
    data = load_dataset(
        write(
            tmp_path,
            "temperature [degC],temperature_standard_deviation [degC],friction_coefficient [1],"
            "friction_coefficient_standard_deviation [%]\n20,1.5,0.5,4\n",
        )
    )
    assert data.columns["temperature"].tolist() == [293.15]
    assert data.columns["temperature_standard_deviation"].tolist() == [1.5]  # a difference has no offset
    assert data.columns["friction_coefficient_standard_deviation"].tolist() == pytest.approx([0.04])


def test_spread_of_a_label_is_a_column_like_others(tmp_path: Path) -> None:
    data = load_dataset(write(tmp_path, "normal_force [N],person_standard_deviation [1]\n1,2\n"))
    assert data.columns["person_standard_deviation"].tolist() == [2.0]


def test_values_beyond_the_largest_number_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="line 2, column 'young_modulus_bulk': found 1e308 GPa"):
        load_dataset(write(tmp_path, "young_modulus_bulk [GPa]\n1e308\n"))


def test_infinite_is_a_value_where_it_means_something(tmp_path: Path) -> None:
    data = load_dataset(write(tmp_path, "yield_stress [MPa],friction_coefficient [1]\ninf,0.5\n50,0.6\n"))
    assert data.columns["yield_stress"].tolist() == [np.inf, 5e7]


def test_a_path_may_be_relative_to_another_file(tmp_path: Path) -> None:
    write(tmp_path, "normal_force [N]\n1\n")
    assert load_dataset("mine.csv", relative_to=tmp_path).key == "mine"
    with pytest.raises(InputError, match="neither a shipped data set nor an existing file"):
        load_dataset("mine.csv", relative_to=tmp_path / "elsewhere")
