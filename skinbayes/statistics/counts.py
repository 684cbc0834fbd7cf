"""How surprising a count is of events that each have a probability of their own."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import ArrayLike


def count_p_value(count: int, probabilities: ArrayLike) -> float:
    """Probability of so many events or fewer, or of so many or more, the smaller of the two doubled.

    Parameters
    ----------
    count : events that happened
    probabilities : of each event, shape ``(n,)``; all alike they make a binomial count

    Returns
    -------
    float
        At most 1.

    Examples
    --------
    >>> print(f"{count_p_value(2, np.full(10, 0.5)):.4f}")
    0.1094
    """
    distribution = np.ones(1)
    for p in np.asarray(probabilities, dtype=float):
        distribution = np.convolve(distribution, [1.0 - p, p])
    return float(min(1.0, 2.0 * min(distribution[: count + 1].sum(), distribution[count:].sum())))
