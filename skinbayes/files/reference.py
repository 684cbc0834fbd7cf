"""Reference tables: published values for choosing priors and checking results, which cannot be fitted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from skinbayes.errors import InputError
from skinbayes.files.find_dataset import find_dataset
from skinbayes.files.provenance import Provenance, check_sha256, load_provenance
from skinbayes.files.table import quoted, read_table
from skinbayes.units import NUMBER

if TYPE_CHECKING:
    from pandas import DataFrame

Cell = str | float | None


@dataclass(frozen=True, eq=False)
class ReferenceTable:
    """Published values, one row each, as the table has them: no conversion, free columns.

    Attributes
    ----------
    key : name of the table
    path : the CSV
    columns : headers in order, with the unit in brackets where a column has one
    rows : header to cell; a float in columns that hold numbers only, text otherwise, None where empty
    provenance : where the values come from, the meaning of columns and grades
    sha256 : of the bytes of the CSV
    """

    key: str
    path: Path
    columns: tuple[str, ...]
    rows: tuple[Mapping[str, Cell], ...]
    provenance: Provenance
    sha256: str

    def to_pandas(self) -> DataFrame:
        """The table as a pandas DataFrame, empty cells as missing values."""
        from pandas import DataFrame

        return DataFrame([dict(row) for row in self.rows], columns=list(self.columns))


def load_reference(name_or_path: str | Path) -> ReferenceTable:
    """Read a reference table.

    Parameters
    ----------
    name_or_path : name of a shipped table, or a folder with ``data.csv`` and ``provenance.toml``

    Raises
    ------
    InputError
        if there is no such table, it cannot be read, or it holds measurements that can be fitted

    Examples
    --------
    >>> table = load_reference("stratum-corneum-thickness")
    >>> [row["layer_thickness [m]"] for row in table.rows if row["body_site"] == "volar forearm"]
    [2.26e-05]
    """
    key, path, described_in = find_dataset(name_or_path)
    if described_in is None:
        raise InputError(f'{path}: no provenance.toml beside it; expected one with kind = "reference"')
    provenance = load_provenance(described_in)
    if provenance.kind != "reference":
        raise InputError(f"data set '{key}' holds measurements, not reference values; load it as a data set")
    table = read_table(path)
    check_sha256(provenance, path, table.sha256, described_in)
    if bad := [h for i, h in enumerate(table.header) if not h or h in table.header[:i]]:
        raise InputError(f"{table.header_place}: column {quoted(bad[0])} is unnamed or appears twice")
    columns = [_cells(table.column(position)) for position in range(len(table.header))]
    rows = (
        MappingProxyType(dict(zip(table.header, cells, strict=True))) for cells in zip(*columns, strict=True)
    )
    return ReferenceTable(key, path, table.header, tuple(rows), provenance, table.sha256)


def _cells(column: list[str]) -> list[Cell]:
    if all(cell == "" or NUMBER.fullmatch(cell) for cell in column):
        return [float(cell) if cell else None for cell in column]
    return [cell or None for cell in column]
