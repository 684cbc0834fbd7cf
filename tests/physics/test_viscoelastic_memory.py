"""Tissue that remembers, in the units of its contact: kernels, moduli at v/b, and the correction of a table of films."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from skinbayes.contact import (
    ConstantLossMaterial,
    ViscoelasticMaterial,
    ViscoelasticSkin,
    constant_loss_solid,
    indentation_cycle,
    standard_linear_solid,
)
from skinbayes.contact.indentation_loss import (
    loss_fraction_of_constant_loss,
    loss_fraction_of_relaxation,
    stiffening_of_constant_loss,
    stiffening_of_relaxation,
)
from skinbayes.contact.viscoelastic_line_contact import passage
from skinbayes.lubrication import (
    FilmTablePlan,
    LubricatedBalls,
    build_film_table,
    stribeck_curve,
    tabulated_friction,
    viscoelastic_films,
    viscoelastic_stribeck_curve,
)
from skinbayes.lubrication.viscoelastic_correction import RememberingTissue
from skinbayes.lubrication.viscoelastic_memory import passage_in_contact, tissue_in_contact
from skinbayes.lubrication.viscoelastic_stribeck import skin_at_speed
from skinbayes.lubrication.viscoelastic_table import MemoryPlan, build_memory_correction
from skinbayes.roughness import named_surface

BALL = {"normal_force": 0.3, "sphere_radius": 8e-3}
CYLINDER = {"load_per_length": 21.92, "cylinder_radius": 4.533e-3}
SURFACE = named_surface("paper_reference")


def skin_of(substrate: str, strength: float, time: float = 0.2) -> ViscoelasticSkin:
    """Layer and tissue of one substrate; ``strength`` is Δ or tan δ of the tissue, half of it of the layer."""
    moduli = {"layer": (7e6, strength / 2), "bulk": (30e3, strength)}
    parts: dict[str, ViscoelasticMaterial | ConstantLossMaterial] = {}
    for name, (modulus, loss) in moduli.items():
        if substrate == "constant_loss":
            parts[name] = ConstantLossMaterial(modulus=modulus, tan_delta=loss, reference_frequency=10.0)
        elif loss == 0:
            parts[name] = ViscoelasticMaterial(equilibrium_modulus=modulus)
        else:
            parts[name] = standard_linear_solid(modulus, modulus * (1 + loss), relaxation_time=time)
    return ViscoelasticSkin(**parts, layer_thickness=20e-6)


def relaxation_of(substrate: str, strength: float, time: float = 0.2) -> dict[str, float]:
    if substrate == "constant_loss":
        return {
            "loss_tangent_bulk": strength,
            "loss_tangent_layer": strength / 2,
            "reference_angular_frequency": 10.0,
        }
    return {
        "relaxation_strength_bulk": strength,
        "relaxation_time_bulk": time,
        "relaxation_strength_layer": strength / 2,
        "relaxation_time_layer": time,
    }


@pytest.mark.parametrize("tangent", [0.05, 0.158, 0.49])
def test_closed_kernel_of_constant_loss_is_the_sum_over_relaxation_times(tangent: float) -> None:
    """The sum has |E| to 1e-4 and tan δ to 4e-4 in its band, and is elastic far out, where the closed form is not."""
    closed = ConstantLossMaterial(modulus=20e3, tan_delta=tangent, reference_frequency=1.0)
    band = {"angular_frequency": 1.0, "lowest_frequency": 1e-4, "highest_frequency": 1e6}
    total = constant_loss_solid(20e3, tangent, **band)
    found, wanted = (
        viscoelastic_films([1e-2, 1e-2, 0.1], [0.1, 10.0, 10.0], material=m, **CYLINDER)
        for m in (closed, total)
    )
    for name in ("central_film", "minimum_film", "couette", "pressure_flow"):
        assert_allclose(getattr(found, name), getattr(wanted, name), rtol=2e-5)
    assert_allclose(found.hysteresis, wanted.hysteresis, rtol=3e-4)


@pytest.mark.parametrize("substrate", ["constant_loss", "standard_linear_solid"])
def test_moduli_and_kernel_in_contact_are_those_of_the_materials(substrate: str) -> None:
    """Newton's iteration for all rows at once against the fixed point of one contact."""
    rng = np.random.default_rng(1)
    for _ in range(8):
        strength, speed, time = rng.uniform(0.05, 0.9), 10 ** rng.uniform(-4, 0), 10 ** rng.uniform(-2, 1)
        skin = skin_of(substrate, strength, time)
        held = skin_at_speed(speed, skin=skin, **BALL)
        parameters = {"young_modulus_layer": 7e6, "young_modulus_bulk": 30e3, **BALL}
        tissue = tissue_in_contact(
            substrate,
            speed,
            parameters=parameters,
            relaxation=relaxation_of(substrate, strength, time),
            poisson_ratio_bulk=0.5,
        )
        moduli = np.exp([tissue.log_modulus_layer, tissue.log_modulus_bulk])
        assert_allclose(moduli, [held.young_modulus_layer, held.young_modulus_bulk], rtol=1e-10)
        frequency = float(np.exp(tissue.log_frequency))
        tangent = float(skin.bulk.loss_tangent(frequency))
        assert_allclose(tissue.loss, np.sin(np.arctan(tangent)), rtol=1e-10)
        modulus = float(abs(skin.bulk.reduced_modulus(frequency)))
        load = (
            modulus * (speed / frequency) ** 2 * np.pi / 4 / 4e-3
        )  # of the line contact of that half width on 4 mm
        scales = passage(skin.bulk, speed, load_per_length=load, cylinder_radius=4e-3)
        ready, loss = passage_in_contact(
            substrate,
            float(tissue.strength),
            float(tissue.place),
            modulus=modulus,
            half_width=speed / frequency,
        )
        assert_allclose(loss, tissue.loss, rtol=1e-10)
        nodes = np.linspace(-3.0, 2.0, 30)
        found, wanted = ready.kernel(nodes).deflection, scales.kernel(nodes).deflection
        # as a whole the solid may lie anywhere
        assert_allclose(found - found[0], wanted - wanted[0], atol=1e-9)


def test_without_loss_skin_is_elastic() -> None:
    """tan δ and Δ of 0, and Deborah numbers of next to nothing and of next to infinity: to 1e-6."""
    given = {"spectrum": SURFACE, "frictional_shear_stress": 15e6, **BALL}
    viscosity = np.array([1e-3, 1.0, 20.0])
    cases = {
        "constant_loss": [(0.0, 0.2, 1.0), (1e-9, 0.2, 1.0)],
        "standard_linear_solid": [(0.0, 0.2, 1.0), (0.5, 1e-9, 1.0), (0.5, 1e10, 1.5)],
    }
    for substrate, rows in cases.items():
        for strength, time, stiffer in rows:
            skin = skin_of(substrate, strength, time)
            found = viscoelastic_stribeck_curve(0.01, viscosity, skin=skin, **given)
            held = skin_at_speed(0.01, skin=skin, **BALL)
            assert_allclose(held.young_modulus_bulk, 30e3 * stiffer, rtol=1e-6)
            wanted = stribeck_curve(0.01 * viscosity, skin=held, contact="line", **given)
            assert_allclose(found.friction_coefficient, wanted.friction_coefficient, rtol=1e-6)
            assert np.abs(found.hysteresis).max() < 1e-7


def test_hysteresis_of_a_dry_ball_of_weak_loss() -> None:
    """(6/π²) sin δ a/R, of Hertz's pressure: hardly rough, hardly lubricated. The next order is 0.33 tan δ."""
    skin = skin_of("constant_loss", 0.01)
    spectrum = replace(SURFACE, rms_height=2e-7)
    found = viscoelastic_stribeck_curve(
        0.01, 1e-9, skin=skin, spectrum=spectrum, frictional_shear_stress=0.0, **BALL
    )
    modulus = float(skin_at_speed(0.01, skin=skin, **BALL).young_modulus_bulk) / 0.75
    radius = (3 * BALL["normal_force"] * BALL["sphere_radius"] / (4 * modulus)) ** (1 / 3)
    wanted = 6 / np.pi**2 * np.sin(np.arctan(0.01)) * radius / BALL["sphere_radius"]
    assert_allclose(found.hysteresis, wanted, rtol=0.01)


@pytest.fixture(scope="module", params=["constant_loss", "standard_linear_solid"])
def tables(request: pytest.FixtureRequest):  # type: ignore[no-untyped-def]
    """A table of one ball and the correction of it, three strengths and places enough."""
    ball = {
        "young_modulus_layer": 7e6,
        "young_modulus_bulk": 30e3,
        "rms_height": 22.4e-6,
        "layer_thickness": 20e-6,
    }
    plan = FilmTablePlan(
        {name: (value, value) for name, value in (ball | BALL).items()},
        spectrum=SURFACE,
        contact="line",
        checked=0,
    )
    table = build_film_table(plan)
    relaxing = request.param != "constant_loss"
    memory = MemoryPlan(
        plan,
        substrate=request.param,
        largest_strength=np.log(1.6) if relaxing else 0.2,
        places=(-1.5, 1.5) if relaxing else (0.0, 0.0),
        counts=(3, 4) if relaxing else (3, 1),
        checked=12,
    )
    return request.param, table, build_memory_correction(memory, table)


def test_friction_from_the_table_is_that_of_the_solver(tables) -> None:  # type: ignore[no-untyped-def]
    """At places that the table was not made from; parts, films and hysteresis, of which the direct ones share no table."""
    substrate, table, correction = tables
    assert correction.held_out_count == 12 and correction.held_out[2] < 0.01
    rng = np.random.default_rng(3)
    for _ in range(5):
        speed = 0.01
        strength, time = (
            (rng.uniform(0.05, 0.55), 10 ** rng.uniform(-1.2, -0.2))
            if substrate != "constant_loss"
            else (rng.uniform(0.03, 0.3), 1.0)
        )
        skin = skin_of(substrate, strength, time)
        held = skin_at_speed(speed, skin=skin, **BALL)
        # softer at rest by as much as it is stiffer at v/b: the table holds one modulus there
        parts = {"layer": 7e6 / held.young_modulus_layer, "bulk": 30e3 / held.young_modulus_bulk}
        relaxation = relaxation_of(substrate, strength, time)
        for _ in range(30):
            tissue = tissue_in_contact(
                substrate,
                speed,
                parameters={
                    "young_modulus_layer": 7e6 * parts["layer"],
                    "young_modulus_bulk": 30e3 * parts["bulk"],
                    **BALL,
                },
                relaxation=relaxation,
                poisson_ratio_bulk=0.5,
            )
            parts["layer"] *= 7e6 / float(np.exp(tissue.log_modulus_layer))
            parts["bulk"] *= 30e3 / float(np.exp(tissue.log_modulus_bulk))
        materials = {name: softer(getattr(skin, name), factor) for name, factor in parts.items()}
        viscosity = 10 ** rng.uniform(-3, 1.5, 6)
        given = {"spectrum": SURFACE, "frictional_shear_stress": 15e6, **BALL}
        direct = viscoelastic_stribeck_curve(
            speed, viscosity, skin=ViscoelasticSkin(**materials, layer_thickness=20e-6), **given
        )
        memory = {name: getattr(tissue, name) for name in ("strength", "place", "loss")}
        parameters = {
            "young_modulus_layer": 7e6, "young_modulus_bulk": 30e3, "rms_height": 22.4e-6, "layer_thickness": 20e-6, **BALL
        }  # fmt: skip
        found = tabulated_friction(
            table,
            speed * viscosity,
            balls=LubricatedBalls(
                parameters=parameters,
                frictional_shear_stress=15e6,
                everything=True,
                tissue=RememberingTissue(correction=correction, **memory),
            ),
        )
        for name in ("friction_coefficient", "hysteresis", "central_film", "minimum_film", "couette"):
            # few nodes; of the hysteresis, which is a small part, a little less is asked
            tolerance = 0.02 if name == "hysteresis" else 0.01
            assert_allclose(getattr(found, name), getattr(direct, name), rtol=tolerance, err_msg=name)
        assert_allclose(found.boundary, direct.boundary, atol=0.01 * direct.friction_coefficient.max())


def softer(material, factor):  # type: ignore[no-untyped-def]
    """The material with all its moduli times a factor."""
    if isinstance(material, ConstantLossMaterial):
        return replace(material, modulus=material.modulus * factor)
    return replace(
        material,
        equilibrium_modulus=material.equilibrium_modulus * factor,
        relaxing_moduli=np.asarray(material.relaxing_moduli) * factor,
    )


def test_table_without_loss_is_the_elastic_one(tables) -> None:  # type: ignore[no-untyped-def]
    _, table, correction = tables
    parameters = {
        "young_modulus_layer": 7e6, "young_modulus_bulk": 30e3, "rms_height": 22.4e-6, "layer_thickness": 20e-6, **BALL
    }  # fmt: skip
    balls = LubricatedBalls(parameters=parameters, frictional_shear_stress=15e6, everything=True)
    products = np.geomspace(1e-7, 0.3, 40)
    elastic = tabulated_friction(table, products, balls=balls)
    tissue = RememberingTissue(correction=correction, strength=0.0, place=0.0, loss=0.0)
    found = tabulated_friction(table, products, balls=replace(balls, tissue=tissue))
    assert_array_equal(found.hysteresis, 0.0)
    assert_allclose(found.friction_coefficient, elastic.friction_coefficient, rtol=1e-12)
    assert_allclose(found.central_film, elastic.central_film, rtol=1e-12)


def test_beyond_the_table_there_is_no_friction(tables) -> None:  # type: ignore[no-untyped-def]
    _, table, correction = tables
    parameters = {
        "young_modulus_layer": 7e6, "young_modulus_bulk": 30e3, "rms_height": 22.4e-6, "layer_thickness": 20e-6, **BALL
    }  # fmt: skip
    strength = np.array([[0.9], [1.1]]) * correction.largest_strength
    tissue = RememberingTissue(correction=correction, strength=strength, place=0.0, loss=0.1)
    balls = LubricatedBalls(parameters=parameters, frictional_shear_stress=15e6, tissue=tissue)
    found = tabulated_friction(table, [1e-3, 1e-2], balls=balls)
    assert np.isfinite(found.friction_coefficient[0]).all() and np.isnan(found.friction_coefficient[1]).all()
    assert_array_equal(found.outside_table, [[False, False], [True, True]])


def test_loss_of_indentation_for_many_materials() -> None:
    rng = np.random.default_rng(5)
    for _ in range(10):
        strength, ratio, tangent = (
            np.expm1(rng.uniform(0, 4.5)),
            np.exp(rng.uniform(-6, 6)),
            rng.uniform(0.01, 0.9),
        )
        solid = standard_linear_solid(1.0, 1 + strength, relaxation_time=ratio)
        cycle = indentation_cycle(1.0, 1.0, sphere_radius=1.0, material=solid)
        assert_allclose(loss_fraction_of_relaxation(strength, ratio), cycle.loss_fraction, atol=2e-3)
        stiffer = stiffening_of_relaxation(np.asarray(strength), np.asarray(1 / ratio))
        assert_allclose(4 / 3 / 0.75 * stiffer, cycle.force[400], rtol=1e-8)
        fractional = ConstantLossMaterial(modulus=1.0, tan_delta=tangent, reference_frequency=1.0)
        cycle = indentation_cycle(3.0, 2.0, sphere_radius=0.5, material=fractional)
        assert_allclose(loss_fraction_of_constant_loss(tangent), cycle.loss_fraction, atol=2e-6)
        stiffer = stiffening_of_constant_loss(np.asarray(tangent), np.asarray(2.0 / 3.0))
        assert_allclose(4 / 3 / 0.75 * np.sqrt(0.5) * 2**1.5 * stiffer, cycle.force[400], rtol=1e-9)
    assert np.isnan(loss_fraction_of_constant_loss([-0.1, 1.0])).all()
    assert np.isnan(loss_fraction_of_relaxation([-0.1, 200.0], 1.0)).all()


def test_cycle_of_constant_loss_is_that_of_a_sum_over_relaxation_times() -> None:
    total = constant_loss_solid(
        20e3, 0.158, angular_frequency=1.0, lowest_frequency=1e-4, highest_frequency=1e5
    )
    closed = ConstantLossMaterial(modulus=20e3, tan_delta=0.158, reference_frequency=1.0)
    found, wanted = (indentation_cycle(2.5e-3, 5e-3, sphere_radius=8e-3, material=m) for m in (closed, total))
    assert_allclose(
        [found.loss_fraction, found.residual_depth], [wanted.loss_fraction, wanted.residual_depth], rtol=1e-6
    )
    assert_allclose(found.force[1:-1], wanted.force[1:-1], rtol=1e-4)
