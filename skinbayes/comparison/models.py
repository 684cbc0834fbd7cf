"""Comparing models on the same data."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import softmax

from skinbayes.comparison.cross_check import CrossCheck, cross_check
from skinbayes.comparison.prior_widths import PriorWidths, prior_widths
from skinbayes.comparison.scores import FEW_ROWS, LeftOut, RefitProgress, Scores, difference, score
from skinbayes.comparison.verdicts import (
    AHEAD,
    Statement,
    few_levels,
    level_question,
    not_refitted,
    plus_minus,
    pointwise_question,
    unreliable_data,
    unreliable_levels,
)
from skinbayes.comparison.weights import stacking_weights
from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit


@dataclass(frozen=True)
class ComparedModel:
    """One model of a comparison.

    Attributes
    ----------
    name : the model
    elpd_loo, elpd_loo_se : expected log predictive density of left-out data and its standard error, None with fewer than
        `FEW_ROWS` data
    p_loo : effective number of parameters
    elpd_difference, elpd_difference_se : difference to the best model and its standard error
    weight : stacking weight; None where a term of any model is unreliable
    unreliable_rows : data of which it is not known how well they are predicted when they are left out
    converged : whether the fit met its stopping rule
    left_out : the same for all data of one level of a grouping column, or of a block of rows, at a time, by column
    log_evidence, log_evidence_se : ln Z and its standard error; None if not known of all models
    probability : of the model given the data, if all models were equally probable before; None without evidence
    refitted_rows : data that were left out by sampling anew
    monte_carlo_error : standard error of ``elpd_loo`` as a number that was computed from draws
    told_apart : whether it is clearly worse than the best model
    refits_not_made : refits that would be needed and were not asked for
    """

    name: str
    elpd_loo: float
    elpd_loo_se: float | None
    p_loo: float
    elpd_difference: float
    elpd_difference_se: float | None
    weight: float | None
    unreliable_rows: int
    converged: bool
    left_out: Mapping[str, LeftOut] = field(default_factory=dict)
    log_evidence: float | None = None
    log_evidence_se: float | None = None
    probability: float | None = None
    refitted_rows: int = 0
    monte_carlo_error: float = 0.0
    told_apart: bool = False
    refits_not_made: int = 0

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        return vars(self) | {"left_out": {column: entry.to_dict() for column, entry in self.left_out.items()}}


@dataclass(frozen=True)
class Comparison:
    """Models ordered from best to worst by their predictive density of single data.

    Attributes
    ----------
    models : best first
    rows : number of data
    grouped_by : grouping columns that have effects in one of the models
    prior_widths : what the evidence owes to the width of priors
    cross_checks : ln Z by nested sampling beside that of the fits, if it was asked for
    """

    models: tuple[ComparedModel, ...]
    rows: int
    grouped_by: tuple[str, ...] = ()
    prior_widths: PriorWidths = field(default_factory=PriorWidths)
    cross_checks: tuple[CrossCheck, ...] = ()

    @property
    def columns(self) -> tuple[str, ...]:
        """Grouping columns whose levels were left out, and blocks of rows."""
        return tuple(self.models[0].left_out)

    def sentences(self) -> list[str]:
        """What the comparison says, in words."""
        return [statement.text for statement in self.statements()]

    def statements(self) -> list[Statement]:
        """The sentences, each with what it does."""
        best, said = self.models[0], []
        for other in self.models[1:]:
            gap = plus_minus(-other.elpd_difference, other.elpd_difference_se)
            computed = np.hypot(best.monte_carlo_error, other.monte_carlo_error)
            if other.elpd_difference_se is None and other.weight is not None and computed > 0:
                gap += f" (computed to ± {computed:.2f})"
            text = (
                f"'{best.name}' predicts left-out data better than '{other.name}', by {gap}."
                if other.told_apart
                else f"These data do not tell '{best.name}' and '{other.name}' apart: their predictive densities differ by {gap}."
            )
            said.append(Statement(text, AHEAD))
        said += [*self._on_evidence(), *self.prior_widths.statements()]
        said += [Statement(check.sentence()) for check in self.cross_checks]
        if self.grouped_by:
            said.append(Statement(pointwise_question(self.grouped_by)))
        if self.rows < FEW_ROWS:
            said.append(
                Statement(
                    f"With {self.rows} data leave-one-out can hardly decide anything; a standard error over them would mean "
                    "nothing and is not given."
                )
            )
        for column in self.columns:
            said += self._on_levels(column)
        said += on_sampling(self.models, self.rows)
        if any(model.weight is None for model in self.models):
            said.append(
                Statement(
                    "There are no stacking weights: they hang on every single datum, and some of these numbers are unreliable."
                )
            )
        return said

    def _on_evidence(self) -> list[Statement]:
        """What the evidence says, and whether it agrees with the predictive densities."""
        if not self.has_evidence:
            return []
        first, second = self.by_evidence[:2]
        gap = (first.log_evidence or 0.0) - (second.log_evidence or 0.0)
        error = np.hypot(first.log_evidence_se or 0.0, second.log_evidence_se or 0.0)
        said = (
            f"Evidence: '{first.name}' made the data exp({gap:.2f} ± {error:.2f}) times as probable, before they were seen, as "
            f"'{second.name}'. This hangs on the priors: a parameter that the data leave alone costs nothing, a needlessly wide "
            "prior of one that they determine costs evidence."
        )
        if first.name == self.models[0].name or first.weight is None:
            return [Statement(said, AHEAD)]
        instead = (
            f"Left-out data are predicted best by '{self.models[0].name}' instead: predictive densities ask how well a fitted "
            "model predicts one more datum, the evidence how well the priors predicted all of them."
        )
        return [Statement(said, AHEAD), Statement(instead, AHEAD)]

    @property
    def converged(self) -> bool:
        """Whether all fits met their stopping rules."""
        return all(model.converged for model in self.models)

    @property
    def has_evidence(self) -> bool:
        """Whether ln Z is known of all models."""
        return all(model.log_evidence is not None for model in self.models)

    @property
    def by_evidence(self) -> list[ComparedModel]:
        """The models, that of the largest evidence first."""
        return sorted(self.models, key=lambda model: -(model.log_evidence or 0.0))

    def _on_levels(self, column: str) -> list[Statement]:
        said = [Statement(level_question(column, self.grouped_by))]
        ordered = sorted(self.models, key=lambda model: -model.left_out[column].elpd)
        best = ordered[0]
        for other in ordered[1:]:
            found = difference(best.left_out[column].pointwise, other.left_out[column].pointwise)
            gap = plus_minus(found.value, found.error)
            text = (
                f"'{best.name}' does so better than '{other.name}', by {gap}."
                if found.sign
                else f"In that '{best.name}' and '{other.name}' are not told apart: they differ by {gap}."
            )
            said.append(Statement(text, AHEAD))
        return said + few_levels(best.left_out[column])

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        return {
            "models": [model.to_dict() for model in self.models],
            "rows": self.rows,
            "prior_widths": self.prior_widths.to_dict(),
            "cross_checks": [asdict(check) | {"agrees": check.agrees} for check in self.cross_checks],
            "sentences": self.sentences(),
        }


def compare(
    fits: Sequence[Fit | JointFit],
    refit: bool | None = None,
    leave_out: Sequence[str] = (),
    nested: bool = False,
    progress: RefitProgress | None = None,
    sensitivity: bool = False,
) -> Comparison:
    """Compare fits by what they predict for data left out.

    Single data by Pareto-smoothed importance-sampling leave-one-out cross-validation, Vehtari, Gelman & Gabry 2017,
    doi 10.1007/s11222-016-9696-4, and by refits where there are few data or importance sampling fails; weights by stacking,
    Yao et al. 2018, doi 10.1214/17-BA1091. And, where the data have grouping columns, all data of one person, or one liquid, in
    the same way: Merkle, Furr & Rabe-Hesketh 2019, doi 10.1007/s11336-019-09679-0, on why these are other questions.

    Parameters
    ----------
    fits : two or more fits of the same data
    refit : sample a model anew without each datum if there are at most 20, and without whatever importance sampling cannot
        leave out, where the model and its data are at hand; None leaves refits that are many, of many data, until they are asked
        for with True (more than 8,000 data in all refits of a model together)
    leave_out : blocks of rows to be left out too: ``"normal_force in 3"``, thirds of the rows along a column, ``"in 3"`` along
        that which has the most different values, ``"order in 3"`` as they stand, ``"session"`` by value
    nested : compute ln Z of each model by nested sampling too, an independent check
    progress : called before the first and after every refit of a model, with the number done and their total
    sensitivity : sample a model anew with wider priors where the draws cannot tell whether the evidence would still prefer the
        same model

    Returns
    -------
    Comparison
        Models, best first, with predictive densities (ln, of data in SI), stacking weights, and sentences.

    Raises
    ------
    InputError
        Fewer than two fits, fits of different data (another table, other rows or another observable), blocks that cannot be
        made, or dynesty is not installed. The model or data of a fit are not at hand, where blocks or nested sampling need them.

    Examples
    --------
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-water")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 500))
    >>> compared = sb.compare([fit, fit], refit=False)
    >>> compared.rows, [model.elpd_difference for model in compared.models]
    (11, [0.0, 0.0])
    """
    if len(fits) < 2:
        raise InputError(f"{len(fits)} run given; a comparison needs at least two")
    reference = fits[0]
    for fit in fits[1:]:
        if fit.provenance["data"]["fingerprint"] != reference.provenance["data"]["fingerprint"]:
            raise InputError(
                f"'{reference.name}' and '{fit.name}' were fitted to different data "
                f"({_describe(reference)}; {_describe(fit)}); only models of the same rows can be compared"
            )
    checks = tuple(cross_check(fit) for fit in fits) if nested else ()  # may lack dynesty, so before all work
    scores = [score(fit, refit, leave_out, progress) for fit in fits]
    widths = prior_widths(fits, sensitivity, progress if sensitivity else None)
    return replace(compare_scores(scores, grouped_by(fits)), cross_checks=checks, prior_widths=widths)


def compare_scores(scores: Sequence[Scores], grouped: tuple[str, ...] = ()) -> Comparison:
    """Compare models of the same data by their scores.

    Parameters
    ----------
    scores : of one or more fits
    grouped : grouping columns that have effects in one of the models
    """
    pointwise = np.stack([entry.single.pointwise for entry in scores])
    reliable = not any(entry.single.unreliable for entry in scores)
    weights = stacking_weights(pointwise) if reliable else None
    best = int(np.argmax([entry.single.elpd for entry in scores]))
    left_out = _differences(scores)
    known = [entry.log_evidence for entry in scores if entry.log_evidence is not None]
    evidence = known if len(known) == len(scores) else None
    probabilities = softmax([value for value, _ in evidence]) if evidence else None
    models = []
    for i, entry in enumerate(scores):
        gap = difference(pointwise[i], pointwise[best])
        models.append(
            ComparedModel(
                name=entry.name,
                elpd_loo=entry.single.elpd,
                elpd_loo_se=entry.single.elpd_se,
                p_loo=entry.effective_parameters,
                elpd_difference=gap.value,
                elpd_difference_se=gap.error,
                weight=None if weights is None else float(weights[i]),
                unreliable_rows=len(entry.single.unreliable),
                converged=entry.converged,
                left_out=left_out[i],
                log_evidence=evidence[i][0] if evidence else None,
                log_evidence_se=evidence[i][1] if evidence else None,
                probability=None if probabilities is None else float(probabilities[i]),
                refitted_rows=len(entry.single.refitted),
                monte_carlo_error=entry.single.monte_carlo_error,
                told_apart=gap.sign != 0,
                refits_not_made=entry.refits_not_made,
            )
        )
    models.sort(key=lambda model: -model.elpd_loo)
    return Comparison(tuple(models), pointwise.shape[1], grouped)


def on_sampling(models: Iterable[ComparedModel], rows: int) -> list[Statement]:
    """What is to be known of the numbers of each model: what was sampled anew, what is doubtful, whether it has converged."""
    said = []
    for model in models:
        said += unreliable_data(model.name, model.unreliable_rows, model.refitted_rows, rows)
        said += not_refitted(model.name, model.refits_not_made, rows)
        for left_out in model.left_out.values():
            said += unreliable_levels(model.name, left_out)
        if not model.converged:
            said.append(Statement(f"'{model.name}' has NOT CONVERGED; its numbers are provisional."))
    return said


def grouped_by(fits: Sequence[Fit | JointFit]) -> tuple[str, ...]:
    """Grouping columns that have effects in one of the fits."""
    labels = [label for fit in fits for label in (*fit.names, *fit.provenance.get("fixed", {}))]
    found = [
        label.partition("[")[2].removesuffix("]") for label in labels if label.startswith("group_scale[")
    ]
    return tuple(dict.fromkeys(found))


def _differences(scores: Sequence[Scores]) -> list[dict[str, LeftOut]]:
    """Scores of levels with differences to the best model, for columns that all models have."""
    columns = [c for c in scores[0].left_out if all(c in entry.left_out for entry in scores)]
    found: list[dict[str, LeftOut]] = [{} for _ in scores]
    for column in columns:
        entries = [entry.left_out[column] for entry in scores]
        best = max(entries, key=lambda entry: entry.elpd)
        for kept, entry in zip(found, entries, strict=True):
            gap = difference(entry.pointwise, best.pointwise)
            kept[column] = replace(entry, difference=gap.value, difference_se=gap.error)
    return found


def _describe(fit: Fit | JointFit) -> str:
    data = fit.provenance["data"]
    return f"{data.get('rows')} rows of {data.get('key')}"
