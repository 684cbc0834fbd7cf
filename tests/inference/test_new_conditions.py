"""Posterior predictions at rows that were not measured, against closed forms and against the data's own rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import skinbayes as sb
from skinbayes.errors import InputError
from skinbayes.fit.prediction import Prediction
from skinbayes.forward import forward_model
from skinbayes.problem.new_conditions import at_new_conditions

DRAWS = 20_000
NOISE, BETWEEN, PRIOR = 0.05, 0.2, 1.0


def normal_problem(**blocks: object) -> sb.Problem:
    """One mean friction of people who differ, everything normal and every width known."""
    return sb.build_problem(
        "constant",
        data={
            "friction_coefficient": [0.5, 0.6, 0.9],
            "normal_force": [1.0, 2.0, 3.0],
            "person": ["a", "a", "b"],
        },
        parameters={"typical_friction_coefficient": {"normal": [1.0, PRIOR]}},
        noise={"family": "gaussian", "noise_scale": NOISE},
        groups={"person": BETWEEN},
        **blocks,
    )


def exact() -> tuple[np.ndarray, np.ndarray]:
    """Mean and covariance of (mean friction, effect of a, effect of b) given the data, in closed form."""
    design = np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0]])
    prior = np.diag([PRIOR**2, BETWEEN**2, BETWEEN**2])
    data, centre = np.array([0.5, 0.6, 0.9]), np.array([1.0, 0.0, 0.0])
    gain = prior @ design.T @ np.linalg.inv(design @ prior @ design.T + NOISE**2 * np.eye(3))
    return centre + gain @ (data - design @ centre), prior - gain @ design @ prior


@pytest.fixture(scope="module")
def fit() -> sb.Fit:
    problem = normal_problem()
    mean, covariance = exact()
    rng = np.random.default_rng(3)
    draws = mean[0] + np.sqrt(covariance[0, 0]) * rng.standard_normal((DRAWS, 1))
    return sb.Fit.from_draws(problem, draws)


def test_known_and_new_people_have_the_variances_of_the_closed_form(fit: sb.Fit) -> None:
    prediction = fit.predict({"normal_force": [1.0, 1.0], "person": ["b", "c"]})
    model, measured = (
        part["friction_coefficient"] for part in (prediction.of_model, prediction.of_measurement)
    )
    mean, covariance = exact()
    known = np.array([1.0, 0.0, 1.0])  # mean friction and the effect of b
    centre = [known @ mean, mean[0]]
    variance = [known @ covariance @ known, covariance[0, 0]]
    extra = [NOISE**2, NOISE**2 + BETWEEN**2]
    for row in range(2):
        # standard errors of 20,000 draws: sd/141 of the mean, 0.5 % of the standard deviation; five of them allowed
        sd = np.sqrt(variance[row])
        assert model[:, row].mean() == pytest.approx(centre[row], abs=5 * sd / 141)
        assert model[:, row].std() == pytest.approx(sd, rel=0.025)
        whole = np.sqrt(variance[row] + extra[row])
        assert measured[:, row].mean() == pytest.approx(centre[row], abs=5 * whole / 141)
        assert measured[:, row].std() == pytest.approx(whole, rel=0.025)
    below = prediction.probability("friction_coefficient < 0.7")
    wanted = stats.norm.cdf(0.7, centre, np.sqrt(np.add(variance, extra)))
    assert below == pytest.approx(wanted, abs=5 * 0.5 / 141)
    assert (
        "person c" in prediction.notes[0] and "b" not in prediction.notes[0].split(".")[0].split("person ")[1]
    )


def test_rows_without_the_column_are_of_somebody_new(fit: sb.Fit) -> None:
    anonymous = fit.predict({"normal_force": [1.0]}).quantiles("friction_coefficient")
    named = fit.predict({"normal_force": [1.0], "person": ["c"]}).quantiles("friction_coefficient")
    assert anonymous.tolist() == named.tolist()


def test_the_rows_of_the_data_are_predicted_as_the_fit_says() -> None:
    problem = sb.load_problem("forearm-glass")
    fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 4000))
    assert problem.dataset is not None
    prediction = fit.predict(problem.dataset)
    again = problem.predict(fit.theta())["friction_coefficient"]
    assert (prediction.of_model["friction_coefficient"] == again).all()
    stored = fit.groups["posterior_predictive"]["friction_coefficient"].values.reshape(-1, 2)
    for row in range(2):
        # two samples of the same distribution: fails by chance once in 1e4
        assert (
            stats.ks_2samp(stored[:, row], prediction.of_measurement["friction_coefficient"][:, row]).pvalue
            > 1e-4
        )


def test_a_discrepancy_curve_is_carried_over_and_not_beyond_the_data() -> None:
    force = np.linspace(1.0, 9.0, 12)
    problem = sb.build_problem(
        "constant",
        data={"friction_coefficient": 0.5 + 0.1 * np.sin(force), "normal_force": force},
        parameters={"typical_friction_coefficient": {"normal": [0.5, 0.1]}},
        noise={"family": "gaussian", "noise_scale": 0.005},
        discrepancy={"along": "normal_force", "size": 0.2, "length": 0.3},
    )
    draws = np.full((2000, 1), 0.5) + 0.01 * np.random.default_rng(1).standard_normal((2000, 1))
    fit = sb.Fit.from_draws(problem, draws)
    between = (force[:-1] + force[1:]) / 2
    model = fit.predict({"normal_force": between}).quantiles("friction_coefficient", 0.5, measured=False)
    assert model == pytest.approx(0.5 + 0.1 * np.sin(between), abs=0.01)
    with pytest.raises(InputError, match=r"row 2: normal_force lies outside 1 to 9"):
        fit.predict({"normal_force": [5.0, 9.5]})


def test_where_a_statement_holds_is_found_between_rows() -> None:
    load = np.linspace(0.0, 4.0, 41)
    # normal with mean 1 - 0.2 load and width 0.1 at equal probabilities: below 0.4 with 95 % from load 3.8224
    z = stats.norm.ppf((np.arange(4000) + 0.5) / 4000)[:, np.newaxis]
    draws = 1.0 - 0.2 * load + 0.1 * z
    columns = {"normal_force": load}
    prediction = Prediction(columns, {"friction_coefficient": draws}, {"friction_coefficient": draws})
    ((at, where),) = prediction.holds("friction_coefficient < 0.4", "normal_force")
    assert at == {} and len(where) == 1
    assert where[0] == (pytest.approx((0.6 + 0.1 * stats.norm.ppf(0.95)) / 0.2, abs=0.01), 4.0)
    assert prediction.holds("friction_coefficient < 0", "normal_force") == [({}, [])]
    inside = prediction.holds("friction_coefficient > 0.4", "normal_force", 0.5)[0][1]
    assert inside == [(0.0, pytest.approx(3.0, abs=0.01))]


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("friction < 0.4", "'friction' is not predicted here, but friction_coefficient is"),
        ("friction_coefficient = 0.4", "expected an observable, < or >"),
        ("friction_coefficient < 4 MPa", "4 MPa"),
        ("friction_coefficient <", "expected an observable, < or >"),
    ],
)
def test_statements_that_cannot_be_judged_are_explained(fit: sb.Fit, statement: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        fit.predict({"normal_force": [1.0]}).probability(statement)


def test_rows_that_cannot_be_predicted_are_explained() -> None:
    problem = sb.load_problem("forearm-glass")
    fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 200))
    rows = {"state": ["wet"], "normal_force": [1.0], "sphere_radius": [7e-3]}
    with pytest.raises(InputError, match="no column 'sphere_radius"):
        fit.predict({k: v for k, v in rows.items() if k != "sphere_radius"})
    with pytest.raises(InputError, match="'rms_height' is a parameter of 'forearm-glass' that was inferred"):
        fit.predict(rows | {"rms_height": [2e-5]})
    with pytest.raises(InputError, match="rows have soaked"):
        fit.predict(rows | {"state": ["soaked"]})


def test_a_column_replaces_a_fixed_parameter() -> None:
    problem = sb.load_problem("forearm-glass")
    fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 200))
    rows = {"state": ["wet"], "normal_force": [1.0], "sphere_radius": [7e-3]}
    usual, other = (
        fit.predict(rows | more).of_model["friction_coefficient"]
        for more in ({}, {"poisson_ratio_layer": [0.3]})
    )
    small = (
        usual[:, 0] < 1.0
    )  # where the contact area is small it goes as 1/E* of the layer, (1 - 0.3²)/(1 - 0.5²)
    assert (other / usual)[small] == pytest.approx(0.91 / 0.75, rel=0.01)


def test_rows_within_reach_share_the_table_of_the_fit_and_others_get_one_with_its_ties() -> None:
    """Tied moduli of drying skin: their box alone holds skins without bridges, for which there is no table."""
    told: list[tuple[dict[str, tuple[float, float]], dict[str, tuple[str, float]]]] = []

    def prepare(model, ranges, tables, progress, cores):  # type: ignore[no-untyped-def]
        told.append((dict(ranges), dict(ranges.multiples)))
        return model

    model = replace(forward_model("friction"), name="noted", prepare=prepare)
    problem = sb.build_problem(
        model,
        data={"normal_force": [0.5, 1.0], "sphere_radius": [7e-3, 7e-3], "friction_coefficient": [1.2, 1.3]},
        parameters={
            "frictional_shear_stress": "15 MPa",
            "young_modulus_layer": {"lognormal": ["7 MPa", 0.2]},
            "young_modulus_bulk": {"same_as": "young_modulus_layer", "times": 0.003},
            "layer_thickness": "20 um",
        },
        noise={"family": "lognormal", "noise_scale": 0.1},
        surface="paper_reference",
    )
    inside = at_new_conditions(problem, {"normal_force": [0.7], "sphere_radius": [7e-3]})
    assert inside.problem.model is problem.model and len(told) == 1
    beyond = at_new_conditions(problem, {"normal_force": [2.0], "sphere_radius": [7e-3]})
    assert beyond.problem.conditions.n_rows == 1 and len(told) == 2
    assert told[1][1] == told[0][1] == {"young_modulus_bulk": ("young_modulus_layer", 0.003)}
    assert told[1][0]["normal_force"] == (2.0, 2.0)
