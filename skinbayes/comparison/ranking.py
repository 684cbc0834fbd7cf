"""How a fit stands against baseline models: whether it beats, equals or loses to them, and what each leaves unexplained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.comparison.models import Comparison, compare_scores, grouped_by, on_sampling
from skinbayes.comparison.noise_floor import NoiseFloor, noise_floor
from skinbayes.comparison.parts import SINGLE
from skinbayes.comparison.scores import Scores, difference
from skinbayes.comparison.verdicts import (
    AHEAD,
    LOSES,
    Statement,
    few_levels,
    level_question,
    plus_minus,
    pointwise_question,
)
from skinbayes.phrases import singular

if TYPE_CHECKING:
    from skinbayes.fit import Fit

VERDICTS = {1: "beats", 0: "equals", -1: "loses to"}

SCATTER_DRAWS = 200
"""Posterior draws whose width of the noise is averaged."""


@dataclass(frozen=True)
class RankedAgainst:
    """How a fit stands against one baseline model in one question.

    Attributes
    ----------
    baseline_model : name of the baseline model
    question : ``"datum"``, or the grouping column whose levels are left out
    difference, difference_se : predictive density of the fit less that of the baseline model, and its standard error, None with
        few data or levels
    verdict : ``"beats"``, ``"equals"`` or ``"loses to"``
    """

    baseline_model: str
    question: str
    difference: float
    difference_se: float | None
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
class AgainstBaselines:
    """A fit beside its baseline models.

    Attributes
    ----------
    name : the fit
    comparison : the fit and its baseline models, best first
    ranking : the fit against each baseline model in each question
    scatter : what each model leaves unexplained, by name
    floor : the noise floor of the data, or None
    """

    name: str
    comparison: Comparison
    ranking: tuple[RankedAgainst, ...]
    scatter: dict[str, Scatter]
    floor: NoiseFloor | None

    @property
    def loses(self) -> bool:
        """Whether the fit loses to a baseline model in any question."""
        return any(ranked.verdict == VERDICTS[-1] for ranked in self.ranking)

    def sentences(self) -> list[str]:
        """Whether the fit beats, equals or loses to each baseline model in each question, in words."""
        return [statement.text for statement in self.statements()]

    def statements(self) -> list[Statement]:
        """The sentences, each with what it does."""
        said: list[Statement] = []
        for question in dict.fromkeys(ranked.question for ranked in self.ranking):
            said += self._question(question)
            said += [self._words(ranked) for ranked in self.ranking if ranked.question == question]
            if question != SINGLE:
                said += few_levels(self.comparison.models[0].left_out[question])
        said += on_sampling(self.comparison.models, self.comparison.rows)
        if self.floor is not None:
            said.append(Statement(self.floor.sentence()))
            noise = self.scatter[self.name].noise
            if noise is not None:
                said.append(Statement(self.floor.against(noise)))
        return said

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
                    plus_minus(model.elpd_loo, model.elpd_loo_se, 1),
                    *(plus_minus(entry.elpd, entry.elpd_se, 1) for entry in model.left_out.values()),
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
            "ranking": [vars(ranked) for ranked in self.ranking],
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

    def _question(self, question: str) -> list[Statement]:
        grouped = self.comparison.grouped_by
        if question == SINGLE:
            return [Statement(pointwise_question(grouped))] if grouped else []
        return [Statement(level_question(question, grouped))]

    def _words(self, ranked: RankedAgainst) -> Statement:
        what = "a left-out datum" if ranked.question == SINGLE else f"a left-out {singular(ranked.question)}"
        gap = plus_minus(abs(ranked.difference), ranked.difference_se, 1)
        if ranked.verdict == VERDICTS[0]:
            return Statement(
                f"'{self.name}' equals '{ranked.baseline_model}' in predicting {what}: they differ by {gap}, "
                "which is no difference."
            )
        if ranked.verdict == VERDICTS[1]:
            return Statement(
                f"'{self.name}' beats '{ranked.baseline_model}' in predicting {what}, by {gap}.", AHEAD
            )
        return Statement(
            f"'{self.name}' LOSES to '{ranked.baseline_model}' in predicting {what}, by {gap}: "
            "its physics makes this prediction worse.",
            LOSES,
        )


def beside(fit: Fit, scores: Sequence[Scores], fits: Sequence[Fit]) -> AgainstBaselines:
    """Put a fit beside other fits of the same data.

    Parameters
    ----------
    fit : the fit
    scores : of the fits
    fits : the fit itself and the baseline models
    """
    own = scores[0]
    comparison = compare_scores(scores, grouped_by(fits))
    ranking = []
    for question in (SINGLE, *comparison.columns):
        for other in scores[1:]:
            gap = difference(_scores_of(own, question), _scores_of(other, question))
            ranking.append(RankedAgainst(other.name, question, gap.value, gap.error, VERDICTS[gap.sign]))
    floor = None if fit.problem is None else noise_floor(fit.problem)
    scatter = {entry.name: _scatter(entry) for entry in fits}
    return AgainstBaselines(fit.name, comparison, tuple(ranking), scatter, floor)


def _scores_of(scores: Scores, question: str) -> Any:
    return scores.single.pointwise if question == SINGLE else scores.left_out[question].pointwise


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
