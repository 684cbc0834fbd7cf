"""Each person of a population: values with their intervals, in order."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.plot.scales import scale_for, ticks
from skinbayes.plot.style import (
    GONE,
    GREY,
    POSTERIOR,
    inches,
    look,
    new_figure,
    sentence_figure,
    set_title,
    shortened,
)
from skinbayes.plot.symbols import figure_text, spoken_name
from skinbayes.vocabulary import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.fit.asked_fit import AskedFit

TITLE = "People one by one"

MOST_SHOWN = 60
"""Levels drawn of each parameter: of more those with the lowest and the highest medians."""

LONGEST = 24


def plot_people(fit: AskedFit, width: str | None = None) -> Figure:
    """Draw the value of each person, of each parameter that has a population.

    Parameters
    ----------
    fit : any fit
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each parameter, its levels ordered by median: bars hold 50 % and 90 % of the posterior. The band is the
        median of the population with its 90 % interval. A sentence if no parameter has a population.
    """
    if fit.problem is None:
        return sentence_figure(fit, TITLE, GONE, width)
    findings = fit.population_findings
    if not findings:
        return sentence_figure(fit, TITLE, "No parameter of the model has a population.", width)
    counts = [min(len(finding.people), MOST_SHOWN) for finding in findings]
    size, between = inches(width), 0.75
    longest = max(len(shortened(p.level, LONGEST)) for finding in findings for p in finding.people)
    with look(size):
        figure = new_figure(
            size, 1.25 + between * (len(findings) - 1) + 0.2 * sum(counts), left=0.35 + 0.075 * longest, bottom=0.7, top=0.5,
            between=(0.0, between), panels=(1, len(findings)),
        )  # fmt: skip
        grid = figure.add_gridspec(len(findings), 1, height_ratios=counts)
        grid.update(hspace=between / (0.2 * float(np.mean(counts))))
        for place, finding in enumerate(findings):
            ax = figure.add_subplot(grid[place])
            people = sorted(finding.people, key=lambda person: person.value[1])
            if len(people) > MOST_SHOWN:
                people = [*people[: MOST_SHOWN // 2], *people[-MOST_SHOWN // 2 :]]
            name = f"{finding.by}_{finding.parameter}"
            everybody = np.array([value for person in people for value in person.value])
            scale = scale_for(finding.unit, everybody)
            ax.axvspan(*scale.shown(np.array(finding.median[::2])), color=GREY, alpha=0.2, linewidth=0.0)
            ax.axvline(float(scale.shown(np.array([finding.median[1]]))[0]), color=GREY, linewidth=1.0)
            for i, person in enumerate(people):
                inner = np.quantile(fit.draws(f"{name}[{person.level}]"), [0.25, 0.75])
                outer, middle = (
                    scale.shown(np.array(person.value[::2])),
                    scale.shown(np.array([person.value[1]])),
                )
                ax.plot(outer, [i, i], color=POSTERIOR, linewidth=1.2, alpha=0.6, solid_capstyle="butt")
                ax.plot(scale.shown(inner), [i, i], color=POSTERIOR, linewidth=3.6, solid_capstyle="butt")
                ax.plot(middle, [i], "o", color="white", markeredgecolor=POSTERIOR, markersize=3.6)
            if scale.logarithmic:
                ax.set_xscale("log")
            low, high = scale.shown(np.array([everybody.min(), everybody.max()]))
            ticks(ax.xaxis, scale, float(low), float(high), most=5)
            ax.set_yticks(
                range(len(people)), [shortened(p.level, LONGEST).replace("$", r"\$") for p in people]
            )
            ax.set_ylim(-0.7, len(people) - 0.3)
            symbol = figure_text(QUANTITIES[finding.parameter].symbol)
            ax.set_xlabel(scale.label(f"{spoken_name(finding.parameter)} {symbol}"))
        set_title(figure, fit, TITLE)
    return figure
