"""Hertz contact on stacks of layers: limits, thin layers on a rigid base, and the surface that the pressure makes."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.special import j0

from skinbayes.contact import (
    layered_line_contact,
    layered_modulus,
    layered_sphere_contact,
    line_contact,
    sphere_contact,
)
from skinbayes.errors import InputError

SKIN = {"moduli": [7e6, 20e3], "poisson_ratios": [0.5, 0.5], "thicknesses": [20e-6]}
STACK = {
    "moduli": [1e6, 50e3, 20e3, 5e6],
    "poisson_ratios": [0.5, 0.45, 0.3, 0.4],
    "thicknesses": [2e-4, 1e-3, 3e-3],
}
SOFT = {"moduli": [2e4, 1e6], "poisson_ratios": [0.45, 0.4], "thicknesses": [1e-3]}


def test_equal_layers_are_a_half_space() -> None:
    same = {"moduli": [20e3] * 3, "poisson_ratios": [0.4] * 3, "thicknesses": [1e-3, 2e-3]}
    modulus = 20e3 / (1 - 0.16)
    ball, hertz = (
        layered_sphere_contact(0.2, 8e-3, **same),
        sphere_contact(0.2, 8e-3, reduced_modulus=modulus),
    )
    for name in ("contact_radius", "mean_pressure", "maximum_pressure", "indentation"):
        assert getattr(ball, name)[0] == pytest.approx(getattr(hertz, name), rel=1e-9)
    assert (ball.equivalent_modulus[0], ball.equivalent_radius[0]) == pytest.approx((modulus, 8e-3), rel=1e-9)
    profile = hertz.maximum_pressure * np.sqrt(1 - np.square(ball.position[0] / ball.contact_radius[0]))
    np.testing.assert_allclose(ball.pressure[0], profile, atol=1e-9 * profile[0])
    line, flat = layered_line_contact(20.0, 4e-3, **same), line_contact(20.0, 4e-3, reduced_modulus=modulus)
    assert line.half_width[0] == pytest.approx(flat.half_width, rel=1e-9)
    np.testing.assert_allclose(line.pressure[0] / flat.maximum_pressure, profile / profile[0], atol=1e-9)


@pytest.mark.parametrize("layers", [SKIN, STACK, SOFT])
def test_small_contacts_know_the_surface_and_wide_ones_the_half_space(layers: dict) -> None:
    surface, deepest = (layers["moduli"][n] / (1 - layers["poisson_ratios"][n] ** 2) for n in (0, -1))
    thickness, total = layers["thicknesses"][0], sum(layers["thicknesses"])
    # a = d/200, and 100 to 500 times all layers, or more if they are softer than what is below; what is left goes as d/a
    small = 4 / 3 * surface * (thickness / 200) ** 3 / 1.0
    assert layered_sphere_contact(small, 1.0, **layers).equivalent_modulus[0] == pytest.approx(
        surface, rel=2e-4
    )
    small = np.pi / 4 * surface * (thickness / 200) ** 2
    assert layered_line_contact(small, 1.0, **layers).equivalent_modulus[0] == pytest.approx(
        surface, rel=2e-3
    )
    contrast, off = max(1.0, layers["moduli"][-1] / min(layers["moduli"])), []
    for width in (100 * total * contrast, 500 * total * contrast):
        large = layered_sphere_contact(4 / 3 * deepest * width**3 / 10.0, 10.0, **layers)
        off.append(abs(large.equivalent_modulus[0] / deepest - 1))
    assert off[1] < 0.03
    assert off[1] < off[0] / 3


@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_thin_layers_on_a_rigid_base(nu: float) -> None:
    # compressible: p = M(δ − r²/2R)/d, M the modulus of a confined layer; incompressible: ∇²p = −(3G/d³)(δ − r²/2R)
    young, d, radius = 1e5, 1e-3, 10.0
    layer = {"moduli": [young, 1e13], "poisson_ratios": [nu, 0.3], "thicknesses": [d]}
    off = []
    for width in (0.02, 0.1):
        confined = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) if nu < 0.5 else np.inf
        if nu < 0.5:
            force, load = (
                np.pi * confined * width**4 / (4 * radius * d),
                2 * confined * width**3 / (3 * radius * d),
            )
        else:
            force = np.pi * young * width**6 / (96 * radius * d**3)
            load = 2 * young / 3 * width**5 / (15 * radius * d**3)
        ball, line = (
            layered_sphere_contact(force, radius, **layer),
            layered_line_contact(load, radius, **layer),
        )
        off.append([ball.contact_radius[0] / width - 1, line.half_width[0] / width - 1])
        depth, peak = (0.5, 2.0) if nu < 0.5 else (0.25, 3.0)
        assert ball.indentation[0] / (width**2 / radius) == pytest.approx(depth, rel=0.8 * d / width)
        assert ball.maximum_pressure[0] / ball.mean_pressure[0] == pytest.approx(peak, rel=4 * d / width)
    assert np.abs(off[1]).max() < 0.02
    np.testing.assert_allclose(np.array(off[1]) * 5, off[0], rtol=0.1)  # the edge is wide as d


def gauss(edges: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights of Gauss's rule between each two edges."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    places = np.concatenate([(a + b + (b - a) * nodes) / 2 for a, b in pairwise(edges)])
    return places, np.concatenate([(b - a) / 2 * weights for a, b in pairwise(edges)])


def shape(position: np.ndarray, pressure: np.ndarray) -> CubicSpline:
    """The pressure over √(1 − (r/a)²), which is smooth, against r/a."""
    part = position[:-1] / position[-1]
    return CubicSpline(part, pressure[:-1] / np.sqrt(1 - np.square(part)))


@pytest.mark.parametrize("layers", [SKIN, STACK, SOFT])
def test_the_pressure_makes_the_surface_that_of_the_body(layers: dict) -> None:
    # depth 2 ∫p(q) J0(qr) dq/E_eff(q), p(q) by quadrature: no Bessel functions but J0
    load, radius = 0.2, 8e-3
    ball, line = layered_sphere_contact(load, radius, **layers), layered_line_contact(22.0, radius, **layers)
    turn, part = gauss(np.linspace(0, np.pi / 2, 9), 24)
    q, step = gauss(np.concatenate([np.geomspace(1e-3, 0.5, 12), np.arange(1.0, 400.0, 1.5)]), 6)
    places = np.array([0.0, 0.3, 0.6, 0.9])
    size, smooth = ball.contact_radius[0], shape(ball.position[0], ball.pressure[0])
    spread = np.sin(turn) * np.cos(turn) ** 2 * smooth(np.sin(turn)) * part
    assert 2 * np.pi * size**2 * spread.sum() == pytest.approx(load, rel=1e-4)
    transform = size**2 * j0(np.outer(q, np.sin(turn))) @ spread
    weight = 2 / size * step * transform / layered_modulus(q / size, **layers).real
    depth = j0(np.outer(places, q)) @ weight
    expected = ball.indentation[0] - np.square(places * size) / (2 * radius)
    np.testing.assert_allclose(depth, expected, rtol=2e-3)
    size, smooth = line.half_width[0], shape(line.position[0], line.pressure[0])
    spread = np.cos(turn) ** 2 * smooth(np.sin(turn)) * part
    assert 2 * size * spread.sum() == pytest.approx(22.0, rel=1e-4)
    transform = 2 * size * np.cos(np.outer(q, np.sin(turn))) @ spread
    weight = 2 / np.pi * step / q * transform / layered_modulus(q / size, **layers).real
    sag = (1 - np.cos(np.outer(places, q))) @ weight
    np.testing.assert_allclose(sag, np.square(places * size) / (2 * radius), rtol=4e-3)


def test_what_cannot_be() -> None:
    contact = layered_sphere_contact([0.2, 0.0, -1.0, np.nan], 8e-3, **SKIN)
    assert np.isfinite(contact.contact_radius).tolist() == [True, False, False, False]
    assert np.isnan(contact.pressure[1:]).all()
    assert contact.contact_radius[0] == layered_sphere_contact(0.2, 8e-3, **SKIN).contact_radius[0]
    with pytest.raises(InputError, match="There are 2 moduli"):
        layered_sphere_contact(0.2, 8e-3, **(SKIN | {"thicknesses": []}))
    with pytest.raises(InputError, match="poisson_ratios"):
        layered_line_contact(0.2, 8e-3, **(SKIN | {"poisson_ratios": [0.5, 0.6]}))
    with pytest.raises(InputError, match="sphere_radius"):
        layered_sphere_contact(0.2, -8e-3, **SKIN)
    with pytest.raises(InputError, match="thicknesses"):
        layered_sphere_contact(0.2, 8e-3, **(SKIN | {"thicknesses": [0.0]}))
