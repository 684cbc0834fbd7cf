"""The store: what is put in comes out, and what does not belong or is damaged is refused by name."""

from __future__ import annotations

import json

import numpy as np
import pytest
from sampling_targets import UnitGaussian

from skinbayes.errors import FingerprintMismatch, InputError
from skinbayes.sampling.advance import Block
from skinbayes.sampling.ensembles import draw_identity, run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.store import HEADER, SampleStore

IDENTITY = {"model or data (fingerprint)": "abc", "sampler option seed": 1}
OPTIONS = SamplerOptions(seed=1, ensembles=2, walkers=8, block_steps=5, max_steps=10)


def block(seed):
    generator = np.random.RandomState(seed)
    positions = generator.normal(size=(5, 8, 2))  # an odd number of draws leaves a cached one
    generator.normal()
    return Block(
        positions,
        generator.normal(size=(5, 8)),
        generator.get_state(),
        40,
        2,
        generator.normal(size=positions.shape[-1]),
    )


def assert_same(first, second):
    assert np.array_equal(first.positions, second.positions)
    assert np.array_equal(first.log_density, second.log_density)
    assert first.random_state[0] == second.random_state[0]
    assert np.array_equal(first.random_state[1], second.random_state[1])
    assert first.random_state[2:] == second.random_state[2:]
    assert (first.evaluations, first.invalid) == (second.evaluations, second.invalid)
    assert np.array_equal(first.first_invalid, second.first_invalid)


@pytest.fixture
def stored(tmp_path):
    """A store of three rounds of two ensembles."""
    path = tmp_path / "steps"
    store = SampleStore(path)
    assert store.open(IDENTITY) == []
    for number in range(3):
        store.append([block(2 * number), block(2 * number + 1)])
    return path


def test_blocks_come_back_to_the_last_bit(stored):
    rounds = SampleStore(stored, resume=True).open(IDENTITY)
    assert len(rounds) == 3
    for number, blocks in enumerate(rounds):
        for ensemble in range(2):
            assert_same(blocks[ensemble], block(2 * number + ensemble))


def test_more_blocks_follow(stored):
    store = SampleStore(stored, resume=True)
    store.open(IDENTITY)
    store.append([block(6), block(7)])
    rounds = SampleStore(stored, resume=True).open(IDENTITY)
    assert len(rounds) == 4
    assert_same(rounds[3][1], block(7))


def test_files_are_never_written_twice(stored):
    before = {file.name: (file.stat().st_mtime_ns, file.read_bytes()) for file in stored.iterdir()}
    store = SampleStore(stored, resume=True)
    store.open(IDENTITY)
    store.append([block(6), block(7)])
    after = {file.name: (file.stat().st_mtime_ns, file.read_bytes()) for file in stored.iterdir()}
    assert set(after) - set(before) == {"segment-000004.h5"}
    assert {name: after[name] for name in before} == before


def test_a_run_is_not_overwritten(stored):
    with pytest.raises(InputError, match="holds a run of 3 blocks"):
        SampleStore(stored).open(IDENTITY)


def test_resuming_nothing_starts_anew(tmp_path):
    assert SampleStore(tmp_path / "new", resume=True).open(IDENTITY) == []
    assert SampleStore(tmp_path / "new", resume=True).open(IDENTITY) == []


def test_other_files_do_no_harm(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    store = SampleStore(tmp_path)
    assert store.open(IDENTITY) == []
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_a_file_in_the_way(tmp_path):
    (tmp_path / "steps").write_text("")
    with pytest.raises(InputError, match="a file found, a directory expected"):
        SampleStore(tmp_path / "steps").open(IDENTITY)


def test_leftovers_of_a_killed_run_are_removed(stored):
    (stored / "segment-000004.h5.partial").write_bytes(b"\x89HDF half a fi")
    (stored / "header.json.partial").write_text("{")
    assert len(SampleStore(stored, resume=True).open(IDENTITY)) == 3
    assert not list(stored.glob("*.partial"))


@pytest.mark.parametrize(
    ("part", "value"), [("model or data (fingerprint)", "xyz"), ("sampler option seed", 2)]
)
def test_the_part_that_differs_is_named(stored, part, value):
    with pytest.raises(FingerprintMismatch) as caught:
        SampleStore(stored, resume=True).open({**IDENTITY, part: value})
    assert f"{part} is {IDENTITY[part]!r} there and {value!r} here" in str(caught.value)
    for other in set(IDENTITY) - {part}:
        assert other not in str(caught.value)


def test_a_segment_of_another_run_is_refused(stored, tmp_path):
    other = SampleStore(tmp_path / "other")
    other.open({**IDENTITY, "sampler option seed": 2})
    other.append([block(0), block(1)])
    (tmp_path / "other" / "segment-000001.h5").replace(stored / "segment-000002.h5")
    with pytest.raises(FingerprintMismatch, match=r"segment-000002\.h5: belongs to another run"):
        SampleStore(stored, resume=True).open(IDENTITY)


def test_a_missing_segment_is_named(stored):
    (stored / "segment-000002.h5").unlink()
    with pytest.raises(InputError, match=r"segment-000002\.h5: missing"):
        SampleStore(stored, resume=True).open(IDENTITY)


@pytest.mark.parametrize("damage", ["truncated", "empty", "flipped", "text"])
def test_a_damaged_segment_is_named(stored, damage):
    file = stored / "segment-000002.h5"
    content = bytearray(file.read_bytes())
    if damage == "truncated":
        content = content[: len(content) // 2]
    if damage == "empty":
        content = bytearray()
    if damage == "flipped":
        place = content.index(block(2).positions[0, 0].tobytes())
        content[place] ^= 1
    if damage == "text":
        content = bytearray(b"not HDF5 at all\n" * 100)
    file.write_bytes(content)
    with pytest.raises(InputError, match=r"segment-000002\.h5: damaged"):
        SampleStore(stored, resume=True).open(IDENTITY)


@pytest.mark.parametrize("content", ["", "{", "[]", '{"format": 1}', "\x00"])
def test_a_damaged_header_is_named(stored, content):
    (stored / HEADER).write_text(content)
    with pytest.raises(InputError, match=r"header\.json: cannot be read"):
        SampleStore(stored, resume=True).open(IDENTITY)


def test_a_missing_header_is_named(stored):
    (stored / HEADER).unlink()
    with pytest.raises(InputError, match=r"header\.json: missing"):
        SampleStore(stored, resume=True).open(IDENTITY)


def test_a_later_format_is_named(stored):
    content = json.loads((stored / HEADER).read_text())
    (stored / HEADER).write_text(json.dumps({**content, "format": 99}))
    with pytest.raises(InputError, match="store format 99 found, 1 expected"):
        SampleStore(stored, resume=True).open(IDENTITY)


def test_a_place_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        SampleStore(tmp_path / "file" / "steps").open(IDENTITY)


def test_the_identity_holds_what_changes_draws_and_nothing_else():
    target = UnitGaussian(2)
    base = draw_identity(target, OPTIONS)
    for change in ({"ess": 9.0}, {"max_steps": 500}, {"cores": 2}, {"vectorize": False}, {"r_hat": 1.1}):
        assert draw_identity(target, SamplerOptions(**{**OPTIONS.__dict__, **change})) == base
    for change in ({"seed": 9}, {"ensembles": 3}, {"walkers": 10}, {"block_steps": 10}):
        assert draw_identity(target, SamplerOptions(**{**OPTIONS.__dict__, **change})) != base
    assert draw_identity(UnitGaussian(2, spread=2.0), OPTIONS) != base


def test_a_run_leaves_its_steps_in_the_store(tmp_path):
    target = UnitGaussian(2)
    chains = run_ensembles(target, OPTIONS, store=SampleStore(tmp_path))
    rounds = SampleStore(tmp_path, resume=True).open(draw_identity(target, OPTIONS))
    for ensemble in range(2):
        steps = np.concatenate([blocks[ensemble].positions for blocks in rounds])
        assert np.array_equal(steps, chains.positions[ensemble])
