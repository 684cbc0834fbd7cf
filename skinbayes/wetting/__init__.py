"""Wet and drying skin: water, evaporation, capillary bridges, drying and humidity."""

from skinbayes.wetting._gaps import VERSION_OF_BRIDGES
from skinbayes.wetting.bridge_table import BridgeTable, bridge_table, skin_groups
from skinbayes.wetting.capillary import CapillaryState, capillary_state, capillary_state_at_gap, kelvin_gap
from skinbayes.wetting.drying import DryingCurve, DryingFeatures, drying_curve, drying_features
from skinbayes.wetting.evaporation import (
    AIR_SPEED_COEFFICIENT,
    LATENT_HEAT_OF_PAPER,
    STILL_AIR_COEFFICIENT,
    evaporation_rate,
    evaporation_rate_from_pressures,
    film_of_droplet,
)
from skinbayes.wetting.film_contact import FILM_FLOOR, FilmContact, film_contact
from skinbayes.wetting.humid_table import HumidTable, humid_groups, humid_table
from skinbayes.wetting.humidity import (
    MOLECULE_DIAMETER,
    capillary_state_in_humid_air,
    humidity_at_surface,
    is_below_molecule,
    kelvin_radius,
    young_modulus_at_humidity,
)
from skinbayes.wetting.modulus_table import young_modulus_from_table
from skinbayes.wetting.water import (
    density_of_water,
    latent_heat_of_evaporation,
    molecular_volume_of_water,
    saturation_vapour_pressure,
    surface_tension_of_water,
)

__all__ = [
    "AIR_SPEED_COEFFICIENT",
    "FILM_FLOOR",
    "LATENT_HEAT_OF_PAPER",
    "MOLECULE_DIAMETER",
    "STILL_AIR_COEFFICIENT",
    "VERSION_OF_BRIDGES",
    "BridgeTable",
    "CapillaryState",
    "DryingCurve",
    "DryingFeatures",
    "FilmContact",
    "HumidTable",
    "bridge_table",
    "capillary_state",
    "capillary_state_at_gap",
    "capillary_state_in_humid_air",
    "density_of_water",
    "drying_curve",
    "drying_features",
    "evaporation_rate",
    "evaporation_rate_from_pressures",
    "film_contact",
    "film_of_droplet",
    "humid_groups",
    "humid_table",
    "humidity_at_surface",
    "is_below_molecule",
    "kelvin_gap",
    "kelvin_radius",
    "latent_heat_of_evaporation",
    "molecular_volume_of_water",
    "saturation_vapour_pressure",
    "skin_groups",
    "surface_tension_of_water",
    "young_modulus_at_humidity",
    "young_modulus_from_table",
]
