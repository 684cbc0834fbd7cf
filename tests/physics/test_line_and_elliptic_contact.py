"""Hertz line and elliptic contact, and the cylinders that stand for sphere and ellipse (Eqs. 9 and B1 of the paper)."""

import numpy as np
import pytest
from scipy.integrate import dblquad, quad
from scipy.special import ellipe, ellipk

from skinbayes.contact.elliptic_contact import cylinder_of_ellipse, ellipse_factors, elliptic_contact
from skinbayes.contact.hertz import sphere_contact
from skinbayes.contact.line_contact import cylinder_of_sphere, line_contact
from skinbayes.contact.solid import reduced_modulus


def test_line_pressure_carries_the_load_and_flattens_the_cylinder():
    load, radius, modulus = 21.92, 4.53e-3, 2.7e4
    contact = line_contact(load, radius, reduced_modulus=modulus)
    b, peak = contact.half_width, contact.maximum_pressure
    assert quad(lambda x: peak * np.sqrt(1 - (x / b) ** 2), -b, b)[0] == pytest.approx(load, rel=1e-8)
    assert contact.mean_pressure == pytest.approx(load / (2 * b), rel=1e-12)

    # displacement difference between the centre and x: −(2/(π E*)) ∫ p ln|(x − s)/s| ds must be x²/(2R)
    def displacement(x):
        # s = b cos θ takes the square roots out; the logarithm is split at its singularity
        def term(t):
            return np.sin(t) ** 2 * np.log(abs(x / b - np.cos(t)))

        turn = np.arccos(x / b)
        return -2 / (np.pi * modulus) * peak * b * (quad(term, 0, turn)[0] + quad(term, turn, np.pi)[0])

    for x in (0.3 * b, 0.8 * b):
        assert displacement(0.0) - displacement(x) == pytest.approx(x**2 / (2 * radius), rel=1e-6)


def test_both_conditions_behind_the_cylinder_of_a_sphere():
    force, radius, modulus = np.array([0.02, 0.5, 5.0]), 8e-3, reduced_modulus(20e3, 0.5)
    sphere = sphere_contact(force, radius, reduced_modulus=modulus)
    cylinder = cylinder_of_sphere(force, radius, reduced_modulus=modulus)
    line = line_contact(cylinder.load_per_length, cylinder.cylinder_radius, reduced_modulus=modulus)
    np.testing.assert_allclose(line.mean_pressure, sphere.mean_pressure, rtol=1e-13)
    np.testing.assert_allclose(2 * line.half_width * np.sqrt(2 / 3), sphere.contact_radius, rtol=1e-13)
    # the closed forms of the factors, and their printed values
    radius_factor, load_factor = np.pi**2 / 32 * 1.5**1.5, 6 ** (1 / 6) / np.pi
    np.testing.assert_allclose(cylinder.cylinder_radius, radius_factor * radius, rtol=1e-13)
    np.testing.assert_allclose(
        cylinder.load_per_length, load_factor * np.cbrt(modulus * force**2 / radius), rtol=1e-13
    )
    assert (radius_factor, load_factor) == pytest.approx((0.5666, 0.4291), abs=5e-5)


def test_rigid_plates_with_these_contact_areas_squeeze_out_fluid_in_the_same_time():
    # Reynolds for a falling plate, h³ ∇²p = −12 η v: mean pressure v η w²/h³ for a strip of width w,
    # (3/2) v η r²/h³ for a disk (the solutions are 6ηv(w²/4 − x²)/h³ and 3ηv(r² − s²)/h³)
    w = 1.0
    r = w * np.sqrt(2 / 3)
    strip = quad(lambda x: 6 * (w**2 / 4 - x**2), -w / 2, w / 2)[0] / w
    disk = quad(lambda s: 3 * (r**2 - s**2) * 2 * np.pi * s, 0, r)[0] / (np.pi * r**2)
    assert strip == pytest.approx(disk, rel=1e-12)


def test_skin_of_section_6():
    modulus = reduced_modulus(20e3, 0.5)
    cylinder = cylinder_of_sphere(0.2, 8e-3, reduced_modulus=modulus)
    line = line_contact(cylinder.load_per_length, cylinder.cylinder_radius, reduced_modulus=modulus)
    assert cylinder.cylinder_radius == pytest.approx(4.53e-3, rel=1e-3)
    assert cylinder.load_per_length == pytest.approx(21.9, rel=1e-3)
    assert line.half_width == pytest.approx(2.18e-3, rel=1e-3)
    assert line.maximum_pressure == pytest.approx(6.41e3, rel=1e-3)
    assert line.half_width / cylinder.cylinder_radius == pytest.approx(0.48, abs=0.005)


@pytest.mark.parametrize("ratio", [1.3, 2.0, 5.0, 30.0])
def test_factors_agree_with_the_printed_integrals(ratio):
    square = 1 - 1 / ratio**2
    first, second = ellipk(square), ellipe(square)
    bend, stretch = ratio**2 * second - first, first - second
    size = np.cbrt(4 / (np.pi * square) * ratio**-1.5 * np.sqrt(bend * stretch))
    factors = ellipse_factors(ratio)
    mean = (ratio + 1 / ratio) / 2
    expected = (bend / stretch, size, size / mean**0.5, size**3 / mean**0.5, 1 / size / mean**0.5)
    np.testing.assert_allclose(factors, expected, rtol=1e-11)


def test_near_the_circle_no_digits_are_lost():
    # the printed form is 0/0 there; the factors are even in ln(a/b), so they differ from 1 by O(ln²)
    np.testing.assert_allclose(ellipse_factors(1.0), 1.0, rtol=1e-15)
    np.testing.assert_allclose(ellipse_factors(1 + 1e-7)[1:], 1.0, rtol=1e-13)
    np.testing.assert_allclose(ellipse_factors(4.0), ellipse_factors(0.25), rtol=1e-15)


@pytest.mark.parametrize("radii", [(8e-3, 8e-3), (8e-3, 16e-3), (8e-3, 0.4), (16e-3, 8e-3)])
def test_elliptic_pressure_carries_the_load_and_flattens_the_body(radii):
    force, modulus = 0.3, 5e4
    contact = elliptic_contact(force, radii[0], radius_across=radii[1], reduced_modulus=modulus)
    a, b = contact.semi_axis_along, contact.semi_axis_across
    assert contact.maximum_pressure * 2 / 3 * np.pi * a * b == pytest.approx(force, rel=1e-12)
    assert contact.mean_pressure * np.pi * a * b == pytest.approx(force, rel=1e-12)
    assert 2 / contact.effective_radius**2 == pytest.approx(1 / a**2 + 1 / b**2, rel=1e-12)
    # potential theory: curvature of the displacement, p0 a b/E* ∫ dw/[(a² + w²)^(3/2) (b² + w²)^(1/2)] = 1/(2 R1)
    for own, other, radius in ((a, b, radii[0]), (b, a, radii[1])):
        integral = quad(
            lambda t, s=own, o=other: np.cos(t) ** 2 / np.sqrt((s * np.sin(t)) ** 2 + (o * np.cos(t)) ** 2),
            0, np.pi / 2, epsabs=0, epsrel=1e-12,
        )[0] / own**2  # fmt: skip
        curvature = contact.maximum_pressure / modulus * a * b * integral
        assert curvature == pytest.approx(1 / (2 * radius), rel=1e-9)


def test_displacement_of_an_elliptic_contact_by_brute_force():
    force, modulus, radii = 0.3, 5e4, (8e-3, 24e-3)
    contact = elliptic_contact(force, radii[0], radius_across=radii[1], reduced_modulus=modulus)
    a, b = contact.semi_axis_along, contact.semi_axis_across

    def displacement(x):
        # polar coordinates about (x, 0) remove the 1/r of Boussinesq's solution
        def reach(angle):
            p = (np.cos(angle) / a) ** 2 + (np.sin(angle) / b) ** 2
            q = x * np.cos(angle) / a**2
            return (-q + np.sqrt(q * q + p * (1 - (x / a) ** 2))) / p

        def pressure(r, angle):
            rest = 1 - ((x + r * np.cos(angle)) / a) ** 2 - (r * np.sin(angle) / b) ** 2
            return np.sqrt(max(rest, 0.0))

        return (
            contact.maximum_pressure / (np.pi * modulus)
            * dblquad(pressure, 0, 2 * np.pi, 0, reach, epsabs=1e-10, epsrel=1e-6)[0]
        )  # fmt: skip

    x = 0.7 * a
    assert displacement(0.0) - displacement(x) == pytest.approx(x**2 / (2 * radii[0]), rel=1e-4)


def test_cylinder_of_an_ellipse_is_equation_b1():
    force, along, across, modulus = 0.2, 8e-3, np.array([8e-3, 1e-2, 4e-2, 1.0]), 2.7e4
    contact = elliptic_contact(force, along, radius_across=across, reduced_modulus=modulus)
    factors = ellipse_factors(contact.semi_axis_across / contact.semi_axis_along)
    radius = np.sqrt(along * across)
    circle = cylinder_of_sphere(force, radius, reduced_modulus=modulus)
    cylinder = cylinder_of_ellipse(force, along, radius_across=across, reduced_modulus=modulus)
    np.testing.assert_allclose(
        cylinder.cylinder_radius, factors.cylinder_radius * circle.cylinder_radius, rtol=1e-12
    )
    np.testing.assert_allclose(
        cylinder.load_per_length, factors.cylinder_load * circle.load_per_length, rtol=1e-12
    )
    np.testing.assert_allclose(factors.radius_ratio, across / along, rtol=1e-12)


def test_impossible_arguments_give_nan():
    assert np.isnan(
        np.array(line_contact([-1.0, 1.0, 1.0], [1.0, 0.0, 1.0], reduced_modulus=[1.0, 1.0, -1.0]))
    ).all()
    assert np.isnan(
        np.array(elliptic_contact([1.0, 1.0], [-1.0, 1.0], radius_across=[1.0, 0.0], reduced_modulus=1.0))
    ).all()
    assert np.isnan(cylinder_of_ellipse(1.0, 2.0, radius_across=1.0, reduced_modulus=1.0).cylinder_radius)
    assert np.isnan(cylinder_of_sphere(-1.0, 1.0, reduced_modulus=1.0).cylinder_radius)
    assert np.isnan(ellipse_factors(-2.0).size)
