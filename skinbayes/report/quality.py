"""Does the model fit, did the sampler converge: sentences about the quality of a fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.plot.numbers import number, percent
from skinbayes.plot.predictive import (
    datum_names,
    observables,
    observed_values,
    predictive_draws,
    predictive_quantiles,
)
from skinbayes.plot.rows import group_columns
from skinbayes.report.words import and_list, plural

if TYPE_CHECKING:
    from skinbayes.fit import Fit

FEW = 5
"""With fewer data than this their agreement says little."""

SURPRISING = 0.01
"""A datum with a smaller share of predictive draws on one side of it is named."""

MOST_NAMED = 6


def agreement(fit: Fit) -> list[str]:
    """Whether the fitted model reproduces the data it was fitted to.

    Coverage of predictive intervals, rows in the tails, and posterior predictive p-values of mean and scatter (Gelman,
    Meng & Stern 1996, Statistica Sinica 6:733).
    """
    observed = observed_values(fit)
    quantiles = predictive_quantiles(fit)
    count = len(observed)
    wide = int(((quantiles[0] <= observed) & (observed <= quantiles[4])).sum())
    narrow = int(((quantiles[1] <= observed) & (observed <= quantiles[3])).sum())
    said = [
        f"{_of(wide, count)} in the 5–95 % range of what the fitted model predicts, {narrow} in the 25–75 % range; "
        f"about {number(0.9 * count, 2)} and {number(0.5 * count, 2)} would be expected of a model that is right."
    ]
    draws = predictive_draws(fit)
    share = (draws < observed).mean(axis=0)
    tails = np.minimum(share, 1.0 - share)
    far = [i for i in np.argsort(tails) if tails[i] < SURPRISING]
    if far:
        names = datum_names(fit)
        listed = ", ".join(names[i] for i in far[:MOST_NAMED])
        more = f" and {len(far) - MOST_NAMED} more" if len(far) > MOST_NAMED else ""
        said.append(
            f"Almost no simulated value is as far out as the observed one in {'row' if len(far) == 1 else 'rows'} "
            f"{listed}{more}: the model does not explain {'it' if len(far) == 1 else 'them'}."
        )
    else:
        said.append("No single row lies where the fitted model would hardly ever put it.")
    if count >= FEW and len(observables(fit)) == 1:
        said += [
            _statistic("mean", draws.mean(axis=1), float(observed.mean())),
            _statistic("scatter between rows", draws.std(axis=1, ddof=1), float(observed.std(ddof=1))),
        ]
    if group_columns(fit):
        many = and_list([plural(column) for column in group_columns(fit)])
        said.append(
            f"These predictions know the effects of the very {many} that were measured: they say little about the theory, "
            "which is judged by the size of the effects and by what is predicted for others."
        )
    if count < FEW:
        said.append(
            f"With {count} {'datum' if count == 1 else 'data'} such agreement is weak evidence: almost any model with as "
            "many parameters would show it."
        )
    return said


def _of(inside: int, count: int) -> str:
    if count == 1:
        return "The single datum lies" if inside else "The single datum does not lie"
    return (
        f"{'All' if inside == count else inside} of {count} data lie"
        if inside
        else f"None of {count} data lies"
    )


def _statistic(name: str, simulated: FloatArray, observed: float) -> str:
    above = float((simulated > observed).mean())
    verdict = "reproduced" if 0.05 <= above <= 0.95 else "not reproduced"
    return (
        f"The {name} of the data is {verdict}: {percent(above)} of simulated data sets have a larger one "
        "(posterior predictive p-value; near 0 % or 100 % means misfit)."
    )


def convergence(fit: Fit) -> list[str]:
    """How the sampler ran and what its stopping rule said."""
    run = fit.provenance["sampling"]
    ess, r_hat = np.min(run["ess_bulk"]), np.max(run["r_hat"])
    acceptance = np.mean(run["acceptance_fraction"])
    said = [
        str(run["verdict"]),
        f"{run['ensembles']} independent ensembles of {run['walkers']} walkers made {run['steps']} steps each; the first "
        f"{run['burn_in']} were left out and one in {run['thinning']} of the others kept. "
        f"{percent(float(acceptance))} of the proposed moves were accepted; the model was evaluated {run['evaluations']} times.",
        f"The smallest effective sample size of a parameter is {number(float(ess), 3)}, the largest R-hat {r_hat:.3f}.",
    ]
    if run["invalid"]:
        said.append(f"{run['invalid']} evaluations gave no finite value and counted as impossible.")
    return said


def missing(fit: Fit) -> list[str]:
    """What a run that has not converged lacks; empty if it has."""
    if fit.converged:
        return []
    run = fit.provenance["sampling"]
    return [str(entry) for entry in run["missing"]] or [str(run["verdict"])]
