"""One number out of many, for the rules of words."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray


def farthest_from_one(ratios: FloatArray) -> float:
    """The ratio that is farthest from 1, up or down.

    Examples
    --------
    >>> farthest_from_one(np.array([0.7, 1.2]))
    0.7
    """
    return float(ratios[np.argmax(np.abs(np.log(ratios)))])


def largest_change(ratios: FloatArray) -> float:
    """The ratio that is farthest from 1, less 1.

    Examples
    --------
    >>> round(largest_change(np.array([0.95, 1.02])), 3)
    -0.05
    """
    return farthest_from_one(ratios) - 1.0


def growing(values: FloatArray) -> float:
    """Last over first of a series that never steps back, else its largest step back, a ratio below 1.

    Examples
    --------
    >>> growing(np.array([1.0, 2.0, 4.0])), growing(np.array([1.0, 3.0, 1.5]))
    (4.0, 0.5)
    """
    steps = values[1:] / values[:-1]
    return float(values[-1] / values[0] if steps.min() >= 1.0 else steps.min())


def falling(values: FloatArray) -> float:
    """Last over first of a series that never steps up, else its largest step up, a ratio above 1.

    Examples
    --------
    >>> falling(np.array([4.0, 2.0, 1.0])), falling(np.array([4.0, 1.0, 1.5]))
    (0.25, 1.5)
    """
    steps = values[1:] / values[:-1]
    return float(values[-1] / values[0] if steps.max() <= 1.0 else steps.max())
