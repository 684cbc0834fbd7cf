"""Many solutions computed here or in other processes, with what is done kept on the way."""

from __future__ import annotations

import os
import pickle
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
from skinbayes.emulation.box import Places

_SAVED_EVERY = 2.0  # seconds

Progress = Callable[[int, int], None]
"""Told how many of how many steps are done."""


_UNSHARED = (BrokenProcessPool, pickle.PicklingError, AttributeError, TypeError)
"""A process was ended from outside, perhaps for want of memory, or cannot be given the function: go on without."""


class Kept(Protocol):
    """A place for arrays by name that outlives the process."""

    def load(self) -> Mapping[str, FloatArray]:
        """What was saved last, empty if nothing was."""

    def save(self, arrays: Mapping[str, FloatArray]) -> None:
        """Keep these arrays instead of those kept before."""


class Tasks:
    """Apply functions to many arguments, in order, with ``processes`` processes; what is kept from before is not done again.

    Parameters
    ----------
    processes : how many solve at once
    total : number of solutions of all stages, for ``progress``; None counts each stage by itself
    progress : told the number of solutions that are done and of all
    kept : where results of the stages are kept
    """

    def __init__(
        self,
        processes: int = 1,
        total: int | None = None,
        progress: Progress | None = None,
        kept: Kept | None = None,
    ) -> None:
        self._pool = _pool(processes) if processes > 1 else None
        self._total, self._progress, self._kept = total, progress, kept
        self._stages: dict[str, FloatArray] = dict(kept.load()) if kept is not None else {}
        self._done = 0

    def __enter__(self) -> Tasks:
        return self

    def __exit__(self, *what: object) -> None:
        self._end_pool()

    def __call__(self, stage: str, function: Callable[[Any], Any], arguments: Iterable[Any]) -> FloatArray:
        """Results of ``function`` for all ``arguments``, one a row; ``stage`` names them among what is kept.

        Every argument is made, also those whose results are known: the first of several that share something decides on it.
        """
        rows = list(self._stages.get(stage, ()))
        todo = list(islice(arguments, len(rows), None))
        if self._total is None:
            self._done, self._stage = 0, len(rows) + len(todo)
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

    def at(self, stage: str, solve: Callable[[Places], FloatArray], places: Places, block: int) -> FloatArray:
        """Solutions at M places, shape ``(M, columns)``, at most ``block`` of them at a time."""
        total = max(len(x) for x in places.values())
        parts = -(-total // block)
        # blocks of one size, to be kept as one array: the last place may come twice
        chosen = np.minimum(np.arange(parts * -(-total // parts)), total - 1).reshape(parts, -1)
        blocks = ({n: x[rows] if len(x) > 1 else x for n, x in places.items()} for rows in chosen)
        found = self(stage, solve, blocks)
        return np.asarray(found.reshape(chosen.size, -1)[:total])

    def _results(self, function: Callable[[Any], Any], todo: list[Any]) -> Iterator[Any]:
        done = 0
        if self._pool is not None and todo:
            try:
                # here, not in the pool: its queue can wait for ever once it met what it cannot send
                pickle.dumps((function, todo[0]))
                for found in self._pool.map(function, todo, chunksize=4):
                    yield found
                    done += 1
                return
            except _UNSHARED:
                self._end_pool()
        yield from map(function, todo[done:])

    def _say(self, count: int) -> None:
        self._done += count
        if self._progress is not None and count:
            self._progress(self._done, self._total or self._stage)

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
