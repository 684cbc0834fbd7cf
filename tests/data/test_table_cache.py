"""Tables kept on disk: found again, built again when damaged, never in the way."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from skinbayes.forward import table_cache
from skinbayes.forward.table_cache import FOLDER, cache_folder, cached


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(FOLDER, str(tmp_path / "kept"))
    return tmp_path / "kept"


class Builder:
    def __init__(self) -> None:
        self.built = 0

    def __call__(self) -> table_cache.Stored:
        self.built += 1
        return {"values": np.arange(3.0) / 7, "shape": np.ones((2, 0))}, {"error": 0.1, "names": ["a", "b"]}


def test_built_once(folder: Path) -> None:
    build = Builder()
    first, second = cached("film", {"a": 1.0}, build), cached("film", {"a": 1.0}, build)
    assert build.built == 1
    for arrays, metadata in (first, second):
        assert metadata == {"error": 0.1, "names": ["a", "b"]}
        assert arrays["values"].tolist() == [0, 1 / 7, 2 / 7] and arrays["shape"].shape == (2, 0)
    cached("film", {"a": np.nextafter(1.0, 2.0)}, build)
    assert build.built == 2
    assert len(list(folder.iterdir())) == 2 and all(path.suffix == ".npz" for path in folder.iterdir())


@pytest.mark.parametrize("damage", [b"", b"not a zip file", None])
def test_damaged_files_are_built_again(folder: Path, damage: bytes | None) -> None:
    build = Builder()
    cached("film", {"a": 1}, build)
    (path,) = folder.iterdir()
    path.write_bytes(path.read_bytes()[:-40] if damage is None else damage)
    cached("film", {"a": 1}, build)
    assert build.built == 2
    cached("film", {"a": 1}, build)
    assert build.built == 2


def test_a_folder_that_cannot_be_written_is_left_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv(FOLDER, str(tmp_path / "file" / "below"))
    build = Builder()
    assert cached("film", {"a": 1}, build)[1]["error"] == 0.1
    assert cached("film", {"a": 1}, build)[1]["error"] == 0.1
    assert build.built == 2


def test_nothing_is_kept_if_so_wished(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER, "")
    assert cache_folder() is None
    build = Builder()
    cached("film", {"a": 1}, build)
    cached("film", {"a": 1}, build)
    assert build.built == 2


def test_the_default_is_the_users_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(FOLDER, raising=False)
    folder = cache_folder()
    assert folder is not None and "skinbayes" in folder.parts
