"""The page about data says what is true."""

import re
from pathlib import Path

import pytest

from skinbayes.errors import InputError
from skinbayes.files import load_dataset, load_reference, shipped_folder, shipped_names
from skinbayes.files.provenance import load_provenance

PAGE = Path(__file__).parents[2] / "docs" / "data.md"


def blocks(language: str) -> list[str]:
    return re.findall(
        rf"^```{language}\n(.*?)^```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE
    )


def test_the_example_can_be_read(tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(blocks("")[0], encoding="utf-8")
    data = load_dataset(path)
    assert data.columns["sliding_speed"].tolist() == [0.008, 0.009]
    assert data.labels("person") == ("A", "B") and data.select({"person": ["A"]}).n_rows == 1


def test_the_message_is_the_message(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.csv").write_text("normal_force [mN]\n" + "1\n" * 5 + "-300\n0\nnan\n")
    with pytest.raises(InputError) as caught:
        load_dataset("mine.csv")
    assert str(caught.value) == blocks("")[1].strip()


def test_the_provenance_is_valid(tmp_path: Path) -> None:
    path = tmp_path / "provenance.toml"
    path.write_text(blocks("toml")[0].replace('"…"', f'"{"0" * 64}"'), encoding="utf-8")
    assert load_provenance(path).kind == "measurements"


def test_every_shipped_table_is_listed_with_its_rows() -> None:
    listed = dict(
        re.findall(r"^\| `([a-z0-9-]+)` \| (\d+) \|", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)
    )
    rows = {}
    for name in shipped_names("datasets"):
        kind = load_provenance(shipped_folder("datasets") / name / "provenance.toml").kind
        rows[name] = str(
            load_dataset(name).n_rows if kind == "measurements" else len(load_reference(name).rows)
        )
    assert listed == rows
