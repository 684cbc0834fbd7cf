"""What many simulations say about the calibration of a model, or of the probabilities of two, with its figures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from skinbayes.calibration.odds import ModelOdds
from skinbayes.calibration.ranks import RankedTruths

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, repr=False)
class Calibration(RankedTruths):
    """What many simulations say about the calibration of one model.

    Attributes
    ----------
    name, names, simulations, seed : see :class:`~skinbayes.calibration.ranks.RankedTruths`

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> problem = sb.build_problem(
    ...     "constant", {"friction_coefficient [1]": [0.4, 0.5]},
    ...     parameters={"typical_friction_coefficient": {"uniform": [0, 1]}},
    ...     noise={"family": "gaussian", "noise_scale": 0.1},
    ... )  # fmt: skip
    >>> result = sb.calibrate(problem, simulations=1, ess=400)
    """

    def plot_ranks(self, width: str | None = None) -> Figure:
        """Histograms of ranks.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            A panel for each quantity, with the band in which 99 % of the counts of uniform ranks lie.

        Examples
        --------
        >>> len(result.plot_ranks().axes)
        2
        """
        from skinbayes.plot.calibration import plot_ranks

        return plot_ranks(self, width)

    def plot_ecdf(self, width: str | None = None) -> Figure:
        """Difference of the distribution of ranks to the uniform one.

        Parameters
        ----------
        width : as :meth:`plot_ranks` takes it

        Returns
        -------
        matplotlib.figure.Figure
            A panel for each quantity, with the band that the whole curve of uniform ranks keeps to with probability 95 %.

        Examples
        --------
        >>> len(result.plot_ecdf().axes)
        2
        """
        from skinbayes.plot.calibration import plot_ecdf

        return plot_ecdf(self, width)

    def plot_coverage(self, width: str | None = None) -> Figure:
        """Share of intervals that hold the truth.

        Parameters
        ----------
        width : as :meth:`plot_ranks` takes it

        Returns
        -------
        matplotlib.figure.Figure
            A dot for each parameter and level, with its binomial 95 % interval.

        Examples
        --------
        >>> len(result.plot_coverage().axes)
        2
        """
        from skinbayes.plot.calibration import plot_coverage

        return plot_coverage(self, width)

    def plot_recovery(self, width: str | None = None) -> Figure:
        """Posterior z-score against contraction.

        Parameters
        ----------
        width : as :meth:`plot_ranks` takes it

        Returns
        -------
        matplotlib.figure.Figure
            A panel for each parameter, a dot for each simulation.

        Examples
        --------
        >>> len(result.plot_recovery().axes)
        1
        """
        from skinbayes.plot.calibration import plot_recovery

        return plot_recovery(self, width)


@dataclass(frozen=True, repr=False)
class OddsCalibration(ModelOdds):
    """What many simulations say about the probabilities of two models of the same data.

    Attributes
    ----------
    models, simulations, seed : see :class:`~skinbayes.calibration.odds.ModelOdds`

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> def model(largest):
    ...     return sb.build_problem(
    ...         "constant", {"friction_coefficient [1]": [0.4, 0.5]}, name=f"up-to-{largest}",
    ...         parameters={"typical_friction_coefficient": {"uniform": [0, largest]}},
    ...         noise={"family": "gaussian", "noise_scale": 0.1},
    ...     )
    >>> result = sb.calibrate(model(1), model(4), simulations=1, ess=400)
    """

    def plot_odds(self, width: str | None = None) -> Figure:
        """Predicted probability against frequency.

        Parameters
        ----------
        width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

        Returns
        -------
        matplotlib.figure.Figure
            A dot for each bin, with its binomial 95 % interval.

        Examples
        --------
        >>> len(result.plot_odds().axes)
        1
        """
        from skinbayes.plot.calibration import plot_odds

        return plot_odds(self, width)
