"""What a table of films depends on, for those who keep tables."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from skinbayes.contact.correction import AREA_CORRECTION
from skinbayes.lubrication.film_axes import FILM_PARAMETERS, HOMOGENEOUS_PARAMETERS
from skinbayes.lubrication.film_sweeps import Surface
from skinbayes.lubrication.film_table import VERSION
from skinbayes.lubrication.film_table_build import CHECKED, SPEEDS, TABLE_NODES
from skinbayes.lubrication.stribeck import LARGEST_STRAIN
from skinbayes.roughness.spectrum import PowerSpectrum

_PLACES = 257  # of the band at which the spectrum is compared


def film_table_key(
    ranges: Mapping[str, tuple[float, float]],
    spectrum: PowerSpectrum,
    *,
    poisson_ratio_layer: float = 0.5,
    poisson_ratio_bulk: float = 0.5,
    area_correction: float = AREA_CORRECTION,
    counts: Mapping[str, int] | None = None,
    speeds: int = SPEEDS,
    nodes: int = TABLE_NODES,
    checked: int = CHECKED,
    largest_strain: float = LARGEST_STRAIN,
) -> dict[str, Any]:
    """Everything that the numbers of a table of films depend on, for a key of a cache (Sect. 6 of the paper).

    The arguments are those of `build_film_table`. The version stands for the code of the film solver, the contact theory and
    the table; it changes whenever the numbers do.

    Parameters
    ----------
    ranges : smallest and largest value of each parameter, SI (Pa, m, N)
    spectrum : power spectrum of one surface, C in m^4
    poisson_ratio_layer, poisson_ratio_bulk : ν0, ν1, dimensionless
    area_correction : γ, dimensionless
    counts : nodes of an axis, dimensionless, by its name
    speeds : number of speeds, dimensionless
    nodes : places across the contact, dimensionless
    checked : number of random places, dimensionless
    largest_strain : b/Rc, dimensionless, that the table has to reach

    Returns
    -------
    key : numbers (SI: Pa, m, N, or dimensionless) and texts that JSON can hold; equal for equal tables

    Raises
    ------
    InputError
        if a range is wrong

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6).

    Examples
    --------
    >>> from skinbayes.roughness import named_surface
    >>> ranges = {"young_modulus_layer": (7e6, 7e6), "young_modulus_bulk": (1e4, 1e5), "rms_height": (1e-5, 3e-5),
    ...           "sphere_radius": (8e-3, 8e-3), "normal_force": (0.2, 0.2), "layer_thickness": (2e-5, 2e-5)}
    >>> film_table_key(ranges, named_surface("paper_reference"))["axes"]
    {'young_modulus_bulk': 7, 'rms_height': 5}
    """
    surface = Surface(
        spectrum, poisson_ratio_layer, poisson_ratio_bulk, area_correction, "young_modulus" in ranges
    )
    axes = surface.axes(ranges, largest_strain, counts)
    known = [name for name in (*FILM_PARAMETERS, *HOMOGENEOUS_PARAMETERS[:1]) if name in ranges]
    ends = float(spectrum.wavevector_min), float(spectrum.wavevector_max)
    power = spectrum.power(np.geomspace(*ends, _PLACES)) / surface.rms_height**2
    return {
        "version": VERSION,
        "ranges": {name: [float(end) for end in ranges[name]] for name in known},
        "axes": dict(zip(axes.names, axes.counts, strict=True)),
        "band": list(ends),
        "spectrum": hashlib.sha256(np.ascontiguousarray(power, dtype="<f8").tobytes()).hexdigest(),
        "poisson_ratio_layer": float(poisson_ratio_layer),
        "poisson_ratio_bulk": float(poisson_ratio_bulk),
        "area_correction": float(area_correction),
        "speeds": speeds,
        "nodes": nodes,
        "checked": checked,
        "largest_strain": float(largest_strain),
    }
