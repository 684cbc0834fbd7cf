"""The skin, the balls and the liquids of the paper, from the numbers that it prints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from skinbayes.arrays import FloatArray
from skinbayes.contact import (
    ConstantLossMaterial,
    EquivalentCylinder,
    LayeredSkin,
    ViscoelasticMaterial,
    cylinder_of_sphere,
    indentation_cycle,
    line_contact,
    reduced_modulus,
    relative_contact_area,
    sphere_contact,
    total_contact_area,
    twice_stress_variance,
)
from skinbayes.reproduce.choices import FILMS, PRODUCTS
from skinbayes.reproduce.statements import statements
from skinbayes.roughness import SelfAffineSpectrum, named_surface
from skinbayes.wetting import (
    CapillaryState,
    FilmContact,
    capillary_state,
    evaporation_rate,
    film_contact,
    saturation_vapour_pressure,
    surface_tension_of_water,
)

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Paper:
    """The cases of the paper as objects of skinbayes; what several statements need is computed once.

    Attributes
    ----------
    other : values that take the place of printed ones, SI, by the name of the statement
    surface : power spectrum of the skin; the paper's four parameters alone do not give its slope, see `printed_surface`
    """

    other: dict[str, float] = field(default_factory=dict)
    surface: SelfAffineSpectrum = field(default_factory=lambda: named_surface("paper_reference"))
    _known: dict[str, object] = field(default_factory=dict, init=False, repr=False)

    def __getitem__(self, name: str) -> float:
        """A printed number by the name of its statement, SI."""
        if name in self.other:
            return self.other[name]
        printed = statements()[name].printed
        assert printed is not None and printed.low == printed.high, f"{name} is not one number"
        return printed.low

    def with_values(self, **other: float) -> Paper:
        """The same with other values in place of printed ones; ``_`` in a name stands for ``-``."""
        return replace(self, other=self.other | {name.replace("_", "-"): x for name, x in other.items()})

    def once(self, name: str, compute: Callable[[], T]) -> T:
        """A result that several statements need: computed the first time that it is asked for."""
        if name not in self._known:
            self._known[name] = compute()
        return self._known[name]  # type: ignore[return-value]

    def skin(self, layer: float, bulk: float | None = None) -> LayeredSkin:
        """Skin with a Young's modulus of the layer, and of the bulk if it is another one, Pa."""
        return LayeredSkin(
            young_modulus_layer=layer,
            young_modulus_bulk=self["young-modulus-bulk"] if bulk is None else bulk,
            poisson_ratio_layer=self["poisson-ratio-layer"],
            poisson_ratio_bulk=self["poisson-ratio-bulk"],
            layer_thickness=self["layer-thickness"],
        )

    @cached_property
    def wet(self) -> LayeredSkin:
        """Wet skin."""
        return self.skin(self["young-modulus-layer-wet"])

    @cached_property
    def dry(self) -> LayeredSkin:
        """Dry skin."""
        return self.skin(self["young-modulus-layer-dry"])

    @cached_property
    def printed_surface(self) -> SelfAffineSpectrum:
        """The surface that the four printed parameters make: without a plateau."""
        return SelfAffineSpectrum(
            rms_height=self["rms-height-printed"],
            hurst_exponent=self["hurst-exponent"],
            wavevector_min=self["wavevector-min"],
            wavevector_rolloff=self["wavevector-min"],
            wavevector_max=self["wavevector-max"],
        )

    @cached_property
    def tissue_modulus(self) -> float:
        """E1*, Pa."""
        return float(reduced_modulus(self["young-modulus-bulk"], poisson_ratio=self["poisson-ratio-bulk"]))

    @cached_property
    def pressure(self) -> float:
        """Mean Hertz pressure under the ball of the experiments in water, Pa."""
        return self.pressure_under(self["ball-load"])

    def pressure_under(self, load: float) -> float:
        """Mean Hertz pressure under the ball, Pa, at a load in N."""
        contact = sphere_contact(load, self["ball-radius"], reduced_modulus=self.tissue_modulus)
        return float(contact.mean_pressure)

    def variance(self, skin: LayeredSkin, wavevector: FloatArray | float | None = None) -> FloatArray:
        """V of the surface on a skin, Pa²."""
        return twice_stress_variance(self.surface, skin, wavevector=wavevector)

    @cached_property
    def wet_area(self) -> float:
        """A/A0 of wet skin under the pressure of the experiments."""
        return float(relative_contact_area(self.pressure, self.variance(self.wet)))

    @cached_property
    def dry_area(self) -> float:
        """A/A0 of dry skin, which yields."""
        area = total_contact_area(self.pressure, self.variance(self.dry), yield_stress=self["yield-stress"])
        return float(area)

    def bridges(
        self,
        film: FloatArray | float = FILMS,
        *,
        angle: str = "angle-glass",
        surface: SelfAffineSpectrum | None = None,
        closure: str = "gaussian",
    ) -> CapillaryState:
        """Wet skin with films of water on a countersurface whose contact angle is named."""
        return capillary_state(
            film,
            self.pressure,
            spectrum=surface or self.surface,
            skin=self.wet,
            surface_tension=surface_tension_of_water(self["room-temperature"]),
            contact_angle_skin=self["angle-skin"],
            contact_angle_counterface=self[angle],
            closure=closure,  # type: ignore[arg-type]
        )

    def strongest(
        self,
        *,
        angle: str = "angle-glass",
        surface: SelfAffineSpectrum | None = None,
        closure: str = "gaussian",
        films: FloatArray = FILMS,
    ) -> CapillaryState:
        """The state at the film where the contact area is largest."""
        height = float((surface or self.surface).rms_height)
        name = f"strongest bridges {angle} {closure} {height!r}"
        return self.once(name, lambda: self._strongest(angle, surface, closure, films))

    def _strongest(
        self, angle: str, surface: SelfAffineSpectrum | None, closure: str, films: FloatArray
    ) -> CapillaryState:
        given = {"angle": angle, "surface": surface, "closure": closure}
        states = self.bridges(films, **given)  # type: ignore[arg-type]
        best = int(np.argmax(states.relative_contact_area))
        ends = films[max(best - 1, 0)], films[min(best + 1, len(films) - 1)]
        found = minimize_scalar(
            lambda film: -float(self.bridges(film, **given).relative_contact_area),  # type: ignore[arg-type]
            bounds=ends,
            method="bounded",
            options={"xatol": 1e-3 * ends[0]},
        )
        return self.bridges(float(found.x), **given)  # type: ignore[arg-type]

    @cached_property
    def strongest_bridges(self) -> CapillaryState:
        """The same on glass of 0°."""
        return self.strongest()

    @cached_property
    def air_pressure(self) -> float:
        """Vapour pressure of the air of the room, Pa."""
        return self["room-humidity"] * float(saturation_vapour_pressure(self["room-temperature"]))

    @cached_property
    def evaporation(self) -> float:
        """Rate at which water evaporates from the skin, m/s, with the vapour pressures of water."""
        rate = evaporation_rate(
            self["room-humidity"],
            self["skin-temperature"],
            air_temperature=self["room-temperature"],
            latent_heat=self["latent-heat-used"],
        )
        return float(rate)

    def film_contact(self, angle: str = "angle-glass", closure: str = "gaussian") -> FilmContact:
        """Contact area of drying skin against the film."""
        return film_contact(
            self.pressure,
            self.surface,
            skin=self.wet,
            surface_tension=surface_tension_of_water(self["room-temperature"]),
            contact_angle_skin=self["angle-skin"],
            contact_angle_counterface=self[angle],
            young_modulus_layer_dry=self["young-modulus-layer-dry"],
            yield_stress=self["yield-stress"],
            closure=closure,  # type: ignore[arg-type]
        )

    @cached_property
    def cylinder(self) -> EquivalentCylinder:
        """The cylinder that stands for the ball in silicone fluids."""
        return cylinder_of_sphere(self["oil-load"], self["ball-radius"], reduced_modulus=self.tissue_modulus)

    @cached_property
    def half_width(self) -> float:
        """b of its contact, m."""
        return float(line_contact(*self.cylinder, reduced_modulus=self.tissue_modulus).half_width)

    @cached_property
    def oil_speed(self) -> float:
        """Geometric mean of the sliding speeds in silicone fluids, m/s."""
        return float(np.sqrt(self["oil-speed-least"] * self["oil-speed-most"]))

    @cached_property
    def loss_tangent(self) -> float:
        """tan δ, the same at all frequencies, with which the quoted indentation loses what it lost."""

        def miss(tangent: float) -> float:
            return self.indentation(self.tissue(tangent))[0] - self["indentation-loss"]

        return float(brentq(miss, 0.01, 0.9, xtol=1e-4))

    def indentation(self, material: ViscoelasticMaterial | ConstantLossMaterial) -> tuple[float, float]:
        """Loss over work, and set in m, of the quoted indentation of a material."""
        cycle = indentation_cycle(
            self["indentation-speed"],
            self["indentation-depth"],
            sphere_radius=self["ball-radius"],
            material=material,
        )
        return cycle.loss_fraction, cycle.residual_depth

    def tissue(self, tangent: float) -> ConstantLossMaterial:
        """Tissue of constant loss whose modulus is that of the elastic one at the frequency v/b of the contact in silicone."""
        return ConstantLossMaterial(
            modulus=self["young-modulus-bulk"],
            tan_delta=tangent,
            reference_frequency=self.oil_speed / self.half_width,
            poisson_ratio=self["poisson-ratio-bulk"],
        )

    @property
    def products(self) -> FloatArray:
        """Speed times viscosity of the Stribeck curves, N/m."""
        return PRODUCTS
