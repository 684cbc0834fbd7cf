"""What a sampler sees of a problem."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from skinbayes.arrays import FloatArray


class Target(Protocol):
    """A log-density on the whole real space, evaluated in batches, and the prior and likelihood it is made of.

    Implementations are frozen and can be pickled (they travel to worker processes). One that evaluates its likelihood to look for
    starts may say so by a method ``starts_counted(rng, count)``: the same starts, and the number of evaluations.
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

    def prior_transform(self, unit: FloatArray) -> FloatArray:
        """Positions at quantiles of the prior, given as rows of the unit cube, both ``(B, D)``: what nested sampling needs."""

    def log_likelihood(self, position: FloatArray) -> FloatArray:
        """Log-likelihood of each row of ``position``, shape ``(B,)``; −inf where impossible."""

    def integrated_out(self, position: FloatArray, rng: np.random.Generator) -> dict[str, FloatArray]:
        """Quantities that were integrated out, drawn at positions ``(B, D)``, each ``(B,)`` under a name for people."""


def is_hierarchical(target: Target) -> bool:
    """Whether a target says which of its coordinates belong to single people."""
    return getattr(target, "hierarchy", None) is not None


def moved_together(target: Target) -> int:
    """The largest number of coordinates that are moved together: all of them, unless people are moved one by one."""
    hierarchy = getattr(target, "hierarchy", None)
    return len(target.names) if hierarchy is None else int(hierarchy.together)
