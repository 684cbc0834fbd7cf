"""Calibration in pictures: ranks, their distribution with its band, coverage, recovery, and probabilities of models."""

from __future__ import annotations

from collections.abc import Callable
from math import ceil
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import bdtrik, betaincinv

from skinbayes.plot.style import (
    BLUE,
    GREY,
    SMALL,
    VERMILLION,
    inches,
    look,
    new_figure,
    set_title,
    shortened,
)
from skinbayes.plot.symbols import figure_text, spoken_name
from skinbayes.statistics.uniformity import uniform_band
from skinbayes.vocabulary import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skinbayes.calibration.odds import ModelOdds
    from skinbayes.calibration.ranks import RankedTruths
    from skinbayes.plot.style import Sampled

RANKS = 200
"""Number of different ranks."""

LEVELS = (0.5, 0.9)
SHADE = "#E3E7EB"
FEWEST_IN_A_BAR = 10


def plot_ranks(calibration: RankedTruths, width: str | None = None) -> Figure:
    """Histograms of the ranks of the truth among posterior draws.

    Parameters
    ----------
    calibration : from :func:`skinbayes.calibrate`
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each parameter and one for the likelihood; of uniform ranks 99 % of the bars end in the shaded band.
    """

    def draw(ax: Axes, name: str) -> None:
        ranks = calibration.ranks(name)
        bars = next(n for n in (20, 10, 5, 1) if len(ranks) >= n * FEWEST_IN_A_BAR or n == 1)
        ax.axhspan(*_expected_counts(len(ranks), 1 / bars), color=SHADE, linewidth=0)
        ax.axhline(len(ranks) / bars, color=GREY, linewidth=0.8)
        ax.hist(ranks + 0.5, bins=bars, range=(0, RANKS), color=BLUE, rwidth=0.92, alpha=0.85)
        ax.set_xlim(0, RANKS)
        ax.set_xticks([0, RANKS // 2, RANKS])
        ax.locator_params(axis="y", nbins=3, integer=True)

    label = "rank of the truth among 199 posterior draws"
    return _panels(calibration, calibration.quantities, draw, label, "Ranks: level if calibrated", width)


def plot_ecdf(calibration: RankedTruths, width: str | None = None) -> Figure:
    """Distribution of the ranks less the uniform one.

    Parameters
    ----------
    calibration : from :func:`skinbayes.calibrate`
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each parameter and one for the likelihood; the whole curve of uniform ranks keeps to the shaded band with
        probability 95 %. Where fits did not converge, a dashed curve leaves them out.
    """

    def draw(ax: Axes, name: str) -> None:
        levels, sure = calibration.levels(name), calibration.levels(name, converged_only=True)
        if not len(levels):
            return
        band = uniform_band(len(levels))
        low, high = band.limits()
        ax.fill_between(band.places, low, high, step="mid", color=SHADE, linewidth=0)
        ax.axhline(0.0, color=GREY, linewidth=0.8)
        found = band.difference(levels)
        out = bool(((found < low - 1e-9) | (found > high + 1e-9)).any())
        ax.step(band.places, found, where="mid", color=VERMILLION if out else BLUE)
        if 0 < len(sure) < len(levels):
            ax.step(
                band.places,
                uniform_band(len(sure)).difference(sure),
                where="mid",
                color=GREY,
                ls="--",
                lw=1.0,
            )
        ax.set_xlim(0, 1)
        ax.set_xticks([0, 0.5, 1], ["0", "0.5", "1"])
        ax.locator_params(axis="y", nbins=4)

    label = "posterior probability of less than the truth"
    title = "Their distribution less the uniform one"
    return _panels(calibration, calibration.quantities, draw, label, title, width)


def plot_coverage(calibration: RankedTruths, width: str | None = None) -> Figure:
    """Share of central intervals that hold the truth.

    Parameters
    ----------
    calibration : from :func:`skinbayes.calibrate`
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        A dot for each parameter, one panel each for 50 % and 90 % intervals; bars are binomial 95 % intervals.
    """
    size = inches(width)
    names = [shortened(spoken_name(name), 34 if size >= SMALL else 22) for name in calibration.names]
    places = np.arange(len(names))
    with look(size):
        figure = new_figure(
            size, 0.24 * len(names) + 1.35, left=0.2 + (0.075 if size >= SMALL else 0.062) * max(map(len, names)), right=0.2,
            bottom=0.6, top=0.7, between=(0.25, 0.2), panels=(len(LEVELS), 1),
        )  # fmt: skip
        axes = figure.subplots(1, len(LEVELS), sharey=True, squeeze=False)[0]
        for ax, level in zip(axes, LEVELS, strict=True):
            counts = [calibration.coverage(name, level)[:2] for name in calibration.names]
            share = np.array([hits / max(count, 1) for hits, count in counts])
            ends = np.array([_interval(hits, count) for hits, count in counts])
            ax.axvline(level, color=GREY, linewidth=0.8)
            ax.errorbar(
                share,
                places,
                xerr=np.abs(ends.T - share),
                fmt="o",
                color=BLUE,
                markersize=4.5,
                elinewidth=1.2,
            )
            ax.set_title(f"{level:.0%} intervals".replace("%", " %"), pad=4.0)
            ax.set_ylim(len(names) - 0.5, -0.5)
            ax.set_yticks(places, names)
            ax.locator_params(axis="x", nbins=4)
            ax.grid(axis="x")
        _below(figure, "share that holds the truth", size)
        set_title(figure, calibration, "Do intervals hold the truth?")
    return figure


def plot_recovery(calibration: RankedTruths, width: str | None = None) -> Figure:
    """How far the posterior mean is from the truth, and how much the data said.

    Parameters
    ----------
    calibration : from :func:`skinbayes.calibrate`
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each parameter, a dot for each simulation: z-score against contraction, 0 where the data say nothing and 1
        where they say everything.
    """

    def draw(ax: Axes, name: str) -> None:
        scores, contraction = calibration.recovery(name)
        ax.axhline(0.0, color=GREY, linewidth=0.8)
        ax.plot(
            np.clip(contraction, -0.5, 1.0),
            np.clip(scores, -5, 5),
            "o",
            color=BLUE,
            markersize=2.0,
            alpha=0.5,
        )
        ax.set_xlim(-0.55, 1.05)
        ax.set_ylim(-5.2, 5.2)
        ax.set_xticks([-0.5, 0, 0.5, 1], ["−0.5", "0", "0.5", "1"])
        ax.set_yticks([-4, 0, 4])

    title = "Error over posterior width, against what was learnt"
    return _panels(calibration, calibration.names, draw, "contraction of the variance", title, width)


def plot_odds(calibration: ModelOdds, width: str | None = None) -> Figure:
    """Predicted probability of a model against the frequency with which it is right.

    Parameters
    ----------
    calibration : from :func:`skinbayes.calibrate`
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        A dot for each bin of the probability, with its binomial 95 % interval and the number of simulations in it.
    """
    size = inches(width)
    with look(size):
        figure = new_figure(size, min(size, 4.2), left=0.75, bottom=0.65, top=0.55)
        ax = figure.subplots()
        ax.plot([0, 1], [0, 1], color=GREY, linewidth=0.8)
        for probability, frequency, hits, count, _ in calibration.bins():
            low, high = _interval(hits, count)
            ax.errorbar(
                probability, frequency, yerr=[[frequency - low], [high - frequency]], fmt="o", color=BLUE, markersize=4.5,
                elinewidth=1.2,
            )  # fmt: skip
            side = 1 if probability < 0.5 else -1
            ax.annotate(
                str(count), (probability, frequency), (6 * side, 0), textcoords="offset points",
                ha="left" if side > 0 else "right", va="center", fontsize=8.0,
            )  # fmt: skip
        ax.set_xlim(-0.03, 1.03)
        ax.set_ylim(-0.03, 1.03)
        second = shortened(calibration.models[1], 30 if size >= SMALL else 20)
        ax.set_xlabel(f"probability of {second}")
        ax.set_ylabel("frequency with which it made the data")
        set_title(figure, calibration, "Are models right as often as they say?")
    return figure


def _panels(
    what: Sampled,
    names: tuple[str, ...],
    draw: Callable[[Axes, str], None],
    label: str,
    title: str,
    width: str | None,
) -> Figure:
    """One panel for each quantity."""
    size = inches(width)
    columns = min(len(names), 3 if size >= SMALL else 2)
    rows = ceil(len(names) / columns)
    letters = int((13.5 if size >= SMALL else 15.5) * (size - 0.6) / columns)
    with look(size):
        figure = new_figure(
            size, 1.45 * rows + 0.85, left=0.55, right=0.2, bottom=0.6, top=0.7, between=(0.5, 0.6),
            panels=(columns, rows),
        )  # fmt: skip
        axes = figure.subplots(rows, columns, squeeze=False).reshape(-1)
        for ax, name in zip(axes, names, strict=False):
            draw(ax, name)
            ax.set_title(_brief(name, letters), pad=4.0, fontsize=9.0 if size >= SMALL else 7.5)
        for ax in axes[len(names) :]:
            ax.set_axis_off()
        _below(figure, label, size)
        set_title(figure, what, title)
    return figure


def _brief(label: str, letters: int) -> str:
    """A parameter as people say it, by its symbol where that is too long."""
    spoken, (name, _, level) = spoken_name(label), label.partition("[")
    known = QUANTITIES.get(name)
    if len(spoken) <= letters or known is None or not known.symbol:
        return figure_text(shortened(spoken, letters))
    return figure_text(f"{known.symbol} ({level.removesuffix(']')})" if level else known.symbol)


def _below(figure: Figure, label: str, size: float) -> None:
    figure.supxlabel(label, y=0.12 / figure.get_size_inches()[1], fontsize=10.0 if size >= SMALL else 8.0)


def _expected_counts(count: int, share: float) -> tuple[float, float]:
    """Between which 99 % of binomial counts lie."""
    low, high = (np.ceil(bdtrik(p, count, share)) for p in (0.005, 0.995))
    return float(low), float(high)


def _interval(hits: int, count: int) -> tuple[float, float]:
    """Binomial 95 % interval of Clopper and Pearson."""
    low = betaincinv(hits, count - hits + 1, 0.025) if hits else 0.0
    high = betaincinv(hits + 1, count - hits, 0.975) if hits < count else 1.0
    return float(low), float(high)
