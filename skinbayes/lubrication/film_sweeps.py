"""Direct solutions that tables of films are made of and checked with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from skinbayes.arrays import FloatArray
from skinbayes.contact.area import relative_contact_area
from skinbayes.contact.homogeneous import HomogeneousSolid
from skinbayes.contact.layered import LayeredSkin
from skinbayes.contact.line_contact import cylinder_of_sphere, line_contact
from skinbayes.contact.solid import ElasticSolid, reduced_modulus
from skinbayes.contact.variance import twice_stress_variance
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import AsperityLaw, asperity_table, law_of_table
from skinbayes.lubrication.film import lubricated_films, lubrication_number_per_product
from skinbayes.lubrication.film_axes import FilmAxes, film_axes, film_parameters, range_logarithms
from skinbayes.roughness.spectrum import PowerSpectrum

CENTRAL, BOUNDARY, COUETTE, PRESSURE_FLOW, MINIMUM, FRACTION = range(6)
"""Outputs of a film: ln of H under the middle, E0 h ∫A dX/∫P dX, ∫θ dX/H, ∫H dP_f, smallest H, load fraction of asperities."""

HALF, FAINT = 0.5, 1e-3
"""Load fractions of the asperities at the two lubrication numbers that a table counts speeds from."""

_MORE_NODES = (0, 17, 34)  # tried one after the other where a film is not found
_THINNEST = (
    0.03  # of the decay length: where contact is nearly complete the separation vanishes, the film does not
)
_LARGEST_ODDS = 20.0  # |ln share/(1 − share)| that has digits
_LEAST = 1e-300
_ANCHOR_SPEEDS = np.linspace(-5.0, 11.0, 17)  # ln λ about a guess of where asperities carry half the load
_ANCHOR_NODES = 56


@dataclass(frozen=True, eq=False)
class Surface:
    """What a table of films takes as given: the shape of the spectrum, Poisson ratios and γ.

    Attributes
    ----------
    spectrum : power spectrum of one surface, C in m^4; its rms height is a scale only
    poisson_ratio_layer, poisson_ratio_bulk : ν0, ν1, dimensionless
    area_correction : γ, dimensionless
    homogeneous : the solid has no layer; then E is E1, and ν is ν1
    """

    spectrum: PowerSpectrum
    poisson_ratio_layer: float
    poisson_ratio_bulk: float
    area_correction: float
    homogeneous: bool = False

    @property
    def rms_height(self) -> float:
        """h_rms of the spectrum as it is given, m."""
        return float(np.sqrt(2 * np.pi * self.spectrum.partial_moment(1.0)))

    def stress_scale(self, ranges: Mapping[str, tuple[float, float]]) -> float:
        """√V/(E0 h_rms), 1/m, for the softest layer on the stiffest tissue of some ranges of the parameters, SI."""
        range_logarithms(ranges)
        named = film_parameters(ranges, (1.0, 1.0))
        bulk = named["young_modulus_bulk"][1]
        layer = max(named["young_modulus_layer"][0], bulk)
        skin = self.solid(layer, bulk, named["layer_thickness"][0])
        return float(np.sqrt(twice_stress_variance(self.spectrum, skin)) / (layer * self.rms_height))

    def axes(
        self,
        ranges: Mapping[str, tuple[float, float]],
        largest_strain: float,
        counts: Mapping[str, int] | None = None,
    ) -> FilmAxes:
        """Axes of a table for some ranges of the parameters, SI, see `film_axes`."""
        return film_axes(
            ranges,
            self.poisson_ratio_bulk,
            largest_strain=largest_strain,
            counts=counts,
            stress_scale=self.stress_scale(ranges),
        )

    def solid(self, layer: float, bulk: float, thickness: float) -> ElasticSolid:
        """The solid of given moduli, Pa, and thickness of the layer, m."""
        if self.homogeneous:
            return HomogeneousSolid(young_modulus=bulk, poisson_ratio=self.poisson_ratio_bulk)
        return LayeredSkin(
            young_modulus_layer=layer,
            young_modulus_bulk=bulk,
            poisson_ratio_layer=self.poisson_ratio_layer,
            poisson_ratio_bulk=self.poisson_ratio_bulk,
            layer_thickness=thickness,
        )

    def material(self, log_parameters: FloatArray) -> Material:
        """Asperity law and twice the stress variance at parameters given by their ln, SI, shape ``(6,)``."""
        layer, bulk, height, _, _, thickness = np.exp(log_parameters).tolist()
        skin = self.solid(layer, bulk, thickness)
        law = law_of_table(*asperity_table(self.spectrum, skin, area_correction=self.area_correction))
        twice_variance = float(twice_stress_variance(self.spectrum, skin))
        return Material(law, twice_variance, layer * self.rms_height, layer / bulk, thickness, height)


@dataclass(frozen=True, eq=False)
class Material:
    """Asperity law of one ratio of moduli and one layer thickness; other roughness and moduli follow by scaling.

    Attributes
    ----------
    law : p_a (Pa) against ū (m) at the rms height of the spectrum
    twice_variance : V there, Pa²
    stiffness : E0 h_rms there, Pa m
    ratio : E0/E1, dimensionless
    thickness : d, m
    height : h_rms of the parameters it was asked with, m
    """

    law: AsperityLaw
    twice_variance: float
    stiffness: float
    ratio: float
    thickness: float
    height: float


@dataclass(frozen=True, eq=False)
class Ball:
    """A ball on a rough material, ready for the film solver.

    Attributes
    ----------
    surface : what was given
    law : p_a (Pa) against ū (m)
    twice_variance : V, Pa²
    stiffness : E0 h_rms, Pa m
    cylinder_radius : Rc, m
    load_per_length : f_N, N/m
    reduced_modulus : E1*, Pa
    """

    surface: Surface
    law: AsperityLaw
    twice_variance: float
    stiffness: float
    cylinder_radius: float
    load_per_length: float
    reduced_modulus: float

    def outputs(self, log_number: FloatArray, nodes: int) -> FloatArray:
        """ln of the outputs at ln λ of shape ``(K,)``, shape ``(6, K)``.

        Raises
        ------
        InputError
            if no film was found
        """
        hertz = line_contact(self.load_per_length, self.cylinder_radius, reduced_modulus=self.reduced_modulus)
        height = float(hertz.half_width**2 / self.cylinder_radius)
        slope = float(hertz.half_width / self.cylinder_radius)
        number = np.exp(log_number)
        products = number / lubrication_number_per_product(self.cylinder_radius, hertz)
        for more in _MORE_NODES:
            films = lubricated_films(
                products,
                cylinder_radius=self.cylinder_radius,
                load_per_length=self.load_per_length,
                reduced_modulus=self.reduced_modulus,
                asperities=self.law,
                nodes=nodes + more,
            )
            area = relative_contact_area(
                films.asperity_pressure, self.twice_variance, area_correction=self.surface.area_correction
            )
            # 1 − (1 − fraction) has no digits where the fraction is small
            carried = films.asperity_pressure @ films.load_weight / self.load_per_length
            fraction = np.where(films.asperity_load_fraction > 0.5, films.asperity_load_fraction, carried)
            found = np.array(
                [
                    films.central_film / height,
                    np.maximum(self.stiffness * (area @ films.load_weight) / self.load_per_length, _LEAST),
                    films.couette * 3 * np.pi / slope / number,
                    films.pressure_flow * np.pi / slope,
                    films.minimum_film / height,
                    np.maximum(fraction, _LEAST),
                ]
            )
            if np.all(found > 0):
                return np.log(found)
        raise InputError(
            f"No film was found for a cylinder of radius {self.cylinder_radius:.3g} m under {self.load_per_length:.3g} N/m "
            f"on tissue of E* = {self.reduced_modulus:.3g} Pa with E0 h_rms = {self.stiffness:.3g} Pa m, which the table "
            "of films needs; narrower ranges may do without."
        )

    def anchors(self) -> tuple[float, float]:
        """ln λ at which asperities carry half of the load, and how much further on they carry 1e-3 of it."""
        hertz = line_contact(self.load_per_length, self.cylinder_radius, reduced_modulus=self.reduced_modulus)
        height = float(hertz.half_width**2 / self.cylinder_radius)
        law = self.law.scaled(height, float(hertz.maximum_pressure))
        tail = np.log(law.decay_length)
        rough = np.log(max(law.separation_at(1.0), _THINNEST * law.decay_length))
        # a regression over balls and skins, good to half a unit; the speeds reach far beyond
        log_number = 2.4 + 1.85 * rough + 0.46 * (tail - rough) + _ANCHOR_SPEEDS
        fraction = self.outputs(log_number, _ANCHOR_NODES)[FRACTION]
        odds = fraction - np.log(np.maximum(-np.expm1(fraction), 1e-16))
        wanted = [np.log(FAINT / (1 - FAINT)), np.log(HALF / (1 - HALF))]
        useful = np.abs(odds) < _LARGEST_ODDS
        faint, half = PchipInterpolator(odds[useful][::-1], log_number[useful][::-1])(wanted).tolist()
        return half, faint - half


def ball_at(surface: Surface, material: Material, log_parameters: FloatArray) -> Ball:
    """Ball at parameters given by their ln (SI, shape ``(6,)``), on a material with the same E0/E1 and d."""
    layer, bulk, height, radius, force, _ = np.exp(log_parameters).tolist()
    modulus = float(reduced_modulus(bulk, surface.poisson_ratio_bulk))
    cylinder = cylinder_of_sphere(force, radius, reduced_modulus=modulus)
    stiffness = layer * height
    times = stiffness / material.stiffness
    return Ball(
        surface,
        material.law.scaled(surface.rms_height / height, 1 / times),
        material.twice_variance * times * times,
        stiffness,
        float(cylinder.cylinder_radius),
        float(cylinder.load_per_length),
        modulus,
    )
