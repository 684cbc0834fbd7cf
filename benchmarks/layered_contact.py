"""What layers do to the contact of a ball as a whole, and which half-space stands for them under a lubricated ball.

Run with ``python benchmarks/layered_contact.py``. A ball of 8 mm under 0.2 N rests on stacks of layers, the stratum corneum of
the paper and examples of tissue of 20 kPa on something else. Printed are the contact over that of Hertz on the tissue, with a
solution by boundary elements beside it, and by how much the friction of the lubricated ball, its roughness that of the paper,
is missed from 1e-5 to 0.3 N/m if one half-space takes the place of the layers: that of the tissue, that with the same contact
radius, that with the same indentation, and the tissue under another ball that has the same contact radius. The films they are
held against are solved with the deflection of the layers, ``(1/π) ∫p(x′) ∫₀^∞ J0(q|x − x′|)/E_eff(q) dq dA``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import j0

from skinbayes.contact import LayeredSkin, layered_modulus, layered_sphere_contact, sphere_contact
from skinbayes.lubrication import CELLS, asperity_law
from skinbayes.lubrication.point_film import point_films_of
from skinbayes.lubrication.point_grid import PointGrid, point_grid
from skinbayes.lubrication.point_newton import LOAD
from skinbayes.roughness import named_surface

FORCE, RADIUS, TISSUE = 0.2, 8e-3, 20e3 / 0.75
PRODUCTS = np.geomspace(1e-5, 0.3, 19)  # N/m
PLATEAU = 1.447  # friction of asperities that carry everything
FAR = 50.0  # contact radii, beyond which the layers are not seen
STACKS: dict[str, tuple[list[float], list[float]]] = {
    "20 µm of 7 MPa on 20 kPa": ([7e6, 20e3], [20e-6]),
    "2 mm of 20 kPa on 80 kPa": ([20e3, 80e3], [2e-3]),
    "2 mm of 20 kPa on bone (2 GPa)": ([20e3, 2e9], [2e-3]),
    "5 mm of 20 kPa on bone": ([20e3, 2e9], [5e-3]),
    "2 mm of 20 kPa on 2 kPa": ([20e3, 2e3], [2e-3]),
    "5 mm of 20 kPa on 2 kPa": ([20e3, 2e3], [5e-3]),
}
"""Young's moduli, Pa, from the surface down, and thicknesses, m; examples, all incompressible."""


class Layers:
    """A stack of layers in the units of a contact with a half-space of E*, Pa, whose radius is a, m."""

    def __init__(self, stack: dict[str, Any], modulus: float, radius: float) -> None:
        surface, deepest = (modulus / (stack["moduli"][n] / 0.75) for n in (0, -1))
        self.surface, self.deepest = surface, deepest
        self.rest = self._rest(stack, modulus, radius)

    def _rest(self, stack: dict[str, Any], modulus: float, radius: float) -> CubicSpline:
        """∫(E*/E_eff − E*/E0*) J0(qρ) dq against ρ."""
        end = 40 * radius / stack["thicknesses"][0]
        edges = np.concatenate([[1e-9], np.geomspace(1e-4, 0.05, 60)[:-1], np.linspace(0.05, end, 6000)])
        nodes, weights = np.polynomial.legendre.leggauss(6)
        half = np.diff(edges) / 2
        q = ((edges[1:] + edges[:-1])[:, None] / 2 + half[:, None] * nodes).ravel()
        part = modulus / layered_modulus(q / radius, **stack).real - self.surface
        part *= (half[:, None] * weights).ravel()
        places = np.concatenate([[0.0], np.geomspace(1e-3, 1.0, 160), np.geomspace(1.03, FAR, 160)])
        return CubicSpline(places, [part @ j0(q * place) for place in places])

    def __call__(self, grid: PointGrid) -> PointGrid:
        """The grid with the kernel of the layers, by Gauss's rule in each cell."""
        rays = grid.rays
        x, y = grid.radius * np.cos(grid.angle), grid.radius * np.sin(grid.angle)
        nodes, weights = np.polynomial.legendre.leggauss(8)
        kernel = self.surface * grid.kernel
        for cell in range(x.size):
            inner, outer = grid.faces[cell // rays : cell // rays + 2]
            r = ((outer + inner) / 2 + (outer - inner) / 2 * nodes)[:, None]
            phi = grid.angle[cell] + np.pi / rays / 2 * nodes
            area = (weights * r[:, 0] * (outer - inner) / 2)[:, None] * (weights * np.pi / rays / 2)
            for side in (1, -1):
                away = np.hypot(
                    x[:, None] - (r * np.cos(phi)).ravel(), y[:, None] - side * (r * np.sin(phi)).ravel()
                )
                beyond = (self.deepest - self.surface) / np.maximum(away, 1e-9)
                seen = np.where(away < FAR, self.rest(np.minimum(away, FAR)), beyond)
                kernel[:, cell] += 2 / np.pi**2 * seen @ area.ravel()
        return grid._replace(kernel=kernel)


def dry(grid: PointGrid) -> tuple[float, float]:
    """Radius of the contact, to half a ring, and indentation over a²/R, from boundary elements."""
    touching = grid.radius < 1
    while True:
        count = np.count_nonzero(touching)
        matrix = np.zeros((count + 1, count + 1))
        matrix[:count, :count] = grid.kernel[np.ix_(touching, touching)]
        matrix[:count, count], matrix[count, :count] = 1, grid.area[touching]
        solved = np.linalg.solve(matrix, np.append(-np.square(grid.radius[touching]) / 2, LOAD))
        pressure = np.zeros(grid.radius.size)
        pressure[touching] = solved[:-1]
        gap = solved[-1] + np.square(grid.radius) / 2 + grid.kernel @ pressure
        now = np.where(touching, pressure > 0, gap < -1e-12)
        if (now == touching).all():
            return float(grid.faces[np.searchsorted(grid.faces, grid.radius[touching].max())]), -float(
                solved[-1]
            )
        touching = now


def friction(modulus: float, radius: float = RADIUS, layers: Layers | None = None) -> np.ndarray:
    """Friction of the lubricated ball, the boundary part as the load on asperities."""
    skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    films, _ = point_films_of(
        PRODUCTS, normal_force=FORCE, sphere_radius=radius, reduced_modulus=modulus, cells=CELLS, rheology=None,
        asperities=asperity_law(named_surface("paper_reference"), skin), flow_factors=None, respond=layers,
    )  # fmt: skip
    return PLATEAU * films.asperity_load_fraction + films.couette + films.pressure_flow


def main() -> None:
    """Print the table."""
    hertz = sphere_contact(FORCE, RADIUS, reduced_modulus=TISSUE)
    print(
        "over Hertz on the tissue: radius, elements; largest pressure; indentation, elements; equivalent modulus"
    )
    print("friction missed at worst by: tissue, same radius, same indentation, other ball")
    for name, (moduli, thicknesses) in STACKS.items():
        stack: dict[str, Any] = {
            "moduli": moduli, "poisson_ratios": [0.5] * len(moduli), "thicknesses": thicknesses,
        }  # fmt: skip
        contact = layered_sphere_contact(FORCE, RADIUS, **stack)
        modulus, depth = float(contact.equivalent_modulus[0]), float(contact.indentation[0])
        size = float(contact.contact_radius[0])
        layers = Layers(stack, modulus, size)
        edge, sinking = dry(layers(point_grid(50, 8, 0.05, 8.0)))
        by_depth = 3 * FORCE / (4 * np.sqrt(RADIUS) * depth**1.5)
        right = friction(modulus, layers=layers)
        others = (
            friction(TISSUE), friction(modulus), friction(by_depth), friction(TISSUE, RADIUS * TISSUE / modulus)
        )  # fmt: skip
        print(
            f"{name:32s} {size / hertz.contact_radius:.3f} {edge * size / hertz.contact_radius:.3f};"
            f" {contact.maximum_pressure[0] / hertz.maximum_pressure:.3f}; {depth / hertz.indentation:.4f}"
            f" {sinking * size * size / RADIUS / hertz.indentation:.4f}; {modulus / TISSUE:.3f} |"
            + "".join(f" {np.nanmax(np.abs(other / right - 1)):6.1%}" for other in others),
            flush=True,
        )


if __name__ == "__main__":
    main()
