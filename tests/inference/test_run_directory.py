"""A run directory is new, empty or a run; nothing of anybody else's is overwritten, in it or through a link."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from small_models import same_draws, three_parameters
from small_runs import small_problem, small_run, tree

from skinbayes.errors import FingerprintMismatch, InputError
from skinbayes.fit import Fit, load_fit
from skinbayes.fit.run_directory import RunDirectory


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Fit:
    return small_run(small_problem(tmp_path_factory.mktemp("whole")))


FOREIGN = {
    "model": {"model.toml": "mine"},
    "note": {"run.json": "{}"},
    "likeness": {"run.json": '{"model": "x", "fingerprint": "y", "data": null}'},
    "damaged": {"run.json": "\x00{"},
    "list": {"run.json": "[]"},
    "summary": {"summary.csv": "a,b\n"},
    "data": {"data/data.csv": "a,b\n"},
    "everything": {"model.toml": "m", "run.json": "[1]", "summary.csv": "s", "data/data.csv": "d", "result.nc": "r"},
    "others": {"thesis.tex": "t", "steps/notes.txt": "n"},
    "hidden": {".git/config": "c"},
}  # fmt: skip


@pytest.mark.parametrize("resume", [False, True])
@pytest.mark.parametrize("kind", FOREIGN)
def test_a_folder_of_the_user_is_left_alone(kind: str, resume: bool, tmp_path: Path) -> None:
    problem, folder = small_problem(tmp_path / "model"), tmp_path / "mine"
    for name, content in FOREIGN[kind].items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content)
    before = tree(folder)
    with pytest.raises(InputError, match="is no run of skinbayes"):
        small_run(problem, folder, resume=resume)
    assert tree(folder) == before


def test_a_file_or_a_dangling_link_is_no_folder(tmp_path: Path) -> None:
    problem = small_problem(tmp_path / "model")
    (tmp_path / "file").write_text("mine")
    (tmp_path / "link").symlink_to(tmp_path / "nowhere")
    for name in ("file", "file/below", "link"):
        with pytest.raises(InputError, match=name):
            small_run(problem, tmp_path / name)
    assert (tmp_path / "file").read_text() == "mine" and not (tmp_path / "nowhere").exists()


def test_new_empty_and_linked_folders_are_used(tmp_path: Path, whole: Fit) -> None:
    problem = small_problem(tmp_path / "model")
    (tmp_path / "empty").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "elsewhere")
    for name in ("empty", "link", "new/below"):
        same_draws(small_run(problem, tmp_path / name), whole)
        same_draws(load_fit(tmp_path / name), whole)
    assert (tmp_path / "link").is_symlink() and (tmp_path / "elsewhere" / "run.json").exists()


def test_what_a_killed_start_leaves_is_no_obstacle(tmp_path: Path, whole: Fit) -> None:
    problem, folder = small_problem(tmp_path / "model"), tmp_path / "run"
    folder.mkdir()
    (folder / ".skinbayes.lock").write_text("process 1 on another")
    (folder / ".0123456789abcdef.partial").write_text("half")
    same_draws(small_run(problem, folder), whole)
    assert set(tree(folder)) >= {"run.json", "model.toml", "result.nc"}
    assert not [name for name in tree(folder) if name.startswith(".")]


def test_a_start_killed_between_its_files_is_made_good(tmp_path: Path) -> None:
    problem, folder = small_problem(tmp_path / "model"), tmp_path / "run"
    with RunDirectory(folder, problem, resume=False):
        pass
    complete = tree(folder)
    for resume in (False, True):
        (folder / "model.toml").unlink()
        with RunDirectory(folder, problem, resume=resume):
            pass
        assert tree(folder) == complete
    with pytest.raises(FingerprintMismatch, match="holds a run of 'two'"):
        small_run(three_parameters(tmp_path), folder)


FILES = ("model.toml", "run.json", "result.nc", "summary.csv", "steps/segment-000003.h5", "steps/header.json")


def test_files_are_not_written_through_links(tmp_path: Path, whole: Fit) -> None:
    """Every file of a run in turn replaced by a link to a file of the user with the same content."""
    problem, folder, mine = small_problem(tmp_path / "model"), tmp_path / "run", tmp_path / "mine"
    mine.mkdir()
    small_run(problem, folder)
    for name in FILES:
        (folder / name).replace(mine / Path(name).name)
        (folder / name).symlink_to(mine / Path(name).name)
    # and names under which files might be made before they are renamed
    (mine / "more").write_text("mine")
    for name in ("result.nc.part", "steps/segment-000005.h5.partial", "summary.csv.part"):
        (folder / name).symlink_to(mine / "more")
    (folder / "steps/segment-000005.h5.part").symlink_to(tmp_path / "nowhere")
    before = tree(mine)
    same_draws(small_run(problem, folder, resume=True), whole)
    small_run(problem, folder, resume=True, max_steps=300)
    assert tree(mine) == before and not (tmp_path / "nowhere").exists()
    assert not (folder / "result.nc").is_symlink() and not (folder / "summary.csv").is_symlink()


@pytest.mark.parametrize("name", ["data", "steps", "baseline-models"])
def test_linked_folders_are_refused(name: str, tmp_path: Path) -> None:
    problem, folder, mine = small_problem(tmp_path / "model"), tmp_path / "run", tmp_path / "mine"
    with RunDirectory(folder, problem, resume=False):
        pass
    mine.mkdir()
    (mine / "data.csv").write_text("mine")
    if (folder / name).is_dir():
        for path in (folder / name).iterdir():
            path.unlink()
        (folder / name).rmdir()
    (folder / name).symlink_to(mine)
    before = tree(mine)
    with pytest.raises(InputError, match=rf"{name}: a link found"):
        small_run(problem, folder, resume=True)
    assert tree(mine) == before


def test_a_lock_that_is_a_link_is_not_followed(tmp_path: Path) -> None:
    problem, folder = small_problem(tmp_path / "model"), tmp_path / "run"
    folder.mkdir()
    (tmp_path / "mine").write_text("mine")
    (folder / ".skinbayes.lock").symlink_to(tmp_path / "mine")
    with pytest.raises(InputError, match="cannot be used for a run"):
        small_run(problem, folder)
    assert (tmp_path / "mine").read_text() == "mine"


def test_steps_without_a_result_are_finished(tmp_path: Path, whole: Fit) -> None:
    problem, folder = small_problem(tmp_path / "model"), tmp_path / "run"
    small_run(problem, folder)
    for name in ("result.nc", "summary.csv"):
        (folder / name).unlink()
    with pytest.raises(InputError, match="not finished"):
        load_fit(folder)
    small_run(problem, folder, resume=True)
    same_draws(load_fit(folder), whole)
    assert (folder / "summary.csv").exists()
    assert json.loads((folder / "run.json").read_text())["format"].startswith("skinbayes")
