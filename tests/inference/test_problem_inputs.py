"""A model file bound to its data: levels of a column, settings, surfaces, rows of the user."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy import integrate
from small_models import FINGER, three_parameters, write_model

from skinbayes.errors import InputError
from skinbayes.problem import load_problem

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
    path.write_text("# convention: paper\nwavevector [1/m],power_spectrum_2d [m^4]\n" + rows)
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
        "# convention: two-sided 1-D\nwavevector [1/m],power_spectrum_1d [m^3]\n"
        + "".join(f"{a!r},{b!r}\n" for a, b in zip(q[:-1].tolist(), one.tolist(), strict=True))
    )
    (tmp_path / "two.csv").write_text(
        "# convention: paper\nwavevector [1/m],power_spectrum_2d [m^4]\n"
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
    (tmp_path / "c.csv").write_text("# convention: paper\nwavevector [1/m],power_spectrum_2d [m^4]\n" + rows)
    text = FINGER.format(
        parameters='frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }\nyoung_modulus_layer = "7 MPa"\n'
        'rms_height = { lognormal = ["20 um", 0.5] }',
        noise='family = "lognormal"\nnoise_scale = 0.3',
    ).replace('name = "paper_reference"', 'file = "c.csv"')
    problem = load_problem(write_model(tmp_path, text))
    theta = problem.draw_prior(np.random.default_rng(3), 20)
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
