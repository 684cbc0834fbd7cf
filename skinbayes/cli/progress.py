"""The progress of a run on standard error: a bar on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.cli.output import console, say

if TYPE_CHECKING:
    from skinbayes.sampling.ensembles import Progress

QUIET_SECONDS = 15.0
"""Without a terminal one line is written each time this much time has passed."""


YARDSTICK_ESS = 2000.0
"""Effective sample size that yardsticks are sampled to, the default of ``sample``."""


@contextmanager
def sampling_progress(ess: float, what: str = "sampling") -> Iterator[Callable[[Progress], None]]:
    """Yield what to call after every block of steps; shows steps and effective sample size reached of ``ess``."""
    terminal = console(stderr=True)
    if not terminal.is_terminal:
        yield _lines(ess, what)
        return
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    bar = Bar(
        TextColumn(what),
        BarColumn(),
        TextColumn("{task.description}"),
        TimeElapsedColumn(),
        console=terminal,
        transient=True,
    )
    with bar:
        task = bar.add_task("starting", total=ess)

        def update(progress: Progress) -> None:
            reached = _reached(progress)
            text = f"{progress.steps} steps" + (
                "" if reached is None else f", effective sample size {reached:.0f} of {ess:.0f}"
            )
            bar.update(task, completed=min(reached or 0.0, ess), description=text)

        yield update


@contextmanager
def counted_progress(what: str) -> Iterator[Callable[[int, int], None]]:
    """Yield what to call with the number done and their total; nothing is shown before the first call."""
    terminal = console(stderr=True)
    if not terminal.is_terminal:
        yield _counted_lines(what)
        return
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    bar = Bar(
        TextColumn(what),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        console=terminal,
        transient=True,
    )
    with bar:
        task = bar.add_task(what, total=None, visible=False)
        yield lambda done, total: bar.update(task, completed=done, total=total, visible=True)


@contextmanager
def fit_progress(ess: float) -> Iterator[tuple[Callable[[int, int], None], Callable[[Progress], None]]]:
    """Yield what to call while a table is built, and after every block of steps; one bar makes way for the other."""
    with ExitStack() as shown:
        count = shown.enter_context(counted_progress("building the table"))
        sampling: list[Callable[[Progress], None]] = []

        def update(progress: Progress) -> None:
            if not sampling:
                shown.close()
                sampling.append(shown.enter_context(sampling_progress(ess)))
            sampling[0](progress)

        yield count, update


@contextmanager
def yardstick_progress() -> Iterator[Callable[[str, Progress], None]]:
    """Yield what to call with the name of a yardstick after every block of its steps."""
    with ExitStack() as shown:
        current: dict[str, Callable[[Progress], None]] = {}

        def update(name: str, progress: Progress) -> None:
            if name not in current:
                # the bar of the yardstick before makes way
                shown.close()
                current[name] = shown.enter_context(sampling_progress(YARDSTICK_ESS, f"yardstick {name}"))
            current[name](progress)

        yield update


def _counted_lines(what: str) -> Callable[[int, int], None]:
    last = time.monotonic()

    def update(done: int, total: int) -> None:
        nonlocal last
        if time.monotonic() - last >= QUIET_SECONDS:
            last = time.monotonic()
            say(f"{what}: {done} of {total}", err=True)

    return update


def _lines(ess: float, what: str) -> Callable[[Progress], None]:
    last = time.monotonic()

    def update(progress: Progress) -> None:
        nonlocal last
        if time.monotonic() - last >= QUIET_SECONDS:
            last = time.monotonic()
            reached = _reached(progress)
            size = "" if reached is None else f", effective sample size {reached:.0f} of {ess:.0f}"
            say(f"{what}: {progress.steps} steps{size}", err=True)

    return update


def _reached(progress: Progress) -> float | None:
    return None if progress.report is None else float(np.min(progress.report.ess_bulk))
