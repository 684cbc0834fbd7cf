"""Persson's area and the Yang–Persson correction against independent solutions and limits."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp
from scipy.linalg import solve_banded
from scipy.special import erf

from skinbayes.contact import (
    AREA_CORRECTION,
    LayeredSkin,
    corrected_twice_stress_variance,
    elastoplastic_contact_area,
    persson_contact_area,
    relative_contact_area,
    twice_stress_variance,
)
from skinbayes.contact.correction import _single_table
from skinbayes.friction import friction_coefficient
from skinbayes.roughness import named_surface

PRESSURE = 6830.0
SURFACE = named_surface("paper_reference")
WET = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
DRY = LayeredSkin(young_modulus_layer=1e9, young_modulus_bulk=20e3, layer_thickness=20e-6)


def diffuse(pressure, twice_variances, cells=3000):
    """Crank–Nicolson solution of ∂P/∂V = ¼ ∂²P/∂σ², P = 0 at σ = 0, started as δ(σ − p); returns ∫P dσ at each V."""
    start = (pressure / 9) ** 2  # the Gaussian has not reached the wall yet
    edge = pressure + 7 * np.sqrt(max(twice_variances))
    h = edge / cells
    sigma = h * (np.arange(cells) + 0.5)
    density = np.exp(-((sigma - pressure) ** 2) / start) / np.sqrt(np.pi * start)
    now, areas = start, []
    for target in twice_variances:
        for following in np.linspace(now, target, 400)[1:]:
            r = (following - now) / 8 / h**2
            laplacian = np.zeros((3, cells))
            laplacian[0, 1:], laplacian[1], laplacian[2, :-1] = 1.0, -2.0, 1.0
            laplacian[1, [0, -1]] = -3.0  # the wall lies half a cell away
            right = density + r * (laplacian[1] * density)
            right[1:] += r * density[:-1]
            right[:-1] += r * density[1:]
            density = solve_banded((1, 1), np.array([[0.0], [1.0], [0.0]]) - r * laplacian, right)
            now = following
        areas.append(density.sum() * h)
    return areas


def test_area_is_what_the_diffusion_of_stress_leaves():
    twice_variances = np.array([0.3, 2.0, 9.0]) * PRESSURE**2
    found = persson_contact_area(PRESSURE, twice_variances)
    np.testing.assert_allclose(found, diffuse(PRESSURE, twice_variances), rtol=1e-4)


def test_limits_of_the_area():
    assert persson_contact_area(1.0, 0.0) == 1.0
    assert persson_contact_area(1.0, 1e-3) == pytest.approx(1.0, abs=1e-15)
    assert persson_contact_area(1e-9, 4.0) == pytest.approx(2e-9 / np.sqrt(4 * np.pi), rel=1e-12)
    assert persson_contact_area(0.0, 4.0) == 0.0
    assert relative_contact_area(0.0, 4.0) == 0.0
    assert np.isnan(persson_contact_area([-1.0, 1.0, np.nan], [1.0, -1.0, 1.0])).all()


def phi_by_quadrature(y, gamma):
    """∫ from 0 to y of dy/[γ + (1 − γ) erf²(1/√y)]."""
    low = min(y, 0.02)
    edges = [*np.arange(np.log(low), np.log(y), 1.0).tolist(), np.log(y)]

    def integrand(t):
        return np.exp(t) / (gamma + (1 - gamma) * erf(np.exp(-t / 2)) ** 2)

    return low + sum(quad(integrand, a, b, epsabs=0, epsrel=1e-12)[0] for a, b in itertools.pairwise(edges))


@pytest.mark.parametrize("gamma", [1e-3, 0.05, 0.3, AREA_CORRECTION, 0.45, 0.9, 0.999])
def test_correction_inverts_its_integral(gamma):
    y = np.exp(np.linspace(np.log(1e-3), np.log(1e22), 90))
    ratio = np.array([phi_by_quadrature(value, gamma) for value in y])
    np.testing.assert_allclose(
        corrected_twice_stress_variance(3.0, 9 * ratio, area_correction=gamma), 9 * y, rtol=5e-7
    )


def test_correction_solves_its_differential_equation():
    gamma, p = 0.42, 2.0
    solution = solve_ivp(
        lambda v, y: gamma + (1 - gamma) * erf(p / np.sqrt(y)) ** 2,
        (1e-9, 400.0),
        [1e-9],
        t_eval=[0.5, 4.0, 30.0, 400.0],
        rtol=1e-11,
        atol=1e-14,
        method="DOP853",
    )
    np.testing.assert_allclose(corrected_twice_stress_variance(p, solution.t), solution.y[0], rtol=3e-7)


@pytest.mark.parametrize("gamma", [1e-9, 0.05, AREA_CORRECTION, 0.999])
def test_many_values_are_those_of_few_to_the_last_bit(gamma):
    """Many look their cells up in a guide, few search for them; also on knots and beside them, beyond both ends, and NaN."""
    knots = np.exp(_single_table(gamma)[0])
    beside = np.concatenate([np.nextafter(knots, 0.0), knots, np.nextafter(knots, np.inf)])
    anywhere = np.exp(np.random.default_rng(1).uniform(-10.0, 60.0, 3000))
    values = np.concatenate([beside, anywhere, [0.0, np.inf, np.nan]])
    many = corrected_twice_stress_variance(1.0, values, area_correction=gamma)
    few = [
        corrected_twice_stress_variance(1.0, part, area_correction=gamma)
        for part in np.array_split(values, 20)
    ]
    assert np.array_equal(many, np.concatenate(few), equal_nan=True)


def test_limits_of_the_correction():
    twice_variance = np.array([0.0, 1e-6, 0.01, 1.0, 1e6, 1e22])
    assert np.array_equal(
        corrected_twice_stress_variance(1.0, twice_variance, area_correction=1.0), twice_variance
    )
    np.testing.assert_allclose(
        corrected_twice_stress_variance(1.0, twice_variance[:3]), twice_variance[:3], rtol=1e-15
    )
    assert corrected_twice_stress_variance(1.0, 1e22) == pytest.approx(0.42e22, rel=1e-12)
    assert corrected_twice_stress_variance(0.0, 5.0, area_correction=0.3) == pytest.approx(1.5, rel=1e-15)
    assert corrected_twice_stress_variance(1e-300, 1e5, area_correction=0.3) == pytest.approx(
        0.3e5, rel=1e-12
    )
    for bad in (0.0, -0.1, 1.1, np.nan):
        assert np.isnan(corrected_twice_stress_variance(1.0, 2.0, area_correction=bad))
    assert np.isnan(corrected_twice_stress_variance([-1.0, 1.0, np.nan], [1.0, -1.0, 1.0])).all()


def test_correction_of_a_batch_agrees_with_its_rows_to_the_last_bit():
    rng = np.random.default_rng(3)
    gamma = np.append(rng.uniform(0.01, 1, 40), [1.0, 0.42, 0.42, np.nan])[:, None]
    pressure = np.exp(rng.uniform(-3, 9, (1, 5)))
    twice_variance = np.exp(rng.uniform(-5, 50, (44, 5)))
    whole = corrected_twice_stress_variance(pressure, twice_variance, area_correction=gamma)
    for i in range(44):
        row = corrected_twice_stress_variance(
            pressure, twice_variance[i : i + 1], area_correction=gamma[i : i + 1]
        )
        assert np.array_equal(row[0], whole[i], equal_nan=True)
        for j in range(5):
            alone = corrected_twice_stress_variance(
                pressure[0, j], twice_variance[i, j], area_correction=gamma[i, 0]
            )
            assert np.array_equal(alone, whole[i, j], equal_nan=True)


@given(st.floats(1e-6, 1e6), st.floats(1e-6, 1e6), st.floats(1.001, 10), st.floats(1e-3, 1))
def test_area_is_monotone(pressure, twice_variance, factor, gamma):
    area = relative_contact_area(pressure, twice_variance, area_correction=gamma)
    assert 0 <= area <= 1
    assert relative_contact_area(pressure * factor, twice_variance, area_correction=gamma) >= area * (
        1 - 1e-6
    )
    assert relative_contact_area(pressure, twice_variance * factor, area_correction=gamma) <= area * (
        1 + 1e-6
    )
    assert persson_contact_area(pressure, twice_variance) <= area * (1 + 1e-6)
    effective = corrected_twice_stress_variance(pressure, twice_variance, area_correction=gamma)
    assert gamma * twice_variance * (1 - 1e-6) <= effective <= twice_variance * (1 + 1e-6)


def test_wet_skin_of_the_paper():
    twice_variance = twice_stress_variance(SURFACE, WET)
    assert twice_variance == pytest.approx(3.36644e14, rel=2e-6)
    assert persson_contact_area(PRESSURE, twice_variance) == pytest.approx(4.20040e-4, rel=2e-6)
    assert relative_contact_area(PRESSURE, twice_variance) == pytest.approx(6.48133e-4, rel=2e-6)
    assert relative_contact_area(PRESSURE, twice_variance, area_correction=0.406) == pytest.approx(
        6.59e-4, rel=5e-4
    )  # the printed value
    friction = friction_coefficient(
        15e6, relative_contact_area(PRESSURE, twice_variance), nominal_pressure=PRESSURE
    )
    assert friction == pytest.approx(1.42, abs=0.005)


def test_dry_skin_of_the_paper():
    twice_variance = twice_stress_variance(SURFACE, DRY)
    assert persson_contact_area(PRESSURE, twice_variance) == pytest.approx(2.94031e-6, rel=3e-6)
    area = elastoplastic_contact_area(PRESSURE, twice_variance, yield_stress=50e6)
    assert area.total == pytest.approx(PRESSURE / 50e6, rel=1e-12)  # 1.366e-4
    assert area.plastic_fraction == pytest.approx(1.0, rel=1e-12)
    assert friction_coefficient(15e6, area.total, nominal_pressure=PRESSURE) == pytest.approx(0.3, rel=1e-12)


@pytest.mark.parametrize(
    ("gamma", "wavevectors"),
    [(1.0, (7.048e4, 8.228e4, 1.0842e5)), (0.42, (8.386e4, 9.971e4, 1.3929e5))],
    ids=["plain", "corrected"],
)
def test_onset_of_yielding_in_dry_skin(gamma, wavevectors):
    fraction = elastoplastic_contact_area(
        PRESSURE,
        twice_stress_variance(SURFACE, DRY, wavevector=wavevectors),
        yield_stress=50e6,
        area_correction=gamma,
    ).plastic_fraction
    np.testing.assert_allclose(fraction, [0.1, 0.5, 0.99], atol=1e-3)
