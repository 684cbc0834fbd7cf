"""How far models are behind the best one, by the evidence and by what they predict for data left out."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from skinbayes.comparison.verdicts import one
from skinbayes.plot.style import BLUE, GREY, SMALL, inches, look, new_figure, set_title, shortened

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.comparison import Comparison


class _Panel(NamedTuple):
    """One measure: how far each model, in the order of the comparison, is behind the best; errors are nan if not known."""

    title: str
    behind: list[float]
    errors: list[float]


def plot_comparison(comparison: Comparison, width: str | None = None) -> Figure:
    """Draw how far each model is behind the best one, a panel for each measure.

    Parameters
    ----------
    comparison : from :func:`skinbayes.compare`
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        Dots are differences of ln densities to the best model, 0 is the best; bars are one standard error either way,
        where it is known.
    """
    size = inches(width)
    panels = _panels(comparison)
    columns = min(len(panels), 2 if size >= SMALL else 1)
    rows = -(-len(panels) // columns)
    models = comparison.models
    names = [shortened(model.name, 26 if size >= SMALL else 16) for model in models]
    letters = max(len(name) for name in names)
    places = np.arange(len(models))
    with look(size):
        each = 0.24 * len(models) + 0.75
        figure = new_figure(
            size, rows * each + 0.95, left=0.15 + (0.075 if size >= SMALL else 0.062) * letters, right=0.2,
            bottom=0.7, top=0.65, between=(0.25, 0.6), panels=(columns, rows),
        )  # fmt: skip
        axes = figure.subplots(rows, columns, sharey=True, squeeze=False).reshape(-1)
        for ax, panel in zip(axes, panels, strict=False):
            ax.axvline(0.0, color=GREY, linewidth=0.8)
            ax.errorbar(
                panel.behind, places, xerr=panel.errors, fmt="o", color=BLUE, markersize=4.5, elinewidth=1.2
            )
            ax.set_title(panel.title, pad=4.0)
            ax.set_ylim(len(models) - 0.5, -0.5)
            ax.set_yticks(places, names)
            ax.locator_params(axis="x", nbins=3)
            ax.grid(axis="x")
        for ax in axes[len(panels) :]:
            ax.set_axis_off()
        figure.supxlabel(
            "difference to the best, nats",
            y=0.12 / figure.get_size_inches()[1],
            fontsize=10.0 if size >= SMALL else 8.0,
        )
        set_title(figure, comparison, "Which model is ahead?")
    return figure


def _panels(comparison: Comparison) -> list[_Panel]:
    models = comparison.models
    panels = []
    if comparison.has_evidence:
        best = comparison.by_evidence[0]
        gaps = [(m.log_evidence or 0.0) - (best.log_evidence or 0.0) for m in models]
        errors = [
            0.0 if m is best else float(np.hypot(m.log_evidence_se or 0.0, best.log_evidence_se or 0.0))
            for m in models
        ]
        panels.append(_Panel("ln evidence", gaps, errors))
    panels.append(
        _Panel(
            "each datum left out",
            [m.elpd_difference for m in models],
            [np.nan if m.elpd_difference_se is None else m.elpd_difference_se for m in models],
        )
    )
    for column in comparison.columns:
        found = [m.left_out[column] for m in models]
        errors = [np.nan if f.difference_se is None else f.difference_se for f in found]
        panels.append(_Panel(f"each {one(column)} left out", [f.difference for f in found], errors))
    return panels
