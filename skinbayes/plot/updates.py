"""What the data changed about each parameter of a fit, for figures and pages."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from skinbayes.diagnose import PriorUpdate
    from skinbayes.fit.result import FitResult


def fit_updates(fit: FitResult) -> dict[str, PriorUpdate]:
    """Prior against posterior of each free parameter, by label.

    Spreads are compared in the coordinates of each parameter alone: logarithms of positive ones. Without the problem the
    support of a parameter is not known, and all whose draws are positive count as positive.
    """
    from skinbayes.diagnose import prior_updates
    from skinbayes.statistics.transforms import VectorTransform

    before, after = fit.theta("prior"), fit.theta()
    if fit.problem is not None:
        # where funnels are straightened, the coordinates of the sampler mix parameters
        transform = VectorTransform(fit.problem.target().transform.transforms)
    else:
        positive = np.atleast_1d(np.vstack([before, after]).min(axis=0) > 0.0)
        transform = VectorTransform.for_supports(
            [(0.0, np.inf) if is_positive else (-np.inf, np.inf) for is_positive in positive]
        )
    found = prior_updates(fit.names, before, after, transform)
    return {update.name: update for update in found if update.name in fit.shown_names}
