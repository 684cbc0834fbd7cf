"""Runs that are killed or interrupted, through the command line: resumed, they are the uninterrupted run."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from small_models import same_draws, two_parameters

from skinbayes.errors import InputError
from skinbayes.fit import Fit, load_fit, sample

ROOT = Path(__file__).resolve().parents[2]


def start(*arguments: str | Path) -> subprocess.Popen[str]:
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    return subprocess.Popen(
        [sys.executable, "-c", "from skinbayes.cli import main; main()", "fit", *map(str, arguments)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": path},
    )  # fmt: skip


LONG = ("--seed", "5", "--ess", "20000", "--engine-option", "importance=false", "--json")


@pytest.fixture(scope="module")
def uninterrupted(tmp_path_factory: pytest.TempPathFactory) -> Fit:
    made = sample(two_parameters(tmp_path_factory.mktemp("whole")), seed=5, ess=20_000, importance=False)
    assert made.provenance["sampling"]["steps"] > 200  # so that the first block is not the last
    return made


@pytest.mark.parametrize(
    ("number", "cores"),
    [
        (signal.SIGINT, 1),
        (signal.SIGKILL, 1),
        pytest.param(signal.SIGINT, 2, marks=pytest.mark.slow),
        pytest.param(signal.SIGKILL, 2, marks=pytest.mark.slow),
        pytest.param(signal.SIGTERM, 1, marks=pytest.mark.slow),
    ],
)
def test_stopped_runs_resume_to_the_same_draws(number, cores, uninterrupted: Fit, tmp_path: Path) -> None:
    run, model = tmp_path / "run", two_parameters(tmp_path).spec.path
    process = start(model, *LONG, "-o", run, "--cores", cores)
    deadline = time.monotonic() + 60
    while not list((run / "steps").glob("segment-*.h5")) and process.poll() is None:
        assert time.monotonic() < deadline
        time.sleep(0.02)
    process.send_signal(number)
    output, errors = process.communicate(timeout=60)
    assert output == ""
    assert "Traceback" not in errors
    if number == signal.SIGINT:
        assert process.returncode == 130
        assert str(run) in errors and "--resume" in errors
    else:
        assert process.returncode in (-number, 130)
    assert not (run / "result.nc").exists()
    with pytest.raises(InputError, match="not finished"):
        load_fit(run)
    refused = start(model, *LONG, "-o", run)
    assert "--resume" in refused.communicate(timeout=60)[1] and refused.returncode == 2
    again = start(model, *LONG, "-o", run, "--resume")
    output, errors = again.communicate(timeout=120)
    assert again.returncode == 0, errors
    assert json.loads(output)["converged"] is True
    same_draws(load_fit(run), uninterrupted)
