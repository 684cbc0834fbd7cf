"""Curves of the forward model with their posterior bands and the data: contact area against magnification, drying in time."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.fit.predicted import observables, observed_values
from skinbayes.plot.profile_bands import Band, profile_bands
from skinbayes.plot.rows import abscissa_of_rows
from skinbayes.plot.scales import Scale, axis_scale, scale_for, ticks
from skinbayes.plot.style import (
    GONE,
    OBSERVED,
    POSTERIOR,
    SERIES,
    inches,
    letters_of_key,
    look,
    new_figure,
    sentence_figure,
    set_title,
    width_of,
    wrapped,
)
from skinbayes.plot.symbols import axis_name, figure_text
from skinbayes.vocabulary import STANDARD_DEVIATION_SUFFIX

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skinbayes.fit.result import FitResult
    from skinbayes.forward import Profile
    from skinbayes.problem import Problem

TITLES = {
    "time": "Drying in time",
    "film_thickness": "Skin against the water film",
    "relative_humidity": "Skin in humid air",
}
"""Titles of figures of several curves by their abscissa."""


def plot_profile(fit: FitResult, abscissa: str | None = None, width: str | None = None) -> Figure:
    """Draw the curves that the forward model offers, with posterior median and bands, and the data that lie on them.

    Parameters
    ----------
    fit : a fit with its problem
    abscissa : quantity on the common axis, one of :func:`profile_abscissas`; the first if omitted
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each curve over that abscissa, one below the other. One colour for each group of rows that share a curve;
        where more than four differ, those that end lowest, in the middle and highest. Bands hold 90 %, for a single curve
        also 50 % of the posterior; scatter and effects of groups are not in them. Dots are the data, with their standard
        deviations where these are known. A sentence if there is nothing to draw.

    Raises
    ------
    InputError
        The forward model has no curve against ``abscissa``.
    """
    title = "Curves of the model"
    if fit.problem is None:
        return sentence_figure(fit, title, GONE, width)
    offered = profile_abscissas(fit.problem)
    if abscissa is not None and abscissa not in offered:
        known = f"it has curves against {', '.join(offered)}" if offered else "it has no curves"
        raise InputError(
            f"abscissa: the forward model '{fit.problem.forward.name}' has no curve against {abscissa!r}; {known}"
        )
    if not offered:
        return sentence_figure(
            fit, title, f"The forward model '{fit.problem.forward.name}' has no curves.", width
        )
    abscissa = abscissa or offered[0]
    profiles = [profile for profile in fit.problem.profiles if profile.abscissa == abscissa]
    drawn = [(profile, profile_bands(fit, fit.problem, profile)) for profile in profiles]
    size = inches(width)
    lines = max(len(bands) for _, bands in drawn)
    # long names of rows take several lines of a narrow key
    rows = max(sum(1 + len(band.label) // letters_of_key(size) for band in bands) for _, bands in drawn)
    zoom = None if abscissa != "wavevector" else _smallest_wavevector(fit.problem)
    key = 0.22 * (rows if lines > 1 else 1) + 0.1
    height, top = (3.1 if len(drawn) == 1 else 2.0), 0.45 if zoom is None else 0.9
    with look(size):
        figure = new_figure(
            size, height * len(drawn) + 0.15 * (len(drawn) - 1) + top + key + 0.5, left=0.85, right=0.3,
            bottom=key + 0.5, top=top, between=(0.0, 0.15), panels=(1, len(drawn)),
        )  # fmt: skip
        axes = figure.subplots(len(drawn), 1, squeeze=False, sharex=True)[:, 0]
        ends = [
            _panel(ax, fit, fit.problem, profile, bands)
            for ax, (profile, bands) in zip(axes, drawn, strict=True)
        ]
        shown, low, high = ends[0][0], min(end[1] for end in ends), max(end[2] for end in ends)
        axes[-1].set_xlim(low, high)
        ticks(axes[-1].xaxis, shown, low, high, most=6, between=True)
        axes[-1].set_xlabel(shown.label(axis_name(abscissa)[1]))
        if zoom is not None:
            _magnification_axis(axes[0], zoom / shown.factor)
        _key(figure, axes, lines)
        set_title(figure, fit, drawn[0][0].title if len(drawn) == 1 else TITLES.get(abscissa, title))
    return figure


def profile_abscissas(problem: Problem) -> list[str]:
    """Quantities against which the forward model offers curves, in its order."""
    return list(dict.fromkeys(profile.abscissa for profile in problem.profiles))


def _panel(
    ax: Axes, fit: FitResult, problem: Problem, profile: Profile, bands: list[Band]
) -> tuple[Scale, float, float]:
    """Draw one curve and its data; return the scale of the abscissa and the ends of what was drawn."""
    x_unit, _ = axis_name(profile.abscissa)
    y_unit, y_name = axis_name(profile.ordinate)
    x_scale = axis_scale(profile.abscissa, scale_for(x_unit, *(band.abscissa for band in bands)))
    y_scale = scale_for(y_unit, *(band.quantiles.ravel() for band in bands))
    if profile.abscissa == "time":  # a series is read by its heights
        y_scale = replace(y_scale, logarithmic=False)
    colours = [POSTERIOR] if len(bands) == 1 else list(SERIES)
    for band, colour in zip(bands, colours, strict=False):
        x, (low, q25, median, q75, high) = x_scale.shown(band.abscissa), y_scale.shown(band.quantiles)
        single = len(bands) == 1
        ax.fill_between(
            x, low, high, color=colour, alpha=0.2, linewidth=0.0, label="5–95 %" if single else None
        )
        if single:
            ax.fill_between(x, q25, q75, color=colour, alpha=0.35, linewidth=0.0, label="25–75 %")
        ax.plot(x, median, color=colour, label="median" if single else wrapped(ax, band.label))
    measured = _data(ax, fit, problem, profile, bands, x_scale, y_scale)
    for scale, setter in ((x_scale, ax.set_xscale), (y_scale, ax.set_yscale)):
        if scale.logarithmic:
            setter("log")
    if profile.abscissa == "time" and all(float(np.nanmin(band.quantiles)) >= 0.0 for band in bands):
        ax.set_ylim(bottom=0.0)
    ticks(ax.yaxis, y_scale, *ax.get_ylim(), most=6, between=True)
    ax.grid()
    label = y_scale.label(y_name)
    ax.set_ylabel(label if len(label) < 7 * width_of(ax) else label.replace(" $", "\n$", 1))
    return x_scale, *_ends(x_scale, bands, measured)


def _ends(scale: Scale, bands: list[Band], measured: FloatArray) -> tuple[float, float]:
    """Ends of the common axis: those of the curves, and some room beyond data that lie outside."""
    curves = scale.shown(np.concatenate([band.abscissa for band in bands]))
    low, high = float(curves.min()), float(curves.max())
    if not len(measured):
        return low, high
    room = (high / low) ** 0.02 if scale.logarithmic else 0.02 * (high - low)
    first, last = float(scale.shown(measured.min())), float(scale.shown(measured.max()))
    if scale.logarithmic:
        return min(low, first / room), max(high, last * room)
    return (low if first >= low else first - room), (high if last <= high else last + room)


def _data(
    ax: Axes,
    fit: FitResult,
    problem: Problem,
    profile: Profile,
    bands: list[Band],
    x_scale: Scale,
    y_scale: Scale,
) -> FloatArray:
    """Draw the data that lie on the curve, each in the colour of its curve if that is drawn; return their abscissa, SI."""
    along = abscissa_of_rows(problem, profile, np.median(fit.theta(), axis=0))
    if along is None or profile.ordinate not in observables(fit):
        return np.empty(0)
    values = observed_values(fit).reshape(len(observables(fit)), -1)[observables(fit).index(profile.ordinate)]
    known = fit.groups["constant_data"]

    def spread(name: str, scale: Scale) -> FloatArray | None:
        column = name + STANDARD_DEVIATION_SUFFIX
        return scale.shown(known[column].values) if column in known else None

    drawn = [(band.rows, colour) for band, colour in zip(bands, SERIES, strict=False)]
    if len(bands) == 1 or sum(len(rows) for rows, _ in drawn) < len(values):
        drawn = [(list(range(len(values))), OBSERVED)]
    errors = (spread(profile.ordinate, y_scale), spread(profile.abscissa, x_scale))
    for i, (rows, colour) in enumerate(drawn):
        y_error, x_error = (None if error is None else error[rows] for error in errors)
        ax.errorbar(
            x_scale.shown(along[rows]), y_scale.shown(values[rows]), y_error, x_error, fmt="o", color=colour,
            markersize=4.0, markeredgecolor="white", markeredgewidth=0.5, elinewidth=0.9, zorder=3,
            label="measured" if i == 0 else None,
        )  # fmt: skip
    return along


def _key(figure: Figure, axes: Any, lines: int) -> None:
    """The key below the panels, from the first that has each entry."""
    entries = {
        text: handle for ax in axes for handle, text in zip(*ax.get_legend_handles_labels(), strict=True)
    }
    order = ["measured", "median", "25–75 %", "5–95 %"] if lines == 1 else list(entries)
    texts = [text for text in order if text in entries]
    figure.legend(
        [entries[text] for text in texts], texts, loc="lower center", ncols=len(texts) if lines == 1 else 1,
        bbox_to_anchor=(0.5, 0.0), borderaxespad=0.2, labelspacing=0.25,
    )  # fmt: skip


def _smallest_wavevector(problem: Problem) -> float | None:
    """q0 if all rows and draws share it."""
    if problem.tables.spectrum is not None:
        value = np.atleast_1d(problem.tables.spectrum.wavevector_min)
    elif any(parameter.name == "wavevector_min" for parameter in problem.free):
        return None
    else:
        value = problem.inputs(problem.prior_medians()[np.newaxis])["wavevector_min"]
    return float(value.flat[0]) if np.ptp(value) == 0.0 else None


def _magnification_axis(ax: Axes, smallest: float) -> None:
    def zoom(wavevector: Any) -> FloatArray:
        return np.asarray(wavevector, dtype=float) / smallest

    def back(magnification: Any) -> FloatArray:
        return np.asarray(magnification, dtype=float) * smallest

    upper = ax.secondary_xaxis("top", functions=(zoom, back))
    low, high = ax.get_xlim()
    scale = scale_for("1", np.array([low, high]) / smallest)
    ticks(upper.xaxis, scale, low / smallest, high / smallest, most=6, between=True)
    upper.set_xlabel(f"magnification {figure_text('ζ = q/q0')}")
