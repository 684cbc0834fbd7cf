"""Where the rows of a data set stand, and columns of which something is required."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset


def place_of_row(dataset: Dataset, row: int) -> str:
    """The file and the line of a row in it, or its number, for messages; ``row`` counts from 0."""
    return f"{dataset.path}, {dataset.row_word} {dataset.lines[row] if dataset.lines else row + 1}"


def positive_column(dataset: Dataset, column: str, why: str) -> FloatArray:
    """A numeric column, shape ``(N,)``, SI; :class:`InputError` with the row and the reason unless all values are > 0."""
    values = np.asarray(dataset.columns[column], dtype=float)
    for row in np.flatnonzero(~(values > 0)).tolist():
        raise InputError(
            f"{place_of_row(dataset, row)}, {column}: found {values[row]:g}; expected a value > 0, as {why}"
        )
    return values
