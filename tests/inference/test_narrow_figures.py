"""Figures at the width of a journal's column: every text inside, no text on another."""

from __future__ import annotations

from functools import cache
from itertools import combinations

import numpy as np
import pytest
from grouped_fit import finger_fit
from made_up_fit import made_up_fit
from matplotlib.figure import Figure
from matplotlib.text import Text

import skinbayes.plot
from skinbayes.errors import InputError
from skinbayes.fit import Fit, sample
from skinbayes.fit.predicted import observed_values
from skinbayes.plot import plot_corner, plot_data, plot_levels, plot_profile
from skinbayes.plot.surface import plot_measured_spectrum, plot_surface
from skinbayes.problem import load_problem
from skinbayes.topography import LineProfile, MeasuredSurface, SurfaceCollection, analyse_surface

PLOTS = [getattr(skinbayes.plot, name) for name in skinbayes.plot.__all__]


@cache
def water() -> Fit:
    """Eleven rows of different loads."""
    return sample(load_problem("finger-water"), max_steps=100, ensembles=2, walkers=32)


def overlaps(figure: Figure) -> list[str]:
    """Texts that overlap by more than the slack of their boxes, or leave the figure."""
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()  # type: ignore[attr-defined]
    shown = [
        (text.get_text(), text.get_window_extent(renderer))
        for text in _texts(figure)
        if text.get_visible() and text.get_text().strip()
    ]
    page = figure.bbox
    found = [
        f"{text!r} leaves the figure"
        for text, box in shown
        if box.x0 < page.x0 - 1 or box.x1 > page.x1 + 1 or box.y0 < page.y0 - 1 or box.y1 > page.y1 + 1
    ]
    for (one, a), (two, b) in combinations(shown, 2):
        wide = min(a.x1, b.x1) - max(a.x0, b.x0)
        high = min(a.y1, b.y1) - max(a.y0, b.y0)
        if wide > 2.0 and high > 2.0:
            found.append(f"{one!r} on {two!r}")
    return found


def _texts(figure: Figure) -> list[Text]:
    """All texts that are drawn: an axis also holds labels of ticks outside its limits."""
    panels = [inner for ax in figure.axes if ax.axison for inner in (ax, *ax.child_axes)]
    axes = [axis for ax in panels for axis in (ax.xaxis, ax.yaxis)]
    ticks = [tick for axis in axes for tick in axis._update_ticks()]  # type: ignore[attr-defined]
    names = [text for axis in axes for text in (axis.label, axis.offsetText)]
    titles = [text for ax in panels for text in (ax.title, ax._left_title)]  # type: ignore[attr-defined]
    keys = [text for legend in figure.legends for text in legend.get_texts()]
    return [*figure.texts, *titles, *names, *keys, *(t.label1 for t in ticks), *(t.label2 for t in ticks)]


@pytest.mark.parametrize("width", [None, "84 mm"])
@pytest.mark.parametrize("plot", PLOTS, ids=lambda plot: plot.__name__)
@pytest.mark.parametrize(("parameters", "rows"), [(1, 1), (3, 4), (7, 12)])
def test_no_text_lies_on_another(plot, parameters: int, rows: int, width: str | None) -> None:
    figure = plot(made_up_fit(parameters, rows, converged=parameters != 3), width=width)
    if width:
        assert figure.get_size_inches()[0] == pytest.approx(84 / 25.4)
    assert overlaps(figure) == []


@pytest.mark.parametrize("width", [None, "84 mm"])
def test_nor_in_figures_of_a_real_fit(width: str | None) -> None:
    fit = water()
    for draw in (fit.plot_data, fit.plot_profile, fit.plot_residuals, fit.plot_corner, fit.plot_predictive):
        assert overlaps(draw(width=width)) == [], draw.__name__


@pytest.mark.parametrize("width", [None, "84 mm"])
def test_nor_in_figures_of_groups(width: str | None) -> None:
    fit = finger_fit()
    for draw in (fit.plot_data, fit.plot_levels, fit.plot_effects, fit.plot_profile, fit.plot_corner):
        assert overlaps(draw(width=width)) == [], draw.__name__


def test_values_are_in_the_narrow_corner_plot_too() -> None:
    fit = made_up_fit(7, 3)
    wide, narrow = plot_corner(fit), plot_corner(fit, "84 mm")
    median, interval = wide.axes[0].get_title(loc="left").split("\n")[1:]
    (listed,) = [text.get_text() for text in narrow.texts if "90 %:" in text.get_text()]
    assert len(listed.splitlines()) == 7 and f"{median}  (90 %: {interval})" in listed.splitlines()[0]
    assert not narrow.axes[0].get_title(loc="left")


@pytest.mark.parametrize("width", ["84", "5 mm", "2 m", "3 kPa"])
def test_a_width_is_a_length_that_fits_a_page(width: str) -> None:
    with pytest.raises(InputError, match="width"):
        plot_corner(made_up_fit(2, 2), width)


def test_curves_and_groups_that_are_not_there_are_errors_that_name_those_that_are() -> None:
    with pytest.raises(InputError, match="no curve against 'loads'; it has curves against wavevector"):
        plot_profile(water(), "loads")
    with pytest.raises(InputError, match="'persons' is no grouping column"):
        plot_levels(water(), "persons")


def test_data_are_drawn_against_the_condition_that_varies() -> None:
    fit = water()
    assert fit.problem is not None
    ax = plot_data(fit).axes[0]
    assert "normal force" in ax.get_xlabel() and "[N]" in ax.get_xlabel()
    # each person has a pad of another size, but friction at small contact area does not know it: one curve
    drawn = next(c for c in ax.containers if c.get_label() == "measured")
    force = fit.problem.conditions.values["normal_force"]
    np.testing.assert_allclose(drawn.lines[0].get_xdata(), force, rtol=1e-12)
    np.testing.assert_allclose(drawn.lines[0].get_ydata(), observed_values(fit), rtol=1e-12)
    median = next(line for line in ax.lines if line.get_label() == "median")
    middle = np.median(fit.problem.predict(fit.theta())["friction_coefficient"], axis=0)
    np.testing.assert_allclose(median.get_ydata(), np.median(middle), rtol=0.02)
    bars = next(c for c in ax.collections if c.get_label() == "90 % of measurements")
    expected = fit.groups["posterior_predictive"]["friction_coefficient"].values.reshape(-1, len(force))
    ends = np.array([segment[:, 1] for segment in bars.get_segments()])
    order = np.argsort(force)
    np.testing.assert_allclose(ends, np.quantile(expected, [0.05, 0.95], axis=0).T[order], rtol=1e-9)


def test_data_without_a_condition_that_varies_are_drawn_row_by_row() -> None:
    assert plot_data(made_up_fit(2, 4)).axes[0].get_yticklabels()[0].get_text() == "1"


@pytest.mark.parametrize("pixel", [1e-8, 1e-6, 1e-3])
@pytest.mark.parametrize("band", [None, (0.3, 1.5)])
def test_figures_of_lines_and_their_spectra(pixel: float, band: tuple[float, float] | None) -> None:
    walk = np.cumsum(np.random.default_rng(1).standard_normal(6000)) * pixel
    asked = band and (band[0] / pixel, band[1] / pixel)
    found = analyse_surface(LineProfile(walk, pixel_size=pixel), source="a line", band=asked)
    one = MeasuredSurface(name="a line", kind="text", spectrum=found.spectrum, analysis=found)
    for width in ("84 mm", None):
        for figure in (plot_surface(one, width), plot_measured_spectrum(SurfaceCollection([one]), width)):
            assert overlaps(figure) == []
