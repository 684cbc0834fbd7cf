"""Viscosity laws, and flow factors against perturbation theory, exact media and quadrature."""

import numpy as np
import pytest
from scipy.integrate import quad

from skinbayes.contact import LayeredSkin, gap_distribution
from skinbayes.errors import InputError
from skinbayes.lubrication import (
    FlowCurve,
    PatirCheng,
    ShearThinning,
    TrivialFlowFactors,
    gap_flow_factors,
    tabulated_flow_factors,
    thinned_viscosity,
)
from skinbayes.roughness import named_surface

WET, SURFACE = (
    LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6),
    named_surface("paper_reference"),
)


def test_thinning_sets_in_where_the_paper_says():
    # half of η0 at (B/η0)^(1/n): 1e5 1/s for 1 Pa s
    assert thinned_viscosity(1.0, 1e5) == pytest.approx(0.5, rel=1e-12)
    assert thinned_viscosity(100.0, 100 ** (1 / 0.8)) == pytest.approx(50.0, rel=1e-12)
    rate = np.geomspace(1, 1e7, 50)
    stress = thinned_viscosity(10.0, rate) * rate
    assert np.all(np.diff(stress) > 0)
    assert thinned_viscosity(np.ones((3, 1)), rate).shape == (3, 50)
    assert np.isnan(thinned_viscosity([-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], scale=[1.0, 1.0, 0.0])).all()


@pytest.mark.parametrize("liquid", [ShearThinning(30.0), FlowCurve([1, 10, 1e3, 1e4], [3.0, 2.9, 1.0, 0.4])])
def test_slopes_for_the_solver_are_derivatives(liquid):
    rate = np.array([2.0, 30.0, 900.0, 7e3])
    value, slope = liquid.relative(rate)
    step = 1e-6
    up, down = liquid.relative(rate * np.exp(step))[0], liquid.relative(rate * np.exp(-step))[0]
    np.testing.assert_allclose(slope, np.log(up / down) / (2 * step), rtol=1e-6)
    assert value == pytest.approx(np.asarray(value))
    assert np.all(slope <= 0)


def test_measured_curve_is_kept_between_its_points_and_ends_with_them():
    rate, eta = np.array([0.1, 1.0, 10.0, 1e3]), np.array([5.0, 5.0, 2.0, 0.1])
    curve = FlowCurve(rate, eta)
    np.testing.assert_allclose(curve.viscosity(rate), eta, rtol=1e-14)
    fine = np.geomspace(0.1, 1e3, 400)
    assert np.all(np.diff(curve.viscosity(fine)) <= 1e-15)  # falls where the points fall, flat where they are
    assert curve.viscosity(0.5) == pytest.approx(5.0, rel=1e-14)
    assert np.isnan(curve.viscosity([0.0999, 1001.0, np.nan, -1.0])).all()
    assert curve.measured_at([0.0999, 0.1, 1e3, 1001.0]).tolist() == [False, True, True, False]
    assert curve.shear_rate_range == (0.1, 1e3)
    assert curve.low_shear_viscosity == 5.0
    # a power law is a straight line in logarithms
    power = FlowCurve(fine, 3 * fine**-0.4)
    assert power.viscosity(7.7) == pytest.approx(3 * 7.7**-0.4, rel=1e-9)


@pytest.mark.parametrize(
    ("rate", "eta", "message"),
    [
        ([1.0], [2.0], "at least two rows"),
        ([1.0, 2.0], [2.0, -1.0], "viscosity in row 2 of a flow curve is -1 Pa s"),
        ([0.0, 2.0], [2.0, 1.0], "shear_rate in row 1 of a flow curve is 0 1/s"),
        ([1.0, 3.0, 2.0], [1.0, 1.0, 1.0], "row 3 of a flow curve is 2 1/s, but must be larger than the 3"),
        ([1.0, 2.0], [1.0, 1.0, 1.0], "two columns of equal length"),
    ],
)
def test_bad_flow_curves_are_refused(rate, eta, message):
    with pytest.raises(InputError, match=message):
        FlowCurve(rate, eta)


def test_shear_factor_of_patir_and_cheng_is_the_mean_inverse_gap():
    # heights of density (35/96)(1 − δ²/9)³ about the mean gap H, gaps below 1/100 left out
    for ratio in (0.5, 1.5, 2.9, 3.2, 6.0, 25.0):
        density = quad(
            lambda d, h=ratio: 35 / 96 * (1 - d * d / 9) ** 3 / (h + d),
            max(-3.0, -ratio + 0.01),
            3.0,
            limit=400,
        )[0]
        other = 11.1 * min(ratio, 7) ** 2.31 * np.exp(-2.38 * ratio + 0.11 * ratio**2) if ratio <= 7 else 0.0
        found = PatirCheng(1e-6).friction(np.array([ratio * 1e-6])).shear[0]
        assert found == pytest.approx(ratio * density + other, rel=5e-3)


def test_patir_cheng_is_continuous_and_smooth_far_away():
    factors = PatirCheng(1e-6)
    edge = np.array([4.999999e-6, 5.000001e-6])
    shear = factors.flow(edge)[2]
    assert shear[1] / shear[0] == pytest.approx(1.0, abs=2e-3)
    height = np.array([0.3, 2.0, 4.0, 6.0, 9.0]) * 1e-6
    _, phi_slope, _, shear_slope = factors.flow(height)
    step = 1e-12
    up, down = factors.flow(height + step), factors.flow(height - step)
    np.testing.assert_allclose(phi_slope, (up[0] - down[0]) / (2 * step), rtol=1e-5)
    np.testing.assert_allclose(shear_slope, (up[2] - down[2]) / (2 * step), rtol=1e-4, atol=1e-6)
    far = np.array([1e-3])
    assert factors.flow(far)[0] == pytest.approx(1.0, abs=1e-12)
    assert np.array(factors.friction(far)) == pytest.approx(1.0, abs=1e-5)
    assert np.array(TrivialFlowFactors().friction(far)).tolist() == [[1.0], [1.0]]


def test_weak_roughness_is_perturbation_theory():
    # ε² = ⟨δ²⟩/ū², isotropic: 1 − 3/2 ε², 3/2 ε² ū, 1 + ε² + 3/2 ε², 1 − 3/2 ε²
    nodes, weights = np.polynomial.hermite_e.hermegauss(21)
    weights = weights / weights.sum()
    spread = 0.01
    factors = gap_flow_factors(2e-6 * (1 + spread * nodes), weights)
    square = spread**2
    assert 1 - factors.pressure_flow == pytest.approx(1.5 * square, rel=2e-3)
    assert factors.shear_flow == pytest.approx(2e-6 * 1.5 * square, rel=2e-3)
    assert factors.shear_stress - 1 == pytest.approx(2.5 * square, rel=2e-3)
    assert 1 - factors.pressure_stress == pytest.approx(1.5 * square, rel=2e-3)


def test_two_phases_conduct_like_the_geometric_mean():
    # exact for a symmetric two-phase medium in two dimensions (Keller, Dykhne): σ = √(σ1 σ2)
    for narrow, wide in ((1e-6, 2e-6), (1e-7, 5e-6)):
        factors = gap_flow_factors([narrow, wide], [0.5, 0.5])
        assert factors.pressure_flow * ((narrow + wide) / 2) ** 3 == pytest.approx(
            (narrow * wide) ** 1.5, rel=1e-9
        )


def test_contact_blocks_the_flow_from_half_of_the_area_on():
    assert gap_flow_factors([1e-6], [1.0])[:2] == pytest.approx((1.0, 0.0), abs=1e-12)
    # one gap with contact c: φ_p ū³ = (1 − 2c) u³
    for contact in (0.1, 0.3, 0.49):
        factors = gap_flow_factors([1e-6], [1 - contact])
        assert factors.pressure_flow * (1 - contact) ** 3 == pytest.approx(1 - 2 * contact, rel=1e-9)
    blocked = gap_flow_factors([1e-6], [0.5])
    assert blocked.pressure_flow == 0
    assert blocked.shear_flow == pytest.approx(0.5e-6)


def test_factors_of_skin():
    factors = tabulated_flow_factors(SURFACE, WET)
    height = np.array([14e-6, 65e-6, 1e-4, 2e-3])
    phi, _, shear, _ = factors.flow(height)
    assert phi[0] == pytest.approx(0.74, abs=0.03)  # where Patir–Cheng has 0.37 for the undeformed surface
    assert phi[-1] == pytest.approx(1.0, abs=1e-3)
    # nearly undeformed, two unrelated theories: the fits to computed flow between Gaussian surfaces
    fits = PatirCheng(22.4e-6)
    np.testing.assert_allclose(phi[1:3], fits.flow(height[1:3])[0], atol=0.05)
    np.testing.assert_allclose(shear[1:3] / height[1:3], fits.flow(height[1:3])[2] / height[1:3], atol=0.03)
    for ours, theirs in zip(factors.friction(height[1:3]), fits.friction(height[1:3]), strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=0.12)


def test_table_agrees_with_its_source_between_the_points():
    factors = tabulated_flow_factors(SURFACE, WET)
    gaps = gap_distribution(3.1e3, SURFACE, skin=WET)
    edges = np.geomspace(22.4e-8, 2e-3, 3000)
    fraction, volume = np.diff(gaps.cumulative(edges)), np.diff(gaps.film(edges))
    filled = fraction > 1e-14
    direct = gap_flow_factors(volume[filled] / fraction[filled], fraction[filled])
    mean = np.array([float(gaps.mean)])
    assert factors.flow(mean)[0][0] == pytest.approx(direct.pressure_flow, rel=0.02)
    assert factors.flow(mean)[2][0] == pytest.approx(direct.shear_flow, rel=0.05)
    assert factors.friction(mean).shear[0] == pytest.approx(direct.shear_stress, rel=0.05)
    step = 1e-10
    up, down = factors.flow(mean + step), factors.flow(mean - step)
    assert factors.flow(mean)[1][0] == pytest.approx((up[0][0] - down[0][0]) / (2 * step), rel=1e-4)
    assert factors.flow(mean)[3][0] == pytest.approx((up[2][0] - down[2][0]) / (2 * step), rel=1e-4)
