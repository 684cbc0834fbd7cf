"""Water along saturation and the evaporating film: tables of the IAPWS, thermodynamics, the numbers of the paper."""

import numpy as np
import pytest
from scipy.differentiate import derivative

from skinbayes.wetting import (
    LATENT_HEAT_OF_PAPER,
    density_of_water,
    evaporation_rate,
    evaporation_rate_from_pressures,
    film_of_droplet,
    latent_heat_of_evaporation,
    molecular_volume_of_water,
    saturation_vapour_pressure,
    surface_tension_of_water,
)


@pytest.mark.parametrize(
    ("temperature", "pressure", "liquid", "latent"),
    # IAPWS SR1-86(1992), Table 1: p, ρ' and h'' − h' with the digits printed there
    [(273.16, 611.657, 999.789, 2500.5e3), (373.1243, 101325.0, 958.365, 2675.7e3 - 419.05e3)],
)
def test_saturation_line_has_the_printed_values(temperature, pressure, liquid, latent):
    assert saturation_vapour_pressure(temperature) == pytest.approx(pressure, rel=1e-6)
    assert density_of_water(temperature) == pytest.approx(liquid, rel=1e-6)
    assert latent_heat_of_evaporation(temperature) == pytest.approx(latent, rel=3e-5)


@pytest.mark.parametrize(
    ("celsius", "tension"),
    # IAPWS R1-76(2014), Table 1, mN/m with two digits
    [
        (10, 74.22),
        (20, 72.74),
        (30, 71.19),
        (40, 69.60),
        (50, 67.94),
        (100, 58.91),
        (150, 48.74),
        (300, 14.36),
    ],
)
def test_surface_tension_has_the_printed_values(celsius, tension):
    assert 1e3 * surface_tension_of_water(celsius + 273.15) == pytest.approx(tension, abs=0.0051)


def test_latent_heat_follows_from_the_vapour_pressure():
    # Clapeyron with a numerical derivative and the ideal-gas volume: the vapour is ideal to 0.3 % up to 37 °C
    kelvin = np.linspace(275.0, 310.0, 7)
    slope = derivative(lambda t: np.log(saturation_vapour_pressure(t)), kelvin, initial_step=1.0).df
    ideal = 461.52 * kelvin**2 * slope
    np.testing.assert_allclose(latent_heat_of_evaporation(kelvin), ideal, rtol=3e-3)
    assert np.all(latent_heat_of_evaporation(kelvin) < ideal)  # attraction in the vapour makes it smaller


def test_a_mole_of_molecules_has_the_molar_volume():
    assert 6.02214076e23 * molecular_volume_of_water(298.15) == pytest.approx(18.07e-6, rel=1e-3)


def test_numbers_of_the_paper():
    assert evaporation_rate_from_pressures(5.6e3, 1.15e3) == pytest.approx(1.7432e-7, rel=1e-4)
    assert saturation_vapour_pressure(308.15) == pytest.approx(5.6e3, rel=0.01)
    assert 0.5 * saturation_vapour_pressure(293.15) == pytest.approx(1.15e3, rel=0.02)
    assert evaporation_rate(
        surface_temperature=308.15, air_temperature=293.15, relative_humidity=0.5
    ) == pytest.approx(1.7e-7, rel=0.03)
    assert film_of_droplet(50e-9, 0.08, contact_width=0.008) == pytest.approx(78.125e-6, rel=1e-12)


def test_rate_is_the_ashrae_heat_flow():
    # 0.089 + 0.0782 v in W/(m² Pa), over the latent heat of a volume of water of 1000 kg/m³
    pressure, speed = 3000.0, 1.5
    heat_flow = pressure * (0.089 + 0.0782 * speed)
    rate = evaporation_rate_from_pressures(pressure, 0.0, air_speed=speed)
    assert rate == pytest.approx(heat_flow / (1000 * LATENT_HEAT_OF_PAPER), rel=3e-3)


def test_condensation_and_balance():
    assert evaporation_rate(surface_temperature=293.15, air_temperature=293.15, relative_humidity=1.0) == 0
    assert evaporation_rate(surface_temperature=283.15, air_temperature=303.15, relative_humidity=0.9) < 0
    rates = evaporation_rate(
        surface_temperature=308.15, air_temperature=293.15, relative_humidity=np.linspace(0, 1, 11)
    )
    assert np.all(np.diff(rates) < 0)
    np.testing.assert_allclose(np.diff(rates, 2), 0, atol=1e-20)


def test_shapes_and_batches_agree_with_rows_to_the_last_bit():
    surface = np.array([[300.0], [308.15], [311.0]])
    humidity = np.array([0.1, 0.5, 0.97])
    heat = latent_heat_of_evaporation(surface)
    batch = evaporation_rate(
        surface_temperature=surface,
        air_temperature=293.15,
        relative_humidity=humidity,
        air_speed=0.3,
        latent_heat=heat,
    )
    assert batch.shape == (3, 3)
    for i in range(3):
        for j in range(3):
            kelvin = float(surface[i, 0])
            one = evaporation_rate(
                surface_temperature=kelvin,
                air_temperature=293.15,
                relative_humidity=float(humidity[j]),
                air_speed=0.3,
                latent_heat=latent_heat_of_evaporation(kelvin),
            )
            assert one == batch[i, j]


def test_impossible_arguments_give_nan():
    assert np.isnan(saturation_vapour_pressure([270.0, 647.2, np.nan, -1.0])).all()
    assert np.isnan(
        evaporation_rate(surface_temperature=308.15, air_temperature=293.15, relative_humidity=[1.2, -0.1])
    ).all()
    assert np.isnan(
        evaporation_rate(
            surface_temperature=308.15, air_temperature=293.15, relative_humidity=0.5, air_speed=-1.0
        )
    )
    assert np.isnan(
        evaporation_rate(
            surface_temperature=308.15,
            air_temperature=293.15,
            relative_humidity=0.5,
            air_speed=0.0,
            latent_heat=0.0,
        )
    )
    assert np.isnan(
        film_of_droplet([-1e-9, 1e-9, 1e-9], [0.1, 0.0, 0.1], contact_width=[0.1, 0.1, -0.1])
    ).all()
