"""From recordings to the table that a fit takes, with its provenance: `reduce_recordings`."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset
from skinbayes.files.reading import open_file
from skinbayes.files.recipe import Recipe, load_recipe
from skinbayes.files.recording_file import read_recording, recording_of_frame
from skinbayes.files.recording_text import LARGEST_RECORDING
from skinbayes.files.reduced_rows import grouped_rows, table_columns
from skinbayes.recordings import FrictionRow, ReducedRecording, reduce_recording

if TYPE_CHECKING:
    from pandas import DataFrame


@dataclass(frozen=True, eq=False)
class ReducedRecordings:
    """Friction of several recordings.

    Attributes
    ----------
    recordings : each of them, with its strokes, zeros and what is to be said of it
    rows : of the table
    recipe : by which it was made
    sources : name of each recording to the sha256 of its file; empty text of a data frame
    dataset : the table, as a fit takes it
    before_zero : rows left out because they lie before the zero of time

    Examples
    --------
    Examples of methods go on from this one.

    >>> import numpy as np, pandas as pd, skinbayes as sb
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> folder = Path(mkdtemp())
    >>> t = np.arange(0, 8, 0.01)
    >>> noise = np.random.default_rng(1).normal(scale=0.004, size=t.size)
    >>> forward = t % 4 < 2
    >>> frame = pd.DataFrame({"t": t, "x": 10 * np.abs(1 - t % 4 / 2), "Fx": np.where(forward, 0.2, -0.2) + noise, "Fz": 0.5})
    >>> reduced = sb.reduce_recordings({"glass": frame}, {
    ...     "title": "Glass on a forearm", "authors": ["A. Author"],
    ...     "columns": {"time": {"name": "t", "unit": "s"}, "position": {"name": "x", "unit": "mm"},
    ...                 "tangential_force": {"name": "Fx", "unit": "N"}, "normal_force": {"name": "Fz", "unit": "N"}}})
    >>> reduced.sources
    {'glass': ''}
    """

    recordings: tuple[ReducedRecording, ...]
    rows: tuple[FrictionRow, ...]
    recipe: Recipe
    sources: Mapping[str, str]
    dataset: Dataset
    before_zero: int = 0

    def table(self) -> DataFrame:
        """The table in SI.

        Returns
        -------
        pandas.DataFrame
            A row for each stroke (or what the recipe says), columns as in :attr:`dataset`.

        Examples
        --------
        >>> reduced.table()["friction_coefficient"].round(2).tolist()
        [0.4, 0.4, 0.4, 0.4]
        """
        import pandas as pd

        return pd.DataFrame(dict(self.dataset.columns))

    def save(self, path: str | Path) -> tuple[Path, Path]:
        """Write the table and its provenance, which holds the recipe; in a folder they are a data set.

        Parameters
        ----------
        path : a file that ends in ``.csv``, or a folder for ``data.csv``

        Returns
        -------
        tuple of Path
            The CSV and ``provenance.toml`` (``NAME.provenance.toml`` beside a CSV of another name).

        Examples
        --------
        >>> data, provenance = reduced.save(folder / "glass")
        >>> data.name, provenance.name, sb.load_dataset(folder / "glass").n_rows
        ('data.csv', 'provenance.toml', 4)
        """
        from skinbayes.files.reduced_provenance import provenance_text

        data, described = targets(path)
        data.parent.mkdir(parents=True, exist_ok=True)
        text = self.dataset.to_csv()
        data.write_text(text, encoding="utf-8", newline="\n")
        described.write_text(
            provenance_text(self, hashlib.sha256(text.encode()).hexdigest()), encoding="utf-8", newline="\n"
        )
        return data, described


def targets(path: str | Path) -> tuple[Path, Path]:
    """The CSV and its provenance; a folder gets both under the names that make it a data set."""
    path = Path(path)
    if path.suffix.lower() != ".csv":
        if path.suffix or path.is_file():
            raise InputError(f"{path}: expected a file that ends in .csv, or a folder")
        path = path / "data.csv"
    name = "provenance.toml" if path.name == "data.csv" else f"{path.stem}.provenance.toml"
    return path, path.with_name(name)


def reduce_recordings(
    recordings: str | Path | Iterable[str | Path] | Mapping[str, DataFrame],
    recipe: str | Path | Mapping[str, Any],
    *,
    progress: Callable[[int, int], None] | None = None,
) -> ReducedRecordings:
    """Make force–time recordings of a tribometer the table of friction that a fit takes.

    Strokes are found, their steady parts chosen and zeros taken off as the recipe says; friction of each gets a standard error
    from the number of independent samples. docs/recordings.md has the rules.

    Parameters
    ----------
    recordings : path of a file, several of them, or a mapping of names to data frames
    recipe : path of a TOML file, or its tables as a mapping
    progress : called with the number of recordings done and their total

    Returns
    -------
    ReducedRecordings

    Raises
    ------
    InputError
        naming file, line and column of what cannot be used

    Examples
    --------
    >>> import numpy as np, pandas as pd, skinbayes as sb
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> folder = Path(mkdtemp())
    >>> t = np.arange(0, 8, 0.01)
    >>> noise = np.random.default_rng(1).normal(scale=0.004, size=t.size)
    >>> forward = t % 4 < 2
    >>> frame = pd.DataFrame({"t": t, "x": 10 * np.abs(1 - t % 4 / 2), "Fx": np.where(forward, 0.2, -0.2) + noise, "Fz": 0.5})
    >>> reduced = sb.reduce_recordings({"glass": frame}, {
    ...     "title": "Glass on a forearm", "authors": ["A. Author"],
    ...     "columns": {"time": {"name": "t", "unit": "s"}, "position": {"name": "x", "unit": "mm"},
    ...                 "tangential_force": {"name": "Fx", "unit": "N"}, "normal_force": {"name": "Fz", "unit": "N"}}})
    >>> reduced.dataset.n_rows, round(float(reduced.dataset.columns["normal_force"][0]), 3)
    (4, 0.5)
    """
    plan = load_recipe(recipe)
    frames: Mapping[str, Any] = recordings if isinstance(recordings, Mapping) else {}
    names = (
        list(frames) if frames else [recordings] if isinstance(recordings, (str, Path)) else list(recordings)
    )
    if not names or len(set(map(str, names))) < len(names):
        raise InputError("recordings: expected at least one, and none twice")
    found, sources = [], {}
    short = [Path(str(name)).name for name in names]
    for count, (name, known) in enumerate(zip(names, short, strict=True), 1):
        recording = (
            recording_of_frame(frames[str(name)], str(name), plan) if frames else read_recording(name, plan)
        )
        unique = known if short.count(known) == 1 else str(name)
        # messages have the path
        reduced = reduce_recording(replace(recording, name=str(name)), plan.rules)
        found.append(replace(reduced, name=unique))
        sources[unique] = "" if frames else _sha256(Path(str(name)))
        if progress is not None:
            progress(count, len(names))
    rows, before = grouped_rows(found, plan)
    dataset = Dataset.from_columns(table_columns(rows, found, plan), name=f"{plan.path}: rows")
    return ReducedRecordings(tuple(found), tuple(row for row, _ in rows), plan, sources, dataset, before)


def _sha256(path: Path) -> str:
    with open_file(path, LARGEST_RECORDING, "a recording") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
