"""Data sets: a CSV with units in its header, and where it comes from."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from itertools import compress
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, TypeAlias
from unicodedata import normalize

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.columns import DROP, LEAVE_OUT, LabelArray, Missing, read_columns
from skinbayes.files.find_dataset import find_dataset, listed, suggestions
from skinbayes.files.given_columns import table_of_columns
from skinbayes.files.provenance import Provenance, check_sha256, load_provenance
from skinbayes.files.table import Problems, csv_text, quoted, read_table
from skinbayes.plugins import installed_forward_models

if TYPE_CHECKING:
    from pandas import DataFrame


@dataclass(frozen=True, eq=False)
class Dataset:
    """Columns of measurements in SI, immutable and picklable.

    Attributes
    ----------
    key : name of the data set (of the file, for a CSV of a user's own)
    path : the CSV; the name, for columns that were given as such
    columns : name to array of shape (n_rows,), read-only; numbers in SI, or text for label columns
    units : SI unit of each numeric column; as written where the vocabulary does not know the quantity
    n_rows : number of rows
    provenance : where the numbers come from, or None for a bare CSV
    sha256 : of the bytes of the CSV
    kind : ``"measurements"``
    selection : the labels that were selected, by column; empty for all rows
    lines : line (of a file) or row (of columns that were given) of each row; empty if not known
    dropped : those of the rows that were left out because a value is missing
    in_memory : whether there is no file

    Examples
    --------
    Examples of methods go on from this one.

    >>> data = load_dataset("adams2007-forearm-glass")
    >>> data.n_rows, data.columns["normal_force"].tolist(), data.units["normal_force"]
    (2, [0.5, 0.5], 'N')
    """

    key: str
    path: Path
    columns: Mapping[str, FloatArray | LabelArray]
    units: Mapping[str, str]
    provenance: Provenance | None
    sha256: str
    kind: Literal["measurements"] = "measurements"
    selection: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    lines: tuple[int, ...] = ()
    dropped: tuple[int, ...] = ()
    in_memory: bool = False

    def __post_init__(self) -> None:
        frozen: dict[str, FloatArray | LabelArray] = {}
        for name, values in self.columns.items():
            copy = values.copy()
            copy.setflags(write=False)
            frozen[name] = copy
        object.__setattr__(self, "columns", MappingProxyType(frozen))
        object.__setattr__(self, "units", MappingProxyType(dict(self.units)))
        object.__setattr__(self, "selection", MappingProxyType(dict(self.selection)))

    def __reduce__(self) -> tuple[Any, ...]:
        # a mapping proxy cannot be pickled, and arrays forget that they are read-only
        values = (getattr(self, one.name) for one in fields(self))
        return Dataset, tuple(dict(v) if isinstance(v, MappingProxyType) else v for v in values)

    @classmethod
    def from_columns(
        cls, columns: Mapping[str, Any] | DataFrame, name: str = "data", *, missing: Missing = "refuse"
    ) -> Dataset:
        """Make a data set of a pandas data frame or a mapping of arrays, with the checks of a CSV.

        Parameters
        ----------
        columns : header to values of shape (n_rows,). A header is as in a CSV, ``"normal_force [mN]"``; under the bare name of a
            quantity stand numbers in SI or a ``pint`` quantity; all else is a label column
        name : stands in messages in place of a file
        missing : whether rows without a value are refused, or kept (NaN, empty labels)

        Returns
        -------
        Dataset
            columns in SI

        Raises
        ------
        InputError
            as :func:`load_dataset` does, with the row in place of the line (the first is 1)

        Examples
        --------
        >>> data = Dataset.from_columns({"person": ["A", "B"], "normal_force [mN]": [500, 480]})
        >>> data.columns["normal_force"].tolist(), data.labels("person")
        ([0.5, 0.48], ('A', 'B'))
        """
        installed_forward_models()  # whose quantities the columns may be
        table = table_of_columns(columns, name)
        found, units = read_columns(table, missing=missing)
        made = cls(name, Path(name), found, units, None, "", lines=table.lines, in_memory=True)
        return replace(made, sha256=hashlib.sha256(made.to_csv().encode()).hexdigest())

    def to_csv(self) -> str:
        """The columns as a CSV in SI; read again, it has the same :attr:`fingerprint`.

        Returns
        -------
        str
            Header and rows.

        Examples
        --------
        >>> data.to_csv().splitlines()[0][:40]
        'state,body_site,counterface,friction_coe'
        """
        cells = {
            name: [repr(v) if v == v else "" for v in values.tolist()]
            if name in self.units
            else values.tolist()
            for name, values in self.columns.items()
        }
        return csv_text(cells, self.units)

    @property
    def shown(self) -> str:
        """What people know it by: a folder with provenance by its key, a file by its own name."""
        return self.path.name if self.path.stem == self.key else self.key

    @property
    def row_word(self) -> str:
        """What :attr:`lines` count: ``"line"`` of a file, or ``"row"``."""
        return "row" if self.in_memory or not self.lines else "line"

    @property
    def n_rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self.columns.values())))

    @property
    def fingerprint(self) -> str:
        """sha256 of the names, units and values of all columns: the same numbers, wherever they were read."""
        digest = hashlib.sha256()
        for name in sorted(self.columns):
            values = self.columns[name]
            content = "\n".join(values.tolist()).encode() if values.dtype.kind == "U" else values.tobytes()
            digest.update(f"{name}\n{self.units.get(name, '')}\n{len(content)}\n".encode() + content)
        return digest.hexdigest()

    def labels(self, column: str) -> tuple[str, ...]:
        """Different labels of a column.

        Parameters
        ----------
        column : a column of text

        Returns
        -------
        tuple of str
            In order of appearance.

        Raises
        ------
        InputError
            if there is no such label column

        Examples
        --------
        >>> data.labels("state")
        ('dry', 'wet')
        """
        return tuple(dict.fromkeys(self._label_column(column).tolist()))

    def select(self, rows: Mapping[str, Sequence[str]]) -> Dataset:
        """The rows whose labels are among those given.

        Parameters
        ----------
        rows : label column to the labels that stay, such as ``{"liquid": ["water"]}``

        Returns
        -------
        Dataset
            the same columns with fewer rows, in the same order

        Raises
        ------
        InputError
            for an unknown column or label, or if no row remains

        Examples
        --------
        >>> load_dataset("fehlberg2025-finger-stribeck").select({"liquid": ["water"]}).n_rows
        11
        """
        keep = np.ones(self.n_rows, dtype=bool)
        for column, wanted in rows.items():
            present = self.labels(column)
            chosen = _labels(wanted)
            for label in chosen:
                if label not in present:
                    raise InputError(
                        f"data set '{self.key}', column '{column}': no row is labelled {quoted(str(label))}; "
                        f"expected one of {listed(present)}.{suggestions(label, present)}"
                    )
            keep &= np.isin(self._label_column(column), chosen)
        if not keep.any():
            raise InputError(f"data set '{self.key}': no row has {_wish(rows)}; expected at least one row")
        chosen_labels = {column: tuple(_labels(labels)) for column, labels in rows.items()}
        return replace(self.rows(keep), selection={**self.selection, **chosen_labels})

    def complete(self, used: Collection[str], drop: bool) -> Dataset:
        """The rows that have a value in each of the columns ``used``.

        Parameters
        ----------
        used : names; those that are no columns are passed over
        drop : whether rows without a value are left out, or refused

        Returns
        -------
        Dataset
            the same columns with these rows

        Raises
        ------
        InputError
            a value is missing and its row may not be dropped, or no row remains

        Examples
        --------
        >>> gaps = Dataset.from_columns({"normal_force [N]": [0.5, None]}, missing="keep")
        >>> gaps.complete(["normal_force"], drop=True).n_rows
        1
        """
        empty = {
            name: np.isnan(values) if values.dtype.kind == "f" else values == ""
            for name, values in self.columns.items()
            if name in used
        }
        keep = ~np.any([*empty.values(), np.zeros(self.n_rows, dtype=bool)], axis=0)
        if keep.all():
            return self
        lines = self.lines or tuple(range(1, self.n_rows + 1))
        problems = Problems(self.path, self.row_word)
        for position, (name, missing) in enumerate(empty.items()):
            for row in np.flatnonzero(missing).tolist():
                problems.add(
                    lines[row], position, f", column '{name}': found no value. {LEAVE_OUT}, {DROP}", "missing"
                )
        if not drop:
            problems.raise_if_any()
        if not keep.any():
            raise InputError(f"{self.path}: no row has a value in each of the columns {', '.join(empty)}")
        dropped = tuple(line for line, kept in zip(lines, keep, strict=True) if not kept)
        return replace(self.rows(keep), dropped=tuple(sorted({*self.dropped, *dropped})))

    def rows(self, keep: NDArray[np.bool_]) -> Dataset:
        """Some of the rows.

        Parameters
        ----------
        keep : which, shape ``(n_rows,)``

        Returns
        -------
        Dataset
            the same columns with fewer rows, in the same order

        Examples
        --------
        >>> data.rows(np.array([True, False])).n_rows
        1
        """
        columns = {name: values[keep] for name, values in self.columns.items()}
        return replace(self, columns=columns, lines=tuple(compress(self.lines, keep)))

    def _label_column(self, column: str) -> LabelArray:
        available = [name for name in self.columns if name not in self.units]
        if column not in available:
            has = listed(available) if available else "none"
            raise InputError(
                f"data set '{self.key}': no label column {quoted(str(column))}; label columns are: {has}."
                f"{suggestions(column, available)}"
            )
        values: Any = self.columns[column]
        return values


def _labels(wanted: str | Sequence[str]) -> list[str]:
    """Labels in the Unicode normal form that columns have."""
    return [
        normalize("NFC", label) if isinstance(label, str) else label
        for label in ([wanted] if isinstance(wanted, str) else wanted)
    ]


def _wish(rows: Mapping[str, Sequence[str]]) -> str:
    return " and ".join(f"{column} in {list(labels)!r:.80}" for column, labels in rows.items()) or "any label"


Data: TypeAlias = "str | Path | Mapping[str, Any] | Dataset | DataFrame"
"""What can be made a data set of."""


def as_dataset(data: Data, *, relative_to: Path | None = None, missing: Missing = "refuse") -> Dataset:
    """A data set of whatever stands for one: itself, a name or path, a pandas data frame, a mapping of arrays.

    Parameters
    ----------
    data : as for :func:`load_dataset`
    relative_to : folder that relative paths start from; the current one by default
    missing : whether cells without a value are refused, or kept (NaN, empty labels); a `Dataset` is returned as it is

    Raises
    ------
    InputError
        as :func:`load_dataset` does
    """
    if isinstance(data, Dataset):
        return data
    if isinstance(data, (str, Path)):
        return load_dataset(data, relative_to=relative_to, missing=missing)
    if not hasattr(data, "items"):
        raise InputError(
            f"data: found {type(data).__name__}; expected the name or path of a data set, a data frame, or a mapping of column "
            "headers to values"
        )
    return Dataset.from_columns(data, missing=missing)


def load_dataset(
    name_or_path: Data, *, relative_to: Path | None = None, missing: Missing = "refuse"
) -> Dataset:
    """Read a data set and check every cell.

    Parameters
    ----------
    name_or_path : name of a shipped data set, path of a CSV, or of a folder with ``data.csv`` and
        ``provenance.toml``. A shipped name wins; write ``./name`` for a folder of the same name. A data frame or a
        mapping is read by :meth:`Dataset.from_columns`
    relative_to : folder that relative paths start from (that of a model file); the current one by default
    missing : whether cells without a value are refused, or kept (NaN, empty labels)

    Returns
    -------
    Dataset
        columns in SI

    Raises
    ------
    InputError
        naming file, line, column, what was found and what was expected; or if the numbers are a reference
        table, which cannot be fitted

    Examples
    --------
    >>> data = load_dataset("adams2007-forearm-glass")
    >>> data.labels("state"), data.columns["friction_coefficient"].tolist(), data.units["normal_force"]
    (('dry', 'wet'), [0.3, 1.4], 'N')
    """
    if not isinstance(name_or_path, (str, Path)):
        return as_dataset(name_or_path, missing=missing)
    installed_forward_models()  # whose quantities the columns may be
    key, path, described_in = find_dataset(name_or_path, relative_to=relative_to)
    provenance = None
    if described_in is not None:
        provenance = load_provenance(described_in)
        if provenance.kind == "reference":
            raise InputError(
                f"data set '{key}' is a reference table: published values for choosing priors and checking "
                "results, not measurements of one experiment, so it cannot be fitted. "
                f"'skinbayes show {key}' prints it"
            )
    problems = Problems(path)
    table = read_table(path, problems=problems)
    if provenance is not None and described_in is not None:
        check_sha256(provenance, path, table.sha256, described_in)
    columns, units = read_columns(table, problems, missing)
    return Dataset(key, path, columns, units, provenance, table.sha256, lines=table.lines)
