"""Ensembles advanced in this process or shared out to several."""

from __future__ import annotations

import multiprocessing
import pickle
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import TypeAlias

from skinbayes.sampling.advance import Block, EnsembleState, advance
from skinbayes.sampling.moves import MoveFactory
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.target import Target

Advance: TypeAlias = Callable[[list[EnsembleState]], list[Block]]
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
    crew = _start(count, target, options, moves)
    try:
        yield lambda states: _share_out(crew, states)
    finally:
        for connection in crew:
            connection.close()
        for process in crew.values():
            process.terminate()
        for process in crew.values():
            process.join()


def _start(
    count: int, target: Target, options: SamplerOptions, moves: MoveFactory
) -> dict[Connection, BaseProcess]:
    # Not fork: a copy of this process could inherit locks that other threads hold.
    forkserver = "forkserver" in multiprocessing.get_all_start_methods()
    context = (
        multiprocessing.get_context("forkserver") if forkserver else multiprocessing.get_context("spawn")
    )
    crew: dict[Connection, BaseProcess] = {}
    with _interrupts_held_back():
        for _ in range(count):
            here, there = context.Pipe()
            arguments = (there, target, options.block_steps, options.vectorize, moves)
            process = context.Process(target=_serve, args=arguments, daemon=True)
            process.start()
            there.close()
            crew[here] = process
    return crew


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
    reply: tuple[int, Block | Exception]
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


def _share_out(crew: dict[Connection, BaseProcess], states: list[EnsembleState]) -> list[Block]:
    """Give each free worker the next ensemble; which worker does what does not change the result."""
    waiting = list(enumerate(states))[::-1]
    blocks: dict[int, Block] = {}
    busy: list[Connection] = []
    try:
        for connection in crew:
            if waiting:
                connection.send(waiting.pop())
                busy.append(connection)
        while busy:
            ready = wait(busy)
            for connection in [candidate for candidate in busy if candidate in ready]:
                index, result = connection.recv()
                if isinstance(result, Exception):
                    raise result
                blocks[index] = result
                if waiting:
                    connection.send(waiting.pop())
                else:
                    busy.remove(connection)
    except (EOFError, ConnectionError) as error:
        raise RuntimeError(
            "A worker process of the sampler died, perhaps for want of memory. The steps stored so far are safe. "
            "(A script that samples on several cores does so under: if __name__ == '__main__'.)"
        ) from error
    return [blocks[index] for index in range(len(states))]
