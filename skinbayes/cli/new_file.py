"""Writing files that a user may already have."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from skinbayes.atomic import write_atomically
from skinbayes.errors import InputError


def refuse_existing(paths: Sequence[Path], overwrite: bool) -> None:
    """InputError for the first path that exists, unless it is an ordinary file that the user said may be overwritten."""
    for path in paths:
        if path.exists() and not path.is_file():
            raise InputError(f"{path}: exists and is no ordinary file; choose another name")
        if (path.exists() or path.is_symlink()) and not overwrite:
            raise InputError(f"{path}: exists already; choose another name, or add --overwrite")


def write_text(path: Path, text: str) -> None:
    """Write a UTF-8 file with line feeds, and its folder; all of it or nothing."""
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file and its folder; all of it or nothing."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, content)
    except OSError as error:
        # in the name that the user gave, not in that of the file on its way there
        raise OSError(error.errno, error.strerror, str(path)) from error


def write_columns(path: Path, columns: Mapping[str, Any]) -> None:
    """Write columns of equal length as a CSV in SI; nan is an empty cell."""
    from skinbayes.files.table import csv_text
    from skinbayes.vocabulary import QUANTITIES

    cells, units = {}, {}
    for name, values in columns.items():
        each = values.tolist()
        cells[name] = [("" if v != v else repr(v)) if isinstance(v, float) else str(v) for v in each]
        if not isinstance(each[0], str):
            # NAME_median is of the quantity NAME
            known = (
                name if name in QUANTITIES else next((q for q in QUANTITIES if name.startswith(f"{q}_")), "")
            )
            units[name] = QUANTITIES[known].unit if known else "1"
    write_text(path, csv_text(cells, units))


def format_of(
    form: str | None, output: str | None, known: tuple[str, ...], suffixes: dict[str, str], usual: str
) -> str:
    """The format asked for, else that of the name of the file, else the usual one."""
    if form is not None:
        if form.lower() not in known:
            raise InputError(f"--format: found {form[:80]!r}; expected {' or '.join(known)}")
        return form.lower()
    if output is None:
        return usual
    suffix = Path(output).suffix.lower()
    if suffix not in suffixes:
        raise InputError(
            f"-o {output}: found the kind {suffix!r}; expected a name that ends with {' or '.join(suffixes)}, or --format"
        )
    return suffixes[suffix]
