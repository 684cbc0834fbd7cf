"""What a sampler sees of a problem."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from skinbayes.arrays import FloatArray


class Target(Protocol):
    """A log-density on the whole real space, evaluated in batches.

    Implementations are frozen and can be pickled (they travel to worker processes).
    """

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the coordinates, in order."""

    @property
    def fingerprint(self) -> str:
        """A digest of everything the density depends on: model, data, priors, code version."""

    def log_density(self, position: FloatArray) -> FloatArray:
        """Log-density of each row of ``position`` (shape ``(B, D)``), shape ``(B,)``; −inf where impossible.

        NaN and +inf are taken as −inf by the sampler, which counts them and keeps the first offending position.
        """

    def starts(self, rng: np.random.Generator, count: int) -> FloatArray:
        """``count`` dispersed positions of finite density, shape ``(count, D)``."""
