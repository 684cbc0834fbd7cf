"""Work through batches in blocks that stay in the cache: larger temporary arrays cost several times more per element."""

from __future__ import annotations

from collections.abc import Iterator
from math import prod

import numpy as np

from skinbayes.arrays import FloatArray

_TERMS = 8192  # of a block


def as_rows(values: FloatArray, batch: tuple[int, ...]) -> FloatArray:
    """``values`` of shape ``(..., n)`` broadcast to ``batch`` and flattened to ``(rows, n)``."""
    width = values.shape[-1]
    return np.ascontiguousarray(np.broadcast_to(values, (*batch, width))).reshape(prod(batch), width)


def blocks(rows: int, columns: int, width: int) -> Iterator[tuple[slice, slice]]:
    """Blocks of rows and columns of an array ``(rows, columns, width)``."""
    column_step = max(1, min(columns, _TERMS // width))
    row_step = max(1, _TERMS // (column_step * width))
    for row in range(0, rows, row_step):
        for column in range(0, columns, column_step):
            yield slice(row, row + row_step), slice(column, column + column_step)
