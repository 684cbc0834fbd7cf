"""Checked input of the crossed group effects: shapes raise, impossible numbers are marked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError

_PART = 128
"""Vectors that are worked on at once; larger arrays cost more in fresh memory than they save in calls."""


@dataclass(frozen=True, eq=False)
class GroupData:
    """Residuals and scales of a batch; impossible vectors hold harmless numbers and are marked.

    Attributes
    ----------
    residual : data less prediction, shape ``(B, N)``, unit of the data
    width : standard deviation of each row, shape ``(B, N)``, same unit
    weight : 1/width², shape ``(B, N)``
    scale : standard deviation of each effect, shape ``(B, G)``, same unit
    possible : False for vectors with an impossible number, shape ``(B,)``
    """

    residual: FloatArray
    width: FloatArray
    weight: FloatArray
    scale: FloatArray
    possible: NDArray[np.bool_]

    def parts(self) -> Iterator[GroupData]:
        """The batch in parts whose matrices fit in the cache; at least one, also of an empty batch."""
        for start in range(0, max(len(self.residual), 1), _PART):
            place = slice(start, start + _PART)
            yield GroupData(*(values[place] for values in vars(self).values()))


def scale_of_effects(scales: FloatArray, level_counts: Sequence[int]) -> FloatArray:
    """Scales of columns, shape ``(B, n_columns)``, as scales of their effects, shape ``(B, G)``."""
    return np.repeat(scales, level_counts, axis=-1)


def group_data(
    residual: ArrayLike, width: ArrayLike, scales: ArrayLike, n_rows: int, level_counts: Sequence[int]
) -> GroupData:
    """Bring input into shape.

    Parameters
    ----------
    residual, width, scales : see :class:`skinbayes.statistics.groups.CrossedGroups`
    n_rows : number of rows of the design
    level_counts : number of levels of each column

    Raises
    ------
    InputError
        if the shapes do not fit
    """
    r = np.ascontiguousarray(residual, dtype=float)
    if r.ndim != 2 or r.shape[1] != n_rows:
        raise InputError(
            f"group effects: residuals of shape {r.shape}, expected (B, {n_rows}), one for each row"
        )
    try:
        w = np.ascontiguousarray(np.broadcast_to(np.asarray(width, dtype=float), r.shape))
        s = np.broadcast_to(np.asarray(scales, dtype=float), (len(r), len(level_counts)))
    except ValueError:
        raise InputError(
            f"group effects: widths of shape {np.shape(width)} and scales of shape {np.shape(scales)}, expected"
            f" shapes that broadcast to {r.shape} and {(len(r), len(level_counts))}"
        ) from None
    possible = np.isfinite(r).all(axis=-1) & ((w > 0.0) & (w < inf)).all(axis=-1)
    possible &= ((s >= 0.0) & (s < inf)).all(axis=-1)
    if not possible.all():
        valid = possible[:, None]
        r, w, s = np.where(valid, r, 0.0), np.where(valid, w, 1.0), np.where(valid, s, 0.0)
    with np.errstate(all="ignore"):
        weight = 1.0 / (w * w)
    return GroupData(r, w, weight, scale_of_effects(s, level_counts), possible)
