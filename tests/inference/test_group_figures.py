"""Figures of grouped data and of drying: bands, points and residuals at the numbers they should have."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from grouped_fit import finger_fit
from made_up_fit import made_up_fit
from matplotlib.figure import Figure

from skinbayes.errors import InputError
from skinbayes.fit import Fit, sample
from skinbayes.plot import plot_effects, plot_levels, plot_profile, plot_residuals
from skinbayes.plot.profile import profile_abscissas
from skinbayes.plot.rows import group_columns, row_predictions, telling_columns, varying
from skinbayes.problem import load_problem


def line(ax, label: str):
    return next(found for found in ax.lines if found.get_label() == label)


def words(figure: Figure) -> str:
    return " ".join(text.get_text() for text in figure.texts).replace("\n", " ")


def test_panels_by_person_show_the_persons_rows_and_the_model_with_the_persons_effect() -> None:
    fit = finger_fit()
    problem = fit.problem
    assert problem is not None
    figure = plot_levels(fit, "person")
    assert len([ax for ax in figure.axes if ax.axison]) == 11
    people = problem.conditions.labels["person"]
    product = problem.conditions.values["viscosity"] * problem.conditions.values["sliding_speed"]
    ax = next(ax for ax in figure.axes if ax.get_title(loc="left").startswith("ID07"))
    order = np.flatnonzero(people == "ID07")[np.argsort(product[people == "ID07"])]
    points = line(ax, "measured")
    # the axis is in mN/m
    np.testing.assert_allclose(points.get_xdata(), product[order] * 1e3, rtol=1e-12)
    np.testing.assert_allclose(points.get_ydata(), problem.observations[0].values[order], rtol=1e-12)
    assert len(line(ax, "all others").get_xdata()) == 165 - 15
    # the median line, computed here from the draws themselves
    theta, effect = (
        fit.theta(),
        fit.groups["posterior"]["person_effect"].sel(person_level="ID07").values.ravel(),
    )
    step = max(1, len(theta) // 400)
    predicted = problem.predict(theta[::step])["friction_coefficient"][:, order]
    expected = np.median(predicted * np.exp(effect[::step, np.newaxis]), axis=0)
    median = next(
        found for found in ax.lines if len(found.get_xdata()) == 15 and found.get_marker() == "None"
    )
    np.testing.assert_allclose(median.get_ydata(), expected, rtol=1e-9)


def test_liquids_are_ordered_along_the_axis_and_people_by_name() -> None:
    fit = finger_fit()
    assert fit.problem is not None
    values, liquid = fit.problem.conditions.values, fit.problem.conditions.labels["liquid"]
    product = values["viscosity"] * values["sliding_speed"]
    names = [ax.get_title(loc="left").split("   ")[0] for ax in plot_levels(fit, "liquid").axes if ax.axison]
    medians = [float(np.median(product[liquid == name])) for name in names]
    assert len(names) == 15 and medians == sorted(medians)
    assert (names[0], names[-1]) == ("water", "honey + 6 g starch")
    people = [ax.get_title(loc="left")[:4] for ax in plot_levels(fit, "person").axes if ax.axison]
    assert people == sorted(people)


def test_effects_are_bars_at_their_quantiles_in_order() -> None:
    fit = finger_fit()
    figure = plot_effects(fit)
    assert [ax.get_title(loc="left") for ax in figure.axes] == ["by person", "by liquid"]
    for ax, column in zip(figure.axes, ("person", "liquid"), strict=True):
        draws = fit.groups["posterior"][f"{column}_effect"]
        names = [text.get_text() for text in ax.get_yticklabels()]
        wide = np.array(ax.collections[0].get_segments())[:, :, 0]
        for name, (low, high) in zip(names, wide, strict=True):
            own = draws.sel({f"{column}_level": name}).values
            np.testing.assert_allclose([low, high], np.quantile(own, [0.05, 0.95]), rtol=1e-9)
        medians = [float(draws.sel({f"{column}_level": name}).median()) for name in names]
        assert medians == sorted(medians)


def test_dots_beside_an_effect_scatter_about_it_by_the_noise() -> None:
    fit = finger_fit()
    assert fit.problem is not None
    predictions = row_predictions(fit, fit.problem)
    observed = fit.problem.observations[0].values
    left = predictions.residuals("friction_coefficient", observed, "person", "liquid")
    without = predictions.residuals("friction_coefficient", observed, "person")
    # taking off all effects leaves the noise
    noise = float(np.median(fit.draws("noise_scale")))
    assert np.std(left) == pytest.approx(noise, rel=0.15)
    liquids = fit.problem.conditions.labels["liquid"]
    effect = fit.groups["posterior"]["liquid_effect"]
    for name in ("water", "honey"):
        middle = float(effect.sel(liquid_level=name).median())
        # eleven rows: the mean is known to a third of the noise, and pulled a little to zero
        assert np.mean(without[liquids == name]) == pytest.approx(middle, abs=noise)


def test_residuals_stand_against_abscissa_and_load() -> None:
    figure = plot_residuals(finger_fit())
    labels = [ax.get_xlabel() for ax in figure.axes]
    assert labels[0].startswith("speed times viscosity") and any("normal force" in label for label in labels)
    assert all("observed\nover predicted" in ax.get_ylabel() for ax in figure.axes)


def test_abscissa_is_speed_times_viscosity_of_each_row() -> None:
    problem = load_problem("finger-descriptive")
    found = varying(Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 20)))
    assert found is not None and found[0] == "speed_viscosity_product"
    values = problem.conditions.values
    np.testing.assert_array_equal(found[1], values["viscosity"] * values["sliding_speed"])
    # without a curve to lie on, data are drawn against the condition that varies most
    plain = load_problem("finger-water")
    found = varying(Fit.from_draws(plain, plain.draw_prior(np.random.default_rng(1), 20)))
    assert found is not None and found[0] == "normal_force"


def test_profile_shows_all_points_on_the_curves() -> None:
    fit = finger_fit()
    ax = plot_profile(fit).axes[0]
    points = ax.containers[0].lines[0]
    assert len(points.get_xdata()) == 165
    labels = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert [label.split(":")[0] for label in labels] == ["lowest", "middle", "highest", "measured"]


@pytest.mark.parametrize("plot", [plot_levels, plot_effects, plot_residuals])
def test_what_cannot_be_drawn_is_said(plot) -> None:
    assert "gone" in words(plot(made_up_fit(2, 3)))
    assert "gone" in words(plot(replace(finger_fit(), problem=None)))


def test_unknown_column_and_abscissa_are_said() -> None:
    with pytest.raises(
        InputError, match="'state' is no grouping column; these data can be drawn by person, liquid"
    ):
        plot_levels(finger_fit(), "state")
    with pytest.raises(
        InputError, match="no curve against 'time'; it has curves against speed_viscosity_product"
    ):
        plot_profile(finger_fit(), "time")


def test_columns_that_tell_rows_apart() -> None:
    assert group_columns(finger_fit()) == ["person", "liquid"] == telling_columns(finger_fit())
    assert telling_columns(made_up_fit(2, 3)) == []


# -- drying ----------------------------------------------------------------------------------------------------------

SERIES = """
title = "A series that was simulated"
forward = "drying"
[data]
file = "series.csv"
observable = "friction_coefficient"
[surface]
name = "paper_reference"
[parameters]
frictional_shear_stress = { lognormal = ["15 MPa", 0.3] }
young_modulus_layer = "7 MPa"
young_modulus_layer_dry = "1 GPa"
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
yield_stress = "50 MPa"
nominal_pressure = "6.83 kPa"
surface_tension = "72 mN/m"
contact_angle_skin = "80 deg"
contact_angle_counterface = "0 deg"
wetting_time = "30 s"
initial_film = { lognormal = ["90 um", 0.2] }
evaporation_rate = "1.743e-7 m/s"
[noise]
family = "lognormal"
noise_scale = { half_normal = 0.2 }
"""


@cache
def drying_fit(folder: Path) -> Fit:
    """A short series, dry, wet and dry again, sampled much too briefly."""
    times = [5.0, 20.0, 60.0, 150.0, 300.0, 400.0, 480.0, 510.0, 530.0, 600.0, 650.0]
    friction = [0.31, 0.29, 1.4, 1.5, 1.4, 1.45, 1.6, 2.3, 2.1, 0.3, 0.31]
    rows = "\n".join(f"{t},{mu}" for t, mu in zip(times, friction, strict=True))
    (folder / "series.csv").write_text(f"time [s],friction_coefficient [1]\n{rows}\n", encoding="utf-8")
    (folder / "series.toml").write_text(SERIES, encoding="utf-8")
    return sample(load_problem(folder / "series.toml"), max_steps=100, ensembles=2, walkers=32)


@pytest.fixture(scope="module")
def series(tmp_path_factory: pytest.TempPathFactory) -> Fit:
    return drying_fit(tmp_path_factory.mktemp("drying"))


def test_timeline_of_film_area_and_friction_with_the_points_on_friction(series: Fit) -> None:
    assert series.problem is not None
    assert profile_abscissas(series.problem) == ["time", "film_thickness"]
    axes = plot_profile(series).axes
    assert [ax.get_ylabel().split()[0] for ax in axes] == ["film", "relative", "friction"]
    assert [len(ax.containers) for ax in axes] == [0, 0, 1]
    points = axes[2].containers[0].lines[0]
    np.testing.assert_array_equal(points.get_xdata(), series.problem.conditions.values["time"])
    assert axes[0].get_xlim()[1] >= 650.0 and all(ax.get_yscale() == "linear" for ax in axes)
    # the curve is that of the model itself: at the rows, predicted in another way
    curve = line(axes[2], "median")
    step = max(1, len(series.theta()) // 200)
    rows = np.median(series.problem.predict(series.theta()[::step])["friction_coefficient"], axis=0)
    wet = slice(2, 6)  # where friction is even, so that the grid of times does not matter
    found = np.interp(series.problem.conditions.values["time"][wet], curve.get_xdata(), curve.get_ydata())
    np.testing.assert_allclose(found, rows[wet], rtol=2e-3)


def test_skin_against_the_film_floods_where_the_film_fills_the_gap(series: Fit) -> None:
    figure = plot_profile(series, "film_thickness")
    area, wet, gap, wet_gap = (line(ax, "median") for ax in figure.axes)
    film = area.get_xdata() * 1e-6  # shown in µm
    flooded = gap.get_ydata()[-1] * 1e-6
    thick = film > 1.01 * flooded
    assert 3 < thick.sum() < len(film) - 3
    # all is wet but what touches
    np.testing.assert_allclose(wet.get_ydata()[thick] + area.get_ydata()[thick], 1.0, rtol=1e-5)
    np.testing.assert_allclose(area.get_ydata()[thick], area.get_ydata()[-1], rtol=1e-6)
    # bridges pull: more contact and less gap than flooded, least water in the narrowest gaps
    assert area.get_ydata().max() > 1.3 * area.get_ydata()[-1]
    assert gap.get_ydata().min() < gap.get_ydata()[-1]
    assert (np.diff(wet.get_ydata()) > -1e-9).all()
    # the gaps that hold water are part of all gaps
    assert (wet_gap.get_ydata() * wet.get_ydata() <= gap.get_ydata() * (1.0 + 1e-5)).all()


def test_residuals_of_a_series_stand_against_even_time(series: Fit) -> None:
    (ax,) = plot_residuals(series).axes
    assert ax.get_xlabel() == "time t [s]" and ax.get_xscale() == "linear"
