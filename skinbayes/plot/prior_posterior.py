"""Prior against posterior of each parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.plot.scales import Scale, scale_for, ticks
from skinbayes.plot.style import POSTERIOR, PRIOR, inches, key_below, look, new_figure, set_title, width_of
from skinbayes.plot.symbols import figure_symbol
from skinbayes.plot.updates import fit_updates

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult

BINS = 128

VERDICTS = {
    "updated": "updated",
    "moved": "moved, not narrowed",
    "not updated": "not updated",
    "contradicted": "contradicts the prior",
}


def plot_prior_posterior(fit: FitResult, width: str | None = None) -> Figure:
    """Draw the densities of prior and posterior of each free parameter, per unit of its axis.

    Parameters
    ----------
    fit : any fit
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each parameter; its title says whether the data updated it.
    """
    names = fit.shown_names
    updates = fit_updates(fit)
    columns = 1 if len(names) == 1 else 2
    rows = -(-len(names) // columns)
    size = inches(width)
    with look(size):
        figure = new_figure(
            size, 0.6 + 1.5 * rows + 0.3, top=0.6, bottom=0.85, between=(0.3, 0.75), panels=(columns, rows)
        )
        axes = np.atleast_1d(figure.subplots(rows, columns, squeeze=False)).reshape(-1)
        for ax, label in zip(axes, names, strict=False):
            _panel(ax, fit, label, VERDICTS[updates[label].verdict])
        for ax in axes[len(names) :]:
            ax.set_axis_off()
        key_below(figure, axes[0], 2)
        set_title(figure, fit, "Prior against posterior")
    return figure


def _panel(ax: Axes, fit: FitResult, label: str, verdict: str) -> None:
    before, after = fit.draws(label, "prior"), fit.draws(label)
    scale = scale_for(fit.unit(label), before, after)
    for draws, colour, name, width in ((before, PRIOR, "prior", 1.2), (after, POSTERIOR, "posterior", 1.8)):
        if not np.ptp(draws) > 0.0:
            ax.axvline(float(scale.shown(draws)[0]), color=colour, linewidth=width, label=name)
            continue
        x, density = smooth_density(scale.shown(draws), scale.logarithmic)
        ax.fill_between(x, density, color=colour, alpha=0.25, linewidth=0.0)
        ax.plot(
            x, density, color=colour, linewidth=width, label=name, linestyle="--" if name == "prior" else "-"
        )
    _limits(ax, scale, before, after)
    ax.set_xlabel(scale.label(figure_symbol(fit, label)))
    ax.set_yticks([])
    ax.spines["left"].set_visible(False)
    ax.set_ylim(bottom=0.0)
    muted = verdict == "not updated"
    ax.set_title(verdict, color="#6A6A6A" if muted else "#1A1A1A", fontstyle="italic" if muted else "normal")


def _limits(ax: Axes, scale: Scale, *groups: FloatArray) -> None:
    low = min(float(np.quantile(scale.shown(g), 0.002)) for g in groups)
    high = max(float(np.quantile(scale.shown(g), 0.998)) for g in groups)
    if not high > low:
        low, high = low - 0.5 * max(abs(low), 1.0), high + 0.5 * max(abs(high), 1.0)
    if scale.logarithmic:
        ax.set_xscale("log")
    ax.set_xlim(low, high)
    ticks(ax.xaxis, scale, low, high, most=4 if ax.get_position().width * width_of(ax) > 2.0 else 3)


def smooth_density(values: FloatArray, logarithmic: bool) -> tuple[FloatArray, FloatArray]:
    """Density of draws, smoothed; reflecting ends keep the edges of bounded priors sharp.

    Parameters
    ----------
    values : draws, shape ``(S,)``
    logarithmic : give the density per unit of ln(value), as areas on a logarithmic axis show it

    Returns
    -------
    positions and densities, both of shape ``(128,)``; the densities are zero for draws without spread

    Examples
    --------
    >>> x, density = smooth_density(np.linspace(0.0, 2.0, 4001), logarithmic=False)
    >>> print(round(float(density.min()), 2), round(float(density.max()), 2))
    0.5 0.5
    """
    from scipy.ndimage import gaussian_filter1d

    coordinates = np.log(values) if logarithmic else values
    low, high = float(coordinates.min()), float(coordinates.max())
    if not high > low:
        return np.linspace(values[0] - 0.5, values[0] + 0.5, BINS), np.zeros(BINS)
    heights, edges = np.histogram(coordinates, bins=BINS, range=(low, high), density=True)
    quartiles = np.quantile(coordinates, [0.25, 0.75])
    spread = min(float(np.std(coordinates)), float(np.diff(quartiles)[0]) / 1.349) or float(
        np.std(coordinates)
    )
    width = 1.06 * spread * len(coordinates) ** -0.2  # Silverman's rule
    smooth = gaussian_filter1d(heights, max(width / (edges[1] - edges[0]), 0.5), mode="reflect")
    middle = 0.5 * (edges[1:] + edges[:-1])
    return (np.exp(middle) if logarithmic else middle), np.asarray(smooth)
