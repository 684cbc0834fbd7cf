"""The page about a fit of several experiments: what all say together, whether they agree, and each by itself."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from skinbayes.phrases import and_list
from skinbayes.plot.updates import fit_updates
from skinbayes.report import opening, quality, sentences, tables
from skinbayes.report.agreement import agreement_sentences
from skinbayes.report.digest import digest
from skinbayes.report.discrepancy import discrepancy_sentences
from skinbayes.report.drawings import TRACE, drawings, sampled
from skinbayes.report.figures import picture
from skinbayes.report.groups import group_sentences
from skinbayes.report.origin import data_origin
from skinbayes.report.ridges import posterior_ridges, ridge_sentences
from skinbayes.report.sensitivity import EXPLAINED, HEADERS, brief_sensitivity, page_sensitivity
from skinbayes.report.validity import validity_sentences

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit
    from skinbayes.fit.left_out import LeftOutExperiment

OF_ALL = {*(drawing.key for drawing in sampled()), TRACE.key}
"""Figures of parameters, which are drawn once."""


def joint_context(fit: JointFit, left_out: Sequence[LeftOutExperiment]) -> dict[str, Any]:
    """Everything the template shows, as text."""
    whole = fit.together
    rows, said = page_sensitivity(fit)
    kinds = [*sampled(), *([] if "weighted_posterior" in fit.groups else [TRACE])]
    return {
        "title": str(fit.provenance["title"]) or fit.name,
        "name": fit.name,
        "description": str(fit.provenance["description"]),
        "converged": fit.converged,
        "question": _question(fit),
        "answer": opening.answer(whole),
        "unanswered": opening.unanswered(whole),
        "fits": [f"{name}: {' '.join(quality.verdict(one))}" for name, one in fit.experiments.items()],
        "misfit": any(quality.misfit(one) for one in fit.experiments.values()),
        "sampling": quality.sampling(whole),
        "missing": [sentences.with_symbols(whole, sentence) for sentence in quality.missing(whole)],
        "agreement": agreement_sentences(fit, left_out),
        "learnt": sentences.learnt(whole),
        "not_learnt": sentences.not_learnt(whole),
        "disagreements": sentences.disagreements(whole),
        "ridges": ridge_sentences(whole),
        "scatter": sentences.scatter(whole),
        "parameters": tables.parameter_rows(whole),
        "kept": fit.groups["posterior"].sizes["chain"] * fit.groups["posterior"].sizes["draw"],
        "pictures": [picture(whole, drawing) for drawing in kinds],
        "experiments": {
            name: _experiment(name, one) | {"data": data_origin(one)} for name, one in fit.experiments.items()
        },
        "convergence": [sentences.with_symbols(whole, sentence) for sentence in quality.convergence(whole)],
        "sensitivity": {
            "sentences": [sentences.with_symbols(whole, sentence) for sentence in said],
            "headers": HEADERS,
            "rows": [[sentences.with_symbols(whole, cell) for cell in row] for row in rows],
            "explained": EXPLAINED,
        },
        "fixed": tables.fixed_rows(whole),
        "settings": tables.settings(whole),
        "model_text": str(fit.provenance["model_text"]),
        "references": fit.cite(),
        "bibtex": "\n\n".join(fit.cite("bibtex")),
    }


def _question(fit: JointFit) -> str:
    parameters = [label for label in fit.names if not opening.is_scatter(label)]
    about = and_list([fit.symbol(label) for label in parameters]) or "their scatter"
    return f"What do {and_list(list(fit.experiments))} together say about {about}?"


def _experiment(name: str, fit: Fit) -> dict[str, Any]:
    """What is said of one experiment; the draws are those of all."""
    shown, folded = tables.derived_rows(fit)
    drawn = [picture(fit, drawing) for drawing in drawings(fit) if drawing.key not in OF_ALL]
    return {
        "forward": ""
        if fit.problem is None
        else f"{fit.problem.forward.name}, {fit.problem.forward.summary}",
        "question": opening.question(fit),
        "fits": quality.verdict(fit),
        "checks": quality.agreement(fit),
        "products": sentences.learnt_products(fit),
        "misses": discrepancy_sentences(fit),
        "groups": group_sentences(fit),
        "validity": validity_sentences(fit),
        "derived": shown,
        "derived_folded": folded,
        "pictures": [one | {"key": f"{name}-{one['key']}"} for one in drawn],
    }


def joint_digest(fit: JointFit, left_out: Sequence[LeftOutExperiment]) -> dict[str, Any]:
    """What the page says, for machines: of the parameters of all, of the agreement, and under ``experiments`` of each."""
    whole = fit.together
    return {
        "prior_sensitivity": brief_sensitivity(fit),
        "ridges": [vars(ridge) for ridge in posterior_ridges(whole)],
        "priors": {
            label: {
                "verdict": update.verdict,
                "contraction": update.contraction,
                "prior_quantile": update.prior_quantile,
            }
            for label, update in fit_updates(whole).items()
        },
        "agreement": {one.experiment: one.to_dict() for one in left_out},
        "experiments": {
            name: {
                key: value
                for key, value in digest(one, with_priors=False).items()
                if key not in ("ridges", "priors")
            }
            for name, one in fit.experiments.items()
        },
    }


def joint_remarks(fit: JointFit, left_out: Sequence[LeftOutExperiment]) -> list[str]:
    """Whether the models fit and the experiments agree, about what only the prior speaks, and how sampling went."""
    whole = fit.together
    silent = [
        label
        for label, update in fit_updates(whole).items()
        if update.verdict == "not updated" and not opening.is_scatter(label)
    ]
    return [
        *(f"{name}: {' '.join(quality.verdict(one))}" for name, one in fit.experiments.items()),
        *agreement_sentences(fit, left_out),
        *sentences.disagreements(whole),
        *([f"Only the prior speaks about {and_list(silent)}."] if silent else []),
        str(fit.provenance["sampling"]["verdict"]),
    ]
