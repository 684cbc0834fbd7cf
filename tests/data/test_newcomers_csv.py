"""CSV files as people who do not know the vocabulary write them, and what they are told."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from skinbayes.errors import InputError
from skinbayes.files import load_dataset
from skinbayes.files.spectrum import read_spectrum
from skinbayes.files.table import MOST_SHOWN
from skinbayes.vocabulary import LABELS, QUANTITIES, suggestions

KNOWN = [*QUANTITIES, *LABELS]


def write(folder: Path, text: str, name: str = "mine.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def refusal(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        load_dataset(path)
    return str(caught.value)


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        (word, name)
        for name, words in {
            "friction_coefficient": "mu|μ|µ|cof|COF|CoF|friction coefficient|Friction Coefficient|friction",
            "normal_force": "load|Load|force|normal load|F_N|FN|Fn|normal-force",
            "person": "subject|Subject|participant|volunteer",
            "body_site": "site|location|Body Site",
            "liquid": "lubricant|fluid",
            "sliding_speed": "velocity|speed|v|sliding velocity",
            "temperature": "temp|T",
            "relative_humidity": "RH|rh|humidity|relative humidity",
            "viscosity": "η|eta|dynamic viscosity",
            "frictional_shear_stress": "σ_f|σf|tau|shear strength",
            "young_modulus_layer": "E0|E_0|stratum corneum modulus",
            "layer_thickness": "thickness|d",
            "rms_height": "Rq|Sq|roughness|h_rms",
            "sphere_radius": "radius|ball radius|R|sphere_diameter|ball_diameter|diameter|Ball Diameter",
            "friction_coefficient_standard_deviation": "mu_sd|COF_std|friction_coefficient_sd|sd_mu",
            "friction_coefficient_standard_error": "mu_se|COF_sem|friction coefficient std err",
            "friction_force": "friction force|tangential_force|F_t",
            "normal_force_standard_deviation": "load_sd|force_stdev|normal_force_std|normal_force_err",
        }.items()
        for word in words.split("|")
    ],
)  # fmt: skip
def test_other_words_for_the_same(written: str, meant: str) -> None:
    assert f" Did you mean '{meant}'" in suggestions(written, [*KNOWN, meant])


def test_what_differs_is_said() -> None:
    assert "half of the diameter" in suggestions("ball_diameter", KNOWN)
    assert "density" in suggestions("kinematic viscosity", KNOWN)


@pytest.mark.parametrize(
    "word",
    [
        "replicate",
        "trial",
        "repeat",
        "batch",
        "notes",
        "date",
        "operator",
        "age",
        "sex",
        "layer",
        "thing",
        "gender",
        "comment",
        "xyz",
        "foo1",
    ],
)
def test_no_suggestion_where_nothing_is_near(word: str) -> None:
    assert suggestions(word, KNOWN) == ""


@pytest.mark.parametrize(
    ("header", "write_instead"),
    [
        ("load (mN)", "'normal_force [mN]', with the unit in square brackets"),
        ('"Load, mN"', "'normal_force [mN]'"),
        ("force_mN", "'normal_force [mN]'"),
        ("normal_force_N", "'normal_force [N]'"),
        ("speed_mm_s", "'sliding_speed [mm/s]'"),
        ("velocity (mm/s)", "'sliding_speed [mm/s]'"),
        ("Temp (°C)", "'temperature [°C]'"),
        ("force/N", "'normal_force [N]'"),
        ("speed in mm/s", "'sliding_speed [mm/s]'"),
        ("mu", "'friction_coefficient [1]'"),
        ("friction_coefficient", "'friction_coefficient [1]'"),
    ],
)
def test_the_header_to_write_is_shown(header: str, write_instead: str, tmp_path: Path) -> None:
    said = refusal(write(tmp_path, f"{header},sphere_radius [mm]\n0.5,8\n"))
    assert write_instead in said or write_instead.lower() in said


def test_all_problems_come_at_once(tmp_path: Path) -> None:
    said = refusal(
        write(
            tmp_path,
            "subject,load,sliding_speed [m],friction_coefficient\nA,1,2,0.5\nB,1,2\n",
        )
    )
    for part in (
        "'normal_force [N]'",
        "wrong dimension",
        "'friction_coefficient [1]'",
        "line 3: found 3 cells",
    ):
        assert part in said  # fmt: skip
    said = refusal(
        write(
            tmp_path,
            "person,normal_force [mN],friction_coefficient [1]\nA,-1,0.5\nB,,0.5\nC,1,abc\nD,1\n",
        )
    )
    assert [f"line {n}" in said for n in (2, 3, 4, 5)] == [True] * 4 and said.startswith(
        f"{tmp_path / 'mine.csv'}: 4 problems"
    )


def test_the_list_is_bounded_and_shows_each_kind(tmp_path: Path) -> None:
    rows = "".join(f"{-i},0.5\n" for i in range(1, 41)) + '1,"0,3"\n'
    said = refusal(write(tmp_path, "normal_force [N],friction_coefficient [1]\n" + rows))
    lines = said.splitlines()
    assert lines[0].endswith("41 problems") and len(lines) == 1 + MOST_SHOWN + 1
    assert lines[-1].strip() == f"- and {41 - MOST_SHOWN} more"
    assert "line 42, column 'friction_coefficient'" in said and "line 2, column 'normal_force'" in said


def test_rows_as_spreadsheets_leave_them(tmp_path: Path) -> None:
    header = "normal_force [N],friction_coefficient [1]\n"
    assert "remove the commas at the end" in refusal(write(tmp_path, header + "1,0.5,,\n"))
    assert load_dataset(write(tmp_path, header + "1,0.5\n,,\n,\n")).n_rows == 1
    assert load_dataset(write(tmp_path, header.strip() + ",,\n1,0.5,,\n,,,\n")).n_rows == 1
    assert "thousand" in refusal(write(tmp_path, header + '"1,000",0.5\n'))
    assert "remove the #" in refusal(write(tmp_path, "# " + header + "1,0.5\n"))


@pytest.mark.parametrize("label", ["#7", "# 7", "#", "##", "#a#"])
def test_a_label_may_begin_with_a_hash(label: str, tmp_path: Path) -> None:
    header = "person,normal_force [N],friction_coefficient [1]\n"
    data = load_dataset(write(tmp_path, f"# {header}{header}A,0.5,1.3\n{label},0.5,1.2\n"))
    assert data.labels("person") == ("A", label)


@pytest.mark.parametrize(
    "comment", ["# a note", "#7,0.5", "# first, second, third", "#", "#,,", "# 1, 2, 3, 4"]
)
def test_a_comment_cannot_be_a_row(comment: str, tmp_path: Path) -> None:
    header = "person,normal_force [N],friction_coefficient [1]\n"
    assert load_dataset(write(tmp_path, f"{header}A,0.5,1.3\n{comment}\n")).labels("person") == ("A",)
    numeric = "normal_force [N],friction_coefficient [1]\n"
    assert load_dataset(write(tmp_path, f"{numeric}0.5,1.3\n#0.5,1.2\n")).n_rows == 1


def test_a_row_that_begins_with_a_hash_is_checked(tmp_path: Path) -> None:
    said = refusal(write(tmp_path, "person,normal_force [N],friction_coefficient [1]\n#7,nan,1.2\n"))
    assert "line 2" in said and "'nan'" in said


@pytest.mark.parametrize(
    ("composed", "decomposed"), [("José", "Jose\u0301"), ("Å", "A\u030a"), ("Zoë", "Zoe\u0308")]
)
def test_labels_in_one_normal_form(composed: str, decomposed: str, tmp_path: Path) -> None:
    text = f"person,friction_coefficient [1]\n{composed},0.5\n{decomposed},0.6\nAnn,0.7\n"
    data = load_dataset(write(tmp_path, text))
    assert data.labels("person") == (composed, "Ann")
    assert data.select({"person": [decomposed]}).n_rows == 2 == data.select({"person": [composed]}).n_rows


@pytest.mark.parametrize(
    "content", ["root:$6$salt$hash:19000:0:99999:7:::\n", "hunter2\n1\n", "a secret, and another\n1,2\n"]
)
def test_a_file_that_is_no_table_of_ours_is_not_quoted(content: str, tmp_path: Path) -> None:
    path = write(tmp_path, content)
    for read in (load_dataset, read_spectrum):
        with pytest.raises(InputError) as caught:
            read(path)
        said = str(caught.value).replace(str(path), "")
        assert not any(word in said for word in ("root", "salt", "hunter2", "secret", "another"))


def test_cells_are_quoted_briefly(tmp_path: Path) -> None:
    said = refusal(write(tmp_path, f"person,normal_force [N]\n{'x' * 300},{'y' * 5000}\nB,{'9' * 5000}\n"))
    assert "y" * 25 not in said and "x" * 25 not in said and "9" * 25 not in said


def test_what_is_no_file_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "data.csv")
    assert "this is a pipe" in refusal(tmp_path)
    with pytest.raises(InputError, match="this is a device"):
        read_spectrum("/dev/zero")


def test_a_huge_file_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / "sparse.csv"
    with path.open("wb") as stream:
        stream.truncate(3_000_000_000)
    assert "at most 100,000,000 bytes" in refusal(path)
