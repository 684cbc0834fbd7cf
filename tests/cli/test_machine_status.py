"""Exit status 4: the machine stopped a run, which continues where it was; through the command line, as processes."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from command_line import command, environment, run, run_process
from small_models import FINGER, write_model

from skinbayes.fit import load_fit

LONG = ("--seed", "5", "--ess", "8000", "--engine-option", "importance=false", "--json")


def model(folder: Path, name: str = "mine", stress: int = 10) -> Path:
    folder.mkdir(exist_ok=True)
    parameters = (
        f'frictional_shear_stress = {{ lognormal = ["{stress} MPa", 1.0] }}\nyoung_modulus_layer = "7 MPa"'
    )
    noise = 'family = "lognormal"\nnoise_scale = { half_normal = 0.5 }'
    return write_model(folder, FINGER.format(parameters=parameters, noise=noise), f"{name}.toml")


def start(*arguments: str | Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        command("fit", *arguments),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment(),
    )


def until_steps(directory: Path, process: subprocess.Popen[str], count: int = 1) -> None:
    deadline = time.monotonic() + 120
    while len(list((directory / "steps").glob("segment-*.h5"))) < count and process.poll() is None:
        assert time.monotonic() < deadline
        time.sleep(0.02)


def one_sentence(errors: str) -> str:
    """The message, which is one line and no traceback."""
    # of a slow machine, progress is told too
    lines = [line for line in errors.strip().splitlines() if not line.startswith("sampling: ")]
    assert len(lines) == 1 and lines[0].startswith("skinbayes: "), errors
    return lines[0]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    folder = tmp_path_factory.mktemp("whole")
    done = run_process("fit", model(folder), *LONG, "-o", folder / "run")
    assert done.status == 0, done.errors
    return done.document()["parameters"]


def resumed(path: Path, directory: Path) -> object:
    done = run_process("fit", path, *LONG, "-o", directory, "--resume")
    assert done.status == 0, done.errors
    assert load_fit(directory).converged
    return done.document()["parameters"]


def test_a_folder_that_was_renamed(tmp_path: Path, whole) -> None:
    path, directory, moved = model(tmp_path / "model"), tmp_path / "run", tmp_path / "moved"
    process = start(path, *LONG, "-o", directory)
    until_steps(directory, process)
    directory.rename(moved)
    output, errors = process.communicate(timeout=120)
    assert process.returncode == 4 and output == ""
    assert f"-o {moved} --resume" in one_sentence(errors)
    assert not directory.exists()
    assert resumed(path, moved) == whole


def test_interrupted_in_a_folder_that_is_gone(tmp_path: Path, whole) -> None:
    """The message of an interrupt would name a folder that is not there."""
    path, directory, moved = model(tmp_path / "model"), tmp_path / "run", tmp_path / "moved"
    process = start(path, *LONG, "-o", directory)
    until_steps(directory, process)
    directory.rename(moved)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 4
    assert f"-o {moved} --resume" in one_sentence(errors)
    assert resumed(path, moved) == whole


def limited(size: int, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """The command line where no file can become larger than ``size`` bytes, as on a full disk."""
    code = (
        f"import resource; resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))\n"
        "from skinbayes.cli import main; main()"
    )
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, arguments)], env=environment(), capture_output=True, text=True,
        timeout=120,
    )  # fmt: skip


@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
@pytest.mark.parametrize("size", [1000, 20_000, 1_000_000])
def test_no_room_for_inputs_steps_or_result(size: int, tmp_path: Path, whole) -> None:
    path, directory = model(tmp_path / "model"), tmp_path / "run"
    done = limited(size, "fit", path, *LONG, "-o", directory)
    assert done.returncode == 4 and done.stdout == ""
    assert "no space left on the disk" in one_sentence(done.stderr)
    assert ("Make room" if size == 1000 else "--resume") in done.stderr
    assert not [file for file in directory.rglob("*") if file.suffix in (".partial", ".part", ".lock")]
    assert not (directory / "result.nc").exists()
    assert resumed(path, directory) == whole


@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
def test_no_room_for_the_page(tmp_path: Path) -> None:
    path, directory = model(tmp_path / "model"), tmp_path / "run"
    assert run_process("fit", path, "-o", directory, "--ess", "500", "--report").status == 0
    page = (directory / "report.html").read_bytes()
    done = limited(2000, "report", directory)
    assert done.returncode == 4
    assert "report.html: cannot be written (no space left on the disk)" in one_sentence(done.stderr)
    assert (directory / "report.html").read_bytes() == page


def test_a_page_replaces_pages_only(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, directory = model(tmp_path / "model"), tmp_path / "run"
    assert run(capsys, "fit", path, "-o", directory, "--ess", "500").status == 0
    for name, content in (("mine.csv", "a,b\\n"), ("mine.html", "<!DOCTYPE html><p>mine"), ("empty.txt", "")):
        (tmp_path / name).write_text(content)
        refused = run(capsys, "report", directory, "-o", tmp_path / name)
        assert refused.status == 2 and "is no page of skinbayes" in refused.errors
        assert (tmp_path / name).read_text() == content
    refused = run(capsys, "report", directory, "-o", tmp_path)
    assert refused.status == 2 and "a folder" in refused.errors
    for _ in range(2):
        assert run(capsys, "report", directory, "-o", tmp_path / "page.html").status == 0
    (directory / "report.html").symlink_to(tmp_path / "mine.html")
    assert run(capsys, "report", directory).status == 2
    (directory / "report.html").unlink()
    (directory / "report.html").symlink_to(tmp_path / "page.html")
    before = (tmp_path / "page.html").stat().st_mtime_ns
    assert run(capsys, "report", directory).status == 0
    assert (tmp_path / "page.html").stat().st_mtime_ns == before and not (
        directory / "report.html"
    ).is_symlink()


def children(process: int) -> list[int]:
    """Processes started by a process, and by those."""
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = status.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == process:
            found += [int(status.parent.name), *children(int(status.parent.name))]
    return found


def workers(process: int) -> list[int]:
    """The processes that sample: those that have no children of their own, but for what watches resources."""
    return [
        child
        for child in children(process)
        if not children(child) and b"resource_tracker" not in Path(f"/proc/{child}/cmdline").read_bytes()
    ]


def test_workers_that_are_killed(tmp_path: Path, whole) -> None:
    """Killed whenever there are some: started again once, and then one sentence."""
    path, directory = model(tmp_path / "model"), tmp_path / "run"
    process = start(path, *LONG, "-o", directory, "--cores", "2")
    until_steps(directory, process)
    while process.poll() is None:
        for child in workers(process.pid):
            os.kill(child, signal.SIGKILL)
        time.sleep(0.3)
    output, errors = process.communicate(timeout=120)
    assert process.returncode == 4 and output == ""
    assert "died twice" in one_sentence(errors) and str(directory) in errors and "--resume" in errors
    assert resumed(path, directory) == whole


TOGETHER = """
import sys, time
from skinbayes.cli import main
import skinbayes.fit.run_directory, skinbayes.sampling.ensembles, emcee
moment = float(sys.argv.pop(1))
while time.time() < moment:
    pass
main()
"""


def both_at_once(folder: Path, paths: list[Path], *more: str) -> list[tuple[int, str, str]]:
    moment = time.time() + 5.0
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", TOGETHER, str(moment), "fit", str(path), "-o", str(folder), "--ess", "500", *more],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment(),
        )
        for path in paths
    ]  # fmt: skip
    return [(*process.communicate(timeout=120), process.returncode) for process in processes]


def assert_one_won(folder: Path, paths: list[Path], ended: list[tuple[str, str, int]]) -> None:
    assert sorted(status for *_, status in ended) == [0, 2], ended
    winner = next(i for i, (*_, status) in enumerate(ended) if status == 0)
    message = one_sentence(ended[1 - winner][1])
    assert str(folder) in message
    assert (folder / "model.toml").read_bytes() == paths[winner].read_bytes()
    assert json.loads((folder / "run.json").read_text())["model"] == paths[winner].stem
    fit = load_fit(folder)
    assert fit.problem is not None and fit.name == paths[winner].stem
    assert not list(folder.rglob("*.partial")) and not (folder / ".skinbayes.lock").exists()


def test_two_models_started_at_once_in_one_folder(tmp_path: Path) -> None:
    paths = [model(tmp_path / "model", "first", 10), model(tmp_path / "model", "second", 12)]
    assert_one_won(tmp_path / "run", paths, both_at_once(tmp_path / "run", paths))


@pytest.mark.slow
def test_two_models_started_at_once_many_times(tmp_path: Path) -> None:
    paths = [model(tmp_path / "model", "first", 10), model(tmp_path / "model", "second", 12)]
    for number in range(25):
        folder = tmp_path / f"run-{number}"
        assert_one_won(folder, paths, both_at_once(folder, paths, *(["--resume"] if number % 2 else [])))


@pytest.mark.slow
def test_killed_at_random_moments_with_rivals(tmp_path: Path, whole) -> None:
    """Killed from the first instant on, while another process tries to take the folder; then resumed."""
    path, moments = model(tmp_path / "model"), random.Random(3)
    for number in range(12):
        directory = tmp_path / f"run-{number}"
        for _ in range(3):
            process = start(path, *LONG, "-o", directory, "--resume")
            time.sleep(moments.uniform(0.3, 4.0))
            rival = start(path, *LONG, "-o", directory, "--resume") if moments.random() < 0.5 else None
            time.sleep(moments.uniform(0.0, 1.0))
            process.kill()
            process.communicate()
            if rival is not None:
                _, errors = rival.communicate(timeout=120)
                assert rival.returncode in (0, 2) and "Traceback" not in errors
        assert resumed(path, directory) == whole
