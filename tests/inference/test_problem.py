"""A model file bound to its data: densities, batches, settings, data that do not fit, fingerprints."""

from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy import integrate, stats
from small_models import FINGER, finger, student, three_parameters, two_parameters, write_model

from skinbayes.errors import InputError
from skinbayes.files.locate import shipped_folder, shipped_names
from skinbayes.problem import Problem, load_problem
from skinbayes.problem.target import PosteriorTarget

FITTED = ("forearm-glass", "forearm-glass-separate", "finger-water")


@pytest.fixture(scope="module", params=FITTED)
def shipped(request: pytest.FixtureRequest) -> Problem:
    return load_problem(request.param)


def draws(problem: Problem, count: int = 64) -> np.ndarray:
    return problem.draw_prior(np.random.default_rng(3), count)


# -- densities -------------------------------------------------------------------------------------------------------


def test_log_likelihood_sums_the_rows(shipped):
    theta = draws(shipped)
    pointwise = shipped.log_likelihood(theta, pointwise=True)
    assert pointwise.shape == (64, len(shipped.observed))
    assert_array_equal(shipped.log_likelihood(theta), pointwise.sum(axis=-1))


def test_rows_of_a_batch_equal_single_vectors_to_the_last_bit(shipped):
    theta = draws(shipped)
    batch = {
        "prior": shipped.log_prior(theta),
        "likelihood": shipped.log_likelihood(theta),
        "posterior": shipped.log_posterior(theta),
        "pointwise": shipped.log_likelihood(theta, pointwise=True),
        "prediction": shipped.predict(theta)["friction_coefficient"],
    }
    for i in (0, 1, 17, 63):
        single = {
            "prior": shipped.log_prior(theta[i]),
            "likelihood": shipped.log_likelihood(theta[i]),
            "posterior": shipped.log_posterior(theta[i]),
            "pointwise": shipped.log_likelihood(theta[i], pointwise=True),
            "prediction": shipped.predict(theta[i])["friction_coefficient"],
        }
        for name, value in single.items():
            assert_array_equal(value, batch[name][i], err_msg=name)
            assert np.ndim(value) == batch[name].ndim - 1
    # any other batch size and memory layout, too
    assert_array_equal(shipped.log_posterior(theta[5:12]), batch["posterior"][5:12])
    assert_array_equal(shipped.log_posterior(np.asfortranarray(theta)), batch["posterior"])
    assert_array_equal(shipped.log_posterior(theta[::-1])[::-1], batch["posterior"])


def test_posterior_is_prior_times_likelihood(shipped):
    theta = draws(shipped)
    assert_allclose(
        shipped.log_posterior(theta), shipped.log_prior(theta) + shipped.log_likelihood(theta), rtol=1e-14
    )


def test_impossible_parameters_have_no_density(shipped):
    theta = np.tile(shipped.prior_medians(), (shipped.dimension + 1, 1))
    for i in range(shipped.dimension):
        theta[i, i] = -1.0
    prior, posterior = shipped.log_prior(theta), shipped.log_posterior(theta)
    assert (prior[:-1] == -np.inf).all() and (posterior[:-1] == -np.inf).all()
    assert np.isfinite(posterior[-1])
    theta[0, 0] = np.nan
    assert shipped.log_posterior(theta)[0] == -np.inf
    assert not np.isnan(shipped.log_likelihood(theta)).any()


def test_prior_transform_is_the_quantile_function(shipped):
    u = np.random.default_rng(1).random((200, shipped.dimension))
    theta = shipped.prior_transform(u)
    assert theta.shape == u.shape
    assert_array_equal(shipped.prior_transform(u[7]), theta[7])
    for i, parameter in enumerate(shipped.free):
        assert_allclose(parameter.prior.cdf(theta[:, i]), u[:, i], atol=1e-12)
    assert_allclose(shipped.prior_transform(np.full(shipped.dimension, 0.5)), shipped.prior_medians())


def test_prior_transform_against_scipy(tmp_path):
    problem = three_parameters(tmp_path)
    u = np.array([[0.05, 0.5, 0.9], [0.3, 0.01, 0.25]])
    expected = np.stack(
        [
            stats.loguniform(0.5e6, 500e6).ppf(u[:, 0]),
            stats.lognorm(0.5, scale=7e6).ppf(u[:, 1]),
            stats.halfnorm(scale=0.5).ppf(u[:, 2]),
        ],
        axis=-1,
    )
    assert_allclose(problem.prior_transform(u), expected, rtol=1e-12)


def test_log_prior_integrates_to_one(tmp_path):
    problem = finger(
        tmp_path,
        'frictional_shear_stress = { uniform = ["1 MPa", "50 MPa"] }\n'
        "young_modulus_layer = { truncated_normal = ['7 MPa', '4 MPa', '1 MPa', '9 MPa'] }",
        'family = "lognormal"\nnoise_scale = 0.2',
    )

    def density(modulus: float, shear: float) -> float:
        return float(np.exp(problem.log_prior([shear * 1e6, modulus * 1e6]))) * 1e12

    # per MPa², and the support is the box
    total, error = integrate.dblquad(density, 1.0, 50.0, 1.0, 9.0)
    assert error < 1e-6
    assert total == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("build", [two_parameters, three_parameters])
def test_posterior_mass_is_the_same_in_both_coordinates(build, tmp_path):
    # the Jacobian of the sampler's coordinates: ∫ p(θ) dθ over the noise scale alone, by quadrature both ways
    problem = build(tmp_path)
    target = problem.target()
    theta = problem.prior_medians()
    i = problem.names.index("noise_scale")

    def in_parameters(scale: float) -> float:
        at = theta.copy()
        at[i] = scale
        return float(np.exp(problem.log_posterior(at) + 40.0))

    at_rest = target.transform.forward(theta[np.newaxis])

    def in_coordinates(z: float) -> float:
        at = at_rest.copy()
        at[0, i] = z
        return float(np.exp(target.log_density(at)[0] + 40.0))

    direct = integrate.quad(in_parameters, 0.0, 20.0, points=[0.1, 0.3, 1.0], limit=400)[0]
    mapped = integrate.quad(in_coordinates, -6.0, 3.0, limit=400)[0]
    # Jacobian of the coordinates that are held still, each by central differences of the map itself
    others = 0.0
    for j in range(problem.dimension):
        if j != i:
            step = np.zeros_like(at_rest)
            step[0, j] = 1e-5
            ends = [target.transform.inverse(at_rest + sign * step)[0, j] for sign in (1, -1)]
            others += float(np.log((ends[0] - ends[1]) / 2e-5))
    assert mapped == pytest.approx(direct * np.exp(others), rel=1e-6)


def test_likelihood_against_hand_written_densities(tmp_path):
    problem = student(tmp_path)
    theta = draws(problem, 5)
    mu = problem.predict(theta)["friction_coefficient"]
    observed = problem.observed
    expected = stats.t.logpdf(observed, 3, loc=mu, scale=theta[:, 2:])
    assert_allclose(problem.log_likelihood(theta, pointwise=True), expected, rtol=1e-11)
    problem = three_parameters(tmp_path)
    expected = stats.lognorm.logpdf(observed, s=theta[:, 2:], scale=mu)
    assert_allclose(problem.log_likelihood(theta, pointwise=True), expected, rtol=1e-11)


def test_a_factor_between_model_and_truth_multiplies_predictions(tmp_path):
    text = 'frictional_shear_stress = "15 MPa"\nyoung_modulus_layer = "7 MPa"'
    noise = 'family = "gaussian"\nnoise_scale = { half_normal = 0.5 }\n'
    plain = finger(tmp_path, text, noise)
    scaled = finger(tmp_path, text, noise + "discrepancy_factor = { lognormal = [0.8, 0.1] }")
    assert scaled.names == ("noise_scale", "discrepancy_factor")
    mu = plain.predict([0.3])["friction_coefficient"]
    assert_allclose(scaled.predict([0.3, 0.8])["friction_coefficient"], 0.8 * mu, rtol=1e-14)
    expected = stats.norm.logpdf(plain.observed, 0.8 * mu, 0.3)
    assert_allclose(scaled.log_likelihood([0.3, 0.8], pointwise=True), expected, rtol=1e-12)


def test_wrong_shapes_are_refused(shipped):
    for theta in (1.0, np.zeros(shipped.dimension + 1), np.zeros((2, 2, shipped.dimension)), np.zeros((0,))):
        with pytest.raises(InputError, match=f"expected \\({shipped.dimension},\\)"):
            shipped.log_posterior(theta)
    assert shipped.log_posterior(np.empty((0, shipped.dimension))).shape == (0,)


def test_simulated_data_scatter_as_the_noise_says(tmp_path):
    problem = two_parameters(tmp_path)
    theta = np.tile([12e6, 0.3], (4000, 1))
    simulated = problem.simulate(theta, np.random.default_rng(2))
    assert simulated.shape == (4000, 11)
    scores = np.log(simulated / problem.predict(theta)["friction_coefficient"]) / 0.3
    assert stats.kstest(scores.ravel(), "norm").pvalue > 1e-3
    again = problem.simulate(theta[:1], np.random.default_rng(2))
    assert again.shape == (1, 11) and problem.simulate(theta[0], np.random.default_rng(2)).shape == (11,)


def test_a_problem_is_frozen_and_travels_to_other_processes(shipped):
    with pytest.raises(FrozenInstanceError):
        shipped.fingerprint = "another"
    theta = draws(shipped, 8)
    copy = pickle.loads(pickle.dumps(shipped))
    assert_array_equal(copy.log_posterior(theta), shipped.log_posterior(theta))
    target = pickle.loads(pickle.dumps(shipped.target()))
    z = target.transform.forward(theta)
    assert_array_equal(target.log_density(z), shipped.target().log_density(z))


def test_starts_are_finite_distinct_and_seeded(shipped):
    target = shipped.target()
    first = target.starts(np.random.default_rng(5), 64)
    assert first.shape == (64, shipped.dimension)
    assert np.isfinite(target.log_density(first)).all()
    assert len(np.unique(first, axis=0)) == 64
    assert_array_equal(first, target.starts(np.random.default_rng(5), 64))
    assert PosteriorTarget(shipped, use_likelihood=False).fingerprint != target.fingerprint


# -- levels of a grouping column -------------------------------------------------------------------------------------


def test_levels_reach_their_rows_only():
    problem = load_problem("forearm-glass")
    assert problem.names[:4] == (
        "frictional_shear_stress", "young_modulus_layer[dry]", "young_modulus_layer[wet]", "yield_stress[dry]",
    )  # fmt: skip
    theta = problem.prior_medians()
    base = problem.predict(theta)["friction_coefficient"]
    for label, row in (("young_modulus_layer[wet]", 1), ("yield_stress[dry]", 0)):
        moved = theta.copy()
        moved[problem.names.index(label)] *= 1.3
        changed = problem.predict(moved)["friction_coefficient"] != base
        assert changed.tolist() == [row == 0, row == 1]


def test_a_set_level_leaves_the_other_free():
    problem = load_problem("forearm-glass", settings={"young_modulus_layer[wet]": "5 MPa"})
    assert "young_modulus_layer[dry]" in problem.names and "young_modulus_layer[wet]" not in problem.names
    whole = load_problem("forearm-glass", settings={"young_modulus_layer": "5 MPa"})
    assert not any(name.startswith("young_modulus_layer") for name in whole.names)
    theta = load_problem("forearm-glass").prior_medians()
    theta[2] = 5e6
    assert_array_equal(
        problem.predict(np.delete(theta, 2))["friction_coefficient"],
        load_problem("forearm-glass").predict(theta)["friction_coefficient"],
    )


@pytest.mark.parametrize(
    ("key", "fragments"),
    [
        ("young_modulus_layer[damp]", ("damp", "dry, wet")),
        ("young_modulus_bulk[dry]", ("young_modulus_bulk", "no levels")),
        ("young_modulus_layr", ("no input 'young_modulus_layr'", "young_modulus_layer")),
        ("noise_scale", ("no input 'noise_scale'",)),
        ("temperature", ("no input 'temperature'",)),
    ],
)
def test_settings_that_fit_nothing(key, fragments):
    with pytest.raises(InputError) as caught:
        load_problem("forearm-glass", settings={key: "5 MPa"})
    for fragment in fragments:
        assert fragment in str(caught.value)


# -- settings --------------------------------------------------------------------------------------------------------


def area(**settings: str) -> np.ndarray:
    problem = load_problem("contact-area", settings=settings)
    return problem.predict(problem.prior_medians())["relative_contact_area"]


def test_units_do_not_matter():
    assert_array_equal(area(yield_stress="50 MPa"), area(yield_stress="0.05 GPa"))
    assert_array_equal(area(layer_thickness="20 um"), area(layer_thickness="0.02 mm"))
    assert_allclose(area(nominal_pressure="6.83 kPa"), area(nominal_pressure="0.0683 bar"), rtol=1e-13)


def test_pressure_is_given_in_one_way_only():
    at_full = {"wavevector": "1e9 1/m"}
    hertz = load_problem("contact-area", settings={"normal_force": "0.5 N", **at_full})
    # mean Hertz pressure of a sphere on a soft flat: p = F/(π a²), a³ = 3FR/(4E*), E* = E/(1 − ν²)
    modulus = 20e3 / 0.75
    expected = 0.5 / (np.pi * (3 * 0.5 * 8e-3 / (4 * modulus)) ** (2 / 3))
    assert hertz.derived(np.empty((1, 0)))["nominal_pressure"].item() == pytest.approx(expected, rel=1e-12)
    assert expected == pytest.approx(6.83e3, rel=2e-3)  # the paper's number
    area_given = load_problem(
        "contact-area", settings={"normal_force": "2 N", "nominal_contact_area": "4 cm^2", **at_full}
    )
    assert area_given.derived(np.empty((1, 0)))["nominal_pressure"].item() == pytest.approx(5e3, rel=1e-12)
    other_radius = load_problem(
        "contact-area", settings={"normal_force": "0.5 N", "sphere_radius": "16 mm", **at_full}
    )
    assert other_radius.derived(np.empty((1, 0)))["nominal_pressure"].item() == pytest.approx(
        expected * 2 ** (-2 / 3), rel=1e-12
    )
    with pytest.raises(InputError, match="exclude each other"):
        load_problem("contact-area", settings={"normal_force": "0.5 N", "nominal_pressure": "1 kPa"})
    with pytest.raises(InputError, match="needs nominal_pressure"):
        load_problem("contact-area", settings={"nominal_contact_area": "4 cm^2"})


def test_a_set_pressure_wins_over_the_loads_of_the_data(tmp_path):
    problem = three_parameters(tmp_path)
    theta = problem.prior_medians()
    path = problem.spec.path
    loads = problem.conditions.values
    pressure = loads["normal_force"] / loads["nominal_contact_area"]
    one = load_problem(path, settings={"nominal_pressure": f"{float(pressure[0])!r} Pa"})
    mu = one.predict(theta)["friction_coefficient"]
    assert len(np.unique(mu)) == 1
    assert mu[0] == pytest.approx(problem.predict(theta)["friction_coefficient"][0], rel=1e-14)


def test_elastic_and_plain_limits():
    assert_allclose(area(yield_stress="inf"), area(yield_stress="1e6 TPa"), rtol=1e-12)
    assert_array_equal(area(area_correction="none"), area(area_correction="1"))
    assert area(area_correction="none")[-1] == pytest.approx(4.20e-4, rel=2e-3)
    for text in ("nan MPa", "-5 MPa", "0 MPa", "50", "50 m", "none"):
        with pytest.raises(InputError, match="yield_stress"):
            area(yield_stress=text)


def test_magnification_is_wavevector_over_the_smallest():
    by_wavevector = load_problem("contact-area", settings={"wavevector": "2e5 1/m"})
    by_magnification = load_problem("contact-area", settings={"magnification": "200"})
    nothing = np.empty(0)
    for name, value in by_wavevector.predict(nothing).items():
        assert_allclose(by_magnification.predict(nothing)[name], value, rtol=1e-13, err_msg=name)
    with pytest.raises(InputError, match="magnification and wavevector exclude"):
        load_problem("contact-area", settings={"wavevector": "1e5 1/m", "magnification": "3"})


# -- surfaces --------------------------------------------------------------------------------------------------------


def test_named_surfaces_change_the_area_and_unknown_ones_are_named():
    reference, printed = area(), area(surface="paper_printed")
    assert not np.allclose(reference, printed, rtol=0.1)
    assert_array_equal(area(surface="paper_reference"), reference)
    with pytest.raises(InputError, match=r"paper_refrence.*paper_reference"):
        area(surface="paper_refrence")
    kept = area(surface="paper_printed", rms_height="44.8 um")
    assert not np.allclose(kept, printed, rtol=0.1)


def test_a_tabulated_spectrum_is_the_self_affine_one_it_was_made_of(tmp_path):
    # plateau and power law as a table: ⟨h²⟩ = 2π∫q C dq fixes the amplitude
    hurst, low, rolloff, high, height = 0.78, 1e3, 6.345e3, 1e9, 22.4e-6
    q = np.unique(np.concatenate([np.geomspace(low, rolloff, 40), np.geomspace(rolloff, high, 400)]))
    shape = np.where(q < rolloff, 1.0, (q / rolloff) ** (-2 * (1 + hurst)))
    mean_square = (
        2
        * np.pi
        * ((rolloff**2 - low**2) / 2 + rolloff**2 / (2 * hurst) * (1 - (rolloff / high) ** (2 * hurst)))
    )
    power = shape * height**2 / mean_square
    path = tmp_path / "spectrum.csv"
    rows = "".join(f"{a!r},{b!r}\n" for a, b in zip(q.tolist(), power.tolist(), strict=True))
    path.write_text("wavevector [1/m],power_spectrum_2d [m^4]\n" + rows)
    assert_allclose(area(surface=str(path)), area(), rtol=2e-3)
    # heights can be set over a table
    assert_allclose(area(surface=str(path), rms_height="44.8 um"), area(rms_height="44.8 um"), rtol=2e-3)


def test_a_profile_spectrum_is_converted(tmp_path):
    # isotropic surface: C1D(q) = 2 ∫_q^∞ C(k) k / √(k² − q²) dk; for C = c k^-4 that is c (π/2) q^-3 ... by quadrature
    hurst, low, high = 0.8, 1e3, 1e7
    q = np.geomspace(low, high, 120)

    def power(k: float) -> float:
        return 1e-21 * (k / 1e4) ** (-2 * (1 + hurst))

    def profile(at: float) -> float:
        top = np.sqrt(high**2 - at**2)  # k² = q² + t²
        if top == 0.0:
            return 0.0
        return 2 * integrate.quad(
            lambda u: power(float(np.hypot(at, np.exp(u)))) * np.exp(u), np.log(1e-4 * at), np.log(top), limit=300
        )[0] + 2 * power(at) * 1e-4 * at  # fmt: skip

    one = np.array([profile(x) for x in q[:-1]])
    (tmp_path / "one.csv").write_text(
        "wavevector [1/m],power_spectrum_1d [m^3]\n"
        + "".join(f"{a!r},{b!r}\n" for a, b in zip(q[:-1].tolist(), one.tolist(), strict=True))
    )
    (tmp_path / "two.csv").write_text(
        "wavevector [1/m],power_spectrum_2d [m^4]\n"
        + "".join(f"{a!r},{power(a)!r}\n" for a in q[:-1].tolist())
    )
    settings = {"wavevector": "1e5 1/m"}
    assert_allclose(
        area(surface=str(tmp_path / "one.csv"), **settings), area(surface=str(tmp_path / "two.csv"), **settings),
        rtol=0.05,
    )  # fmt: skip


def test_a_table_with_free_height_is_one_batch(tmp_path):
    q = np.geomspace(1e3, 1e8, 60)
    rows = "".join(f"{a!r},{1e-20 * (a / 1e4) ** -3.6!r}\n" for a in q.tolist())
    (tmp_path / "c.csv").write_text("wavevector [1/m],power_spectrum_2d [m^4]\n" + rows)
    text = FINGER.format(
        parameters='frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }\nyoung_modulus_layer = "7 MPa"\n'
        'rms_height = { lognormal = ["20 um", 0.5] }',
        noise='family = "lognormal"\nnoise_scale = 0.3',
    ).replace('name = "paper_reference"', 'file = "c.csv"')
    problem = load_problem(write_model(tmp_path, text))
    theta = draws(problem, 20)
    batch = problem.log_posterior(theta)
    assert np.isfinite(batch).all()
    assert_array_equal(batch, [problem.log_posterior(row) for row in theta])
    mu = problem.predict(np.array([[10e6, 20e-6], [10e6, 40e-6]]))["friction_coefficient"]
    assert_allclose(mu[1], mu[0] / 2, rtol=1e-3)  # small area: proportional to 1/slope
    with pytest.raises(InputError, match="'hurst_exponent' has no effect on a tabulated spectrum"):
        load_problem(problem.spec.path, settings={"hurst_exponent": "0.7"})


# -- conditions ------------------------------------------------------------------------------------------------------


def test_rows_of_the_user_replace_the_grid(tmp_path):
    rows = tmp_path / "rows.csv"
    rows.write_text("wavevector [1/mm],nominal_pressure [kPa]\n100,6.83\n1e6,13.66\n")
    problem = load_problem("contact-area", conditions=rows)
    predicted = problem.predict(np.empty(0))["relative_contact_area"]
    assert_allclose(predicted[0], area(wavevector="1e5 1/m")[0], rtol=1e-12)
    assert_allclose(predicted[1], area(wavevector="1e9 1/m", nominal_pressure="13.66 kPa")[0], rtol=1e-12)
    set_beside = load_problem("contact-area", conditions=rows, settings={"nominal_pressure": "6.83 kPa"})
    assert_allclose(set_beside.predict(np.empty(0))["relative_contact_area"][1], area()[-1], rtol=1e-12)


def test_rows_of_the_user_may_use_another_alternative(tmp_path):
    rows = tmp_path / "rows.csv"
    rows.write_text("normal_force [N]\n0.2\n0.5\n")
    problem = load_problem("contact-area", conditions=rows)
    pressure = problem.derived(np.empty((1, 0)))["nominal_pressure"].ravel()
    assert pressure[1] / pressure[0] == pytest.approx(2.5 ** (1 / 3), rel=1e-12)


def test_rows_need_the_levels_of_the_model(tmp_path):
    rows = tmp_path / "rows.csv"
    rows.write_text("state,normal_force [N],sphere_radius [m]\ndamp,0.5,0.008\n")
    with pytest.raises(InputError, match="rows have damp"):
        load_problem("forearm-glass", conditions=rows)
    rows.write_text("normal_force [N],sphere_radius [m]\n0.5,0.008\n")
    with pytest.raises(InputError, match="no column 'state'"):
        load_problem("forearm-glass", conditions=rows)
    rows.write_text("state,normal_force [N],sphere_radius [mm]\nwet,0.5,8\nwet,1.0,8\ndry,0.5,8\n")
    problem = load_problem("forearm-glass", conditions=rows)
    theta = problem.prior_medians()
    assert problem.predict(theta)["friction_coefficient"].shape == (3,)
    assert problem.observed is None


# -- data that do not fit the model ----------------------------------------------------------------------------------

MINE = """
title = "Mine"
forward = "friction"
[data]
file = "mine.csv"
observable = "friction_coefficient"
{data}
[surface]
name = "paper_reference"
[parameters]
frictional_shear_stress = {{ lognormal = ["10 MPa", 1.0] }}
young_modulus_layer = "7 MPa"
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
{parameters}
[noise]
family = "lognormal"
noise_scale = 0.2
"""


@pytest.mark.parametrize(
    ("csv", "data", "parameters", "fragments"),
    [
        ("normal_force [N]\n1\n", "", 'nominal_pressure = "1 kPa"', ("no column 'friction_coefficient",)),
        ("friction_coefficient [1]\n0.5\n", "", "", ("needs nominal_pressure", "normal_force and")),
        (
            "friction_coefficient [1],nominal_pressure [Pa]\n0.5,1000\n",
            "",
            'nominal_pressure = "1 kPa"',
            ("'nominal_pressure' is given twice",),
        ),
        ("friction_coefficient [1],nominal_pressure [Pa]\n0,1000\n", "", "", ("Row 1", "> 0")),
        (
            "friction_coefficient [1],friction_coefficient_standard_deviation [1],nominal_pressure [Pa]\n0.5,0.1,1000\n",
            "",
            "",
            ('spread = "use"', 'spread = "ignore"'),
        ),
        (
            "friction_coefficient [1],nominal_pressure [Pa]\n0.5,1000\n",
            'spread = "use"',
            "",
            ("no column 'friction_coefficient_standard_deviation'",),
        ),
        (
            "friction_coefficient [1],nominal_pressure [Pa]\n0.5,1000\n",
            'rows = { liquid = ["water"] }',
            "",
            ("data.rows", "liquid"),
        ),
        (
            "liquid,friction_coefficient [1],nominal_pressure [Pa]\nwater,0.5,1000\n",
            'rows = { liquid = ["watr"] }',
            "",
            ("data.rows", "watr", "water"),
        ),
        (
            "friction_coefficient [1],nominal_pressure [Pa]\n0.5,1000\n",
            "",
            "yield_stress = { by = 'state', dry = '50 MPa' }",
            ("no column 'state'",),
        ),
        (
            "state,friction_coefficient [1],nominal_pressure [Pa]\ndry,0.5,1000\nwet,1.0,1000\n",
            "",
            "yield_stress = { by = 'state', dry = '50 MPa' }",
            ("yield_stress differs by 'state'", "rows have wet"),
        ),
    ],
)  # fmt: skip
def test_data_that_do_not_fit(csv, data, parameters, fragments, tmp_path):
    (tmp_path / "mine.csv").write_text(csv)
    path = write_model(tmp_path, MINE.format(data=data, parameters=parameters), "model.toml")
    with pytest.raises(InputError) as caught:
        load_problem(path)
    for fragment in fragments:
        assert fragment in str(caught.value)
    assert str(caught.value).startswith(str(tmp_path))


def test_known_spread_enters_the_likelihood_only_if_asked(tmp_path):
    (tmp_path / "mine.csv").write_text(
        "friction_coefficient [1],friction_coefficient_standard_deviation [1],nominal_pressure [Pa]\n0.5,0.2,1000\n0.6,0.1,2000\n"
    )
    used, ignored = (
        load_problem(write_model(tmp_path, MINE.format(data=f'spread = "{word}"', parameters=""), f"{word}.toml"))
        for word in ("use", "ignore")
    )  # fmt: skip
    theta = [12e6]
    mu = used.predict(theta)["friction_coefficient"]
    for problem, width in ((used, np.hypot(0.2, [0.2 / 0.5, 0.1 / 0.6])), (ignored, 0.2)):
        expected = stats.lognorm.logpdf(problem.observed, s=width, scale=mu)
        assert_allclose(problem.log_likelihood(theta, pointwise=True), expected, rtol=1e-12)
    assert used.fingerprint != ignored.fingerprint


def test_a_model_without_data_has_no_likelihood():
    problem = load_problem("contact-area")
    with pytest.raises(InputError, match="no data"):
        problem.log_likelihood(np.empty(0))
    with pytest.raises(InputError, match=r"no \[data\] block"):
        load_problem("contact-area", data="adams2007-forearm-glass")


def test_rows_of_the_user_have_no_likelihood(tmp_path):
    rows = tmp_path / "rows.csv"
    rows.write_text("normal_force [N],nominal_contact_area [m^2]\n0.2,4e-4\n")
    problem = load_problem("finger-water", conditions=rows)
    with pytest.raises(InputError, match="no data"):
        problem.log_likelihood(problem.prior_medians())


# -- fingerprints ----------------------------------------------------------------------------------------------------

NOISE = 'family = "lognormal"\nnoise_scale = { half_normal = 0.5 }'
PARAMETERS = 'frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }\nyoung_modulus_layer = "7 MPa"'


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('["10 MPa", 1.0]', '["10 MPa", 1.1]'),
        ('["10 MPa", 1.0]', '["11 MPa", 1.0]'),
        ('lognormal = ["10 MPa", 1.0]', 'normal = ["10 MPa", "1 MPa"]'),
        ('"7 MPa"', '"7.000001 MPa"'),
        ('"7 MPa"', '{ lognormal = ["7 MPa", 0.1] }'),
        ('"173 um"', '"174 um"'),
        ("paper_reference", "paper_printed"),
        ('family = "lognormal"', 'family = "relative"'),
        ("half_normal = 0.5", "half_normal = 0.4"),
        ('liquid = ["water"]', 'liquid = ["water", "hand cream"]'),
        ("[noise]", "yield_stress = '50 MPa'\n[noise]"),
        ("[noise]", "[noise]\ndiscrepancy_scale = 0.1"),
    ],
)
def test_fingerprint_follows_what_the_posterior_depends_on(old, new, tmp_path):
    text = FINGER.format(parameters=PARAMETERS, noise=NOISE)
    assert old in text
    first = load_problem(write_model(tmp_path, text))
    second = load_problem(write_model(tmp_path, text.replace(old, new, 1), "other.toml"))
    assert first.fingerprint != second.fingerprint
    assert (first.data_fingerprint == second.data_fingerprint) == ("liquid" not in old)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("[noise]", "# a remark\n\n[noise]"),
        ('title = "Fingers"', 'title = "Fingertips"'),
        ('"7 MPa"', '{ fixed = "7000 kPa", source = "a book" }'),
        ("\n", "\r\n"),
        ('["10 MPa", 1.0] }', '["10 MPa", 1.0], source = "a guess" }'),
    ],
)
def test_fingerprint_ignores_words_and_spelling(old, new, tmp_path):
    text = FINGER.format(parameters=PARAMETERS, noise=NOISE)
    first = load_problem(write_model(tmp_path, text))
    second = tmp_path / "other.toml"
    second.write_bytes(text.replace(old, new).encode())
    assert first.fingerprint == load_problem(second).fingerprint


def test_fingerprint_follows_every_point_of_a_tabulated_spectrum(tmp_path):
    q = np.geomspace(1e3, 1e8, 400)
    text = FINGER.format(parameters=PARAMETERS, noise=NOISE).replace(
        'name = "paper_reference"', 'file = "c.csv"'
    )
    path = write_model(tmp_path, text)
    seen = set()
    for changed in (None, 0, 7, 8, 201, 399):
        power = 1e-20 * (q / 1e4) ** -3.6
        if changed is not None:
            power[changed] *= 1.01
        rows = "".join(f"{a!r},{b!r}\n" for a, b in zip(q.tolist(), power.tolist(), strict=True))
        (tmp_path / "c.csv").write_text("wavevector [1/m],power_spectrum_2d [m^4]\n" + rows)
        seen.add(load_problem(path).fingerprint)
    assert len(seen) == 6


def test_fingerprint_follows_one_changed_datum(tmp_path):
    source = Path(shipped_folder("datasets")) / "adams2007-forearm-glass" / "data.csv"
    shipped = load_problem("forearm-glass")
    copy = tmp_path / "copy.csv"
    copy.write_bytes(source.read_bytes())
    same = load_problem("forearm-glass", data=copy)
    assert (same.fingerprint, same.data_fingerprint) == (shipped.fingerprint, shipped.data_fingerprint)
    copy.write_text(source.read_text().replace("1.4", "1.41"))
    changed = load_problem("forearm-glass", data=copy)
    assert changed.fingerprint != shipped.fingerprint and changed.data_fingerprint != shipped.data_fingerprint


def test_every_shipped_model_loads_and_predicts():
    for name in shipped_names("models"):
        problem = load_problem(name)
        for values in problem.predict(problem.prior_medians()).values():
            assert np.isfinite(values).all()
