"""A pad that is pressed flat: a contact of given area, and an inlet of given length, against limits and other solutions."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from skinbayes.contact import (
    HomogeneousSolid,
    LayeredSkin,
    line_contact,
    reduced_modulus,
    sphere_contact,
    sphere_of_contact,
)
from skinbayes.errors import InputError
from skinbayes.forward import forward_model
from skinbayes.forward.base import Tables
from skinbayes.forward.pad import film_ranges, with_ball
from skinbayes.lubrication import (
    FILM_PARAMETERS,
    FilmTablePlan,
    lubricated_films,
    lubricated_point_films,
    stribeck_curve,
)
from skinbayes.lubrication.film import lubrication_number_per_product
from skinbayes.roughness import named_surface

BALL = {"normal_force": 0.2, "sphere_radius": 8e-3, "reduced_modulus": 20e3 / 0.75}
SURFACE = named_surface("paper_reference")
ROUGHNESS = {
    "rms_height": 22.4e-6, "hurst_exponent": 0.78, "wavevector_min": 1e3, "wavevector_rolloff": 6.345e3, "wavevector_max": 1e9,
}  # fmt: skip
PAD = {
    "frictional_shear_stress": 10e6, "normal_force": 0.8, "nominal_contact_area": 150e-6, "inlet_length": 3e-3,
    "young_modulus_layer": 7e6, "young_modulus_bulk": 50e3, "layer_thickness": 173e-6, "poisson_ratio_layer": 0.5,
    "poisson_ratio_bulk": 0.5, "area_correction": 0.42, "velocity_shift_factor": 1.0, "additive_friction": 0.0,
    "nominal_area_ratio": 1.0, "nominal_area_load_exponent": 0.0, "strain_limit": 1.3,
}  # fmt: skip


def pad_inputs(**changed: object) -> dict[str, np.ndarray]:
    named = {**ROUGHNESS, **PAD, **changed}
    return {name: np.atleast_2d(np.asarray(value, dtype=float)) for name, value in named.items()}


def test_a_contact_has_the_ball_that_makes_it() -> None:
    force, radius, modulus = (
        np.array([0.02, 1.0, 5.0]),
        np.array([1e-3, 1e-2, 0.1]),
        np.array([1e4, 1e5, 1e6]),
    )
    contact = sphere_contact(force, radius, reduced_modulus=modulus).contact_radius
    assert_allclose(sphere_of_contact(force, contact, reduced_modulus=modulus), radius, rtol=1e-13)
    assert np.isnan(sphere_of_contact([0.0, -1.0, 1.0], [1e-3, 1e-3, 0.0], reduced_modulus=1e4)).all()


def test_a_pad_as_wide_as_the_contact_of_a_ball_is_that_ball() -> None:
    modulus = float(reduced_modulus(50e3, 0.5))
    contact = float(sphere_contact(0.8, 10e-3, reduced_modulus=modulus).contact_radius)
    products = np.array([[1e-4, 1e-2, 0.3]])
    inputs = pad_inputs(
        nominal_contact_area=np.pi * contact**2, speed_viscosity_product=products, strain_limit=3.0
    )
    found = forward_model("stribeck").with_options({"contact": "pad"}).evaluate(inputs, Tables())
    skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=50e3, layer_thickness=173e-6)
    curve = stribeck_curve(
        products[0], normal_force=0.8, sphere_radius=10e-3, spectrum=SURFACE, skin=skin,
        frictional_shear_stress=10e6, inlet_length=3e-3, largest_strain=3.0, thickest_film=np.inf,
    )  # fmt: skip
    for name, wanted in (
        ("friction_coefficient", curve.friction_coefficient),
        ("central_film_thickness", curve.central_film),
        ("asperity_load_fraction", curve.asperity_load_fraction),
    ):
        assert_allclose(found[name][0], wanted, rtol=1e-12, err_msg=name)


def test_the_area_follows_the_load_as_a_power() -> None:
    inputs = pad_inputs(
        nominal_contact_area=300e-6, nominal_area_ratio=0.5, nominal_area_load_exponent=2 / 3,
        normal_force=[0.2, 1.0, 3.0],
    )  # fmt: skip
    radius = with_ball(inputs)["sphere_radius"]
    # with the power 2/3 of Hertz it is one ball under all loads
    assert_allclose(radius, radius[0, 0], rtol=1e-13)
    flat = with_ball(inputs | {"nominal_area_load_exponent": np.zeros((1, 1))})["sphere_radius"]
    assert_allclose(flat * [0.2, 1.0, 3.0], flat[0, 1], rtol=1e-13)
    assert_allclose(flat[0, 1], 4 / 3 * 50e3 / 0.75 * (150e-6 / np.pi) ** 1.5, rtol=1e-13)


def test_a_distant_end_of_the_liquid_changes_no_film() -> None:
    products = np.array([1e-3, 2e-2, 0.2])
    contact = float(sphere_contact(**BALL).contact_radius)
    endless = lubricated_point_films(products, **BALL)
    ended = lubricated_point_films(products, **BALL, inlet_length=19 * contact)
    # the same grid: 20 contact radii
    assert_allclose(ended.central_film, endless.central_film, rtol=3e-3)
    assert (ended.couette > endless.couette).all()  # drag is counted further out
    near = lubricated_point_films(products, **BALL, inlet_length=0.3 * contact)
    assert (near.central_film < 0.995 * endless.central_film)[1:].all()
    line = {"cylinder_radius": 4.533e-3, "load_per_length": 21.92, "reduced_modulus": 20e3 / 0.75}
    far = lubricated_films(products, **line, inlet_length=40 * 2.18e-3)
    assert_allclose(far.central_film, lubricated_films(products, **line).central_film, rtol=3e-3)


def test_a_nearly_flat_cylinder_with_an_end_against_another_solution() -> None:
    # dP/dX = λ (H − H_c)/H³ from P = 0 at the end of the liquid by quadrature, and the deflection by sums, in turns
    number, end = 1e5, 2.5
    line = {"cylinder_radius": 1.0, "load_per_length": 1.0, "reduced_modulus": 4 / np.pi}
    hertz = line_contact(1.0, 1.0, reduced_modulus=4 / np.pi)
    product = number / lubrication_number_per_product(1.0, hertz)
    films = lubricated_films([product], **line, nodes=120, inlet_length=(end - 1) * float(hertz.half_width))
    edges = np.linspace(-end, end, 1201)
    x, step = (edges[1:] + edges[:-1]) / 2, edges[1] - edges[0]
    offset = np.subtract.outer(x, edges)
    once = offset * (np.log(np.abs(offset)) - 1)
    kernel = (once[:, :-1] - once[:, 1:]) / np.pi

    def pressure(film: np.ndarray) -> np.ndarray:
        def run(cavity: float) -> np.ndarray:
            slope = np.where(x <= cavity, (film - np.interp(cavity, x, film)) / film**3, 0.0)
            return number * step * (np.cumsum(slope) - slope / 2)

        return run(brentq(lambda place: run(place)[-1], 0.1, end - step))

    shape, approach = x**2 / 2, 0.0
    for _ in range(40):
        approach = brentq(
            lambda high, over: pressure(high + over).sum() * step - np.pi / 2, 2.0, 1e3, args=(shape,)
        )
        found = pressure(approach + shape)
        shape = (shape + x**2 / 2 - kernel @ found) / 2
    wanted = np.interp(0.0, x, approach + shape)
    assert_allclose(films.central_film[0] / float(hertz.half_width**2), wanted, rtol=5e-3)


def test_a_box_of_pads_is_inside_the_table() -> None:
    ranges = {
        "young_modulus_layer": (3e6, 2e7), "young_modulus_bulk": (1.5e4, 1.5e5), "rms_height": (1.5e-5, 3e-5),
        "layer_thickness": (173e-6, 173e-6), "normal_force": (0.17, 4.0), "nominal_contact_area": (265e-6, 620e-6),
        "nominal_area_ratio": (0.3, 0.8), "nominal_area_load_exponent": (0.0, 2 / 3),
    }  # fmt: skip
    plan = FilmTablePlan(film_ranges(ranges, 0.5), spectrum=SURFACE, inlet_length=3e-3)
    assert len(plan.axes.names) == 3
    rng = np.random.default_rng(3)
    drawn = {
        name: rng.uniform(*ends, 500) if ends[0] == 0 else np.exp(rng.uniform(*np.log(ends), 500))
        for name, ends in ranges.items()
    }
    balls = with_ball(drawn | {"poisson_ratio_layer": 0.5, "poisson_ratio_bulk": 0.5})
    logs = [np.log(balls[name]) for name in FILM_PARAMETERS]
    assert plan.axes.contains(logs).all()
    assert not plan.axes.contains([logs[0], logs[1], logs[2] + 20, *logs[3:]]).any()
    # the box of the balls themselves would be much larger: the same to twice the width at most
    widths = [np.ptp(part) for part in plan.axes.coordinates(logs)]
    assert min(widths) > 0.8


def test_what_a_pad_cannot_be() -> None:
    model = forward_model("stribeck").with_options({"contact": "pad"})
    assert "nominal_contact_area" in model.required_names() and "sphere_radius" not in model.required_names()
    assert model.validate is not None
    with pytest.raises(InputError, match=r"inlet_length goes from 0.001 to 0.003 m, but has to be one fixed"):
        model.validate(pad_inputs(inlet_length=[1e-3, 3e-3]), Tables())
    with pytest.raises(InputError, match="inlet_length is 0 m"):
        lubricated_point_films([0.1], **BALL, inlet_length=0.0)
    gel = HomogeneousSolid(young_modulus=5e4)
    with pytest.raises(
        InputError, match=r"'pad' and options.substrate 'constant_loss': a pad carries its contact with it"
    ):
        forward_model("stribeck").with_options({"contact": "pad", "substrate": "constant_loss"})
    bent = stribeck_curve(
        [1e-3], normal_force=1.0, sphere_radius=float(sphere_of_contact(1.0, 0.0, reduced_modulus=5e4)),
        spectrum=SURFACE, skin=gel, frictional_shear_stress=1e6,
    )  # fmt: skip
    assert bent.impossible.all()
