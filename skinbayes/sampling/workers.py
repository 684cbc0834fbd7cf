"""Ensembles advanced in this process or shared out to several."""

from __future__ import annotations

import multiprocessing
import pickle
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection, wait
from typing import TypeAlias

from skinbayes.errors import MachineError
from skinbayes.sampling.advance import EnsembleState, EnsembleSteps, advance
from skinbayes.sampling.moves import MoveFactory
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.target import Target

Advance: TypeAlias = Callable[[list[EnsembleState]], list[EnsembleSteps]]
"""Moves every ensemble one block further."""


@contextmanager
def advancing(target: Target, options: SamplerOptions, moves: MoveFactory) -> Iterator[Advance]:
    """Provide what moves all ensembles one block further, with ``options.cores`` processes.

    Worker processes get the target once and end with this process, however it ends.

    Parameters
    ----------
    target : the density; must be picklable if there is more than one core
    options : cores, block length and how to evaluate
    moves : builds the proposals

    Yields
    ------
    a function of the states that returns the blocks in the same order
    """
    count = min(options.cores, options.ensembles)
    if count == 1:
        yield lambda states: [
            advance(target, state, options.block_steps, options.vectorize, moves) for state in states
        ]
        return
    crew: list[_Worker] = []
    try:
        for _ in range(count):
            crew.append(_Worker((target, options.block_steps, options.vectorize, moves)))
        yield lambda states: _share_out(crew, states)
    finally:
        for worker in crew:
            worker.stop()


class _Worker:
    """A process that advances ensembles; one that dies is started again, once, and gets the same ensemble.

    Parameters
    ----------
    task : arguments of :func:`advance` but for the state
    """

    def __init__(self, task: tuple[Target, int, bool, MoveFactory]) -> None:
        self._task = task
        self._state: tuple[int, EnsembleState] | None = None
        self._died = False
        self._start()

    def _start(self) -> None:
        # Not fork: a copy of this process could inherit locks that other threads hold.
        forkserver = "forkserver" in multiprocessing.get_all_start_methods()
        context = (
            multiprocessing.get_context("forkserver") if forkserver else multiprocessing.get_context("spawn")
        )
        self.connection, there = context.Pipe()
        self._process = context.Process(target=_serve, args=(there, *self._task), daemon=True)
        with _interrupts_held_back():
            self._process.start()
        there.close()

    def send(self, index: int, state: EnsembleState) -> None:
        """Give it an ensemble to advance."""
        self._state = index, state
        try:
            self.connection.send(self._state)
        except OSError:
            self._again()

    def receive(self) -> tuple[int, EnsembleSteps | Exception] | None:
        """The number of the ensemble and its block; None if it died and begins anew."""
        try:
            reply: tuple[int, EnsembleSteps | Exception] = self.connection.recv()
        except (EOFError, OSError):
            self._again()
            return None
        return reply

    def _again(self) -> None:
        """Start the process once more, with the ensemble it was to advance: a block depends on its state alone."""
        if self._died:
            raise MachineError(
                "A worker process of the sampler died twice, perhaps for want of memory: fewer --cores need less. "
                "(A script that samples on several cores does so under: if __name__ == '__main__'.)"
            )
        self._died = True
        self.stop()
        self._start()
        if self._state is not None:
            self.send(*self._state)

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


def _serve(connection: Connection, target: Target, steps: int, vectorize: bool, moves: MoveFactory) -> None:
    """Advance ensembles as they are sent, until the other end closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    reply: tuple[int, EnsembleSteps | Exception]
    try:
        while True:
            index, state = connection.recv()
            try:
                reply = index, advance(target, state, steps, vectorize, moves)
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


def _share_out(crew: list[_Worker], states: list[EnsembleState]) -> list[EnsembleSteps]:
    """Give each free worker the next ensemble; which worker does what does not change the result."""
    waiting = list(enumerate(states))[::-1]
    blocks: dict[int, EnsembleSteps] = {}
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
            blocks[index] = result
            if waiting:
                worker.send(*waiting.pop())
            else:
                busy.remove(worker)
    return [blocks[index] for index in range(len(states))]
