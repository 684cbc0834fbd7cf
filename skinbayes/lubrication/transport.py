"""How a film conducts liquid and drags it along, in the units of a solver: flow factors and viscosity."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.lubrication.flow_factors import FlowFactors, TrivialFlowFactors
from skinbayes.lubrication.newton import Transport
from skinbayes.lubrication.rheology import Rheology


def no_asperities(film: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The asperity law of smooth surfaces: no pressure, no slope."""
    zero = np.zeros_like(film)
    return zero, zero


def _smooth_transport(film: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    square = film * film
    return square * film, 3 * square, film, np.ones_like(film)


def transport_of(
    flow_factors: FlowFactors | None, rheology: Rheology | None, height: float, per_product: float
) -> Callable[[float], Transport]:
    """Film law at each lubrication number: conductance φ_p H³ η0/η and dragged volume H + Φ_s, with slopes."""
    if flow_factors is None and rheology is None:
        return lambda number: _smooth_transport
    factors = flow_factors if flow_factors is not None else TrivialFlowFactors()

    def at(number: float) -> Transport:
        speed = 0.0 if rheology is None else number / per_product / rheology.low_shear_viscosity

        def transport(film: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
            factor, factor_slope, shear, shear_slope = factors.flow(film * height)
            cube = film**3
            conduct = factor * cube
            slope = 3 * factor * film * film + factor_slope * height * cube
            if rheology is not None:
                thinning, power = rheology.relative(speed / (film * height))
                conduct = conduct / thinning
                slope = slope / thinning + conduct * power / film
            return conduct, slope, film + shear / height, 1 + shear_slope

        return transport

    return at
