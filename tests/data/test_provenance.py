"""A provenance file is validated, and data that were changed afterwards are refused."""

import hashlib
from pathlib import Path

import pytest

from skinbayes.errors import InputError
from skinbayes.files import load_dataset, load_reference
from skinbayes.files.provenance import load_provenance

DATA = b"normal_force [N]\n0.5\n"
GOOD = f"""title = "T"
authors = "A. Author"
doi = "10.1000/xyz"
licence = "CC BY 4.0"
kind = "measurements"
where = "Table 1"
how_read = "copied"
transformation = "none"
spread = "none"
sha256 = "{hashlib.sha256(DATA).hexdigest()}"
"""


def folder(tmp_path: Path, provenance: str | bytes, data: bytes = DATA) -> Path:
    path = tmp_path / "mine"
    path.mkdir()
    (path / "data.csv").write_bytes(data)
    (path / "provenance.toml").write_bytes(
        provenance if isinstance(provenance, bytes) else provenance.encode()
    )
    return path


def test_own_folder(tmp_path: Path) -> None:
    data = load_dataset(folder(tmp_path, GOOD))
    assert data.key == "mine" and data.provenance is not None
    assert data.provenance.authors == ["A. Author"] and data.provenance.doi == ["10.1000/xyz"]


def test_folder_without_provenance(tmp_path: Path) -> None:
    path = folder(tmp_path, GOOD)
    (path / "provenance.toml").unlink()
    assert load_dataset(path).provenance is None
    with pytest.raises(InputError, match=r"no provenance\.toml"):
        load_reference(path)


def test_changed_data_are_refused(tmp_path: Path) -> None:
    path = folder(tmp_path, GOOD, DATA.replace(b"0.5", b"0.6"))
    with pytest.raises(
        InputError, match=r"sha256 is [0-9a-f]{64}; expected [0-9a-f]{64} as .*provenance\.toml"
    ):
        load_dataset(path)


@pytest.mark.parametrize(
    ("old", "new", "fragments"),
    [
        ('title = "T"\n', "", (": title:", "is missing")),
        ('title = "T"', 'title = ""', ("line 1: title:", "at least 1 character")),
        ('title = "T"', "title = 3", ("line 1: title:", "string", "found 3")),
        ('title = "T"', 'title = "T"\ntitel = "T"', ("line 2: titel:", "unknown key", "'title'")),
        ('title = "T"', 'title = "T"\ntitle = "U"', ("line 2", "not valid TOML")),
        ('doi = "10.1000/xyz"', 'doi = "https://doi.org/10.1000/xyz"', ("line 3: doi:", "pattern")),
        (
            'kind = "measurements"',
            'kind = "dreams"',
            ("line 5: kind:", "'measurements' or 'reference'", "'dreams'"),
        ),
        ('where = "Table 1"', "where = ", ("line 6", "not valid TOML")),
        ("sha256 = ", "sha256 = [] # ", (": sha256:", "string")),
        ('authors = "A. Author"', "authors = []", ("line 2: authors:", "at least 1 item")),
    ],
)
def test_bad_provenance(tmp_path: Path, old: str, new: str, fragments: tuple[str, ...]) -> None:
    assert old in GOOD
    path = folder(tmp_path, GOOD.replace(old, new))
    with pytest.raises(InputError) as caught:
        load_dataset(path)
    message = str(caught.value)
    assert message.startswith(str(path / "provenance.toml")) and "\n" not in message
    for fragment in fragments:
        assert fragment in message


@pytest.mark.parametrize("content", [b"", b"\0\0", b"\xff\xfe", b"[" * 100_000, b"a" * 2_000_000])
def test_what_is_not_toml(tmp_path: Path, content: bytes) -> None:
    with pytest.raises(InputError, match=r"provenance\.toml"):
        load_dataset(folder(tmp_path, content))


def test_missing_provenance(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        load_provenance(tmp_path / "provenance.toml")
