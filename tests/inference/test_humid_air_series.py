"""Friction against humidity as data: parameters come back, the table of bridged gaps serves, batches are their rows.

The series are simulated here, with the noise that their model file states.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_models import write_model

from skinbayes.errors import InputError
from skinbayes.fit import sample
from skinbayes.plot import plot_profile
from skinbayes.problem import Problem, load_problem

PAGE = Path(__file__).parents[2] / "docs" / "humidity.md"
FIXED = {
    "frictional_shear_stress": '"15 MPa"',
    "young_modulus_layer_dry": '"1 GPa"',
    "young_modulus_layer_wet": '"7 MPa"',
    "transition_humidity": "0.7",
    "transition_sharpness": "1.3",
    "young_modulus_bulk": '"20 kPa"',
    "layer_thickness": '"20 um"',
    "yield_stress": '"50 MPa"',
    "nominal_pressure": '"6.83 kPa"',
    "temperature": '"20 degC"',
    "contact_angle_skin": '"80 deg"',
    "contact_angle_counterface": '"10 deg"',
}
CURVE = ("young_modulus_layer_dry", "young_modulus_layer_wet", "transition_humidity", "transition_sharpness")
FREE = {
    "frictional_shear_stress": '{ lognormal = ["12 MPa", 0.5] }',
    "young_modulus_layer_wet": '{ lognormal = ["7 MPa", 0.4] }',
    "transition_humidity": "{ beta = [14, 6] }",
    "transition_sharpness": "{ lognormal = [1.5, 0.4] }",
}
TRUTH = {
    "frictional_shear_stress": 15e6, "young_modulus_layer_wet": 7e6, "transition_humidity": 0.7,
    "transition_sharpness": 1.3, "rms_height": 22.4e-6, "layer_thickness": 20e-6, "young_modulus_bulk": 20e3,
    "contact_angle_counterface": 0.2, "hurst_exponent": 0.78, "young_modulus_layer_dry": 1e9, "yield_stress": 50e6,
}  # fmt: skip
HUMIDITY = np.array([0.05, 0.2, 0.35, 0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.93, 1.0])
MORE = {
    **FREE,
    "rms_height": '{ lognormal = ["22.4 um", 0.2] }',
    "young_modulus_bulk": '{ lognormal = ["20 kPa", 0.2] }',
    "contact_angle_counterface": '{ uniform = ["0 deg", "30 deg"] }',
    "young_modulus_layer_dry": '{ lognormal = ["1 GPa", 0.5] }',
    "yield_stress": '{ lognormal = ["50 MPa", 0.4] }',
}


def model(
    folder: Path, free: dict[str, str], columns: dict[str, np.ndarray] | None = None, closure: str = "gaussian"
) -> Problem:  # fmt: skip
    """A problem whose data were drawn from it at the true parameters, seed 3."""
    table = {"relative_humidity [1]": HUMIDITY} if columns is None else columns
    entries = {**FIXED, **free}
    if "young_modulus_layer" in free or any(name.startswith("young_modulus_layer [") for name in table):
        entries = {name: text for name, text in entries.items() if name not in CURVE}
    lines = "\n".join(f"{name} = {text}" for name, text in entries.items())
    path = write_model(
        folder,
        f'title = "A forearm in a climate chamber"\nforward = "humid-air"\noptions = {{ closure = "{closure}" }}\n'
        f'[data]\nfile = "mine.csv"\nobservable = "friction_coefficient"\n'
        f'[surface]\nname = "paper_reference"\n'
        f'[noise]\nfamily = "lognormal"\nnoise_scale = 0.05\n[parameters]\n{lines}\n',
    )

    def bound(friction: np.ndarray) -> Problem:
        rows = zip(*(x.tolist() for x in table.values()), friction.tolist(), strict=True)
        text = [",".join([*table, "friction_coefficient [1]"]), *(",".join(map(repr, row)) for row in rows)]
        (folder / "mine.csv").write_text("\n".join(text) + "\n", encoding="utf-8")
        return load_problem(path)

    blank = bound(np.ones(len(next(iter(table.values())))))
    return bound(blank.simulate(truth(blank), np.random.default_rng(3)))


def truth(problem: Problem) -> np.ndarray:
    return np.array([TRUTH[name] for name in problem.names])


def about_truth(problem: Problem, count: int, reach: float = 0.1) -> np.ndarray:
    scatter = np.random.default_rng(5).normal(size=(count, problem.dimension))
    return truth(problem) * np.exp(reach * scatter)


def test_the_curve_of_the_modulus_comes_back(tmp_path: Path) -> None:
    problem = model(tmp_path, FREE)
    fit = sample(problem, seed=1, ess=200, ensembles=2, walkers=32, block_steps=50, steps_over_tau=20)
    assert fit.converged
    for name, value in zip(problem.names, truth(problem), strict=True):
        low, high = np.quantile(fit.draws(name), [0.005, 0.995])
        assert low < value < high, name
    # four dry rows of 5 % noise tell the shear stress, and the rise of friction where the layer softens
    summary = fit.summary()
    spread = np.log(summary["q95"] / summary["q05"]) / 3.29
    assert spread["frictional_shear_stress"] < 0.04
    assert spread["transition_humidity"] < 0.05
    figure = plot_profile(fit)
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert len(labels) == 3
    assert [
        word in label for word, label in zip(("friction", "contact area", "modulus"), labels, strict=True)
    ]
    measured = [line.get_xdata() for line in figure.axes[0].lines if line.get_linestyle() == "None"]
    assert any(np.array_equal(x, HUMIDITY) for x in measured)
    doubtful = problem.flags(truth(problem))
    assert list(HUMIDITY[doubtful["strong_bridges"][0]]) == [0.85, 0.9, 0.93]
    assert list(HUMIDITY[doubtful["below_molecule"][0]]) == [0.05]


def test_a_table_serves_the_likelihood(tmp_path: Path) -> None:
    problem = model(tmp_path, MORE)
    assert "interpolated" in problem.model.accuracy
    theta = about_truth(problem, 8)
    tabulated, solved = (
        m.evaluate(problem.inputs(theta), problem.tables) for m in (problem.model, problem.forward)
    )
    # a few times the root mean square that the table states
    for name in ("friction_coefficient", "relative_contact_area"):
        np.testing.assert_allclose(tabulated[name], solved[name], rtol=5e-3)
    total = [6830.0 + found["capillary_pressure"] for found in (tabulated, solved)]
    np.testing.assert_allclose(*total, rtol=3e-3)
    np.testing.assert_array_equal(tabulated["capillary_pressure"][:, -1], 0.0)
    for name, values in problem.forward.flags(problem.inputs(theta), problem.tables).items():
        np.testing.assert_array_equal(
            problem.model.flags(problem.inputs(theta), problem.tables)[name], values
        )


def test_what_the_table_does_not_reach_is_solved(tmp_path: Path) -> None:
    problem = model(tmp_path, FREE)
    stiff = truth(problem)
    stiff[problem.names.index("young_modulus_layer_wet")] = 5e9
    both = problem.predict(np.stack([truth(problem), stiff]))["friction_coefficient"]
    np.testing.assert_array_equal(both[0], problem.predict(truth(problem))["friction_coefficient"])
    inputs = problem.inputs(stiff[np.newaxis])
    alone = problem.forward.evaluate(inputs, problem.tables)["friction_coefficient"][0]
    np.testing.assert_allclose(both[1], alone, rtol=1e-3)
    # stiffer than any layer of the priors
    np.testing.assert_array_equal(both[1, HUMIDITY > 0.7], alone[HUMIDITY > 0.7])


@pytest.mark.parametrize(
    ("free", "tabulated"),
    [
        ({"layer_thickness": '{ lognormal = ["20 um", 0.05] }'}, True),
        ({"hurst_exponent": "{ truncated_normal = [0.78, 0.03, 0.5, 0.95] }"}, False),
    ],
)
def test_what_a_table_is_built_for(tmp_path: Path, free: dict[str, str], tabulated: bool) -> None:
    rows = {"relative_humidity [1]": np.array([0.3, 0.85])}
    problem = model(tmp_path, free, rows)
    assert ("interpolated" in problem.model.accuracy) == tabulated
    assert ("same_as" in problem.model.accuracy) != tabulated
    theta = about_truth(problem, 3, 0.01)
    solved = problem.forward.evaluate(problem.inputs(theta), problem.tables)["friction_coefficient"]
    np.testing.assert_allclose(problem.predict(theta)["friction_coefficient"], solved, rtol=4e-3)


@pytest.mark.parametrize("closure", ["gaussian", "sharp"])
def test_a_batch_and_its_rows_agree_to_the_last_bit(tmp_path: Path, closure: str) -> None:
    problem = model(tmp_path, MORE, closure=closure)
    theta = about_truth(problem, 5)
    batch, whole = problem.log_likelihood(theta, pointwise=True), problem.predict(theta)
    assert np.isfinite(batch).all()
    for i, one in enumerate(theta):
        np.testing.assert_array_equal(batch[i], problem.log_likelihood(one, pointwise=True))
        for name, values in problem.predict(one).items():
            np.testing.assert_array_equal(whole[name][i], values)


def test_the_likelihood_has_no_kinks(tmp_path: Path) -> None:
    problem = model(tmp_path, MORE)
    for seed in range(3):
        direction = np.random.default_rng(seed).normal(size=problem.dimension) * 0.01

        def bend(count: int, direction: np.ndarray = direction) -> float:
            places = np.linspace(-1.0, 1.0, count)
            value = problem.log_likelihood(truth(problem) * np.exp(places[:, np.newaxis] * direction))
            return float(np.max(np.abs(np.diff(np.diff(value) / np.diff(places)))))

        # where the gradient is continuous its changes halve with the step; a kink would keep its own
        assert bend(241) < 0.6 * bend(121)


def test_moduli_of_the_users_own_beside_the_humidity(tmp_path: Path) -> None:
    moduli = np.array([2e9, 1.1e9, 4e8, 9e7, 1.1e7])
    rows = {
        "relative_humidity [%]": np.array([10.0, 30.0, 50.0, 70.0, 90.0]),
        "young_modulus_layer [MPa]": moduli / 1e6,
    }
    free = {name: MORE[name] for name in ("frictional_shear_stress", "rms_height")}
    problem = model(tmp_path, free, rows)
    assert problem.names == ("frictional_shear_stress", "rms_height")
    assert "interpolated" in problem.model.accuracy
    found = problem.predict(truth(problem))["friction_coefficient"]
    for i, modulus in enumerate(moduli):
        inputs = problem.inputs(truth(problem)[np.newaxis]) | {
            "relative_humidity": np.array([[0.1 + 0.2 * i]]),
            "young_modulus_layer": np.array([[modulus]]),
        }
        alone = problem.forward.evaluate(inputs, problem.tables)["friction_coefficient"]
        assert found[i] == pytest.approx(float(alone[0, 0]), rel=1e-3)
    # a curve at the modulus of one row would connect nothing, and none is offered
    assert problem.profiles == ()
    (tmp_path / "one").mkdir()
    one = model(tmp_path / "one", {**free, "young_modulus_layer": '"20 MPa"'})
    assert [profile.ordinate for profile in one.profiles] == ["friction_coefficient", "relative_contact_area"]


def test_a_column_of_moduli_beside_a_curve_is_refused(tmp_path: Path) -> None:
    problem = model(tmp_path, FREE)
    path = problem.spec.path
    (tmp_path / "mine.csv").write_text(
        "relative_humidity [1],young_modulus_layer [MPa],friction_coefficient [1]\n0.3,900,0.3\n0.8,30,0.5\n",
        encoding="utf-8",
    )
    with pytest.raises(
        InputError, match="young_modulus_layer and young_modulus_layer_dry exclude each other"
    ):
        load_problem(path)


# -- the page ------------------------------------------------------------------------------------------------------------


def block(language: str) -> str:
    found = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.M | re.S)
    return next(
        text
        for name, text in found
        if name == language and text.startswith(("format", "relative_humidity", "from"))
    )


def test_the_page_has_a_model_its_series_and_an_example(tmp_path: Path) -> None:
    (tmp_path / "my-humidity.csv").write_text(block(""), encoding="utf-8")
    (tmp_path / "my-humidity.toml").write_text(block("toml"), encoding="utf-8")
    problem = load_problem(tmp_path / "my-humidity.toml")
    assert {*FREE, "rms_height", "yield_stress", "noise_scale"} <= set(problem.names)
    assert "interpolated" in problem.model.accuracy
    # the example is one that the model can make
    found = problem.predict(problem.prior_medians())["friction_coefficient"]
    assert np.corrcoef(np.log(found), np.log(problem.observed))[0, 1] > 0.95
    assert problem.check().identifiability is not None
    names: dict[str, Any] = {}
    exec(block("python").replace("young_modulus_from_table([", "moduli = young_modulus_from_table(["), names)
    assert np.all(np.diff(names["moduli"]) < 0)


@pytest.mark.parametrize(("closure", "place"), [("gaussian", 0), ("sharp", 1)])
def test_the_page_says_what_is_predicted(closure: str, place: int) -> None:
    rows = re.findall(r"^\| (\d+) % \| ([\d.]+)(?: \(([\d.]+)\))? \|", PAGE.read_text(encoding="utf-8"), re.M)
    assert [int(row[0]) for row in rows] == [10, 70, 90, 95, 99, 100]
    for humidity, *values in rows:
        problem = load_problem(
            "humid-air", settings={"closure": closure, "relative_humidity": f"{humidity} %"}
        )
        found = problem.predict(problem.prior_medians())
        said = values[place] or values[0]
        # both closures agree where one number stands for them, to 0.03
        assert found["friction_coefficient"][0] == pytest.approx(
            float(said), abs=0.03 if not values[1] else 0.05
        )
