"""Coordinates without the funnel between the levels of a parameter and the scale of effects on the same levels.

Where each level of a grouping column has a parameter of its own and an effect, ratios of the parameters are known as badly as the
effects are wide: within their scale s, or within the scatter w of the data where s is smaller. Walkers would have to squeeze
through the neck at small s. With the deviations of the logarithms from their mean, less what the data say without effects,
measured in √(s² + w²), neck and mouth are equally wide: a non-centred parametrisation about the data instead of the prior. The
density stays what it is: the Jacobian is exact, whatever the centre.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.statistics.transforms import VectorTransform


@dataclass(frozen=True)
class Funnel:
    """Levels that share a scale.

    Attributes
    ----------
    levels : places of at least two coordinates that are logarithms
    scale : place of the coordinate that is the logarithm of s
    centre : deviations of the levels from their mean where there are no effects, sum 0
    width : what they are known to where there are no effects, w > 0
    """

    levels: tuple[int, ...]
    scale: int
    centre: tuple[float, ...]
    width: float

    def log_spread(self, z: FloatArray) -> FloatArray:
        """ln √(s² + w²), shape of ``z`` without its last axis."""
        return 0.5 * np.logaddexp(2.0 * z[..., self.scale], 2.0 * np.log(self.width))

    def split(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mean of the levels, last axis kept, and deviations from it."""
        levels = np.ascontiguousarray(z[..., list(self.levels)])
        mean = levels.mean(axis=-1, keepdims=True)
        return mean, levels - mean


@dataclass(frozen=True)
class FunnelTransform(VectorTransform):
    """A :class:`VectorTransform` whose funnels are straightened. Frozen, picklable.

    Attributes
    ----------
    funnels : no coordinate is a level of two of them, or level here and scale there
    """

    funnels: tuple[Funnel, ...] = ()

    def forward(self, x: FloatArray) -> FloatArray:
        """Natural coordinates ``(B, D)`` to unconstrained ones ``(B, D)``; NaN outside the support."""
        z = super().forward(x)
        with np.errstate(all="ignore"):
            for funnel in self.funnels:
                mean, deviation = funnel.split(z)
                spread = np.exp(funnel.log_spread(z))[..., np.newaxis]
                z[..., list(funnel.levels)] = mean + (deviation - np.array(funnel.centre)) / spread
        return z

    def inverse(self, z: FloatArray) -> FloatArray:
        """Unconstrained coordinates ``(B, D)`` to natural ones ``(B, D)``."""
        return super().inverse(self._usual(z))

    def log_jacobian(self, z: FloatArray) -> FloatArray:
        """ln |det dx/dz| of each row of ``z`` (shape ``(B, D)``), shape ``(B,)``."""
        found = super().log_jacobian(self._usual(z))
        for funnel in self.funnels:
            # the mean keeps its scale, the deviations, one fewer than the levels, do not
            found = found + (len(funnel.levels) - 1) * funnel.log_spread(z)
        return found

    def _usual(self, z: FloatArray) -> FloatArray:
        usual = np.array(z, dtype=float)
        with np.errstate(all="ignore"):
            for funnel in self.funnels:
                mean, deviation = funnel.split(usual)
                spread = np.exp(funnel.log_spread(usual))[..., np.newaxis]
                usual[..., list(funnel.levels)] = mean + deviation * spread + np.array(funnel.centre)
        return usual
