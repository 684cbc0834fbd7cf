"""Damaged, exchanged and crafted files of a run: never a number that is silently another, and nothing is lost."""

from __future__ import annotations

import io
import json
import os
import shutil
import warnings
from collections import Counter
from pathlib import Path

import h5py
import numpy as np
import pytest
from damage import copied, damages, outcome
from small_models import same_draws, two_parameters

from skinbayes.cli import main
from skinbayes.errors import FingerprintMismatch, InputError, RepairWarning
from skinbayes.fit import Fit, load_fit, sample
from skinbayes.fit.netcdf import MOST_GROUPS, result_image
from skinbayes.problem import Problem, load_problem
from skinbayes.sealed import DamagedFile, checked, content_digest, read_note, sealed, sealed_note

SHORT = {"ess": 1e6, "max_steps": 300, "importance": False, "walkers": 16}
INPUTS = ("model.toml", "data/data.csv", "data/provenance.toml", "run.json")


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory) -> Problem:
    return two_parameters(tmp_path_factory.mktemp("model"))


@pytest.fixture(scope="module")
def run(problem: Problem, tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("runs") / "run"
    sample(problem, seed=1, directory=directory, **SHORT)
    assert len(list((directory / "steps").glob("segment-*.h5"))) == 3
    return directory


@pytest.fixture(scope="module")
def whole(run: Path) -> Fit:
    return load_fit(run)


def attack(file: Path, flips: int, seed: int, read: Path, whole: Fit) -> Counter[str]:
    """Damage a file in many ways one after the other; it is whole again afterwards."""
    content, met = file.read_bytes(), Counter()
    try:
        for changed in damages(content, flips, seed):
            file.write_bytes(changed)
            met[outcome(read, whole, file.name)] += 1
    finally:
        file.write_bytes(content)
    return met


# -- what is damaged is refused -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["result.nc", *INPUTS])
def test_damage_is_refused_by_the_name_of_the_file(run: Path, whole: Fit, name: str) -> None:
    met = attack(run / name, 30, 7, run, whole)
    assert met["refused"] >= 38
    # white space of JSON carries nothing; of any other file every bit counts
    assert not met["harmless"] or name == "run.json"


def test_damage_of_a_bare_file_is_refused(whole: Fit, tmp_path: Path) -> None:
    file = whole.save(tmp_path / "alone.nc")
    met = attack(file, 60, 8, file, whole)
    assert met["refused"] >= 60 and not met["harmless"]


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("name", ["result.nc", *INPUTS])
def test_every_bit_counts(run: Path, whole: Fit, name: str, seed: int) -> None:
    met = attack(run / name, 300, seed, run, whole)
    assert met["refused"] >= 280 and (not met["harmless"] or name == "run.json")


@pytest.mark.parametrize("flips", [20, pytest.param(300, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["header.json", "segment-000002.h5", "segment-000003.h5"])
def test_damaged_steps_are_made_again(problem: Problem, run: Path, name: str, flips: int) -> None:
    from skinbayes.sampling.ensembles import draw_identity
    from skinbayes.sampling.options import SamplerOptions
    from skinbayes.sampling.store import SampleStore

    identity = draw_identity(problem.target(), SamplerOptions(seed=1, **SHORT))
    rounds = SampleStore(run / "steps", resume=True).open(identity)
    content = (run / "steps" / name).read_bytes()
    for number, changed in enumerate(damages(content, flips, 9)):
        copy = Path(shutil.copytree(run / "steps", run.parent / f"steps-{name}-{flips}-{number}"))
        (copy / name).write_bytes(changed)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            try:
                found = SampleStore(copy, resume=True).open(identity)
            except InputError as error:  # a header that speaks of another run, or another version
                assert name == "header.json" and name in str(error) and "format" in str(error)
                continue
        assert len(found) == 3 or (told and name in str(told[0].message))
        for blocks, expected in zip(found, rounds, strict=False):
            for block, other in zip(blocks, expected, strict=True):
                assert np.array_equal(block.positions, other.positions)
                assert np.array_equal(block.log_density, other.log_density)
                assert np.array_equal(block.random_state[1], other.random_state[1])
                assert block.random_state[2:] == other.random_state[2:]
        shutil.rmtree(copy)


# -- exchanged files ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["result.nc", "run.json"])
def test_files_of_another_seed_are_not_taken(problem: Problem, run: Path, name: str, tmp_path: Path) -> None:
    other = tmp_path / "other"
    sample(problem, seed=2, directory=other, **SHORT)
    copy = copied(run, tmp_path)
    shutil.copyfile(other / name, copy / name)
    with pytest.raises(InputError, match="not the result of this run"):
        load_fit(copy)
    shutil.copytree(other / "steps", copy / "steps", dirs_exist_ok=True)
    with pytest.raises(FingerprintMismatch, match="sampler option seed is 2 there and 1 here"):
        sample(problem, seed=1, directory=copy, resume=True, **SHORT)


def test_segments_of_another_seed_are_not_taken(problem: Problem, run: Path, tmp_path: Path) -> None:
    sample(problem, seed=2, directory=tmp_path / "other", **SHORT)
    copy = copied(run, tmp_path)
    name = "steps/segment-000003.h5"
    shutil.copyfile(tmp_path / "other" / name, copy / name)
    with pytest.raises(FingerprintMismatch, match=r"segment-000003\.h5: belongs to another run"):
        sample(problem, seed=1, directory=copy, resume=True, **SHORT)


def test_an_edited_copy_of_the_data_is_told(run: Path, tmp_path: Path) -> None:
    copy = copied(run, tmp_path)
    data = copy / "data" / "data.csv"
    data.write_text(data.read_text().replace("1.00804", "1.00805", 1))
    with pytest.raises(InputError, match=r"data\.csv: damaged, or changed since the run was made.*--resume"):
        load_fit(copy)
    assert load_fit(copy / "result.nc").provenance["names"]  # as the message says


# -- and what to do helps -----------------------------------------------------------------------------------------------


QUICKLY = {
    ("damaged", "result.nc"), ("removed", "run.json"), ("damaged", "data/data.csv"), ("damaged", "steps/segment-000001.h5"),
    ("removed", "steps/segment-000003.h5"), ("damaged", "steps/header.json"),
}  # fmt: skip


@pytest.mark.parametrize(("how", "name"), [
    pytest.param(how, name, marks=() if (how, name) in QUICKLY else pytest.mark.slow)
    for name in ("result.nc", *INPUTS, "steps/segment-000003.h5", "steps/segment-000001.h5", "steps/header.json")
    for how in ("damaged", "removed")
])  # fmt: skip
def test_a_damaged_run_resumes_to_the_same(
    problem: Problem, run: Path, whole: Fit, name: str, how: str, tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    copy = copied(run, tmp_path)
    content = (copy / name).read_bytes()
    if how == "removed":
        (copy / name).unlink()
    else:
        (copy / name).write_bytes(content[: len(content) // 2] + b"?" + content[len(content) // 2 + 1 :])
    arguments = ["fit", str(problem.spec.path), "-o", str(copy), "--resume", "--json"]
    with pytest.raises(SystemExit) as ended:
        main(
            [
                *arguments,
                "--ess",
                "1000000",
                "--max-steps",
                "300",
                "--engine-option",
                "importance=false",
                "--engine-option",
                "walkers=16",
            ]
        )
    output, errors = capsys.readouterr()
    assert ended.value.code == 3 and json.loads(output)["steps"] == 300
    # a result is written at the end of every run, and a lost last block leaves no trace to speak of
    last = name == "steps/segment-000003.h5" and how == "removed"
    quiet = last or name == "result.nc"
    assert (Path(name).name in errors) is not quiet and errors.count("skinbayes: ") == (not quiet), errors
    again = load_fit(copy)
    same_draws(again, whole)
    assert again.problem is not None
    assert outcome(copy, again, "") == "harmless"


def test_a_damaged_note_of_a_run_is_not_replaced_by_that_of_another_model(run: Path, tmp_path: Path) -> None:
    copy = copied(run, tmp_path)
    (copy / "run.json").write_text("{")
    before = {file: file.read_bytes() for file in copy.rglob("*") if file.is_file()}
    for resume in (True, False):
        with pytest.raises(InputError, match=r"another model|holds a result already"):
            sample(load_problem("forearm-glass"), directory=copy, resume=resume, **SHORT)
    (copy / "steps" / "header.json").write_text("{")
    with pytest.raises(InputError, match=r"run\.json: damaged"):
        sample(load_problem("forearm-glass"), directory=copy, resume=True, **SHORT)
    before[copy / "steps" / "header.json"] = b"{"
    assert {file: file.read_bytes() for file in copy.rglob("*") if file.is_file()} == before


def test_a_result_that_is_not_listed_is_not_finished(run: Path, tmp_path: Path) -> None:
    copy = copied(run, tmp_path)
    note = read_note(copy / "run.json")
    del note["files"]["result.nc"]
    (copy / "run.json").write_bytes(sealed_note(note))
    with pytest.raises(InputError, match="not finished"):
        load_fit(copy)


def test_a_result_alone_is_not_joined_to_a_model_with_other_noise(tmp_path: Path) -> None:
    problem = two_parameters(tmp_path)
    fit = sample(problem, seed=1, directory=tmp_path / "run", **SHORT)
    file = fit.save(tmp_path / "alone.nc")
    same = load_fit(file).problem
    assert same is not None and same.fingerprint == problem.fingerprint
    model = problem.spec.path
    text = model.read_text()
    assert 'family = "lognormal"' in text
    model.write_text(text.replace('family = "lognormal"', 'family = "gaussian"'))
    with pytest.warns(RepairWarning, match="the model or its data are not what was fitted"):
        assert load_fit(file).problem is None


def test_a_model_that_cannot_be_built_again_is_told(run: Path, whole: Fit, tmp_path: Path) -> None:
    copy = copied(run, tmp_path)
    note = read_note(copy / "run.json")
    (copy / "run.json").write_bytes(sealed_note({**note, "settings": {"yield_stress": "5 furlong"}}))
    with pytest.warns(RepairWarning, match="cannot be built again"):
        read = load_fit(copy)
    assert read.problem is None
    same_draws(read, whole)


# -- notes that were made to confuse ------------------------------------------------------------------------------------


NOT_A_NOTE = [
    "", "{", "[]", "null", "3", "[" * 100_000, '{"a":' * 100_000, "\x00", "9" * 10_000, '{"model": "two"}',
]  # fmt: skip


@pytest.mark.parametrize("content", NOT_A_NOTE)
def test_a_note_of_a_run_that_is_none(run: Path, content: str, tmp_path: Path) -> None:
    copy = copied(run, tmp_path)
    (copy / "run.json").write_text(content)
    with pytest.raises(InputError, match=r"run\.json: damaged"):
        load_fit(copy)


@pytest.mark.parametrize(
    "change",
    [
        {"model": 3}, {"fingerprint": None}, {"data": ["data"]}, {"data": "/etc/passwd"}, {"data": "../data"},
        {"surface": {}}, {"rheology": 1.5}, {"settings": []}, {"settings": {"a": 1}}, {"rows": {"liquid": "water"}},
        {"rows": [1]}, {"files": None}, {"files": {"../model.toml": "0"}}, {"files": {"model.toml": 1}},
    ],
)  # fmt: skip
def test_a_note_of_a_run_with_wrong_values(run: Path, change: dict[str, object], tmp_path: Path) -> None:
    copy = copied(run, tmp_path)
    (copy / "run.json").write_bytes(sealed_note({**read_note(copy / "run.json"), **change}))
    with pytest.raises(InputError, match=rf"run\.json: damaged \('{next(iter(change))}'"):
        load_fit(copy)


def test_a_note_of_any_size_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "run.json").open("wb") as file:
        file.truncate(1 << 40)  # takes no room on disk
    with pytest.raises(DamagedFile):
        read_note(tmp_path / "run.json")
    with pytest.raises(DamagedFile, match="no checksum"):
        checked(tmp_path / "run.json")


def test_the_order_of_keys_means_nothing() -> None:
    assert content_digest({"a": 1, "b": 2}) == content_digest({"b": 2, "a": 1}) != content_digest({"a": 1})


# -- results that were made to confuse ----------------------------------------------------------------------------------


def replaced(name: str, **options: object):
    def change(file: h5py.File) -> None:
        del file[name]
        file.create_dataset(name, **options)

    return change


def removed(name: str):
    return lambda file: file.__delitem__(name)


def noted(**change: object):
    def apply(file: h5py.File) -> None:
        note = json.loads(file["posterior"].attrs["skinbayes"])
        file["posterior"].attrs["skinbayes"] = json.dumps({**note, **change})

    return apply


def filled(name: str, value: float):
    return lambda file: file[name].__setitem__((0,) * file[name].ndim, value)


MU = "posterior/frictional_shear_stress"
CRAFTED = {
    "no posterior": removed("posterior"),
    "no prior": removed("prior"),
    "no parameter": removed(MU),
    "no prior of it": removed("prior/noise_scale"),
    "no dimension": removed("posterior/draw"),
    "no data": removed("observed_data/friction_coefficient"),
    "no likelihood": removed("log_likelihood/friction_coefficient"),
    "text": replaced(MU, data=["a", "b"]),
    "other length": replaced(MU, data=np.ones(3)),
    "other dimensions": replaced(MU, data=np.ones((4, 2, 2))),
    "one number": replaced(MU, data=1.0),
    "nothing": replaced(MU, data=h5py.Empty("f8")),
    "declared size": replaced(MU, shape=(10**6, 10**6), dtype="f8", chunks=(1, 100)),
    "declared row": lambda file: file.create_dataset("constant_data/extra", (10**12,), "f8", chunks=(100,)),
    "compressed zeros": lambda file: file.create_dataset("prior/extra", shape=(10**8,), dtype="f8", chunks=(10**6,),
                                                         compression="gzip", fillvalue=0.0),
    "opaque": lambda file: file.create_dataset("prior/extra", data=np.void(b"abc")),
    "compound": lambda file: file.create_dataset("prior/extra", data=np.zeros(2, dtype=[("a", "f8")])),
    "outside": lambda file: file["prior"].__setitem__("extra", h5py.ExternalLink("other.nc", "/a")),
    "circle": lambda file: file["prior"].__setitem__("extra", file["prior"]),
    "data at the top": lambda file: file.create_dataset("extra", data=np.ones(3)),
    "many groups": lambda file: [file.create_group(f"g{i}") for i in range(2000)],
    "nan": filled(MU, np.nan),
    "infinite prior": filled("prior/noise_scale", np.inf),
    "infinite data": filled("observed_data/friction_coefficient", np.inf),
    "no note": lambda file: file["posterior"].attrs.__delitem__("skinbayes"),
    "number for a note": lambda file: file["posterior"].attrs.__setitem__("skinbayes", 5),
    "broken note": lambda file: file["posterior"].attrs.__setitem__("skinbayes", "{"),
    "deep note": lambda file: file["posterior"].attrs.__setitem__("skinbayes", "[" * 50_000),
    "list for a note": lambda file: file["posterior"].attrs.__setitem__("skinbayes", "[1]"),
    "names": noted(names="frictional_shear_stress"),
    "numbers for names": noted(names=[1, 2]),
    "unknown name": noted(names=["frictional_shear_stress", "another"]),
    "a level of none": noted(names=["frictional_shear_stress[dry]", "noise_scale"]),
    "no names": noted(names=[]),
    "sampling": noted(sampling=[]),
    "no sampling": noted(sampling={}),
    "convergence": noted(sampling={"converged": "yes", "ess_bulk": [1, 1], "ess_tail": [1, 1], "r_hat": [1, 1]}),
    "r_hat": noted(sampling={"converged": True, "ess_bulk": [1, 1], "ess_tail": [1, 1], "r_hat": ["a", "b"]}),
    "observables": noted(observables=["another"]),
    "model": noted(model=5),
}  # fmt: skip


def crafted(whole: Fit, change) -> bytes:
    """A result with a valid checksum whose content was changed."""
    image = io.BytesIO(result_image(whole.groups, whole.provenance))
    with h5py.File(image, "r+") as file:
        change(file)
    return sealed(image.getvalue())


@pytest.mark.parametrize("name", CRAFTED)
def test_a_result_made_to_confuse_is_refused(whole: Fit, name: str, tmp_path: Path) -> None:
    file = tmp_path / "crafted.nc"
    file.write_bytes(crafted(whole, CRAFTED[name]))
    with pytest.raises(InputError, match=r"crafted\.nc: damaged, or not a result"):
        load_fit(file)


def test_what_is_crafted_is_whole_but_for_the_change(whole: Fit, tmp_path: Path) -> None:
    file = tmp_path / "crafted.nc"
    file.write_bytes(crafted(whole, lambda opened: None))
    same_draws(load_fit(file), whole)
    assert len(whole.groups) < MOST_GROUPS


def test_a_result_that_was_edited_by_other_programs_is_told(whole: Fit, tmp_path: Path) -> None:
    file = whole.save(tmp_path / "edited.nc")
    with h5py.File(file, "r+") as opened:
        opened[MU][0, 0] *= 2
    with pytest.raises(InputError, match=r"edited\.nc: damaged"):
        load_fit(file)


def test_what_is_no_ordinary_file_is_not_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.nc")
    with pytest.raises(InputError, match="no result found"):
        load_fit(tmp_path / "pipe.nc")
