"""Two rough elastic solids against brute-force quadrature, one solid of twice the compliance, and a surface √2 as high."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from skinbayes.contact import (
    HomogeneousSolid,
    LayeredSkin,
    SolidPair,
    effective_modulus,
    twice_stress_variance,
)
from skinbayes.roughness import (
    SelfAffineSpectrum,
    SummedSpectrum,
    TabulatedSpectrum,
    named_surface,
    rms_height,
    rms_slope,
)

SKIN = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
RUBBER = HomogeneousSolid(young_modulus=2e6, poisson_ratio=0.4)
ROUGH = SelfAffineSpectrum(
    rms_height=3e-6, hurst_exponent=0.9, wavevector_min=5e3, wavevector_rolloff=2e4, wavevector_max=1e8
)
FOREARM = named_surface("paper_reference")


def test_squares_of_heights_and_slopes_add() -> None:
    both = SummedSpectrum(FOREARM, ROUGH)
    for moment in (rms_height, rms_slope):
        assert moment(both) == pytest.approx(np.hypot(moment(FOREARM), moment(ROUGH)), rel=1e-14)
    assert both.power(1e4) == FOREARM.power(1e4) + ROUGH.power(1e4)
    assert (both.wavevector_min, both.wavevector_max) == (1e3, 1e9)


@pytest.mark.parametrize("wavevector", [None, [3e3, 1e5, 1e8]])
@pytest.mark.parametrize("second", [ROUGH, TabulatedSpectrum([5e3, 2e4, 1e8], [1e-18, 9e-19, 1e-32])])
def test_stress_variances_of_both_spectra_add(wavevector: list[float] | None, second: object) -> None:
    both = twice_stress_variance(SummedSpectrum(FOREARM, second), SKIN, wavevector=wavevector)
    each = [twice_stress_variance(one, SKIN, wavevector=wavevector) for one in (FOREARM, second)]
    assert both == pytest.approx(each[0] + each[1], rel=1e-12)


def test_stress_variance_of_a_pair_is_the_integral() -> None:
    pair = SolidPair(SKIN, RUBBER)

    def modulus(q: float) -> float:
        parts = (float(effective_modulus(solid, q)) for solid in (SKIN, RUBBER))
        return 1 / sum(1 / part for part in parts)

    def integrand(t: float) -> float:
        q = np.exp(t)
        return float(q**4 * (FOREARM.power(q) + ROUGH.power(q)) * modulus(q) ** 2)

    cuts = np.log([1e3, 5e3, 6.345e3, 2e4, 1e5, 1e6, 1e8, 1e9])
    brute = np.pi * sum(quad(integrand, low, high, limit=200)[0] for low, high in pairwise(cuts))
    found = twice_stress_variance(SummedSpectrum(FOREARM, ROUGH), pair)
    # the quadrature between roll-off and where the layer ends is good to 1e-5 for skin
    assert found == pytest.approx(brute, rel=2e-5)
    assert effective_modulus(pair, 1e5) == pytest.approx(modulus(1e5), rel=1e-12)


def test_a_pair_of_equal_solids_is_one_of_half_the_modulus() -> None:
    pair, half = SolidPair(RUBBER, RUBBER), HomogeneousSolid(young_modulus=1e6, poisson_ratio=0.4)
    assert twice_stress_variance(FOREARM, pair) == pytest.approx(
        twice_stress_variance(FOREARM, half), rel=1e-12
    )
    assert pair.contact_modulus == pytest.approx(float(half.contact_modulus), rel=1e-14)
    q = np.geomspace(1e3, 1e8, 7)
    for found, expected in zip(pair.compliance_fall(q), half.compliance_fall(q), strict=True):
        assert found == pytest.approx(expected, rel=1e-12)


def test_compliance_fall_is_a_derivative() -> None:
    pair, step = SolidPair(SKIN, RUBBER), 1e-4
    q = np.geomspace(1e3, 1e7, 9)
    low, high = (pair.compliance_fall(q * np.exp(sign * step))[0] for sign in (-1, 1))
    assert pair.compliance_fall(q)[1] == pytest.approx((low - high) / (2 * step), rel=1e-6)
    assert pair.compliance_fall(q)[0] == pytest.approx(1 / (q * effective_modulus(pair, q)), rel=1e-10)


def test_a_stiff_counterface_is_rigid() -> None:
    stiff = SolidPair(SKIN, HomogeneousSolid(young_modulus=1e20))
    assert twice_stress_variance(FOREARM, stiff) == pytest.approx(
        twice_stress_variance(FOREARM, SKIN), rel=1e-10
    )


def test_a_batch_and_its_rows_agree_to_the_last_bit() -> None:
    heights, pair = np.array([1e-6, 2e-6, 5e-6]), SolidPair(SKIN, RUBBER)
    batch = twice_stress_variance(SummedSpectrum(FOREARM, replace(ROUGH, rms_height=heights)), pair)
    for one, height in zip(batch, heights, strict=True):
        alone = SummedSpectrum(FOREARM, replace(ROUGH, rms_height=height))
        assert one == twice_stress_variance(alone, pair)
