"""Runs killed at random moments, again and again, then resumed to the end: the draws of a run that was left alone."""

from __future__ import annotations

import multiprocessing
import os
import random
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from small_models import same_draws, student, two_parameters
from small_runs import SMALL, after, small_problem, small_run
from test_several_experiments import FREE, two_balls

from skinbayes.fit import load_fit, load_joint_fit, sample
from skinbayes.problem import load_problem

KINDS: dict[str, tuple[Callable[[Path], Any], dict[str, Any]]] = {
    "walkers": (two_parameters, {**SMALL, "max_steps": 300}),
    "importance sampling": (student, {"seed": 5, "ess": 1000}),
    "people and liquids": (
        lambda folder: load_problem("finger-descriptive"),
        {**SMALL, "walkers": 32, "block_steps": 25, "max_steps": 100},
    ),
    "several experiments": (lambda folder: two_balls(**FREE), {"seed": 5, "ess": 1000}),
}
"""Kinds of runs: a problem and how it is sampled, within a few seconds."""

KILLS, IN_A_ROW = 50, 5
"""Kills of each kind, and how many of them strike the same run."""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are forked, to be killed within milliseconds")
@pytest.mark.parametrize("kind", KINDS)
def test_two_hundred_kills(kind: str, tmp_path: Path) -> None:
    make, options = KINDS[kind]
    problem, moments = make(tmp_path), random.Random(kind)
    whole = sample(problem, directory=tmp_path / "whole", **options)
    began = time.monotonic()  # now that everything is imported
    sample(problem, directory=tmp_path / "again", **options)
    lasts, read = time.monotonic() - began, load_joint_fit if kind == "several experiments" else load_fit
    forked = multiprocessing.get_context("fork")
    killed = resumed = 0
    while killed < KILLS:
        run = tmp_path / f"run-{resumed}"
        for _ in range(IN_A_ROW):
            process = forked.Process(
                target=sample, args=(problem,), kwargs={"directory": run, "resume": True, **options}
            )
            process.start()
            process.join(moments.uniform(0.0, lasts))
            process.kill()
            process.join()
            assert process.exitcode in (0, -signal.SIGKILL)
            killed += process.exitcode != 0
            if process.exitcode == 0:  # it was done
                break
        same_draws(sample(problem, directory=run, resume=True, **options), whole)
        same_draws(read(run), whole)
        assert not [file for file in run.rglob("*") if "part" in file.name or file.name.endswith(".lock")]
        resumed += 1


def test_a_clock_that_is_set_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By a year in the middle of a run, whose files are then of the future, and again before it is resumed."""
    problem, run = small_problem(tmp_path / "model"), tmp_path / "run"
    whole = small_run(problem)
    now = time.time

    def set_back() -> None:
        monkeypatch.setattr(time, "time", lambda: now() - 3e7)
        for file in run.rglob("*"):
            os.utime(file, (now() + 3e7, now() + 3e7))

    same_draws(small_run(problem, run, progress=after(100, set_back)), whole)
    set_back()
    (run / "steps" / "segment-000004.h5").unlink()
    same_draws(small_run(problem, run, resume=True), whole)
    same_draws(load_fit(run), whole)
