"""Problems from values of Python, and the model files that problems write."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pint
import pytest

import skinbayes as sb
from skinbayes.files.locate import shipped_names
from skinbayes.problem import Problem
from skinbayes.roughness import TabulatedSpectrum
from skinbayes.statistics import make_prior

UNITS = pint.UnitRegistry()
SKIN = {
    "frictional_shear_stress": {"loguniform": ["0.5 MPa", 500e6]},
    "young_modulus_layer": {
        "by": "state",
        "dry": {"lognormal": [0.75 * UNITS.GPa, 0.7]},
        "wet": make_prior("lognormal", [7e6, 0.5]),
    },
    "yield_stress": {"by": "state", "dry": {"lognormal": ["50 MPa", 0.5]}, "wet": np.inf},
    "young_modulus_bulk": {"lognormal": [20 * UNITS.kPa, np.float64(0.35)]},
    "layer_thickness": {"lognormal": [20.5e-6, 0.15], "source": "the data set"},
    "rms_height": {"lognormal": ["22.4 um", 0.35]},
}
NOISE = {"family": "lognormal", "noise_scale": 0.1}


def forearm(data: object, **others: object) -> Problem:
    given = {"parameters": SKIN, "noise": NOISE, "surface": "paper_reference", "name": "mine", **others}
    return sb.build_problem("friction", data, **given)


def measured() -> pd.DataFrame:
    """The columns of a shipped data set in units of their own."""
    columns = sb.load_dataset("adams2007-forearm-glass").columns
    return pd.DataFrame(
        {
            "state": columns["state"],
            "body_site": columns["body_site"],
            "counterface": columns["counterface"],
            "friction_coefficient": columns["friction_coefficient"],
            "normal_force [mN]": 1e3 * columns["normal_force"],
            "sphere_radius [mm]": 1e3 * columns["sphere_radius"],
            "sliding_speed [mm/s]": 1e3 * columns["sliding_speed"],
        }
    )


def test_values_make_the_problem_that_the_model_file_makes() -> None:
    shipped = sb.load_problem("forearm-glass")
    for data in (
        "adams2007-forearm-glass",
        measured(),
        dict(measured()),
        sb.Dataset.from_columns(measured()),
    ):
        problem = forearm(data)
        assert problem.names == shipped.names
        theta = shipped.prior_medians()
        assert problem.log_posterior(theta) == pytest.approx(shipped.log_posterior(theta), rel=1e-12)
    assert forearm("adams2007-forearm-glass").fingerprint == shipped.fingerprint


def test_quantities_of_pint_in_columns() -> None:
    frame = measured()
    columns = {
        "state": frame["state"],
        "normal_force": frame["normal_force [mN]"].to_numpy() * UNITS.mN,
        "sphere_radius": 8 * np.ones(2) * UNITS.mm,
        "friction_coefficient": frame["friction_coefficient"],
    }
    assert forearm(columns).conditions.values["sphere_radius"].tolist() == [0.008, 0.008]


@pytest.mark.parametrize("name", shipped_names("models"))
def test_the_file_that_a_shipped_problem_writes_makes_it_again(name: str, tmp_path: Path) -> None:
    problem = sb.load_problem(name)
    text = problem.to_toml(tmp_path / "mine.toml")
    again = sb.load_problem(tmp_path / "mine.toml")
    assert (tmp_path / "mine.toml").read_text(encoding="utf-8") == text
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"]
    assert again.fingerprint == problem.fingerprint
    assert (
        again.spec.derived == problem.spec.derived
        and again.spec.baseline_models == problem.spec.baseline_models
    )
    assert again.spec.description == problem.spec.description
    assert [p.source for p in again.free] == [p.source for p in problem.free]


def test_a_data_frame_goes_into_a_file_beside_the_model(tmp_path: Path) -> None:
    problem = forearm(
        measured(),
        rows={"state": ["wet"]},
        parameters={**SKIN, "young_modulus_layer": "7 MPa", "yield_stress": "inf Pa"},
    )
    assert problem.conditions.n_rows == 1
    problem.to_toml(tmp_path / "mine.toml")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine-data.csv", "mine.toml"]
    assert sb.load_problem(tmp_path / "mine.toml").fingerprint == problem.fingerprint
    with pytest.raises(sb.InputError, match="there already"):
        problem.to_toml(tmp_path / "mine.toml")


def test_settings_and_replaced_priors_are_in_the_file(tmp_path: Path) -> None:
    problem = sb.load_problem(
        "drying", settings={"closure": "sharp", "initial_film": "50 um", "surface": "paper_printed"}
    )
    assert 'closure = "sharp"' in problem.to_toml(tmp_path / "set.toml")
    assert sb.load_problem(tmp_path / "set.toml").fingerprint == problem.fingerprint
    shipped = sb.load_problem("finger-null")
    first, *others = shipped.free
    changed = replace(shipped, free=(replace(first, prior=make_prior("lognormal", [0.7, 0.2])), *others))
    assert changed.fingerprint != shipped.fingerprint
    changed.to_toml(tmp_path / "changed.toml")
    assert sb.load_problem(tmp_path / "changed.toml").fingerprint == changed.fingerprint
    cut = replace(shipped, free=(replace(first, prior=first.prior.truncated(0.1, 0.9)), *others))
    with pytest.raises(sb.InputError, match="cut off"):
        cut.to_toml()


def test_liquids_groups_covariates_and_a_spectrum_from_values(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    wavevector = np.geomspace(1e3, 1e8, 40)
    spectrum = TabulatedSpectrum(wavevector, 1e-15 * (wavevector / 1e3) ** -3.5, scale=1.7)
    rates = np.geomspace(1e-2, 1e3, 8)
    columns = {
        "person": np.repeat(["A", "B", "C"], 4),
        "liquid": np.tile(["oil", "gel"], 6),
        "sliding_speed": rng.uniform(1e-3, 0.1, 12),
        "skin_hydration": rng.uniform(20, 60, 12),
        "normal_force": np.full(12, 1.0),
        "friction_coefficient": rng.uniform(0.2, 1, 12),
    }
    problem = sb.build_problem(
        "stribeck",
        columns,
        name="liquids",
        surface=spectrum,
        parameters={
            "frictional_shear_stress": {"lognormal": ["5 MPa", 1.0]},
            "young_modulus_layer": "10 MPa",
            "young_modulus_bulk": 5e4,
            "layer_thickness": "170 um",
            "sphere_radius": 10 * UNITS.mm,
        },
        noise={"family": "lognormal", "noise_scale": {"half_normal": 0.3}},
        groups={"person": {"half_normal": 0.3}},
        covariates={
            "wetness": {
                "column": "skin_hydration",
                "acts_on": "frictional_shear_stress",
                "reference": 40,
                "exponent": {"normal": [0, 1]},
            }
        },
        rheology={
            "by": "liquid",
            "data": {
                "liquid": np.repeat(["oil", "gel"], 8),
                "shear_rate": np.tile(rates, 2),
                "viscosity": np.concatenate([np.full(8, 0.1), 2 / (1 + rates)]),
            },
        },
        derived={"strength": {"product": {"frictional_shear_stress": 1, "young_modulus_layer": -1}}},
    )
    assert problem.names[-3:] == ("covariate_exponent[wetness]", "noise_scale", "group_scale[person]")
    assert set(problem.flow_curves) == {"oil", "gel"}
    problem.to_toml(tmp_path / "mine.toml")
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["mine-data.csv", "mine-rheology.csv", "mine-spectrum.csv", "mine.toml"]
    again = sb.load_problem(tmp_path / "mine.toml")
    assert again.names == problem.names and again.data_fingerprint == problem.data_fingerprint
    np.testing.assert_allclose(again.tables.spectrum.node_power, 1.7 * spectrum.node_power, rtol=1e-14)


def test_several_observables_and_conditions_from_values() -> None:
    problem = sb.build_problem(
        "stribeck-descriptive",
        parameters={
            "plateau_friction_coefficient": 0.9,
            "transition_speed_viscosity_product": "1e-3 N/m",
            "transition_exponent": 1.0,
            "rising_friction_coefficient": 0.01,
            "rising_exponent": 0.5,
            "normal_force": "1 N",
        },
        conditions={"speed_viscosity_product": np.geomspace(1e-6, 1e-1, 5)},
    )
    assert problem.predict([])["friction_coefficient"].shape == (5,)
    told = sb.load_problem("drying-timing")
    values = {name: column for name, column in told.dataset.columns.items() if name in told.dataset.units}
    noise = {"family": "gaussian", "noise_scale": "20 s"}
    several = sb.build_problem(
        "drying-features",
        values,
        observable=["dry_time", "peak_width"],
        spread="ignore",
        noise={"dry_time": noise, "peak_width": noise},
        parameters={
            p.name: {p.prior.family: p.prior.arguments} if p.prior else p.value
            for p in told.free + told.fixed
            if p.name in told.forward.input_names()
        },
    )
    assert several.observables == ("dry_time", "peak_width")
    assert [p.unit for p in several.fixed if p.name == "noise_scale"] == ["s", "s"]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"parameters": {**SKIN, "yield_stres": "1 MPa"}},
            "mine: parameters.yield_stres: unknown parameter.*yield_stress",
        ),
        (
            {"parameters": {**SKIN, "rms_height": 3 * UNITS.kg}},
            "mine: parameters.rms_height: found 3 kilogram; expected a quantity in m",
        ),
        (
            {"parameters": {**SKIN, "rms_height": -1e-6}},
            "mine: parameters.rms_height: found -1e-06 m; expected a rms_height > 0 m",
        ),
        ({"parameters": {**SKIN, "rms_height": True}}, "mine: parameters.rms_height: found True"),
        ({"noise": None}, r"\[noise\] is missing"),
        ({"surface": "papier"}, "papier"),
        ({"rows": {"state": ["damp"]}}, "damp"),
        (
            {"options": {"closure": "sharp"}},
            "the forward model 'friction' has no option 'closure'; it takes none",
        ),
        ({"spread": "maybe"}, "spread: found 'maybe'"),
        ({"groups": {"state": {"half_normal": 50}}}, "mine: groups.state.scale: the prior reaches"),
    ],
)
def test_what_does_not_fit_is_named(change: dict, said: str) -> None:
    with pytest.raises(sb.InputError, match=said):
        forearm(measured(), **change)


def test_a_fit_of_a_data_frame_is_kept_and_read_again(tmp_path: Path) -> None:
    problem = sb.build_problem(
        "constant",
        {"friction_coefficient": [0.31, 0.27, 0.33]},
        name="few",
        parameters={"typical_friction_coefficient": {"lognormal": [0.5, 1.0]}},
        noise={"family": "lognormal", "noise_scale": {"half_normal": 0.3}},
    )
    fit = sb.sample(problem, seed=1, ess=200, max_steps=300, directory=tmp_path / "run")
    again = sb.load_fit(tmp_path / "run")
    assert again.problem is not None and again.problem.fingerprint == problem.fingerprint
    assert again.problem.name == "few"
    np.testing.assert_array_equal(
        again.groups["posterior"]["noise_scale"].values, fit.groups["posterior"]["noise_scale"].values
    )
