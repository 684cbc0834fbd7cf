"""The forward model of spectra, and draws of a surface as the prior of another model."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import quad

import skinbayes as sb
from skinbayes.files.surface_draws import read_surface_draws, surface_draws
from skinbayes.problem.spectrum_problem import spectrum_problem
from skinbayes.roughness import SelfAffineSpectrum, rms_slope
from skinbayes.topography import MeasuredSpectrum

Q = np.geomspace(1e4, 1e6, 12)
SURFACE = SelfAffineSpectrum(
    rms_height=4e-6, hurst_exponent=0.75, wavevector_min=1e4, wavevector_rolloff=5e4, wavevector_max=1e9
)
NUMBERS = {
    "rms_height": 4e-6,
    "hurst_exponent": 0.75,
    "wavevector_min": 1e4,
    "wavevector_rolloff": 5e4,
    "wavevector_max": 1e9,
}
SKIN = {
    "frictional_shear_stress": {"loguniform": ["0.5 MPa", "500 MPa"]},
    "young_modulus_layer": {"lognormal": ["7 MPa", 0.5]},
    "young_modulus_bulk": "20 kPa",
    "layer_thickness": "20 um",
}
ROWS = {"nominal_pressure [kPa]": [5, 8], "friction_coefficient": [1.3, 1.2]}
NOISE = {"family": "lognormal", "noise_scale": {"half_normal": 0.3}}


def measured(modes: float = 40.0, factor: float = 1.0, seed: int = 1) -> MeasuredSpectrum:
    scatter = np.random.default_rng(seed).gamma(modes, 1 / modes, size=Q.size)
    return MeasuredSpectrum(
        Q,
        power_spectral_density=SURFACE.power(Q) * scatter * factor,
        independent_modes=np.full(Q.size, modes),
        wavevector_min=1e4,
        wavevector_max=1e6,
        source="made up",
    )


def made_up_draws(count: int = 3000):
    """Draws of a surface whose roughness parameters depend on each other."""
    z = np.random.default_rng(7).normal(size=(3, count))
    values = {
        "rms_height": 4e-6 * np.exp(0.1 * z[0]),
        "hurst_exponent": 0.75 + 0.02 * (z[0] + z[1]),
        "wavevector_max": 10 ** np.random.default_rng(8).uniform(7, 10, size=count),
    }
    return surface_draws(values, {"wavevector_min": 1e4, "wavevector_rolloff": 5e4}, "made up")


def test_the_likelihood_of_one_spectrum_is_that_of_averaged_ordinates() -> None:
    one = measured()
    problem = spectrum_problem(one, parameters=NUMBERS)
    # a scale of zero leaves the scatter of the periodogram
    found = float(problem.log_likelihood(np.array([1e-9])))
    expected = stats.gamma(40.0, scale=SURFACE.power(Q) / 40.0).logpdf(one.power_spectral_density).sum()
    assert found == pytest.approx(expected, rel=1e-9)


def test_slope_and_area_reach_to_the_end_of_the_band() -> None:
    problem = spectrum_problem(
        measured(), parameters=NUMBERS | {"wavevector_max": {"loguniform": ["1e7 1/m", "1e10 1/m"]}}
    )
    found = problem.derived(np.array([[1e9, 0.1], [1e7, 0.1]]))
    assert found["rms_slope"][0] == pytest.approx(float(rms_slope(SURFACE)), rel=1e-12)
    assert found["rms_slope"][1] < 0.6 * found["rms_slope"][0]


def test_a_free_form_keeps_the_rms_height_and_sums_its_slope() -> None:
    factors = [1.0, 3.0, 0.5, 1.0, 2.0, 0.7]
    fixed = {f"spectrum_factor_{i + 1}": factor for i, factor in enumerate(factors)}
    problem = spectrum_problem(measured(), shape="free-form", parameters=NUMBERS | fixed)
    plain = spectrum_problem(measured(), shape="free-form", parameters=NUMBERS | dict.fromkeys(fixed, 1.0))

    def power(q: float, one: sb.Problem = problem) -> float:
        inputs = one.inputs(np.array([[0.1]])) | {"wavevector": np.array([[q]])}
        return float(one.forward.evaluate(inputs, one.tables)["power_spectral_density"].squeeze())

    cuts = np.log([1e4, 2e4, 5e4, 1e5, 4e5, 1e6, 1e7, 1e9])

    def moment(order: int) -> float:
        parts = (
            quad(lambda t: np.exp(order * t) * power(np.exp(t)), low, high, epsrel=1e-4)[0]
            for low, high in pairwise(cuts)
        )
        return float(2 * np.pi * sum(parts))

    # 400 points over the band: the mean of a smooth factor
    assert np.sqrt(moment(2)) == pytest.approx(4e-6, rel=3e-3)
    slope = float(problem.derived(np.array([[0.1]]))["rms_slope"].squeeze())
    assert slope == pytest.approx(np.sqrt(moment(4)), rel=3e-3)
    assert power(1e6 / 10**0.8) / power(1e4 * 10**0.4) != pytest.approx(
        power(1e6 / 10**0.8, plain) / power(1e4 * 10**0.4, plain)
    )
    # at the knots the ratio to the self-affine spectrum is that of the factors
    knots = np.geomspace(1e4, 1e6, 6)
    ratio = [power(q) / float(SURFACE.power(q)) for q in knots * np.array([1, 1, 1, 1, 1, 0.999999])]
    assert np.array(ratio) / ratio[0] == pytest.approx(factors, rel=1e-4)


def test_places_share_an_effect_and_the_mean_of_the_logarithm_is_corrected() -> None:
    problem = spectrum_problem([measured(seed=1), measured(factor=1.5, seed=2), measured(factor=0.7, seed=3)])
    assert "group_scale[place]" in problem.names
    many = spectrum_problem([measured(modes=2.0, seed=i) for i in range(400)], parameters=NUMBERS)
    # the mean of two ordinates: ln of it is off by −0.27 without correction, and scatters by 0.80 where C scatters by 0.71
    off = np.log(many.observations[0].values.reshape(400, -1) / SURFACE.power(Q))
    assert off.mean() == pytest.approx(0.0, abs=4 * off.std() / np.sqrt(off.size))
    relative = many.observations[0].spread / many.observations[0].values
    assert off.std() == pytest.approx(relative[0], rel=0.05)


def test_few_bands_and_a_band_above_the_longest_wave_are_refused() -> None:
    few = MeasuredSpectrum(
        [1e4, 2e4, 3e4],
        power_spectral_density=[1e-20] * 3,
        independent_modes=[9.0] * 3,
        wavevector_min=1e4,
        wavevector_max=1e5,
    )
    with pytest.raises(sb.InputError, match=r"3 bands of wavevectors.*expected at least 4"):
        spectrum_problem(few)
    with pytest.raises(sb.InputError, match="wavevector_min is 20000 1/m"):
        spectrum_problem(measured(), wavevector_min=2e4)
    with pytest.raises(sb.InputError, match="no spectrum given"):
        spectrum_problem([])


def test_draws_of_a_surface_enter_as_they_are() -> None:
    draws = made_up_draws()
    problem = sb.build_problem("friction", ROWS, surface=draws, parameters=SKIN, noise=NOISE)
    assert problem.names[2:5] == tuple(f"surface_deviate[{name}]" for name in draws.draws)
    assert problem.surface_prior is not None
    assert problem.surface_prior.departure() < 0.06
    theta = problem.draw_prior(np.random.default_rng(1), 4000)
    entered = problem.derived(theta)
    assert set(draws.draws) <= set(entered)
    assert entered["relative_contact_area"].shape == (4000, 2)
    # friction of the draws themselves, without the copula
    wide = {name: {"lognormal": [float(np.median(values)), 0.1]} for name, values in draws.draws.items()}
    wide |= {"hurst_exponent": {"uniform": [0.1, 0.99]}} | dict(draws.fixed)
    direct = sb.build_problem("friction", ROWS, noise=NOISE, parameters=SKIN | wide)
    columns = {
        "frictional_shear_stress": theta[:3000, 0],
        "young_modulus_layer": theta[:3000, 1],
        "noise_scale": theta[:3000, -1],
    }
    own = np.stack([{**columns, **draws.draws}[name] for name in direct.names], axis=-1)
    expected = np.log(direct.predict(own)["friction_coefficient"][:, 0])
    found = np.log(problem.predict(theta)["friction_coefficient"][:, 0])
    fractions = [0.05, 0.25, 0.5, 0.75, 0.95]
    assert np.quantile(found, fractions) == pytest.approx(
        np.quantile(expected, fractions), abs=0.12 * expected.std()
    )


def test_a_roughness_parameter_that_is_given_is_not_drawn() -> None:
    problem = sb.build_problem(
        "friction",
        ROWS,
        surface=made_up_draws(),
        parameters=SKIN | {"wavevector_max": "1e9 1/m"},
        noise=NOISE,
    )
    assert problem.surface_prior is not None
    assert problem.surface_prior.names == ("rms_height", "hurst_exponent")
    assert "wavevector_max" in {p.name for p in problem.fixed}


def test_model_file_and_draws_make_the_same_problem_again(tmp_path: Path) -> None:
    problem = sb.build_problem(
        "friction", ROWS, surface=made_up_draws(), parameters=SKIN, noise=NOISE, name="mine"
    )
    problem.to_toml(tmp_path / "mine.toml")
    assert "mine-surface.csv" in (tmp_path / "mine.toml").read_text()
    again = sb.load_problem(tmp_path / "mine.toml")
    assert again.fingerprint == problem.fingerprint
    other = sb.load_problem(tmp_path / "mine.toml", settings={"wavevector_rolloff": "6e4 1/m"})
    assert other.fingerprint != problem.fingerprint
    assert (
        sb.load_problem(tmp_path / "mine.toml", settings={"surface": "paper_reference"}).surface_prior is None
    )
    assert (
        sb.load_problem(
            "forearm-glass", settings={"surface": str(tmp_path / "mine-surface.csv")}
        ).surface_prior
        is not None
    )


def test_a_saved_fit_is_a_surface(tmp_path: Path) -> None:
    problem = spectrum_problem(measured())
    draws = problem.draw_prior(np.random.default_rng(1), 2000)
    fit = sb.Fit.from_draws(problem, draws)
    surface = fit.surface()
    assert surface.draws["rms_height"] == pytest.approx(draws[:, 0])
    assert surface.fixed == {"wavevector_min": 1e4}
    again = read_surface_draws(fit.save(tmp_path / "result.nc"))
    assert again.draws["wavevector_max"].tolist() == surface.draws["wavevector_max"].tolist()
    (tmp_path / "broken.nc").write_bytes((tmp_path / "result.nc").read_bytes()[:-1])
    with pytest.raises(sb.InputError, match=r"broken\.nc: no usable result of a fit"):
        read_surface_draws(tmp_path / "broken.nc")
    with pytest.raises(sb.InputError, match="no such file or folder"):
        read_surface_draws(tmp_path / "nothing")
    rough = {"rms_height": {"lognormal": ["22 um", 0.3]}}
    other = sb.build_problem(
        "friction", ROWS, surface="paper_reference", parameters=SKIN | rough, noise=NOISE
    )
    foreign = sb.Fit.from_draws(other, other.draw_prior(np.random.default_rng(1), 2000))
    with pytest.raises(sb.InputError, match="a fit of friction_coefficient, which would count twice"):
        read_surface_draws(foreign.save(tmp_path / "foreign.nc"))
    few = sb.Fit.from_draws(problem, draws[:150])
    with pytest.raises(sb.InputError, match="did not converge"):
        read_surface_draws(few.save(tmp_path / "few.nc"))
    (tmp_path / "draws.csv").write_text("rms_height [um]\n4\n5\n")
    with pytest.raises(sb.InputError, match="says nothing about hurst_exponent"):
        read_surface_draws(tmp_path / "draws.csv")


def test_two_experiments_have_one_surface() -> None:
    friction = {"forward": "friction", "noise": NOISE, "data": ROWS}
    problem = sb.build_joint_problem(
        {"left": friction, "right": friction}, surface=made_up_draws(), parameters=SKIN
    )
    assert [name for name in problem.names if name.startswith("surface_deviate")] == [
        f"surface_deviate[{name}]" for name in ("rms_height", "hurst_exponent", "wavevector_max")
    ]


def test_a_counterface_adds_its_heights() -> None:
    numbers = {name: getattr(SURFACE, name).item() for name in NUMBERS}
    fixed = SKIN | {
        "frictional_shear_stress": "15 MPa",
        "young_modulus_layer": "7 MPa",
        "nominal_pressure": "7 kPa",
    }

    def friction(**further: object) -> float:
        problem = sb.build_problem("friction", parameters=fixed | numbers | further)
        return float(problem.predict(problem.prior_medians())["friction_coefficient"].squeeze())

    counterface = {f"counterface_{name}": value for name, value in numbers.items()}
    assert friction(**counterface) == pytest.approx(friction(rms_height=4e-6 * np.sqrt(2)), rel=1e-12)
    assert friction(**counterface | {"counterface_rms_height": 1e-14}) == pytest.approx(friction(), rel=1e-12)
    assert friction(young_modulus_counterface="1e12 GPa") == pytest.approx(friction(), rel=1e-9)
    assert friction(young_modulus_counterface="1 MPa") > 1.5 * friction()
    with pytest.raises(
        sb.InputError, match="counterface_rms_height' has no effect without counterface_hurst_exponent"
    ):
        friction(counterface_rms_height=1e-6)


@pytest.mark.parametrize(
    "table", ["[counterface]\nfile", "[surface]\nname = 'paper_reference'\ncounterface_file"]
)
def test_a_table_of_a_counterface_is_refused_with_the_way_out(table: str, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(
        f"title = 'Two'\nforward = 'friction'\n{table} = 'glass.csv'\n[parameters]\n"
    )
    with pytest.raises(
        sb.InputError, match=r"not taken as a table.*counterface_wavevector_max.*spectrum FILE --fit"
    ):
        sb.load_problem(tmp_path / "mine.toml")


def test_ridges_carry_all_load_on_their_tops() -> None:
    numbers = dict(NUMBERS)
    fixed = SKIN | {"frictional_shear_stress": "15 MPa", "young_modulus_layer": "7 MPa"} | numbers
    ridges = {"ridge_spacing": "0.5 mm", "ridge_width": "0.2 mm", "ridge_height": "0.1 mm"}

    def derived(**further: object) -> dict[str, float]:
        problem = sb.build_problem("friction", parameters=fixed | further)
        found = problem.derived(np.empty((1, 0))) | problem.predict(np.empty((1, 0)))
        flags = problem.flags(np.empty((1, 0)))
        return {name: float(np.squeeze(value)) for name, value in (found | flags).items()}

    ridged, flat = derived(nominal_pressure="4 kPa", **ridges), derived(nominal_pressure="10 kPa")
    assert ridged["friction_coefficient"] == flat["friction_coefficient"]
    assert ridged["relative_contact_area"] == pytest.approx(0.4 * flat["relative_contact_area"], rel=1e-14)
    # of tissue alone π E1* h/(2λ) would be 8.4 kPa; the stratum corneum makes it several times that
    assert (
        derived(nominal_pressure="2.5 kPa", young_modulus_layer="20 kPa", **ridges)["closing_ridges"] == 0.0
    )
    assert (
        derived(nominal_pressure="2.6 kPa", young_modulus_layer="20 kPa", **ridges)["closing_ridges"] == 1.0
    )
    assert ridged["closing_ridges"] == 0.0
    assert derived(nominal_pressure="1 kPa", **ridges)["closing_ridges"] == 0.0
    with pytest.raises(sb.InputError, match="ridge_width is larger than ridge_spacing"):
        derived(nominal_pressure="1 kPa", ridge_spacing="0.1 mm", ridge_width="0.2 mm")


@pytest.mark.parametrize("name", ["roughness-spectrum", "roughness-spectrum-free-form"])
def test_shipped_models_take_a_spectrum_of_the_users_own(name: str) -> None:
    power = SURFACE.power(Q)
    data = {
        "wavevector": Q,
        "power_spectral_density": power,
        "power_spectral_density_standard_deviation": power / np.sqrt(40),
    }
    problem = sb.load_problem(name, data=data, settings={"wavevector_min": "1e4 1/m"})
    # every factor of a free form at 1 is the self-affine surface itself
    theta = np.array([NUMBERS.get(label, 1.0) for label in problem.names])
    assert problem.predict(theta)["power_spectral_density"] == pytest.approx(power, rel=1e-9)
    assert np.isfinite(problem.log_posterior(theta))


def test_films_take_the_height_of_draws_and_say_why_not_the_shape(monkeypatch: pytest.MonkeyPatch) -> None:
    from skinbayes.forward import stribeck_table

    built = []

    def noted(plan: object, *_: object) -> object:
        built.append(plan)
        raise sb.InputError("a table would be built now")

    monkeypatch.setattr(stribeck_table, "kept_films", noted)
    rows = {"speed_viscosity_product [N/m]": [1e-4, 1e-2], "friction_coefficient": [0.9, 0.4]}
    skin = SKIN | {"young_modulus_layer": "7 MPa", "sphere_radius": "8 mm", "normal_force": "0.2 N"}
    given = {"surface": made_up_draws(), "noise": NOISE, "options": {"contact": "line"}}
    problem = sb.build_problem("stribeck", rows, parameters=skin, **given)
    with pytest.raises(sb.InputError, match="a spectrum of one shape") as refused:
        problem.prepare()
    assert not built
    for said in ("surface.posterior", "hurst_exponent = 0.7", 'wavevector_max = "', "[parameters]"):
        assert said in str(refused.value)
    # the way out that is named: the height is drawn as it is, and tables hold it
    fixed = {"hurst_exponent": 0.75, "wavevector_max": "3e8 1/m"}
    problem = sb.build_problem("stribeck", rows, parameters=skin | fixed, **given)
    assert problem.names[1] == "surface_deviate[rms_height]"
    low, high = problem.ranges()["rms_height"]
    assert low < 4e-6 * np.exp(-0.3) and high > 4e-6 * np.exp(0.3)
    with pytest.raises(sb.InputError, match="a table would be built now"):
        problem.prepare()
    assert len(built) == 1 and built[0].ranges["rms_height"] == (low, high)
