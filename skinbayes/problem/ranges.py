"""How far the inputs of a problem reach."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import Multiples, TiedRanges
from skinbayes.statistics.priors import Prior

DRAWS = 2000
"""Prior draws looked at."""

BEYOND = 1e-5
"""Fraction of the prior of each parameter that lies beyond the range on either side."""


def input_ranges(
    priors: Sequence[Prior],
    inputs: Callable[[FloatArray], Mapping[str, FloatArray]],
    seed: int = 4,
    multiples: Multiples | None = None,
) -> TiedRanges:
    """Smallest and largest value of each input over the rows and nearly all of the prior; inputs that are not finite left out.

    Parameters
    ----------
    priors : of each of the D parameters
    inputs : inputs of the forward model by name for parameter vectors ``(B, D)``
    seed : seed of the prior draws
    multiples : inputs that may be multiples of others; those are kept that are it wherever is looked

    Notes
    -----
    Looked at are prior draws, and each parameter by itself at its outermost quantiles with the others at their medians.
    """
    dimension = len(priors)
    outermost = np.tile(np.full(dimension, 0.5), (2 * dimension, 1))
    for i in range(dimension):
        outermost[2 * i : 2 * i + 2, i] = BEYOND, 1 - BEYOND
    rng = np.random.default_rng([seed])
    draws = np.stack(
        [
            np.concatenate([prior.quantile(outermost[:, i]), prior.draw(rng, DRAWS)])
            for i, prior in enumerate(priors)
        ],
        axis=-1,
    )
    given = inputs(draws)
    found = {
        name: (float(values.min()), float(values.max()))
        for name, values in given.items()
        if np.isfinite(values).all()
    }
    # an exponent of a covariate may act on one of two
    together = {
        name: (of, times)
        for name, (of, times) in (multiples or {}).items()
        if {name, of} <= set(found) and np.allclose(given[name], times * given[of], rtol=1e-12, atol=0)
    }
    return TiedRanges(found, together)
