"""Terms of dry friction and relaxations on the skin, against quadrature, differential equations and limits."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.special import spherical_jn

from skinbayes.contact import sphere_contact
from skinbayes.friction import (
    ball_hysteresis,
    contact_after_dwell,
    friction_coefficient,
    occluded_modulus,
    run_in_factor,
    shear_stress_under_pressure,
)


def test_a_stress_linear_in_the_pressure_adds_a_constant():
    area, pressure = np.array([1e-6, 1e-3, 0.9]), np.array([1e2, 7e3, 4e5])
    stress = shear_stress_under_pressure(2e6, 0.15, relative_contact_area=area, nominal_pressure=pressure)
    whole = friction_coefficient(stress, area, nominal_pressure=pressure)
    alone = friction_coefficient(2e6, area, nominal_pressure=pressure)
    np.testing.assert_allclose(whole - alone, 0.15, rtol=1e-9)
    # the same from a distribution of pressures in the real contact: exponential, of mean p0/(A/A0)
    mean = pressure[1] / area[1]
    force = quad(lambda x: (2e6 + 0.15 * mean * x) * np.exp(-x), 0, np.inf)[0] * area[1]
    assert force / pressure[1] == pytest.approx(whole[1], rel=1e-9)
    none = shear_stress_under_pressure(2e6, 0.0, relative_contact_area=area, nominal_pressure=pressure)
    np.testing.assert_array_equal(none, 2e6)


def test_hysteresis_is_the_work_that_the_tissue_keeps():
    # power of the pressure of Hertz that passes over a half-space of E* e^(iδ), over speed and load
    contact = sphere_contact(0.5, 8e-3, reduced_modulus=2.7e4)
    a, peak = contact.contact_radius, contact.maximum_pressure
    # p(q) = 2π a² p_max j1(qa)/(qa); u(q) = 2 p(q)/(E* q); mean of |q_x| over angles is 2q/π
    x = np.linspace(1e-6, 1000, 500_001)
    pressure = 2 * np.pi * a**2 * peak * spherical_jn(1, x) / x
    power = np.trapezoid(pressure**2 * (2 / (2.7e4 * x / a)) * (2 / np.pi * x / a) * x / a, x / a) / (
        2 * np.pi
    )
    sine = np.sin(np.arctan(0.1))
    assert ball_hysteresis(a, 8e-3, loss_tangent=0.1) == pytest.approx(sine * power / 0.5, rel=1e-3)
    assert ball_hysteresis(a, 8e-3, loss_tangent=0.0) == 0
    assert np.isnan(ball_hysteresis([a, -a], [0.0, 1.0], loss_tangent=0.1)).all()


def test_growth_of_contact_is_first_order():
    times = np.array([0.0, 1.0, 5.0, 30.0])
    solved = solve_ivp(lambda t, y: (1 - y) / 7.0, (0, 30), [0.3], t_eval=times, rtol=1e-10, atol=1e-12).y[0]
    np.testing.assert_allclose(
        contact_after_dwell(times, 7.0, initial_contact_fraction=0.3), solved, rtol=1e-8
    )
    impossible = contact_after_dwell(
        [-1.0, 1.0, 1.0], [1.0, 0.0, 1.0], initial_contact_fraction=[0.1, 0.1, 1.1]
    )
    assert np.isnan(impossible).all()


def test_occlusion_relaxes_the_logarithm():
    times = np.array([0.0, 3.0, 20.0, 90.0])
    end = np.log(0.02e9)
    solved = solve_ivp(
        lambda t, y: (end - y) / 20.0, (0, 90), [np.log(1e9)], t_eval=times, rtol=1e-10, atol=1e-10
    ).y[0]
    found = occluded_modulus(1e9, 0.02, dwell_time=times, occlusion_time=20.0)
    np.testing.assert_allclose(found, np.exp(solved), rtol=1e-7)
    assert occluded_modulus(1e9, 1.0, dwell_time=50.0, occlusion_time=20.0) == 1e9


@pytest.mark.parametrize("ratio", [0.4, 1.0, 3.0])
def test_each_stroke_takes_the_same_share_of_the_rest(ratio):
    factor, kept = ratio, np.exp(-1 / 6.0)
    for number in range(1, 40):
        assert run_in_factor(number, 6.0, run_in_ratio=ratio) == pytest.approx(factor, rel=1e-12)
        factor = 1 + (factor - 1) * kept
    assert np.isnan(run_in_factor([0, 2], [5.0, 0.0], run_in_ratio=1.5)).all()
