"""Hertz sphere and friction coefficient: closed forms, balance of forces, the numbers of the paper."""

import numpy as np
import pytest
from scipy.integrate import quad

from skinbayes.contact import reduced_modulus, sphere_contact, sphere_force
from skinbayes.friction import friction_coefficient


def test_mean_pressure_of_the_paper():
    # 0.5 N on a ball of 8 mm: 6.83 kPa (with E*² in the cube root; with E* the unit would not even be a pressure)
    contact = sphere_contact(0.5, 8e-3, reduced_modulus=reduced_modulus(20e3, 0.5))
    assert contact.mean_pressure == pytest.approx(6830, rel=2e-4)
    assert 2 * sphere_contact(
        0.2, 8e-3, reduced_modulus=reduced_modulus(20e3, 0.5)
    ).contact_radius == pytest.approx(7.11e-3, rel=1e-3)


@pytest.mark.parametrize("case", [(0.5, 8e-3, 2.7e4), (1e-9, 1e-6, 1e9), (12.0, 0.3, 5e6)])
def test_pressure_distribution_carries_the_load_and_displaces_by_the_indentation(case):
    force, radius, modulus = case
    contact = sphere_contact(force, radius, reduced_modulus=modulus)
    a, peak = contact.contact_radius, contact.maximum_pressure

    def pressure(fraction):
        return peak * np.sqrt(1 - fraction**2)

    load = 2 * np.pi * a**2 * quad(lambda fraction: fraction * pressure(fraction), 0, 1)[0]
    assert load == pytest.approx(force, rel=1e-7)
    # displacement at the centre of an axisymmetric pressure: (2/E*) ∫p dr
    centre = 2 / modulus * a * quad(pressure, 0, 1)[0]
    assert contact.indentation == pytest.approx(centre, rel=1e-7)
    # and at the edge of the contact the sphere is a²/(2R) higher
    assert contact.indentation - a**2 / (2 * radius) == pytest.approx(a**2 / (2 * radius), rel=1e-12)
    assert contact.mean_pressure == pytest.approx(force / (np.pi * a**2), rel=1e-12)


def test_force_at_a_depth_is_the_load_that_makes_it_and_close_to_that_of_an_exact_sphere():
    force = np.array([1e-9, 0.02, 3.0])
    depth = sphere_contact(force, 8e-3, reduced_modulus=2.7e4).indentation
    np.testing.assert_allclose(sphere_force(depth, 8e-3, reduced_modulus=2.7e4), force, rtol=1e-14)
    # Sneddon's sphere in units of R and E*, by its contact radius a
    for a, error in ((0.1, 1.0e-3), (0.3, 9.4e-3), (0.5, 2.83e-2)):
        ends = np.log((1 + a) / (1 - a))
        exact = (a * a + 1) / 2 * ends - a
        assert sphere_force(a / 2 * ends, 1.0, reduced_modulus=1.0) / exact - 1 == pytest.approx(
            error, rel=0.01
        )
    impossible = sphere_force([-1.0, 1.0, 1.0], [1.0, 0.0, 1.0], reduced_modulus=[1.0, 1.0, -1.0])
    assert np.isnan(impossible).all()


def test_scaling_and_shapes():
    contact = sphere_contact(np.array([[0.1], [0.8]]), 8e-3, reduced_modulus=np.array([1e4, 2e4, 8e4]))
    assert contact.mean_pressure.shape == (2, 3)
    np.testing.assert_allclose(contact.mean_pressure[1], 2 * contact.mean_pressure[0], rtol=1e-14)
    np.testing.assert_allclose(contact.mean_pressure[:, 2], 4 * contact.mean_pressure[:, 0], rtol=1e-14)


def test_impossible_arguments_give_nan_and_no_load_no_contact():
    contact = sphere_contact(
        [-1.0, 1.0, 1.0, np.nan], [1.0, -1.0, 1.0, 1.0], reduced_modulus=[1.0, 1.0, 0.0, 1.0]
    )
    assert np.isnan(np.array(contact)).all()
    assert np.array_equal(sphere_contact(0.0, 1.0, reduced_modulus=1.0), np.zeros(4))


def test_friction_coefficient():
    assert friction_coefficient(15e6, 1.366e-4, nominal_pressure=6830.0) == pytest.approx(0.3, rel=1e-12)
    assert friction_coefficient(np.full((3, 1), 1e6), np.full((1, 2), 1e-3), nominal_pressure=1e4).shape == (
        3,
        2,
    )
    assert np.isnan(friction_coefficient(1e6, 0.0, nominal_pressure=0.0))
