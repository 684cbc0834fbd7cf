"""A result that can be asked what speaks against its model, and what it owes to its priors."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from skinbayes.fit.result import FitResult

if TYPE_CHECKING:
    import pandas

    from skinbayes.files.surface_draws import SurfaceDraws
    from skinbayes.fit.people import PopulationFinding
    from skinbayes.fit.prior_sensitivity import PriorSensitivity
    from skinbayes.fit.surface_variance import SurfaceVariance
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
    population_findings : the median person, how people differ, each of them, and what a treatment does, for each parameter that
        has a population; see ``skinbayes.fit.people.PopulationFinding``. Empty if the model is gone

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
    def population_findings(self) -> tuple[PopulationFinding, ...]:
        """What is to be said of each parameter with a population."""
        from skinbayes.fit.people import population_findings

        return population_findings(self)

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

    def people(self) -> pandas.DataFrame:
        """Each person's value of each parameter that has a population.

        Returns
        -------
        pandas.DataFrame
            A row for each parameter and level, nested ones too: ``parameter``, ``level``, ``unit``, the quantiles ``q05``,
            ``median`` and ``q95`` (SI), and ``shrinkage``: how much of what is said is that of the population, 1 without data.
            Without rows if no parameter has a population.

        Examples
        --------
        >>> list(fit.people().columns)
        ['parameter', 'level', 'unit', 'q05', 'median', 'q95', 'shrinkage']
        """
        from skinbayes.fit.people import people_table

        return people_table(self.population_findings)

    def contrasts(self) -> pandas.DataFrame:
        """What treatments do to parameters that have a population.

        Returns
        -------
        pandas.DataFrame
            A row for the median of the population (``who`` is empty) and one for each person: ``parameter``, ``compared``, such
            as ``"after/before"``, ``who``, ``kind`` (``"ratio"`` of what is positive, else ``"difference"``), ``unit``, the
            quantiles ``q05``, ``median``, ``q95`` (SI) and ``probability_lower``, that the treatment lowers the parameter.

        Examples
        --------
        >>> len(fit.contrasts())
        0
        """
        from skinbayes.fit.people import contrast_table

        return contrast_table(self.population_findings)

    def surface(self) -> SurfaceDraws:
        """What this fit knows of the roughness, for another problem: ``build_problem(…, surface=fit.surface())``.

        Returns
        -------
        SurfaceDraws
            Draws of the roughness parameters that are free, and the values of the others, SI.

        Raises
        ------
        InputError
            The fit has no self-affine surface with free parameters, or its model is not at hand any more.

        Examples
        --------
        >>> list(fit.surface().draws), fit.surface().fixed["hurst_exponent"]
        (['rms_height'], 0.78)
        """
        from skinbayes.fit.surface_variance import fitted_surface

        return fitted_surface(self)

    def surface_variance(self, quantity: str | None = None) -> SurfaceVariance:
        """Split the posterior variance of ln of a parameter into surface, other parameters of the theory, and data.

        ``Var E[ln y | surface] / Var ln y`` and so on, from regressions on the draws; where the posterior makes groups depend on
        each other each gets the mean of what it adds first and last. See ``skinbayes.statistics.variance_shares``.

        Parameters
        ----------
        quantity : label of a free parameter; the first frictional shear stress if omitted

        Returns
        -------
        SurfaceVariance
            The three shares with their standard errors, and ``sentence()``.

        Raises
        ------
        InputError
            No roughness parameter is free beside it, or the model of the fit is not at hand any more.

        Examples
        --------
        >>> print(f"{fit.surface_variance('young_modulus_layer').data:.1f}")  # draws of the prior: nothing depends on anything
        1.0
        """
        from skinbayes.fit.surface_variance import surface_variance

        return surface_variance(self, quantity)
