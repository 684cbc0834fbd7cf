"""Tables kept on disk: found again, built again when damaged, never in the way."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from skinbayes.emulation import FOLDER, Box, Unfinished, cache_folder, cached, kept_table
from skinbayes.emulation import cache as table_cache
from skinbayes.forward import Tables, forward_model


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


def test_a_table_that_cannot_be_is_kept_as_such(folder: Path) -> None:
    asked: list[Unfinished] = []

    def build(unfinished: Unfinished) -> Box | None:
        asked.append(unfinished)
        return None if len(asked) == 1 else Box({"a": (0.0, 1.0)})

    for _ in range(3):
        assert kept_table("box", {"a": 1}, Box, build) is None
    assert len(asked) == 1
    for _ in range(2):
        box = kept_table("box", {"a": 2}, Box, build)
        assert box is not None and box.varying == ("a",)
    assert len(asked) == 2
    assert kept_table("box", None, Box, build) is not None and len(asked) == 3


SKIN = {
    "young_modulus_bulk": 2e4, "layer_thickness": 2e-5, "rms_height": 22.4e-6, "hurst_exponent": 0.78, "wavevector_min": 1e3,
    "wavevector_rolloff": 6.345e3, "wavevector_max": 1e9, "nominal_pressure": 6830.0, "frictional_shear_stress": 15e6,
    "contact_angle_skin": 1.4, "contact_angle_counterface": 0.0,
}  # fmt: skip
AIR = {"relative_humidity": 0.6, "temperature": 293.15, "young_modulus_layer": 7e6}
WATER = {
    "time": 300.0, "wetting_time": 30.0, "initial_film": 9e-5, "evaporation_rate": 1.7e-7, "surface_tension": 0.0727,
    "young_modulus_layer": 7e6, "young_modulus_layer_dry": 1e9,
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "conditions", "module"),
    [("humid-air", AIR, "humid_air_table.humid_table"), ("drying", WATER, "drying_table.bridge_table")],
)
def test_tables_of_bridges_are_kept(
    folder: Path, monkeypatch: pytest.MonkeyPatch, name: str, conditions: dict[str, float], module: str
) -> None:
    model, given = forward_model(name), SKIN | conditions
    ranges = {key: (value, value) for key, value in (given | model.defaults(given)).items()}
    ranges |= {"young_modulus_layer": (6.5e6, 7.5e6)}
    inputs = {key: np.array([[low]]) for key, (low, _) in ranges.items()}
    inputs["young_modulus_layer"] = np.array([[6.7e6], [7.2e6]])
    assert model.prepare is not None
    found = []
    for _ in range(2):
        ready = model.prepare(model, ranges, Tables(), None, 1)
        assert "interpolated" in ready.accuracy
        found.append(ready.evaluate(inputs, Tables()))
        # from now on there is nothing to build a table with
        monkeypatch.setattr(f"skinbayes.forward.{module}", None)
    assert len(list(folder.glob("*.table"))) == 1
    for observable, values in found[0].items():
        np.testing.assert_array_equal(values, found[1][observable])
    # another box is another table
    with pytest.raises(TypeError):
        model.prepare(model, ranges | {"young_modulus_layer": (6e6, 7.5e6)}, Tables(), None, 1)
