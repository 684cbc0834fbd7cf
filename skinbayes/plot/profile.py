"""Curves of the forward model with their posterior bands: the contact area against magnification (Fig. 6)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.plot.numbers import quantity
from skinbayes.plot.predictive import row_names
from skinbayes.plot.scales import scale_for, ticks
from skinbayes.plot.style import SERIES, WIDTH, look, new_figure, sentence_figure, set_title
from skinbayes.plot.symbols import figure_text, spoken_name
from skinbayes.vocabulary import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skinbayes.fit import Fit
    from skinbayes.forward import Profile
    from skinbayes.problem import Problem

DRAWS = 300
"""Posterior draws that a band is made of."""

MOST_CURVES = 4

SAME = 1e-3
"""Rows whose curves agree within this relative difference share one curve."""


@dataclass(frozen=True)
class Band:
    """One curve: its label, the abscissa ``(K,)`` and the 5, 50 and 95 % quantiles of the ordinate ``(3, K)``, SI."""

    label: str
    abscissa: FloatArray
    quantiles: FloatArray


def plot_profile(fit: Fit) -> Figure:
    """Draw the curves that the forward model offers, with posterior median and 5–95 % band.

    Parameters
    ----------
    fit : a fit with its problem

    Returns
    -------
    matplotlib.figure.Figure
        One panel for each curve of the forward model, one colour for each group of rows that share it; where more than
        four differ, those that end lowest, in the middle and highest. A sentence if there is nothing to draw.
    """
    title = "Curves of the model"
    if fit.problem is None:
        return sentence_figure(
            fit, title, "The model or its data are gone, so that no curve can be computed from this result."
        )
    profiles = fit.problem.forward.profiles
    if not profiles:
        return sentence_figure(fit, title, f"The forward model '{fit.problem.forward.name}' has no curves.")
    with look():
        figure = new_figure(
            WIDTH, 4.0 * len(profiles), left=0.8, right=0.3, bottom=0.55, top=0.9, between=(0.0, 1.4),
            panels=(1, len(profiles)),
        )  # fmt: skip

        axes = figure.subplots(len(profiles), 1, squeeze=False)[:, 0]
        for ax, profile in zip(axes, profiles, strict=True):
            _panel(ax, fit.problem, profile, profile_bands(fit, fit.problem, profile))
        set_title(figure, fit, profiles[0].title if len(profiles) == 1 else title)
    return figure


def profile_bands(fit: Fit, problem: Problem, profile: Profile) -> list[Band]:
    """The curves of one profile, at most four, each for a group of rows that share it."""
    theta = fit.theta()
    middle = np.median(theta, axis=0, keepdims=True)
    theta = theta[:: max(1, len(theta) // DRAWS)]
    groups = _groups(problem, profile, middle)
    shared = len(groups) == 1
    names, bands = row_names(fit), []
    for position, rows in groups:
        abscissa, curves = problem.profile(profile, theta, rows[0])
        label = position + _row_text(names, rows, shared) + _pressure(problem, middle, rows)
        bands.append(Band(label, abscissa, np.nanquantile(curves, [0.05, 0.5, 0.95], axis=0)))
    return bands


def _groups(problem: Problem, profile: Profile, middle: FloatArray) -> list[tuple[str, list[int]]]:
    """Rows that share a curve at the posterior median, and a word for each group."""
    groups: list[tuple[FloatArray, list[int]]] = []
    alike: dict[tuple[float, ...], list[int]] = {}
    differing = [
        values[0]
        for name, values in problem.inputs(middle).items()
        if values.shape[-1] > 1 and name != profile.abscissa
    ]
    for row in range(problem.conditions.n_rows):
        same = alike.setdefault(tuple(float(values[row]) for values in differing), [])
        same.append(row)
    # rows of the same inputs share a curve without it being computed again, and others may still do
    for alike_rows in alike.values():
        grid, curve = problem.profile(profile, middle, alike_rows[0])
        both = np.concatenate([grid, curve[0]])
        for known, rows in groups:
            if np.allclose(known, both, rtol=SAME, atol=0.0, equal_nan=True):
                rows[:] = sorted([*rows, *alike_rows])
                break
        else:
            groups.append((both, list(alike_rows)))
    if len(groups) <= MOST_CURVES:
        return [("", rows) for _, rows in groups]
    groups.sort(key=lambda group: group[0][-1])
    chosen = (("lowest: ", groups[0]), ("middle: ", groups[len(groups) // 2]), ("highest: ", groups[-1]))
    return [(word, rows) for word, (_, rows) in chosen]


def _row_text(names: list[str], rows: list[int], shared: bool) -> str:
    if shared:
        return "all rows" if len(names) > 1 else names[0]
    found = [names[row] for row in rows]
    return ", ".join(found) if len(found) <= 3 else f"{found[0]} and {len(found) - 1} more"


def _pressure(problem: Problem, middle: FloatArray, rows: list[int]) -> str:
    pressure = problem.derived(middle).get("nominal_pressure")
    if pressure is None:
        return ""
    value = float(pressure[0, rows[0] if pressure.shape[-1] == problem.conditions.n_rows else 0])
    return f" (p0 = {quantity(value, 'Pa', 2)})"


def _panel(ax: Axes, problem: Problem, profile: Profile, bands: list[Band]) -> None:
    x_quantity, y_quantity = QUANTITIES[profile.abscissa], QUANTITIES[profile.ordinate]
    x_scale = scale_for(x_quantity.unit, *(band.abscissa for band in bands))
    y_scale = scale_for(y_quantity.unit, *(band.quantiles.ravel() for band in bands))
    for band, colour in zip(bands, SERIES, strict=False):
        x, (low, median, high) = x_scale.shown(band.abscissa), y_scale.shown(band.quantiles)
        ax.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0.0)
        ax.plot(x, median, color=colour, label=figure_text(band.label))
    for scale, setter, axis, limits in (
        (x_scale, ax.set_xscale, ax.xaxis, ax.set_xlim),
        (y_scale, ax.set_yscale, ax.yaxis, ax.set_ylim),
    ):
        if scale.logarithmic:
            setter("log")
        if axis is ax.xaxis:
            low = min(float(x_scale.shown(band.abscissa).min()) for band in bands)
            high = max(float(x_scale.shown(band.abscissa).max()) for band in bands)
            limits(low, high)
        else:
            low, high = ax.get_ylim()
        ticks(axis, scale, low, high, most=6, between=True)
    ax.grid(color="#E6E6E6", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.set_xlabel(x_scale.label(f"{x_quantity.name} {figure_text(x_quantity.symbol)}"))
    ax.set_ylabel(y_scale.label(f"{spoken_name(profile.ordinate)} {figure_text(y_quantity.symbol)}"))
    ax.legend(loc="best")
    smallest = _smallest_wavevector(problem, profile)
    if smallest is not None:
        _magnification_axis(ax, smallest / x_scale.factor)


def _smallest_wavevector(problem: Problem, profile: Profile) -> float | None:
    """q0 if the abscissa is a wavevector and all rows and draws share its smallest value."""
    if profile.abscissa != "wavevector":
        return None
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
