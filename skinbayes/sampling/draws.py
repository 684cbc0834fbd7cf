"""What an engine returns, and the one way in which draws of unequal weight become draws of equal weight."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.statistics.annealing import effective_number


@dataclass(frozen=True)
class Draws:
    """Draws of a target.

    Attributes
    ----------
    samples : in the coordinates of the target, shape ``(chains, draws, D)``; one chain may be given as ``(draws, D)``
    log_weights : ln of their weights up to a constant, shape ``(chains, draws)`` or ``(draws,)``; None if all weigh the same
    log_evidence : ln of the integral of prior times likelihood, and its standard error; None if it is not known
    diagnostics : what the engine says about its run, by name. Known names, of which any may be missing: ``converged``,
        ``verdict`` (a sentence), ``missing`` (sentences), ``ess_bulk``, ``ess_tail``, ``r_hat`` (one number for each coordinate),
        ``evaluations``, ``steps``, ``invalid``, ``first_invalid``. Others are kept and shown under the name they have
    log_density : of the samples, shape ``(chains, draws)``; computed where it is needed if omitted

    Raises
    ------
    InputError
        Shapes that do not fit each other, samples that are not finite, or weights that are NaN, +inf or all zero.

    Examples
    --------
    >>> Draws([[0.0], [1.0]], np.log([3.0, 1.0])).samples.shape
    (1, 2, 1)
    """

    samples: FloatArray
    log_weights: FloatArray | None = None
    log_evidence: tuple[float, float] | None = None
    diagnostics: Mapping[str, Any] = field(default_factory=dict)
    log_density: FloatArray | None = None

    def __post_init__(self) -> None:
        samples = np.asarray(self.samples, dtype=float)
        samples = samples[np.newaxis] if samples.ndim == 2 else samples
        if samples.ndim != 3 or not samples.size:
            raise InputError(
                f"draws: an array of shape {samples.shape} found; expected (draws, D) or (chains, draws, D)"
            )
        if not np.isfinite(samples).all():
            raise InputError(f"draws: {np.sum(~np.isfinite(samples))} numbers are not finite")
        object.__setattr__(self, "samples", samples)
        for name in ("log_weights", "log_density"):
            values = getattr(self, name)
            if values is not None:
                object.__setattr__(self, name, _of_each(values, name, samples.shape[:2]))
        weights = self.log_weights
        if weights is not None and (np.isnan(weights).any() or not np.isfinite(weights.max())):
            raise InputError("log_weights: NaN, +inf, or nothing but −inf found; expected ln of weights")

    @property
    def dimension(self) -> int:
        """Number of coordinates D."""
        return int(self.samples.shape[-1])

    @property
    def effective_number(self) -> float:
        """(Σw)²/Σw² of the weights; the number of draws if they all weigh the same."""
        if self.log_weights is None:
            return float(self.samples.shape[0] * self.samples.shape[1])
        return effective_number(self.log_weights.ravel())

    def equally_weighted(self, most: int, rng: np.random.Generator) -> FloatArray:
        """Draws that all weigh the same, ``most`` of them at most, shape ``(chains, draws, D)``.

        Draws of equal weight are thinned evenly. Others become one chain by systematic resampling: of N draws of weight w,
        ⌊N w⌋ or ⌈N w⌉ copies are taken, in random order.
        """
        chains, length, dimension = self.samples.shape
        if self.log_weights is None:
            return self.samples[:, :: -(-length * chains // most)] if length * chains > most else self.samples
        fraction = np.exp(self.log_weights.ravel() - self.log_weights.max())
        count = min(most, fraction.size)
        places = (rng.random() + np.arange(count)) / count
        edges = np.cumsum(fraction) / fraction.sum()
        # the last edge may fall short of 1 by rounding
        chosen = rng.permutation(np.minimum(np.searchsorted(edges, places, "right"), fraction.size - 1))
        return self.samples.reshape(-1, dimension)[np.newaxis, chosen]


def weighted_quantiles(values: FloatArray, weights: FloatArray, probabilities: ArrayLike) -> FloatArray:
    """Quantiles of weighted draws, linear between the middles of the steps of their distribution function.

    Parameters
    ----------
    values, weights : shape ``(n,)``; the weights need no norm
    probabilities : any shape

    Examples
    --------
    >>> weighted_quantiles(np.array([2.0, 1.0, 3.0]), np.array([2.0, 1.0, 1.0]), 0.5).item()
    2.0
    """
    order = np.argsort(values)
    heights = np.cumsum(weights[order]) - weights[order] / 2
    return np.asarray(np.interp(np.asarray(probabilities) * weights.sum(), heights, values[order]))


def _of_each(values: ArrayLike, name: str, shape: tuple[int, ...]) -> FloatArray:
    array = np.asarray(values, dtype=float)
    if array.shape not in (shape, shape[1:] if shape[0] == 1 else shape):
        raise InputError(f"{name}: shape {array.shape} found, one for each draw, {shape}, expected")
    return array.reshape(shape)
