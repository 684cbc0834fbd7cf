"""How far a run is: facts by name, and one sentence that says what is missing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, isfinite
from typing import Literal, Protocol

import numpy as np

from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.stopping import WALKER_R_HAT, StoppingReport, next_check

Phase = Literal["starting", "settling", "collecting", "done"]

_BURN_IN_FRACTION, _BURN_IN_TIMES = 0.2, 10.0  # of the stopping rule


class RunProgress(Protocol):
    """How far a run of any engine is."""

    @property
    def steps(self) -> int:
        """Steps made so far, of whatever kind the engine makes."""

    def sentence(self, width: int | None = None) -> str:
        """What is missing, in words; in fewer words where ``width`` characters are too few."""


@dataclass(frozen=True)
class PlainProgress:
    """Progress of an engine that says one thing only."""

    steps: int
    words: str

    def sentence(self, width: int | None = None) -> str:
        """The words."""
        return self.words


@dataclass(frozen=True)
class EnsembleProgress:
    """How far a run of ensembles is, told when it begins (or is taken up) and after every block.

    Attributes
    ----------
    steps : steps of each ensemble so far
    max_steps : where the run ends at the latest
    report : the latest verdict of the stopping rule, None before the first
    options : what is asked for
    walkers : walkers of all ensembles together
    far_walkers : how many of them stand far below the log-density of their ensemble
    seconds_per_step : wall time of a step of all ensembles in this process, None before the first
    """

    steps: int
    max_steps: int
    report: StoppingReport | None
    options: SamplerOptions
    walkers: int
    far_walkers: int
    seconds_per_step: float | None

    @property
    def phase(self) -> Phase:
        """``starting`` before the first verdict, ``settling`` until ensembles agree and autocorrelation is known, then
        ``collecting`` draws, and ``done``."""
        report = self.report
        if report is None:
            return "starting"
        if report.converged:
            return "done"
        agree = bool(np.all(report.r_hat <= self.options.r_hat))
        return "collecting" if agree and np.isfinite(report.tau).all() else "settling"

    @property
    def next_check(self) -> int:
        """Steps after which the stopping rule is applied next."""
        return min(next_check(self.steps, self.options.block_steps), self.max_steps)

    @property
    def slowest(self) -> str | None:
        """The coordinate that the run waits for: the one the ensembles disagree most about, or the longest correlated."""
        report = self.report
        if report is None:
            return None
        disagree = np.nan_to_num(report.r_hat, nan=inf)
        if disagree.max() > self.options.r_hat:
            return report.names[int(np.argmax(disagree))]
        times = np.nan_to_num(report.tau, nan=inf, posinf=inf)
        # several unknown times: the one whose walkers differ most
        order = np.lexsort((np.nan_to_num(report.walker_r_hat), times))
        return report.names[int(order[-1])]

    @property
    def steps_needed(self) -> int | None:
        """Steps in all that the run is likely to need; None while it is unknown."""
        return None if self.report is None else steps_needed(self.report, self.options)

    @property
    def seconds_to_go(self) -> float | None:
        """Time that the rest is likely to take; None while it is unknown."""
        needed = self.steps_needed
        if needed is None or self.seconds_per_step is None:
            return None
        return max(min(needed, self.max_steps) - self.steps, 0) * self.seconds_per_step

    def sentence(self, width: int | None = None) -> str:
        """What is missing, in words; in fewer words where ``width`` characters are too few."""
        said = self._sentences()
        return next((text for text in said if width is None or len(text) <= width), said[-1])

    def _sentences(self) -> list[str]:
        """The same said ever shorter."""
        report, phase = self.report, self.phase
        far = (
            f"{self.far_walkers} of {self.walkers} walkers still far from the others"
            if self.far_walkers
            else ""
        )
        again = f"judged again at {self.next_check} steps"
        if report is None:
            return [far] if far else [f"starting, first judged after {self.next_check} steps", "starting"]
        if phase == "done":
            size = f"effective sample size {report.ess_bulk.min():.0f}"
            return [f"converged: {size}, R-hat at most {report.r_hat.max():.3f}", "converged"]
        if phase == "settling":
            name = str(self.slowest)
            index = report.names.index(name)
            if report.r_hat[index] <= self.options.r_hat:
                apart = _r_hat(report.walker_r_hat[index])
                whole = f"walkers have not yet been everywhere in {name} (R-hat between them {apart})"
                brief = f"walkers differ in {name} (R-hat {apart})"
            else:
                apart = _r_hat(report.r_hat[index])
                whole = f"the ensembles do not agree yet about {name} (R-hat {apart})"
                brief = f"ensembles differ in {name} (R-hat {apart})"
            if far:
                return [f"settling: {far}; {whole}", f"settling: {far}", far]
            return [
                f"settling: {whole}; {again}",
                f"settling: {whole}",
                f"settling: {brief}",
                f"R-hat {apart}: {name}",
            ]
        collected = far or max(_shortfalls(report, self.options))[1]
        return [f"found; {collected}{self._to_go()}", f"found; {collected}", collected]

    def _to_go(self) -> str:
        needed, seconds = self.steps_needed, self.seconds_to_go
        if needed is not None and needed > self.max_steps:
            return f", about {needed} steps needed of {self.max_steps} allowed"
        return "" if seconds is None or seconds < 1.0 else f", about {duration(seconds)} to go"


def duration(seconds: float) -> str:
    """A time for people.

    Examples
    --------
    >>> duration(38.2), duration(130.0), duration(9000.0)
    ('38 s', '2 min', '2.5 h')
    """
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def _r_hat(value: float) -> str:
    return f"{value:.1f}" if value >= 1.2 else f"{value:.2f}" if value >= 1.1 else f"{value:.3f}"


def steps_needed(report: StoppingReport, options: SamplerOptions) -> int | None:
    """Steps in all that a run is likely to need, from what a verdict lacks; None while autocorrelation times are unknown."""
    if not np.isfinite(report.tau).all():
        return None
    kept = (report.steps - report.burn_in) * max(
        1.0, *(fraction for fraction, _ in _shortfalls(report, options))
    )
    burn_in = max(
        _BURN_IN_TIMES * float(report.tau.max()), kept * _BURN_IN_FRACTION / (1.0 - _BURN_IN_FRACTION)
    )
    return next_check(max(int(kept + burn_in), report.steps) - 1, options.block_steps)


def _shortfalls(report: StoppingReport, options: SamplerOptions) -> Iterator[tuple[float, str]]:
    """By how much the kept steps are too few for each condition, and how far it is met."""
    kept = (report.steps - report.burn_in) * options.ensembles
    growth = 1.0 + np.maximum(report.tau_change, 0.0)
    smallest = float(np.min(report.ess_bulk / growth))
    yield options.ess / smallest, f"effective sample size {smallest:.0f} of {options.ess:.0f}"
    longest = int(np.argmax(report.tau * growth))
    times = kept / float((report.tau * growth)[longest])
    wanted = options.steps_over_tau
    yield wanted / times, f"{times:.0f} of {wanted:.0f} autocorrelation times of {report.names[longest]}"
    walker = int(np.argmax(np.nan_to_num(report.walker_r_hat, nan=inf)))
    value = float(report.walker_r_hat[walker])
    if isfinite(value):
        # what single walkers differ by falls as one over their length
        fraction = (value**2 - 1.0) / (WALKER_R_HAT**2 - 1.0)
        yield (
            fraction,
            f"walkers still differ in {report.names[walker]} (R-hat {_r_hat(value)} of {WALKER_R_HAT})",
        )
