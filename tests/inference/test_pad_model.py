"""A finger pad of given contact area as a statistical model: what it needs, and its table against the film solver."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from skinbayes.errors import InputError
from skinbayes.problem import load_problem

MODEL = """
format = 1
title = "A finger pad in two liquids"
forward = "stribeck"

[options]
contact = "pad"

[data]
file = "mine.csv"
observable = "friction_coefficient"

[surface]
name = "paper_reference"

[parameters]
frictional_shear_stress = {{ lognormal = ["10 MPa", 0.5] }}
young_modulus_layer = "7 MPa"
young_modulus_bulk = {{ lognormal = ["50 kPa", 0.1] }}
layer_thickness = "173 um"
nominal_area_ratio = {{ lognormal = [0.5, 0.05] }}
nominal_area_load_exponent = 0.4
{parameters}

[noise]
family = "lognormal"
noise_scale = {{ half_normal = 0.3 }}
"""

ROWS = """nominal_contact_area [mm^2],normal_force [N],speed_viscosity_product [N/m],friction_coefficient [1]
330,0.4,1e-3,1.1
330,1,1e-2,0.5
380,0.5,0.05,0.1
380,1.2,0.3,0.2
"""


def write(folder: Path, parameters: str = 'inlet_length = "3 mm"', rows: str = ROWS) -> Path:
    (folder / "mine.csv").write_text(rows, encoding="utf-8")
    path = folder / "mine.toml"
    path.write_text(MODEL.format(parameters=parameters), encoding="utf-8")
    return path


def test_a_pad_needs_areas_and_an_inlet(tmp_path: Path) -> None:
    without = "\n".join(row.split(",", 1)[1] for row in ROWS.splitlines())
    with pytest.raises(InputError, match="nominal_contact_area"):
        load_problem(write(tmp_path, rows=without + "\n"))
    with pytest.raises(InputError, match="inlet_length"):
        load_problem(write(tmp_path, parameters=""))
    with pytest.raises(InputError, match="sphere_radius"):
        load_problem(write(tmp_path, parameters='inlet_length = "3 mm"\nsphere_radius = "1 cm"'))
    varied = load_problem(write(tmp_path, parameters='inlet_length = { lognormal = ["3 mm", 0.5] }'))
    with pytest.raises(InputError, match="inlet_length goes from"):
        varied.prepare()


@pytest.mark.slow
def test_the_table_of_a_pad_is_the_film_solver(tmp_path: Path) -> None:
    problem = load_problem(write(tmp_path))
    theta = np.array([[10e6, 50e3, 0.5, 0.2], [15e6, 62e3, 0.45, 0.2], [8e6, 42e3, 0.55, 0.2]])
    found = problem.predict(theta)
    exact = problem.forward.evaluate(problem.inputs(theta), problem.tables)
    # 360 cells of the solver against 400 in the table: each within 0.5 % of many more, and 1 % of the axes
    for name in ("friction_coefficient", "central_film_thickness"):
        assert_allclose(found[name], exact[name], rtol=2e-2, err_msg=name)
    assert np.ptp(np.log(found["friction_coefficient"])) > 1
    flags = problem.forward.flags(problem.inputs(theta), problem.tables)
    for name, flag in problem.flags(theta).items():
        assert_array_equal(flag, np.broadcast_to(flags[name], flag.shape), err_msg=name)
    batch = problem.log_likelihood(theta)
    assert np.isfinite(batch).all()
    assert_array_equal(problem.log_likelihood(theta[1]), batch[1])
