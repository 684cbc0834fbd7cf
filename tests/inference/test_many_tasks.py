"""Tasks are done by this process, by several, or by the workers of a dask scheduler: with the same results."""

from __future__ import annotations

import sys
from typing import Any

import pytest

from skinbayes.errors import InputError
from skinbayes.sampling import many_tasks
from skinbayes.sampling.many_tasks import done_tasks


def square(number: int) -> int:
    if number < 0:
        raise ValueError(f"{number} is negative")
    return number * number


def test_here_one_after_the_other() -> None:
    assert list(done_tasks(square, [3, 4])) == [(0, 9), (1, 16)]
    assert list(done_tasks(square, [], processes=2)) == []


def test_by_processes_as_they_end() -> None:
    assert dict(done_tasks(square, range(5), processes=2)) == {i: i * i for i in range(5)}
    with pytest.raises(ValueError, match="-1 is negative"):
        list(done_tasks(square, [1, -1], processes=2))


def test_without_dask_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"pip install 'skinbayes\[cluster\]'"):
        list(done_tasks(square, [1], scheduler="tcp://node1:8786"))


def test_by_a_scheduler(cluster: Any) -> None:
    address = cluster.scheduler_address
    assert dict(done_tasks(square, range(5), scheduler=address)) == {i: i * i for i in range(5)}
    with pytest.raises(ValueError, match="-1 is negative"):
        list(done_tasks(square, [1, -1], scheduler=address))


def test_workers_of_another_version_are_refused(cluster: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(many_tasks, "_version", lambda: "9.9")
    with pytest.raises(InputError, match=r"workers have skinbayes 9\.9; expected"):
        list(done_tasks(square, [1], scheduler=cluster.scheduler_address))


def test_nobody_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr(many_tasks, "PATIENCE", 0.5)
    with pytest.raises(InputError, match="no dask scheduler answers there"):
        list(done_tasks(square, [1], scheduler="tcp://127.0.0.1:9"))


def test_a_scheduler_without_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(many_tasks, "PATIENCE", 1.0)
    with (
        distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=":0") as empty,
        pytest.raises(InputError, match="has no workers; start some with: dask worker"),
    ):
        list(done_tasks(square, [1], scheduler=empty.scheduler_address))
