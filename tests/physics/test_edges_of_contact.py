"""Contact mechanics at the ends of closed intervals: values there are the limits of those beside, in wide boxes of parameters.

An end is compared with a vector a little inside, with closed forms, and with the inverse function; nothing here is a number that
the code printed.
"""

from dataclasses import fields

import numpy as np
import pytest
from named_fields import skin_from, surface_from

from skinbayes.contact import (
    LayeredSkin,
    cylinder_of_ellipse,
    cylinder_of_sphere,
    effective_modulus,
    elastoplastic_contact_area,
    ellipse_factors,
    elliptic_contact,
    gap_distribution,
    line_contact,
    mean_separation,
    persson_contact_area,
    pressure_at_separation,
    reduced_modulus,
    relative_contact_area,
    sphere_contact,
    surface_response,
    total_contact_area,
    twice_stress_variance,
)
from skinbayes.roughness import named_surface, rms_height, rms_slope, total_area_ratio

INSIDE = 1e-12  # relative distance from an end
SURFACES = ("free", "no plateau", "plateau only", "H = 1", "narrow")
SKINS = ("free", "alike", "soft layer", "incompressible", "no sideways strain", "thin", "thick")
FAST, WIDE = 60, 1000


def between(rng, low, high, count):
    return np.exp(rng.uniform(np.log(low), np.log(high), count))


def surfaces(kind, count, off=0.0):
    """Self-affine spectra at an end of their domain, or ``off`` from it."""
    rng = np.random.default_rng(11)
    height, hurst = between(rng, 1e-8, 1e-3, count), rng.uniform(0.01, 1.0, count)
    first = between(rng, 1e1, 1e5, count)
    last = first * between(rng, 1.7, 1e8, count)
    knee = between(rng, first, last, count)
    if kind == "no plateau":
        knee = first * (1 + off)
    elif kind == "plateau only":
        knee = last * (1 - off)
    elif kind == "H = 1":
        hurst = np.full(count, 1.0 - off)
    elif kind == "narrow":
        last = first * (1 + 1e-6)
        knee = first
    return surface_from((height, hurst, first, knee, last))


def skins(kind, count, off=0.0):
    rng = np.random.default_rng(12)
    bulk = between(rng, 1e3, 1e8, count)
    layer = bulk * between(rng, 1.0, 1e5, count)
    thickness = between(rng, 1e-7, 1e-2, count)
    upper, lower = (rng.uniform(-0.9, 0.5, count) for _ in range(2))
    if kind == "alike":
        layer, upper = bulk * (1 + off), lower
    elif kind == "soft layer":
        layer = bulk * 1e-3
    elif kind == "incompressible":
        upper = lower = np.full(count, 0.5 - off)
    elif kind == "no sideways strain":
        upper = lower = np.full(count, off)
    elif kind == "thin":
        thickness = np.full(count, 1e-15)
    elif kind == "thick":
        thickness = np.full(count, 1e3)
    return skin_from((layer, bulk, upper, lower, thickness))


def loads(twice_variance):
    rng = np.random.default_rng(13)
    return between(rng, 1e-6, 5.0, twice_variance.size) * np.sqrt(twice_variance)


def check_all_edges(surface_kind, skin_kind, count):
    surface, inner_surface = (surfaces(surface_kind, count, off) for off in (0.0, INSIDE))
    skin, inner_skin = (skins(skin_kind, count, off) for off in (0.0, INSIDE))
    np.testing.assert_allclose(rms_height(surface), surface.rms_height, rtol=1e-9)
    np.testing.assert_allclose(rms_slope(surface), rms_slope(inner_surface), rtol=1e-6)
    twice_variance = twice_stress_variance(surface, skin)
    assert (twice_variance > 0).all()
    np.testing.assert_allclose(twice_variance, twice_stress_variance(inner_surface, inner_skin), rtol=1e-6)
    if skin_kind == "alike" and surface_kind != "free":
        # no layer at all: a half-space, V = E*² s²/2; a plateau of eight decades is beyond the twelve nodes that it has
        close = 5e-4 if surface_kind == "plateau only" else 5e-5
        modulus = reduced_modulus(skin.young_modulus_bulk, skin.poisson_ratio_bulk)
        np.testing.assert_allclose(twice_variance, np.square(modulus * rms_slope(surface)) / 2, rtol=close)
    pressure = loads(twice_variance)
    for gamma in (1.0, 0.42, 1e-3):
        mean = mean_separation(pressure[:, None], surface, skin=skin, area_correction=gamma)
        inner = mean_separation(pressure[:, None], inner_surface, skin=inner_skin, area_correction=gamma)
        assert np.isfinite(mean).all()
        np.testing.assert_allclose(mean, inner, rtol=1e-6, atol=1e-200)
        found = pressure_at_separation(mean, surface, skin=skin, area_correction=gamma)[:, 0]
        unclosed = mean[:, 0] > 1e-200
        np.testing.assert_allclose(found[unclosed], pressure[unclosed], rtol=1e-7)
    mean = mean_separation(pressure[:, None], surface, skin=skin)
    # where contact is closed but for rounding nothing can carry the mean
    unclosed = mean[:, 0] > 1e-13 * surface.rms_height
    for closure in ("gaussian", "sharp"):
        gaps = gap_distribution(pressure[:, None], surface, skin=skin, area_correction=0.42, closure=closure)
        assert all(np.isfinite(getattr(gaps, field.name)).all() for field in fields(gaps))
        np.testing.assert_allclose(gaps.film(np.inf)[unclosed], mean[unclosed], rtol=1e-6)
        np.testing.assert_allclose(gaps.cumulative(np.inf), 1.0, rtol=1e-9)
        fraction = gaps.cumulative(mean[..., None])
        assert ((fraction >= gaps.contact_fraction[..., None] - 1e-12) & (fraction <= 1 + 1e-12)).all()
    inner_gaps = gap_distribution(pressure[:, None], inner_surface, skin=inner_skin)
    gaps = gap_distribution(pressure[:, None], surface, skin=skin)
    # 2e-3 is the accuracy of the cells, see `gap_distribution`
    np.testing.assert_allclose(
        gaps.cumulative(mean[..., None]), inner_gaps.cumulative(mean[..., None]), atol=2e-3
    )


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize("skin", SKINS)
def test_edges_of_spectra_and_skins(surface, skin):
    check_all_edges(surface, skin, FAST)


@pytest.mark.slow
@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize("skin", SKINS)
def test_edges_of_spectra_and_skins_in_wide_boxes(surface, skin):
    check_all_edges(surface, skin, WIDE)


@pytest.mark.parametrize("end", ["wavevector_min", "wavevector_max"])
def test_a_spectrum_without_plateau_or_without_decay_has_an_inverse(end):
    rng = np.random.default_rng(1)
    surface = surface_from((22.4e-6, 0.78, 1e3, 1e3 if end == "wavevector_min" else 1e6, 1e6))
    skin = LayeredSkin(
        young_modulus_layer=between(rng, 1e5, 1e9, 300), young_modulus_bulk=20e3, layer_thickness=20e-6
    )
    pressure = between(rng, 10.0, 1e6, 300)
    mean = mean_separation(pressure[:, None], surface, skin=skin)
    unclosed = mean > 1e-200  # in closed contact the separation says nothing of the pressure
    assert unclosed.sum() > 200
    found = pressure_at_separation(mean, surface, skin=skin)
    np.testing.assert_allclose(found[unclosed], pressure[:, None][unclosed], rtol=1e-8)


def test_edges_of_the_area():
    assert relative_contact_area(0.0, 1e14) == 0.0
    for pressure in (5e-324, 1e-300, 1e-160, 1.0, 1e160, 1e300):
        # without roughness contact is complete under any load, with it and hardly a load A = (2/√π) p/√(γV)
        assert relative_contact_area(pressure, 0.0) == 1.0
        assert persson_contact_area(pressure, 0.0) == 1.0
        assert total_contact_area(pressure, 0.0, yield_stress=np.inf) == 1.0
        assert elastoplastic_contact_area(pressure, 0.0, yield_stress=np.inf).elastic == 1.0
    assert relative_contact_area(1e-200, 1e14) == pytest.approx(1e-207 * 2 / np.sqrt(np.pi * 0.42), rel=1e-6)
    for function in (persson_contact_area, relative_contact_area):
        assert function(0.0, 0.0) == 0.0
        assert (
            np.isnan(function(-1.0, 1e14))
            and np.isnan(function(np.nan, 1e14))
            and np.isnan(function(1.0, np.nan))
        )
    assert total_contact_area(0.0, 0.0, yield_stress=5e7) == 0.0
    yielded = elastoplastic_contact_area([5e7, 6e7], 1e14, yield_stress=5e7)
    np.testing.assert_array_equal(yielded.total, 1.0)
    beside = elastoplastic_contact_area(5e7 * (1 - 1e-12), 1e14, yield_stress=5e7)
    assert beside.total == pytest.approx(1.0, abs=1e-9)
    for gamma in (0.0, -0.1, 1 + 1e-12, np.nan):
        assert np.isnan(relative_contact_area(1.0, 1.0, area_correction=gamma))
    assert relative_contact_area(1e3, 1e8, area_correction=1.0) == persson_contact_area(1e3, 1e8)
    assert relative_contact_area(1e3, 1e8, area_correction=1 - 1e-12) == pytest.approx(
        persson_contact_area(1e3, 1e8), rel=1e-6
    )


def test_edges_of_the_response():
    skin = LayeredSkin(
        young_modulus_layer=7e6,
        young_modulus_bulk=20e3,
        poisson_ratio_layer=0.5,
        poisson_ratio_bulk=0.45,
        layer_thickness=20e-6,
    )
    ends = effective_modulus(skin, [0.0, np.inf])
    np.testing.assert_allclose(ends, [reduced_modulus(20e3, 0.45), reduced_modulus(7e6, 0.5)], rtol=1e-12)
    assert surface_response(skin, np.inf) == 1.0
    assert np.isnan(surface_response(skin, [-1.0, np.nan])).all()
    assert np.isnan(effective_modulus(skin, -1e-3))
    assert np.isnan(reduced_modulus(1e6, [-1.0, 0.5 + 1e-12])).all()
    assert twice_stress_variance(named_surface("paper_reference"), skin, wavevector=1e3) == 0.0
    whole = twice_stress_variance(named_surface("paper_reference"), skin)
    assert twice_stress_variance(named_surface("paper_reference"), skin, wavevector=1e9) == pytest.approx(
        whole, rel=1e-9
    )


def test_separation_at_its_ends():
    skin, surface = (
        LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6),
        named_surface("paper_reference"),
    )
    assert mean_separation(0.0, surface, skin=skin) == np.inf
    assert pressure_at_separation(0.0, surface, skin=skin) == np.inf
    assert pressure_at_separation(np.inf, surface, skin=skin) == 0.0
    assert mean_separation(1e300, surface, skin=skin) == 0.0
    assert np.isnan(mean_separation([-1.0, np.nan], surface, skin=skin)).all()
    assert np.isnan(pressure_at_separation([-1.0, np.nan], surface, skin=skin)).all()
    gaps = gap_distribution(6830.0, surface, skin=skin)
    assert gaps.cumulative(0.0) == pytest.approx(gaps.contact_fraction, rel=1e-12) and gaps.film(0.0) == 0.0
    assert np.isnan(gap_distribution(0.0, surface, skin=skin).mean)


def test_hertz_at_its_ends():
    assert tuple(sphere_contact(0.0, 8e-3, reduced_modulus=2e4)) == (0.0, 0.0, 0.0, 0.0)
    assert tuple(line_contact(0.0, 8e-3, reduced_modulus=2e4)) == (0.0, 0.0, 0.0)
    assert np.isnan(cylinder_of_sphere(0.0, 8e-3, reduced_modulus=2e4).cylinder_radius)
    round_, nearly = (
        elliptic_contact(0.2, 8e-3, radius_across=[8e-3, 8e-3 * (1 + 1e-9)], reduced_modulus=2e4),
        sphere_contact(0.2, 8e-3, reduced_modulus=2e4),
    )
    np.testing.assert_allclose(round_.semi_axis_along, nearly.contact_radius, rtol=1e-8)
    np.testing.assert_allclose(round_.mean_pressure, nearly.mean_pressure, rtol=1e-8)
    circle = cylinder_of_ellipse(0.2, 8e-3, radius_across=8e-3, reduced_modulus=2e4)
    sphere = cylinder_of_sphere(0.2, 8e-3, reduced_modulus=2e4)
    np.testing.assert_allclose(circle, sphere, rtol=1e-12)
    factors = ellipse_factors([1 - 1e-15, 1.0, 1 + 1e-15, 1 + 1e-9])
    np.testing.assert_allclose(factors, 1.0, rtol=2e-9)
    assert np.isnan(ellipse_factors([0.0, -1.0, np.nan]).size).all()


def test_true_area_at_its_ends():
    np.testing.assert_allclose(total_area_ratio([0.0, 1e-300, 1e-6]), [1.0, 1.0, 1 + 5e-13], rtol=1e-14)
    # a cliff: √π/2 s
    assert total_area_ratio(1e9) == pytest.approx(np.sqrt(np.pi) / 2 * 1e9, rel=1e-8)
    assert np.isnan(total_area_ratio(-1e-9))


def test_empty_batches_are_empty():
    none = np.empty(0)
    surface = named_surface("paper_reference")
    skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    no_surface = surface_from((none, 0.78, 1e3, 1e3, 1e9))
    no_skin = LayeredSkin(young_modulus_layer=none, young_modulus_bulk=20e3, layer_thickness=20e-6)
    for rough, body in ((no_surface, skin), (surface, no_skin)):
        assert twice_stress_variance(rough, body).shape == (0,)
        assert mean_separation(6830.0, rough, skin=body).shape == (0,)
        assert pressure_at_separation(1e-5, rough, skin=body).shape == (0,)
        assert gap_distribution(6830.0, rough, skin=body).mean.shape == (0,)
        assert mean_separation(none, rough, skin=body).shape == (0, 0)
    assert mean_separation(none, surface, skin=skin).shape == (0,)
    assert gap_distribution(none, surface, skin=skin).cumulative(1e-6).shape == (0,)
    assert relative_contact_area(none, 1e14).shape == (0,)
    assert total_contact_area(1e3, 1e14, yield_stress=none).shape == (0,)
