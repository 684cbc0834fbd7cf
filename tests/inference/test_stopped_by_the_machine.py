"""Full disks, folders that are carried off, two processes in one folder: said in a sentence, nothing lost."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from small_models import same_draws
from small_runs import after, small_problem, small_run, tree

from skinbayes.errors import InputError, MachineError
from skinbayes.fit import Fit, load_fit, run_contents, run_directory
from skinbayes.fit.run_directory import RunDirectory


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Fit:
    return small_run(small_problem(tmp_path_factory.mktemp("whole")))


# -- folders ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("steps", [0, 100, 200])
def test_a_renamed_folder_is_noticed_and_named(steps: int, tmp_path: Path, whole: Fit) -> None:
    problem, folder, moved = small_problem(tmp_path / "model"), tmp_path / "run", tmp_path / "moved to"
    with pytest.raises(MachineError, match=f"is now {moved}.*-o '{moved}' --resume"):
        small_run(problem, folder, progress=after(steps, lambda: folder.rename(moved)))
    assert not folder.exists()
    same_draws(small_run(problem, moved, resume=True), whole)


def remove_all(run: Path) -> None:
    shutil.rmtree(run)


def replace(run: Path) -> None:
    shutil.rmtree(run)
    (run / "steps").mkdir(parents=True)
    (run / "notes.txt").write_text("mine")


def remove_steps(run: Path) -> None:
    shutil.rmtree(run / "steps")


@pytest.mark.parametrize("steps", [50, 200])
@pytest.mark.parametrize("act", [remove_all, replace, remove_steps])
def test_what_was_removed_is_written_beside(
    act: Callable[[Path], None], steps, tmp_path: Path, whole: Fit
) -> None:
    problem, folder, kept = small_problem(tmp_path / "model"), tmp_path / "run", tmp_path / "run-kept"
    left: dict[str, object] = {}

    def strike() -> None:
        act(folder)
        left.update(tree(folder))

    with pytest.raises(MachineError, match=f"renamed, removed or replaced.*in {kept}.*-o {kept} --resume"):
        small_run(problem, folder, progress=after(steps, strike))
    assert {name for name in tree(folder) if not name.endswith(".lock")} == {
        name for name in left if not name.endswith(".lock")
    }
    made: list[int] = []
    same_draws(small_run(problem, kept, resume=True, progress=lambda p: made.append(p.steps)), whole)
    assert made[0] == min(steps + 50, 200)  # the block under way was in memory, and is kept too


def test_a_folder_that_is_gone_with_all_above_it(tmp_path: Path) -> None:
    problem, above = small_problem(tmp_path / "model"), tmp_path / "above"
    with pytest.raises(MachineError, match=r"renamed, removed or replaced.*above/run-kept"):
        small_run(problem, above / "run", progress=after(50, lambda: shutil.rmtree(above)))
    assert (above / "run-kept" / "run.json").exists()


@pytest.mark.parametrize("at", [100, 200])
@pytest.mark.parametrize("name", ["segment-000001.h5", "segment-000002.h5", "header.json"])
def test_a_removed_file_is_written_again(name: str, at: int, tmp_path: Path, whole: Fit) -> None:
    problem, folder = small_problem(tmp_path / "model"), tmp_path / "run"
    small_run(problem, folder, progress=after(at, (folder / "steps" / name).unlink))
    assert len(list((folder / "steps").glob("segment-*.h5"))) == 4
    same_draws(small_run(problem, folder, resume=True), whole)


def test_a_removed_result_is_noticed(tmp_path: Path, whole: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder is carried off while the result is computed from the steps, or right after it was written."""
    problem = small_problem(tmp_path / "model")
    for place, moment in (
        (Fit, "summary"),
        (run_contents, "result_image"),
        (run_directory, "write_manifest"),
    ):
        folder, moved = tmp_path / moment, tmp_path / f"{moment}-moved"
        original = getattr(place, moment)

        def act(*arguments, original=original, folder=folder, moved=moved, moment=moment, **more):
            # the note is written twice: when the folder is claimed, and when there is a result
            if folder.exists() and (moment != "write_manifest" or (folder / "result.nc").exists()):
                folder.rename(moved)
            return original(*arguments, **more)

        with monkeypatch.context() as patch:
            patch.setattr(place, moment, act)
            with pytest.raises(MachineError, match=f"is now {moved}"):
                small_run(problem, folder)
        assert not folder.exists()
        same_draws(small_run(problem, moved, resume=True), whole)


# -- full disks ------------------------------------------------------------------------------------------------------


def failing(patch: pytest.MonkeyPatch, number: int, code: int) -> list[int]:
    """Let every forced write from the given one on fail; the list grows with each."""
    calls: list[int] = []
    original = os.fsync

    def fsync(handle: int) -> None:
        calls.append(handle)
        if len(calls) > number:
            raise OSError(code, os.strerror(code))
        original(handle)

    patch.setattr(os, "fsync", fsync)
    return calls


def full_and_resumed(code: int, step: int, folder: Path, whole: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs that fail at every ``step``-th write, from the last one back; each is resumed to the same draws."""
    problem = small_problem(folder / "model")
    with monkeypatch.context() as patch:
        calls = failing(patch, 1000, code)
        small_run(problem, folder / "counted")
    writes = len(calls)
    assert writes > 10
    for number in range(writes - 1, -1, -step):
        run = folder / f"full-{number}"
        with monkeypatch.context() as patch:
            failing(patch, number, code)
            # a folder that was never writable is bad input, unless the disk is full
            with pytest.raises(MachineError if code != errno.EIO else (MachineError, InputError)) as caught:
                small_run(problem, run)
        if code != errno.EIO:
            assert "no space left on the disk" in str(caught.value)
        assert "\n" not in str(caught.value)
        assert not [name for name in tree(run) if "part" in name or name.endswith(".lock")]
        same_draws(small_run(problem, run, resume=True), whole)
        same_draws(load_fit(run), whole)


def test_a_disk_that_is_full_at_some_writes(tmp_path: Path, whole: Fit, monkeypatch) -> None:
    full_and_resumed(errno.ENOSPC, 6, tmp_path, whole, monkeypatch)


@pytest.mark.slow
@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT, errno.EIO])
def test_a_disk_that_is_full_at_any_write(code: int, tmp_path: Path, whole: Fit, monkeypatch) -> None:
    full_and_resumed(code, 1, tmp_path, whole, monkeypatch)


# -- two processes ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("resume", [False, True])
def test_a_folder_in_use_is_refused_at_once_and_can_be_read(resume: bool, tmp_path: Path, whole: Fit) -> None:
    problem, folder = small_problem(tmp_path / "model"), tmp_path / "run"
    with RunDirectory(folder, problem, resume=False):
        before = tree(folder)
        with pytest.raises(InputError, match=rf"{folder}: another fit is running.*process {os.getpid()} on "):
            small_run(problem, folder, resume=resume)
        with pytest.raises(InputError, match="no result found"):
            load_fit(folder)
        assert tree(folder) == before
    small_run(problem, folder)
    with RunDirectory(folder, problem, resume=True):
        same_draws(load_fit(folder), whole)
        with pytest.raises(
            InputError, match="another fit is running" if resume else "holds a result already"
        ):
            small_run(problem, folder, resume=resume)
    assert not (folder / ".skinbayes.lock").exists()


def test_a_file_system_without_locks_is_used_without(tmp_path: Path, whole: Fit, monkeypatch) -> None:
    fcntl = pytest.importorskip("fcntl")

    def flock(handle: int, operation: int) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(fcntl, "flock", flock)
    same_draws(small_run(small_problem(tmp_path / "model"), tmp_path / "run"), whole)
