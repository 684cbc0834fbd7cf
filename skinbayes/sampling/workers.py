"""Pieces of work done in this process or shared out to several."""

from __future__ import annotations

import multiprocessing
import pickle
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing.connection import Connection, wait
from typing import Any, TypeVar

from skinbayes.errors import MachineError

Task = TypeVar("Task")
Result = TypeVar("Result")

MOST_DEATHS = 3
"""Of a worker with the same one of many tasks."""


@contextmanager
def sharing_out(
    work: Callable[[Task], Result], processes: int
) -> Iterator[Callable[[Sequence[Task]], list[Result]]]:
    """Provide what does several tasks, in this process if it is the only one.

    Worker processes get ``work`` once and end with this process, however it ends.

    Parameters
    ----------
    work : does one task, as a function of the task alone; must be picklable if there is more than one process
    processes : how many share the tasks

    Yields
    ------
    a function of the tasks that returns their results in the same order
    """
    if processes == 1:
        yield lambda tasks: [work(task) for task in tasks]
        return
    with _crew(work, processes) as crew:
        yield lambda tasks: [result for _, result in sorted(_as_done(crew, tasks), key=lambda one: one[0])]


def done_by_processes(
    work: Callable[[Task], Result], tasks: Sequence[Task], processes: int
) -> Iterator[tuple[int, Result]]:
    """Do tasks in this process, or in several; yields the number of each task and its result as soon as it is there.

    Parameters
    ----------
    work : as :func:`sharing_out` takes it
    tasks : what is to be done
    processes : how many share the tasks
    """
    if processes == 1:
        yield from ((index, work(task)) for index, task in enumerate(tasks))
        return
    with _crew(work, min(processes, len(tasks) or 1), forgiving=True) as crew:
        yield from _as_done(crew, tasks)


@contextmanager
def _crew(work: Callable[[Any], Any], processes: int, forgiving: bool = False) -> Iterator[list[_Worker]]:
    crew: list[_Worker] = []
    try:
        for _ in range(processes):
            crew.append(_Worker(work, forgiving))
        yield crew
    finally:
        for worker in crew:
            worker.stop()


class _Worker:
    """A process that does tasks; one that dies is started again and gets the same task.

    It may die once; if it is ``forgiving``, three times with each task, since among thousands of tasks a machine kills some.
    """

    def __init__(self, work: Callable[[Any], Any], forgiving: bool) -> None:
        self._work = work
        self._forgiving = forgiving
        self._deaths = 0
        self._task: tuple[int, Any] | None = None
        self._start()

    def _start(self) -> None:
        # Not fork: a copy of this process could inherit locks that other threads hold.
        forkserver = "forkserver" in multiprocessing.get_all_start_methods()
        context = (
            multiprocessing.get_context("forkserver") if forkserver else multiprocessing.get_context("spawn")
        )
        self.connection, there = context.Pipe()
        self._process = context.Process(target=_serve, args=(there, self._work), daemon=True)
        with _interrupts_held_back():
            self._process.start()
        there.close()

    def send(self, index: int, task: Any) -> None:
        """Give it a task to do."""
        self._task = index, task
        try:
            self.connection.send(self._task)
        except OSError:
            self._again()

    def receive(self) -> tuple[int, Any] | None:
        """The number of the task and its result, or the error that it raised; None if it died and begins anew."""
        try:
            reply: tuple[int, Any] = self.connection.recv()
        except (EOFError, OSError):
            self._again()
            return None
        if self._forgiving:
            self._deaths = 0
        return reply

    def _again(self) -> None:
        """Start the process once more, with the task it was to do: a result depends on its task alone."""
        self._deaths += 1
        if self._deaths > (MOST_DEATHS if self._forgiving else 1):
            often = "again and again with one task" if self._forgiving else "twice"
            raise MachineError(
                f"A worker process of the sampler died {often}, perhaps for want of memory: fewer --cores need less. "
                "(A script that samples on several cores does so under: if __name__ == '__main__'.)"
            )
        self.stop()
        self._start()
        if self._task is not None:
            self.send(*self._task)

    def stop(self) -> None:
        """End the process."""
        self.connection.close()
        self._process.terminate()
        self._process.join()


@contextmanager
def _interrupts_held_back() -> Iterator[None]:
    """Block the interrupt signal; processes started meanwhile keep it blocked, so Ctrl-C reaches this one only."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _serve(connection: Connection, work: Callable[[Any], Any]) -> None:
    """Do tasks as they are sent, until the other end closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        while True:
            index, task = connection.recv()
            reply: tuple[int, Any]
            try:
                reply = index, work(task)
            except Exception as error:
                reply = index, _portable(error)
            connection.send(reply)
    except (EOFError, OSError):
        return


def _portable(error: Exception) -> Exception:
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _as_done(crew: list[_Worker], tasks: Sequence[Any]) -> Iterator[tuple[int, Any]]:
    """Give each free worker the next task; which worker does what does not change a result."""
    waiting = list(enumerate(tasks))[::-1]
    busy = crew[: len(waiting)]
    for worker in busy:
        worker.send(*waiting.pop())
    while busy:
        ready = wait([worker.connection for worker in busy])
        for worker in [candidate for candidate in busy if candidate.connection in ready]:
            reply = worker.receive()
            if reply is None:
                continue
            index, result = reply
            if isinstance(result, Exception):
                raise result
            if waiting:
                worker.send(*waiting.pop())
            else:
                busy.remove(worker)
            yield index, result
