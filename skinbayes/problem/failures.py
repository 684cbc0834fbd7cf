"""Arithmetic that fails for numbers which no skin has, as an error for the person who wrote them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError

FAILED = "the forward model cannot be evaluated"


@contextmanager
def explained(path: Path, doing: str) -> Iterator[None]:
    """Turn a failure of numerical code into an :class:`InputError` that names the model file.

    Physics and linear algebra refuse what they know to be wrong; values hundreds of orders of magnitude apart overflow in places
    that no check foresees.

    Parameters
    ----------
    path : the model file
    doing : what failed, such as ``"the forward model cannot be evaluated"``
    """
    try:
        yield
    except InputError:
        raise
    except MemoryError:
        raise InputError(f"{path}: {doing}: it takes more memory than there is") from None
    except (ArithmeticError, ValueError, IndexError) as error:  # that of linear algebra is a ValueError
        raise InputError(
            f"{path}: {doing} ({str(error).rstrip('.'):.120}); are all parameters, priors and data of the size that they "
            "have in nature? 'skinbayes check' and 'skinbayes show' list them"
        ) from error


def without_underflow(values: FloatArray) -> FloatArray:
    """A copy in which numbers too small to have all their digits, which rounding has made of nothing, are 0."""
    return np.where(np.abs(values) < np.finfo(float).tiny, 0.0, values)


def impossible(values: FloatArray) -> FloatArray:
    """Log-densities in which what is no number, or infinitely likely, counts as impossible."""
    return np.where(values < np.inf, values, -np.inf)
