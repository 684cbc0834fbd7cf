"""What is shipped is found in a wheel (inside the package) and in a checkout (beside it)."""

from pathlib import Path

import pytest

from skinbayes.errors import InputError
from skinbayes.files import locate


def make(folder: Path) -> None:
    (folder / "datasets" / "one").mkdir(parents=True)
    (folder / "datasets" / "one" / "data.csv").write_text("normal_force [N]\n1\n")
    (folder / "datasets" / "not-a-data-set").mkdir()
    (folder / "models").mkdir()
    (folder / "models" / "b.toml").write_text("")
    (folder / "models" / "a.toml").write_text("")


def test_checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(tmp_path)
    monkeypatch.setattr(locate, "_PACKAGE", tmp_path / "skinbayes")
    assert locate.shipped_folder("models") == tmp_path / "models"
    assert locate.shipped_names("models") == ("a", "b")
    assert locate.shipped_names("datasets") == ("one",)


def test_wheel_comes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(tmp_path / "skinbayes" / "_shipped")
    (tmp_path / "models").mkdir()  # some other package's folder in site-packages
    monkeypatch.setattr(locate, "_PACKAGE", tmp_path / "skinbayes")
    assert locate.shipped_folder("models") == tmp_path / "skinbayes" / "_shipped" / "models"
    assert locate.shipped_names("datasets") == ("one",)


def test_incomplete_installation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(locate, "_PACKAGE", tmp_path / "skinbayes")
    with pytest.raises(InputError, match="shipped models are missing"):
        locate.shipped_folder("models")
