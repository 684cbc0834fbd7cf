"""Asperity laws, flow factors, liquids and friction at the ends of their domains."""

import numpy as np
import pytest

from skinbayes.contact import (
    LayeredSkin,
)
from skinbayes.errors import InputError
from skinbayes.friction import friction_coefficient
from skinbayes.lubrication import (
    FlowCurve,
    PatirCheng,
    ShearThinning,
    TrivialFlowFactors,
    asperity_law,
    gap_flow_factors,
    law_of_table,
    liquid_rows,
    tabulated_flow_factors,
    thinned_viscosity,
)
from skinbayes.roughness import named_surface

SURFACE, SKIN = (
    named_surface("paper_reference"),
    LayeredSkin(
        young_modulus_layer=7e6,
        young_modulus_bulk=20e3,
        poisson_ratio_layer=0.5,
        poisson_ratio_bulk=0.5,
        layer_thickness=20e-6,
    ),
)
LIQUID = FlowCurve([1.0, 10.0, 100.0], [2.0, 1.0, 0.5])


def test_asperity_law_at_its_ends():
    law = asperity_law(SURFACE, SKIN)
    pressure, slope = law(np.array([np.inf, 1e300, 1e-3, np.nan]))
    assert pressure[:2].tolist() == slope[:2].tolist() == [0.0, 0.0]
    assert pressure[2] == pytest.approx(law(np.array([1e-3 - law.decay_length]))[0][0] / np.e, rel=1e-9)
    assert np.isnan(pressure[3])
    assert law.separation_at(0.0) == np.inf and law.separation_at(np.inf) == 0.0
    assert np.isnan(law.separation_at(-1.0)) and np.isnan(law.separation_at(np.nan))
    assert law(np.array([law.separation_at(1e-300)]))[0][0] == pytest.approx(1e-300, rel=1e-9)
    two = law_of_table(np.array([1e-6, 2e-6]), np.array([5.0, 3.0]))
    np.testing.assert_allclose(
        np.log(two(np.array([0.0, 1e-6, 2e-6, 3e-6]))[0]), [7.0, 5.0, 3.0, 1.0], rtol=1e-12
    )
    for place, level in (
        ([1e-6], [5.0]),
        ([1, 2], [3, 5]),
        ([1, 1], [5, 3]),
        ([1, 2, np.nan], [5, 3, 2]),
        ([], []),
    ):
        with pytest.raises(InputError, match="at least two finite points"):
            law_of_table(np.array(place), np.array(level))
    with pytest.raises(InputError, match="asperity law"):
        asperity_law(
            SURFACE,
            LayeredSkin(
                young_modulus_layer=-1.0,
                young_modulus_bulk=20e3,
                poisson_ratio_layer=0.5,
                poisson_ratio_bulk=0.5,
                layer_thickness=20e-6,
            ),
        )


def test_flow_factors_at_their_ends():
    far = np.array([np.inf, 1e300, 1e3])
    for factors in (PatirCheng(22.4e-6), TrivialFlowFactors()):
        pressure, slope, shear, shear_slope = factors.flow(far)
        np.testing.assert_allclose(pressure, 1.0, rtol=1e-12)
        np.testing.assert_array_equal([*slope, *shear, *shear_slope], 0.0)
        np.testing.assert_allclose(factors.friction(far), 1.0, rtol=1e-12)
    found = tabulated_flow_factors(SURFACE, SKIN)
    assert np.isfinite(found.flow(np.array([0.0, 1e-300]))).all() and found.flow(np.zeros(1))[2] == 0.0
    last = found.separation[-1]
    np.testing.assert_allclose(found.flow(np.array([1e300]))[0], found.flow(np.array([last]))[0], rtol=1e-12)
    assert np.isfinite(found.flow(np.array([np.inf]))[3]).all()
    for height in (0.0, -1e-6, np.inf, np.nan):
        with pytest.raises(InputError, match="rms_height is"):
            PatirCheng(height)
    for changes in ({"smallest_gap": 0.0}, {"smallest_gap": 1.0}, {"area_correction": 0.0}):
        with pytest.raises(InputError, match="Flow factors need"):
            tabulated_flow_factors(SURFACE, SKIN, **changes)


def test_factors_of_gaps_at_their_ends():
    # one gap everywhere is no roughness; gaps without a fraction do not count
    for gap, fraction in (([1e-6], [1.0]), ([1e-9, 1e-6], [0.0, 1.0])):
        np.testing.assert_allclose(gap_flow_factors(gap, fraction), [1.0, 0.0, 1.0, 1.0], atol=1e-12)
    closed = gap_flow_factors([1e-6, 2e-6], [0.25, 0.25])
    assert closed.pressure_flow == closed.pressure_stress == 0.0 and closed.shear_flow == 0.75e-6
    np.testing.assert_allclose(
        gap_flow_factors([1e-6, 2e-6], [0.25, 0.25 + 1e-9]), closed, rtol=1e-6, atol=1e-8
    )
    assert gap_flow_factors([1e-6], [0.0]) == gap_flow_factors([], []) == (0.0, 0.0, 0.0, 0.0)
    for gap, fraction in (
        ([0.0, 1e-6], [0.5, 0.5]),
        ([-1e-6, 1e-6], [0.5, 0.5]),
        ([1e-6, 2e-6], [-0.1, 1.0]),
        ([1e-6, 2e-6], [0.6, 0.5]),
        ([np.nan, 2e-6], [0.5, 0.5]),
        ([1e-6, 2e-6], [np.nan, 0.5]),
        ([np.inf, 2e-6], [0.5, 0.5]),
    ):
        assert np.isnan(gap_flow_factors(gap, fraction)).all()


def test_rheology_at_its_ends():
    assert thinned_viscosity(3.0, 0.0) == 3.0 and thinned_viscosity(3.0, np.inf) == 0.0
    assert thinned_viscosity(3.0, 1e4, scale=np.inf) == 3.0
    # where thinning leaves next to nothing of η0 the viscosity is B γ̇^-n, whatever η0
    np.testing.assert_allclose(thinned_viscosity([1e300, np.inf], 1e10), 1e4 * 1e10**-0.8, rtol=1e-12)
    assert np.isnan(thinned_viscosity([0.0, -1.0, 1.0, 1.0], [1.0, 1.0, -1.0, np.nan])).all()
    assert np.isnan(thinned_viscosity(1.0, 1.0, scale=[0.0, 1.0], exponent=[1.0, -1.0])).all()
    fraction, power = ShearThinning(1.0).relative(np.array([0.0, 1e300, np.inf]))
    np.testing.assert_allclose(fraction, [1.0, 1e4 * 1e300**-0.8, 0.0], rtol=1e-12)
    np.testing.assert_allclose(power, [0.0, -0.8, -0.8], atol=1e-12)
    np.testing.assert_array_equal(
        ShearThinning(1.0, scale=np.inf).relative(np.array([0.0, 1e9])), [[1, 1], [0, 0]]
    )
    for viscosity, others in (
        (0.0, {}), (-1.0, {}), (np.inf, {}), (np.nan, {}), (1.0, {"scale": 0.0}), (1.0, {"scale": np.nan}),
        (1.0, {"exponent": -0.1}), (1.0, {"exponent": np.inf}),
    ):  # fmt: skip
        with pytest.raises(InputError, match="of a shear-thinning liquid is"):
            ShearThinning(viscosity, **others)
    np.testing.assert_array_equal(LIQUID.viscosity([1.0, 100.0]), [2.0, 0.5])
    assert np.isnan(LIQUID.viscosity([0.0, 1 - 1e-12, 100 + 1e-9, np.inf, np.nan])).all()
    relative, power = LIQUID.relative(np.array([0.0, 1.0, 100.0, np.inf]))
    np.testing.assert_allclose(relative, [1.0, 1.0, 0.25, 0.25], rtol=1e-12)
    np.testing.assert_array_equal(power, 0.0)
    rows = liquid_rows([LIQUID] * 3)
    value, slope = rows.log_viscosity(np.array([-np.inf, np.inf, np.nan]))
    np.testing.assert_allclose(np.exp(value[:2]), [2.0, 0.5], rtol=1e-12)
    assert slope[:2].tolist() == [0.0, 0.0] and np.isnan(value[2])


def test_friction_at_its_ends():
    stress, area, pressure = [0.0, 1e6, 1e6, np.inf], [1e-3, 0.0, 1.0, 0.1], [1.0, 1.0, np.inf, 1.0]
    np.testing.assert_array_equal(
        friction_coefficient(stress, area, nominal_pressure=pressure), [0.0, 0.0, 0.0, np.inf]
    )
    assert np.isnan(
        friction_coefficient(
            [-1.0, 1.0, 1.0, 1.0, 0.0],
            [0.1, -0.1, 0.1, 0.1, 0.0],
            nominal_pressure=[1.0, 1.0, -1.0, 0.0, 0.0],
        )
    ).all()
    assert friction_coefficient(np.empty(0), 1.0, nominal_pressure=1.0).shape == (0,)
