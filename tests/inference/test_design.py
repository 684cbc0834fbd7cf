"""Expected information of rows that were not measured yet, against closed forms of the normal distribution."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats
from scipy.integrate import trapezoid

import skinbayes as sb
from skinbayes.errors import InputError
from skinbayes.fit.design import DRAWS

NOISE, BETWEEN, WIDTH = 0.1, 0.2, 0.3


def normal_fit(seed: int = 1, **groups: float) -> sb.Fit:
    """A mean friction known with `WIDTH`, and if wanted people who differ; every width known."""
    problem = sb.build_problem(
        "constant",
        data={
            "friction_coefficient": [2.0, 2.0, 2.2],
            "normal_force": [1.0, 2.0, 3.0],
            "person": ["a", "a", "b"],
        },
        parameters={"typical_friction_coefficient": {"normal": [2.0, 10.0]}},
        noise={"family": "gaussian", "noise_scale": NOISE},
        groups=groups or None,
    )
    rng = np.random.default_rng(seed)
    return sb.Fit.from_draws(problem, 2.0 + WIDTH * rng.standard_normal((4 * DRAWS, 1)))


def test_information_is_half_the_logarithm_of_the_ratio_of_variances() -> None:
    found = normal_fit().design({"normal_force": [1.0, 2.0]}, rows=2)
    # of one datum and of two: I = ½ ln(1 + n WIDTH²/NOISE²)
    one, two = (0.5 * np.log(1.0 + n * WIDTH**2 / NOISE**2) for n in (1, 2))
    assert found.information == pytest.approx([one, one], abs=0.12)  # four of its standard errors
    assert np.abs(found.information - one).max() < 4.0 * found.errors.max() + 0.01
    assert found.chosen[1].information == pytest.approx(two, abs=0.12)


def test_one_more_row_of_a_known_person_tells_other_things_than_one_of_somebody_new() -> None:
    fit = normal_fit(person=BETWEEN)
    rows = {"normal_force": [1.0, 1.0], "person": ["a", "new"]}
    found = fit.design(rows)
    # given the mean friction m, the effect of a is known from its two rows: normal with precision 1/BETWEEN² + 2/NOISE², and
    # its mean falls by the share s of what m rises; a row of a new person scatters by BETWEEN and NOISE about m
    precision = 1.0 / BETWEEN**2 + 2.0 / NOISE**2
    share = (2.0 / NOISE**2) / precision
    known = 0.5 * np.log(1.0 + ((1.0 - share) * WIDTH) ** 2 / (NOISE**2 + 1.0 / precision))
    new = 0.5 * np.log(1.0 + WIDTH**2 / (NOISE**2 + BETWEEN**2))
    assert found.information == pytest.approx([known, new], abs=0.08)
    assert found.order == [1, 0] and new > 10 * known


def test_rows_of_one_new_person_share_the_effect() -> None:
    fit = normal_fit(person=BETWEEN)
    same = fit.design({"normal_force": [1.0, 1.0], "person": ["x", "x"]}, rows=2).chosen[1].information
    other = fit.design({"normal_force": [1.0, 1.0], "person": ["x", "y"]}, rows=2).chosen[1].information
    exact_same = 0.5 * np.log(1.0 + WIDTH**2 / (NOISE**2 / 2 + BETWEEN**2))
    exact_other = 0.5 * np.log(1.0 + 2 * WIDTH**2 / (NOISE**2 + BETWEEN**2))
    assert same == pytest.approx(exact_same, abs=0.1) and other == pytest.approx(exact_other, abs=0.1)


def two_state_fit() -> sb.Fit:
    """σ_f and the modulus of dry and wet skin, from draws of the prior."""
    problem = sb.load_problem("forearm-glass")
    return sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(2), 4 * DRAWS))


def test_information_on_one_parameter_is_no_more_than_on_all_and_sees_which_row_bears_on_it() -> None:
    fit = two_state_fit()
    rows = {"state": ["dry", "wet"], "normal_force": [1.0, 1.0], "sphere_radius": [7e-3, 7e-3]}
    on_all = fit.design(rows)
    on_modulus = fit.design(rows, ["young_modulus_layer[wet]"])
    assert (on_modulus.information < on_all.information).all()
    assert on_modulus.information[1] > 0.02 > abs(on_modulus.information[0]) - 3 * on_modulus.errors[0]
    assert on_modulus.order == [1, 0]


def test_a_datum_tells_two_models_apart_as_the_integral_says() -> None:
    first, second = normal_fit(1), normal_fit(2)
    shifted = sb.Fit.from_draws(second.problem, second.theta() + 1.0)
    found = first.design({"normal_force": [1.0]}, against=shifted)
    # mutual information of the label and a datum that is normal about 2 or 3, by quadrature
    y, width = np.linspace(-2.0, 7.0, 20_001), np.hypot(WIDTH, NOISE)
    p = np.exp(-0.5 * ((y[:, np.newaxis] - [2.0, 3.0]) / width) ** 2) / (width * np.sqrt(2 * np.pi))
    mixed = p.mean(axis=1)
    with np.errstate(all="ignore"):
        gain = np.where(p > 1e-300, p * np.log(p / mixed[:, np.newaxis]), 0.0)
    exact = gain.mean(axis=1).sum() * (y[1] - y[0])
    assert found.between_models and found.information[0] == pytest.approx(exact, abs=0.03)
    assert found.information[0] < np.log(2.0)


def test_noise_whose_shape_changes_with_its_width_has_its_own_density() -> None:
    """Gamma data of a known shape n about a mean whose ln is normal: I = ∫∫ p ln(p/p(y)), by quadrature."""
    modes, spread = 30.0, 0.4
    problem = sb.build_problem(
        "constant",
        data={"friction_coefficient": [1.0], "normal_force": [1.0]},
        parameters={"typical_friction_coefficient": {"lognormal": [1.0, spread]}},
        noise={"family": "gamma", "noise_scale": modes**-0.5},
    )
    fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 4 * DRAWS))
    x, y = np.linspace(-5 * spread, 5 * spread, 801), np.geomspace(0.02, 30.0, 4001)
    weight = np.exp(-0.5 * (x / spread) ** 2)
    weight /= weight.sum()
    density = stats.gamma.pdf(y, modes, scale=np.exp(x)[:, np.newaxis] / modes)
    with np.errstate(all="ignore"):
        gain = np.where(density > 0, density * np.log(density / (weight @ density)), 0.0)
    exact = float(trapezoid(weight @ gain, y))
    found = fit.design({"normal_force": [1.0]})
    assert found.information[0] == pytest.approx(exact, abs=4.0 * found.errors[0] + 0.01)


def test_two_models_of_different_numbers_of_draws_can_be_told_apart() -> None:
    first = normal_fit(1)
    fewer = sb.Fit.from_draws(first.problem, first.theta()[:700] + 1.0)
    found = first.design({"normal_force": [1.0]}, against=fewer)
    assert 0.2 < found.information[0] < np.log(2.0)


def test_costs_change_the_order() -> None:
    rows = {"normal_force": [1.0, 1.0], "person": ["a", "new"], "cost [1]": [1.0, 1000.0]}
    fit = normal_fit(person=BETWEEN)
    assert fit.design(rows).order == [1, 0] and fit.design(rows, cost="cost").order == [0, 1]
    # of one cost: what differs without it differs with it, whatever its unit
    rows["cost [1]"] = [1000.0, 1000.0]
    assert "All candidates" not in fit.design(rows, cost="cost").sentence()
    assert "All candidates" in fit.design(rows | {"person": ["new", "new"]}, cost="cost").sentence()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"parameters": ["friction"]}, "'friction' is no free parameter"),
        ({"rows": 3}, "expected 1 to 2"),
        ({"cost": "normal_forces"}, "no numeric column 'normal_forces"),
        ({"cost": "zero"}, r"row 1, zero: found 0; expected a value > 0"),
    ],
)
def test_what_cannot_be_designed_is_explained(options: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        normal_fit().design({"normal_force": [1.0, 2.0], "zero [1]": [0.0, 1.0]}, **options)  # type: ignore[arg-type]
