"""A result that can be asked what speaks against its model, and what it owes to its priors."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from skinbayes.fit.result import FitResult

if TYPE_CHECKING:
    from skinbayes.fit.prior_sensitivity import PriorSensitivity
    from skinbayes.statistics.agreement import Agreement
    from skinbayes.statistics.repeats import LackOfFit
    from skinbayes.statistics.trends import Trend


class AskedFit(FitResult):
    """A :class:`~skinbayes.fit.result.FitResult` that knows what speaks against its model, and what other priors would change.

    Each answer is computed when it is first asked for, and kept: verdict, page and JSON share it.

    Attributes
    ----------
    agreement : how the data lie among their posterior predictive draws, see
        :class:`~skinbayes.statistics.agreement.Agreement`
    residual_trends : observable to checks of its residuals along every column that varies and in the order of the rows, the
        most surprising first, see :class:`~skinbayes.statistics.trends.Trend`
    repeats : observable to the misfit beside the scatter of rows of the same conditions, see
        :class:`~skinbayes.statistics.repeats.LackOfFit`; without those of which hardly any row repeats another, and empty if
        model or data are gone

    Examples
    --------
    Examples of methods go on from this one.

    >>> import numpy as np
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-water")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 500))
    >>> fit.agreement.count, list(fit.residual_trends), fit.repeats
    (11, ['friction_coefficient'], {})
    """

    @cached_property
    def agreement(self) -> Agreement:
        """How the data lie among their posterior predictive draws."""
        from skinbayes.fit.misfit import agreement

        return agreement(self)

    @cached_property
    def residual_trends(self) -> dict[str, tuple[Trend, ...]]:
        """Checks of the residuals along every column that varies and in the order of the rows, by observable."""
        from skinbayes.fit.misfit import residual_trends

        return residual_trends(self)

    @cached_property
    def repeats(self) -> dict[str, LackOfFit]:
        """The misfit beside the scatter of repeats, by observable."""
        from skinbayes.fit.misfit import repeats

        return repeats(self)

    @cached_property
    def _sensitivities(self) -> dict[bool, PriorSensitivity]:
        """Those found so far, by whether the model was sampled anew for them."""
        return {}

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

        if refit not in self._sensitivities:
            self._sensitivities[refit] = prior_sensitivity(self, refit, progress)
        return self._sensitivities[refit]
