"""The Stribeck curve of skin (Figs. 11, 13, 20 and 21 of the paper), its sensitivities, batches and validity."""

import numpy as np
import pytest
from line_curves import stribeck_curve
from named_fields import surface_from
from scipy.interpolate import CubicSpline

from skinbayes.contact import LayeredSkin, reduced_modulus, relative_contact_area, twice_stress_variance
from skinbayes.contact.line_contact import cylinder_of_sphere, line_contact
from skinbayes.lubrication import (
    FlowCurve,
    PatirCheng,
    ShearThinning,
    lubricated_films,
    tabulated_flow_factors,
)
from skinbayes.roughness import SelfAffineSpectrum, named_surface

# σ_f A/A0 such that A/A0 = 6.59e-4 of the paper's Sect. 4 holds at 6.83 kPa, where skinbayes has 6.48133e-4
PAPER = {
    "h": 22.4e-6,
    "bulk": 2e4,
    "layer": 7e6,
    "radius": 8e-3,
    "force": 0.2,
    "stress": 15e6 * 6.59 / 6.48133,
}
SPEEDS = np.geomspace(1e-5, 0.5, 61)


def curve(speeds=SPEEDS, nodes=100, flow_factors=None, rheology=None, **changes):
    case = PAPER | changes
    return stribeck_curve(
        speeds,
        sphere_radius=case["radius"],
        normal_force=case["force"],
        skin=LayeredSkin(
            young_modulus_layer=case["layer"], young_modulus_bulk=case["bulk"], layer_thickness=20e-6
        ),
        spectrum=surface_from((case["h"], 0.78, 1e3, 6.345e3, 1e9)),
        frictional_shear_stress=case["stress"],
        flow_factors=flow_factors,
        rheology=rheology,
        nodes=nodes,
    )


def features(found, plateau=None):
    """ηv at half of the plateau, ηv and μ of the minimum."""
    log_speed, friction = np.log(SPEEDS), found.friction_coefficient
    fine = np.linspace(log_speed[0], log_speed[-1], 20001)
    smooth = CubicSpline(log_speed, np.log(friction))(fine)
    half = fine[np.argmax(smooth < np.log((friction[0] if plateau is None else plateau) / 2))]
    return np.exp([half, fine[np.argmin(smooth)], smooth.min()])


@pytest.fixture(scope="module")
def paper():
    return curve()


def test_figure_13(paper):
    assert curve([1e-7]).friction_coefficient == pytest.approx([1.447], abs=2e-3)
    half, speed, lowest = features(paper, 1.447)
    assert half == pytest.approx(1.60e-3, rel=0.02)
    assert speed == pytest.approx(0.0229, rel=0.04)
    assert lowest == pytest.approx(0.108, abs=0.001)
    # without the pressure flow
    assert (paper.boundary + paper.couette).min() == pytest.approx(0.086, abs=0.001)
    assert paper.strain == pytest.approx(0.48, abs=0.005)
    assert paper.strained.all()
    assert paper.valid.all()


def test_parts_add_up_and_the_boundary_part_falls(paper):
    total = paper.boundary + paper.couette + paper.pressure_flow
    np.testing.assert_allclose(paper.friction_coefficient, total, rtol=1e-14)
    assert np.all(np.diff(paper.boundary) < 0)
    assert np.all(np.diff(paper.couette) > 0)
    # real contact is proportional to the load that asperities carry
    ratio = paper.boundary / paper.asperity_load_fraction
    np.testing.assert_allclose(ratio, ratio[0], rtol=2e-3)


def test_slow_limit_is_dry_friction_at_the_nominal_pressure():
    spectrum, skin = (
        SelfAffineSpectrum(
            rms_height=22.4e-6,
            hurst_exponent=0.78,
            wavevector_min=1e3,
            wavevector_rolloff=6.345e3,
            wavevector_max=1e9,
        ),
        LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=2e4, layer_thickness=2e-5),
    )
    area = relative_contact_area(5000.0, twice_stress_variance(spectrum, skin))
    assert curve([1e-11]).friction_coefficient[0] == pytest.approx(PAPER["stress"] * area / 5000, rel=2e-3)
    assert curve([1e-11]).asperity_load_fraction[0] == pytest.approx(1.0, abs=1e-6)


def test_boundary_part_saturates_where_contact_is_nearly_complete():
    # soft skin without a stiff layer: A/A0 is far from proportional to the pressure, which is nearly that of Hertz
    skin, flat = (
        LayeredSkin(young_modulus_layer=2e4, young_modulus_bulk=2e4, layer_thickness=20e-6),
        SelfAffineSpectrum(
            rms_height=2e-6,
            hurst_exponent=0.8,
            wavevector_min=1e4,
            wavevector_rolloff=1e4,
            wavevector_max=1e9,
        ),
    )
    found = stribeck_curve(
        [1e-18],
        sphere_radius=8e-3,
        normal_force=0.2,
        skin=skin,
        spectrum=flat,
        frictional_shear_stress=1e3,
        nodes=200,
    )
    modulus = reduced_modulus(2e4, 0.5)
    cylinder = cylinder_of_sphere(0.2, 8e-3, reduced_modulus=modulus)
    line = line_contact(cylinder.load_per_length, cylinder.cylinder_radius, reduced_modulus=modulus)
    place = (np.arange(2000) + 0.5) / 2000
    twice_variance = twice_stress_variance(flat, skin)
    area = relative_contact_area(
        line.maximum_pressure * np.sqrt(1 - place**2), twice_stress_variance=twice_variance
    )
    expected = 1e3 * 2 * line.half_width * area.mean() / cylinder.load_per_length
    assert area.max() > 0.5
    assert found.boundary[0] == pytest.approx(expected, rel=0.02)


def test_figure_11_slope():
    # R = 1 cm, 1.3 N, E* = 1.6 MPa, hydrodynamic branch; the paper has about 0.47. A slope carries its window
    cylinder = cylinder_of_sphere(1.3, 1e-2, reduced_modulus=1.6e6)
    speeds = np.geomspace(1e-3, 0.1, 9)
    films = lubricated_films(
        speeds,
        cylinder_radius=float(cylinder.cylinder_radius),
        load_per_length=float(cylinder.load_per_length),
        reduced_modulus=1.6e6,
        nodes=160,
    )
    friction = films.couette + films.pressure_flow
    slope = np.diff(np.log(friction)) / np.diff(np.log(speeds))
    assert np.log(friction[-1] / friction[0]) / np.log(100) == pytest.approx(0.472, abs=0.003)
    assert np.all(np.diff(slope) > 0)
    assert slope[[0, -1]] == pytest.approx([0.438, 0.513], abs=0.005)
    assert np.log(films.couette[-1] / films.couette[0]) / np.log(100) == pytest.approx(0.423, abs=0.003)


def test_sensitivities(paper):
    step = 1.05

    def exponents(name, **more):
        up = features(curve(**{name: PAPER[name] * step} | more))
        down = features(curve(**{name: PAPER[name] / step} | {k: PAPER[k] ** 2 / v for k, v in more.items()}))
        return np.log(up / down) / (2 * np.log(step))

    # a rougher surface has less real contact, A ∝ 1/h: with σ_f ∝ h the plateau stays
    assert exponents("h", stress=PAPER["stress"] * step) == pytest.approx([2.6, 1.65, 0.83], abs=0.06)
    assert exponents("bulk") == pytest.approx([0.55, 0.57, 0.13], abs=0.03)
    assert exponents("layer")[0] == pytest.approx(0.61, abs=0.03)
    assert exponents("radius")[0] == pytest.approx(-0.55, abs=0.03)
    # the rising branch knows neither roughness nor shear stress
    rising = SPEEDS > 0.15
    for change in ({"h": 20e-6}, {"stress": 5e6}):
        np.testing.assert_allclose(
            curve(**change).friction_coefficient[rising], paper.friction_coefficient[rising], rtol=3e-3
        )


def test_figure_20_flow_factors(paper):
    factors = tabulated_flow_factors(
        SelfAffineSpectrum(
            rms_height=22.4e-6,
            hurst_exponent=0.78,
            wavevector_min=1e3,
            wavevector_rolloff=6.345e3,
            wavevector_max=1e9,
        ),
        LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=2e4, layer_thickness=20e-6),
    )

    class FlowOnly:
        def flow(self, separation):
            return factors.flow(separation)

        def friction(self, separation):
            return type(factors.friction(separation))(np.ones_like(separation), np.ones_like(separation))

    plain, flow = features(paper), features(curve(flow_factors=FlowOnly()))
    rising = SPEEDS > 0.1
    # the flow alone: nothing on the rising branch, a percent on the minimum, nearly a factor of two in speed between
    only = curve(flow_factors=FlowOnly()).friction_coefficient / paper.friction_coefficient
    assert np.abs(only[rising] - 1).max() < 5e-3
    assert flow[0] / plain[0] == pytest.approx(0.56, abs=0.02)
    assert flow[2] / plain[2] == pytest.approx(1.012, abs=0.01)
    # with the friction factors too the minimum rises by a quarter, whichever factors are taken
    for full in (factors, PatirCheng(22.4e-6)):
        found = curve(flow_factors=full)
        assert np.abs(found.friction_coefficient / paper.friction_coefficient - 1)[rising].max() < 0.02
        assert 1.15 < features(found)[2] / plain[2] < 1.35


@pytest.mark.parametrize(("viscosity", "largest"), [(0.01, 0.004), (1.0, 0.009), (100.0, 0.021)])
def test_figure_21_shear_thinning(paper, viscosity, largest):
    found = curve(rheology=ShearThinning(viscosity))
    change = np.abs(found.friction_coefficient / paper.friction_coefficient - 1)
    assert 1e-4 < change.max() < largest
    assert not found.shear_rate_unmeasured.any()


def test_flow_curve_is_the_law_it_was_measured_on():
    law = ShearThinning(50.0)
    rate = np.geomspace(1e-3, 1e7, 200)
    curve_of_points = FlowCurve(rate, 50.0 * law.relative(rate)[0])
    speeds = SPEEDS[::6]
    np.testing.assert_allclose(
        curve(speeds, rheology=curve_of_points).friction_coefficient,
        curve(speeds, rheology=law).friction_coefficient,
        rtol=2e-3,
    )
    # thinner where it is sheared: a Newtonian liquid of that viscosity is a bound
    narrow = FlowCurve([1.0, 10.0], [50.0, 50.0])
    flagged = curve(speeds, rheology=narrow)
    shear = speeds / 50.0 / np.array([flagged.minimum_film, flagged.central_film])
    expected = (shear[0] > 10.0) | (shear[1] < 1.0)
    assert flagged.shear_rate_unmeasured.tolist() == expected.tolist()
    assert 0 < expected.sum() < expected.size
    assert any("viscosity was not measured" in reason for reason in flagged.reasons())
    np.testing.assert_allclose(flagged.friction_coefficient, curve(speeds).friction_coefficient, rtol=1e-6)


def test_shift_factor_shifts():
    shifted = stribeck_curve(
        [1e-3, 1e-2],
        sphere_radius=8e-3,
        normal_force=0.2,
        skin=LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=2e4, layer_thickness=20e-6),
        spectrum=named_surface("paper_reference"),
        frictional_shear_stress=15e6,
        velocity_shift_factor=20.0,
    )
    plain = curve([2e-2, 0.2], stress=15e6, nodes=80)
    np.testing.assert_allclose(shifted.friction_coefficient, plain.friction_coefficient, rtol=2e-3)
    assert shifted.speed_viscosity_product.tolist() == [1e-3, 1e-2]


def test_similarity_of_ball_sizes():
    # at fixed moduli (h, F, R) and (h s, F s, R/s) have the same b and the same film in other units: Rc ∝ 1/s, p_H and u ∝ s,
    # and λ = 6ηv Rc²/(b³ p_H) is the same for ηv ∝ s³
    scale = 1.3
    speeds = np.geomspace(1e-4, 0.1, 7)
    first = curve(speeds)
    second = curve(
        speeds * scale**3,
        h=PAPER["h"] * scale,
        force=PAPER["force"] * scale,
        radius=PAPER["radius"] / scale,
    )
    np.testing.assert_allclose(second.minimum_film, first.minimum_film * scale, rtol=1e-6)
    np.testing.assert_allclose(
        second.asperity_load_fraction, first.asperity_load_fraction, rtol=1e-5, atol=1e-9
    )
    np.testing.assert_allclose(second.couette, first.couette * scale, rtol=1e-6)
    np.testing.assert_allclose(second.boundary, first.boundary / scale, rtol=1e-3)


def test_batches_are_rows():
    skin = LayeredSkin(young_modulus_layer=[7e6, 2e7], young_modulus_bulk=[2e4, 4e4], layer_thickness=20e-6)
    surface = surface_from(([22.4e-6, 10e-6], 0.78, 1e3, 6.345e3, 1e9))
    force = np.array([[0.1], [0.2], [0.4]])
    speeds = np.array([1e-4, 1e-2])
    found = stribeck_curve(
        speeds,
        sphere_radius=8e-3,
        normal_force=force,
        skin=skin,
        spectrum=surface,
        frictional_shear_stress=[15e6, 5e6],
        area_correction=[0.42, 1.0],
    )
    assert found.friction_coefficient.shape == (3, 2, 2)
    assert found.strain.shape == (3, 2)
    one = stribeck_curve(
        speeds,
        sphere_radius=8e-3,
        normal_force=0.4,
        skin=LayeredSkin(young_modulus_layer=2e7, young_modulus_bulk=4e4, layer_thickness=20e-6),
        spectrum=SelfAffineSpectrum(
            rms_height=10e-6,
            hurst_exponent=0.78,
            wavevector_min=1e3,
            wavevector_rolloff=6.345e3,
            wavevector_max=1e9,
        ),
        frictional_shear_stress=5e6,
        area_correction=1.0,
    )
    np.testing.assert_allclose(found.friction_coefficient[2, 1], one.friction_coefficient, rtol=1e-12)
    single = stribeck_curve(
        1e-2,
        sphere_radius=8e-3,
        normal_force=0.4,
        skin=LayeredSkin(young_modulus_layer=2e7, young_modulus_bulk=4e4, layer_thickness=20e-6),
        spectrum=SelfAffineSpectrum(
            rms_height=10e-6,
            hurst_exponent=0.78,
            wavevector_min=1e3,
            wavevector_rolloff=6.345e3,
            wavevector_max=1e9,
        ),
        frictional_shear_stress=5e6,
        area_correction=1.0,
    )
    assert single.friction_coefficient.shape == ()
    assert single.friction_coefficient == pytest.approx(one.friction_coefficient[1], rel=3e-3)


def test_outside_its_validity_the_theory_is_silent():
    found = curve([1e-3, 1.0, 1.3, 10.0])
    assert np.isfinite(found.friction_coefficient).tolist() == [True, True, False, False]
    assert found.film_beyond_ball.tolist() == [False, False, True, True]
    assert "2 of 4 points: the film is thicker than the inlet of the ball" in found.reasons()[0]
    large = curve([1e-3], force=3.0)
    assert 0.8 < large.strain < 1.3
    assert large.largely_strained.all() and large.valid.all()
    assert any("half as wide as the ball" in reason for reason in large.reasons())
    wide = curve([1e-3], force=6.0)
    assert wide.strain > 1.3
    assert wide.too_strained.all()
    assert np.isnan(wide.friction_coefficient).all()
    assert np.isnan(wide.minimum_film).all()
    assert not wide.valid.any()


@pytest.mark.parametrize(
    "change",
    [
        {"radius": -8e-3},
        {"force": 0.0},
        {"bulk": -1.0},
        {"h": 0.0},
        {"stress": -1.0},
        {"force": np.nan},
        {"layer": np.nan},
    ],
)
def test_impossible_inputs_are_said(change):
    found = curve([1e-3], **change)
    assert found.impossible.all()
    assert np.isnan(found.friction_coefficient).all()
    assert not found.not_converged.any()
    assert found.reasons()[0] == "1 of 1 points: an input is not physical."


def test_impossible_speeds_are_said():
    found = curve([-1.0, 0.0, np.nan, 1e-3])
    assert found.impossible.tolist() == [True, False, True, False]
    assert np.isfinite(found.friction_coefficient).tolist() == [False, True, False, True]
