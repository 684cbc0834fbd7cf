"""Tables of films for tests: small, and built once."""

from functools import lru_cache

import numpy as np
from line_curves import FilmTablePlan
from named_fields import surface_from

from skinbayes.contact import LayeredSkin
from skinbayes.lubrication import (
    FILM_PARAMETERS,
    FilmTable,
    build_film_table,
)
from skinbayes.roughness import SelfAffineSpectrum, named_surface

RANGES = {
    "young_modulus_layer": (7e6, 7e6),
    "young_modulus_bulk": (2e4, 6e4),
    "rms_height": (15e-6, 25e-6),
    "sphere_radius": (8e-3, 8e-3),
    "normal_force": (0.2, 0.6),
    "layer_thickness": (20e-6, 20e-6),
}


@lru_cache(maxsize=1)
def small_table() -> FilmTable:
    """Bulk modulus, roughness and force vary a little."""
    counts = {"young_modulus_bulk": 5, "rms_height": 4, "normal_force": 4}
    return build_film_table(
        FilmTablePlan(RANGES, spectrum=named_surface("paper_reference"), counts=counts, checked=20)
    )


def draw(rng: np.random.Generator, vectors: int, rows: int = 0) -> dict[str, np.ndarray]:
    """Parameters within the ranges, shape ``(vectors, 1)``; forces differ from row to row if there are rows."""
    drawn = {}
    for name in FILM_PARAMETERS:
        low, high = np.log(RANGES[name])
        shape = (vectors, rows) if rows and name == "normal_force" else (vectors, 1)
        drawn[name] = np.exp(rng.uniform(low, high, shape))
    return drawn


def skin_of(parameters: dict[str, float]) -> LayeredSkin:
    return LayeredSkin(
        young_modulus_layer=parameters["young_modulus_layer"],
        young_modulus_bulk=parameters["young_modulus_bulk"],
        layer_thickness=parameters["layer_thickness"],
    )


def spectrum_of(parameters: dict[str, float]) -> SelfAffineSpectrum:
    shape = named_surface("paper_reference")
    return surface_from(
        (
            parameters["rms_height"],
            shape.hurst_exponent,
            shape.wavevector_min,
            shape.wavevector_rolloff,
            shape.wavevector_max,
        )
    )
