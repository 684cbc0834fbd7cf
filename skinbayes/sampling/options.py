"""What a user can choose about a sampling run."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from skinbayes.errors import InputError

DEFAULT_WALKERS = 128
"""Walkers of an ensemble unless the dimension asks for more: enough for a kernel density of half of them."""

FEWER_WALKERS = 64
"""The same for targets whose evaluation takes far longer than a step of the sampler: the steps that the stopping rule asks for do
not depend on the number of walkers."""


@dataclass(frozen=True)
class SamplerOptions:
    """Settings of a run of several independent ensembles.

    Only ``seed``, ``ensembles`` and ``walkers`` (and the moves) change the draws; ``block_steps`` sets when they
    are stored and judged. The rest says when to stop and how to compute.

    Attributes
    ----------
    seed : non-negative integer from which every random stream is spawned
    ensembles : number of independent ensembles; they are the chains of R-hat
    walkers : walkers of each ensemble, even and at least twice the dimension; None is
        :data:`DEFAULT_WALKERS` (:data:`FEWER_WALKERS` if ``costly``) or four times the dimension, whichever is larger
    ess : effective sample size wanted in every coordinate, over all ensembles together
    r_hat : largest acceptable rank-normalised split R-hat between ensembles
    steps_over_tau : kept steps, summed over the ensembles, must reach this many autocorrelation times
    max_steps : steps of each ensemble after which the run ends, converged or not (a total: resuming does not add)
    block_steps : steps between two writes to the store
    cores : worker processes that share the ensembles
    vectorize : evaluate half an ensemble in one call, else walker by walker
    costly : the target takes so long to evaluate that fewer walkers are better

    Raises
    ------
    InputError
        If a value is out of range; the message names it.

    Examples
    --------
    >>> SamplerOptions(seed=1).walkers_for(dimension=5)
    128
    >>> SamplerOptions(seed=1).walkers_for(dimension=40)
    160
    """

    seed: int
    ensembles: int = 4
    walkers: int | None = None
    ess: float = 2000.0
    r_hat: float = 1.01
    steps_over_tau: float = 50.0
    max_steps: int = 10_000
    block_steps: int = 100
    cores: int = 1
    vectorize: bool = True
    costly: bool = False

    def __post_init__(self) -> None:
        _whole("seed", self.seed, 0)
        _whole("ensembles", self.ensembles, 2)
        if self.walkers is not None:
            _whole("walkers", self.walkers, 4)
            if self.walkers % 2:
                raise InputError(f"sampler option walkers: {self.walkers} found, an even number expected.")
        _whole("block_steps", self.block_steps, 1)
        _whole("max_steps", self.max_steps, self.block_steps)
        _whole("cores", self.cores, 1)
        _above("ess", self.ess, 0.0)
        _above("r_hat", self.r_hat, 1.0)
        _above("steps_over_tau", self.steps_over_tau, 0.0)

    def walkers_for(self, dimension: int) -> int:
        """Walkers of each ensemble for a target of ``dimension`` coordinates; InputError if too few were asked for."""
        if self.walkers is None:
            return max(FEWER_WALKERS if self.costly else DEFAULT_WALKERS, 4 * dimension)
        if self.walkers < 2 * dimension:
            raise InputError(
                f"sampler option walkers: {self.walkers} found, at least {2 * dimension} expected "
                f"(twice the {dimension} coordinates)."
            )
        return self.walkers


def _whole(name: str, value: object, least: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise InputError(
            f"sampler option {name}: {value!r} found, a whole number of at least {least} expected."
        )


def _above(name: str, value: float, bound: float) -> None:
    if (
        isinstance(value, bool)
        or not isinstance(value, int | float)
        or not (isfinite(value) and value > bound)
    ):
        raise InputError(f"sampler option {name}: {value!r} found, a finite number above {bound:g} expected.")
