"""Figures of a fit: right labels, right numbers, nothing left behind."""

from __future__ import annotations

import io
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from made_up_fit import NAMES, made_up_fit
from matplotlib.figure import Figure
from scipy import stats

import skinbayes.plot
from skinbayes.fit import Fit, sample
from skinbayes.fit.predicted import observed_values
from skinbayes.phrases import number
from skinbayes.plot import (
    plot_corner,
    plot_predictive,
    plot_prior_posterior,
    plot_prior_predictive,
    plot_profile,
    plot_trace,
)
from skinbayes.plot.numbers import quantity
from skinbayes.plot.prior_posterior import smooth_density
from skinbayes.plot.scales import round_values
from skinbayes.plot.symbols import figure_text
from skinbayes.problem import load_problem

PLOTS = [getattr(skinbayes.plot, name) for name in skinbayes.plot.__all__]


@cache
def short_fit(model: str) -> Fit:
    """A real fit, sampled much too briefly."""
    return sample(load_problem(model), max_steps=100, ensembles=2, walkers=32, importance=False)


def texts(figure: Figure) -> str:
    found = [*figure.texts] + [a.title for a in figure.axes] + [a._left_title for a in figure.axes]
    found += [label for a in figure.axes for label in (a.xaxis.label, a.yaxis.label)]
    return "\n".join(text.get_text() for text in found if text is not None)


def title(figure: Figure) -> str:
    return figure.get_suptitle()


@pytest.mark.parametrize("plot", PLOTS, ids=lambda plot: plot.__name__)
@pytest.mark.parametrize(("parameters", "rows"), [(1, 1), (3, 4), (15, 165)])
def test_every_figure_can_be_drawn(plot, parameters: int, rows: int) -> None:
    figure = plot(made_up_fit(parameters, rows))
    assert isinstance(figure, Figure)
    buffer = io.BytesIO()
    figure.savefig(buffer, dpi=40)
    assert buffer.getvalue().startswith(b"\x89PNG")
    assert max(figure.get_size_inches()) <= 20.0


@pytest.mark.parametrize("plot", PLOTS, ids=lambda plot: plot.__name__)
def test_a_fit_that_has_not_converged_says_so_in_every_title(plot) -> None:
    fit = made_up_fit(2, 3, converged=False)
    assert "NOT CONVERGED" in title(plot(fit))
    assert "CONVERGED" not in title(plot(made_up_fit(2, 3)))


def test_no_figure_stays_open_and_settings_come_back() -> None:
    import matplotlib
    import matplotlib.pyplot

    before = dict(matplotlib.rcParams)
    for plot in PLOTS:
        plot(made_up_fit(2, 3))
    assert matplotlib.pyplot.get_fignums() == []
    assert dict(matplotlib.rcParams) == before


@pytest.mark.parametrize("plot", [plot_corner, plot_trace, plot_prior_posterior])
def test_parameters_are_labelled_with_symbol_and_unit(plot) -> None:
    said = texts(plot(made_up_fit(5, 2))).replace("\n[", " [")
    for label in ("σ_{f}}$ [MPa]", "E_{0}}$ [MPa]", "d [µm]", "h_{rms}}$ [µm]"):
        assert label in said


def test_corner_titles_give_the_quantiles_of_the_summary() -> None:
    fit = made_up_fit(4, 2)
    figure = plot_corner(fit)
    diagonal = [figure.axes[i * (i + 3) // 2].get_title(loc="left").split("\n") for i in range(4)]
    for (_, median, interval), (_, row) in zip(diagonal, fit.summary().iterrows(), strict=True):
        assert median == quantity(row["median"], row["unit"])
        low, high = (float(part.split()[0]) for part in interval.split(" – "))
        factor = row["median"] / float(median.split()[0])
        assert low * factor == pytest.approx(row["q05"], rel=0.01)
        assert high * factor == pytest.approx(row["q95"], rel=0.01)


def test_corner_lines_stand_at_the_quantiles() -> None:
    fit = made_up_fit(1, 1)
    lines = [line.get_xdata()[0] for line in plot_corner(fit).axes[0].lines if line.get_linestyle() == "--"]
    expected = np.quantile(fit.draws(NAMES[0]), [0.05, 0.5, 0.95]) / 1e6
    np.testing.assert_allclose(np.sort(lines), expected, rtol=1e-9)


def test_corner_leaves_out_what_does_not_vary() -> None:
    figure = plot_corner(made_up_fit(4, 2, constant=("yield_stress",)))
    assert len(figure.axes) == 6
    assert "constant, not drawn: σ_Y" in texts(figure)
    assert "nothing to draw" in texts(plot_corner(made_up_fit(2, 2, constant=NAMES[:2])))


def test_prior_against_posterior_says_what_was_not_updated() -> None:
    figure = plot_prior_posterior(made_up_fit(4, 2, not_updated=("yield_stress",)))
    assert [ax.get_title() for ax in figure.axes] == ["updated", "updated", "not updated", "updated"]


@pytest.mark.parametrize("logarithmic", [False, True])
def test_smooth_density_of_a_normal(logarithmic: bool) -> None:
    draws = stats.norm(2.0, 0.4).ppf((np.arange(20000) + 0.5) / 20000)
    x, density = smooth_density(np.exp(draws) if logarithmic else draws, logarithmic)
    coordinate = np.log(x) if logarithmic else x
    # the kernel widens a normal by 1 %: its peak is that much lower
    np.testing.assert_allclose(density, stats.norm(2.0, 0.4).pdf(coordinate), atol=0.02)
    assert np.trapezoid(density, coordinate) == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize(
    ("plot", "group"),
    [(plot_predictive, "posterior_predictive"), (plot_prior_predictive, "prior_predictive")],
)
def test_predictive_bars_are_the_quantiles_and_dots_the_data(plot, group: str) -> None:
    fit = made_up_fit(2, 4)
    ax = plot(fit).axes[0]
    draws = fit.groups[group]["friction_coefficient"].values.reshape(-1, 4)
    wide, narrow = (np.array(bars.get_segments())[:, :, 0] for bars in ax.collections[:2])
    np.testing.assert_allclose(wide, np.quantile(draws, [0.05, 0.95], axis=0).T)
    np.testing.assert_allclose(narrow, np.quantile(draws, [0.25, 0.75], axis=0).T)
    dots = next(line for line in ax.lines if line.get_label() == "observed")
    np.testing.assert_allclose(dots.get_xdata(), observed_values(fit))
    assert [text.get_text() for text in ax.get_yticklabels()] == ["1", "2", "3", "4"]


def test_many_rows_are_ordered_and_have_no_names() -> None:
    fit = made_up_fit(2, 165)
    ax = plot_predictive(fit).axes[0]
    dots = next(line for line in ax.lines if line.get_label() == "observed")
    medians = np.median(fit.groups["posterior_predictive"]["friction_coefficient"].values, axis=(0, 1))
    np.testing.assert_allclose(dots.get_ydata(), observed_values(fit)[np.argsort(medians)])
    assert "165 rows" in ax.get_xlabel()
    assert len(ax.get_xticklabels()) < 15


def test_trace_has_one_line_for_each_ensemble() -> None:
    fit = made_up_fit(3, 2)
    figure = plot_trace(fit)
    assert len(figure.axes) == 3
    for ax, label in zip(figure.axes, fit.names, strict=True):
        curves = [line for line in ax.lines if len(line.get_ydata()) > 2]
        assert len(curves) == 4
        shown = np.concatenate([line.get_ydata() for line in curves])
        assert set(np.round(shown, 9)) <= set(np.round(fit.draws(label) / 1e6, 9))  # pressures, shown in MPa


def test_profile_ends_at_the_contact_area_of_the_rows() -> None:
    fit = short_fit("forearm-glass")
    figure = plot_profile(fit)
    ax = figure.axes[0]
    assert "wavevector" in ax.get_xlabel() and "[1/m]" in ax.get_xlabel()
    assert "relative contact area" in ax.get_ylabel()
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    curves = {line.get_label().split(" (")[0]: line for line in ax.lines}
    assert set(curves) == {"dry", "wet"}
    for state, curve in curves.items():
        # computed another way: the derived quantity of the same draws, at the end of the band of roughness
        expected = np.median(fit.draws(f"relative_contact_area[{state}]"))
        assert curve.get_ydata()[-1] == pytest.approx(expected, rel=1e-6)
        assert curve.get_ydata()[0] == pytest.approx(1.0, abs=1e-6)
    upper = ax.child_axes[0]
    figure.canvas.draw()
    assert "magnification" in upper.get_xlabel()
    np.testing.assert_allclose(upper.get_xlim(), [1.0, 1e6], rtol=1e-9)


def test_profile_of_many_rows_shows_lowest_middle_and_highest() -> None:
    labels = [line.get_label() for line in plot_profile(short_fit("finger-water")).axes[0].lines]
    # the load over the pad area is smallest for ID09 and largest for ID07
    assert [label.split(":")[0] for label in labels] == ["lowest", "middle", "highest"]
    assert "ID09" in labels[0] and "ID07" in labels[2]


def test_profile_without_problem_is_a_sentence() -> None:
    fit = replace(short_fit("forearm-glass"), problem=None)
    assert "nothing can be computed" in texts(plot_profile(fit)).replace("\n", " ")


@pytest.mark.parametrize("text", ["$x", "a$b$c", r"\frac{", "σ_f/(E0 s)", "x_$y$", "E0 $", "^_", "$$"])
def test_any_text_can_stand_in_a_figure(text: str) -> None:
    figure = plot_predictive(made_up_fit(1, 2, row_names=[text, "other"]))
    figure.axes[0].set_xlabel(figure_text(text))
    figure.canvas.draw()


def test_numbers_keep_three_digits() -> None:
    rng = np.random.default_rng(2)
    raised = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
    for value in 10.0 ** rng.uniform(-12, 12, 500) * rng.choice([-1.0, 1.0], 500):
        mantissa, _, power = number(value).partition(" × 10")
        if mantissa.startswith("10") and set(mantissa[2:]) & set("⁻⁰¹²³⁴⁵⁶⁷⁸⁹"):
            mantissa, power = "1", mantissa[2:]
        read = float(mantissa) * 10.0 ** int(power.translate(raised) or 0)
        assert read == pytest.approx(value, rel=5.001e-3)
        assert "e" not in number(value)


def test_round_values_lie_inside_and_are_few() -> None:
    rng = np.random.default_rng(3)
    for low, ratio in zip(10.0 ** rng.uniform(-9, 9, 200), 10.0 ** rng.uniform(0.6, 9, 200), strict=True):
        values = round_values(low, low * ratio)
        assert 1 <= len(values) <= 5
        assert values == sorted(values)
        assert values[0] >= 0.99 * low and values[-1] <= 1.01 * low * ratio
