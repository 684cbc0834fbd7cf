"""Tables kept on disk: found again, built again when damaged, never in the way."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from skinbayes.emulation import FOLDER, Unfinished, cache_folder, cached
from skinbayes.emulation import cache as table_cache


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(FOLDER, str(tmp_path / "kept"))
    return tmp_path / "kept"


class Builder:
    def __init__(self) -> None:
        self.built = 0

    def __call__(self, unfinished: Unfinished) -> table_cache.Stored:
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
    assert len(list(folder.iterdir())) == 2 and all(path.suffix == ".table" for path in folder.iterdir())


def flipped(content: bytes, rng: np.random.Generator) -> bytes:
    changed = bytearray(content)
    changed[rng.integers(len(content))] ^= 1 << int(rng.integers(8))
    return bytes(changed)


DAMAGE: dict[str, Callable[[bytes, np.random.Generator], bytes]] = {
    "empty": lambda content, rng: b"",
    "another file": lambda content, rng: b"not a table",
    "cut": lambda content, rng: content[: rng.integers(len(content))],
    "longer": lambda content, rng: content + b"\0",
    "a bit": flipped,
    "zeros": lambda content, rng: content[:60] + bytes(len(content) - 60),
    "random bytes": lambda content, rng: rng.bytes(len(content)),
    "random bytes below the heading": lambda content, rng: content[:18] + rng.bytes(len(content) - 18),
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_damaged_files_are_built_again(folder: Path, kind: str) -> None:
    build, rng = Builder(), np.random.default_rng(1)
    cached("film", {"a": 1}, build)
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    for attempt in range(2, 32):
        path.write_bytes(DAMAGE[kind](whole, rng))
        arrays, metadata = cached("film", {"a": 1}, build)
        assert (
            build.built == attempt
            and arrays["values"].tolist() == [0, 1 / 7, 2 / 7]
            and metadata["error"] == 0.1
        )
        assert path.read_bytes()[:18] == whole[:18]
        cached("film", {"a": 1}, build)
        assert build.built == attempt


def test_a_file_of_objects_or_of_another_key_is_built_again(folder: Path) -> None:
    build = Builder()
    cached("film", {"a": 1}, build)
    (path,) = folder.iterdir()
    for arrays, key in (
        ({"values": np.array([{}], dtype=object)}, '{"a": 1}'),
        ({"values": np.ones(3)}, '{"a": 2}'),
    ):
        table_cache._write(path, key, (arrays, {}))
        assert cached("film", {"a": 1}, build)[0]["values"].tolist() == [0, 1 / 7, 2 / 7]
    assert build.built == 3


@pytest.mark.parametrize("kind", ["folder", "pipe", "unreadable"])
def test_what_is_no_file_is_left_alone(folder: Path, kind: str) -> None:
    build = Builder()
    cached("film", {"a": 1}, build)
    (path,) = folder.iterdir()
    if kind == "unreadable":
        path.chmod(0)
    else:
        path.unlink()
        path.mkdir() if kind == "folder" else os.mkfifo(path)
    for _ in range(2):
        assert cached("film", {"a": 1}, build)[1]["error"] == 0.1
    assert not list(folder.glob(".*"))


def test_a_build_goes_on_where_it_stopped(folder: Path) -> None:
    def stopped(unfinished: Unfinished) -> table_cache.Stored:
        assert unfinished.load() == {}
        unfinished.save({"done": np.arange(4.0) / 3})
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        cached("film", {"a": 1}, stopped)
    seen = []

    def resumed(unfinished: Unfinished) -> table_cache.Stored:
        seen.append(unfinished.load()["done"].tolist())
        return Builder()(unfinished)

    cached("film", {"a": 1}, resumed)
    assert seen == [[0, 1 / 3, 2 / 3, 1]]
    assert [path.suffix for path in folder.iterdir()] == [".table"]


def test_what_a_killed_process_left_behind_goes(folder: Path) -> None:
    folder.mkdir()
    old, new = folder / ".old.part", folder / ".new.part"
    for path in (old, new):
        path.write_text("half")
    os.utime(old, (0, 0))
    cached("film", {"a": 1}, Builder())
    assert new.exists() and not old.exists()


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
