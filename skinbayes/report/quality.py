"""Does the model fit, did the sampler converge: sentences about the quality of a fit."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.fit.misfit import FEW
from skinbayes.fit.predicted import is_logarithmic, observables
from skinbayes.phrases import and_list, number, percent, plural, sample_size
from skinbayes.plot.numbers import fraction, quantity_of
from skinbayes.plot.predictive import datum_names
from skinbayes.plot.rows import group_columns
from skinbayes.plot.symbols import spoken_name
from skinbayes.report.repeats import repeat_sentences
from skinbayes.report.trends import trend_sentences
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from skinbayes.fit import Fit
    from skinbayes.statistics.agreement import Agreement

MOST_NAMED = 6


def misfit(fit: Fit) -> bool:
    """Whether single values, mean, scatter, a trend of the residuals or repeats speak against the model."""
    return fit.agreement.misfit or bool(trend_sentences(fit)) or bool(repeat_sentences(fit)[0])


def verdict(fit: Fit) -> list[str]:
    """Whether the model fits, in a few sentences; what only looks like a good fit is not praised."""
    found, trends, (beyond, allowed) = fit.agreement, trend_sentences(fit), repeat_sentences(fit)
    follows = trends + beyond
    inside = (
        f"{found.wide} of {found.count} values lie in their 90 % ranges "
        f"(about {number(0.9 * found.count, 2)} expected)"
    )
    if found.misfit:
        why = [inside] if found.few_inside else []
        if found.far:
            why.append(f"{_rows(fit, found)} {'is' if len(found.far) == 1 else 'are'} far out")
        why += [f"the {name} of the data is not reproduced" for name in found.missed]
        said = [
            f"The model misses something: {'; '.join(why)}. Do not use its values before it is clear what.",
            *follows,
        ]
    elif follows:
        start = "The model misses a trend." if trends else "The model misses what is no noise."
        said = [start, *follows, "Do not use its values before it is clear why."]
    elif found.count < FEW:
        said = [
            "Hardly tested: almost any model with as many parameters agrees with "
            f"{'one value' if found.count == 1 else f'{found.count} values'}."
        ]
    else:
        said = [f"Single values, mean, scatter and trends do not speak against it: {inside}."]
    said += [] if beyond else allowed
    if group_columns(fit):
        many = and_list([plural(column) for column in group_columns(fit)])
        said.append(f"What is predicted knows the effects of the {many} measured.")
    if scatter := free_scatter(fit):
        start = "The" if found.misfit or follows or found.count < FEW else "That is little: the"
        said.append(
            f"{start} scatter was fitted too ({scatter}) and takes in whatever the model misses. Look for dots that lie on "
            "one side together."
        )
    return said


def free_scatter(fit: Fit) -> str:
    """The size of a fitted scatter, ``"16 % of μ"``; empty if it was given, or is none of one number."""
    if "noise_scale" not in fit.names or len(observables(fit)) != 1:
        return ""
    name = observables(fit)[0]
    known, value = lookup(name), float(fit.quantiles("noise_scale", 0.5))
    if is_logarithmic(fit, name):
        return f"{percent(value)} of {known.symbol if known else spoken_name(name)}"
    return quantity_of(name, value)


def agreement(fit: Fit) -> list[str]:
    """Whether the fitted model reproduces the data it was fitted to, check by check."""
    found = fit.agreement
    said = [
        f"{_of(found.wide, found.count)} in the 5–95 % range of what the fitted model predicts, {found.narrow} in the 25–75 % "
        f"range; about {number(0.9 * found.count, 2)} and {number(0.5 * found.count, 2)} would be expected of a model that "
        "is right."
    ]
    if found.far:
        said.append(
            f"Almost no simulated value is as far out as the observed one in {_rows(fit, found)}: the model does not explain "
            f"{'it' if len(found.far) == 1 else 'them'}."
        )
    else:
        said.append("No single row lies where the fitted model would hardly ever put it.")
    said += [
        f"The {name} of the data is {'not ' if name in found.missed else ''}reproduced: {fraction(above, total)} of simulated "
        "data sets have a larger one (posterior predictive p-value; near 0 % or 100 % means misfit)."
        for name, (above, total) in found.statistics.items()
    ]
    if group_columns(fit):
        many = and_list([plural(column) for column in group_columns(fit)])
        said.append(
            f"These predictions know the effects of the very {many} that were measured: they say little about the theory, "
            "which is judged by the size of the effects and by what is predicted for others."
        )
    if found.count < FEW:
        said.append(
            f"With {found.count} {'datum' if found.count == 1 else 'data'} such agreement is weak evidence: almost any model "
            "with as many parameters would show it."
        )
    return said


def _rows(fit: Fit, found: Agreement) -> str:
    names = datum_names(fit)
    listed = ", ".join(names[i] for i in found.far[:MOST_NAMED])
    more = f" and {len(found.far) - MOST_NAMED} more" if len(found.far) > MOST_NAMED else ""
    return f"{'row' if len(found.far) == 1 else 'rows'} {listed}{more}"


def _of(inside: int, count: int) -> str:
    if count == 1:
        return "The single datum lies" if inside else "The single datum does not lie"
    return (
        f"{'All' if inside == count else inside} of {count} data lie"
        if inside
        else f"None of {count} data lies"
    )


TOLD = (
    "{ensembles} independent ensembles of {walkers} walkers made {steps} steps each; the first {burn_in} were left out and "
    "one in {thinning} of the others kept.",
    "Importance sampling was tried and given up: {importance_refused}.",
    "{runs} independent runs of nested sampling with {live_points} live points each were merged.",
    "{acceptance} of the proposed moves were accepted.",
    "The model was evaluated {evaluations} times.",
    "ln of the evidence is {log_evidence}.",
    "The smallest effective sample size of a parameter is {ess}.",
    "The largest R-hat is {r_hat}.",
    "{invalid} evaluations gave no finite value and counted as impossible.",
)
"""What is said about a run, each where its engine has all numbers by these names."""


def told(fit: Fit) -> dict[str, str]:
    """The diagnostics of a run by name, as text."""
    run = fit.provenance["sampling"]
    text = {name: str(value) for name, value in run.items() if isinstance(value, int | float | str) and value}
    if "acceptance_fraction" in run:
        text["acceptance"] = percent(float(np.mean(run["acceptance_fraction"])))
    if run.get("log_evidence"):
        value, error = run["log_evidence"]
        text["log_evidence"] = f"{value:.2f} ± {error:.2f}"
    if "ess_bulk" in run:
        ess = float(np.min(run["ess_bulk"]))
        text["ess"] = number(ess, 3) if ess > 0 else "unknown"
    if "r_hat" in run:
        text["r_hat"] = f"{np.max(run['r_hat']):.3f}"
    return text


def convergence(fit: Fit) -> list[str]:
    """How the sampler ran and what its stopping rule said."""
    known = told(fit)
    lines = [line.format_map(known) for line in TOLD if set(re.findall(r"{(\w+)}", line)) <= set(known)]
    note = more_than_kept(fit)
    return [str(fit.provenance["sampling"]["verdict"]), *lines, *([note] if note else [])]


def more_than_kept(fit: Fit) -> str:
    """What an effective sample size above the number of stored draws is; empty if there is none."""
    sizes = fit.groups["posterior"].sizes
    kept = sizes["chain"] * sizes["draw"]
    if max(fit.provenance["sampling"].get("ess_bulk", [0.0])) <= kept:
        return ""
    if "weighted_posterior" in fit.groups:
        return (
            f"Quantiles of parameters come from all weighted draws; {kept} of them, resampled to equal weight, are kept for "
            "predictions and figures."
        )
    return (
        f"Effective sample sizes (ESS) count all steps of the run; {kept} draws of them are kept, nearly independent, and all "
        "numbers here come from these."
    )


def sampling(fit: Fit) -> str:
    """How the sampling went, in one line: it says nothing about the model."""
    run = fit.provenance["sampling"]
    numbers = (
        [f"effective sample size {_at_least(float(np.min(run['ess_bulk'])))}"] if "ess_bulk" in run else []
    )
    numbers += [f"R-hat at most {np.max(run['r_hat']):.3f}"] if "r_hat" in run else []
    said = f"The computation {'converged' if fit.converged else 'has NOT converged'}"
    return f"{': '.join([said, ', '.join(numbers)]) if numbers else said}."


def _at_least(ess: float) -> str:
    return f"at least {sample_size(ess)}" if ess > 0 else "unknown, as the run is too short to tell"


def missing(fit: Fit) -> list[str]:
    """What a run that has not converged lacks; empty if it has."""
    if fit.converged:
        return []
    run = fit.provenance["sampling"]
    return [str(entry) for entry in run["missing"]] or [str(run["verdict"])]
