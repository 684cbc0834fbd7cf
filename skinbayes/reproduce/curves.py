"""Curves of the paper's figures, computed again: arrays in SI units."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import (
    effective_modulus,
    ellipse_factors,
    persson_contact_area,
    relative_contact_area,
    total_contact_area,
)
from skinbayes.lubrication import viscoelastic_films
from skinbayes.reproduce.choices import MAGNIFICATIONS, SHARPNESS, TRANSITION
from skinbayes.reproduce.paper import Paper
from skinbayes.wetting import young_modulus_at_humidity

STEEP = 0.49
"""tan δ of the tissue whose loss can be seen by eye, 60 % of an indentation."""


class Areas(NamedTuple):
    """Relative contact area against wavevector (Fig. 6), dimensionless and 1/m."""

    wavevector: FloatArray
    wet: FloatArray
    dry: FloatArray
    wet_plain: FloatArray
    dry_elastic: FloatArray


def areas(paper: Paper) -> Areas:
    """Fig. 6."""
    q = MAGNIFICATIONS[1:] * paper["wavevector-min"]
    wet, dry = paper.variance(paper.wet, q), paper.variance(paper.dry, q)
    return Areas(
        q,
        relative_contact_area(paper.pressure, wet),
        total_contact_area(paper.pressure, dry, yield_stress=paper["yield-stress"]),
        persson_contact_area(paper.pressure, wet),
        relative_contact_area(paper.pressure, dry),
    )


def moduli(paper: Paper) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Effective modulus of wet and dry skin, Pa, against wavevector, 1/m (Eq. 4)."""
    q = np.geomspace(paper["wavevector-min"] / 10, paper["wavevector-max"], 200)
    return q, {"wet": effective_modulus(paper.wet, q), "dry": effective_modulus(paper.dry, q)}


def ratios() -> tuple[FloatArray, FloatArray, FloatArray]:
    """a/b, C_e/C and C′_e/C′ (Fig. 19)."""
    ratio = np.linspace(1.0, 10.0, 91)
    factors = ellipse_factors(ratio)
    return ratio, factors.cylinder_radius, factors.cylinder_load


def layer_moduli(paper: Paper) -> tuple[FloatArray, FloatArray]:
    """Humidity and the assumed modulus of the layer, Pa (in place of Fig. 17)."""
    humidity = np.linspace(0.0, 1.0, 201)
    modulus = young_modulus_at_humidity(
        humidity,
        paper["young-modulus-layer-dry"],
        young_modulus_wet=paper["young-modulus-layer-wet"],
        transition_humidity=TRANSITION,
        sharpness=SHARPNESS,
    )
    return humidity, modulus


class Shape(NamedTuple):
    """Height of the cylinder and of the tissue above its undisturbed level against position, m (Fig. 14)."""

    position: FloatArray
    cylinder: FloatArray
    tissue: FloatArray


def shape(paper: Paper, tangent: float, product: float) -> Shape:
    """A smooth cylinder and the tissue below it at a speed times viscosity, N/m, heights from the cylinder's lowest point."""
    load, radius = paper.cylinder
    found = viscoelastic_films(
        paper.oil_speed,
        np.array([product]) / paper.oil_speed,
        load_per_length=float(load),
        cylinder_radius=float(radius),
        material=paper.tissue(tangent),
        nodes=160,
    )
    x = np.ravel(found.position)
    cylinder = x**2 / (2 * float(radius))
    return Shape(x, cylinder, cylinder - np.ravel(found.separation))
