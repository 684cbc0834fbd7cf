"""When a run has been long enough: one rule, judged on what has been sampled and on nothing else.

A run has converged if all of this holds in every coordinate, on the ranks of the kept steps:

1. the autocorrelation dies out within the kept steps, and those, summed over the ensembles, are at least 50
   autocorrelation times;
2. correlations at lags up to half of the kept steps do not double that time; whatever they add to it is added
   in conditions 1 and 3, so that a time known badly asks for more steps, not for a better estimate of it;
3. the effective sample size (all kept positions over the autocorrelation time) reaches what was asked for, and that
   of the 5 % and 95 % quantiles, which mix more slowly, a quarter of it: intervals are reported by these ends;
4. R-hat between ensembles, of location and of spread, is at most 1.01;
5. R-hat between single walkers is at most 1.05: walkers left half and half in two modes look like noise one by
   one, and ensembles of such walkers agree with each other;
6. every walker has moved.

Burn-in, which is discarded, is ten autocorrelation times of the second half or a fifth of the steps, whichever
is longer, but at most half; and if walkers that were left behind were taken along (see ``stuck_walkers``), all steps until then
and a fifth of those after it.

Fifty autocorrelation times are asked of the sum over ensembles, not of each, because the autocorrelation is
averaged over all walkers of all ensembles about their common mean, and is then known to 6 % from 12.5
autocorrelation times (512 walkers). That each ensemble's own stretch is not too short is seen by condition 5, which
a converged run meets from about eleven autocorrelation times on. Held against known targets (unit Gaussians in 5 and
10 dimensions from starts ten times too wide and eight too far, 50 runs): runs stop after 200 and 500 steps, the mean
square errors of mean, median and of the 5 % and 95 % quantiles are 0.7 to 1.0 times what the effective sample size
claims, and no bias shows. Asking 50 of each ensemble would take four times the steps.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import ceil

import numpy as np
from scipy.special import ndtri

from skinbayes.arrays import FloatArray
from skinbayes.sampling.convergence import autocorrelation_time, r_hat, rank_normalise, rank_r_hat
from skinbayes.sampling.options import SamplerOptions

WALKER_R_HAT = 1.05
"""Largest acceptable R-hat between single walkers."""

TAU_CHANGE = 1.0
"""Largest acceptable growth of an autocorrelation time when correlations are summed to half of the kept steps."""

JUDGED_STEPS = 256
"""Longer chains are thinned to between half of this and this many steps before tau is estimated."""

TAIL_FRACTION = 0.25
"""Fraction of the effective sample size asked for that the 5 % and 95 % quantiles have to reach."""

FEWER_STEPS = 64
"""The same for R-hat between ensembles and for the burn-in, which need no resolution in time."""

TAIL_SCORE = float(ndtri(0.05))
"""Normal score of the 5 % quantile."""

FIRST_CHECK = 200
CHECK_GROWTH = 1.3


@dataclass(frozen=True)
class StoppingReport:
    """Every number the stopping rule looks at, and its verdict.

    Arrays have one value for each coordinate.

    Attributes
    ----------
    names : coordinates
    steps, burn_in : steps of each ensemble, and how many of the first are discarded
    tau : integrated autocorrelation time of the ranks, in steps
    tau_change : relative change of tau when correlations are summed to half of the kept steps
    ess_bulk, ess_tail : effective sample size of the ranks, and the smaller one of the 5 % and 95 % quantiles
    r_hat : rank-normalised split R-hat, the chains being ensembles
    walker_r_hat : rank-normalised R-hat, the chains being walkers
    unmoved_walkers : walkers that never moved after burn-in
    missing : sentences, one for each condition that is not met
    """

    names: tuple[str, ...]
    steps: int
    burn_in: int
    tau: FloatArray
    tau_change: FloatArray
    ess_bulk: FloatArray
    ess_tail: FloatArray
    r_hat: FloatArray
    walker_r_hat: FloatArray
    unmoved_walkers: int
    missing: tuple[str, ...]

    @property
    def converged(self) -> bool:
        """Whether nothing is missing."""
        return not self.missing

    def sentence(self) -> str:
        """The verdict in words."""
        if self.converged:
            return (
                f"Converged after {self.steps} steps: effective sample size at least {self.ess_bulk.min():.0f}, "
                f"R-hat at most {self.r_hat.max():.3f}."
            )
        return f"Not converged after {self.steps} steps: " + "; ".join(self.missing) + "."


def is_check(steps: int, block_steps: int, first: int = FIRST_CHECK) -> bool:
    """Whether the rule is applied after ``steps`` steps: at 200 and then each time the run is 30 % longer.

    The sequence is rounded up to whole blocks and depends on the number of steps alone, so that an interrupted run
    stops where an uninterrupted one does.
    """
    return next_check(steps - 1, block_steps, first) == steps


def next_check(steps: int, block_steps: int, first: int = FIRST_CHECK) -> int:
    """Steps after which the rule is applied for the first time after ``steps``."""
    check = first
    while (rounded := ceil(check / block_steps) * block_steps) <= steps:
        check = ceil(check * CHECK_GROWTH)
    return rounded


def judge(
    positions: FloatArray, names: tuple[str, ...], options: SamplerOptions, discarded: int = 0
) -> StoppingReport:
    """Apply the stopping rule.

    Parameters
    ----------
    positions : all steps so far, shape ``(ensembles, steps, walkers, D)``
    names : the D coordinates
    options : what is asked for
    discarded : steps at the beginning that must not be kept, fewer than there are

    Returns
    -------
    all numbers and the verdict
    """
    steps = positions.shape[1]
    burn_in = _burn_in(positions)
    if discarded:
        burn_in = max(burn_in, discarded + ceil((steps - discarded) / 5))
    kept = positions[:, burn_in:]
    stride = max(1, ceil(kept.shape[1] / JUDGED_STEPS))
    judged = kept[:, ::-1][:, ::stride][:, ::-1]
    numbers = np.array([_numbers(judged[..., index]) for index in range(len(names))])
    tau, tau_far, tail_tau, r_hat_ensembles, r_hat_walkers = numbers.T
    draws = kept.shape[0] * kept.shape[1] * kept.shape[2]
    report = StoppingReport(
        names=names,
        steps=steps,
        burn_in=burn_in,
        tau=tau * stride,
        tau_change=np.where(np.isfinite(tau), tau_far / np.where(np.isfinite(tau), tau, 1.0) - 1.0, np.inf),
        ess_bulk=np.nan_to_num(draws / (tau * stride)),
        ess_tail=np.nan_to_num(draws / (tail_tau * stride)),
        r_hat=r_hat_ensembles,
        walker_r_hat=r_hat_walkers,
        unmoved_walkers=int(np.count_nonzero(~np.any(kept[:, 1:] != kept[:, :-1], axis=(1, 3)))),
        missing=(),
    )
    return replace(report, missing=tuple(_missing(report, kept.shape[0], options)))


def _burn_in(positions: FloatArray) -> int:
    """Steps to discard: ten autocorrelation times of the second half or a fifth, but never more than half."""
    ensembles, steps, walkers, dimension = positions.shape
    half = steps // 2
    stride = max(1, half // FEWER_STEPS)
    late = positions[:, half::stride].transpose(3, 0, 2, 1).reshape(dimension, ensembles * walkers, -1)
    tau = stride * max(autocorrelation_time(rank_normalise(series))[0] for series in late)
    return half if not 10 * tau < half else max(ceil(10 * tau), ceil(steps / 5))


def _numbers(values: FloatArray) -> tuple[float, float, float, float, float]:
    """Autocorrelation times (near, far, tails) and R-hat (ensembles, walkers) of one coordinate, shape (E, S, W)."""
    ensembles, steps, walkers = values.shape
    scores = rank_normalise(values)
    series = np.ascontiguousarray(scores.transpose(0, 2, 1)).reshape(ensembles * walkers, steps)
    tau, tau_far = autocorrelation_time(series)
    tails = [(series <= TAIL_SCORE).astype(float), (series >= -TAIL_SCORE).astype(float)]
    tail_tau = max(autocorrelation_time(tail)[0] for tail in tails)
    fewer = values[:, :: max(1, steps // FEWER_STEPS)].reshape(ensembles, -1)
    return tau, tau_far, tail_tau, rank_r_hat(fewer), r_hat(series)


def _missing(report: StoppingReport, ensembles: int, options: SamplerOptions) -> Iterator[str]:
    """One sentence for each condition that is not met; comparisons are such that nan does not meet them."""
    kept = report.steps - report.burn_in
    growth = 1.0 + np.maximum(report.tau_change, 0.0)
    name, tau = _largest(report, report.tau * growth)
    if not tau < np.inf:
        yield (
            f"the autocorrelation of {name} has not died out within the {kept} kept steps, "
            "so its autocorrelation time is unknown"
        )
    else:
        if not kept * ensembles >= options.steps_over_tau * tau:
            yield (
                f"the {kept} kept steps of {ensembles} ensembles are {kept * ensembles / tau:.0f} autocorrelation "
                f"times of {name} ({tau:.1f} steps), {options.steps_over_tau:g} are asked for"
            )
        name, change = _largest(report, report.tau_change)
        if not change <= TAU_CHANGE:
            yield f"the autocorrelation time of {name} is not stable: {change:+.0%} when longer lags are included"
    name, size = _largest(report, -report.ess_bulk / growth)
    if not -size >= options.ess:
        found = f"{-size:.0f}" if size < 0 else "unknown, because its autocorrelation has not died out yet"
        yield f"the effective sample size of {name} is {found}, {options.ess:.0f} is asked for"
    name, size = _largest(report, -report.ess_tail)
    if not -size >= TAIL_FRACTION * options.ess:
        found = f"{-size:.0f}" if size < 0 else "unknown, because their autocorrelation has not died out yet"
        yield (
            f"the effective sample size of the 5 and 95 % quantiles of {name} is {found}, "
            f"{TAIL_FRACTION * options.ess:.0f} is asked for"
        )
    name, value = _largest(report, report.r_hat)
    if not value <= options.r_hat:
        yield f"the ensembles disagree about {name}: R-hat {value:.3f}, at most {options.r_hat:g} is accepted"
    name, value = _largest(report, report.walker_r_hat)
    if not value <= WALKER_R_HAT:
        yield f"single walkers disagree about {name}: R-hat {value:.3f}, at most {WALKER_R_HAT:g} is accepted"
    if report.unmoved_walkers:
        yield f"{report.unmoved_walkers} of all walkers never moved"


def _largest(report: StoppingReport, values: FloatArray) -> tuple[str, float]:
    """Name and value of the coordinate with the largest value; nan counts as largest."""
    worst = int(np.argmax(np.nan_to_num(values, nan=np.inf)))
    return report.names[worst], float(values[worst])
