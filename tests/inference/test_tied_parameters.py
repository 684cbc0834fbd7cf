"""Parameters tied to one another, and solids of one material, in problems."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.errors import InputError

DATA = {"normal_force [N]": [0.1, 0.2], "state": ["dry", "wet"], "friction_coefficient": [1.0, 2.0]}
REST = {"sphere_radius": "8 mm", "frictional_shear_stress": "5 MPa"}
SOFT = {"lognormal": ["2 MPa", 0.5]}
HALF = {"same_as": "young_modulus_layer", "times": 0.5, "source": "made up for a test"}
LAYER = {**REST, "layer_thickness": "20 um"}


def problem(noise: Any = 0.2, **parameters: Any) -> sb.Problem:
    return sb.build_problem(
        "friction",
        DATA,
        parameters=parameters,
        surface="paper_reference",
        noise={"family": "lognormal", "noise_scale": noise},
    )


def test_a_tied_parameter_follows_and_is_not_free(tmp_path: Path) -> None:
    tied = problem(**LAYER, young_modulus_layer=SOFT, young_modulus_bulk=HALF)
    assert tied.names == ("young_modulus_layer",)
    for layer in (1e6, 4e6):
        fixed = problem(**LAYER, young_modulus_layer=layer, young_modulus_bulk=layer / 2)
        assert (
            tied.predict([layer])["friction_coefficient"] == fixed.predict([])["friction_coefficient"]
        ).all()
    assert "young_modulus_bulk = 0.5 × young_modulus_layer" in str(tied)
    assert any("= 0.5 × young_modulus_layer" in line for line in tied.check().priors)
    other = problem(**LAYER, young_modulus_layer=SOFT, young_modulus_bulk={**HALF, "times": 0.6})
    assert other.fingerprint != tied.fingerprint
    text = tied.to_toml(tmp_path / "tied.toml")
    assert 'same_as = "young_modulus_layer"\ntimes = 0.5\nsource = "made up for a test"' in text
    assert sb.load_problem(tmp_path / "tied.toml").fingerprint == tied.fingerprint
    # a prior that becomes a value takes what is tied to it along
    (layer_spec,) = tied.free
    held = replace(tied, free=(), fixed=(*tied.fixed, replace(layer_spec, prior=None, value=3e6)))
    assert held.inputs(np.zeros((1, 0)))["young_modulus_bulk"] == [[1.5e6]]
    held = sb.load_problem(tmp_path / "tied.toml", settings={"young_modulus_layer": "6 MPa"})
    assert held.inputs(np.zeros((1, 0)))["young_modulus_bulk"] == [[3e6]]


def drying(**parameters: Any) -> sb.Problem:
    given = {
        **LAYER, "young_modulus_layer": "7 MPa", "young_modulus_bulk": "20 kPa", "young_modulus_layer_dry": "1 GPa",
        "yield_stress": "50 MPa", "nominal_pressure": "6.83 kPa", "surface_tension": "72 mN/m", "contact_angle_skin": "80 deg",
        "contact_angle_counterface": "0 deg", "wetting_time": "30 s", "initial_film": "90 um", "evaporation_rate": "0.17 um/s",
    }  # fmt: skip
    given.pop("sphere_radius")
    return sb.build_problem(
        "drying",
        {"time [s]": [0.0, 300.0, 420.0, 500.0, 540.0], "friction_coefficient": [1.0] * 5},
        parameters=given | parameters,
        surface="paper_reference",
        noise={"family": "lognormal", "noise_scale": 0.2},
    )


def test_a_table_holds_no_more_than_a_tie_leaves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Moduli that go together are one axis of a table of bridged skin; a box of both has skins without bridges to solve."""
    monkeypatch.setenv("SKINBAYES_CACHE", "")
    soft = {"lognormal": ["20 kPa", 0.2]}
    tied = drying(
        young_modulus_bulk=soft, young_modulus_layer={"same_as": "young_modulus_bulk", "times": 350}
    )
    assert "interpolated" in tied.model.accuracy
    theta = tied.draw_prior(np.random.default_rng(5), 6)
    with np.errstate(all="ignore"):
        solved = tied.forward.evaluate(tied.inputs(theta), tied.tables)["friction_coefficient"]
    assert tied.predict(theta)["friction_coefficient"] == pytest.approx(solved, rel=4e-3)
    assert np.ptp(np.log(solved[:, 2])) > 0.1
    apart = drying(young_modulus_bulk=soft, young_modulus_layer={"lognormal": ["7 MPa", 0.2]})
    assert apart.model.evaluate is apart.forward.evaluate and "(same_as)" in apart.model.accuracy


def test_a_layer_that_hardens_leaves_its_tie(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []
    monkeypatch.setattr("skinbayes.forward.drying_table.corners", lambda *given: seen.append(given[2]))
    tie = {"same_as": "young_modulus_bulk", "times": 350}
    parameters = {"young_modulus_bulk": {"lognormal": ["20 kPa", 0.2]}, "young_modulus_layer": tie}
    for more in ({}, {"hardening_film": "1 um"}):
        drying(**parameters, **more).prepare()
    assert seen == [{"young_modulus_layer": ("young_modulus_bulk", 350.0)}, {}]


def test_ties_to_levels(tmp_path: Path) -> None:
    levels = {"by": "state", "dry": SOFT, "wet": {"same_as": "young_modulus_layer[dry]", "times": 0.1}}
    for entry, expected in (
        (HALF, [[2e6, 2e5]]),  # level by level, through the tie of another
        ({"same_as": "young_modulus_layer[wet]"}, [[4e5]]),
    ):
        tied = problem(**LAYER, young_modulus_layer=levels, young_modulus_bulk=entry)
        inputs = tied.inputs(np.array([[4e6]]))
        assert inputs["young_modulus_layer"] == pytest.approx(np.array([[4e6, 4e5]]))
        assert inputs["young_modulus_bulk"] == pytest.approx(np.array(expected))
        tied.to_toml(tmp_path / f"{len(expected[0])}.toml")
        assert sb.load_problem(tmp_path / f"{len(expected[0])}.toml").fingerprint == tied.fingerprint


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"young_modulus_layer": {"same_as": "young_modulus_bulk"}}, "tied in a circle"),
        ({"young_modulus_bulk": {"same_as": "young_modulus_bulk"}}, "tied in a circle"),
        ({"young_modulus_bulk": {"same_as": "young_modulus_lay"}}, "Did you mean 'young_modulus_layer'"),
        ({"young_modulus_bulk": {"same_as": "young_modulus_layer[dry]"}}, r"no parameter 'young_modulus_layer\[dry\]'"),
        ({"young_modulus_bulk": {"same_as": "normal_force"}}, "is a column of the data"),
        ({"young_modulus_bulk": {"same_as": "layer_thickness"}}, "has the unit m; expected a parameter in Pa"),
        ({"poisson_ratio_bulk": {"same_as": "poisson_ratio_layer", "times": 2}}, "reaches from 0.4 to 0.8"),
        ({"young_modulus_bulk": {**HALF, "times": -1}}, "expected a finite number > 0"),
        ({"young_modulus_bulk": {**HALF, "fixed": "2 Pa"}}, "unknown key 'fixed' beside 'same_as'"),
        ({"noise": {"same_as": "hurst_exponent"}}, "only inputs of the forward model"),
    ],
)  # fmt: skip
def test_ties_that_cannot_be(changes: dict[str, Any], said: str) -> None:
    poisson = {"poisson_ratio_layer": {"uniform": [0.2, 0.4]}}
    with pytest.raises(InputError, match=said):
        problem(**{**LAYER, "young_modulus_layer": SOFT, "young_modulus_bulk": HALF, **poisson, **changes})


def test_a_solid_of_one_material() -> None:
    """The same friction as layered skin of equal moduli, by another parametrisation."""
    solid = problem(**REST, young_modulus=SOFT, poisson_ratio=0.45)
    same = problem(
        **LAYER,
        young_modulus_layer=SOFT,
        young_modulus_bulk={"same_as": "young_modulus_layer"},
        poisson_ratio_layer=0.45,
        poisson_ratio_bulk=0.45,
    )
    for theta in ([1e6], [5e6]):
        assert solid.log_posterior(theta) == pytest.approx(same.log_posterior(theta), rel=1e-10)
    labels = {p.label for p in solid.fixed}
    assert "poisson_ratio" in labels and not {"poisson_ratio_layer", "layer_thickness"} & labels
    assert "poisson_ratio" not in {p.label for p in same.fixed}


@pytest.mark.parametrize(
    ("further", "said"),
    [
        ({"young_modulus_layer": "1 MPa"}, "young_modulus and young_modulus_layer exclude each other"),
        ({"layer_thickness": "1 mm"}, "young_modulus and layer_thickness exclude each other"),
        ({"poisson_ratio_layer": 0.4}, "'poisson_ratio_layer' has no effect without layer_thickness"),
    ],
)
def test_layered_and_homogeneous_at_once(further: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        problem(**REST, young_modulus=SOFT, **further)


def test_what_is_missing_of_layered_skin_is_named() -> None:
    with pytest.raises(InputError, match="Not given: young_modulus_bulk and layer_thickness"):
        problem(**REST, young_modulus_layer=SOFT)


def test_set_values_beside_ties(tmp_path: Path) -> None:
    levels = {"by": "state", "dry": SOFT, "wet": {"same_as": "young_modulus_layer[dry]", "times": 0.1}}
    to_level = {"same_as": "young_modulus_layer[dry]", "times": 0.5}
    problem(**LAYER, young_modulus_layer=levels, young_modulus_bulk=to_level).to_toml(tmp_path / "level.toml")
    text = problem(**LAYER, young_modulus_layer=levels, young_modulus_bulk=HALF).spec.text
    (tmp_path / "whole.toml").write_text(text.replace("my-model-data", "level-data"))

    def inputs(name: str, **settings: str) -> dict[str, list[list[float]]]:
        found = sb.load_problem(tmp_path / f"{name}.toml", settings=settings)
        return {key: value.tolist() for key, value in found.inputs(np.zeros((1, 0))).items()}

    # what is tied to a level follows a value that is set for all of them
    found = inputs("level", young_modulus_layer="6 MPa")
    assert found["young_modulus_layer"] == [[6e6]] and found["young_modulus_bulk"] == [[3e6]]
    found = inputs("level", **{"young_modulus_layer[dry]": "6 MPa"})
    assert found["young_modulus_layer"] == [[6e6, 6e5]] and found["young_modulus_bulk"] == [[3e6]]
    with pytest.raises(
        InputError, match=r"--set young_modulus_bulk\[dry\]: the model file ties all of young_modulus_bulk to"
    ):
        inputs("whole", **{"young_modulus_bulk[dry]": "1 MPa"})


def test_the_page_names_tied_values() -> None:
    from skinbayes.report.page import render

    for bulk, heading in ((HALF, "Fixed and tied values"), ("20 kPa", "Fixed values")):
        found = problem(**LAYER, young_modulus_layer=SOFT, young_modulus_bulk=bulk)
        draws = found.draw_prior(np.random.default_rng(1), 400)
        assert f"<h3>{heading} and where" in render(sb.Fit.from_draws(found, draws))
