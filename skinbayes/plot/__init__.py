"""Figures of a fit. Each function takes a fit and returns a matplotlib ``Figure`` that belongs to no window."""

from skinbayes.plot.corner_plot import plot_corner
from skinbayes.plot.data import plot_data
from skinbayes.plot.discrepancy import plot_discrepancy
from skinbayes.plot.effects import plot_effects, plot_residuals
from skinbayes.plot.levels import plot_levels
from skinbayes.plot.people import plot_people
from skinbayes.plot.predictive import plot_predictive, plot_prior_predictive
from skinbayes.plot.prior_posterior import plot_prior_posterior
from skinbayes.plot.profile import plot_profile
from skinbayes.plot.trace import plot_trace

__all__ = [
    "plot_corner",
    "plot_data",
    "plot_discrepancy",
    "plot_effects",
    "plot_levels",
    "plot_people",
    "plot_predictive",
    "plot_prior_posterior",
    "plot_prior_predictive",
    "plot_profile",
    "plot_residuals",
    "plot_trace",
]
