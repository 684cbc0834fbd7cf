"""What we had to choose because the paper does not say it: windows, grids, where something counts as begun; no input of its."""

from __future__ import annotations

import numpy as np

FILMS = np.geomspace(1e-7, 3e-5, 120)
"""Mean films of Figs. 8 to 10, m; below 0.1 µm skin counts as dry (see `skinbayes.wetting.FILM_FLOOR`)."""

HYDRODYNAMIC = np.geomspace(1e-3, 1e-1, 9)
"""Speed times viscosity over which slopes of Fig. 11 are taken, N/m."""

PRODUCTS = np.geomspace(1e-5, 0.3, 46)
"""Speed times viscosity of the Stribeck curves of skin, N/m: plateau to where the film outgrows the ball's inlet."""

RISING = 0.1
"""Speed times viscosity from which skin is on the rising branch, N/m."""

FILM_AT_EXIT = 1e-2
"""Speed times viscosity at which the films on tissue with and without loss are compared, N/m."""

HUMIDITIES = np.concatenate([np.linspace(0.05, 0.95, 46), 1.0 - np.geomspace(0.04, 1e-3, 18)])
"""Relative humidities of Fig. 16, dimensionless."""

DRY_AIR, MOIST_AIR = 0.05, 0.9
"""Humidity taken for dry air, and the one below which the paper calls bridges negligible."""

BEGUN = 0.1
"""Fraction of the contact area that has yielded where yielding has begun."""

DECADE = np.array([0.1, 10.0])
"""Pressures over p0 between which the exponent of the area is taken."""

LOADS = np.geomspace(0.05, 5.0, 5)
"""Loads at which friction is compared, N: a decade to either side of 0.5 N."""

TISSUES = (10e3, 40e3)
"""Ends of the range of the macroscopic modulus in Sect. 1, Pa."""

RELAXATION = 0.5
"""Relaxation time of the other solid that is indented, s: that of a cycle of 2 × 2 s."""

SOFTER = 6.0
"""How much softer the skin is that is set beside skin with loss."""

SMOOTHER = 0.1
"""Roughness of the smoother surface over that of skin."""

AXIS_RATIO = 2.0
"""a/b of the ellipse at which Appendix B is evaluated."""

KELVIN_RADIUS = 1e-6
"""Size of the Kelvin radius at which Eq. 5 is evaluated, m."""

SHEAR_RATE = 1e4
"""Shear rate at which the viscosity law is evaluated, 1/s."""

WIND = 1.0
"""Speed of the air at which Eq. 8 is evaluated with its second term, m/s."""

UNEQUAL_POISSON_RATIOS = (0.3, 0.45)
"""Of layer and bulk, where Eq. 4 is evaluated with m and n that differ."""

NEW = 1.01
"""Friction over its dry, or wet, value from which it counts as another one."""

TIMES = np.linspace(0.0, 700.0, 2801)
"""Times of the drying curve, s."""

MAGNIFICATIONS = np.geomspace(1.0, 1e6, 121)
"""Magnifications of Fig. 6, q over the smallest wavevector."""

TRANSITION, SHARPNESS = 0.89, 1.5
"""Humidity at which the layer is half soft, and how abruptly, as in the shipped model; only the shape between the ends of
Fig. 17 hangs on them."""

CHOICES = (
    "The surface is paper_reference, the printed parameters with a plateau up to q_r = 6.345e3 1/m, and the contact area has the "
    "Yang–Persson correction with γ = 0.42, unless a row says otherwise.",
    f"Stribeck curves go from {PRODUCTS[0]:g} to {PRODUCTS[-1]:g} N/m; the rising branch begins at {RISING:g} N/m.",
    f"Exponents of Fig. 11 are taken from {HYDRODYNAMIC[0]:g} to {HYDRODYNAMIC[-1]:g} N/m, on smooth bodies.",
    f"Films of water go down to {FILMS[0] * 1e6:g} µm, below which skin counts as dry; its surface tension is that of "
    "water in the room.",
    f"Humidity goes from {100 * HUMIDITIES[0]:g} to {100 * HUMIDITIES[-1]:g} %; dry air is the lower end.",
    f"Yielding has begun where {100 * BEGUN:g} % of the contact area have yielded.",
    f"The area is followed by a decade to either side of p0, friction from {LOADS[0]:g} to {LOADS[-1]:g} N, tissue from "
    f"{TISSUES[0] / 1e3:g} to {TISSUES[1] / 1e3:g} kPa.",
    "Loss of the tissue is a constant loss angle for which the quoted indentation loses 25 %, with the modulus of elastic "
    "tissue at the frequency v/b of the contact, v the geometric mean of the printed speeds.",
    f"Appendix B is evaluated at a/b = {AXIS_RATIO:g}, Eq. 4 where q d = 1, Eq. 8 in still air and at {WIND:g} m/s.",
)
"""The choices in words."""
