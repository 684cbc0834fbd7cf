"""A result that can be asked what it owes to its priors."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from skinbayes.fit.result import FitResult

if TYPE_CHECKING:
    from skinbayes.fit.prior_sensitivity import PriorSensitivity


class AskedFit(FitResult):
    """A :class:`~skinbayes.fit.result.FitResult` that knows what other priors would change.

    Examples
    --------
    Examples of methods go on from this one.

    >>> import numpy as np
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-water")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 500))
    """

    def prior_sensitivity(
        self, refit: bool = False, progress: Callable[[int, int], None] | None = None
    ) -> PriorSensitivity:
        """What evidence and posterior owe to the priors.

        The draws are given other weights, as draws of the posterior with each prior half and twice as wide, and with all of them
        (see ``skinbayes.statistics.widening`` for what that means), Pareto-smoothed; nothing is evaluated anew. And prior
        and likelihood are raised to powers near 1, Kallioinen et al. 2024, doi 10.1007/s11222-023-10366-5.

        Parameters
        ----------
        refit : sample the model anew with the other priors where weights cannot tell (Pareto k too large, or the draws end
            where a wider prior would go on): about as long as a fit for each
        progress : called with the number of changed priors done and their total

        Returns
        -------
        PriorSensitivity
            Changes of ln evidence with standard errors, shifts of medians, ratios of widths, sensitivities to the powers, and
            ``sentences()``.

        Raises
        ------
        InputError
            Model or data of the fit are not at hand any more.

        Examples
        --------
        >>> found = fit.prior_sensitivity()
        >>> found.of(["noise_scale"], 2.0).factor, len(found.informed)
        (2.0, 5)
        """
        from skinbayes.fit.prior_sensitivity import prior_sensitivity

        return prior_sensitivity(self, refit, progress)
