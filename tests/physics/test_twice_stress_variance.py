"""Twice the stress variance against scipy.integrate.quad, batches against their rows."""

import itertools

import numpy as np
import pytest
from named_fields import skin_from, surface_from
from scipy.integrate import quad

from skinbayes.contact import LayeredSkin, reduced_modulus, surface_response, twice_stress_variance
from skinbayes.roughness import TabulatedSpectrum, named_surface, rms_slope


def random_parameters(count, seed, wide=False):
    rng = np.random.default_rng(seed)

    def log_uniform(low, high):
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    q0 = log_uniform(1e2, 1e5) if wide else log_uniform(3e2, 5e3)
    q_r = q0 * log_uniform(1, 1e3 if wide else 20)
    q1 = q_r * log_uniform(30, 1e5) if wide else log_uniform(1e7, 1e10)
    e1 = log_uniform(2e3, 2e5)
    e0 = e1 * (log_uniform(1e-3, 1e7) if wide else log_uniform(1, 1e6))
    nu = rng.uniform(0.1, 0.5, (2, count))
    d = log_uniform(1e-7, 1e-3) if wide else log_uniform(5e-6, 1e-4)
    roughness = (log_uniform(1e-6, 1e-4), rng.uniform(0.05, 1.0, count), q0, q_r, q1)
    return roughness, (e0, e1, nu[0], nu[1], d)


def by_quadrature(roughness, skin, upper=np.inf):
    """π∫q³ C E_eff² dq of one parameter vector, from the definitions."""
    height, hurst, q0, q_r, q1 = roughness
    kinks = np.log([q0, q_r, min(max(upper, q0), q1)])

    def spectrum_shape(q):
        return 1.0 if q < q_r else (q / q_r) ** (-2 * (1 + hurst))

    def over(function, start, stop):
        edges = np.linspace(start, stop, max(2, int(np.ceil((stop - start) / 0.8)) + 1))
        pairs = itertools.pairwise(edges)
        return sum(quad(function, a, b, epsabs=0, epsrel=1e-10)[0] for a, b in pairs if b > a)

    def full(function):
        return over(function, np.log(q0), np.log(q_r) - 1e-15) + over(function, np.log(q_r), np.log(q1))

    plateau = height**2 / (2 * np.pi * full(lambda t: np.exp(2 * t) * spectrum_shape(np.exp(t))))
    material = skin_from(skin)

    def stress(t):
        q = np.exp(t)
        return np.pi * q**4 * plateau * spectrum_shape(q) / surface_response(material, q) ** 2

    knee, end = min(kinks[1], kinks[2]), kinks[2]
    return reduced_modulus(skin[0], skin[2]) ** 2 * (over(stress, kinks[0], knee) + over(stress, knee, end))


@pytest.mark.parametrize(("seed", "wide", "tolerance"), [(1, False, 1e-7), (2, True, 5e-5)])
def test_variance_agrees_with_quadrature(seed, wide, tolerance):
    roughness, skin = random_parameters(25, seed, wide)
    found = twice_stress_variance(surface_from(roughness), skin_from(skin))
    expected = [by_quadrature([x[i] for x in roughness], [x[i] for x in skin]) for i in range(25)]
    np.testing.assert_allclose(found, expected, rtol=tolerance)


def test_variance_up_to_a_wavevector_agrees_with_quadrature():
    roughness, skin = random_parameters(4, 3)
    q = np.array([2e2, 6e3, 3e4, 1e5, 4e5, 1e8, 1e12])
    found = twice_stress_variance(surface_from(roughness), skin_from(skin), wavevector=q)
    for i in range(4):
        one = [x[i] for x in roughness], [x[i] for x in skin]
        np.testing.assert_allclose(found[i], [by_quadrature(*one, upper) for upper in q], rtol=1e-6)
    assert np.all(found[:, 0] == 0)
    np.testing.assert_allclose(found[:, -1], twice_stress_variance(surface_from(roughness), skin_from(skin)))


def test_without_a_layer_the_slope_is_all_that_matters():
    surface, modulus = named_surface("paper_reference"), reduced_modulus(1e6, 0.4)
    found = twice_stress_variance(
        surface,
        LayeredSkin(
            young_modulus_layer=1e6,
            young_modulus_bulk=1e6,
            poisson_ratio_layer=0.4,
            poisson_ratio_bulk=0.4,
            layer_thickness=2e-5,
        ),
    )
    assert found == pytest.approx(modulus**2 * rms_slope(surface) ** 2 / 2, rel=1e-12)


def test_very_thick_and_very_thin_layers_are_half_spaces():
    surface = named_surface("paper_reference")
    half_slope_squared = rms_slope(surface) ** 2 / 2
    thick = twice_stress_variance(
        surface, LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=2e4, layer_thickness=1.0)
    )
    thin = twice_stress_variance(
        surface, LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=2e4, layer_thickness=1e-15)
    )
    assert thick == pytest.approx(reduced_modulus(7e6, 0.5) ** 2 * half_slope_squared, rel=1e-12)
    assert thin == pytest.approx(reduced_modulus(2e4, 0.5) ** 2 * half_slope_squared, rel=2e-3)


def test_tabulated_and_closed_spectrum_agree():
    surface = named_surface("paper_reference")
    q = np.union1d(np.geomspace(1e3, 1e9, 60), [surface.wavevector_rolloff])
    table = TabulatedSpectrum(q, surface.power(q))
    skin = LayeredSkin(
        young_modulus_layer=np.array([7e6, 1e9]),
        young_modulus_bulk=2e4,
        layer_thickness=np.array([2e-5, 5e-6]),
    )
    np.testing.assert_allclose(
        twice_stress_variance(table, skin), twice_stress_variance(surface, skin), rtol=1e-6
    )
    upper = np.geomspace(5e2, 3e9, 23)
    np.testing.assert_allclose(
        twice_stress_variance(table, skin, wavevector=upper),
        twice_stress_variance(surface, skin, wavevector=upper),
        rtol=2e-5,
    )


def identical(a, b):
    return np.array_equal(np.asarray(a), np.asarray(b), equal_nan=True)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 64, 65])
@pytest.mark.parametrize("upper", [None, np.geomspace(1e3, 1e9, 11)])
def test_batch_and_rows_agree_to_the_last_bit(count, upper):
    roughness, skin = random_parameters(count, 5, wide=True)
    whole = twice_stress_variance(surface_from(roughness), skin_from(skin), wavevector=upper)
    for i in range(count):
        row = slice(i, i + 1)
        part = twice_stress_variance(
            surface_from(x[row] for x in roughness), skin_from(x[row] for x in skin), wavevector=upper
        )
        alone = twice_stress_variance(
            surface_from(x[i] for x in roughness), skin_from(x[i] for x in skin), wavevector=upper
        )
        assert identical(part[0], whole[i])
        assert identical(alone, whole[i])


@pytest.mark.parametrize("upper", [None, np.geomspace(1e3, 1e9, 11)])
def test_batch_of_a_table_agrees_with_its_rows_to_the_last_bit(upper):
    surface = named_surface("paper_reference")
    q = np.geomspace(1e3, 1e9, 40)
    _, skin = random_parameters(9, 6)
    scale = np.linspace(0.5, 2, 9)
    whole = twice_stress_variance(
        TabulatedSpectrum(q, surface.power(q), scale=scale), skin_from(skin), wavevector=upper
    )
    for i in range(9):
        table = TabulatedSpectrum(q, surface.power(q), scale=scale[i])
        assert identical(
            twice_stress_variance(table, skin_from(x[i] for x in skin), wavevector=upper), whole[i]
        )


def test_shapes_and_nan():
    surface = surface_from((np.array([[1e-5], [-1e-5], [2e-5]]), 0.8, 1e3, 1e4, 1e9))
    skin = LayeredSkin(
        young_modulus_layer=np.array([[7e6, 1e9]]), young_modulus_bulk=2e4, layer_thickness=2e-5
    )
    assert twice_stress_variance(surface, skin).shape == (3, 2)
    assert twice_stress_variance(surface, skin, wavevector=1e5).shape == (3, 2)
    assert twice_stress_variance(surface, skin, wavevector=[1e5, 1e6, 1e7]).shape == (3, 2, 3)
    assert twice_stress_variance(surface, skin, wavevector=np.full((3, 2, 4), 1e5)).shape == (3, 2, 4)
    bad = np.isnan(twice_stress_variance(surface, skin))
    assert bad[1].all() and not bad[[0, 2]].any()
    assert np.isnan(
        twice_stress_variance(
            surface, LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=-2e4, layer_thickness=2e-5)
        )
    ).all()


def test_rows_of_wavevectors_that_belong_to_the_batch():
    surface = surface_from((np.array([1e-5, 2e-5]), 0.8, 1e3, 1e4, 1e9))
    skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=2e4, layer_thickness=2e-5)
    upper = np.array([[1e4, 1e5], [1e6, 1e7]])
    found = twice_stress_variance(surface, skin, wavevector=upper)
    for i in range(2):
        one = surface_from((surface.rms_height[i], 0.8, 1e3, 1e4, 1e9))
        assert identical(found[i], twice_stress_variance(one, skin, wavevector=upper[i]))


def test_more_roughness_more_stress():
    surface, skin = (
        named_surface("paper_reference"),
        LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=2e4, layer_thickness=2e-5),
    )
    assert np.all(
        np.diff(twice_stress_variance(surface, skin, wavevector=np.geomspace(1.01e3, 1e9, 300))) > 0
    )
