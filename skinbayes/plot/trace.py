"""Draws against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.plot.scales import scale_for, ticks
from skinbayes.plot.style import SERIES, SMALL, inches, look, new_figure, set_title
from skinbayes.plot.symbols import figure_symbol

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult

POINTS = 250
"""Draws shown of each ensemble."""


def plot_trace(fit: FitResult, width: str | None = None) -> Figure:
    """Draw the draws of each free parameter against time, one ensemble beside the other.

    Parameters
    ----------
    fit : any fit
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One row for each parameter. Ensembles that sampled the same distribution fill the same band (dashed lines: 5 %,
        50 % and 95 % of all draws) from the first draw to the last.
    """
    names = fit.shown_names
    chains, length = (fit.groups["posterior"].sizes[d] for d in ("chain", "draw"))
    step = max(1, length // POINTS)
    shown = len(range(0, length, step))
    size = inches(width)
    with look(size):
        figure = new_figure(
            size,
            1.0 + 1.05 * len(names),
            left=0.95 if size >= SMALL else 0.9,
            top=0.4,
            between=(0.0, 0.2),
            panels=(1, len(names)),
        )
        axes = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
        for ax, label in zip(axes, names, strict=True):
            draws = fit.draws(label)
            scale = scale_for(fit.unit(label), draws)
            values = scale.shown(draws).reshape(chains, length)
            if scale.logarithmic:
                ax.set_yscale("log")
            for chain in range(chains):
                time = chain * shown + np.arange(shown)
                ax.plot(
                    time,
                    values[chain, ::step],
                    color=SERIES[chain % len(SERIES)],
                    linewidth=0.6,
                )
            for level in scale.shown(fit.quantiles(label)):
                ax.axhline(level, color="#1A1A1A", linewidth=0.8, linestyle=(0, (4, 3)))
            for boundary in range(1, chains):
                ax.axvline(boundary * shown - 0.5, color="#B0B0B0", linewidth=0.8)
            low, high = float(values.min()), float(values.max())
            if high > low:
                ticks(ax.yaxis, scale, low, high, most=3)
            ax.set_ylabel(scale.label(figure_symbol(fit, label)).replace(" [", "\n["))
            ax.yaxis.set_label_coords(-(0.57 if size >= SMALL else 0.5) / (size - 1.15), 0.5)
        axes[-1].set_xlim(-0.5, chains * shown - 0.5)
        axes[-1].set_xticks([(i + 0.5) * shown for i in range(chains)], [f"{i + 1}" for i in range(chains)])
        axes[-1].tick_params(axis="x", length=0)
        weighted = "weighted_posterior" in fit.groups
        axes[-1].set_xlabel(
            "draws with weights, resampled in random order" if weighted
            else f"{'ensemble' if 'ensembles' in fit.provenance['sampling'] else 'chain'}; within each, time runs to the right"
        )  # fmt: skip
        set_title(figure, fit, "Draws in random order" if weighted else "Draws against time")
    return figure
