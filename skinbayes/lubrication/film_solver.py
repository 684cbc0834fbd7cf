"""Many sweeps solved here or in other processes, with what is done kept on the way."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from itertools import islice
from multiprocessing import connection, get_context, parent_process
from typing import Any, Protocol

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.lubrication.film_sweeps import Progress

_SAVED_EVERY = 2.0  # seconds


class Kept(Protocol):
    """A place for arrays by name that outlives the process."""

    def load(self) -> Mapping[str, FloatArray]:
        """What was saved last, empty if nothing was."""

    def save(self, arrays: Mapping[str, FloatArray]) -> None:
        """Keep these arrays instead of those kept before."""


class Sweeps:
    """Apply functions to many arguments, in order, with ``processes`` processes; what is kept from before is not done again.

    Parameters
    ----------
    processes : how many solve at once, dimensionless
    total : number of sweeps of all stages, dimensionless, for ``progress``
    progress : told the number of sweeps that are done and of all
    kept : where results of the stages are kept
    """

    def __init__(
        self, processes: int, total: int, progress: Progress | None = None, kept: Kept | None = None
    ) -> None:
        self._pool = _pool(processes) if processes > 1 else None
        self._total, self._progress, self._kept = total, progress, kept
        self._stages: dict[str, FloatArray] = dict(kept.load()) if kept is not None else {}
        self._done = 0

    def __enter__(self) -> Sweeps:
        return self

    def __exit__(self, *what: object) -> None:
        self._end_pool()

    def __call__(self, stage: str, function: Callable[[Any], Any], arguments: Iterable[Any]) -> FloatArray:
        """Results of ``function`` for all ``arguments``, one a row; ``stage`` names them among what is kept.

        Every argument is made, also those whose results are known: the first of several that share something decides on it.
        """
        rows = list(self._stages.get(stage, ()))
        todo = list(islice(arguments, len(rows), None))
        self._say(len(rows))
        saved = time.monotonic()
        try:
            for found in self._results(function, todo):
                rows.append(np.asarray(found, dtype=np.float64))
                self._say(1)
                if time.monotonic() - saved > _SAVED_EVERY:
                    self._save(stage, rows)
                    saved = time.monotonic()
        finally:  # also when it is interrupted
            self._save(stage, rows)
        return self._stages[stage].copy()  # callers go on computing in it

    def _results(self, function: Callable[[Any], Any], todo: list[Any]) -> Iterator[Any]:
        done = 0
        if self._pool is not None:
            try:
                for found in self._pool.map(function, todo, chunksize=4):
                    yield found
                    done += 1
                return
            except (
                BrokenProcessPool
            ):  # a process was ended from outside, perhaps for want of memory: go on without
                self._end_pool()
        yield from map(function, todo[done:])

    def _say(self, count: int) -> None:
        self._done += count
        if self._progress is not None and count:
            self._progress(self._done, self._total)

    def _save(self, stage: str, rows: list[FloatArray]) -> None:
        if rows:
            before = len(self._stages.get(stage, ()))
            self._stages[stage] = np.array(rows)
            if self._kept is not None and len(rows) > before:
                self._kept.save(self._stages)

    def _end_pool(self) -> None:
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None


def _pool(processes: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(processes, mp_context=get_context("spawn"), initializer=_begin)


def _begin() -> None:
    """Of a worker: leave interrupts to the parent, and end when it ends, even if it is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
