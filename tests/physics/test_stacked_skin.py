"""Skin of several layers against one layer, none, and all layers solved at once from Airy's stress functions."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from skinbayes.contact import (
    HomogeneousSolid,
    LayeredSkin,
    StackedSkin,
    effective_modulus,
    mean_separation,
    modulus_under_ball,
    surface_response,
    twice_stress_variance,
    validate_solid,
)
from skinbayes.errors import InputError
from skinbayes.roughness import named_surface

SURFACE = named_surface("paper_reference")
Q = np.geomspace(1e1, 1e7, 61)


def columns(z, depth, nu, decaying_only):
    """Rows σ_zz, σ_xz, 2G u_x and 2G u_z of f = (1, z) exp(−z) and, from the lower face, (1, depth − z) exp(z − depth); q = 1."""
    found = []
    for sign, place in ((-1.0, z),) if decaying_only else ((-1.0, z), (1.0, depth - z)):
        growth = np.exp(-place)
        for power in (0, 1):
            # s^k f + k s^(k-1) f' of z^power exp(sign z), written in the distance from the face where it is largest
            slope = 1.0 if sign < 0 else -1.0
            f = [
                (sign**k * place + k * sign ** (k - 1) * slope if power else sign**k) * growth
                for k in range(4)
            ]
            found.append([-f[0], f[1], (1 - nu) * f[2] + nu * f[0], (1 - nu) * f[3] - (2 - nu) * f[1]])
    return np.array(found).T


def all_at_once(q, moduli, ratios, thicknesses):
    """Modulus of a stack from one linear system for the coefficients of all layers, without a recursion."""
    shear = [m / (2 * (1 + nu)) for m, nu in zip(moduli, ratios, strict=True)]
    layers, size = len(thicknesses), 4 * len(thicknesses) + 2
    matrix, right = np.zeros((size, size)), np.zeros(size)
    matrix[:2, :4] = columns(0.0, q * thicknesses[0], ratios[0], False)[:2]
    right[0] = -1.0  # a pressure cos(qx)
    for i in range(layers):
        deep, row, place = q * thicknesses[i], 2 + 4 * i, 4 * i
        above = columns(deep, deep, ratios[i], False)
        last = i + 1 == layers
        below = columns(0.0, 0.0 if last else q * thicknesses[i + 1], ratios[i + 1], last)
        unit = np.array([1.0, 1.0, shear[0] / shear[i], shear[0] / shear[i]])[:, None]
        matrix[row : row + 4, place : place + 4] = above * unit
        unit = np.array([1.0, 1.0, shear[0] / shear[i + 1], shear[0] / shear[i + 1]])[:, None]
        matrix[row : row + 4, place + 4 : place + (6 if last else 8)] = -below * unit
    coefficients = np.linalg.solve(matrix, right)
    displacement = columns(0.0, q * thicknesses[0], ratios[0], False)[3] @ coefficients[:4]
    # a pressure p on a half-space sinks by 2p/(q E*), here 1/(2G) of that
    return abs(2 * 2 * shear[0] / displacement)


@pytest.mark.parametrize(
    ("moduli", "ratios", "thicknesses"),
    [
        ([7e6, 80e3, 15e3], [0.5, 0.5, 0.5], [20e-6, 1.2e-3]),
        ([1e9, 80e3, 5e3, 100e3], [0.5, 0.45, 0.4, 0.5], [20e-6, 1.2e-3, 5e-3]),
        ([50e3, 2e6, 10e3], [0.3, 0.5, 0.2], [100e-6, 50e-6]),
    ],
)
def test_all_layers_at_once(moduli, ratios, thicknesses):
    skin = StackedSkin(young_moduli=moduli, poisson_ratios=ratios, thicknesses=thicknesses)
    expected = [all_at_once(q, moduli, ratios, thicknesses) for q in Q]
    assert effective_modulus(skin, Q) == pytest.approx(expected, rel=1e-7)
    compliance, fall = skin.compliance_fall(Q)
    assert compliance == pytest.approx(1 / (Q * expected), rel=1e-7)
    step = 1e-4
    after, before = (1 / (q * effective_modulus(skin, q)) for q in (Q * np.exp(step), Q * np.exp(-step)))
    assert fall == pytest.approx(-(after - before) / (2 * step), rel=1e-6)


def test_one_layer_and_none():
    one = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    stacked = StackedSkin(young_moduli=[7e6, 20e3], thicknesses=[20e-6])
    finer = StackedSkin(young_moduli=[7e6, 7e6, 20e3], thicknesses=[5e-6, 15e-6])
    for skin in (stacked, finer):
        assert effective_modulus(skin, Q) == pytest.approx(effective_modulus(one, Q), rel=1e-10)
        assert mean_separation([1e2, 1e4], SURFACE, skin=skin) == pytest.approx(
            mean_separation([1e2, 1e4], SURFACE, skin=one), rel=1e-8 if skin is stacked else 1e-4
        )
    for part in ("contact_modulus", "surface_modulus", "transition_length"):
        assert getattr(stacked, part) == pytest.approx(getattr(one, part), rel=1e-14)
    same = StackedSkin(young_moduli=[20e3] * 4, thicknesses=[20e-6, 1e-3, 5e-3])
    assert surface_response(same, Q) == pytest.approx(1.0, rel=1e-12)
    assert twice_stress_variance(SURFACE, same) == pytest.approx(
        twice_stress_variance(SURFACE, HomogeneousSolid(young_modulus=20e3)), rel=1e-9
    )


def test_integrals_over_the_band():
    skin = StackedSkin(young_moduli=[7e6, 80e3, 15e3], thicknesses=[20e-6, 1.2e-3])
    ends = np.log([SURFACE.wavevector_min, SURFACE.wavevector_max])

    def density(place):
        q = np.exp(place)
        return np.pi * q**4 * SURFACE.power(q) * effective_modulus(skin, q) ** 2

    knots = np.linspace(*ends, 16)
    expected = sum(quad(density, a, b, epsrel=1e-7)[0] for a, b in pairwise(knots))
    assert twice_stress_variance(SURFACE, skin) == pytest.approx(expected, rel=1e-6)
    # the layer below the first is felt by the longest waves only
    wide = mean_separation(1e2, SURFACE, skin=skin)
    softer = StackedSkin(young_moduli=[7e6, 15e3, 15e3], thicknesses=[20e-6, 1.2e-3])
    assert mean_separation(1e2, SURFACE, skin=softer) < wide


def test_batches_and_what_cannot_be():
    moduli = np.array([[7e6, 80e3, 15e3], [1e8, 50e3, 15e3], [7e6, -1.0, 15e3]])
    batch = StackedSkin(young_moduli=moduli, thicknesses=[20e-6, 1e-3])
    together = effective_modulus(batch, Q)
    alone = [effective_modulus(StackedSkin(young_moduli=row, thicknesses=[20e-6, 1e-3]), Q) for row in moduli]
    assert np.array_equal(together, np.array(alone), equal_nan=True)
    assert np.isnan(together[2]).all() and np.isfinite(together[:2]).all()
    assert np.isnan(effective_modulus(batch, -1.0)).all()
    with pytest.raises(InputError, match=r"thicknesses is 0 m, but must be a finite number > 0 m"):
        validate_solid(StackedSkin(young_moduli=[7e6, 80e3, 15e3], thicknesses=[20e-6, 0.0]))
    with pytest.raises(InputError, match="young_moduli is -1 Pa"):
        validate_solid(batch)


def test_what_a_ball_meets():
    """The stratum corneum is left out; equal layers are one; a thick layer is all there is."""
    ball = {"normal_force": np.array([0.05, 0.2]), "sphere_radius": 8e-3}
    one = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    assert modulus_under_ball(**ball, skin=one) == one.contact_modulus
    same = StackedSkin(young_moduli=[7e6, 20e3, 20e3], thicknesses=[20e-6, 1e-3])
    assert modulus_under_ball(**ball, skin=same) == pytest.approx(20e3 / 0.75, rel=1e-8)
    thick = StackedSkin(young_moduli=[7e6, 50e3, 20e3], thicknesses=[20e-6, 10.0])
    assert modulus_under_ball(**ball, skin=thick) == pytest.approx(50e3 / 0.75, rel=1e-3)
    thin = StackedSkin(young_moduli=[7e6, 50e3, 20e3], thicknesses=[20e-6, 1e-3])
    found = modulus_under_ball(**ball, skin=thin)
    assert (found > 20e3 / 0.75).all() and (found < 50e3 / 0.75).all() and found[0] > found[1]
    batch = StackedSkin(young_moduli=[[7e6, 50e3, 20e3], [7e6, -1.0, 20e3]], thicknesses=[20e-6, 1e-3])
    both = modulus_under_ball(0.05, 8e-3, skin=batch)
    assert both[0] == found[0] and np.isnan(both[1])
