"""Direct solutions that tables of films are made of and checked with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from skinbayes.arrays import FloatArray
from skinbayes.contact.area import relative_contact_area
from skinbayes.contact.line_contact import HertzLine, line_contact
from skinbayes.errors import InputError
from skinbayes.lubrication.asperities import AsperityLaw
from skinbayes.lubrication.contact_films import LINE, POINT, contact_films, weighted
from skinbayes.lubrication.film import LubricatedFilms, lubrication_number_per_product
from skinbayes.lubrication.film_table import FRACTION
from skinbayes.lubrication.flow_factors import FlowFactors
from skinbayes.lubrication.point_film import CELLS, LubricatedPointFilms
from skinbayes.lubrication.viscoelastic_film import ViscoelasticFilms, films_on
from skinbayes.lubrication.viscoelastic_memory import passage_in_contact

AnyFilms = LubricatedFilms | LubricatedPointFilms | ViscoelasticFilms

HALF, FAINT = 0.5, 1e-3
"""Load fractions of the asperities at the two lubrication numbers that a table counts speeds from."""

_MORE_NODES = (0, 17, 34)  # tried one after the other where a film is not found
_THINNEST = (
    0.03  # of the decay length: where contact is nearly complete the separation vanishes, the film does not
)
_LARGEST_ODDS = 20.0  # ln share/(1 − share) that has digits
_LEAST = 1e-300
# far below those of 1e-3: where a rough surface lets go at once they are needed to find it
_LEAST_ODDS = -345.0
_ANCHOR_SPEEDS = np.linspace(-5.0, 11.0, 17)  # ln λ about a guess of where asperities carry half the load
_ANCHOR_NODES = 56
_POINT_ANCHOR_SPEEDS = np.linspace(-2.2, 2.0, 18)  # in the unit of the cylinder, from its half load
_SHORTEST_UNIT = 1.0  # of ln λ: where asperities let go at once the points above tell no unit


@dataclass(frozen=True, eq=False)
class Ball:
    """A ball on a rough material, ready for the film solver.

    Attributes
    ----------
    law : p_a (Pa) against ū (m)
    twice_variance : V, Pa²
    area_correction : γ, dimensionless
    stiffness : E0 h_rms, Pa m
    normal_force : F_N, N
    sphere_radius : R, m
    cylinder_radius : Rc, m
    load_per_length : f_N, N/m
    reduced_modulus : E1*, Pa
    inlet_length : distance from the contact, m, at which liquid and drag end; None for liquid without end
    flow_factors : of the flow between rough surfaces; None for trivial ones
    """

    law: AsperityLaw
    twice_variance: float
    area_correction: float
    stiffness: float
    normal_force: float
    sphere_radius: float
    cylinder_radius: float
    load_per_length: float
    reduced_modulus: float
    inlet_length: float | None = None
    flow_factors: FlowFactors | None = None

    def outputs(
        self, log_number: FloatArray, nodes: int, *, contact: str = LINE, cells: int = CELLS
    ) -> FloatArray:
        """ln of the outputs at ln λ of shape ``(K,)``, shape ``(6, K)``; those of a ball in the units of its cylinder.

        Raises
        ------
        InputError
            if no film was found
        """
        hertz = line_contact(self.load_per_length, self.cylinder_radius, reduced_modulus=self.reduced_modulus)
        products = np.exp(log_number) / lubrication_number_per_product(self.cylinder_radius, hertz)
        for more in _MORE_NODES:
            films, load = contact_films(
                products,
                normal_force=self.normal_force,
                sphere_radius=self.sphere_radius,
                reduced_modulus=self.reduced_modulus,
                asperities=self.law,
                contact=contact,
                nodes=nodes + more,
                cells=cells + 4 * more,
                inlet_length=self.inlet_length,
                flow_factors=self.flow_factors,
            )
            found = self._outputs_of(films, load, log_number, hertz, contact == LINE)
            if np.all(found > 0):
                return np.log(found)
        raise self._no_film()

    def outputs_with_memory(
        self, log_number: FloatArray, nodes: int, *, substrate: str, strength: float, place: float
    ) -> FloatArray:
        """The outputs of a cylinder on tissue of the same |E*| at v/b that remembers, and ln of its hysteresis, ``(7, K)``.

        The hysteresis is that over ``(8/3π) sin δ b/Rc``. See `passage_in_contact` for the tissue; `InputError` as `outputs`.
        """
        hertz = line_contact(self.load_per_length, self.cylinder_radius, reduced_modulus=self.reduced_modulus)
        products = np.exp(log_number) / lubrication_number_per_product(self.cylinder_radius, hertz)
        half_width = float(hertz.half_width)
        scales, loss = passage_in_contact(
            substrate, strength, place, modulus=self.reduced_modulus, half_width=half_width
        )
        weak = 8 / (3 * np.pi) * loss * half_width / self.cylinder_radius
        for more in _MORE_NODES:
            films = films_on(
                scales,
                products,
                load_per_length=self.load_per_length,
                cylinder_radius=self.cylinder_radius,
                asperities=self.law,
                nodes=nodes + more,
            )
            found = self._outputs_of(films, self.load_per_length, log_number, hertz, line=True)
            found = np.concatenate([found, films.hysteresis[None] / weak])
            if np.all(found > 0):
                return np.log(found)
        raise self._no_film()

    def _outputs_of(
        self, films: AnyFilms, load: float, log_number: FloatArray, hertz: HertzLine, line: bool
    ) -> FloatArray:
        height = float(hertz.half_width**2 / self.cylinder_radius)
        slope = float(hertz.half_width / self.cylinder_radius)
        area = relative_contact_area(
            films.asperity_pressure, self.twice_variance, area_correction=self.area_correction
        )
        # 1 − (1 − fraction) has no digits where the fraction is small
        carried = weighted(films.asperity_pressure, films.load_weight) / load
        fraction = np.where(films.asperity_load_fraction > 0.5, films.asperity_load_fraction, carried)
        return np.array(
            [
                films.central_film / height,
                np.maximum(self.stiffness * weighted(area, films.load_weight) / load, _LEAST),
                films.couette * 3 * np.pi / slope / np.exp(log_number),
                (films.pressure_flow if line else films.pressure_flow + films.couette) * np.pi / slope,
                films.minimum_film / height,
                np.maximum(fraction, _LEAST),
            ]
        )

    def _no_film(self) -> InputError:
        return InputError(
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
        return _anchors_of(log_number, self.outputs(log_number, _ANCHOR_NODES)[FRACTION])

    def point_anchors(self, cells: int) -> tuple[float, float]:
        """The same of the ball itself on few cells, ln λ being that of its cylinder."""
        half, unit = self.anchors()
        log_number = half + max(unit, _SHORTEST_UNIT) * _POINT_ANCHOR_SPEEDS
        found = self.outputs(log_number, _ANCHOR_NODES, contact=POINT, cells=cells)
        return _anchors_of(log_number, found[FRACTION])


def _anchors_of(log_number: FloatArray, log_fraction: FloatArray) -> tuple[float, float]:
    """Where the load fraction is `HALF`, and how much further on `FAINT`."""
    odds = log_fraction - np.log(np.maximum(-np.expm1(log_fraction), 1e-16))
    wanted = [np.log(FAINT / (1 - FAINT)), np.log(HALF / (1 - HALF))]
    useful = (odds < _LARGEST_ODDS) & (odds > _LEAST_ODDS)
    faint, half = PchipInterpolator(odds[useful][::-1], log_number[useful][::-1])(wanted).tolist()
    return half, faint - half
