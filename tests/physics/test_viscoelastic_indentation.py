"""A ball pressed into a solid that relaxes: elastic limits, a power law in closed form, convolutions by brute force."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from skinbayes.contact import (
    ViscoelasticMaterial,
    constant_loss_solid,
    indentation_creep,
    indentation_cycle,
    indentation_relaxation,
    sphere_contact,
    standard_linear_solid,
)
from skinbayes.errors import InputError

RADIUS, RATE, DEPTH = 8e-3, 2.5e-3, 5e-3
TURN = DEPTH / RATE
ZENER = standard_linear_solid(20e3, 30e3, relaxation_time=0.7)


def test_an_elastic_solid_loses_nothing() -> None:
    for modulus, rate in [(20e3, RATE), (20e3, 1e-9), (30e3, 1e4)]:
        material = ViscoelasticMaterial(equilibrium_modulus=20e3) if rate == RATE else ZENER
        cycle = indentation_cycle(rate, DEPTH, sphere_radius=RADIUS, material=material)
        expected = 4 / 3 * modulus / 0.75 * np.sqrt(RADIUS) * cycle.depth**1.5
        np.testing.assert_allclose(cycle.force, expected, rtol=1e-5, atol=1e-6 * expected.max())
        np.testing.assert_allclose(cycle.contact_radius**2 / RADIUS, cycle.depth, atol=1e-6 * DEPTH)
        assert abs(cycle.loss_fraction) < 1e-5
        assert cycle.residual_depth < 1e-5 * DEPTH


def test_force_is_the_convolution_of_lee_radok_and_ting() -> None:
    cycle = indentation_cycle(RATE, DEPTH, sphere_radius=RADIUS, material=ZENER)
    for place in (5, 200, 400, 450, 600, 780):
        time, until = cycle.time[place], cycle.contact_radius[place] ** 2 / RADIUS / RATE

        def rise(s: float, time: float = time) -> float:
            return ZENER.relaxation_modulus(time - s) * 1.5 * np.sqrt(s)

        force = 4 / 3 * np.sqrt(RADIUS) / 0.75 * RATE**1.5 * quad(rise, 0, until, epsrel=1e-10)[0]
        assert cycle.force[place] == pytest.approx(force, rel=1e-7)
        if time > TURN:
            # the centre has not felt what happened since the contact was as large
            before = quad(lambda s, t=time: ZENER.relaxation_modulus(t - s), until, TURN)[0]
            after = quad(lambda s, t=time: ZENER.relaxation_modulus(t - s), TURN, time)[0]
            assert before == pytest.approx(after, rel=1e-8)
    assert cycle.force[-1] == pytest.approx(0.0, abs=1e-9)
    assert cycle.loss_fraction > 0.2


@pytest.mark.parametrize("power", [0.05, 0.0999, 0.3])
def test_a_power_law_has_its_set_in_closed_form(power: float) -> None:
    # ∫_(t1)^t (t − s)^(−n) dδ = 0 gives t − t1 = 2^(1/(1 − n)) (t − t_m)
    material = constant_loss_solid(
        20e3, np.tan(power * np.pi / 2), angular_frequency=1.0, lowest_frequency=1e-5, highest_frequency=1e5
    )
    cycle = indentation_cycle(RATE, DEPTH, sphere_radius=RADIUS, material=material)
    factor = 2 ** (1 / (1 - power))
    assert cycle.residual_depth / DEPTH == pytest.approx(2 - factor / (factor - 1), rel=2e-3)
    until = np.clip(cycle.time - factor * np.maximum(cycle.time - TURN, 0), 0, None)
    np.testing.assert_allclose(cycle.contact_radius**2 / RADIUS / RATE, until, atol=1e-3 * TURN)
    # work by quadrature over both halves, of (t − s)^(−n) with its end taken off by s = t1 sin²
    angle = (np.arange(400) + 0.5) / 400 * np.pi / 2
    sine = np.sin(angle) ** 2

    def force(time: np.ndarray) -> np.ndarray:
        end = np.clip(time - factor * np.maximum(time - TURN, 0), 0, None)[:, None]
        s = end * sine
        weight = 2 * end * np.sin(angle) * np.cos(angle)
        return ((time[:, None] - s) ** -power * np.sqrt(s) * weight).sum(axis=1)

    up, down = (np.linspace(*ends, 4001) for ends in ((1e-9, TURN), (TURN, TURN * factor / (factor - 1))))
    loss = 1 - np.trapezoid(force(down), down) / np.trapezoid(force(up), up)
    assert cycle.loss_fraction == pytest.approx(loss, abs=2e-3)


def test_loss_and_set_do_not_depend_on_ball_or_modulus() -> None:
    first = indentation_cycle(RATE, DEPTH, sphere_radius=RADIUS, material=ZENER)
    stiffer = standard_linear_solid(2e6, 3e6, relaxation_time=0.07)
    second = indentation_cycle(RATE, DEPTH / 10, sphere_radius=1.0, material=stiffer)
    assert first.loss_fraction == pytest.approx(second.loss_fraction, rel=1e-9)
    assert first.residual_depth / DEPTH == pytest.approx(second.residual_depth / DEPTH * 10, rel=1e-9)


def test_a_held_load_and_a_held_depth_begin_and_end_with_hertz() -> None:
    time = np.array([0.0, 0.3, 1e3])
    depth = indentation_creep(time, 0.2, sphere_radius=RADIUS, material=ZENER)
    force = indentation_relaxation(time, 1e-3, sphere_radius=RADIUS, material=ZENER)
    for place, modulus in [(0, 30e3 / 0.75), (2, 20e3 / 0.75)]:
        hertz = sphere_contact(0.2, RADIUS, reduced_modulus=modulus)
        assert depth[place] == pytest.approx(hertz.contact_radius**2 / RADIUS, rel=1e-12)
        assert force[place] == pytest.approx(4 / 3 * modulus * np.sqrt(RADIUS) * 1e-3**1.5, rel=1e-12)
    # creep at constant load: the load is the convolution of relaxation with δ^(3/2)
    fine = np.linspace(0, 0.3, 20001)
    power = indentation_creep(fine, 0.2, sphere_radius=RADIUS, material=ZENER) ** 1.5
    middle = (fine[1:] + fine[:-1]) / 2
    load = ZENER.relaxation_modulus(0.3) * power[0] + ZENER.relaxation_modulus(0.3 - middle) @ np.diff(power)
    assert 4 / 3 * np.sqrt(RADIUS) / 0.75 * load == pytest.approx(0.2, rel=1e-8)
    assert np.isnan(indentation_creep(1.0, -1.0, sphere_radius=RADIUS, material=ZENER))
    assert np.isnan(indentation_relaxation(1.0, 1.0, sphere_radius=-RADIUS, material=ZENER))


def test_bad_numbers_are_named() -> None:
    with pytest.raises(InputError, match="rate is -1 m/s, but must be a finite number > 0 m/s"):
        indentation_cycle(-1.0, DEPTH, sphere_radius=RADIUS, material=ZENER)
    with pytest.raises(InputError, match="material of an indentation"):
        indentation_cycle(
            RATE, DEPTH, sphere_radius=RADIUS, material=ViscoelasticMaterial(equilibrium_modulus=-1.0)
        )
