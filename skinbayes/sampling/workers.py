"""Ensembles advanced, or positions evaluated, in this process or shared out to several."""

from __future__ import annotations

import multiprocessing
import pickle
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from multiprocessing.connection import Connection, wait
from typing import Any, TypeAlias

from skinbayes.arrays import FloatArray
from skinbayes.errors import MachineError
from skinbayes.sampling.advance import Density, EnsembleState, EnsembleSteps, advance
from skinbayes.sampling.moves import MoveFactory
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.target import Target

Work: TypeAlias = EnsembleState | FloatArray
"""An ensemble to be moved one block further, or positions ``(B, D)`` to be evaluated."""

Done: TypeAlias = EnsembleSteps | FloatArray
"""The block, or log-densities ``(B,)``."""

Crew: TypeAlias = Callable[[Sequence[Work]], list[Any]]
"""Does several pieces of work and returns what is done in their order."""


@contextmanager
def working(target: Target, options: SamplerOptions, moves: MoveFactory) -> Iterator[Crew]:
    """Provide what moves ensembles one block further and evaluates positions, with ``options.cores`` processes.

    Worker processes get the target once and end with this process, however it ends.

    Parameters
    ----------
    target : the density; must be picklable if there is more than one core
    options : cores, block length and how to evaluate
    moves : builds the proposals

    Yields
    ------
    a function of several states or positions that returns the blocks or log-densities in the same order
    """
    count = min(options.cores, options.ensembles)
    if count == 1:
        yield lambda pieces: [
            _done(piece, target, options.block_steps, options.vectorize, moves) for piece in pieces
        ]
        return
    crew: list[_Worker] = []
    try:
        for _ in range(count):
            crew.append(_Worker((target, options.block_steps, options.vectorize, moves)))
        yield lambda pieces: _share_out(crew, pieces)
    finally:
        for worker in crew:
            worker.stop()


class _Worker:
    """A process that does work; one that dies is started again, once, and gets the same work.

    Parameters
    ----------
    task : target, steps of a block, how to evaluate, and moves
    """

    def __init__(self, task: tuple[Target, int, bool, MoveFactory]) -> None:
        self._task = task
        self._piece: tuple[int, Work] | None = None
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

    def send(self, index: int, piece: Work) -> None:
        """Give it something to do."""
        self._piece = index, piece
        try:
            self.connection.send(self._piece)
        except OSError:
            self._again()

    def receive(self) -> tuple[int, Done | Exception] | None:
        """The number of the piece and what became of it; None if it died and begins anew."""
        try:
            reply: tuple[int, Done | Exception] = self.connection.recv()
        except (EOFError, OSError):
            self._again()
            return None
        return reply

    def _again(self) -> None:
        """Start the process once more, with what it had to do: what is done depends on the piece alone."""
        if self._died:
            raise MachineError(
                "A worker process of the sampler died twice, perhaps for want of memory: fewer --cores need less. "
                "(A script that samples on several cores does so under: if __name__ == '__main__'.)"
            )
        self._died = True
        self.stop()
        self._start()
        if self._piece is not None:
            self.send(*self._piece)

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
    """Do work as it is sent, until the other end closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    reply: tuple[int, Done | Exception]
    try:
        while True:
            index, piece = connection.recv()
            try:
                reply = index, _done(piece, target, steps, vectorize, moves)
            except Exception as error:
                reply = index, _portable(error)
            connection.send(reply)
    except (EOFError, OSError):
        return


def _done(piece: Work, target: Target, steps: int, vectorize: bool, moves: MoveFactory) -> Done:
    if isinstance(piece, EnsembleState):
        return advance(target, piece, steps, vectorize, moves)
    return Density(target, vectorize)(piece)


def _portable(error: Exception) -> Exception:
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _share_out(crew: list[_Worker], pieces: Sequence[Work]) -> list[Done]:
    """Give each free worker the next piece; which worker does what does not change the result."""
    waiting = list(enumerate(pieces))[::-1]
    blocks: dict[int, Done] = {}
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
    return [blocks[index] for index in range(len(pieces))]
