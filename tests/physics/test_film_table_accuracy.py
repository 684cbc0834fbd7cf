"""How good a table is that holds all skins and balls, end to end against the direct solver."""

import numpy as np
import pytest
from line_curves import FilmTablePlan, stribeck_curve
from named_fields import skin_from, surface_from

from skinbayes.contact import LayeredSkin
from skinbayes.lubrication import (
    FILM_PARAMETERS,
    LubricatedBalls,
    build_film_table,
    film_axes,
    tabulated_friction,
)
from skinbayes.lubrication.film_axes import range_logarithms
from skinbayes.roughness import named_surface

BOX = {
    "young_modulus_layer": (1e6, 30e6),
    "young_modulus_bulk": (5e3, 5e5),
    "rms_height": (2e-6, 60e-6),
    "sphere_radius": (5e-3, 15e-3),
    "normal_force": (0.1, 5.0),
}


def solve(parameters, product, stress, nodes):
    layer, bulk, height, radius, force, thickness = parameters
    shape = named_surface("paper_reference")
    surface = surface_from(
        (height, shape.hurst_exponent, shape.wavevector_min, shape.wavevector_rolloff, shape.wavevector_max)
    )
    skin = LayeredSkin(young_modulus_layer=layer, young_modulus_bulk=bulk, layer_thickness=thickness)
    return stribeck_curve(
        product,
        sphere_radius=radius,
        normal_force=force,
        skin=skin,
        spectrum=surface,
        frictional_shear_stress=stress,
        nodes=nodes,
    ).friction_coefficient[0]


@pytest.mark.slow
@pytest.mark.parametrize("thickness", [20e-6, 173e-6])
def test_one_table_for_all_skins_and_balls(thickness):
    ranges = {**BOX, "layer_thickness": (thickness, thickness)}
    table = build_film_table(FilmTablePlan(ranges, spectrum=named_surface("paper_reference")))
    assert table.held_out[1] < 5e-3
    assert table.held_out[2] < 7.5e-3
    rng = np.random.default_rng(31)
    low, high = range_logarithms(ranges)
    errors, refused = [], 0
    while len(errors) < 300:
        parameters = np.exp(rng.uniform(low, high))
        product = np.exp(rng.uniform(np.log(1e-6), np.log(10.0)))
        stress = np.exp(rng.uniform(np.log(1e6), np.log(5e7)))
        named = dict(zip(FILM_PARAMETERS, parameters, strict=True))
        found = tabulated_friction(
            table, product, balls=LubricatedBalls(parameters=named, frictional_shear_stress=stress)
        )
        wanted = solve(parameters, [product], stress, nodes=128)
        if np.isfinite(wanted) and found.outside_table:
            refused += 1
            continue
        assert np.isfinite(found.friction_coefficient) == np.isfinite(wanted)
        if np.isfinite(wanted):
            errors.append(abs(found.friction_coefficient / wanted - 1))
    assert refused < 0.02 * len(errors)
    assert np.quantile(errors, 0.99) < 5e-3
    assert max(errors) < 7.5e-3


@pytest.mark.slow
def test_layer_thickness_and_poisson_ratios():
    """The layer as an axis, a stiffer Poisson ratio and plain Persson theory."""
    ranges = {
        "young_modulus_layer": (7e6, 7e6),
        "young_modulus_bulk": (1e4, 1e5),
        "rms_height": (20e-6, 20e-6),
        "sphere_radius": (8e-3, 8e-3),
        "normal_force": (0.3, 0.3),
        "layer_thickness": (15e-6, 200e-6),
    }
    shape = named_surface("paper_reference")
    table = build_film_table(
        FilmTablePlan(
            ranges, spectrum=shape, poisson_ratio_layer=0.4, poisson_ratio_bulk=0.45, area_correction=1.0
        )
    )
    assert table.axes.names == ("young_modulus_bulk", "layer_thickness")
    rng = np.random.default_rng(5)
    surface = surface_from(
        (20e-6, shape.hurst_exponent, shape.wavevector_min, shape.wavevector_rolloff, shape.wavevector_max)
    )
    products = np.geomspace(1e-5, 0.05, 8)
    for _ in range(12):
        bulk, thickness = np.exp(rng.uniform(np.log([1e4, 15e-6]), np.log([1e5, 200e-6])))
        named = {name: low for name, (low, _) in ranges.items()}
        named |= {"young_modulus_bulk": bulk, "layer_thickness": thickness}
        skin = skin_from((7e6, bulk, 0.4, 0.45, thickness))
        wanted = stribeck_curve(
            products,
            sphere_radius=8e-3,
            normal_force=0.3,
            skin=skin,
            spectrum=surface,
            frictional_shear_stress=1e7,
            area_correction=1.0,
            nodes=160,
        ).friction_coefficient
        found = tabulated_friction(
            table, products, balls=LubricatedBalls(parameters=named, frictional_shear_stress=1e7)
        ).friction_coefficient
        np.testing.assert_allclose(found, wanted, rtol=7.5e-3)


def random_ranges(rng):
    """Ranges of some of the parameters, up to a factor of 30, the others fixed."""
    ranges = {}
    for name, (low, high) in {**BOX, "layer_thickness": (1e-5, 2e-4)}.items():
        ends = np.sort(np.exp(rng.uniform(np.log(low), np.log(high), 2)))
        ranges[name] = tuple(ends) if rng.uniform() < 0.6 else (ends[0], ends[0])
    return ranges


def test_axes_name_places_and_find_them_again():
    """Coordinates of the parameters that stand for a place are that place, whatever varies; similar balls share them."""
    rng = np.random.default_rng(8)
    for _ in range(60):
        ranges = random_ranges(rng)
        axes = film_axes(ranges, 0.45, largest_strain=1.3, stress_scale=1.17e5)
        places = rng.uniform(-1, 1, (30, len(axes.names)))
        logs = axes.representative(places)
        fixed = [place for place, name in enumerate(FILM_PARAMETERS) if ranges[name][0] == ranges[name][1]]
        np.testing.assert_allclose(
            logs[:, fixed], axes.reference[fixed] + np.zeros((30, len(fixed))), atol=1e-9
        )
        similar = logs + rng.uniform(-1, 1, (30, 1)) * np.array([0, 0, -1, 1, -1, 0])
        stiffer = logs + rng.uniform(-1, 1, (30, 1)) * np.array([1, 1, 0, 0, 1, 0])
        for others in (logs, similar, stiffer):
            assert axes.contains(list(others.T)).all()
            if axes.names:
                np.testing.assert_allclose(np.array(axes.coordinates(list(others.T))).T, places, atol=1e-8)
        assert len(axes.names) <= 4
        # what is fixed and not replaced by anything similar is refused
        thicker = logs + np.array([0, 0, 0, 0, 0, 0.01])
        if "layer_thickness" not in axes.names:
            assert not axes.contains(list(thicker.T)).any()
