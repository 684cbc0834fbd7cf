"""The result of a fit, with its figures and its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.arrays import ArrayLike
from skinbayes.fit.result import FitResult
from skinbayes.fit.saving import save_fit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.problem import Problem


@dataclass(frozen=True, repr=False)
class Fit(FitResult):
    """Posterior draws of a problem and everything computed from them.

    Its attributes, and what is computed from them, are those of :class:`~skinbayes.fit.result.FitResult`.
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
        """Write the result as one netCDF file in the ArviZ schema."""
        return save_fit(self, Path(path))

    def plot_data(self, width: str | None = None) -> Figure:
        """Data and model against the condition that varies: load, speed, humidity, time.

        Every figure takes its ``width`` as text with a unit: ``"84 mm"`` for a column of a journal.
        """
        from skinbayes.plot import plot_data

        return plot_data(self, width=width)

    def plot_corner(self, width: str | None = None) -> Figure:
        """Corner plot of the free parameters."""
        from skinbayes.plot import plot_corner

        return plot_corner(self, width=width)

    def plot_trace(self, width: str | None = None) -> Figure:
        """Draws against time for each ensemble."""
        from skinbayes.plot import plot_trace

        return plot_trace(self, width=width)

    def plot_predictive(self, width: str | None = None) -> Figure:
        """Observed values against the posterior predictive distribution."""
        from skinbayes.plot import plot_predictive

        return plot_predictive(self, width=width)

    def plot_prior_posterior(self, width: str | None = None) -> Figure:
        """Prior against posterior of each parameter."""
        from skinbayes.plot import plot_prior_posterior

        return plot_prior_posterior(self, width=width)

    def plot_prior_predictive(self, width: str | None = None) -> Figure:
        """Observed values against what the priors alone predict."""
        from skinbayes.plot import plot_prior_predictive

        return plot_prior_predictive(self, width=width)

    def plot_profile(self, abscissa: str | None = None, width: str | None = None) -> Figure:
        """Curves of the forward model with posterior bands and data, against one quantity (the first it offers)."""
        from skinbayes.plot import plot_profile

        return plot_profile(self, abscissa, width)

    def plot_levels(self, column: str | None = None, width: str | None = None) -> Figure:
        """Data over posterior bands, a panel for each level of a grouping column such as ``person``."""
        from skinbayes.plot import plot_levels

        return plot_levels(self, column, width=width)

    def plot_effects(self, width: str | None = None) -> Figure:
        """Effects of groups, and the residuals of their rows."""
        from skinbayes.plot import plot_effects

        return plot_effects(self, width=width)

    def plot_residuals(self, width: str | None = None) -> Figure:
        """What is left between data and model, against the abscissa and the conditions."""
        from skinbayes.plot import plot_residuals

        return plot_residuals(self, width=width)
