"""The progress of a run on standard error: one changing line on a terminal, a line now and then elsewhere."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any

from skinbayes.cli.output import console, say

if TYPE_CHECKING:
    from skinbayes.sampling.progress import RunProgress

QUIET_SECONDS = 15.0
"""Without a terminal one line is written each time this much time has passed."""

SAMPLING = "sampling"
"""What is going on unless something else is said."""

CLOCK = 9
"""Characters that the time passed takes at the end of the line."""


@contextmanager
def sampling_progress(what: str = SAMPLING) -> Iterator[Callable[[RunProgress], None]]:
    """Yield what to call after every block of steps; says how many there are and what is still missing, on one line."""
    terminal = console(stderr=True)
    if not terminal.is_terminal:
        yield _now_and_then(lambda progress: f"{what}: {progress.steps} steps, {progress.sentence()}")
        return
    from rich.progress import Progress as Bar
    from rich.progress import TextColumn, TimeElapsedColumn
    from rich.table import Column

    one_line = TextColumn(
        "{task.description}", markup=False, table_column=Column(no_wrap=True, overflow="ellipsis", ratio=1)
    )
    with Bar(one_line, TimeElapsedColumn(), console=terminal, transient=True, expand=True) as bar:
        task = bar.add_task(f"{what}: starting", total=None)
        before = "" if what == SAMPLING else f"{what}: "

        def update(progress: RunProgress) -> None:
            counted = f"{before}{progress.steps} steps, "
            room = terminal.width - len(counted) - CLOCK
            bar.update(task, description=counted + progress.sentence(room))

        yield update


@contextmanager
def counted_progress(what: str) -> Iterator[Callable[[int, int], None]]:
    """Yield what to call with the number done and their total; nothing is shown before the first call."""
    terminal = console(stderr=True)
    if not terminal.is_terminal:
        yield _now_and_then(lambda done, total: f"{what}: {done} of {total}")
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
def fit_progress(
    name: str = "",
) -> Iterator[tuple[Callable[[int, int], None], Callable[[RunProgress], None]]]:
    """Yield what to call while a table is built, and after every block of steps; one bar makes way for the other."""
    of, before = (f" of {name}", f"{SAMPLING} {name}") if name else ("", SAMPLING)
    with ExitStack() as shown:
        count = shown.enter_context(counted_progress(f"building the table{of}"))
        sampling: list[Callable[[RunProgress], None]] = []

        def update(progress: RunProgress) -> None:
            if not sampling:
                shown.close()
                sampling.append(shown.enter_context(sampling_progress(before)))
            sampling[0](progress)

        yield count, update


@contextmanager
def named_progress(what: str) -> Iterator[Callable[[str, RunProgress], None]]:
    """Yield what to call with the name of a model after every block of its steps."""
    with ExitStack() as shown:
        current: dict[str, Callable[[RunProgress], None]] = {}

        def update(name: str, progress: RunProgress) -> None:
            if name not in current:
                # the bar of the baseline model before makes way
                shown.close()
                current[name] = shown.enter_context(sampling_progress(f"{what} {name}"))
            current[name](progress)

        yield update


def _now_and_then(say_it: Callable[..., str]) -> Callable[..., None]:
    """A line on standard error each time that enough time has passed."""
    last = time.monotonic()

    def update(*progress: Any) -> None:
        nonlocal last
        if time.monotonic() - last >= QUIET_SECONDS:
            last = time.monotonic()
            say(say_it(*progress), err=True)

    return update
