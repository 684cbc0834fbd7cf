"""Tabulated spectra: interpolation, moments, quadrature weights, and the step from profiles to surfaces."""

import itertools

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import gamma as gamma_function

from skinbayes.errors import InputError
from skinbayes.roughness import (
    SelfAffineSpectrum,
    TabulatedSpectrum,
    rms_height,
    rms_slope,
    spectral_moment,
)

RNG = np.random.default_rng(7)
ROUGH_Q = np.sort(np.exp(RNG.uniform(np.log(2e2), np.log(5e8), 60)))
ROUGH_C = 1e-10 * ROUGH_Q**-2.5 * np.exp(RNG.normal(0, 0.8, 60))


def interpolate(q, table_q=ROUGH_Q, table_c=ROUGH_C):
    return np.exp(np.interp(np.log(q), np.log(table_q), np.log(table_c)))


def integrate(function, upper=np.inf, table_q=ROUGH_Q):
    """∫ function dln q cell by cell."""
    edges = np.append(table_q[table_q < upper], min(upper, table_q[-1]))
    return sum(
        quad(lambda t: function(np.exp(t)), np.log(a), np.log(b), epsabs=0, epsrel=1e-11)[0]
        for a, b in itertools.pairwise(edges)
        if b > a * (1 + 1e-12)
    )


def test_power_law_between_nodes_and_nothing_outside():
    table = TabulatedSpectrum(ROUGH_Q, ROUGH_C)
    q = np.geomspace(ROUGH_Q[0], ROUGH_Q[-1] * (1 - 1e-12), 501)
    np.testing.assert_allclose(table.power(q), interpolate(q), rtol=1e-10)
    np.testing.assert_allclose(table.power(ROUGH_Q), ROUGH_C, rtol=1e-12)
    assert np.all(table.power([ROUGH_Q[0] * 0.99, ROUGH_Q[-1] * 1.01]) == 0)


@pytest.mark.parametrize("order", [0.0, 2.0, 4.0])
def test_moments_agree_with_quadrature(order):
    expected = 2 * np.pi * integrate(lambda q: q ** (order + 2) * interpolate(q))
    assert spectral_moment(TabulatedSpectrum(ROUGH_Q, ROUGH_C), order) == pytest.approx(expected, rel=1e-10)


def test_logarithmic_cells():
    # C ∝ q^−2 makes the mean square height, C ∝ q^−4 the mean square slope a logarithm
    q = np.array([1e3, 1e5])
    assert rms_height(TabulatedSpectrum(q, q**-2.0)) ** 2 == pytest.approx(2 * np.pi * np.log(100), rel=1e-12)
    assert rms_slope(TabulatedSpectrum(q, q**-4.0)) ** 2 == pytest.approx(2 * np.pi * np.log(100), rel=1e-12)


def smooth(q):
    """As steep as the square of a layered modulus gets."""
    x = q * 2e-5
    return (1e-4 + x**3 / (1 + x**3)) ** 2


@pytest.mark.parametrize("upper", [None, 3e2, 7.7e4, 1e6, 4e8, 1e12])
def test_quadrature_of_a_smooth_function_against_a_rough_table(upper):
    rule = TabulatedSpectrum(ROUGH_Q, ROUGH_C).slope_quadrature(
        1.0, None if upper is None else np.array([upper])
    )
    found = (rule.weights * smooth(rule.nodes)).sum(axis=-1) + rule.remainder
    expected = integrate(lambda q: q**4 * interpolate(q) * smooth(q), upper or np.inf)
    np.testing.assert_allclose(found, expected, rtol=2e-5)


def test_scale_multiplies_the_variance():
    table = TabulatedSpectrum(ROUGH_Q, ROUGH_C)
    scaled = TabulatedSpectrum(ROUGH_Q, ROUGH_C, scale=np.array([[4.0], [9.0], [-1.0]]))
    np.testing.assert_allclose(
        rms_height(scaled)[:2, 0], rms_height(table) * np.array([2.0, 3.0]), rtol=1e-14
    )
    assert np.isnan(rms_height(scaled)[2, 0])
    assert scaled.power([1e4, 1e5]).shape == (3, 1, 2)
    np.testing.assert_allclose(scaled.power([1e4, 1e5])[0, 0], 4 * table.power([1e4, 1e5]), rtol=1e-14)


def test_table_does_not_follow_the_callers_array():
    q, c = ROUGH_Q.copy(), ROUGH_C.copy()
    table = TabulatedSpectrum(q, c)
    before = rms_slope(table)
    c[:] = 1.0
    assert rms_slope(table) == before


def test_gaussian_correlation_from_its_profile():
    # h² exp(−r²/ℓ²): C1D = h²ℓ/(2√π) exp(−q²ℓ²/4), C = h²ℓ²/(4π) exp(−q²ℓ²/4)
    height, length = 3e-6, 1e-4
    q = np.geomspace(1e1, 8e4, 400)
    decay = np.exp(-((q * length) ** 2) / 4)
    spectrum = TabulatedSpectrum.from_profile(q, height**2 * length / (2 * np.sqrt(np.pi)) * decay)
    expected = height**2 * length**2 / (4 * np.pi) * decay
    near = q * length < 4  # beyond, straight lines between nodes stop picturing the fall
    np.testing.assert_allclose(spectrum.node_power[near], expected[near], rtol=6e-3)
    assert rms_height(spectrum) == pytest.approx(height, rel=1e-3)


@pytest.mark.parametrize("exponent", [1.3, 2.6, 3.0])
def test_power_law_from_its_profile(exponent):
    # C1D = q^−b comes from C = q^(−b−1) Γ((b+1)/2)/(√π Γ(b/2)), also from a table of two nodes
    ratio = gamma_function((exponent + 1) / 2) / (np.sqrt(np.pi) * gamma_function(exponent / 2))
    for count in (2, 5, 90):
        q = np.geomspace(1e3, 1e8, count)
        spectrum = TabulatedSpectrum.from_profile(q, q**-exponent)
        np.testing.assert_allclose(spectrum.node_power, ratio * q ** (-exponent - 1), rtol=1e-8)


def test_profile_of_the_isotropic_spectrum_gives_the_profile_back():
    surface = SelfAffineSpectrum(
        rms_height=2e-6, hurst_exponent=0.8, wavevector_min=1e3, wavevector_rolloff=8e3, wavevector_max=1e7
    )

    def profile(q):
        # C1D(q) = 2 ∫ k C(k)/sqrt(k² − q²) dk with k² = q² + u²
        u_end = np.sqrt(1e14 - q * q)
        edges = np.unique(np.clip([1.0, np.sqrt(max(8e3**2 - q * q, 1.0)), q, 10 * q, u_end], 1.0, u_end))
        pieces = [
            quad(
                lambda t: np.exp(t) * surface.power(np.hypot(q, np.exp(t))), np.log(a), np.log(b), epsrel=1e-8
            )[0]
            for a, b in itertools.pairwise(edges)
        ]
        return 2 * (sum(pieces) + surface.power(q))

    q = np.geomspace(1.001e3, 2e6, 60)
    spectrum = TabulatedSpectrum.from_profile(q, [profile(x) for x in q])
    inner = (q < 3e5) & (np.abs(np.log(q / 8e3)) > 0.45)  # away from the kink and from the end
    np.testing.assert_allclose(spectrum.node_power[inner], surface.power(q[inner]), rtol=0.02)


@pytest.mark.parametrize(
    ("q", "c", "message"),
    [
        ([1e3], [1.0], "same length, at least 2"),
        ([1e3, 1e4], [1.0], "same length"),
        ([[1e3, 1e4]], [[1.0, 1.0]], "same length"),
        ([1e3, 1e4, 1e4], [1.0, 1.0, 1.0], "entry 3 is 10000 1/m after 10000"),
        ([1e3, -1e4], [1.0, 1.0], "entry 2, is -10000 1/m"),
        ([1e3, 1e4], [1.0, 0.0], "power, entry 2, is 0 m\\^4"),
        ([1e3, 1e4], [np.nan, 1.0], "entry 1"),
        ([1e3, np.inf], [1.0, 1.0], "entry 2"),
    ],
)
def test_bad_tables_are_refused(q, c, message):
    with pytest.raises(InputError, match=message):
        TabulatedSpectrum(q, c)


def test_profiles_that_no_isotropic_surface_has_are_refused():
    with pytest.raises(InputError, match="must fall there"):
        TabulatedSpectrum.from_profile([1e3, 1e4], [1e-12, 2e-12])
    with pytest.raises(InputError, match=r"negative at 1000 1/m"):
        TabulatedSpectrum.from_profile([1e3, 1e4, 1e5], [1e-12, 5e-11, 1e-13])
