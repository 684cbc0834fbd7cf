"""How thick the film of a droplet is, and how fast it evaporates."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray, floats
from skinbayes.wetting.water import saturation_vapour_pressure

LATENT_HEAT_OF_PAPER = 2.272e6
"""Y as the paper has it, J/kg; `latent_heat_of_evaporation` gives that of the actual temperature."""

STILL_AIR_COEFFICIENT = 8.9e-5
"""a of Eq. 8, m^4/(kg s): the 0.089 W/(m² Pa) of the ASHRAE formula over the density of water."""

AIR_SPEED_COEFFICIENT = 7.8e-5
"""b of Eq. 8, m^3/kg: the 0.0782 W s/(m³ Pa) of the ASHRAE formula over the density of water."""


def evaporation_rate_from_pressures(
    vapour_pressure_surface: ArrayLike,
    vapour_pressure_air: ArrayLike,
    *,
    air_speed: ArrayLike = 0.0,
    latent_heat: ArrayLike = LATENT_HEAT_OF_PAPER,
) -> FloatArray:
    """Thickness of water that evaporates per time, ``ḋ = (p_w − p_a)(a + b v)/Y`` (Eq. 8 of the paper).

    Parameters
    ----------
    vapour_pressure_surface : p_w, saturation pressure at the temperature of the water surface, Pa, any shape
    vapour_pressure_air : p_a, vapour pressure of the air, Pa, broadcasts
    air_speed : v, speed of the air over the surface, m/s, ≥ 0, broadcasts
    latent_heat : Y, J/kg, > 0, broadcasts

    Returns
    -------
    evaporation_rate : m/s, broadcast shape, positive while the film gets thinner (the paper counts it
        negative); negative if water condenses; nan where an argument is impossible

    Notes
    -----
    An empirical formula for open water. a has the unit m^4/(kg s) and b m^3/kg, so that pressure times a over energy per
    mass is a speed.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Eq. 8, after the ASHRAE Handbook).

    Examples
    --------
    The paper's own pressures, from which it has 1.7e-7 m/s:

    >>> print(f"{evaporation_rate_from_pressures(5.6e3, 1.15e3):.3e}")
    1.743e-07
    """
    surface, air, speed, heat = floats(vapour_pressure_surface, vapour_pressure_air, air_speed, latent_heat)
    with np.errstate(all="ignore"):
        possible = (surface >= 0) & (air >= 0) & (speed >= 0) & (heat > 0)
        rate = (surface - air) * (STILL_AIR_COEFFICIENT + AIR_SPEED_COEFFICIENT * speed) / heat
        return np.where(possible, rate, np.nan)[()]


def evaporation_rate(
    relative_humidity: ArrayLike,
    surface_temperature: ArrayLike,
    *,
    air_temperature: ArrayLike,
    air_speed: ArrayLike = 0.0,
    latent_heat: ArrayLike = LATENT_HEAT_OF_PAPER,
) -> FloatArray:
    """Thickness of water that evaporates per time from warm skin into a room (Eq. 8 of the paper).

    ``p_w`` is the saturation pressure at the temperature of the water surface, ``p_a`` the relative humidity times that at the
    temperature of the air.

    Parameters
    ----------
    relative_humidity : RH of the room, dimensionless, 0 … 1, any shape
    surface_temperature : temperature of the water on the skin, K, broadcasts
    air_temperature : temperature of the room, K, broadcasts
    air_speed : v, m/s, ≥ 0, broadcasts
    latent_heat : Y, J/kg, > 0, broadcasts

    Returns
    -------
    evaporation_rate : m/s, broadcast shape, positive while the film gets thinner; nan where an argument is impossible

    Notes
    -----
    With the paper's 35 °C, 20 °C and 50 % it is 1.747e-7 m/s; the paper's rounded pressures give 1.743e-7 m/s, and the latent
    heat of water at 35 °C 1.641e-7 m/s.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Eq. 8, after the ASHRAE Handbook).

    Examples
    --------
    >>> print(f"{evaporation_rate(0.5, 308.15, air_temperature=293.15):.3e}")
    1.747e-07
    """
    humidity = np.asarray(relative_humidity, dtype=np.float64)
    with np.errstate(all="ignore"):
        humidity = np.where((humidity >= 0) & (humidity <= 1), humidity, np.nan)
        air = humidity * saturation_vapour_pressure(air_temperature)
    return evaporation_rate_from_pressures(
        saturation_vapour_pressure(surface_temperature), air, air_speed=air_speed, latent_heat=latent_heat
    )


def film_of_droplet(
    droplet_volume: ArrayLike, stroke_length: ArrayLike, *, contact_width: ArrayLike
) -> FloatArray:
    """Average film of a droplet that is spread over the sliding track, ``ΔV/(L D)`` (Sect. 5 of the paper).

    Parameters
    ----------
    droplet_volume : ΔV, m^3, ≥ 0, any shape
    stroke_length : L, length of the track, m, > 0, broadcasts
    contact_width : D, width of the track, m, > 0, broadcasts

    Returns
    -------
    film_thickness : m, broadcast shape; nan where an argument is impossible

    Notes
    -----
    The paper states 90 µm for 50 µl, L = 8 cm and D = 0.8 cm, which are 78 µm. With the diameter of its Hertz contact,
    9.65 mm, they are 65 µm. Water outside the track, and round ends of the track, would make the film thinner still.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5).

    Examples
    --------
    >>> print(f"{film_of_droplet(50e-9, 0.08, contact_width=0.008):.3e}")
    7.812e-05
    >>> from skinbayes.contact import reduced_modulus, sphere_contact
    >>> width = 2 * sphere_contact(0.5, 8e-3, reduced_modulus=reduced_modulus(20e3, 0.5)).contact_radius
    >>> print(f"{width:.2e} {film_of_droplet(50e-9, 0.08, contact_width=width):.3e}")
    9.65e-03 6.473e-05
    """
    volume, length, width = floats(droplet_volume, stroke_length, contact_width)
    with np.errstate(all="ignore"):
        possible = (volume >= 0) & (length > 0) & (width > 0)
        return np.where(possible, volume / (length * width), np.nan)[()]
