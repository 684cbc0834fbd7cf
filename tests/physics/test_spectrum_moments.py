"""Closed forms of the self-affine spectrum against quadrature, and the named surfaces."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from named_fields import surface_from
from scipy.integrate import quad

from skinbayes.errors import InputError
from skinbayes.roughness import (
    SURFACES,
    named_surface,
    rms_height,
    rms_slope,
    spectral_moment,
    total_area_ratio,
    validate_spectrum,
)


def power_by_hand(q, plateau, hurst, q0, q_r, q1):
    if not q0 <= q <= q1:
        return 0.0
    return plateau if q < q_r else plateau * (q / q_r) ** (-2 * (1 + hurst))


def moment_by_quadrature(spectrum, order):
    q0, q_r, q1 = spectrum.wavevector_min, spectrum.wavevector_rolloff, spectrum.wavevector_max
    plateau, hurst = spectrum.plateau_power, spectrum.hurst_exponent

    def integrand(t):
        q = np.exp(t)
        return 2 * np.pi * q ** (order + 2) * power_by_hand(q, plateau, hurst, q0, q_r, q1)

    total = 0.0
    for a, b in ((q0, q_r), (q_r, q1)):
        ends = np.log([a * (1 + 1e-15), b * (1 - 1e-15)])
        for left, right in zip(np.linspace(*ends, 9)[:-1], np.linspace(*ends, 9)[1:], strict=True):
            total += quad(integrand, left, right, epsabs=0, epsrel=1e-12)[0] if right > left else 0.0
    return total


CASES = [
    (22.4e-6, 0.78, 1e3, 6.345e3, 1e9),
    (1e-6, 1.0, 1e4, 3e4, 1e8),  # the slope grows with the logarithm of the band
    (1e-6, 1.0 - 1e-9, 1e4, 3e4, 1e8),
    (3e-7, 0.5, 1e5, 1e5, 1e7),  # no plateau; order 1 is logarithmic
    (5e-6, 0.05, 2e2, 1e4, 1e6),
    (5e-6, 0.8, 1e3, 1e5, 1e5),  # plateau only
]


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("order", [0.0, 1.0, 2.0, 4.0])
def test_moments_agree_with_quadrature(case, order):
    spectrum = surface_from(case)
    assert spectral_moment(spectrum, order) == pytest.approx(moment_by_quadrature(spectrum, order), rel=1e-10)


@pytest.mark.parametrize("case", CASES)
def test_height_is_the_height_that_was_given(case):
    assert rms_height(surface_from(case)) == pytest.approx(case[0], rel=1e-13)


@pytest.mark.parametrize("case", CASES)
def test_power_is_the_definition(case):
    spectrum = surface_from(case)
    q = np.geomspace(case[2] / 3, case[4] * 3, 200)
    expected = [power_by_hand(x, spectrum.plateau_power, *case[1:]) for x in q]
    np.testing.assert_allclose(spectrum.power(q), expected, rtol=1e-12)


def test_textbook_slope_without_plateau():
    # s² = h² q0² H/(1 − H) [(q1/q0)^(2−2H) − 1]/[1 − (q1/q0)^(−2H)]
    height, hurst, q0, q1 = 2e-6, 0.7, 1e4, 1e9
    ratio = q1 / q0
    expected = (
        height
        * q0
        * np.sqrt(hurst / (1 - hurst) * (ratio ** (2 - 2 * hurst) - 1) / (1 - ratio ** (-2 * hurst)))
    )
    assert rms_slope(surface_from((height, hurst, q0, q0, q1))) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("slope", [1e-3, 0.1, 0.88, 2.8, 30.0, 1e4])
def test_area_ratio_is_the_mean_area_element(slope):
    # the squared gradient of an isotropic Gaussian surface is exponentially distributed
    excess = quad(lambda t: (np.sqrt(1 + slope**2 * t) - 1) * np.exp(-t), 0, np.inf, epsabs=0, epsrel=1e-11)[
        0
    ]
    assert total_area_ratio(slope) - 1 == pytest.approx(excess, rel=1e-8)


def test_area_ratio_limits():
    assert total_area_ratio(0.0) == 1.0
    assert np.isnan(total_area_ratio(-1.0))
    assert total_area_ratio(1e8) == pytest.approx(np.sqrt(np.pi) / 2 * 1e8, rel=1e-7)


def test_paper_reference_has_the_slope_and_area_of_the_paper():
    slope = rms_slope(named_surface("paper_reference"))
    assert slope == pytest.approx(2.79993, abs=5e-6)
    assert total_area_ratio(slope) == pytest.approx(2.73, abs=5e-3)  # printed 2.7
    assert rms_slope(named_surface("paper_reference_sharp")) == pytest.approx(2.8, rel=0.01)


def test_amplitude_at_large_wavevectors_is_shared_by_both_consistent_surfaces():
    q = [1e6, 1e8]
    sharp, plateau = (
        named_surface("paper_reference_sharp").power(q),
        named_surface("paper_reference").power(q),
    )
    np.testing.assert_allclose(sharp, plateau, rtol=0.02)


def test_printed_parameters_contradict_the_printed_slope():
    slope = rms_slope(named_surface("paper_printed"))
    assert slope == pytest.approx(0.885, abs=0.005)
    assert total_area_ratio(slope) == pytest.approx(1.31, abs=0.005)
    assert "nconsistent" in SURFACES["paper_printed"].description


def test_unknown_surface_lists_those_there_are():
    with pytest.raises(InputError, match=r"'skin'.*paper_reference, paper_reference_sharp, paper_printed"):
        named_surface("skin")


BAD = {
    "negative height": (-1e-6, 0.8, 1e3, 1e4, 1e8),
    "zero height": (0.0, 0.8, 1e3, 1e4, 1e8),
    "infinite height": (np.inf, 0.8, 1e3, 1e4, 1e8),
    "nan": (1e-6, np.nan, 1e3, 1e4, 1e8),
    "H too large": (1e-6, 1.2, 1e3, 1e4, 1e8),
    "H zero": (1e-6, 0.0, 1e3, 1e4, 1e8),
    "negative q0": (1e-6, 0.8, -1e3, 1e4, 1e8),
    "roll-off below q0": (1e-6, 0.8, 1e4, 1e3, 1e8),
    "roll-off above q1": (1e-6, 0.8, 1e3, 1e9, 1e8),
    "empty band": (1e-6, 0.8, 1e3, 1e3, 1e3),
    "reversed band": (1e-6, 0.8, 1e4, 1e3, 1e2),
}


@pytest.mark.parametrize("case", BAD.values(), ids=BAD.keys())
def test_impossible_parameters_give_nan_and_a_message(case):
    spectrum = surface_from(case)
    assert np.isnan(rms_slope(spectrum))
    assert np.all(np.isnan(spectrum.power([2e3, 2e4])))
    with pytest.raises(InputError, match="must"):
        validate_spectrum(spectrum)


def test_one_bad_member_leaves_the_others_alone():
    batch = surface_from(([1e-6, -1e-6, 2e-6], 0.8, 1e3, 1e4, 1e8))
    slopes = rms_slope(batch)
    assert np.isnan(slopes[1]) and slopes[2] == pytest.approx(2 * slopes[0], rel=1e-14)
    with pytest.raises(InputError, match="rms_height is -1e-06 m"):
        validate_spectrum(batch)


def test_shapes():
    batch = surface_from((np.full((3, 1), 1e-6), np.full((1, 2), 0.8), 1e3, 1e4, 1e8))
    assert batch.power(np.geomspace(1e3, 1e8, 5)).shape == (3, 2, 5)
    assert batch.power(1e5).shape == (3, 2)
    assert rms_slope(batch).shape == (3, 2)


@given(
    st.floats(1e-8, 1e-3), st.floats(0.01, 1.0), st.floats(1e1, 1e5), st.floats(1.0, 1e3), st.floats(1.5, 1e6)
)
def test_more_bandwidth_means_more_slope(height, hurst, q0, plateau, width):
    q_r = q0 * plateau
    narrow = surface_from((height, hurst, q0, q_r, q_r * width))
    validate_spectrum(narrow)
    wide = surface_from((height, hurst, q0, q_r, q_r * width * 2))
    assert 0 < rms_slope(narrow) < rms_slope(wide)
