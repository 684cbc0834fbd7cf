"""Put a page together and write it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.comparison.verdicts import DOUBT, LOSES
from skinbayes.fit.joint_fit import JointFit
from skinbayes.fit.predicted import observed_values
from skinbayes.fit.surface_variance import surface_shares
from skinbayes.problem.surface_numbers import surface_sentence
from skinbayes.report import opening, quality, sentences, tables
from skinbayes.report.discrepancy import discrepancy_sentences
from skinbayes.report.figures import pictures
from skinbayes.report.groups import effect_rows, group_sentences
from skinbayes.report.joint_page import joint_context
from skinbayes.report.origin import data_origin
from skinbayes.report.people import people_rows, people_sentences
from skinbayes.report.rendering import rendered, write_whole
from skinbayes.report.ridges import ridge_sentences
from skinbayes.report.sensitivity import EXPLAINED, HEADERS, page_sensitivity
from skinbayes.report.validity import validity_sentences

if TYPE_CHECKING:
    from skinbayes.comparison import AgainstBaselines
    from skinbayes.fit import Fit
    from skinbayes.fit.left_out import LeftOutExperiment
    from skinbayes.problem.check import CheckReport


def write_report(
    fit: Fit | JointFit,
    path: Path,
    baseline_models: AgainstBaselines | None = None,
    left_out: Sequence[LeftOutExperiment] | None = None,
) -> Path:
    """Write one self-contained HTML page about a fit.

    Figures are inside the page; nothing is loaded from anywhere and no script runs. Everything that comes from data
    files, model files and labels is escaped. The file appears whole or not at all.

    Parameters
    ----------
    fit : any fit, of one experiment or several; without its problem the page has neither the curves of the model nor the check
        of what data can tell
    path : the file to write
    baseline_models : the fit beside its baseline models, from :func:`skinbayes.comparison.against_baselines`, if there are any
    left_out : of several experiments, what :meth:`skinbayes.JointFit.left_out` found; from weights alone if omitted

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        The folder does not exist or cannot be written.
    MachineError
        The disk is full.
    """
    return write_whole(Path(path), render(fit, baseline_models, left_out))


def render(
    fit: Fit | JointFit,
    baseline_models: AgainstBaselines | None = None,
    left_out: Sequence[LeftOutExperiment] | None = None,
) -> str:
    """The page as text."""
    if isinstance(fit, JointFit):
        return rendered("joint.html", joint_context(fit, fit.left_out() if left_out is None else left_out))
    return rendered("page.html", context(fit, baseline_models))


def context(fit: Fit, baseline_models: AgainstBaselines | None = None) -> dict[str, Any]:
    """Everything the template shows, as text."""
    check = None if fit.problem is None else fit.problem.check()
    shown, folded = tables.derived_rows(fit)
    drawn, groups = pictures(fit), group_sentences(fit)
    return {
        "title": str(fit.provenance["title"]) or fit.name,
        "name": fit.name,
        "description": str(fit.provenance["description"]),
        "converged": fit.converged,
        "data_name": opening.data_name(fit),
        "question": opening.question(fit),
        "answer": opening.answer(fit),
        "unanswered": opening.unanswered(fit),
        "fits": quality.verdict(fit),
        "misfit": quality.misfit(fit),
        "sampling": quality.sampling(fit),
        "first": next(iter(drawn)),
        "kept": fit.groups["posterior"].sizes["chain"] * fit.groups["posterior"].sizes["draw"],
        "missing": [sentences.with_symbols(fit, sentence) for sentence in quality.missing(fit)],
        "learnt": sentences.learnt(fit),
        "products": sentences.learnt_products(fit),
        "not_learnt": [*sentences.not_learnt(fit), *sentences.open_ends(fit)],
        "ridges": ridge_sentences(fit),
        "disagreements": sentences.disagreements(fit),
        "combinations": _combinations(fit, check),
        "scatter": sentences.scatter(fit),
        "parameters": tables.parameter_rows(fit),
        "derived": shown,
        "derived_folded": folded,
        "pictures": drawn,
        "figures": [
            key
            for key in list(drawn)[1:]
            if key not in ("discrepancy", "people") and not (groups and key == "effects")
        ],
        "misses": discrepancy_sentences(fit),
        "groups": groups,
        "populations": people_sentences(fit),
        "people": people_rows(fit),
        "effects": effect_rows(fit),
        "validity": validity_sentences(fit),
        **_baselines(baseline_models),
        "agreement": quality.agreement(fit),
        "convergence": [sentences.with_symbols(fit, sentence) for sentence in quality.convergence(fit)],
        "sensitivity": _sensitivity(fit),
        "assumptions": _assumptions(fit, check),
        "fixed": tables.fixed_rows(fit),
        "some_tied": bool(fit.provenance.get("tied")),
        "data": data_origin(fit),
        "settings": tables.settings(fit),
        "model_text": str(fit.provenance["model_text"]),
        "references": fit.cite(),
        "bibtex": "\n\n".join(fit.cite("bibtex")),
    }


def _baselines(baseline_models: AgainstBaselines | None) -> dict[str, Any]:
    """Sentences and table of the baseline models; what makes the numbers themselves doubtful stands apart."""
    if baseline_models is None:
        return {"loses": [], "baseline_models": None}
    said = baseline_models.statements()
    return {
        "loses": [one.text for one in said if one.kind == LOSES],
        "baseline_models": {
            "sentences": [one.text for one in said if one.kind != DOUBT],
            "doubts": [one.text for one in said if one.kind == DOUBT],
            "headers": baseline_models.headers(),
            "rows": baseline_models.rows(),
        },
    }


def _sensitivity(fit: Fit) -> dict[str, Any]:
    """Sentences and table on the priors, with symbols."""
    rows, said = page_sensitivity(fit)
    return {
        "sentences": [sentences.with_symbols(fit, sentence) for sentence in said],
        "headers": HEADERS,
        "rows": [[sentences.with_symbols(fit, cell) for cell in row] for row in rows],
        "explained": EXPLAINED,
    }


def _combinations(fit: Fit, check: CheckReport | None) -> list[str]:
    """Combinations of simple form that all data together determine, and changes of parameters that they cannot notice."""
    if check is None or check.identifiability is None:
        return []
    found = check.identifiability
    known = [c for c in found.joint.combinations if c.constant and len(c.exponents) > 1]
    said = [f"{combination.phrase()} is determined." for combination in known]
    said += [freedom.sentence() for freedom in found.freedoms if freedom.constant]
    return [sentences.with_symbols(fit, sentence) for sentence in said]


def _assumptions(fit: Fit, check: CheckReport | None) -> list[str]:
    data, free = len(observed_values(fit)), len(fit.names)
    families = {str(family).replace("_", " ") for family in fit.provenance["noise"].values()}
    said = [f"Scatter of the data about the model: {' or '.join(sorted(families))} distribution."]
    if options := fit.provenance.get("options"):
        said.append(f"The theory was evaluated with {', '.join(f'{k} = {v}' for k, v in options.items())}.")
    if fit.problem is not None:
        said += surface_sentence(fit.problem, np.median(fit.theta(), axis=0), " at the posterior medians")
        said += [sentences.with_symbols(fit, sentence) for sentence in surface_shares(fit)]
    if accuracy := str(fit.provenance.get("accuracy") or ""):
        said.append(f"{accuracy[:1].upper()}{accuracy[1:]}".removesuffix(".") + ".")
    if free > data:
        said.append(
            f"There are more free parameters ({free}) than data ({data}): the priors decide what remains open."
        )
    if check is None:
        said.append(
            "The model file or the data are gone, so that what the data can tell was not checked again."
        )
    else:
        said += [sentences.with_symbols(fit, sentence) for sentence in check.predictions]
    return said
