"""The result of a fit, with its figures and its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.arrays import ArrayLike
from skinbayes.atomic import write_atomically
from skinbayes.fit.asked_fit import AskedFit
from skinbayes.fit.netcdf import result_image

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.problem import Problem


@dataclass(frozen=True, repr=False)
class Fit(AskedFit):
    """Posterior draws of a problem and everything computed from them.

    Its attributes, and what is computed from them, are those of :class:`~skinbayes.fit.result.FitResult`.

    Attributes
    ----------
    groups, provenance, problem : see :class:`~skinbayes.fit.result.FitResult`

    Examples
    --------
    Examples of methods go on from this one. Its draws are those of the prior, which are quick to make.

    >>> import numpy as np
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-null")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 100))
    >>> fit.names[0]
    'typical_friction_coefficient'
    """

    def __repr__(self) -> str:
        return f"Fit of '{self.name}': {self.provenance['sampling']['verdict']}"

    @classmethod
    def from_draws(
        cls, problem: Problem, samples: Any, log_weights: ArrayLike | None = None, seed: int = 1
    ) -> Fit:
        """The whole result from draws of any sampler.

        Parameters
        ----------
        problem : a problem with data
        samples : draws of the free parameters in SI: an array ``(draws, D)`` or ``(chains, draws, D)`` in the order of
            ``problem.names``; or by name, each ``(draws,)`` or ``(chains, draws)``: a mapping, a data frame, an
            ``xarray.Dataset``, or what has one as ``posterior`` (``InferenceData``, ``DataTree``). Levels of a parameter are
            ``name[level]``, or a dimension of ``name`` with labels. Other variables are left aside
        log_weights : ln of the weights up to a constant, shape ``(draws,)`` or ``(chains, draws)``; None if all weigh the same
        seed : non-negative integer, for predictive draws and the resampling of weighted ones

        Returns
        -------
        Fit
            ``converged`` if the effective sample size is at least 400 in every parameter and R-hat at most 1.01

        Raises
        ------
        InputError
            Draws of a parameter are missing, lie outside its prior, or shapes do not fit.

        Examples
        --------
        >>> import skinbayes as sb
        >>> problem = sb.load_problem("forearm-glass")
        >>> import numpy as np
        >>> before = problem.draw_prior(np.random.default_rng(1), 2000)
        >>> fit = sb.Fit.from_draws(problem, before, log_weights=problem.log_likelihood(before))
        >>> fit.converged
        False
        """
        from skinbayes.fit.given_draws import fit_parts

        return cls(*fit_parts(problem, samples, log_weights, seed), problem)

    def save(self, path: str | Path) -> Path:
        """Write the result as one netCDF file in the ArviZ schema; the file appears whole or not at all, and shows any damage.

        Parameters
        ----------
        path : the file

        Returns
        -------
        Path
            The file.

        Raises
        ------
        OSError
            It cannot be written.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     again = sb.load_fit(fit.save(pathlib.Path(folder) / "fit.nc"))
        >>> again.names == fit.names
        True
        """
        write_atomically(Path(path), result_image(self.groups, self.provenance))
        return Path(path)

    def plot_data(self, width: str | None = None) -> Figure:
        """Data and model against the condition that varies: load, speed, humidity, time.

        See :func:`skinbayes.plot.plot_data` for what is drawn.

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
        >>> print(fit.plot_data().get_suptitle().removeprefix("NOT CONVERGED – "))
        Data against the fitted model
        """
        from skinbayes.plot import plot_data

        return plot_data(self, width=width)

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
