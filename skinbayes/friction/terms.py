"""What adds to friction at a constant shear stress: pressure in the real contact, and loss of the tissue under a ball."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray, floats


def shear_stress_under_pressure(
    frictional_shear_stress: ArrayLike,
    shear_pressure_coefficient: ArrayLike,
    *,
    relative_contact_area: ArrayLike,
    nominal_pressure: ArrayLike,
) -> FloatArray:
    """Shear stress in the area of real contact that rises with the pressure there, ``σ_f = τ0 + α p0/(A/A0)``.

    Parameters
    ----------
    frictional_shear_stress : τ0, that without pressure, Pa, ≥ 0, any shape
    shear_pressure_coefficient : α, dimensionless, ≥ 0, broadcasts
    relative_contact_area : A/A0, dimensionless, > 0, broadcasts
    nominal_pressure : p0, Pa, ≥ 0, broadcasts

    Returns
    -------
    shear_stress : σ_f, Pa, broadcast shape; nan where an argument is impossible

    Notes
    -----
    p0/(A/A0) is the mean pressure in the real contact. The law is linear, so that its mean over the contact is that at the mean
    pressure, however the pressure is distributed. Friction is then ``μ = τ0 A/(A0 p0) + α``: the second part is the same at all
    loads, whatever surface and moduli, and cannot be told from any other friction in proportion to the load. Sect. 4 of the
    paper has a constant shear stress.

    References
    ----------
    Persson, Sivebaek, Samoilov, Zhao, Volokitin & Zhang, J. Phys.: Condens. Matter 20 (2008) 395006,
    doi 10.1088/0953-8984/20/39/395006.

    Examples
    --------
    >>> print(f"{shear_stress_under_pressure(15e6, 0.1, relative_contact_area=6.48e-4, nominal_pressure=6830.0):.4e}")
    1.6054e+07
    """
    stress, coefficient, area, pressure = floats(
        frictional_shear_stress, shear_pressure_coefficient, relative_contact_area, nominal_pressure
    )
    with np.errstate(all="ignore"):
        possible = (np.minimum(np.minimum(stress, coefficient), pressure) >= 0.0) & (area > 0.0)
        return np.asarray(np.where(possible, stress + coefficient * pressure / area, np.nan))[()]


def ball_hysteresis(
    contact_radius: ArrayLike, sphere_radius: ArrayLike, *, loss_tangent: ArrayLike
) -> FloatArray:
    """Friction coefficient of a ball that ploughs through lossy tissue, ``μ = (6/π²) sin δ a/R``.

    What tissue dissipates that is pressed down before the ball and comes back behind it.

    Parameters
    ----------
    contact_radius : a, m, ≥ 0, any shape
    sphere_radius : R, m, > 0, broadcasts
    loss_tangent : tan δ of the tissue at the frequency v/a, dimensionless, ≥ 0, broadcasts

    Returns
    -------
    friction_coefficient_hysteresis : μ, dimensionless, broadcast shape; nan where an argument is impossible

    Notes
    -----
    For weak loss, the same at all frequencies near v/a, under the pressure of Hertz; the next order is less than 0.3 tan δ. With
    the contact of Hertz it grows as the load to the power 1/3, and it is the only part of dry friction that grows with it. Tissue
    that loses 25 % of the work of an indentation (Sect. 6.2 of the paper) has tan δ = 0.158.

    References
    ----------
    Greenwood & Tabor, Proc. Phys. Soc. 71 (1958) 989, doi 10.1088/0370-1328/71/6/312 (the mechanism); Persson, Eur. Phys. J. E
    33 (2010) 327, doi 10.1140/epje/i2010-10678-y (dissipation from the complex modulus).

    Examples
    --------
    >>> print(f"{ball_hysteresis(4.83e-3, 8e-3, loss_tangent=0.158):.4f}")
    0.0573
    """
    radius, ball, tangent = floats(contact_radius, sphere_radius, loss_tangent)
    with np.errstate(all="ignore"):
        possible = (np.minimum(radius, tangent) >= 0.0) & (ball > 0.0)
        sine = tangent / np.sqrt(1 + np.square(tangent))
        return np.asarray(np.where(possible, 6 / np.pi**2 * sine * radius / ball, np.nan))[()]
