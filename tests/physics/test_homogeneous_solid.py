"""A solid of one material: closed forms of the half-space, and layered skin of equal moduli."""

from __future__ import annotations

import numpy as np
import pytest
from line_curves import FilmTablePlan
from scipy.special import erf

from skinbayes.contact import (
    HomogeneousSolid,
    LayeredSkin,
    effective_modulus,
    mean_separation,
    relative_contact_area,
    surface_response,
    twice_stress_variance,
)
from skinbayes.emulation import Box
from skinbayes.errors import InputError
from skinbayes.lubrication import (
    LubricatedBalls,
    build_film_table,
    tabulated_friction,
)
from skinbayes.roughness import SelfAffineSpectrum, named_surface, rms_slope
from skinbayes.wetting import bridge_table, film_contact, humid_groups, humid_table, skin_groups

SURFACE = named_surface("paper_reference")
RUBBER = HomogeneousSolid(young_modulus=2e6, poisson_ratio=0.4)
STRAINED = 2e6 / (1 - 0.4**2)


def layered(modulus: float, poisson_ratio: float, thickness: float) -> LayeredSkin:
    return LayeredSkin(
        young_modulus_layer=modulus, young_modulus_bulk=modulus, poisson_ratio_layer=poisson_ratio,
        poisson_ratio_bulk=poisson_ratio, layer_thickness=thickness,
    )  # fmt: skip


def test_the_response_is_one() -> None:
    q = np.concatenate([[0.0], np.geomspace(1.0, 1e12, 50), [np.inf]])
    assert (surface_response(RUBBER, q) == 1).all()
    assert effective_modulus(RUBBER, q) == pytest.approx(STRAINED, rel=1e-15)
    assert np.isnan(surface_response(RUBBER, -1.0))
    batch = HomogeneousSolid(young_modulus=np.array([1e6, -1.0, np.nan]))
    assert np.isnan(surface_response(batch, [1e3, 1e4])).tolist() == [[False] * 2, [True] * 2, [True] * 2]


def test_persson_theory_of_a_half_space() -> None:
    """V = ½ (E* slope)² and A/A0 = erf(p/√V), Persson (2001)."""
    for surface in (
        SURFACE,
        SelfAffineSpectrum(rms_height=5e-6, hurst_exponent=1.0, wavevector_min=1e3, wavevector_rolloff=1e3, wavevector_max=1e8),
    ):  # fmt: skip
        twice = (STRAINED * rms_slope(surface)) ** 2 / 2
        assert twice_stress_variance(surface, RUBBER) == pytest.approx(twice, rel=1e-12)
        area = relative_contact_area(1e5, twice_stress_variance(surface, RUBBER), area_correction=1.0)
        assert area == pytest.approx(erf(1e5 / np.sqrt(twice)), rel=1e-12)


@pytest.mark.parametrize("thickness", [2e-6, 3e-4])
def test_it_is_skin_whose_layer_is_no_stiffer(thickness: float) -> None:
    skin, q = layered(2e6, 0.4, thickness), np.geomspace(2e3, 1e9, 20)
    assert twice_stress_variance(SURFACE, skin, wavevector=q) == pytest.approx(
        twice_stress_variance(SURFACE, RUBBER, wavevector=q), rel=1e-12
    )
    pressure = np.geomspace(1e2, 1e6, 7)
    # places of the quadrature differ
    assert mean_separation(pressure, SURFACE, skin=skin) == pytest.approx(
        mean_separation(pressure, SURFACE, skin=RUBBER), rel=1e-10
    )


def test_a_table_of_films() -> None:
    ball = {"rms_height": (22.4e-6,) * 2, "sphere_radius": (8e-3,) * 2, "normal_force": (0.2, 0.2)}
    small = {
        "checked": 0,
        "counts": {"young_modulus": 3},
        "speeds": 9,
        "nodes": 40,
        "poisson_ratio_bulk": 0.4,
    }
    solid = build_film_table(FilmTablePlan({"young_modulus": (1e5, 2e5), **ball}, spectrum=SURFACE, **small))  # type: ignore[arg-type]
    assert solid.axes.names == ("young_modulus",)
    node = 1.5e5
    named = {name: ends[0] for name, ends in ball.items()} | {"young_modulus": node}
    skin = {name: ends[0] for name, ends in ball.items()} | {"layer_thickness": 2e-5}
    fixed = {"young_modulus_layer": node, "young_modulus_bulk": node, **skin}
    one = build_film_table(FilmTablePlan({name: (value, value) for name, value in fixed.items()}, spectrum=SURFACE,
                           poisson_ratio_layer=0.4, **small))  # type: ignore[arg-type] # fmt: skip
    products = np.geomspace(1e-6, 1e-2, 5)
    found, expected = (
        tabulated_friction(
            table, products, balls=LubricatedBalls(parameters=given, frictional_shear_stress=1e6)
        ).friction_coefficient
        for table, given in ((solid, named), (one, fixed))
    )
    # three nodes of the modulus
    assert found == pytest.approx(expected, rel=0.01)
    assert solid.contains(**named) and not solid.contains(**fixed | {"young_modulus_layer": 2e5})


def test_tables_of_bridges() -> None:
    rubber = HomogeneousSolid(young_modulus=np.array([1e6, 2e6]))
    equal = layered(1e6, 0.5, 2e-5)
    one, height, gamma = np.ones(2), np.full(2, 22.4e-6), np.array(0.42)
    tables = []
    for skin in (
        rubber,
        LayeredSkin(
            **vars(equal) | dict.fromkeys(("young_modulus_layer", "young_modulus_bulk"), rubber.young_modulus)
        ),
    ):
        groups = skin_groups(
            6830 * one, 0.0845 * one, height=height, spectrum=SURFACE, skin=skin, area_correction=gamma
        )
        low, high = ({name: float(end(x)) for name, x in groups.items()} for end in (np.min, np.max))
        high["load"] = low["load"] + 0.1
        high["wetting_tension"] = low["wetting_tension"]
        tables.append(bridge_table(Box({name: (low[name], high[name]) for name in low}), depth=1e4))
    assert tables[0] is not None and tables[1] is not None
    assert set(tables[0].found.counts) == {"load"}
    assert tables[0].found.parts == pytest.approx(tables[1].found.parts, rel=1e-3, abs=1e-3)
    humid = []
    for skin in (HomogeneousSolid(young_modulus=1e6), equal):
        groups = humid_groups(6830 * one, 1e-9 * one, height=height, skin=skin)
        low = {name: float(x[0]) for name, x in groups.items()}
        high = {**low, "load": low["load"] + 0.1, "gap": low["gap"] + 0.1}
        humid.append(
            humid_table(
                Box({name: (low[name], high[name]) for name in low}),
                spectrum=SURFACE,
                skin=skin,
                area_correction=gamma,
            )
        )
    assert humid[0] is not None and humid[1] is not None
    assert humid[0].coefficients == pytest.approx(humid[1].coefficients, abs=1e-3)


def test_it_does_not_harden() -> None:
    water = {
        "surface_tension": 0.0727,
        "contact_angle_skin": 1.4,
        "contact_angle_counterface": 0.0,
        "yield_stress": np.inf,
    }
    dried = film_contact(6830.0, SURFACE, skin=RUBBER, **water)
    skin = film_contact(6830.0, SURFACE, skin=layered(2e6, 0.4, 2e-5), young_modulus_layer_dry=2e6, **water)
    assert dried.dry_area == pytest.approx(skin.dry_area, rel=1e-12)
    assert dried.area == pytest.approx(skin.area, rel=1e-3)
    with pytest.raises(InputError, match="no layer that could harden"):
        film_contact(6830.0, SURFACE, skin=RUBBER, young_modulus_layer_dry=2e6, **water)
    with pytest.raises(InputError, match="hardening_film is given, but not young_modulus_layer_dry"):
        film_contact(6830.0, SURFACE, skin=RUBBER, hardening_film=1e-6, **water)
