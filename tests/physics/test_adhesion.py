"""Balls that stick: against the least of the energy, limits, and Maugis' theory of what lies between JKR and DMT."""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize

from skinbayes.contact import dmt_contact, jkr_contact, sphere_contact, tabor_parameter

BALL = {"reduced_modulus": 20e3 / 0.75, "work_of_adhesion": 0.085}


def energy(contact, depth, load, radius, modulus, work):
    """Elastic energy of a parabola with a contact of any radius, surface energy and that of the load."""
    elastic = modulus * (
        contact * depth**2 - 2 / 3 * contact**3 * depth / radius + contact**5 / (5 * radius**2)
    )
    return elastic - np.pi * contact**2 * work - load * depth


@pytest.mark.parametrize("load", [-0.002, 0.0, 0.02, 0.5])
def test_jkr_is_the_least_energy(load):
    found = jkr_contact(load, 8e-3, **BALL)
    scale = np.array([found.contact_radius, found.indentation])

    def scaled(x):
        return 1e6 * energy(*(x * scale), load, 8e-3, *BALL.values())

    start = np.array([1.05, 1.04 if load else 1.1])
    least = minimize(scaled, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-14})
    # the energy is flat at its least: half of the digits
    np.testing.assert_allclose(least.x, 1.0, atol=3e-6)


def test_jkr_balances_the_load_and_pulls_off_where_it_should():
    load = np.linspace(-1.5 * np.pi * 0.085 * 8e-3, 1.0, 40)
    found = jkr_contact(load, 8e-3, **BALL)
    a, modulus, work = found.contact_radius, *BALL.values()
    # Hertz's pressure less that of a flat punch of the same stress intensity at the edge
    np.testing.assert_allclose(
        4 * modulus * a**3 / (3 * 8e-3) - np.sqrt(8 * np.pi * work * modulus * a**3),
        load,
        rtol=1e-9,
        atol=1e-12,
    )
    assert found.pull_off_force[0] == pytest.approx(-load[0])
    assert np.isnan(jkr_contact(1.001 * load[0], 8e-3, **BALL).contact_radius)
    # without load a³ = 9πwR²/(2E*); the paper of 1971 has 6πγ…R/K with K = 4E*/3
    free = jkr_contact(0.0, 8e-3, **BALL).contact_radius
    assert free**3 == pytest.approx(9 * np.pi * work * 8e-3**2 / (2 * modulus))


@pytest.mark.parametrize("theory", [jkr_contact, dmt_contact])
def test_without_adhesion_it_is_hertz(theory):
    hertz = sphere_contact([0.01, 0.5], 8e-3, reduced_modulus=2.7e4)
    found = theory([0.01, 0.5], 8e-3, reduced_modulus=2.7e4, work_of_adhesion=0.0)
    np.testing.assert_allclose(found.contact_radius, hertz.contact_radius, rtol=1e-15)
    np.testing.assert_allclose(found.indentation, hertz.indentation, rtol=1e-15)
    assert np.isnan(theory(-1e-9, 8e-3, reduced_modulus=2.7e4, work_of_adhesion=0.0).contact_radius)
    assert np.isnan(theory(0.1, 8e-3, reduced_modulus=2.7e4, work_of_adhesion=-1.0)).all()


def maugis_load(a, length):
    """Load of Maugis' contact of radius a with attraction of constant stress, in his units: K = R = πw = 1, length is λ."""

    def balance(m):
        root, arc = np.sqrt(m * m - 1), np.arctan(np.sqrt(m * m - 1))
        return (
            length * a * a / 2 * (root + (m * m - 2) * arc) + 4 * length**2 * a / 3 * (root * arc - m + 1) - 1
        )

    m = brentq(balance, 1 + 1e-13, 1e9, xtol=1e-13)
    root = np.sqrt(m * m - 1)
    return a**3 - length * a * a * (root + m * m * np.arctan(root))


@pytest.mark.parametrize(("tabor", "least", "most"), [(0.1, 1.9, 2.0), (1.0, 1.55, 1.85), (5.0, 1.5, 1.53)])
def test_the_tabor_parameter_says_which_theory_holds(tabor, least, most):
    # λ = 1.157 μ_T; a stress σ0 = w/h0 with h0 = 0.97 z0
    radii = np.geomspace(0.05, 3.0, 400)
    pull_off = -min(maugis_load(a, 1.157 * tabor) for a in radii)  # in πwR
    assert least < pull_off < most
    # the parameter of a made-up sphere, from its definition
    reach, radius, modulus = 0.5e-9, 1e-6, 1e9
    work = modulus * reach * np.sqrt(tabor**3 * reach / radius)
    found = tabor_parameter(radius, modulus, work_of_adhesion=work, range_of_attraction=reach)
    assert found == pytest.approx(tabor)


def test_rows_and_batch_agree():
    force, radius = np.geomspace(1e-3, 2, 9)[:, None], np.array([1e-3, 8e-3])
    both = jkr_contact(force, radius, **BALL)
    for i in range(9):
        for j in range(2):
            one = jkr_contact(force[i, 0], radius[j], **BALL)
            assert all(whole[i, j] == single for whole, single in zip(both[:3], one[:3], strict=True))
