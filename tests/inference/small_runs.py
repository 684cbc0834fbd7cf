"""Runs of a second or two, and what is compared between them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from small_models import two_parameters

from skinbayes.fit import Fit, sample
from skinbayes.problem import Problem

SMALL = {
    "seed": 5,
    "ess": 1e6,
    "walkers": 16,
    "ensembles": 2,
    "block_steps": 50,
    "max_steps": 200,
    "importance": False,
}
"""Four blocks of steps, never converged."""


def small_problem(folder: Path) -> Problem:
    folder.mkdir(exist_ok=True)
    return two_parameters(folder)


def small_run(problem: Problem, directory: Path | None = None, **more: Any) -> Fit:
    return sample(problem, directory=directory, **{**SMALL, **more})


def after(steps: int, act: Callable[[], object]) -> Callable[[Any], None]:
    """What to give as ``progress``, to act when so many steps are made."""

    def told(progress: Any) -> None:
        if progress.steps == steps:
            act()

    return told


def tree(folder: Path) -> dict[str, bytes | str | None]:
    """Everything in a folder: contents of files, targets of links."""
    return {
        str(path.relative_to(folder)): (
            str(path.readlink()) if path.is_symlink() else path.read_bytes() if path.is_file() else None
        )
        for path in sorted(folder.rglob("*"))
    }
