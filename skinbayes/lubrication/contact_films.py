"""Films under a ball, either as it is or as the cylinder that the paper takes for it."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.line_contact import cylinder_of_sphere
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import AsperityLaw
from skinbayes.lubrication.film import NODES, LubricatedFilms, lubricated_films
from skinbayes.lubrication.flow_factors import FlowFactors
from skinbayes.lubrication.point_film import CELLS, LubricatedPointFilms, lubricated_point_films
from skinbayes.lubrication.rheology import Rheology

POINT, LINE = CONTACTS = ("point", "line")
"""The ball in two dimensions, and the cylinder of Eq. 9 of the paper."""


def contact_films(
    speed_viscosity_product: FloatArray,
    *,
    normal_force: float,
    sphere_radius: float,
    reduced_modulus: float,
    asperities: AsperityLaw | None,
    contact: str = POINT,
    flow_factors: FlowFactors | None = None,
    rheology: Rheology | None = None,
    nodes: int = NODES,
    cells: int = CELLS,
    inlet_length: float | None = None,
) -> tuple[LubricatedFilms | LubricatedPointFilms, float]:
    """Films under a ball, and the load over which its friction is counted: F_N, N, or f_N, N/m, of the cylinder.

    The arguments are those of `lubricated_point_films`; ``nodes`` are those of a line contact, ``cells`` those of a ball.
    """
    if contact == POINT:
        return lubricated_point_films(
            speed_viscosity_product,
            normal_force=normal_force,
            sphere_radius=sphere_radius,
            reduced_modulus=reduced_modulus,
            asperities=asperities,
            flow_factors=flow_factors,
            rheology=rheology,
            cells=cells,
            inlet_length=inlet_length,
        ), normal_force
    if contact != LINE:
        raise InputError(f"contact is {contact!r:.60}, but must be {' or '.join(map(repr, CONTACTS))}.")
    cylinder = cylinder_of_sphere(normal_force, sphere_radius, reduced_modulus=reduced_modulus)
    load = float(cylinder.load_per_length)
    return lubricated_films(
        speed_viscosity_product,
        cylinder_radius=float(cylinder.cylinder_radius),
        load_per_length=load,
        reduced_modulus=reduced_modulus,
        asperities=asperities,
        flow_factors=flow_factors,
        rheology=rheology,
        nodes=nodes,
        inlet_length=inlet_length,
    ), load


def weighted(values: FloatArray, load_weight: FloatArray) -> FloatArray:
    """Integrals of values of shape ``(K, n)``, with weights of shape ``(n,)`` or, of a ball, ``(K, n)``."""
    if load_weight.ndim == 1:
        return np.asarray(values @ load_weight)
    return np.asarray((values * load_weight).sum(axis=1))
