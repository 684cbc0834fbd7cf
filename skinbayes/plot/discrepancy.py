"""The curves that the theory misses along a column."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import observables
from skinbayes.plot.effects import ratio_axis
from skinbayes.plot.scales import scale_for, ticks
from skinbayes.plot.style import (
    OBSERVED,
    POSTERIOR,
    SERIES,
    inches,
    key_below,
    look,
    new_figure,
    sentence_figure,
    set_title,
)
from skinbayes.plot.symbols import axis_name, figure_text, spoken_name
from skinbayes.statistics.noise_families import noise_family
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult

PREFIX = "discrepancy_along_"


@dataclass(frozen=True)
class Curve:
    """Posterior draws of the curves along one column.

    Attributes
    ----------
    column : the column
    x : values of it, SI, shape ``(n,)``
    levels : levels with curves of their own; one empty name if there is one for all rows
    draws : shape ``(draws, levels, n)``, of ln of the observable where the noise is logarithmic, else in its unit
    """

    column: str
    x: FloatArray
    levels: tuple[str, ...]
    draws: FloatArray


def curves_of(fit: FitResult) -> list[Curve]:
    """The discrepancy along each of its columns; none without one."""
    group = fit.groups.get("discrepancy")
    found = []
    for name, variable in () if group is None else group.data_vars.items():
        if str(name).startswith(PREFIX):
            x = np.asarray(variable[variable.dims[-1]].values, dtype=float)
            several = variable.ndim == 4
            levels = tuple(str(v) for v in variable[variable.dims[2]].values) if several else ("",)
            draws = np.asarray(variable.values, dtype=float).reshape(-1, len(levels), len(x))
            found.append(Curve(str(name).removeprefix(PREFIX), x, levels, draws))
    return found


def plot_discrepancy(fit: FitResult, width: str | None = None) -> Figure:
    """Draw what the theory misses along each column of the discrepancy.

    Parameters
    ----------
    fit : any fit
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each column: the line is the median of the curve, bands hold 50 % and 90 % of the posterior, ticks at the
        bottom are rows of data. Zero, or a factor of 1, is a theory that is right. With curves of their own for each level only
        medians and 90 % bands. A sentence if there is no discrepancy.
    """
    curves = curves_of(fit)
    title = "What the theory misses"
    if not curves:
        return sentence_figure(fit, title, "The model has no discrepancy along a column.", width)
    name = observables(fit)[0]
    noise = fit.provenance.get("noise", {}).get(name)
    logarithmic = noise is not None and noise_family(str(noise)).logarithmic
    size = inches(width)
    with look(size):
        figure = new_figure(
            size, 0.85 + 2.3 * len(curves), left=0.85, bottom=0.85, top=0.5, between=(0.0, 0.62), panels=(1, len(curves))
        )  # fmt: skip
        axes = figure.subplots(len(curves), 1, squeeze=False)[:, 0]
        for ax, curve in zip(axes, curves, strict=True):
            unit, label = axis_name(curve.column)
            even = np.allclose(np.diff(curve.x), (curve.x[-1] - curve.x[0]) / (len(curve.x) - 1))
            scale = replace(scale_for(unit, curve.x), logarithmic=not even)
            x = scale.shown(curve.x)
            low, q25, middle, q75, high = np.quantile(curve.draws, [0.05, 0.25, 0.5, 0.75, 0.95], axis=0)
            for i, level in enumerate(curve.levels):
                colour = POSTERIOR if len(curve.levels) == 1 else SERIES[i % len(SERIES)]
                ax.fill_between(x, low[i], high[i], color=colour, alpha=0.2, linewidth=0.0)
                if len(curve.levels) == 1:
                    ax.fill_between(x, q25[i], q75[i], color=colour, alpha=0.35, linewidth=0.0)
                ax.plot(x, middle[i], color=colour, label=level or "median; bands: 50 and 90 %")
            ax.axhline(0.0, color="#1A1A1A", linewidth=0.8, linestyle=(0, (4, 3)))
            rows = fit.groups["constant_data"].get(curve.column)
            if rows is not None:
                ax.plot(
                    scale.shown(np.asarray(rows.values, dtype=float)), np.full(rows.size, 0.02), "|", color=OBSERVED,
                    transform=ax.get_xaxis_transform(), markersize=7.0, label="rows of data",
                )  # fmt: skip
            if scale.logarithmic:
                ax.set_xscale("log")
            ticks(ax.xaxis, scale, float(x[0]), float(x[-1]), most=5)
            reach = 1.05 * float(np.abs([low, high]).max()) or 1.0
            ax.set_ylim(-reach, reach)
            ratio_axis(ax.yaxis, ax.get_ylim(), logarithmic)
            known = lookup(name)
            symbol = figure_text(known.symbol) if known else spoken_name(name)
            unit_y = "" if logarithmic or known is None or known.unit == "1" else f" [{known.unit}]"
            ax.set_ylabel(f"{symbol}, truth {'over' if logarithmic else 'less'}\ntheory{unit_y}")
            ax.set_xlabel(scale.label(label))
            ax.grid()
        key_below(figure, axes[0], 3)
        set_title(figure, fit, title)
    return figure
