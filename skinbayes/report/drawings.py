"""Which figures a page has, with the texts that say how to read them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from skinbayes.fit.predicted import observables
from skinbayes.phrases import and_list, plural
from skinbayes.plot import (
    plot_corner,
    plot_data,
    plot_discrepancy,
    plot_effects,
    plot_levels,
    plot_people,
    plot_predictive,
    plot_prior_posterior,
    plot_profile,
    plot_residuals,
    plot_trace,
)
from skinbayes.plot.discrepancy import curves_of
from skinbayes.plot.profile import profile_abscissas
from skinbayes.plot.rows import group_columns, row_predictions, telling_columns, varying
from skinbayes.plot.symbols import spoken_name

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.fit import Fit
    from skinbayes.problem import Problem

FEWEST_ROWS = 8
"""With fewer rows there are no figures of residuals."""

CURVES = {
    "wavevector": (
        "Contact area against magnification",
        "Zooming in from left to right, ever finer roughness is resolved and less of the nominal area turns out to touch. "
        "Friction is made in what is left at the right edge.",
    ),
    "time": (
        "Film, contact area and friction in time",
        "One experiment from top to bottom: the water film dries, bridges of water pull the skin into contact before it is gone, "
        "and friction follows the contact area.",
    ),
    "film_thickness": (
        "The skin against the water film",
        "Drying runs from right to left: a thick film floods the skin, a thinner one pulls it together.",
    ),
    "relative_humidity": (
        "The skin in humid air",
        "From left to right the air becomes more humid and the layer softer. Bridges of water pull soft skin together, until in "
        "saturated air they flood the gap and let go.",
    ),
    "speed_viscosity_product": (
        "Stribeck curve",
        "From left to right the liquid carries more of the load: friction falls as contact is lost, and rises again by the shear "
        "of the liquid.",
    ),
}
"""Heading of curves and a sentence on how to read them, by their abscissa."""


@dataclass(frozen=True)
class Drawing:
    """A figure to be drawn.

    Attributes
    ----------
    key : identifier on the page
    draw : makes the figure of a fit; ``width`` is its width as text, None for that of a screen
    heading, alternative, caption : texts
    """

    key: str
    draw: Callable[..., Figure]
    heading: str
    alternative: str
    caption: str


def drawings(fit: Fit) -> list[Drawing]:
    """All figures of a page, in its order: data first, the sampler last."""
    problem = fit.problem
    return [
        *_data(fit),
        _predictive(fit),
        *([DISCREPANCY] if curves_of(fit) else []),
        *([PEOPLE] if problem is not None and problem.populations is not None else []),
        *(
            []
            if problem is None
            else [*_by_level(fit, problem), *_curves(problem), *_residuals(fit, problem)]
        ),
        *sampled(),
        *([] if "weighted_posterior" in fit.groups else [TRACE]),  # draws with weights have no order in time
    ]


def _data(fit: Fit) -> Iterator[Drawing]:
    """Data against the condition that varies; where nothing varies, data row by row come first."""
    found = varying(fit)
    if found is None:
        return
    name = spoken_name(found[0])
    yield Drawing(
        "data", plot_data, f"Data and model against {name}",
        f"Measured values against {name}, over what the fitted model predicts.",
        "Dots are measured. Lines are medians of the model, bands around them hold 90 % of the posterior (a darker one half). "
        "Pale bars, where there are any, hold 90 % of what repeated measurements would give: nine dots in ten should lie on "
        f"them, on both sides all along the axis.{_apart(fit, found[0])}",
    )  # fmt: skip


def _apart(fit: Fit, abscissa: str) -> str:
    """What the figure of the data shows beside theory and data."""
    curves = curves_of(fit)
    said = ""
    if len(curves) == 1 and curves[0].column == abscissa:
        said += " Curves contain what the theory misses; dashed lines are the theory alone."
    if columns := group_columns(fit):
        many = and_list([plural(column) for column in columns])
        said += f" Small open dots, where there is a curve, are the data without the effects of {many}."
    return said


def _predictive(fit: Fit) -> Drawing:
    names = [spoken_name(name) for name in observables(fit)]
    panels = "" if len(names) == 1 else f" One panel for each of what was measured: {', '.join(names)}."
    return Drawing(
        "predictive", plot_predictive, "Data against the fitted model",
        "Observed values with the ranges that the fitted model predicts for each row of data.",
        "Dots are the measured values. The bars are what the fitted model would give if the experiment were repeated, "
        "scatter included: dark for the middle half, light for 90 %. A model that fits has about nine dots in ten on its "
        f"bars.{panels}",
    )  # fmt: skip


DISCREPANCY = Drawing(
    "discrepancy", plot_discrepancy, "What the theory misses",
    "Smooth curves by which the data differ from the theory, with their ranges.",
    "The line is the median of what the theory misses, bands hold half and 90 % of the posterior. Its shape counts: a height "
    "that all of the curve shares cannot be told from the parameters, and is what makes the bands wide.",
)  # fmt: skip


PEOPLE = Drawing(
    "people", plot_people, "People one by one",
    "Values of each person with their ranges, in order, over the median of the population.",
    "Dots are medians, bars hold half and 90 % of the posterior of each person's value. The grey line is the median of the "
    "population, the band its 90 % interval: people of few data lie nearer to it.",
)  # fmt: skip


TRACE = Drawing(
    "trace", plot_trace, "Draws against time",
    "Draws of each parameter in the order in which they were made, one independent chain beside the other.",
    "A check of the sampler: all chains should fill the same band from beginning to end, without drift or steps. "
    "Dashed lines: 5 %, 50 % and 95 % of all draws.",
)  # fmt: skip


def sampled() -> list[Drawing]:
    """Figures of the parameters."""
    return [
        Drawing(
            "prior-posterior", plot_prior_posterior, "Prior against posterior",
            "Density of each parameter before and after the data.",
            "Dashed grey is what was assumed before the data, blue what is known after them. Where both agree the data said "
            "nothing, and the panel says 'not updated'.",
        ),
        Drawing(
            "corner", plot_corner, "Parameters and pairs",
            "Posterior density of each parameter and of each pair of parameters.",
            "Diagonal: each parameter with its median and 90 % interval. Below it: pairs; the inner contour holds half of the "
            "probability, the outer one 90 %. A thin slanted ridge means that only a combination of the two is known.",
        ),
    ]  # fmt: skip


def _curves(problem: Problem) -> Iterator[Drawing]:
    """Curves of the forward model, a figure for each abscissa."""
    for abscissa in profile_abscissas(problem):
        heading, reading = CURVES.get(abscissa, (f"Curves against {spoken_name(abscissa)}", ""))
        seen = {profile.ordinate for profile in problem.profiles if profile.abscissa == abscissa}
        dots = (
            " Scatter is not in them, so that dots may lie outside."
            if seen & set(problem.observables)
            else ""
        )
        yield Drawing(
            f"profile-{abscissa}".replace("_", "-"), partial(plot_profile, abscissa=abscissa), heading,
            "Curves of the forward model with their posterior bands, and the data that lie on them.",
            f"{reading} Lines are posterior medians, bands hold 90 % of the probability (a darker one half).{dots}".strip(),
        )  # fmt: skip


def _by_level(fit: Fit, problem: Problem) -> Iterator[Drawing]:
    """Data and model by person, liquid and other groups."""
    if problem.conditions.n_rows < FEWEST_ROWS or len(observables(fit)) > 1 or not telling_columns(fit):
        return
    effects, predictions = group_columns(fit), row_predictions(fit, problem)
    for column in telling_columns(fit) if varying(fit) else []:
        one = spoken_name(column)
        own = f" and the effect of this {one}, written above it," if column in effects else ""
        yield Drawing(
            f"by-{column}".replace("_", "-"), partial(plot_levels, column=column, predictions=predictions),
            f"Data and model, {one} by {one}",
            f"Small panels, one for each {one}, with measured points over the range of the fitted model.",
            f"Each panel shows one {one}: dots are measured, grey dots are all other {plural(column)}. Blue is what the fitted "
            f"model says for the conditions of these rows{own} without scatter: the line is the median, dark holds half, light "
            "90 % of the probability. It has corners where conditions change from row to row. A thin line is the curve for "
            "typical conditions without effects, the same in all panels.",
        )  # fmt: skip
    if telling_columns(fit):
        bars = (
            ", which the bar beside them shows (dark: half, light: 90 % of the probability)."
            if effects
            else "."
        )
        yield Drawing(
            "effects", partial(plot_effects, predictions=predictions),
            "Effects of groups and residuals" if effects else "Residuals by group",
            "For each level of each grouping column, its effect with its range, and observed over predicted for its rows.",
            f"Dots are rows: what was observed over what the model predicts without the effect in question{bars} "
            "A level whose dots lie to one side is one that the model does not explain.",
        )  # fmt: skip


def _residuals(fit: Fit, problem: Problem) -> Iterator[Drawing]:
    """Residuals against the conditions."""
    if problem.conditions.n_rows < FEWEST_ROWS or not varying(fit):
        return
    known = ", effects of groups taken off" if group_columns(fit) else ""
    yield Drawing(
        "residuals", partial(plot_residuals, predictions=row_predictions(fit, problem)),
        "What is left between data and model", "Observed over predicted for each row against the conditions.",
        f"Dots are rows: observed over predicted{known}. Bars, where there are any, are medians of a sixth of the rows. Where "
        "the model is right, dots lie evenly about the dashed line; a slope or a bend is something it misses.",
    )  # fmt: skip
