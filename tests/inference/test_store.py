"""The store: what is put in comes out, and what does not belong or is damaged is refused by name."""

from __future__ import annotations

import io
import json

import h5py
import numpy as np
import pytest
from sampling_targets import UnitGaussian

from skinbayes.errors import FingerprintMismatch, InputError, RepairWarning
from skinbayes.sampling.advance import EnsembleSteps
from skinbayes.sampling.ensembles import draw_identity, run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.segments import segment_image
from skinbayes.sampling.store import HEADER, SampleStore
from skinbayes.sealed import content_digest, sealed, sealed_note

IDENTITY = {"model or data (fingerprint)": "abc", "sampler option seed": 1}
OPTIONS = SamplerOptions(importance=False, seed=1, ensembles=2, walkers=8, block_steps=5, max_steps=10)


def block(seed):
    generator = np.random.RandomState(seed)
    positions = generator.normal(size=(5, 8, 2))  # an odd number of draws leaves a cached one
    generator.normal()
    return EnsembleSteps(
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


def first_rounds(stored, count, trouble):
    """Resume a damaged store of three rounds: the first ``count`` are whole, and what is wrong is said."""
    with pytest.warns(RepairWarning, match=trouble) as told:
        store = SampleStore(stored, resume=True)
        rounds = store.open(IDENTITY)
    assert len(told) == 1
    assert len(rounds) == count
    for number, blocks in enumerate(rounds):
        for ensemble in range(2):
            assert_same(blocks[ensemble], block(2 * number + ensemble))
    return store


def test_steps_after_a_missing_segment_are_put_aside(stored):
    later = (stored / "segment-000003.h5").read_bytes()
    (stored / "segment-000002.h5").unlink()
    store = first_rounds(stored, 1, r"segment-000002\.h5: missing")
    assert (stored / "segment-000003.h5.damaged").read_bytes() == later
    store.append([block(2), block(3)])
    store.append([block(4), block(5)])
    assert (stored / "segment-000003.h5").read_bytes() == later  # made again, the same to the last bit
    assert len(SampleStore(stored, resume=True).open(IDENTITY)) == 3


def damaged(content, how):
    if how == "truncated":
        return content[: len(content) // 2]
    if how == "shorter by a byte":
        return content[:-1]
    if how == "longer by a byte":
        return content + b"\n"
    if how == "empty":
        return b""
    if how == "text":
        return b"not HDF5 at all\n" * 100
    changed = bytearray(content)
    if how == "flipped":
        changed[len(content) // 3] ^= 1
    else:
        changed[512:1024] = bytes(512)
    return bytes(changed)


@pytest.mark.parametrize("number", [1, 2, 3])
@pytest.mark.parametrize(
    "how", ["truncated", "shorter by a byte", "longer by a byte", "empty", "text", "flipped", "zeroed"]
)
def test_a_damaged_segment_is_named_and_put_aside(stored, number, how):
    file = stored / f"segment-{number:06d}.h5"
    file.write_bytes(damaged(file.read_bytes(), how))
    content = file.read_bytes()
    first_rounds(stored, number - 1, rf"segment-{number:06d}\.h5: damaged")
    assert file.with_name(file.name + ".damaged").read_bytes() == content
    assert not list(stored.glob("segment-000003.h5"))
    assert len(SampleStore(stored, resume=True).open(IDENTITY)) == number - 1  # nothing more to say


def test_what_was_put_aside_before_stays(stored):
    file = stored / "segment-000003.h5"
    for number in range(3):
        file.write_bytes(b"%d" % number)
        first_rounds(stored, 2, "damaged")
    names = ["segment-000003.h5.damaged", "segment-000003.h5.damaged-2", "segment-000003.h5.damaged-3"]
    assert [(stored / name).read_bytes() for name in names] == [b"0", b"1", b"2"]


def test_a_segment_in_the_place_of_another_is_not_taken(stored):
    # whole, and of this run
    (stored / "segment-000002.h5").write_bytes((stored / "segment-000003.h5").read_bytes())
    first_rounds(stored, 1, r"segment-000002\.h5: damaged .*does not follow")


def test_a_stray_segment_is_put_aside(stored):
    (stored / "segment-000003.h5").rename(stored / "segment-000009.h5")
    first_rounds(stored, 2, r"segment-000003\.h5: missing")
    for name in ("segment-abc.h5", "segment-9.h5", "segment-00000４.h5", "segment-.h5"):
        (stored / name).write_text("mine")
    (stored / "segment-000003.h5").mkdir()
    first_rounds(stored, 2, r"segment-000003\.h5: damaged \(no ordinary file\)")
    assert (stored / "segment-abc.h5").read_text() == "mine"


NOT_A_HEADER = [
    "", "{", "[]", "3", '{"format": 1}', "\x00", "[" * 100_000, '{"a":' * 100_000, '{"format": 2, "identity": 5}',
    '{"format": [2], "identity": {}, "sha256": {}}', "9" * 10_000,
]  # fmt: skip


@pytest.mark.parametrize("content", NOT_A_HEADER)
def test_a_damaged_header_is_named_and_written_again(stored, content):
    whole = (stored / HEADER).read_bytes()
    (stored / HEADER).write_text(content)
    first_rounds(stored, 3, r"header\.json: damaged")
    assert (stored / HEADER).read_bytes() == whole
    assert (stored / f"{HEADER}.damaged").read_text() == content


def test_a_missing_header_is_written_again(stored):
    whole = (stored / HEADER).read_bytes()
    (stored / HEADER).unlink()
    first_rounds(stored, 3, r"header\.json: missing")
    assert (stored / HEADER).read_bytes() == whole


@pytest.mark.parametrize("content", ["", None])
def test_without_a_header_steps_of_another_run_are_refused(stored, content):
    (stored / HEADER).unlink()
    if content is not None:
        (stored / HEADER).write_text(content)
    before = {file.name for file in stored.iterdir()}
    with pytest.raises(FingerprintMismatch, match=r"segment-000001\.h5: belongs to another run"):
        SampleStore(stored, resume=True).open({**IDENTITY, "sampler option seed": 2})
    assert {file.name for file in stored.iterdir()} == before


def crafted(change):
    """A segment with a valid checksum whose content was changed."""
    image = io.BytesIO(segment_image([block(4), block(5)], content_digest(IDENTITY), [block(2), block(3)]))
    with h5py.File(image, "r+") as file:
        change(file)
    return sealed(image.getvalue())


def other(name, **options):
    def change(file):
        del file[name]
        if options:
            file.create_dataset(name, **options)

    return change


CRAFTED = {
    "missing": other("positions"),
    "declared size": other("log_density", shape=(2, 5, 10**12), dtype="f8", chunks=(1, 1, 100)),
    "compressed": other("log_density", data=np.zeros((2, 5, 80_000)), compression="gzip"),
    "text": other("evaluations", data=["a", "b"]),
    "scalar": other("evaluations", data=3),
    "nothing": other("evaluations", data=h5py.Empty("i8")),
    "another size": other("first_invalid", data=np.zeros((2, 7))),
    "more ensembles": other("evaluations", data=np.zeros(3, dtype=np.int64)),
    "single precision": other("log_density", data=np.zeros((2, 5, 8), dtype="f4")),
    "group": lambda file: (other("positions")(file), file.create_group("positions")),
    "no identity": lambda file: file.attrs.__delitem__("identity"),
    "numbers for identity": lambda file: file.attrs.__setitem__("follows", np.zeros(3)),
    "link": lambda file: (other("positions")(file), file.__setitem__("positions", h5py.SoftLink("/a"))),
}


@pytest.mark.parametrize("name", CRAFTED)
def test_a_segment_made_to_confuse_is_put_aside(stored, name):
    (stored / "segment-000003.h5").write_bytes(crafted(CRAFTED[name]))
    first_rounds(stored, 2, r"segment-000003\.h5: damaged")


def test_what_is_crafted_is_whole_but_for_the_change(stored):
    (stored / "segment-000003.h5").write_bytes(crafted(lambda file: None))
    assert len(SampleStore(stored, resume=True).open(IDENTITY)) == 3


def test_a_later_format_is_named(stored):
    content = json.loads((stored / HEADER).read_text())
    del content["sha256"]
    (stored / HEADER).write_bytes(sealed_note({**content, "format": 99}))
    with pytest.raises(InputError, match="store format 99 found, 2 expected"):
        SampleStore(stored, resume=True).open(IDENTITY)


def test_a_place_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        SampleStore(tmp_path / "file" / "steps").open(IDENTITY)


def test_the_identity_holds_what_changes_draws_and_nothing_else():
    target = UnitGaussian(2)
    base = draw_identity(target, OPTIONS)
    for change in ({"ess": 9.0}, {"max_steps": 500}, {"cores": 2}, {"r_hat": 1.1}):
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
