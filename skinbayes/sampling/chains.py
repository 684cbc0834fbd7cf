"""What a sampling run returns."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.sampling.stopping import StoppingReport
from skinbayes.sampling.weighted_draws import ImportanceDraws


@dataclass(frozen=True)
class Chains:
    """All steps of all ensembles, and which of them count.

    Attributes
    ----------
    names : coordinates, in order
    positions : shape ``(ensembles, steps, walkers, D)``
    log_density : shape ``(ensembles, steps, walkers)``
    report : the stopping rule's verdict at the last step
    evaluations : log-densities computed, starts included
    invalid : how many of them were NaN or +inf and were taken as −inf
    first_invalid : the first position of that kind, shape ``(D,)``; NaN if there was none
    importance : independent weighted draws that take the place of the positions, if importance sampling was accepted
    refused : why it was not, the last time it was tried; empty if it was not tried
    """

    names: tuple[str, ...]
    positions: FloatArray
    log_density: FloatArray
    report: StoppingReport
    evaluations: int
    invalid: int
    first_invalid: FloatArray
    importance: ImportanceDraws | None = None
    refused: str = ""

    @property
    def converged(self) -> bool:
        """Whether the stopping rule was met, or importance sampling accepted."""
        return self.report.converged or self.importance is not None

    @property
    def steps(self) -> int:
        """Steps of each ensemble, burn-in included."""
        return int(self.positions.shape[1])

    @property
    def kept(self) -> slice:
        """The steps after burn-in."""
        return slice(self.report.burn_in, self.steps)

    def acceptance_fraction(self) -> FloatArray:
        """Fraction of accepted moves of each ensemble after burn-in, shape ``(ensembles,)``."""
        kept = self.positions[:, self.kept]
        if kept.shape[1] < 2:
            return np.zeros(len(kept))
        moved: FloatArray = np.any(kept[:, 1:] != kept[:, :-1], axis=-1).mean(axis=(1, 2))
        return moved

    def thinning(self) -> int:
        """Steps between nearly independent positions of one walker: the largest autocorrelation time, rounded up."""
        largest = float(np.max(self.report.tau))
        return max(1, ceil(largest)) if np.isfinite(largest) else max(1, self.steps - self.report.burn_in)

    def draws(self, max_per_chain: int | None = None) -> tuple[FloatArray, FloatArray]:
        """Nearly independent draws, in order of time; a chain is an ensemble.

        Steps are kept one autocorrelation time apart, and all walkers of a kept step follow each other. If that
        is more than ``max_per_chain``, evenly spaced draws of it are returned.

        Parameters
        ----------
        max_per_chain : at most this many draws of each ensemble; None is no limit

        Returns
        -------
        positions of shape ``(ensembles, draws, D)`` and log-densities of shape ``(ensembles, draws)``
        """
        ensembles, _, walkers, dimension = self.positions.shape
        stride = self.thinning()
        # Counted from the end, so that the last (furthest from the starts) step is always among them.
        picked = np.arange(self.steps - 1, self.report.burn_in - 1, -stride)[::-1]
        positions = self.positions[:, picked].reshape(ensembles, picked.size * walkers, dimension)
        log_density = self.log_density[:, picked].reshape(ensembles, picked.size * walkers)
        if max_per_chain is not None and positions.shape[1] > max_per_chain:
            chosen = np.linspace(0, positions.shape[1] - 1, max_per_chain).round().astype(int)
            positions, log_density = positions[:, chosen], log_density[:, chosen]
        return positions, log_density
