"""What a user can choose about a sampling run."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from skinbayes.defaults import EFFECTIVE_SAMPLE_SIZE, MAX_STEPS
from skinbayes.errors import InputError

DEFAULT_WALKERS = 128
"""Walkers of an ensemble unless the dimension asks for more: enough for a kernel density of half of them."""

EXPLORING_WALKERS = 32
"""Walkers of an ensemble that only has to find the posterior, which is then drawn from by importance sampling."""

BLOCK_STEPS, EXPLORING_BLOCK_STEPS = 100, 25
"""Steps between two writes to the store, without and with importance sampling."""

FEWER_WALKERS = 64
"""The same for targets whose evaluation takes far longer than a step of the sampler: the steps that the stopping rule asks for do
not depend on the number of walkers."""


@dataclass(frozen=True)
class EngineOptions:
    """What every engine can be told.

    Attributes
    ----------
    seed : non-negative integer from which every random stream is spawned
    ess : effective sample size wanted in every coordinate
    cores : worker processes
    expensive : the target takes so long to evaluate that fewer walkers are better

    Raises
    ------
    InputError
        If a value is out of range; the message names it.
    """

    seed: int
    ess: float = EFFECTIVE_SAMPLE_SIZE
    cores: int = 1
    expensive: bool = False

    def __post_init__(self) -> None:
        whole("seed", self.seed, 0)
        whole("cores", self.cores, 1)
        _above("ess", self.ess, 0.0)

    def check(self, dimension: int) -> None:
        """Raise InputError if a target of ``dimension`` coordinates cannot be sampled with these options."""


@dataclass(frozen=True)
class SamplerOptions(EngineOptions):
    """Settings of a run of several independent ensembles.

    Only ``seed``, ``ensembles`` and ``walkers`` (and the moves) change the draws; ``block_steps`` sets when they
    are stored and judged. The rest says when to stop and how to compute.

    Attributes
    ----------
    ensembles : number of independent ensembles; they are the chains of R-hat, and what ``cores`` share
    walkers : walkers of each ensemble, even and at least twice the dimension; None is
        :data:`EXPLORING_WALKERS` or four times the dimension, whichever is larger; in place of the first
        :data:`DEFAULT_WALKERS` without ``importance``, :data:`FEWER_WALKERS` if ``expensive`` too
    r_hat : largest acceptable rank-normalised split R-hat between ensembles
    steps_over_tau : kept steps, summed over the ensembles, must reach this many autocorrelation times
    max_steps : steps of each ensemble after which the run ends, converged or not (a total: resuming does not add)
    block_steps : steps between two writes to the store; None is :data:`EXPLORING_BLOCK_STEPS` (:data:`BLOCK_STEPS` without
        ``importance``)
    importance : let the walkers only find the posterior, and draw from it by importance sampling as soon as that is accepted
        (see ``skinbayes.sampling.importance``); also gives ln of the evidence
    search : positions at which to look for parts that were missed, for each evaluation that was made before; 0 does not look

    Examples
    --------
    >>> SamplerOptions(seed=1).walkers_for(dimension=5)
    32
    >>> SamplerOptions(seed=1, importance=False).walkers_for(dimension=40)
    160
    """

    ensembles: int = 4
    walkers: int | None = None
    r_hat: float = 1.01
    steps_over_tau: float = 50.0
    max_steps: int = MAX_STEPS
    block_steps: int = None  # type: ignore[assignment]  # filled in below
    importance: bool = True
    search: float = 0.1

    def __post_init__(self) -> None:
        super().__post_init__()
        if not isinstance(self.importance, bool):
            raise InputError(f"sampler option importance: {self.importance!r} found, true or false expected.")
        if self.block_steps is None:
            object.__setattr__(self, "block_steps", EXPLORING_BLOCK_STEPS if self.importance else BLOCK_STEPS)
        whole("ensembles", self.ensembles, 2)
        if self.walkers is not None:
            whole("walkers", self.walkers, 4)
            if self.walkers % 2:
                raise InputError(f"sampler option walkers: {self.walkers} found, an even number expected.")
        whole("block_steps", self.block_steps, 1)
        whole("max_steps", self.max_steps, self.block_steps)
        _above("r_hat", self.r_hat, 1.0)
        if self.search != 0:
            _above("search", self.search, 0.0)
        _above("steps_over_tau", self.steps_over_tau, 0.0)

    def check(self, dimension: int) -> None:
        """Raise InputError if there are too few walkers for ``dimension`` coordinates."""
        self.walkers_for(dimension)

    def walkers_for(self, dimension: int) -> int:
        """Walkers of each ensemble for a target of ``dimension`` coordinates; InputError if too few were asked for."""
        if self.walkers is None:
            usual = FEWER_WALKERS if self.expensive else DEFAULT_WALKERS
            return max(EXPLORING_WALKERS if self.importance else usual, 4 * dimension)
        if self.walkers < 2 * dimension:
            raise InputError(
                f"sampler option walkers: {self.walkers} found, at least {2 * dimension} expected "
                f"(twice the {dimension} coordinates)."
            )
        return self.walkers


def whole(name: str, value: object, least: int) -> None:
    """Refuse what is no whole number of at least ``least``."""
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
