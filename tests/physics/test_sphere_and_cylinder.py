"""The ball in two dimensions and the cylinder of Eq. 9 against it: Fig. 11 of the paper, skin, other balls."""

import numpy as np
import pytest
from line_curves import stribeck_curve
from named_fields import surface_from
from scipy.interpolate import CubicSpline

from skinbayes.contact import (
    LayeredSkin,
    cylinder_of_sphere,
    reduced_modulus,
    relative_contact_area,
    sphere_contact,
    twice_stress_variance,
)
from skinbayes.lubrication import (
    asperity_law,
    lubricated_films,
    lubricated_point_films,
)
from skinbayes.roughness import named_surface

# What the map is worth, sphere over cylinder with the whole inlet of its parabola: (smallest, largest) that is accepted
FIGURE_11 = {
    "slope of the sphere": (0.502, 0.508),
    "slope of the cylinder": (0.469, 0.475),
    "friction at 1e-3 N/m": (1.085, 1.105),
    "friction at 1e-1 N/m": (1.255, 1.285),
    "central film at 1e-3 N/m": (0.98, 1.01),
    "central film at 1e-1 N/m": (0.87, 0.89),
}
SKIN = {
    "plateau": (0.995, 1.005),
    "speed at half of the plateau": (1.23, 1.27),
    "speed of the minimum": (1.10, 1.18),
    "friction at the minimum": (1.16, 1.20),
    "friction at 1e-1 N/m": (1.02, 1.05),
}
FLANK = (1.15, 1.32)  # speed at which asperities carry half of the load, skin under a stiffer layer

GLASS_BALL = (8e-3, 0.2, 20e3 / 0.75)
PAPER_SKIN = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
FIGURE_11_BALL = (1e-2, 1.3, 1.6e6)


def number_of(product, radius, force, modulus):
    hertz = sphere_contact(force, radius, reduced_modulus=modulus)
    return 6 * product * radius**2 / (hertz.contact_radius**3 * hertz.maximum_pressure)


def accepted(found, bounds):
    """Print what was found; every number lies in its bounds."""
    for name, value in found.items():
        low, high = bounds[name]
        print(f"{name}: {value:.3f}, accepted {low} to {high}")
    outside = [name for name, value in found.items() if not bounds[name][0] < value < bounds[name][1]]
    assert not outside
    assert found.keys() == bounds.keys()


@pytest.mark.slow
def test_figure_11_sphere_and_cylinder():
    # the paper: 0.50 for the sphere and 0.47 for the cylinder
    radius, force, modulus = FIGURE_11_BALL
    products = np.geomspace(1e-3, 1e-1, 5)
    sphere = films_of_ball(products, FIGURE_11_BALL, cells=1440)
    coarse = films_of_ball(products, FIGURE_11_BALL)
    cylinder = cylinder_of_sphere(force, radius, reduced_modulus=modulus)
    line = lubricated_films(
        products,
        cylinder_radius=float(cylinder.cylinder_radius),
        load_per_length=float(cylinder.load_per_length),
        reduced_modulus=modulus,
        nodes=300,
    )
    here, there, rough_grid = (x.couette + x.pressure_flow for x in (sphere, line, coarse))
    show(products, sphere, line, here, there)
    np.testing.assert_allclose(rough_grid, here, rtol=0.01)
    ratio, films = here / there, sphere.central_film / line.central_film
    accepted(
        {
            "slope of the sphere": np.log(here[-1] / here[0]) / np.log(100),
            "slope of the cylinder": np.log(there[-1] / there[0]) / np.log(100),
            "friction at 1e-3 N/m": ratio[0],
            "friction at 1e-1 N/m": ratio[-1],
            "central film at 1e-3 N/m": films[0],
            "central film at 1e-1 N/m": films[-1],
        },
        FIGURE_11,
    )


def show(products, sphere, line, here, there):
    print(
        "ηv, then sphere and cylinder: μ, Couette, pressure flow, asperity share, central and smallest film in µm"
    )
    for k, product in enumerate(products):
        row = [here[k], there[k]]
        for name in ("couette", "pressure_flow", "asperity_load_fraction"):
            row += [getattr(sphere, name)[k], getattr(line, name)[k]]
        films = [
            x
            for name in ("central_film", "minimum_film")
            for x in (getattr(sphere, name)[k], getattr(line, name)[k])
        ]
        print(f"{product:.2e}", *(f"{x:.5f}" for x in row), *(f"{x * 1e6:.2f}" for x in films))


def features(products, friction):
    """ηv at half of the first value, ηv and μ of the minimum."""
    fine = np.linspace(np.log(products[0]), np.log(products[-1]), 20001)
    curve = CubicSpline(np.log(products), np.log(friction))(fine)
    half = fine[np.argmax(curve < np.log(friction[0] / 2))]
    return np.exp([half, fine[np.argmin(curve)], curve.min()])


def films_of_ball(products, ball, law=None, cells=360):
    radius, force, modulus = ball
    return lubricated_point_films(
        products,
        normal_force=force,
        sphere_radius=radius,
        reduced_modulus=modulus,
        asperities=law,
        cells=cells,
    )


def both_curves(products, ball, skin, spectrum, stress, cells=360):
    """Films and friction of the sphere, and the Stribeck curve of the cylinder."""
    radius, force, _ = ball
    sphere = films_of_ball(products, ball, asperity_law(spectrum, skin), cells)
    contact = relative_contact_area(sphere.asperity_pressure, twice_stress_variance(spectrum, skin))
    friction = (
        stress * (contact * sphere.load_weight).sum(axis=1) / force + sphere.couette + sphere.pressure_flow
    )
    line = stribeck_curve(
        products,
        sphere_radius=radius,
        normal_force=force,
        skin=skin,
        spectrum=spectrum,
        frictional_shear_stress=stress,
        nodes=200,
    )
    return sphere, friction, line


@pytest.mark.slow
def test_skin_sphere_and_cylinder():
    products = np.array(
        [1e-6, 1e-4, 5e-4, 1e-3, 1.5e-3, 2e-3, 3e-3, 5e-3, 8e-3, 1.3e-2, 1.9e-2, 2.5e-2, 3.5e-2, 5e-2, 0.1]
    )
    case = GLASS_BALL, PAPER_SKIN, named_surface("paper_reference"), 15e6 * 6.59 / 6.48133
    sphere, friction, line = both_curves(products, *case, cells=1440)
    show(products, sphere, line, friction, line.friction_coefficient)
    _, coarse, _ = both_curves(products, *case)
    np.testing.assert_allclose(coarse, friction, rtol=0.01)
    here, there = features(products, friction), features(products, line.friction_coefficient)
    print("half of the plateau, minimum:", here, there)
    ratio = friction / line.friction_coefficient
    accepted(
        {
            "plateau": ratio[0],
            "speed at half of the plateau": here[0] / there[0],
            "speed of the minimum": here[1] / there[1],
            "friction at the minimum": here[2] / there[2],
            "friction at 1e-1 N/m": ratio[-1],
        },
        SKIN,
    )


# moduli of tissue and layer in Pa, rms height in m, radius in m, force in N: a/R from 0.08 to 0.6
@pytest.mark.slow
@pytest.mark.parametrize(
    ("bulk", "layer", "height", "radius", "force"),
    [
        (1.1e6, 38e6, 1.8e-6, 6.5e-3, 0.04),
        (1.3e5, 3.0e6, 1.4e-6, 15e-3, 0.21),
        (15e3, 49e6, 6.0e-6, 7.9e-3, 0.03),
        (1.0e5, 3.4e6, 19e-6, 1.1e-3, 0.03),
        (6.5e3, 1.6e6, 8.8e-6, 6.7e-3, 0.12),
    ],
)
def test_flank_of_other_balls(bulk, layer, height, radius, force):
    ball = (radius, force, reduced_modulus(bulk, 0.5))
    skin = LayeredSkin(young_modulus_layer=layer, young_modulus_bulk=bulk, layer_thickness=20e-6)
    spectrum = surface_from((height, 0.78, 1e3, 6.345e3, 1e9))
    # smooth surfaces would be 0.4 λ^0.6 a²/R apart; from where asperities keep them as far apart on, they lose the load
    hertz = sphere_contact(ball[1], ball[0], reduced_modulus=ball[2])
    rough = asperity_law(spectrum, skin).separation_at(float(hertz.maximum_pressure))
    middle = (rough * radius / hertz.contact_radius**2 / 0.4) ** (1 / 0.6) / number_of(1.0, *ball)
    products = middle * np.geomspace(0.2, 10.0, 7)
    sphere, _, line = both_curves(products, ball, skin, spectrum, 0.0, cells=700)
    speeds = []
    for fraction in (sphere.asperity_load_fraction, line.asperity_load_fraction):
        assert fraction[0] > 0.6 > 0.4 > fraction[-1]
        (root,) = CubicSpline(np.log(products), fraction - 0.5).roots(extrapolate=False)
        speeds.append(np.exp(root))
    print(
        f"a/R {hertz.contact_radius / radius:.2f}: half of the load at {speeds[0] / speeds[1]:.3f} of the speed"
    )
    assert FLANK[0] < speeds[0] / speeds[1] < FLANK[1]
