"""Many independent tasks, done by processes of this machine or by the workers of a dask scheduler."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from skinbayes.errors import InputError, MachineError
from skinbayes.sampling.workers import done_by_processes

Task = TypeVar("Task")
Result = TypeVar("Result")

PATIENCE = 30.0
"""Seconds to wait for a scheduler and its first worker."""

NEEDED = "a dask scheduler needs dask.distributed: pip install 'skinbayes[cluster]'"


def done_tasks(
    work: Callable[[Task], Result],
    tasks: Sequence[Task],
    processes: int = 1,
    scheduler: str | None = None,
) -> Iterator[tuple[int, Result]]:
    """Do tasks; yields the number of each and its result as soon as it is there, in no particular order.

    Who does what must not change a result: everything that a task needs, its random stream too, is in ``work`` and the task.

    Parameters
    ----------
    work : does one task, as a function of the task alone; picklable unless this process does all
    tasks : what is to be done
    processes : processes of this machine that share the tasks; without meaning if there is a scheduler
    scheduler : address of a dask scheduler, such as ``"tcp://node1:8786"``; None for this machine, without any server

    Yields
    ------
    tuple
        Number of the task in ``tasks``, and what ``work`` returned for it.

    Raises
    ------
    InputError
        dask.distributed is not installed, nobody answers at the address, the scheduler has no workers, or these have another
        version of skinbayes.
    MachineError
        A worker died with the same task again and again.
    """
    if scheduler is None:
        yield from done_by_processes(work, tasks, processes)
    else:
        yield from _done_by_scheduler(work, tasks, scheduler)


def _done_by_scheduler(
    work: Callable[[Any], Any], tasks: Sequence[Any], address: str
) -> Iterator[tuple[int, Any]]:
    try:
        import distributed
    except ImportError:
        raise InputError(f"scheduler {address}: {NEEDED}") from None
    if not tasks:
        return
    with _connected(distributed, address) as client:
        # to every worker once: with tables it may be megabytes
        shared = client.scatter(work, broadcast=True, hash=False)
        futures = {client.submit(_do, shared, task, pure=False): index for index, task in enumerate(tasks)}
        try:
            for future in distributed.as_completed(list(futures), loop=client.loop):
                try:
                    result = future.result()
                except distributed.KilledWorker:
                    raise MachineError(
                        f"scheduler {address}: workers died again and again with one task, perhaps for want of memory."
                    ) from None
                yield futures[future], result
                future.release()
        finally:
            client.cancel(list(futures))


def _connected(distributed: Any, address: str) -> Any:
    """A client of a scheduler that has workers with this version of skinbayes."""
    from skinbayes.version import __version__

    try:
        client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"scheduler {address}: no dask scheduler answers there ({error}); expected its address, such as tcp://node1:8786"
        ) from None
    try:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise InputError(
                f"scheduler {address}: has no workers; start some with: dask worker {address}"
            ) from None
        try:
            versions = set(client.run(_version).values())
        except Exception as error:  # whatever a worker without skinbayes says
            raise InputError(
                f"scheduler {address}: a worker cannot import skinbayes ({error}); expected version {__version__} on each"
            ) from None
        if versions != {__version__}:
            raise InputError(
                f"scheduler {address}: workers have skinbayes {', '.join(sorted(versions))}; expected {__version__} on each"
            )
    except BaseException:
        client.close()
        raise
    return client


def _version() -> str:
    from skinbayes.version import __version__

    return __version__


def _do(work: Callable[[Any], Any], task: Any) -> Any:
    return work(task)
