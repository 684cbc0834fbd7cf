"""Where a data set is: a shipped one by its name, any other by its path."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from skinbayes import vocabulary
from skinbayes.errors import InputError
from skinbayes.files.locate import shipped_folder, shipped_names

DATA_FILE = "data.csv"
PROVENANCE_FILE = "provenance.toml"


def find_dataset(
    name_or_path: str | Path, *, relative_to: Path | None = None
) -> tuple[str, Path, Path | None]:
    """Key, CSV and provenance file (None for a bare CSV) of a data set.

    Raises
    ------
    InputError
        if there is neither a shipped data set of this name nor such a file or folder
    """
    shipped = shipped_names("datasets")
    if isinstance(name_or_path, str) and name_or_path in shipped:
        folder = shipped_folder("datasets") / name_or_path
        return name_or_path, folder / DATA_FILE, folder / PROVENANCE_FILE
    if str(name_or_path).strip() == "" or "\0" in str(name_or_path):
        raise InputError(f"data set {str(name_or_path)!r}: expected a name or the path of a CSV file")
    path = Path(name_or_path).expanduser()
    if relative_to is not None:
        path = relative_to / path
    try:
        is_folder, is_file = path.is_dir(), path.exists()
    except OSError:
        is_folder = is_file = False
    if is_folder:
        described_in = path / PROVENANCE_FILE
        return path.resolve().name, path / DATA_FILE, described_in if described_in.is_file() else None
    if is_file:
        return path.stem, path, None
    if path.suffix.lower() == ".csv":
        beside = sorted(found.name for found in path.parent.glob("*.csv")) if path.parent.is_dir() else []
        raise InputError(
            f"data set {str(name_or_path)[:400]!r}: neither a shipped data set nor an existing file."
            f"{suggestions(path.name, beside)}"
        )
    raise InputError(
        f"data set {str(name_or_path)[:400]!r}: neither a shipped data set nor an existing file; shipped are "
        f"{', '.join(shipped)}.{suggestions(name_or_path, shipped)}"
    )


def listed(names: Sequence[str], at_most: int = 20) -> str:
    """Names in quotation marks, of many the first."""
    shown = ", ".join(repr(name) for name in names[:at_most])
    return shown + (f" and {len(names) - at_most} more" if len(names) > at_most else "")


def suggestions(name: object, known: Sequence[str]) -> str:
    """What may have been meant, as a sentence that a blank comes before; empty if nothing is like it."""
    return vocabulary.suggestions(str(name)[:80], list(known))
