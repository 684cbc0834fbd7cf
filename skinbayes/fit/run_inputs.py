"""What a run directory is told by, and the copies of model, data and curves that it holds."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.atomic import PARTIAL, write_atomically
from skinbayes.errors import InputError
from skinbayes.fit.run_lock import LOCK
from skinbayes.fit.storage import RUN, YARDSTICK_MODELS

if TYPE_CHECKING:
    from skinbayes.problem import Problem

FORMAT = "skinbayes run 1"
"""Under the key ``format`` of ``run.json``: the mark of a run directory. Nobody else writes it by chance."""

SHOWN = 4
"""Names listed of what else is in a folder."""


def read_note(directory: Path) -> dict[str, Any] | None:
    """What the note of a run directory says; None if the folder is empty or not there.

    Raises
    ------
    InputError
        It holds something else than a run.
    """
    try:
        names = sorted(item.name for item in directory.iterdir())
    except FileNotFoundError:
        return None
    except NotADirectoryError:
        raise InputError(f"{directory}: a file found, a folder expected") from None
    # traces of a process that was killed before it had claimed the folder
    names = [name for name in names if name != LOCK and not _is_leftover(name)]
    if not names:
        return None
    try:
        note = json.loads((directory / RUN).read_text(encoding="utf-8"))
    except (FileNotFoundError, IsADirectoryError, ValueError, RecursionError):
        note = None
    if isinstance(note, dict) and note.get("format") == FORMAT:
        return note
    more = len(names) - SHOWN
    found = ", ".join(names[:SHOWN]) + (f" and {more} more" if more > 0 else "")
    raise InputError(
        f"{directory}: holds {found}, and is no run of skinbayes; expected a new or empty folder, or a run. "
        "Nothing was written"
    )


def _is_leftover(name: str) -> bool:
    return name.startswith(".") and name.endswith(PARTIAL)


def remove_leftovers(directory: Path) -> None:
    """Remove files that a killed process was writing."""
    for item in directory.iterdir():
        if _is_leftover(item.name):
            item.unlink(missing_ok=True)


def own_yardsticks(problem: Problem) -> list[Path]:
    """Yardsticks that are no shipped models."""
    return [Path(name) for name in problem.spec.yardsticks if Path(name).suffix == ".toml"]


def write_inputs(directory: Path, problem: Problem) -> None:
    """Put the note, model file, data, curves and yardsticks of a problem into its run directory."""
    copies: dict[str, Path] = {"model.toml": problem.spec.path}
    note: dict[str, Any] = {
        "format": FORMAT,
        "model": problem.name,
        "fingerprint": problem.fingerprint,
        "data": None,
        "surface": None,
        "rheology": None,
        "settings": {name: text for name, text in problem.settings.items() if name != "surface"},
    }
    if "surface" in problem.settings and problem.surface_file is None:
        note["settings"]["surface"] = problem.settings["surface"]
    if problem.dataset is not None:
        source = Path(problem.dataset.path)
        copies[f"data/{source.name}"] = source
        note["rows"] = {column: list(labels) for column, labels in problem.dataset.selection.items()}
        provenance = source.with_name("provenance.toml")
        if source.name == "data.csv" and provenance.exists():
            copies[f"data/{provenance.name}"] = provenance
            note["data"] = "data"
        else:
            note["data"] = f"data/{source.name}"
    if problem.spec.rheology is not None and Path(problem.spec.rheology).is_file():
        copies["rheology.csv"] = Path(problem.spec.rheology)
        note["rheology"] = "rheology.csv"
    if problem.surface_file is not None:
        copies["spectrum.csv"] = problem.surface_file
        note["surface"] = "spectrum.csv"
    copies |= {f"{YARDSTICK_MODELS}/{path.name}": path for path in own_yardsticks(problem)}
    _write(directory, note, copies)


def _write(directory: Path, note: Mapping[str, Any], copies: Mapping[str, Path]) -> None:
    # read first: the user may point at the copies of an earlier run in this very directory
    contents = {name: source.read_bytes() for name, source in copies.items()}
    # the note first: what a kill leaves behind is known as a run; until there are steps, all is written again
    write_atomically(directory / RUN, (json.dumps(note, indent=1) + "\n").encode())
    for name, content in contents.items():
        (directory / name).parent.mkdir(exist_ok=True)
        write_atomically(directory / name, content)
