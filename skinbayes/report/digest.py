"""What a page says, for machines: validity, groups, ridges and priors of a fit as plain types."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.fit.predicted import row_names
from skinbayes.plot.updates import fit_updates
from skinbayes.problem.surface_numbers import surface_numbers
from skinbayes.report.discrepancy import discrepancy_findings
from skinbayes.report.groups import group_findings
from skinbayes.report.ridges import posterior_ridges
from skinbayes.report.sensitivity import brief_sensitivity
from skinbayes.report.validity import flags

if TYPE_CHECKING:
    from skinbayes.fit import Fit


def digest(fit: Fit, with_priors: bool = True) -> dict[str, Any]:
    """The findings about a fit as plain types.

    Parameters
    ----------
    fit : any fit
    with_priors : False leaves out ``prior_sensitivity``

    Returns
    -------
    dict
        ``prior_sensitivity`` (parameter to what its prior half and twice as wide would change; None if model or data are gone).
        ``validity`` (flag to the number of rows flagged in at least 5 % of the draws, the fraction of all predictions, what it
        means, and the fraction of each of these rows), ``groups`` (column to the quantiles of the scale of its effects and of
        each effect, the scale over the noise, the fraction of the variance), ``populations`` (parameter to its median, how people
        differ, each of them, and what treatments do, with its probability), ``discrepancy`` (column to the
        quantiles of what the theory misses along it), ``ridges`` (pairs of parameters, exponent, the
        combination that is known and how well), ``priors`` (parameter to its update by the data), ``trends`` (observable to the
        checks of its residuals along columns that simulated data hardly ever meet, the most surprising first), ``repeats``
        (observable to the scatter of rows of the same conditions and the misfit beside it), ``surface`` (rms height, rms slope,
        true over nominal area and band at the posterior medians; empty where none enters). Quantities in SI.
    """
    names = row_names(fit)
    return {
        **({"prior_sensitivity": brief_sensitivity(fit)} if with_priors else {}),
        "validity": {flag.name: flag.to_dict(names) for flag in flags(fit)},
        "groups": {finding.column: finding.to_dict() for finding in group_findings(fit)},
        "populations": {finding.parameter: finding.to_dict() for finding in fit.population_findings},
        "discrepancy": {finding.column: finding.to_dict() for finding in discrepancy_findings(fit)},
        "ridges": [asdict(ridge) for ridge in posterior_ridges(fit)],
        "priors": {
            label: {
                "verdict": update.verdict,
                "contraction": update.contraction,
                "prior_quantile": update.prior_quantile,
            }
            for label, update in fit_updates(fit).items()
        },
        "trends": {
            name: [asdict(check) for check in checks if check.found]
            for name, checks in fit.residual_trends.items()
        },
        "surface": {}
        if fit.problem is None
        else surface_numbers(fit.problem, np.median(fit.theta(), axis=0)),
        "repeats": {name: asdict(one) | {"found": one.found} for name, one in fit.repeats.items()},
    }
