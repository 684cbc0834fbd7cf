"""Builds of film tables that are stopped: they go on from what was kept, to the same numbers, and leave no process behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from line_curves import FilmTablePlan
from small_film_tables import RANGES

from skinbayes.emulation import Tasks, to_arrays
from skinbayes.lubrication import (
    FilmTable,
    build_film_table,
)
from skinbayes.roughness import named_surface

COUNTS = {"young_modulus_bulk": 2, "rms_height": 2, "normal_force": 2}


class Memory:
    """Keeps what it is told, and raises after so many times."""

    def __init__(self, patience: int = 10**9) -> None:
        self.arrays: dict[str, np.ndarray] = {}
        self.patience = patience

    def load(self) -> Mapping[str, np.ndarray]:
        return self.arrays

    def save(self, arrays: Mapping[str, np.ndarray]) -> None:
        self.arrays = dict(arrays)
        self.patience -= 1
        if self.patience < 0:
            raise KeyboardInterrupt


def small(kept: Memory | None = None, count: list[int] | None = None) -> FilmTable:
    told = [] if count is None else count
    plan = FilmTablePlan(
        RANGES, spectrum=named_surface("paper_reference"), counts=COUNTS, speeds=8, nodes=32, checked=3
    )
    return build_film_table(plan, kept=kept, progress=lambda done, total: told.append(done))


@pytest.mark.parametrize("patience", [0, 9, 18])
def test_a_stopped_build_gives_the_same_table(patience: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skinbayes.emulation.tasks._SAVED_EVERY", 0.0)
    whole = to_arrays(small())
    memory = Memory(patience)
    with pytest.raises(KeyboardInterrupt):
        small(memory)
    memory.patience = 10**9
    told: list[int] = []
    arrays, metadata = to_arrays(small(memory, told))
    assert metadata == whole[1]
    assert all(arrays[name].tobytes() == whole[0][name].tobytes() for name in whole[0])
    assert told[0] > 1 or patience == 0
    assert told[-1] == 19


def negative(value: float) -> float:
    return -value


def ends_in_a_worker(value: float) -> float:
    if value == 5 and os.getpid() != int(os.environ["TEST_PARENT"]):
        os.kill(os.getpid(), signal.SIGKILL)
    return -value


def test_results_come_in_order_from_processes() -> None:
    with Tasks(2, 20) as solve:
        assert solve("a", negative, range(10)).tolist() == [-i for i in range(10)]
        assert solve("b", negative, range(10, 20)).tolist() == [-i for i in range(10, 20)]


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_a_worker_that_is_killed_is_done_without(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TEST_PARENT", str(os.getpid()))
    with Tasks(2, 20) as solve:
        assert solve("a", ends_in_a_worker, range(20)).tolist() == [-i for i in range(20)]


PARENT = """
import time
from skinbayes.emulation import Tasks

if __name__ == "__main__":
    with Tasks(2, 2) as solve:
        print("started", flush=True)
        solve("a", time.sleep, [300.0] * 8)
"""


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs /proc")
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_workers_end_with_their_parent(how: int, tmp_path: Path) -> None:
    (tmp_path / "parent.py").write_text(PARENT)
    with subprocess.Popen(
        [sys.executable, tmp_path / "parent.py"], stdout=subprocess.PIPE, start_new_session=True
    ) as parent:
        children = _until(
            lambda: found if len(found := _children(parent.pid)) >= 3 else []
        )  # two workers and a tracker
        time.sleep(1.0)  # the workers have begun
        parent.send_signal(how)
        parent.wait()
        assert _until(lambda: not any(map(_runs, children))), "processes outlive their parent"


def _until(found, seconds: float = 60.0):  # type: ignore[no-untyped-def]
    end = time.monotonic() + seconds
    while not (value := found()) and time.monotonic() < end:
        time.sleep(0.1)
    return value


def _children(process: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{process}/task/{process}/children").read_text().split()]


def _runs(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
