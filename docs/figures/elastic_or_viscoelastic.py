"""Draw the figures of docs/elastic-or-viscoelastic.md, beside this file.

Run with ``python docs/figures/elastic_or_viscoelastic.py``.

A ball of 8 mm under 0.2 N slides at 1 cm/s on the wet skin of the paper; viscosity is varied. Loss is that of an indentation
that costs a quarter of its work, as in benchmarks/viscoelastic.py, from where the materials are taken.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib import colormaps, rc_context
from matplotlib.figure import Figure

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "benchmarks"))

from viscoelastic import (  # noqa: E402
    BULK,
    FORCE,
    LAYER,
    RADIUS,
    SHEAR_STRESS,
    SPEED,
    THICKNESS,
    calibrated,
    elastic,
    power_law,
    zener,
)

from skinbayes.contact import (  # noqa: E402
    ViscoelasticMaterial,
    ViscoelasticSkin,
    cylinder_of_sphere,
    line_contact,
)
from skinbayes.lubrication import asperity_law, viscoelastic_films, viscoelastic_stribeck_curve  # noqa: E402
from skinbayes.plot.style import SERIES, look, new_figure  # noqa: E402
from skinbayes.roughness import named_surface  # noqa: E402

SURFACE = named_surface("paper_reference")
PRODUCTS = np.geomspace(1e-6, 1.0, 61)
"""ηv of the curves, N/m."""
PROFILES = 10.0 ** np.arange(-6, 1)
"""ηv of the profiles, N/m."""


def skin_of(tissue: ViscoelasticMaterial, layer: float = LAYER) -> ViscoelasticSkin:
    """Skin with an elastic layer."""
    return ViscoelasticSkin(bulk=tissue, layer=elastic(layer), layer_thickness=THICKNESS)


def same_at_contact(maker, amount: float) -> ViscoelasticMaterial:
    """A lossy tissue with the modulus of the elastic one at v/b."""
    scale = BULK
    for _ in range(20):
        cylinder = cylinder_of_sphere(FORCE, RADIUS, reduced_modulus=BULK / 0.75)
        half_width = float(line_contact(*cylinder, reduced_modulus=BULK / 0.75).half_width)
        scale *= BULK / abs(maker(scale, amount).complex_modulus(SPEED / half_width))
    return maker(scale, amount)


def materials() -> dict[str, ViscoelasticMaterial]:
    """Tissues by the name they have in the figures."""
    return {
        "elastic": elastic(BULK),
        "one relaxation time of 0.7 s, 25 % loss": same_at_contact(zener(0.7), calibrated(zener(0.7), 0.25)),
        "power law, 25 % loss": same_at_contact(power_law, calibrated(power_law, 0.25)),
        "power law, 60 % loss": same_at_contact(power_law, calibrated(power_law, 0.6)),
    }


def curves() -> Figure:
    """Friction without hysteresis against ηv, and what would move it down."""
    tissues = materials() | {"elastic, six times softer": elastic(BULK / 6)}
    with look(7.0):
        figure = new_figure(7.0, 3.7, left=0.85, right=0.15, bottom=1.2, top=0.15)
        ax = figure.subplots()
        for (name, tissue), colour in zip(tissues.items(), SERIES, strict=False):
            found = viscoelastic_stribeck_curve(
                SPEED,
                PRODUCTS / SPEED,
                normal_force=FORCE,
                sphere_radius=RADIUS,
                spectrum=SURFACE,
                skin=skin_of(tissue, LAYER / 6 if "softer" in name else LAYER),
                frictional_shear_stress=SHEAR_STRESS,
                thickest_film=50.0,
            )
            friction = found.friction_coefficient - found.hysteresis
            ax.loglog(
                PRODUCTS, friction, color=colour, label=name, linestyle="--" if "softer" in name else "-"
            )
        ax.set_xlabel("speed × viscosity ηv [N/m]")
        ax.set_ylabel("friction without hysteresis")
        ax.set_xlim(PRODUCTS[0], PRODUCTS[-1])
        ax.grid()
        figure.legend(loc="lower center", ncols=2, bbox_to_anchor=(0.5, 0.0))
    return figure


def profiles() -> Figure:
    """Separation and asperity pressure across the contact, on elastic and on lossy tissue."""
    tissues = {name: materials()[name] for name in ("elastic", "power law, 60 % loss")}
    cylinder = cylinder_of_sphere(FORCE, RADIUS, reduced_modulus=BULK / 0.75)
    with look(7.0):
        figure = new_figure(
            7.0, 4.8, left=0.75, right=0.15, bottom=0.95, top=0.3, panels=(2, 2), between=(0.25, 0.2)
        )
        axes = figure.subplots(2, 2, sharex=True, sharey="row")
        shades = colormaps["viridis"](np.linspace(0.0, 0.9, len(PROFILES)))
        for column, (name, tissue) in enumerate(tissues.items()):
            held = skin_of(tissue).at_frequency(
                SPEED / float(line_contact(*cylinder, reduced_modulus=BULK / 0.75).half_width)
            )
            films = viscoelastic_films(
                SPEED,
                PROFILES / SPEED,
                load_per_length=float(cylinder.load_per_length),
                cylinder_radius=float(cylinder.cylinder_radius),
                material=tissue,
                asperities=asperity_law(SURFACE, held),
            )
            for i, product in enumerate(PROFILES):
                x, label = films.position[i] * 1e3, f"$10^{{{np.log10(product):.0f}}}$ N/m"
                axes[0, column].semilogy(x, films.separation[i] * 1e6, color=shades[i], label=label)
                axes[1, column].plot(x, films.asperity_pressure[i] / 1e3, color=shades[i])
            axes[0, column].set_title(name)
            axes[1, column].set_xlabel("x [mm], liquid enters at the left")
            for ax in axes[:, column]:
                ax.set_xlim(-4.5, 3.5)
                ax.grid()
        axes[0, 0].set_ylim(8.0, 2000.0)
        axes[0, 0].set_ylabel("mean separation [µm]")
        axes[1, 0].set_ylabel("asperity pressure [kPa]")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(
            handles, [f"ηv = {x}" for x in labels], loc="lower center", ncols=4, bbox_to_anchor=(0.5, 0.0)
        )
    return figure


def main() -> None:
    """Write all figures."""
    for name, draw in {"stribeck-viscoelastic": curves, "profiles-viscoelastic": profiles}.items():
        figure = draw()
        with look(7.0), rc_context({"svg.hashsalt": "skinbayes", "svg.fonttype": "path"}):
            figure.savefig(HERE / f"{name}.svg", metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main()
