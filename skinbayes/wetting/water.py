"""Properties of ordinary water along its saturation line, from the closed formulas of the IAPWS."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray

BOLTZMANN_CONSTANT = 1.380649e-23
"""k_B, J/K, exact in the SI."""

AVOGADRO_CONSTANT = 6.02214076e23
"""N_A, 1/mol, exact in the SI."""

MOLAR_MASS_OF_WATER = 18.015268e-3
"""kg/mol, ordinary water (IAPWS G5-01, after Wagner & Pruß 2002, doi 10.1063/1.1461829)."""

_LOWEST_TEMPERATURE, _CRITICAL_TEMPERATURE = 273.15, 647.096  # K
_CRITICAL_PRESSURE, _CRITICAL_DENSITY = 22.064e6, 322.0  # Pa, kg/m^3

_PRESSURE = (
    (1.0, -7.85951783),
    (1.5, 1.84408259),
    (3.0, -11.7866497),
    (3.5, 22.6807411),
    (4.0, -15.9618719),
    (7.5, 1.80122502),
)
_LIQUID = (
    (0.0, 1.0),
    (1 / 3, 1.99274064),
    (2 / 3, 1.09965342),
    (5 / 3, -0.510839303),
    (16 / 3, -1.75493479),
    (43 / 3, -45.5170352),
    (110 / 3, -6.74694450e5),
)
_VAPOUR = (
    (2 / 6, -2.03150240),
    (4 / 6, -2.68302940),
    (8 / 6, -5.38626492),
    (18 / 6, -17.2991605),
    (37 / 6, -44.7586581),
    (71 / 6, -63.9201063),
)
"""Exponents and coefficients of 1 − T/T_c (IAPWS SR1-86(1992), Eqs. 1 to 3)."""


def _distance(temperature: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """T in K and 1 − T/T_c, nan outside the liquid range."""
    kelvin = np.asarray(temperature, dtype=np.float64)
    kelvin = np.where((kelvin >= _LOWEST_TEMPERATURE) & (kelvin < _CRITICAL_TEMPERATURE), kelvin, np.nan)
    return kelvin, np.asarray(1 - kelvin / _CRITICAL_TEMPERATURE)


def _series(terms: tuple[tuple[float, float], ...], distance: FloatArray) -> FloatArray:
    # exp and log instead of **, which may round differently for scalars and arrays
    log = np.log(distance)
    return np.asarray(sum(factor * np.exp(exponent * log) for exponent, factor in terms))


def surface_tension_of_water(temperature: ArrayLike) -> FloatArray:
    """Surface tension of water against its vapour, ``γ_w = B τ^1.256 (1 − 0.625 τ)``, τ = 1 − T/T_c, B = 0.2358 N/m.

    It is the γ of Eq. 6 of the paper, which does not say which value it took.

    Parameters
    ----------
    temperature : T, from 273.15 to 647.096, K, any shape

    Returns
    -------
    surface_tension : N/m, shape of ``temperature``; nan outside the range

    Notes
    -----
    The formula is that of IAPWS R1-76(2014); its uncertainty is 0.5 % or better below 100 °C. Sweat and sebum lower the
    surface tension; water from a pipette on washed skin has about that of pure water.

    References
    ----------
    Vargaftik, Volkov & Voljak, J. Phys. Chem. Ref. Data 12 (1983) 817, doi 10.1063/1.555688.

    Examples
    --------
    >>> print(f"{surface_tension_of_water(293.15):.5f} {surface_tension_of_water(308.15):.5f}")
    0.07274 0.07040
    """
    with np.errstate(all="ignore"):
        _, distance = _distance(temperature)
        return np.asarray(0.2358 * np.exp(1.256 * np.log(distance)) * (1 - 0.625 * distance))[()]


def saturation_vapour_pressure(temperature: ArrayLike) -> FloatArray:
    """Vapour pressure over a flat surface of water, p_w of Eq. 8 of the paper.

    ``ln(p/p_c) = (T_c/T) Σ a_i τ^(e_i)``, τ = 1 − T/T_c (IAPWS SR1-86(1992), Eq. 1).

    Parameters
    ----------
    temperature : T, from 273.15 to 647.096, K, any shape

    Returns
    -------
    saturation_vapour_pressure : Pa, shape of ``temperature``; nan outside the range

    Notes
    -----
    The paper rounds 5.629 kPa at 35 °C to 5.6 kPa and 2.339 kPa at 20 °C to 2.3 kPa.

    References
    ----------
    Wagner & Pruß, J. Phys. Chem. Ref. Data 22 (1993) 783, doi 10.1063/1.555926.

    Examples
    --------
    >>> print(f"{saturation_vapour_pressure(308.15):.1f} {saturation_vapour_pressure(293.15):.1f}")
    5629.1 2339.2
    """
    with np.errstate(all="ignore"):
        kelvin, distance = _distance(temperature)
        exponent = _CRITICAL_TEMPERATURE / kelvin * _series(_PRESSURE, distance)
        return np.asarray(_CRITICAL_PRESSURE * np.exp(exponent))[()]


def density_of_water(temperature: ArrayLike) -> FloatArray:
    """Density of liquid water in equilibrium with its vapour (for the molecular volume of Appendix A of the paper).

    ``ρ/ρ_c = 1 + Σ b_i τ^(e_i)``, τ = 1 − T/T_c (IAPWS SR1-86(1992), Eq. 2).

    Parameters
    ----------
    temperature : T, from 273.15 to 647.096, K, any shape

    Returns
    -------
    density : kg/m^3, shape of ``temperature``; nan outside the range

    References
    ----------
    Wagner & Pruß, J. Phys. Chem. Ref. Data 22 (1993) 783, doi 10.1063/1.555926, Eq. 2.

    Examples
    --------
    >>> print(f"{density_of_water(293.15):.2f}")
    998.16
    """
    with np.errstate(all="ignore"):
        _, distance = _distance(temperature)
        return np.asarray(_CRITICAL_DENSITY * _series(_LIQUID, distance))[()]


def molecular_volume_of_water(temperature: ArrayLike) -> FloatArray:
    """Volume of a molecule in liquid water, ``v = M/(N_A ρ)``, for the Kelvin radius of Appendix A of the paper.

    Parameters
    ----------
    temperature : T, from 273.15 to 647.096, K, any shape

    Returns
    -------
    molecular_volume : m^3, shape of ``temperature``; nan outside the range

    References
    ----------
    Wagner & Pruß, J. Phys. Chem. Ref. Data 22 (1993) 783, doi 10.1063/1.555926, Eq. 2.

    Examples
    --------
    >>> print(f"{molecular_volume_of_water(293.15):.4e}")
    2.9970e-29
    """
    with np.errstate(all="ignore"):
        return np.asarray(MOLAR_MASS_OF_WATER / AVOGADRO_CONSTANT / density_of_water(temperature))[()]


def latent_heat_of_evaporation(temperature: ArrayLike) -> FloatArray:
    """Latent heat of evaporation, Y of Eq. 8 of the paper, from the slope of the vapour pressure (Clapeyron).

    ``Y = T (1/ρ_vapour − 1/ρ_liquid) dp/dT`` with the three formulas of IAPWS SR1-86(1992).

    Parameters
    ----------
    temperature : T, from 273.15 to 647.096, K, any shape

    Returns
    -------
    latent_heat : J/kg, shape of ``temperature``; nan outside the range

    Notes
    -----
    The paper takes 2,272 kJ/kg, which belongs to water near its boiling point; at 35 °C it is 2,418 kJ/kg, so that the
    same pressures evaporate 6 % less.

    References
    ----------
    Wagner & Pruß, J. Phys. Chem. Ref. Data 22 (1993) 783, doi 10.1063/1.555926, Eqs. 1 to 3.

    Examples
    --------
    >>> print(f"{latent_heat_of_evaporation(308.15):.4e}")
    2.4181e+06
    """
    with np.errstate(all="ignore"):
        kelvin, distance = _distance(temperature)
        pressure = saturation_vapour_pressure(kelvin)
        falls = _series(tuple((e - 1, e * a) for e, a in _PRESSURE), distance)
        slope = -pressure / kelvin * (np.log(pressure / _CRITICAL_PRESSURE) + falls)  # dp/dT
        vapour = _CRITICAL_DENSITY * np.exp(_series(_VAPOUR, distance))
        return np.asarray(kelvin * slope * (1 / vapour - 1 / density_of_water(kelvin)))[()]
