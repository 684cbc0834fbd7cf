"""Evaporation, and friction while the skin dries (Sect. 5, Fig. 7)."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import brentq

from skinbayes.arrays import FloatArray
from skinbayes.contact import sphere_contact
from skinbayes.phrases import number
from skinbayes.reproduce.choices import NEW, TIMES, WIND
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes
from skinbayes.reproduce.statements import printed_value
from skinbayes.wetting import (
    DryingCurve,
    drying_curve,
    drying_features,
    evaporation_rate_from_pressures,
    film_of_droplet,
    latent_heat_of_evaporation,
    saturation_vapour_pressure,
)

ZERO_CELSIUS = 273.15
"""K."""


def hertz_diameter(paper: Paper, load: str) -> float:
    """Diameter of the Hertz contact under a load by its name, m."""
    contact = sphere_contact(paper[load], paper["ball-radius"], reduced_modulus=paper.tissue_modulus)
    return 2 * float(contact.contact_radius)


@computes("droplet-film")
def _film(paper: Paper) -> Found:
    def film(width: float) -> float:
        return float(film_of_droplet(paper["droplet-volume"], paper["stroke-length"], contact_width=width))

    wide = number(1e6 * film(hertz_diameter(paper, "ball-load")))
    return Found(
        film(printed_value("contact-width")),
        f"The volume over the stated length and width; {wide} µm over the width of the Hertz contact.",
    )


@computes("contact-width")
def _width(paper: Paper) -> Found:
    return Found(
        hertz_diameter(paper, "ball-load"),
        "Hertz with the paper's load, radius and E1; the same contact has its 6.83 kPa.",
    )


@computes("vapour-pressure-skin")
def _vapour_skin(paper: Paper) -> float:
    return float(saturation_vapour_pressure(paper["skin-temperature"]))


@computes("vapour-pressure-room")
def _vapour_room(paper: Paper) -> float:
    return float(saturation_vapour_pressure(paper["room-temperature"]))


@computes("vapour-pressure-air")
def _vapour_air(paper: Paper) -> Found:
    return Found(
        paper.air_pressure,
        "The printed number is half of the rounded 2.3 kPa; it moves the rate by less than 1 %.",
    )


@computes("latent-heat")
def _latent(paper: Paper) -> Found:
    asked = brentq(
        lambda kelvin: float(latent_heat_of_evaporation(kelvin)) - paper["latent-heat-used"], 300.0, 400.0
    )
    return Found(
        float(latent_heat_of_evaporation(paper["skin-temperature"])),
        f"Water of {number(asked - ZERO_CELSIUS, 2)} °C has the printed number. The rate would be "
        f"{number(_rate_with_own_heat(paper))} m/s with the latent heat of water on skin.",
    )


def _rate_with_own_heat(paper: Paper) -> float:
    own = float(latent_heat_of_evaporation(paper["skin-temperature"]))
    return paper.evaporation * paper["latent-heat-used"] / own


@computes("evaporation-rate")
def _rate(paper: Paper) -> float:
    return paper.evaporation


@computes("time-of-droplet")
def _time_of_droplet(paper: Paper) -> float:
    return printed_value("droplet-film") / paper.evaporation


def curve(
    paper: Paper, times: FloatArray = TIMES, angle: str = "angle-glass", closure: str = "gaussian"
) -> DryingCurve:
    """Friction of drying skin at given times, s, with the printed film."""
    return drying_curve(times, paper["droplet-time"], **_drying(paper, angle, closure))


def _drying(paper: Paper, angle: str, closure: str) -> dict[str, Any]:
    return {
        "initial_film": printed_value("droplet-film"),
        "evaporation_rate": paper.evaporation,
        "contact": paper.film_contact(angle, closure),
        "frictional_shear_stress": paper["shear-stress-used"],
        "nominal_pressure": paper.pressure,
    }


@computes("time-until-dry")
def _until_dry(paper: Paper) -> float:
    friction = curve(paper).friction_coefficient
    dry = friction[0]
    return float(TIMES[np.flatnonzero(friction > NEW * dry)[-1]]) - paper["droplet-time"]


@computes("time-of-bridges")
def _time(paper: Paper) -> Found:
    rate, rounded = paper.evaporation, printed_value("evaporation-rate")
    film = printed_value("time-of-bridges") * rate
    return Found(
        printed_value("flooding-film-abstract") / rate,
        f"{number(printed_value('flooding-film-abstract') / rounded)} s at the rounded 1.7 × 10⁻⁷ m/s. 76 s belong to "
        f"{number(1e6 * film)} µm, or to the 13 µm of the mean separation at the rounded rate "
        f"({number(printed_value('separation-without') / rounded)} s).",
    )


@computes("time-of-bridges-abstract")
def _time_abstract(paper: Paper) -> float:
    return printed_value("flooding-film-abstract") / paper.evaporation


@computes("time-of-enhanced-friction")
def _enhanced(paper: Paper) -> Found:
    friction = curve(paper).friction_coefficient
    features = drying_features(paper["droplet-time"], **_drying(paper, "angle-glass", "gaussian"))
    above = np.count_nonzero(friction > NEW * float(features.wet_plateau))
    return Found(
        float(above * (TIMES[1] - TIMES[0])),
        f"{number(float(features.peak_width), 2)} s at half the height of the peak.",
    )


@computes("eq-8")
def _eq8(paper: Paper) -> Found:
    return _equation_8(paper, 0.0)


@computes("eq-8-wind")
def _eq8_wind(paper: Paper) -> Found:
    return _equation_8(paper, WIND)


def _equation_8(paper: Paper, air_speed: float) -> Found:
    skin, air, heat = (
        printed_value("vapour-pressure-skin"),
        printed_value("vapour-pressure-air"),
        paper["latent-heat-used"],
    )
    found = evaporation_rate_from_pressures(skin, air, air_speed=air_speed, latent_heat=heat)
    factor = paper["still-air-coefficient"] + paper["air-speed-coefficient"] * air_speed
    return Found(float(found), formula=(skin - air) * factor / heat)


@computes("peak-while-drying")
def _peak(paper: Paper) -> Found:
    features = drying_features(paper["droplet-time"], **_drying(paper, "angle-glass", "gaussian"))
    sharp = drying_features(paper["droplet-time"], **_drying(paper, "angle-glass", "sharp"))
    return Found(
        float(features.peak_friction / features.wet_plateau),
        f"μ rises to {number(float(features.peak_friction))} (sharp gaps: {number(float(sharp.peak_friction))}) at "
        f"{number(float(features.peak_time))} s on the clock of Fig. 7.",
    )


@computes("no-peak-on-polypropylene")
def _no_peak(paper: Paper) -> float:
    friction = curve(paper, angle="angle-polypropylene").friction_coefficient
    wet = friction[np.searchsorted(TIMES, 2 * paper["droplet-time"])]
    return float(friction.max() / wet - 1)


@computes("still-air")
def _still(paper: Paper) -> float:
    heat, air = paper["latent-heat-used"], paper.air_pressure
    skin = float(saturation_vapour_pressure(paper["skin-temperature"]))
    still, moved = evaporation_rate_from_pressures(
        skin, air, air_speed=[0.0, paper["ball-speed"]], latent_heat=heat
    )
    return float(moved / still - 1)
