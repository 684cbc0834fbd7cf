"""Each kind of bad data file gives one InputError that names the place, what was found and what was expected."""

import time
from pathlib import Path

import pytest

from skinbayes.errors import NEXT_PROBLEM, InputError
from skinbayes.files import load_dataset
from skinbayes.files.table import MAX_ROWS

HEADER = "person,normal_force [N],friction_coefficient [1]\n"

# name of the case: content, and what the message has to contain
CORPUS: dict[str, tuple[bytes | str, tuple[str, ...]]] = {
    "empty file": (b"", ("the file is empty", "expected a header line")),
    "blank lines only": (b"\n  \n\n", ("the file is empty",)),
    "comments only": (b"# a\n# b\n", ("the file is empty",)),
    "header only": (HEADER, ("line 1", "no rows of data", "expected at least one")),
    "binary": (
        b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR",
        ("line 1", "byte 1 of the line (0x89) is not UTF-8", "expected comma-separated text"),
    ),
    "zero bytes": (
        HEADER.encode() + b"a,1\0,2\n",
        ("line 2", "zero byte", "byte 4 of the line", "not a binary file"),
    ),
    "utf-16 without a mark": (HEADER.encode("utf-16-le"), ("line 1", "zero byte", "byte order mark")),
    "utf-16 cut short": (
        HEADER.encode("utf-16")[:-1],
        ("line 1: byte 99", "is not UTF-16, as the file begins"),
    ),
    "other code pages": (
        HEADER.encode() + "Hélène,1,0.5\n".encode("cp1252"),
        ("line 2", "byte 4", "0xe8", "UTF-8"),
    ),
    "one long line": (b"x" * 200_000, ("line 1", "longer than")),
    "ragged, short": (HEADER + "A,1,0.5\nB,2\n", ("line 3", "found 2 cells", "expected 3")),
    "ragged, long": (HEADER + "A,1,0.5\nB,2,3,4\n", ("line 3", "found 4 cells", "expected 3")),
    "decimal commas, bare": (HEADER + "A,1,0,5\n", ("line 2", "decimal separator a comma")),
    "decimal comma, quoted": (
        HEADER + 'A,"0,3",0.5\n',
        ("line 2", "'normal_force'", "'0,3'", "decimal comma", "expected > 0 N"),
    ),
    "semicolons, decimal comma or thousand": (
        HEADER.replace(",", ";") + "A;1,000;2\n",
        ("line 2", "'1,000'", "1.000 if it is decimal", "1000 if it is a thousand's"),
    ),
    "semicolons, decimal point or thousand": (
        HEADER.replace(",", ";") + "A;2;1\nA;1.000;2\n",
        ("'1.000' (line 3)", "1.0000 if it is decimal", "1000 if it is a thousand's"),
    ),
    "semicolons, both": (
        HEADER.replace(",", ";") + "A;1.000;2\nA;2;0,5\n",
        ("'1.000' (line 2)", "'0,5' (line 3)", "one decimal separator"),
    ),
    "semicolons, decimal comma and thousands": (
        HEADER.replace(",", ";") + "A;1.234,5;0,5\n",
        (
            "line 2",
            "'1.234,5'",
            "separated thousands; write 1234.5 (1234,5 where the file has decimal commas)",
        ),
    ),
    "two separators": ("a;b [N],c [1]\n1;2,3\n1,2;3\n", ("line 1", "commas and semicolons", "double quotes")),
    "quotes do not match": (HEADER + '"A,1,0.5\n', ("line 2", "quotation marks")),
    "column twice": (
        "normal_force [N],normal_force [mN]\n1,1\n",
        ("line 1", "'normal_force' appears twice", "expected each column once"),
    ),
    "unknown column": (
        "normal_forse [N]\n1\n",
        ("line 1", "no quantity that skinbayes knows", "Did you mean 'normal_force'?"),
    ),
    "unknown column without unit, numbers": (
        "normal_forse,sphere_radius [m]\n1,1\n",
        ("line 1", "unknown column 'normal_forse'", "Did you mean 'normal_force'?"),
    ),
    "brackets do not match": (
        "site [left,sphere_radius [m]\na,1\n",
        ("line 1", "'site [left'", "square brackets"),
    ),
    "empty brackets": ("sebum [],sphere_radius [m]\n1,1\n", ("line 1", "'sebum' has no unit")),
    "fewer than one measurement": (
        "friction_coefficient [1],friction_coefficient_standard_error [1],n\n1,0.1,0\n",
        ("line 2", "'number_of_measurements'", "expected >= 1"),
    ),
    "unit in round brackets": (
        "normal_force (N)\n1\n",
        ("line 1", "unknown column 'normal_force (N)'", "square brackets"),
    ),
    "column without name": ("normal_force [N],\n1,2\n", ("line 1", "without a name")),
    "no unit": (
        "normal_force\n1\n",
        ("line 1", "'normal_force' has no unit", "a force in N", "'normal_force [N]'"),
    ),
    "empty unit": ("normal_force []\n1\n", ("line 1", "'normal_force' has no unit", "a force in N")),
    "no unit, dimensionless": (
        "friction_coefficient\n1\n",
        ("line 1", "has no unit", "write 'friction_coefficient [1]'"),
    ),
    "wrong unit": (
        "normal_force [Pa]\n1\n",
        ("line 1", "'normal_force'", "unit 'Pa' has the wrong dimension", "expected a force in N"),
    ),
    "unknown unit": (
        "normal_force [quux]\n1\n",
        ("line 1", "unit 'quux' is unknown", "expected a force in N"),
    ),
    "unit on a label": ("person [1],normal_force [N]\nA,1\n", ("line 1", "'person'", "expected no unit")),
    "labels only": ("person,liquid\nA,water\n", ("line 1", "no quantity", "friction_coefficient [1]")),
    "nan": (HEADER + "A,nan,0.5\n", ("line 2", "'normal_force'", "'nan'", "expected > 0 N")),
    "n/a": (HEADER + "A,N/A,0.5\n", ("line 2", "'normal_force'", "missing value", "expected > 0 N")),
    "empty cell": (HEADER + "A,1,\n", ("line 2", "'friction_coefficient'", "an empty cell", "expected >= 0")),
    "empty label": (HEADER + " ,1,1\n", ("line 2", "'person'", "an empty cell", "printable")),
    "control character": (HEADER + "A\x1b[31m,1,1\n", ("line 2", "'person'", "\\x1b[31m", "printable")),
    "word": (HEADER + "A,heavy,1\n", ("line 2", "'normal_force'", "'heavy'", "not a number", "> 0 N")),
    "underscores": (HEADER + "A,1_000,1\n", ("line 2", "'1_000'", "not a number")),
    "hexadecimal": (HEADER + "A,0x10,1\n", ("line 2", "'0x10'", "not a number")),
    "other digits": (HEADER + "A,٣,1\n", ("line 2", "'٣'", "not a number")),
    "infinite": (HEADER + "A,inf,1\n", ("line 2", "'normal_force'", "found inf N", "expected > 0 N")),
    "overflow": (HEADER + "A,1e999,1\n", ("line 2", "'normal_force'", "found 1e999 N", "expected > 0 N")),
    "negative force": (HEADER + "A,-0.3,1\n", ("line 2", "'normal_force'", "found -0.3 N", "expected > 0 N")),
    "zero force": (HEADER + "A,0,1\n", ("line 2", "'normal_force'", "found 0 N", "expected > 0 N")),
    "negative force, other unit": (
        "normal_force [mN]\n-300\n",
        ("line 2", "found -300 mN (-0.3 N in SI)", "expected > 0 N"),
    ),
    "humidity of 130 %": (
        "relative_humidity [%]\n40\n130\n",
        ("line 3", "'relative_humidity'", "found 130 % (1.3 in SI)", "expected between 0 and 1"),
    ),
    "below absolute zero": (
        "temperature [degC]\n20\n-300\n",
        ("line 3", "'temperature'", "found -300 degC (-26.85 K in SI)", "expected > 0 K"),
    ),
    "zero spread": (
        "friction_coefficient [1],friction_coefficient_standard_deviation [1]\n1,0\n",
        ("line 2", "'friction_coefficient_standard_deviation'", "found 0", "expected > 0"),
    ),
    "several": (
        HEADER + "A,1,1\nB,-1,nan\nC,1,x\n",
        (
            "3 problems",
            "line 3, column 'normal_force': found -1 N",
            "line 3, column 'friction",
            "line 4",
            "'x'",
        ),
    ),
    "first by line": (
        HEADER + "A,1,nan\nB,-1,1\n",
        ("2 problems\n  - line 2, column 'friction_coefficient'", "\n  - line 3, column 'normal_force'"),
    ),
    "lines count comments": ("# made by hand\n\n" + HEADER + "A,-1,1\n", ("line 4", "found -1 N")),
}


@pytest.mark.parametrize("case", CORPUS)
def test_bad_file_gives_one_clear_message(case: str, tmp_path: Path) -> None:
    content, fragments = CORPUS[case]
    path = tmp_path / "mine.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError) as caught:
        load_dataset(path)
    message = str(caught.value)
    assert message.startswith(str(path))
    assert "\n" not in message.replace(NEXT_PROBLEM, "") and len(message) < len(str(path)) + 400
    for fragment in fragments:
        assert fragment in message


def test_a_million_rows_are_refused_quickly(tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    path.write_text("normal_force [N],friction_coefficient [1]\n" + "0.5,0.7\n" * 1_000_000)
    start = time.process_time()
    with pytest.raises(InputError, match=f"line {MAX_ROWS + 2}: more than {MAX_ROWS} rows"):
        load_dataset(path)
    assert time.process_time() - start < 2.0


def test_the_largest_table_is_read(tmp_path: Path) -> None:
    path = tmp_path / "large.csv"
    path.write_text("normal_force [N]\n" + "0.5\n" * MAX_ROWS)
    assert load_dataset(path).n_rows == MAX_ROWS


@pytest.mark.parametrize(
    "name", ["no-such-data", "no/such/file.csv", "", "a\0b", "x" * 5000, "adams2007-forearm-glas"]
)
def test_missing_data_set_lists_what_is_shipped(name: str) -> None:
    with pytest.raises(InputError) as caught:
        load_dataset(name)
    message = str(caught.value)
    if name.endswith(".csv"):  # a file was meant
        assert "nor an existing file" in message and "adams2007" not in message
    else:
        assert "expected a name" in message or "adams2007-forearm-glass, " in message
    assert len(message) < 1000
    if name.startswith("adams"):
        assert "Did you mean 'adams2007-forearm-glass'" in message


def test_folder_without_data(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        load_dataset(tmp_path)
