"""Oils that thin, as an option of the forward model, against films with the viscosity of each place."""

from pathlib import Path

import numpy as np
import pytest

from skinbayes.contact import LayeredSkin, cylinder_of_sphere
from skinbayes.errors import InputError
from skinbayes.lubrication import ShearThinning, asperity_law, lubricated_films
from skinbayes.problem import load_problem
from skinbayes.roughness import named_surface

MODEL = """
title = "Oil"
forward = "stribeck"
options = {{ contact = "line", shear_thinning = "silicone-oil" }}
[surface]
name = "paper_reference"
[parameters]
frictional_shear_stress = "15 MPa"
young_modulus_layer = "7 MPa"
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
sphere_radius = "8 mm"
normal_force = "0.2 N"
sliding_speed = "{speed}"
{more}
[conditions]
{rows}
"""

VISCOSITIES = 'viscosity = { values = ["0.1 Pa s", "10 Pa s", "100 Pa s"] }'


def problem(folder: Path, speed: str = "1 m/s", more: str = "", rows: str = VISCOSITIES):
    path = folder / "oil.toml"
    path.write_text(MODEL.format(speed=speed, more=more, rows=rows), encoding="utf-8")
    return load_problem(path)


def test_one_viscosity_for_each_film_is_enough(tmp_path: Path) -> None:
    found = problem(tmp_path, rows='viscosity = { values = ["1 Pa s", "10 Pa s"] }').predict([])
    plain = load_problem(tmp_path / "oil.toml", settings={"shear_thinning": "none"}).predict([])
    skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    cylinder = cylinder_of_sphere(0.2, 8e-3, reduced_modulus=20e3 / 0.75)
    thinner = 0
    for row, eta in enumerate((1.0, 10.0)):
        films = lubricated_films(
            [eta],  # η0 v at 1 m/s
            cylinder_radius=float(cylinder.cylinder_radius),
            load_per_length=float(cylinder.load_per_length),
            reduced_modulus=20e3 / 0.75,
            asperities=asperity_law(named_surface("paper_reference"), skin),
            rheology=ShearThinning(eta),
        )
        drag = float(films.couette[0] + films.pressure_flow[0])
        parts = (found[f"friction_coefficient_{part}"][row] for part in ("couette", "pressure_flow"))
        if np.isfinite(drag) and np.isfinite(found["friction_coefficient"][row]):
            assert sum(parts) == pytest.approx(drag, rel=0.03)
            thinner += found["friction_coefficient"][row] < 0.99 * plain["friction_coefficient"][row]
    assert thinner


def test_it_needs_the_viscosity_of_each_row(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="viscosity"):
        problem(tmp_path, rows='speed_viscosity_product = { values = ["1e-3 N/m"] }')
    with pytest.raises(InputError, match="expected one for each row, not a free one"):
        free = problem(
            tmp_path,
            more='viscosity = { lognormal = ["1 Pa s", 0.5] }',
            rows='strain_limit = { values = ["1.3"] }',
        )
        free.predict(np.array([[0.5], [1.0]]))
