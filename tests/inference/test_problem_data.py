"""A model file bound to its data: data that do not fit the model, fingerprints."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import stats
from small_models import FINGER, write_model

from skinbayes.errors import InputError
from skinbayes.files.locate import shipped_folder, shipped_names
from skinbayes.problem import load_problem

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
        (tmp_path / "c.csv").write_text(
            "# convention: paper\nwavevector [1/m],power_spectrum_2d [m^4]\n" + rows
        )
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


def test_every_shipped_model_loads():
    for name in shipped_names("models"):
        problem = load_problem(name)
        for values in problem.inputs(problem.prior_medians()[np.newaxis]).values():
            assert not np.isnan(values).any()


def test_rows_without_those_of_a_product(tmp_path):
    rows = tmp_path / "rows.csv"
    rows.write_text(
        "state,normal_force [N],sphere_radius [m],friction_coefficient [1]\nwet,0.5,0.008,1.3\nwet,1,0.008,1.5\n"
    )
    for problem in (load_problem("forearm-glass", data=rows), load_problem("forearm-glass", conditions=rows)):
        theta = problem.draw_prior(np.random.default_rng(3), 3)
        found = problem.derived(theta)
        assert "shear_stress_over_yield_stress" not in found
        expected = theta[:, 0] / theta[:, 2] / found["rms_slope"][:, 0]
        assert_allclose(found["shear_stress_over_modulus_slope"][:, 0], expected, rtol=1e-12)
