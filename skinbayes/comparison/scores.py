"""How well a fit predicts data that are left out: single data, all data of a level of a column, or a block of rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.special import logsumexp, stdtrit

from skinbayes.arrays import FloatArray
from skinbayes.comparison.parts import Parts, blocks, levels, single_data
from skinbayes.statistics.pareto import FINITE_VARIANCE, largest_shape, left_out_density

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit

FEW_ROWS = 10
"""With fewer data, or levels, than this a standard error of a sum over them means little."""

EXACT_ROWS = 20
"""So few data are each left out by a refit, whatever the weights say.

Sums of terms that all counted as reliable were off by 0.2 to 0.35 with 2 to 4 data, 0.06 to 0.14 with 8 to 15, 0.07 and less
from 20 on (root mean square; 60 normal samples each, mean and scatter unknown, an outlier in every third; 4000 draws).
"""

MOST_REFITTED_DATA = 8_000
"""Refits times the data of each that are made unasked: 48 of 165 data, 8 of 1,000, none of 10,000, where each takes minutes."""

LARGEST_REFIT_ERROR = 0.2
"""A refit whose ln density is uncertain by more than this is not reliable either."""

SMALL = 4.0
"""A smaller difference of predictive densities says nothing, whatever its standard error."""

RefitProgress = Callable[[int, int], None]
"""Called with the number of refits done and their total."""


@dataclass(frozen=True)
class LeftOutLevel:
    """Prediction of data that are left out together: of a level of a column, a block of rows, or a single datum.

    Attributes
    ----------
    level : what is left out
    rows : number of its data
    elpd : ln p(its data | all other data)
    error : its standard error, of Monte Carlo
    pareto_k : of the importance sampling
    refitted : True if the model was sampled anew without it, and ``elpd`` comes from that
    reliable : whether ``elpd`` can be trusted
    """

    level: str
    rows: int
    elpd: float
    error: float
    pareto_k: float
    refitted: bool
    reliable: bool


@dataclass(frozen=True)
class LeftOut:
    """Prediction of each part of the data from the others.

    Attributes
    ----------
    column : the grouping column, or the blocks, ``"normal_force in 3"``
    levels : one entry for each level, in the order of the data
    elpd, elpd_se : sum over levels and its standard error, None with fewer than `FEW_ROWS` levels
    difference, difference_se : to the best model in this column, and its standard error
    """

    column: str
    levels: tuple[LeftOutLevel, ...]
    elpd: float
    elpd_se: float | None
    difference: float = 0.0
    difference_se: float | None = 0.0

    @property
    def pointwise(self) -> FloatArray:
        """``elpd`` of each level, shape ``(levels,)``."""
        return np.array([level.elpd for level in self.levels])

    @property
    def monte_carlo_error(self) -> float:
        """Standard error of ``elpd``, of Monte Carlo alone."""
        # refits share what is known of all data, so their errors may add up
        shared = sum(level.error for level in self.levels if level.refitted)
        return float(np.sqrt(shared**2 + sum(level.error**2 for level in self.levels if not level.refitted)))

    @property
    def unreliable(self) -> list[str]:
        """Levels whose number cannot be trusted."""
        return [level.level for level in self.levels if not level.reliable]

    @property
    def refitted(self) -> list[str]:
        """Levels without which the model was sampled anew."""
        return [level.level for level in self.levels if level.refitted]

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        counts = {"unreliable_levels": len(self.unreliable), "refitted_levels": len(self.refitted)}
        return vars(self) | counts | {"levels": {entry.level: vars(entry) for entry in self.levels}}


@dataclass(frozen=True)
class Scores:
    """All scores of one fit.

    Attributes
    ----------
    name : the model
    converged : whether the fit met its stopping rule
    single : of single data
    effective_parameters : by how much ln p of the single data is less when they are left out
    left_out : of levels and blocks, by column
    log_evidence : ln Z and its standard error, None if the engine did not give it
    refits_not_made : refits that would be needed and were not asked for, being more than `MOST_REFITTED_DATA` allows
    """

    name: str
    converged: bool
    single: LeftOut
    effective_parameters: float
    left_out: dict[str, LeftOut]
    log_evidence: tuple[float, float] | None = None
    refits_not_made: int = 0


class Difference(NamedTuple):
    """Difference of two sets of scores of the same parts.

    Attributes
    ----------
    value : sum of the differences
    error : its standard error; None with fewer than `FEW_ROWS` parts, with which it would mean nothing
    sign : 1 if the first is clearly better, −1 if clearly worse, else 0
    """

    value: float
    error: float | None
    sign: int


def score(
    fit: Fit | JointFit,
    refit: bool | None = False,
    leave_out: Sequence[str] = (),
    progress: RefitProgress | None = None,
) -> Scores:
    """Score a fit by Pareto-smoothed importance sampling, and by refits where that fails if asked to.

    Parameters
    ----------
    fit : the fit
    refit : sample anew without each datum if there are few, and wherever importance sampling cannot leave something out, if the
        model and its data are at hand; None does so unless the refits times their data are more than `MOST_REFITTED_DATA`
    leave_out : blocks of rows, see :func:`skinbayes.comparison.parts.blocks`
    progress : called before the first refit and after each

    Raises
    ------
    InputError
        Blocks that cannot be made.
    """
    single = single_data(fit)
    everything = [single, *levels(fit)]
    known = {parts.name for parts in everything}
    everything += [blocks(fit, wanted) for wanted in dict.fromkeys(leave_out) if wanted not in known]
    effective = _effective(fit)
    found = [_by_weights(parts, effective) for parts in everything]
    not_made = 0
    if refit is not False and fit.problem is not None:
        few = single.member.size <= EXACT_ROWS
        wanted = []
        for place, parts in enumerate(everything):
            exact = few and parts is single
            # terms of single data are many, and small beside the error of their sum
            doubts = [not (entry.reliable if parts is single else _sure(entry)) for entry in found[place]]
            if not exact and any(doubts):
                found[place] = _by_own_weights(fit, parts, effective, found[place])
            wanted += [(place, i) for i, entry in enumerate(found[place]) if exact or not entry.reliable]
        if refit is None and len(wanted) * single.member.size > MOST_REFITTED_DATA:
            wanted, not_made = [], len(wanted)
        for done, (place, i) in enumerate(wanted):
            if progress is not None:
                progress(done, len(wanted))
            found[place][i] = _refitted(fit, everything[place], i, effective, found[place][i])
        if progress is not None and wanted:
            progress(len(wanted), len(wanted))
    scores = [_summed(parts.name, entries) for parts, entries in zip(everything, found, strict=True)]
    within = logsumexp(single.densities, axis=0) - np.log(len(single.densities))
    evidence = fit.provenance["sampling"].get("log_evidence")
    return Scores(
        fit.name,
        fit.converged,
        scores[0],
        float(within.sum()) - scores[0].elpd,
        {entry.column: entry for entry in scores[1:]},
        tuple(evidence) if evidence else None,
        not_made,
    )


def difference(first: FloatArray, second: FloatArray) -> Difference:
    """Sum of the differences of two sets of scores, its standard error, and whether it is clear."""
    gaps = first - second
    value, error = float(gaps.sum()), _standard_error(gaps)
    # with few parts the error itself is known badly
    often = float(stdtrit(len(gaps) - 1, 0.975)) if len(gaps) > 1 else float("inf")
    clear = abs(value) >= SMALL and abs(value) >= often * error
    return Difference(value, _unless_few(error, len(gaps)), (1 if value > 0 else -1) if clear else 0)


def _standard_error(values: FloatArray) -> float:
    """Standard error of a sum over N data: √(N · variance); NaN for a single datum."""
    return float(np.sqrt(len(values) * values.var(ddof=1))) if len(values) > 1 else float("nan")


def _unless_few(error: float, count: int) -> float | None:
    return error if count >= FEW_ROWS else None


def _effective(fit: Fit | JointFit) -> float:
    """Number of independent draws that those of a fit are worth."""
    sizes = fit.groups["posterior"].sizes
    kept = float(sizes["chain"] * sizes["draw"])
    known = [size for size in fit.provenance["sampling"].get("ess_bulk", []) if size and size > 0]
    return min([kept, *known])


def _by_weights(parts: Parts, effective: float, log_weights: FloatArray | None = None) -> list[LeftOutLevel]:
    """Each part by importance sampling."""
    effective = min(effective, float(len(parts.densities)))
    limit, counts = largest_shape(effective), parts.counts()
    found = []
    for level, count, column in zip(parts.labels, counts, parts.densities.T, strict=True):
        value, error, shape = left_out_density(column, effective, log_weights)
        found.append(LeftOutLevel(level, count, value, error, shape, False, shape <= limit))
    return found


def _by_own_weights(
    fit: Fit | JointFit, parts: Parts, effective: float, before: list[LeftOutLevel]
) -> list[LeftOutLevel]:
    """The same from the engine's own draws, if they have weights, where that is better: they reach further out."""
    if "weighted_posterior" not in fit.groups:
        return before
    group = fit.groups["weighted_posterior"]
    theta = group["theta"].values.reshape(-1, len(fit.names))
    log_weights = group["log_weight"].values.ravel()
    after = _by_weights(
        parts.at(fit, theta[np.isfinite(log_weights)]), effective, log_weights[np.isfinite(log_weights)]
    )
    return [
        old if _sure(old) else min(old, new, key=lambda entry: (not entry.reliable, entry.error))
        for old, new in zip(before, after, strict=True)
    ]


def _sure(entry: LeftOutLevel) -> bool:
    return entry.reliable and entry.pareto_k <= FINITE_VARIANCE


def _refitted(
    fit: Fit | JointFit, parts: Parts, place: int, effective: float, before: LeftOutLevel
) -> LeftOutLevel:
    """A part by a refit; by weights as before if they are reliable and the refit is not."""
    from skinbayes.fit.refit import predict_left_out

    assert fit.problem is not None
    run = fit.provenance["sampling"]
    evidence = tuple(run["log_evidence"]) if run.get("log_evidence") else None
    whole = parts.densities[:, place]
    found = predict_left_out(
        fit.problem,
        parts.member != place,
        whole,
        min(effective, float(len(whole))),
        evidence,
        int(run["seed"]),
    )
    reliable = found.reliable and found.error <= LARGEST_REFIT_ERROR
    if before.reliable and not reliable:
        return before
    return LeftOutLevel(
        before.level, before.rows, found.log_density, found.error, before.pareto_k, True, reliable
    )


def _summed(column: str, entries: list[LeftOutLevel]) -> LeftOut:
    values = np.array([entry.elpd for entry in entries])
    error = _unless_few(_standard_error(values), len(values))
    return LeftOut(column, tuple(entries), float(values.sum()), error)
