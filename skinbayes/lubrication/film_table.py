"""A table of films under rough lubricated balls: what it holds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.lubrication.film_axes import FILM_PARAMETERS, FilmAxes, film_parameters
from skinbayes.lubrication.film_reference import SmoothFilms

VERSION = 3
"""Of what the numbers in a table mean; tables of another version are built anew."""

CENTRAL, BOUNDARY, COUETTE, PRESSURE_FLOW, MINIMUM, FRACTION = range(6)
"""Outputs of a film: ln of H under the middle, E0 h ∫A dX/∫P dX, ∫θ dX/H, ∫H dP_f, smallest H, load fraction of asperities.

For a point contact they are those of a cylinder of the same friction and films, and the fourth is the whole drag of the liquid,
``∫H dP_f + (λ/3)∫θ dX/H``: the pressure flow up to the edge of a ball may be of either sign."""

HYSTERESIS = 6
"""One more output where the tissue remembers: ln of the hysteresis over (8/3π) sin δ b/Rc."""

REFERENCE = {CENTRAL: 0, COUETTE: 1, PRESSURE_FLOW: 2, MINIMUM: 3}
"""Outputs that are relative to those of the smooth ball, and their places among those."""

REFERENCE_WITH_MEMORY = REFERENCE | {HYSTERESIS: 4}
"""The same where the tissue remembers."""

ANCHORS = 2
"""Numbers before the outputs of a material: ln λ that speeds are counted from, and the unit of ln λ."""

SLOWEST, FASTEST = -1.3, 1.35
"""Ends of the speeds in the unit of a material. Asperities carry half of the load at 0 and 1e-3 of it at 1."""

FASTEST_OF_FACTORS = 2.65
"""The last of them with flow factors, which roughness still has where it no longer touches."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmTable:
    """Films of a rough ball as functions of λ and the axes: Chebyshev polynomials of the axes, cubic splines of ln λ.

    Attributes
    ----------
    axes : what varies, and within which ranges
    poisson_ratio_bulk : ν1, dimensionless
    contact : "point" or "line"
    coefficients : dimensionless, shape ``(n1, …, nA, 2 + 6 (S + 2))``; Chebyshev coefficients along the axes of the
        anchors and of the B-spline coefficients of the six outputs
    speeds : S, number of speeds, dimensionless
    fastest : the last of them in the unit of a material, dimensionless; the first is `SLOWEST`
    end_low, end_high : ln of the smallest and largest radius over that of the contact at which the drag of a ball ends,
        dimensionless; 0 of a line contact
    inlet_length : distance from the contact, m, at which liquid and drag end; None where the ball does
    smooth : films of the smooth ball, which the outputs but the boundary term and the load fraction are relative to
    held_out : median, 99th percentile and largest relative error of the friction coefficient at random places,
        dimensionless, shape ``(3,)``
    held_out_count : number of these places, dimensionless
    """

    axes: FilmAxes
    poisson_ratio_bulk: float
    contact: str
    coefficients: FloatArray
    speeds: int
    fastest: float
    end_low: float
    end_high: float
    inlet_length: float | None
    smooth: SmoothFilms
    held_out: FloatArray
    held_out_count: int

    def contains(self, **parameters: Any) -> BoolArray:
        """Where the table holds parameters (SI, broadcast), or balls that are similar.

        They are named as `FILM_PARAMETERS`, or as `HOMOGENEOUS_PARAMETERS`.
        """
        with np.errstate(all="ignore"):
            named = film_parameters(parameters, 1.0)
            logs = [np.log(np.asarray(named[name], dtype=np.float64)) for name in FILM_PARAMETERS]
        return self.axes.contains(logs)
