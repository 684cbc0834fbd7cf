"""What the friction of a finger pad owes to the length of its inlet and to the profile of its pressure.

Prints ηv at half of the plateau, the minimum, and friction and film far above it, over those of an inlet of one contact radius:
`python benchmarks/pad.py`. A pad of 50 kPa under 173 µm of 7 MPa, 10 MPa of frictional shear stress, `paper_reference`.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from scipy.interpolate import CubicSpline

from skinbayes.contact import LayeredSkin, relative_contact_area, sphere_of_contact, twice_stress_variance
from skinbayes.lubrication import asperity_law, lubricated_point_films, point_newton
from skinbayes.roughness import named_surface

SURFACE = named_surface("paper_reference")
SKIN = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=50e3, layer_thickness=173e-6)
STRESS = 10e6
PADS = ((0.3, 200e-6), (1.0, 200e-6), (3.0, 200e-6))
LENGTHS = (0.2, 0.5, 2.0, 5.0)
CELLS = 400


@contextmanager
def flatter_pressure() -> Iterator[None]:
    """Films under a body of fourth power with the same contact and load: P = (5/9)(1 + 2 r²) √(1 − r²) without liquid."""
    plain = point_newton.PointSolver.__init__

    def fourth(self, grid, law, *positional, **named):  # type: ignore[no-untyped-def]
        plain(self, grid, law, *positional, **named)
        self._parabola = 5 / 16 * grid.radius**4

    point_newton.PointSolver.__init__ = fourth  # type: ignore[method-assign]
    try:
        yield
    finally:
        point_newton.PointSolver.__init__ = plain  # type: ignore[method-assign]


def curve(force: float, area: float, length: float) -> dict[str, float]:
    """Half of the plateau, minimum, and friction and central film at 30 times the speed of the minimum."""
    radius = np.sqrt(area / np.pi)
    modulus = float(SKIN.contact_modulus)
    products = np.geomspace(1e-5, 3.0, 40)
    films = lubricated_point_films(
        products, normal_force=force, sphere_radius=float(sphere_of_contact(force, radius, reduced_modulus=modulus)),
        reduced_modulus=modulus, asperities=asperity_law(SURFACE, SKIN), cells=CELLS, inlet_length=length * radius,
    )  # fmt: skip
    real = relative_contact_area(films.asperity_pressure, float(twice_stress_variance(SURFACE, SKIN)))
    boundary = STRESS * (real * films.load_weight).sum(axis=1) / force
    friction = boundary + films.couette + films.pressure_flow
    places = np.linspace(np.log(products[0]), np.log(products[-1]), 4001)
    total, film = (CubicSpline(np.log(products), np.log(x))(places) for x in (friction, films.central_film))
    half = float(np.exp(np.interp(-boundary[0] / 2, -boundary, np.log(products))))
    lowest = int(np.argmin(total))
    return {
        "half": half,
        "minimum at": float(np.exp(places[lowest])),
        "minimum": float(np.exp(total[lowest])),
        "friction at 0.5": float(np.exp(np.interp(np.log(0.5), places, total))),
        "film at 0.5": float(np.exp(np.interp(np.log(0.5), places, film))),
    }


def main() -> None:
    """Print the tables."""
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    for force, area in PADS:
        radius = np.sqrt(area / np.pi)
        ball = float(sphere_of_contact(force, radius, reduced_modulus=float(SKIN.contact_modulus)))
        reference = curve(force, area, 1.0)
        print(f"\n{force:g} N on {area * 1e6:g} mm2, a/R = {radius / ball:.3f}")
        print("  ".join(f"{name} {value:.4g}" for name, value in reference.items()))
        for length in LENGTHS:
            found = curve(force, area, length)
            ratios = "  ".join(f"{name} {found[name] / reference[name]:.3f}" for name in found)
            print(f"inlet {length:g} a   {ratios}")
        with flatter_pressure():
            found = curve(force, area, 1.0)
        print(
            "flatter pressure   " + "  ".join(f"{name} {found[name] / reference[name]:.3f}" for name in found)
        )


if __name__ == "__main__":
    main()
