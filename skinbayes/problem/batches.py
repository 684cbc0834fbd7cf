"""Parameter vectors one at a time or many: what goes in and comes out of the methods of a problem."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError


def as_batch(theta: ArrayLike, names: Sequence[str]) -> tuple[FloatArray, bool]:
    """Parameter vectors as a batch ``(B, D)``, and whether it was a single one.

    Raises :class:`InputError` if they have another length than there are names.
    """
    array = np.asarray(theta, dtype=float)
    count = len(names)
    if array.ndim not in (1, 2) or array.shape[-1] != count:
        raise InputError(
            f"theta has shape {array.shape}; expected ({count},) or (B, {count}): {', '.join(names)}"
        )
    return (array[np.newaxis, :], True) if array.ndim == 1 else (array, False)


def unbatch(values: FloatArray, single: bool) -> FloatArray:
    """The only row of a batch if a single vector was given, else the batch."""
    return values[0] if single else values
