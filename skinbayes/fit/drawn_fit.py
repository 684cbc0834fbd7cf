"""A result with its figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from skinbayes.fit.asked_fit import AskedFit

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class DrawnFit(AskedFit):
    """An :class:`~skinbayes.fit.asked_fit.AskedFit` that draws itself.

    Examples
    --------
    Examples of methods go on from this one.

    >>> import numpy as np
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-null")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 100))
    """

    def plot_data(self, width: str | None = None, abscissa: str | None = None) -> Figure:
        """Data and model against the condition that varies: load, speed, humidity, time.

        See :func:`skinbayes.plot.plot_data` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted
        abscissa : condition to draw against, such as ``"normal_force"``; the usual one if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has. ``abscissa`` is no condition that differs between rows.

        Examples
        --------
        >>> print(fit.plot_data().get_suptitle().removeprefix("NOT CONVERGED – "))
        Data against the fitted model
        """
        from skinbayes.plot import plot_data

        return plot_data(self, width, abscissa)

    def plot_corner(self, width: str | None = None) -> Figure:
        """Corner plot of the free parameters.

        See :func:`skinbayes.plot.plot_corner` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has.

        Examples
        --------
        >>> print(fit.plot_corner().get_suptitle().removeprefix("NOT CONVERGED – "))
        Posterior of parameters and pairs
        """
        from skinbayes.plot import plot_corner

        return plot_corner(self, width=width)

    def plot_trace(self, width: str | None = None) -> Figure:
        """Draws against time for each ensemble.

        See :func:`skinbayes.plot.plot_trace` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has.

        Examples
        --------
        >>> print(fit.plot_trace().get_suptitle().removeprefix("NOT CONVERGED – "))
        Draws against time
        """
        from skinbayes.plot import plot_trace

        return plot_trace(self, width=width)

    def plot_predictive(self, width: str | None = None) -> Figure:
        """Observed values against the posterior predictive distribution.

        See :func:`skinbayes.plot.plot_predictive` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has.

        Examples
        --------
        >>> print(fit.plot_predictive().get_suptitle().removeprefix("NOT CONVERGED – "))
        Data against the fitted model
        """
        from skinbayes.plot import plot_predictive

        return plot_predictive(self, width=width)

    def plot_prior_posterior(self, width: str | None = None) -> Figure:
        """Prior against posterior of each parameter.

        See :func:`skinbayes.plot.plot_prior_posterior` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has.

        Examples
        --------
        >>> print(fit.plot_prior_posterior().get_suptitle().removeprefix("NOT CONVERGED – "))
        Prior against posterior
        """
        from skinbayes.plot import plot_prior_posterior

        return plot_prior_posterior(self, width=width)

    def plot_prior_predictive(self, width: str | None = None) -> Figure:
        """Observed values against what the priors alone predict.

        See :func:`skinbayes.plot.plot_prior_predictive` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has.

        Examples
        --------
        >>> print(fit.plot_prior_predictive().get_suptitle().removeprefix("NOT CONVERGED – "))
        Data against what the priors allow
        """
        from skinbayes.plot import plot_prior_predictive

        return plot_prior_predictive(self, width=width)

    def plot_profile(self, abscissa: str | None = None, width: str | None = None) -> Figure:
        """Curves of the forward model with posterior bands and data, against one quantity.

        See :func:`skinbayes.plot.plot_profile` for what is drawn.

        Parameters
        ----------
        abscissa : quantity on the common axis; the first that the model offers if omitted
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            The model has no curve against ``abscissa``. A width that no page has.

        Examples
        --------
        >>> print(fit.plot_profile().get_suptitle().removeprefix("NOT CONVERGED – "))
        Curves of the model
        """
        from skinbayes.plot import plot_profile

        return plot_profile(self, abscissa, width)

    def plot_levels(self, column: str | None = None, width: str | None = None) -> Figure:
        """Data over posterior bands, a panel for each level of a grouping column.

        See :func:`skinbayes.plot.plot_levels` for what is drawn.

        Parameters
        ----------
        column : such as ``"person"``; the first with effects if omitted
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            ``column`` is no grouping column. A width that no page has.

        Examples
        --------
        >>> print(fit.plot_levels("liquid").get_suptitle().removeprefix("NOT CONVERGED – "))
        Data and model, liquid by liquid
        """
        from skinbayes.plot import plot_levels

        return plot_levels(self, column, width=width)

    def plot_effects(self, width: str | None = None) -> Figure:
        """Effects of groups, and the residuals of their rows.

        See :func:`skinbayes.plot.plot_effects` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has.

        Examples
        --------
        >>> print(fit.plot_effects().get_suptitle().removeprefix("NOT CONVERGED – "))
        Effects of groups and residuals
        """
        from skinbayes.plot import plot_effects

        return plot_effects(self, width=width)

    def plot_people(self, width: str | None = None) -> Figure:
        """Each person's value of each parameter that has a population.

        See :func:`skinbayes.plot.plot_people` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has.

        Examples
        --------
        >>> print(fit.plot_people().get_suptitle().removeprefix("NOT CONVERGED – "))
        People one by one
        """
        from skinbayes.plot import plot_people

        return plot_people(self, width=width)

    def plot_residuals(self, width: str | None = None) -> Figure:
        """What is left between data and model, against the abscissa and the conditions.

        See :func:`skinbayes.plot.plot_residuals` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has.

        Examples
        --------
        >>> print(fit.plot_residuals().get_suptitle().removeprefix("NOT CONVERGED – "))
        What is left between data and model
        """
        from skinbayes.plot import plot_residuals

        return plot_residuals(self, width=width)

    def plot_discrepancy(self, width: str | None = None) -> Figure:
        """What the theory misses along each column of the discrepancy.

        See :func:`skinbayes.plot.plot_discrepancy` for what is drawn.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            Of no window; ``savefig`` writes it.

        Raises
        ------
        InputError
            A width that no page has.

        Examples
        --------
        >>> print(fit.plot_discrepancy().get_suptitle().removeprefix("NOT CONVERGED – "))
        What the theory misses
        """
        from skinbayes.plot import plot_discrepancy

        return plot_discrepancy(self, width=width)
