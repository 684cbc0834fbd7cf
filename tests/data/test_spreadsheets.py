"""Files as spreadsheets of many countries save them: the same numbers, however they are written."""

from pathlib import Path

import pytest

from skinbayes.errors import InputError
from skinbayes.files import load_dataset
from skinbayes.files.spectrum import read_spectrum

PLAIN = "person,normal_force [N],friction_coefficient [1]\nJörg,1.25,0.5\n#7,1200,1.125\n"


def european(separator: str) -> str:
    return PLAIN.replace(",", separator).replace(".", ",")


def saved(folder: Path, content: bytes, name: str = "mine.csv") -> Path:
    path = folder / name
    path.write_bytes(content)
    return path


@pytest.mark.parametrize(
    "content",
    [
        european(";").encode(),
        european("\t").encode(),
        ("sep=;\n" + european(";")).encode(),
        european(";").encode("utf-8-sig"),
        european(";").encode("utf-16"),
        european("\t").encode("utf-16-be").join([b"\xfe\xff", b""]),
        european(";").encode("cp1252"),
        european(";").replace("\n", "\r\n").encode("cp1252"),
        PLAIN.replace("\n", "\r").encode(),
        european(";").replace("normal_force [N]", '"normal_force\n[N]"').encode(),
        PLAIN.replace("1.25", '"1,25"').replace("0.5", '"0,5"').replace("1.125", '"1,125"').encode(),
        ("\n# a note, with; marks\t\n" + european(";") + ";;\n\n;;\n").encode(),
        (european(";").replace("\n", ";;\n") + ";;;;\n").encode(),
    ],
    ids=str,
)
def test_the_same_numbers(content: bytes, tmp_path: Path) -> None:
    plain = load_dataset(saved(tmp_path, PLAIN.encode(), "plain.csv"))
    assert load_dataset(saved(tmp_path, content)).fingerprint == plain.fingerprint


def test_a_unit_of_a_code_page(tmp_path: Path) -> None:
    content = (
        "# convention: paper\nwavevector [1/µm];power_spectrum_2d [m^4]\n0,5;1e-20\n1,25;1e-21\n".encode(
            "cp1252"
        )
    )
    assert read_spectrum(saved(tmp_path, content)).wavevector.tolist() == [0.5e6, 1.25e6]


def test_three_decimals_are_decimals_where_another_number_says_so(tmp_path: Path) -> None:
    text = "normal_force [mN];friction_coefficient [1]\n1,000;1,250\n250,5;0,75\n"
    data = load_dataset(saved(tmp_path, text.encode()))
    assert data.columns["normal_force"].tolist() == [0.001, 0.2505]
    assert data.columns["friction_coefficient"].tolist() == [1.25, 0.75]


def test_labels_keep_their_commas(tmp_path: Path) -> None:
    data = load_dataset(saved(tmp_path, b"liquid;normal_force [N]\nhoney, 0,5 %;0,5\n1,5;1\n"))
    assert data.labels("liquid") == ("honey, 0,5 %", "1,5")


@pytest.mark.parametrize("page", ["mac-roman", "cp437", "cp1251"])
def test_other_code_pages_are_refused(page: str, tmp_path: Path) -> None:
    name = "Йорг" if page == "cp1251" else "Jörg"
    with pytest.raises(InputError, match=r"line 2: byte [12] of the line \(0x.*is not UTF-8"):
        load_dataset(saved(tmp_path, PLAIN.replace("Jörg", name).encode(page)))
