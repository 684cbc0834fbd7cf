"""Conventions of power spectra: what programs and standards mean by C(q), as a factor on that of the paper."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Convention(NamedTuple):
    """How a spectrum is normalised.

    Attributes
    ----------
    dimensions : 2 of an area, 1 of line profiles, dimensionless
    times : its values over those of `TabulatedSpectrum` (two-dimensional) or of ``TabulatedSpectrum.from_profile``,
        dimensionless
    variance : the mean square height as an integral over wavevectors q > 0, for people
    used_by : where it is found
    """

    dimensions: int
    times: float
    variance: str
    used_by: str


CONVENTIONS = {
    "paper": Convention(2, 1.0, "⟨h²⟩ = 2π ∫ q C dq", "Persson, Kovalev & Gorb (2013), Eq. 1"),
    "contact.engineering": Convention(
        2,
        (2 * np.pi) ** 2,
        "⟨h²⟩ = (1/2π) ∫ q C dq",
        "SurfaceTopography and contact.engineering, radial averages",
    ),
    "two-sided 1-D": Convention(1, 1.0, "⟨h²⟩ = 2 ∫ C dq", "density over q from −∞ to ∞"),
    "one-sided 1-D": Convention(1, 2.0, "⟨h²⟩ = ∫ C dq", "density over q > 0"),
    "contact.engineering 1-D": Convention(
        1, 2 * np.pi, "⟨h²⟩ = (1/π) ∫ C dq", "SurfaceTopography and contact.engineering, line scans"
    ),
    "spatial frequency 1-D": Convention(
        1,
        4 * np.pi,
        "⟨h²⟩ = (1/2π) ∫ C dq = ∫ C df",
        "one-sided density over f = q/2π, as in optics standards",
    ),
}
"""Conventions by name: ``⟨h²⟩`` in each is what the surface has.

References
----------
Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, doi 10.1088/2051-672X/aa51f8.
"""
