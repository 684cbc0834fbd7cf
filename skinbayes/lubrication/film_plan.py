"""What a table of films is to hold, and everything that its numbers depend on."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.correction import AREA_CORRECTION
from skinbayes.contact.homogeneous import HomogeneousSolid
from skinbayes.contact.layered import LayeredSkin
from skinbayes.contact.line_contact import cylinder_of_sphere
from skinbayes.contact.solid import ElasticSolid, reduced_modulus
from skinbayes.contact.variance import twice_stress_variance
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import AsperityLaw, asperity_law
from skinbayes.lubrication.contact_films import CONTACTS, POINT
from skinbayes.lubrication.film_axes import (
    FILM_PARAMETERS,
    HOMOGENEOUS_PARAMETERS,
    FilmAxes,
    film_axes,
    film_parameters,
    range_logarithms,
)
from skinbayes.lubrication.film_sweeps import Ball
from skinbayes.lubrication.film_table import FASTEST, FASTEST_OF_FACTORS, SLOWEST, VERSION
from skinbayes.lubrication.flow_factors import FlowFactors, PatirCheng
from skinbayes.lubrication.gap_flow import TabulatedFlowFactors, tabulated_flow_factors
from skinbayes.lubrication.stribeck import LARGEST_STRAIN
from skinbayes.roughness import rms_height
from skinbayes.roughness.spectrum import PowerSpectrum

FEW_CELLS = 200
"""Cells of half a point contact that is solved at all nodes; what more of them change is smoother."""

_PLACES = 257  # of the band at which the spectrum is compared


@dataclass(frozen=True, eq=False)
class FilmTablePlan:
    """A table of the films under balls on rough skin, or another solid, before it is built (Sect. 6 of the paper).

    Attributes
    ----------
    ranges : smallest and largest value of each of the `FILM_PARAMETERS`, or of the `HOMOGENEOUS_PARAMETERS`, SI (Pa, m, N);
        equal for a fixed one
    spectrum : power spectrum of one surface, C in m^4; its shape counts, the rms height comes from the ranges
    poisson_ratio_layer, poisson_ratio_bulk : ν0, ν1, dimensionless; ν1 is that of a homogeneous solid
    contact : "point", the ball as it is, or "line", the cylinder of Eq. 9 of the paper
    area_correction : γ, dimensionless, 0 < γ ≤ 1
    flow_factors : "none", "patir-cheng", or "gap" from the statistics of the gaps
    counts : nodes of an axis, dimensionless, by its name; see `film_axes`
    speeds : number of speeds, dimensionless
    nodes : places across the contact, dimensionless; with 96 friction is within 0.2 % of that on many more
    checked : number of random places, dimensionless, at which the table is compared with direct solutions
    cells : of half a point contact, dimensionless
    inlet_length : distance from a point contact, m, at which liquid and drag end; None for liquid without end
    largest_strain : b/Rc, dimensionless, that the table has to reach

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6).

    Examples
    --------
    >>> from skinbayes.roughness import named_surface
    >>> ranges = {"young_modulus_layer": (7e6, 7e6), "young_modulus_bulk": (1e4, 1e5), "rms_height": (1e-5, 3e-5),
    ...           "sphere_radius": (8e-3, 8e-3), "normal_force": (0.2, 0.2), "layer_thickness": (2e-5, 2e-5)}
    >>> FilmTablePlan(ranges, spectrum=named_surface("paper_reference")).key()["axes"]
    {'young_modulus_bulk': 7, 'rms_height': 5}
    """

    ranges: Mapping[str, tuple[float, float]]
    _: KW_ONLY
    spectrum: PowerSpectrum
    poisson_ratio_layer: float = 0.5
    poisson_ratio_bulk: float = 0.5
    contact: str = POINT
    area_correction: float = AREA_CORRECTION
    flow_factors: str = "none"
    counts: Mapping[str, int] | None = None
    speeds: int = 31
    nodes: int = 96
    checked: int = 120
    cells: int = 600
    inlet_length: float | None = None
    largest_strain: float = LARGEST_STRAIN

    def __post_init__(self) -> None:
        if self.contact not in CONTACTS:
            raise InputError(
                f"contact is {self.contact!r:.60}, but must be {' or '.join(map(repr, CONTACTS))}."
            )

    @cached_property
    def axes(self) -> FilmAxes:
        """Axes of the table, see `film_axes`; raises `InputError` if a range is wrong."""
        range_logarithms(self.ranges)
        named = film_parameters(self.ranges, (1.0, 1.0))
        # contact is fullest for the softest layer on the stiffest tissue
        bulk = named["young_modulus_bulk"][1]
        layer = max(named["young_modulus_layer"][0], bulk)
        skin = self._solid(layer, bulk, named["layer_thickness"][0])
        return film_axes(
            self.ranges,
            self.poisson_ratio_bulk,
            largest_strain=self.largest_strain,
            counts=self.counts,
            stress_scale=float(
                np.sqrt(twice_stress_variance(self.spectrum, skin)) / (layer * self._rms_height)
            ),
            # where liquid ends at a given distance from the contact, its radius, through F R/E1, says where
            radius_matters=self.contact == POINT and self.inlet_length is None,
        )

    def key(self) -> dict[str, Any]:
        """Numbers (SI: Pa, m, N, or dimensionless) and texts that JSON can hold; equal for equal tables.

        The version stands for the code of the film solver, the contact theory and the table; it changes whenever the numbers do.
        """
        known = [name for name in (*FILM_PARAMETERS, *HOMOGENEOUS_PARAMETERS[:1]) if name in self.ranges]
        ends = float(self.spectrum.wavevector_min), float(self.spectrum.wavevector_max)
        power = self.spectrum.power(np.geomspace(*ends, _PLACES)) / self._rms_height**2
        numbers = ("poisson_ratio_layer", "poisson_ratio_bulk", "area_correction", "largest_strain")
        return {
            "version": VERSION,
            "ranges": {name: [float(end) for end in self.ranges[name]] for name in known},
            "axes": dict(zip(self.axes.names, self.axes.counts, strict=True)),
            "band": list(ends),
            "spectrum": hashlib.sha256(np.ascontiguousarray(power, dtype="<f8").tobytes()).hexdigest(),
            **{name: float(getattr(self, name)) for name in numbers},
            **{name: getattr(self, name) for name in ("speeds", "nodes", "checked", "contact")},
            **({"cells": [FEW_CELLS, self.cells]} if self.contact == POINT else {}),
            **({} if self.inlet_length is None else {"inlet_length": self.inlet_length}),
            **({} if self.flow_factors == "none" else {"flow_factors": self.flow_factors}),
        }

    def ball(self, log_parameters: FloatArray) -> Ball:
        """Ball at parameters given by their ln, SI, shape ``(6,)``.

        Asperity laws of one ratio of moduli and one thickness follow from each other by scaling: they are kept, there are few.
        """
        layer, bulk, height, radius, force, thickness = np.exp(log_parameters).tolist()
        place = (round(float(log_parameters[0] - log_parameters[1]), 9), round(float(log_parameters[5]), 9))
        if place not in self._materials:
            skin = self._solid(layer, bulk, thickness)
            law = asperity_law(self.spectrum, skin, area_correction=self.area_correction)
            variance = float(twice_stress_variance(self.spectrum, skin))
            self._materials[place] = law, variance, layer * self._rms_height
        law, variance, known_stiffness = self._materials[place]
        stiffness = layer * height
        times = stiffness / known_stiffness
        modulus = float(reduced_modulus(bulk, self.poisson_ratio_bulk))
        cylinder = cylinder_of_sphere(force, radius, reduced_modulus=modulus)
        return Ball(
            law.scaled(self._rms_height / height, 1 / times),
            variance * times * times,
            self.area_correction,
            stiffness,
            force,
            radius,
            float(cylinder.cylinder_radius),
            float(cylinder.load_per_length),
            modulus,
            self.inlet_length,
            self._factors(place, layer, bulk, thickness, height),
        )

    def _factors(
        self, place: tuple[float, float], layer: float, bulk: float, thickness: float, height: float
    ) -> FlowFactors | None:
        """Flow factors of a material, which depend on ū/h alone: those of one ratio of moduli and one thickness are kept."""
        if self.flow_factors == "none":
            return None
        if self.flow_factors == "patir-cheng":
            return PatirCheng(height)
        if place not in self._gap_factors:
            skin = self._solid(layer, bulk, thickness)
            self._gap_factors[place] = tabulated_flow_factors(
                self.spectrum, skin, area_correction=self.area_correction
            )
        return self._gap_factors[place].scaled(height / self._rms_height)

    @cached_property
    def _gap_factors(self) -> dict[tuple[float, float], TabulatedFlowFactors]:
        """Flow factors at the rms height of the spectrum."""
        return {}

    @property
    def fastest(self) -> float:
        """The last speed in the unit of a material, dimensionless."""
        return FASTEST if self.flow_factors == "none" else FASTEST_OF_FACTORS

    @property
    def speeds_solved(self) -> int:
        """Number of speeds up to the last one, dimensionless: ``speeds`` up to that without flow factors."""
        more = (self.fastest - FASTEST) / (FASTEST - SLOWEST) * (self.speeds - 1)
        return self.speeds + round(more)

    @cached_property
    def _materials(self) -> dict[tuple[float, float], tuple[AsperityLaw, float, float]]:
        """Asperity law, p in Pa against ū in m, V, Pa², and E0 h_rms, Pa m, at the rms height of the spectrum."""
        return {}

    @cached_property
    def _rms_height(self) -> float:
        return float(rms_height(self.spectrum))

    def _solid(self, layer: float, bulk: float, thickness: float) -> ElasticSolid:
        if "young_modulus" in self.ranges:
            return HomogeneousSolid(young_modulus=bulk, poisson_ratio=self.poisson_ratio_bulk)
        return LayeredSkin(
            young_modulus_layer=layer,
            young_modulus_bulk=bulk,
            poisson_ratio_layer=self.poisson_ratio_layer,
            poisson_ratio_bulk=self.poisson_ratio_bulk,
            layer_thickness=thickness,
        )
