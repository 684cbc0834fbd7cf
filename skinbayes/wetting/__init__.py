"""Wet and drying skin: water, evaporation, capillary bridges, drying and humidity."""

from skinbayes.wetting.capillary import CapillaryState, capillary_state, capillary_state_at_gap, kelvin_gap
from skinbayes.wetting.evaporation import (
    AIR_SPEED_COEFFICIENT,
    LATENT_HEAT_OF_PAPER,
    STILL_AIR_COEFFICIENT,
    evaporation_rate,
    evaporation_rate_from_pressures,
    film_of_droplet,
)
from skinbayes.wetting.water import (
    density_of_water,
    latent_heat_of_evaporation,
    molecular_volume_of_water,
    saturation_vapour_pressure,
    surface_tension_of_water,
)

__all__ = [
    "AIR_SPEED_COEFFICIENT",
    "LATENT_HEAT_OF_PAPER",
    "STILL_AIR_COEFFICIENT",
    "CapillaryState",
    "capillary_state",
    "capillary_state_at_gap",
    "density_of_water",
    "evaporation_rate",
    "evaporation_rate_from_pressures",
    "film_of_droplet",
    "kelvin_gap",
    "latent_heat_of_evaporation",
    "molecular_volume_of_water",
    "saturation_vapour_pressure",
    "surface_tension_of_water",
]
