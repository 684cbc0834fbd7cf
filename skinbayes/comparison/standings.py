"""How a fit stands against yardsticks: whether it beats, equals or loses to them, and what each leaves unexplained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.comparison.models import Comparison, compare_scores, grouped_by
from skinbayes.comparison.noise_floor import NoiseFloor, noise_floor
from skinbayes.comparison.scores import Scores, difference
from skinbayes.comparison.words import (
    few_levels,
    level_question,
    pointwise_question,
    sign_of,
    singular,
    unreliable_levels,
)

if TYPE_CHECKING:
    from skinbayes.fit import Fit

SINGLE = "datum"
"""Question of leaving out single data; the other questions are grouping columns."""

VERDICTS = {1: "beats", 0: "equals", -1: "loses to"}

SCATTER_DRAWS = 200
"""Posterior draws whose width of the noise is averaged."""


@dataclass(frozen=True)
class Standing:
    """How a fit stands against one yardstick in one question.

    Attributes
    ----------
    yardstick : name of the yardstick
    question : ``"datum"``, or the grouping column whose levels are left out
    difference, difference_se : predictive density of the fit less that of the yardstick, and its standard error
    verdict : ``"beats"``, ``"equals"`` or ``"loses to"``
    """

    yardstick: str
    question: str
    difference: float
    difference_se: float
    verdict: str


@dataclass(frozen=True)
class Scatter:
    """What a model leaves unexplained: posterior medians.

    Attributes
    ----------
    noise : root mean square width of the noise over the data; of ln if the noise is logarithmic. None if not at hand
    group_scales : scale of the effects, by grouping column
    """

    noise: float | None
    group_scales: dict[str, float]


@dataclass(frozen=True)
class Yardsticks:
    """A fit beside its yardsticks.

    Attributes
    ----------
    name : the fit
    comparison : the fit and its yardsticks, best first
    standings : the fit against each yardstick in each question
    scatter : what each model leaves unexplained, by name
    floor : the noise floor of the data, or None
    missing : sentences on yardsticks that could not be had
    """

    name: str
    comparison: Comparison
    standings: tuple[Standing, ...]
    scatter: dict[str, Scatter]
    floor: NoiseFloor | None
    missing: tuple[str, ...] = ()

    @property
    def loses(self) -> bool:
        """Whether the fit loses to a yardstick in any question."""
        return any(standing.verdict == VERDICTS[-1] for standing in self.standings)

    def sentences(self) -> list[str]:
        """Whether the fit beats, equals or loses to each yardstick in each question, in words."""
        said: list[str] = []
        for question in dict.fromkeys(standing.question for standing in self.standings):
            said += self._question(question)
            said += [self._words(standing) for standing in self.standings if standing.question == question]
            if question != SINGLE:
                said += few_levels(self.comparison.models[0].left_out[question])
        for model in self.comparison.models:
            for left_out in model.left_out.values():
                said += unreliable_levels(model.name, left_out)
            if not model.converged:
                said.append(f"'{model.name}' has NOT CONVERGED; its numbers are provisional.")
        if self.floor is not None:
            said.append(self.floor.sentence())
            noise = self.scatter[self.name].noise
            if noise is not None:
                said.append(self.floor.against(noise))
        return said + list(self.missing)

    def headers(self) -> list[str]:
        """Headers of :meth:`rows`."""
        columns = self.comparison.columns
        scales = dict.fromkeys(column for entry in self.scatter.values() for column in entry.group_scales)
        return [
            "model",
            "one datum left out",
            *(f"one {singular(column)} left out" for column in columns),
            "scatter",
            *(f"effect of {singular(column)}" for column in scales),
        ]

    def rows(self) -> list[list[str]]:
        """A table: predictive densities with standard errors, and what is left unexplained; the fit first."""
        scales = dict.fromkeys(column for entry in self.scatter.values() for column in entry.group_scales)
        rows = []
        for model in sorted(self.comparison.models, key=lambda model: model.name != self.name):
            left = self.scatter[model.name]
            rows.append(
                [
                    model.name,
                    f"{model.elpd_loo:.1f} ± {model.elpd_loo_se:.1f}",
                    *(f"{entry.elpd:.1f} ± {entry.elpd_se:.1f}" for entry in model.left_out.values()),
                    "" if left.noise is None else f"{left.noise:.3g}",
                    *(
                        f"{left.group_scales[column]:.3g}" if column in left.group_scales else ""
                        for column in scales
                    ),
                ]
            )
        if self.floor is not None:
            blank = [""] * (1 + len(self.comparison.columns))
            rows.append(
                ["noise floor", *blank, f"{self.floor.standard_deviation:.3g}", *([""] * len(scales))]
            )
        return rows

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        return {
            "model": self.name,
            "standings": [vars(standing) for standing in self.standings],
            "loses": self.loses,
            "models": [
                model.to_dict()
                | {
                    "noise": self.scatter[model.name].noise,
                    "group_scales": self.scatter[model.name].group_scales,
                }
                for model in self.comparison.models
            ],
            "noise_floor": None if self.floor is None else self.floor.to_dict(),
            "sentences": self.sentences(),
        }

    def _question(self, question: str) -> list[str]:
        grouped = self.comparison.grouped_by
        if question == SINGLE:
            return [pointwise_question(grouped)] if grouped else []
        return [level_question(question, grouped)]

    def _words(self, standing: Standing) -> str:
        what = (
            "a left-out datum" if standing.question == SINGLE else f"a left-out {singular(standing.question)}"
        )
        gap, error = standing.difference, standing.difference_se
        if standing.verdict == VERDICTS[0]:
            return (
                f"'{self.name}' equals '{standing.yardstick}' in predicting {what}: they differ by {gap:.1f} ± {error:.1f}, "
                "which is no difference."
            )
        if standing.verdict == VERDICTS[1]:
            return f"'{self.name}' beats '{standing.yardstick}' in predicting {what}, by {gap:.1f} ± {error:.1f}."
        return (
            f"'{self.name}' LOSES to '{standing.yardstick}' in predicting {what}, by {-gap:.1f} ± {error:.1f}: "
            "its physics makes this prediction worse."
        )


def beside(fit: Fit, scores: Sequence[Scores], fits: Sequence[Fit]) -> Yardsticks:
    """Put a fit beside other fits of the same data.

    Parameters
    ----------
    fit : the fit
    scores : of the fits
    fits : the fit itself and the yardsticks
    """
    own = scores[0]
    comparison = compare_scores(scores, grouped_by(fits))
    standings = []
    for question in (SINGLE, *comparison.columns):
        for other in scores[1:]:
            gap, error = difference(_scores_of(own, question), _scores_of(other, question))
            verdict = VERDICTS[sign_of(gap, error)]
            standings.append(Standing(other.name, question, gap, error, verdict))
    floor = None if fit.problem is None else noise_floor(fit.problem)
    scatter = {entry.name: _scatter(entry) for entry in fits}
    return Yardsticks(fit.name, comparison, tuple(standings), scatter, floor)


def _scores_of(scores: Scores, question: str) -> Any:
    return scores.loo["pointwise"] if question == SINGLE else scores.left_out[question].pointwise


def _scatter(fit: Fit) -> Scatter:
    scales = {
        label.partition("[")[2].removesuffix("]"): float(np.median(fit.draws(label)))
        for label in fit.names
        if label.startswith("group_scale[")
    }
    if fit.problem is None or len(fit.problem.observations) != 1:
        return Scatter(None, scales)
    theta = fit.theta()
    chosen = theta[:: max(1, len(theta) // SCATTER_DRAWS)]
    widths = [float(np.sqrt(np.mean(fit.problem.noise_width(vector) ** 2))) for vector in chosen]
    return Scatter(float(np.median(widths)), scales)
