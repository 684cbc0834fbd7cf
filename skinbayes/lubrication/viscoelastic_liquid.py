"""Friction of a ball on viscoelastic skin with a liquid of measured flow curve: one viscosity that agrees with its film."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.lubrication.effective_viscosity import agreeing_viscosity
from skinbayes.lubrication.flow_curves import FlowCurve, liquid_rows
from skinbayes.lubrication.viscoelastic_stribeck import ViscoelasticStribeckCurve


def viscoelastic_stribeck_curve_of_liquid(
    sliding_speed: FloatArray | float,
    flow_curve: FlowCurve,
    *,
    curve: Callable[..., ViscoelasticStribeckCurve],
    **ball: Any,
) -> ViscoelasticStribeckCurve:
    """A ``curve`` of viscoelastic skin at speeds v, m/s, shape ``(K,)``, at the viscosity of the shear rate v/u of its own film.

    As `stribeck_curve_of_liquid`: u is the mean separation under the middle of the ball. ``ball`` is what ``curve`` takes beside
    speed and viscosity.
    """
    speed = np.atleast_1d(np.asarray(sliding_speed, dtype=np.float64))
    liquids = liquid_rows([flow_curve]).at(np.zeros(speed.size, dtype=np.intp))
    endless = ball | {"thickest_film": np.inf, "largest_strain": np.inf}

    def shear_rate(log_viscosity: FloatArray) -> FloatArray:
        """ln v/u."""
        films = curve(speed, np.exp(log_viscosity), **endless)
        with np.errstate(divide="ignore"):
            return np.asarray(np.log(speed / films.central_film))

    log_viscosity = agreeing_viscosity(shear_rate, liquids)
    rate = np.exp(shear_rate(log_viscosity))
    found = curve(speed, np.exp(log_viscosity), **ball)
    unmeasured = np.isfinite(found.friction_coefficient) & ~liquids.measured(rate)
    return replace(found, shear_rate_unmeasured=unmeasured)
