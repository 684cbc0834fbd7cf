"""Eq. 4 against its limits and against the layer problem solved from scratch in sixty digits."""

from decimal import Decimal, getcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from named_fields import skin_from

from skinbayes.contact import (
    LayeredSkin,
    effective_modulus,
    reduced_modulus,
    surface_response,
    validate_solid,
)
from skinbayes.errors import InputError


def stress_function(term, z, order):
    """Derivative of ``z^power exp(sign z)``, term = (power, sign), in units of 1/q: ``(d/dz)^order``."""
    power, sign = term
    growth = (sign * z).exp()
    if power == 0:
        return sign**order * growth
    return (sign**order * z + (order * sign ** (order - 1) if order else 0)) * growth


def solve(matrix, right):
    """Gaussian elimination with pivoting in decimal arithmetic."""
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    size = len(rows)
    for i in range(size):
        pivot = max(range(i, size), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, size):
            factor = rows[k][i] / rows[i][i]
            rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i], strict=True)]
    solution = [Decimal(0)] * size
    for i in reversed(range(size)):
        rest = sum(rows[i][k] * solution[k] for k in range(i + 1, size))
        solution[i] = (rows[i][size] - rest) / rows[i][i]
    return solution


def response_by_linear_system(e0, e1, nu0, nu1, x):
    """S = displacement under cos(qx) pressure over that of a half-space of the layer's material; Airy's stress function.

    Plane strain, q = 1: φ = cos(x) f(z), σ_zz = −f, σ_xz = f′, 2G u_x = (1 − ν)f″ + νf, 2G u_z = (1 − ν)f‴ − (2 − ν)f′.
    """
    getcontext().prec = 60
    e0, e1, nu0, nu1, x = (Decimal(v) for v in (e0, e1, nu0, nu1, x))
    g0, g1 = e0 / (2 * (1 + nu0)), e1 / (2 * (1 + nu1))
    layer = [(p, Decimal(s)) for s in (-1, 1) for p in (0, 1)]
    bulk = [(p, Decimal(-1)) for p in (0, 1)]
    zero = Decimal(0)

    def along(term, z, nu):
        return (1 - nu) * stress_function(term, z, 2) + nu * stress_function(term, z, 0)

    def down(term, z, nu):
        return (1 - nu) * stress_function(term, z, 3) - (2 - nu) * stress_function(term, z, 1)

    matrix = [
        [stress_function(t, zero, 0) for t in layer] + [zero, zero],
        [stress_function(t, zero, 1) for t in layer] + [zero, zero],
        [stress_function(t, x, 0) for t in layer] + [-stress_function(t, zero, 0) for t in bulk],
        [stress_function(t, x, 1) for t in layer] + [-stress_function(t, zero, 1) for t in bulk],
        [along(t, x, nu0) / g0 for t in layer] + [-along(t, zero, nu1) / g1 for t in bulk],
        [down(t, x, nu0) / g0 for t in layer] + [-down(t, zero, nu1) / g1 for t in bulk],
    ]
    coefficients = solve(matrix, [Decimal(1)] + [zero] * 5)
    layered = sum(c * down(t, zero, nu0) for c, t in zip(coefficients, layer, strict=False))
    # half-space: f = (1 + z) exp(−z)
    alone = down((0, Decimal(-1)), zero, nu0) + down((1, Decimal(-1)), zero, nu0)
    return float(layered / alone)


MATERIALS = [
    (7e6, 20e3, 0.5, 0.5),
    (1e9, 20e3, 0.5, 0.5),
    (1e9, 1e4, 0.3, 0.5),
    (2e11, 2e4, 0.45, 0.2),
    (2e11, 2e4, 0.5, 0.5),
    (3e4, 2e4, 0.1, 0.4),
    (2e4, 2e4, -0.3, 0.5),
    (2e4, 7e6, 0.4, 0.3),
]


@pytest.mark.parametrize("material", MATERIALS)
def test_response_agrees_with_a_solution_of_the_layer_problem(material):
    thickness = 20e-6
    skin = skin_from((*material, thickness))
    x = np.array([1e-4, 3e-3, 0.05, 0.3, 1.0, 2.7, 6.0, 15.0])
    expected = [response_by_linear_system(*material, value) for value in x]
    np.testing.assert_allclose(surface_response(skin, x / thickness), expected, rtol=2e-11)


@pytest.mark.parametrize("ratio", [1e-7, 1e-4, 1e-2])
def test_soft_layer_on_stiff_ground(ratio):
    x = np.array([1e-3, 0.05, 0.5, 3.0])
    expected = [response_by_linear_system(2e4 * ratio, 2e4, 0.5, 0.5, value) for value in x]
    np.testing.assert_allclose(
        surface_response(
            LayeredSkin(young_modulus_layer=2e4 * ratio, young_modulus_bulk=2e4, layer_thickness=1.0), x
        ),
        expected,
        rtol=1e-9,
    )


def test_no_layer_is_no_layer():
    np.testing.assert_allclose(
        surface_response(
            LayeredSkin(
                young_modulus_layer=5e4,
                young_modulus_bulk=5e4,
                poisson_ratio_layer=0.3,
                poisson_ratio_bulk=0.3,
                layer_thickness=2e-5,
            ),
            np.geomspace(1, 1e8, 30),
        ),
        1.0,
        rtol=1e-14,
    )


@given(st.floats(1e-3, 1e7), st.floats(-0.9, 0.5), st.floats(-0.9, 0.5), st.floats(1e-7, 1e-3))
def test_limits_of_the_response(ratio, nu0, nu1, thickness):
    skin = skin_from((2e4 * ratio, 2e4, nu0, nu1, thickness))
    static = reduced_modulus(2e4 * ratio, nu0) / reduced_modulus(2e4, nu1)
    response = surface_response(skin, [0.0, 1e-9 / thickness, 60 / thickness])
    assert response[0] == pytest.approx(static, rel=1e-9)
    assert response[2] == pytest.approx(1.0, rel=1e-12)
    assert effective_modulus(skin, 0.0) == pytest.approx(reduced_modulus(2e4, nu1), rel=1e-9)


@given(st.floats(1.01, 1e7), st.floats(0.0, 0.5))
def test_a_stiff_layer_hides_the_bulk_more_at_larger_wavevectors(ratio, nu):
    response = surface_response(skin_from((ratio, 1.0, nu, nu, 1.0)), np.geomspace(1e-6, 20, 200))
    assert np.all(np.diff(response) <= 1e-12 * response[:-1])


def test_shapes():
    skin = LayeredSkin(
        young_modulus_layer=np.full((3, 1), 7e6),
        young_modulus_bulk=2e4,
        layer_thickness=np.full((1, 2), 2e-5),
    )
    assert surface_response(skin, np.geomspace(1e3, 1e8, 5)).shape == (3, 2, 5)
    assert surface_response(skin, np.full((3, 2, 4), 1e5)).shape == (3, 2, 4)
    assert effective_modulus(skin, 1e5).shape == (3, 2)


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ((-7e6, 2e4, 0.5, 0.5, 2e-5), "young_modulus_layer is -7e\\+06 Pa"),
        ((-7e6, -2e4, 0.5, 0.5, 2e-5), "young_modulus_layer"),
        ((7e6, 0.0, 0.5, 0.5, 2e-5), "young_modulus_bulk is 0 Pa"),
        ((7e6, 2e4, 0.6, 0.5, 2e-5), "poisson_ratio_layer is 0.6"),
        ((7e6, 2e4, 0.5, -1.0, 2e-5), "poisson_ratio_bulk is -1"),
        ((7e6, 2e4, 0.5, 0.5, 0.0), "layer_thickness is 0 m"),
        ((np.nan, 2e4, 0.5, 0.5, 2e-5), "young_modulus_layer is nan"),
    ],
)
def test_impossible_skin(bad, message):
    assert np.all(np.isnan(surface_response(skin_from(bad), [1e3, 1e5])))
    with pytest.raises(InputError, match=message):
        validate_solid(skin_from(bad))


def test_reduced_modulus():
    assert reduced_modulus(20e3, 0.5) == pytest.approx(20e3 / 0.75, rel=1e-15)
    assert np.isnan(reduced_modulus([-1.0, 0.0, 1.0], [0.5, 0.5, 0.7])).all()
