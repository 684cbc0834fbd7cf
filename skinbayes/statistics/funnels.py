"""Coordinates without the funnel between the levels of a parameter and the scale of effects on the same levels.

Where each level of a grouping column has a parameter of its own and an effect, ratios of the parameters are known as badly as the
effects are wide: within their scale s, or within the scatter w of the data where s is smaller. Walkers would have to squeeze
through the neck at small s. With the deviations of the logarithms from their mean, less what the data say without effects,
measured in √(s² + w²), neck and mouth are equally wide: a non-centred parametrisation about the data instead of the prior. The
density stays what it is: the Jacobian is exact, whatever the centre.

Effects that are added to the data, not to their logarithms, exchange an amount with the levels, not a factor. Then the
data that a level predicts are known but for the effects: a ridge that is straight in these, bent in logarithms, with a plateau
where a level predicts less than the data resolve. :class:`Added` makes them coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import wrightomega

from skinbayes.arrays import FloatArray
from skinbayes.statistics.transforms import VectorTransform


@dataclass(frozen=True)
class Funnel:
    """Levels that share a scale.

    Attributes
    ----------
    levels : places of at least two coordinates that are logarithms, or :class:`Added`
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
class Added:
    """Levels whose coordinates are what they predict, y, on top of which effects come.

    y + w ln y: the data that a level predicts where these are resolved, their logarithm below. ln y is linear in the
    coordinates, which it is about their prior medians, so that other parameters do not bend the levels.

    Attributes
    ----------
    levels : places of J coordinates
    offsets, slopes : of ln y, J and ``(J, D)``; a level acts on its own data alone
    width : what the data of a level are known to, w > 0, in their unit
    """

    levels: tuple[int, ...]
    offsets: tuple[float, ...]
    slopes: tuple[tuple[float, ...], ...]
    width: float

    def forward(self, z: FloatArray) -> FloatArray:
        """y + w ln y of each level, shape ``(B, J)``, for coordinates ``(B, D)``."""
        log_data = z[..., list(self.levels)] * self._own + self._others(z)
        return np.exp(log_data) + self.width * log_data

    def inverse(self, z: FloatArray) -> FloatArray:
        """The coordinates of the levels, shape ``(B, J)``, where those in ``z`` are y + w ln y."""
        return (np.log(self._data(z)) - self._others(z)) / self._own

    def log_jacobian(self, z: FloatArray) -> FloatArray:
        """ln of the determinant of :meth:`inverse`, shape ``(B,)``."""
        return -np.log(np.abs(self._own) * (self._data(z) + self.width)).sum(axis=-1)

    @property
    def _own(self) -> FloatArray:
        return np.array(self.slopes)[range(len(self.levels)), list(self.levels)]

    def _others(self, z: FloatArray) -> FloatArray:
        slopes = np.array(self.slopes)
        slopes[:, list(self.levels)] = 0.0
        return np.array(self.offsets) + (slopes * z[..., np.newaxis, :]).sum(axis=-1)

    def _data(self, z: FloatArray) -> FloatArray:
        place = np.ascontiguousarray(z[..., list(self.levels)]) / self.width
        return np.asarray(self.width * wrightomega(place - np.log(self.width)))


@dataclass(frozen=True)
class FunnelTransform(VectorTransform):
    """A :class:`VectorTransform` whose funnels are straightened. Frozen, picklable.

    Attributes
    ----------
    funnels : no coordinate is a level of two of them, or level here and scale there
    added : levels that effects are added to, or None
    """

    funnels: tuple[Funnel, ...] = ()
    added: Added | None = None

    def forward(self, x: FloatArray) -> FloatArray:
        """Natural coordinates ``(B, D)`` to unconstrained ones ``(B, D)``; NaN outside the support."""
        z = super().forward(x)
        with np.errstate(all="ignore"):
            if self.added is not None:
                z[..., list(self.added.levels)] = self.added.forward(z)
            for funnel in self.funnels:
                mean, deviation = funnel.split(z)
                spread = np.exp(funnel.log_spread(z))[..., np.newaxis]
                z[..., list(funnel.levels)] = mean + (deviation - np.array(funnel.centre)) / spread
        return z

    def inverse(self, z: FloatArray) -> FloatArray:
        """Unconstrained coordinates ``(B, D)`` to natural ones ``(B, D)``."""
        return super().inverse(self._usual(z)[0])

    def log_jacobian(self, z: FloatArray) -> FloatArray:
        """ln |det dx/dz| of each row of ``z`` (shape ``(B, D)``), shape ``(B,)``."""
        usual, found = self._usual(z)
        return sum(found, super().log_jacobian(usual))

    def _usual(self, z: FloatArray) -> tuple[FloatArray, list[FloatArray]]:
        """Coordinates before anything was straightened, and ln of the determinants on the way there."""
        usual, found = np.array(z, dtype=float), []
        with np.errstate(all="ignore"):
            for funnel in self.funnels:
                mean, deviation = funnel.split(usual)
                log_spread = funnel.log_spread(usual)
                spread = np.exp(log_spread)[..., np.newaxis]
                usual[..., list(funnel.levels)] = mean + deviation * spread + np.array(funnel.centre)
                # the mean keeps its scale, the deviations, one fewer than the levels, do not
                found.append((len(funnel.levels) - 1) * log_spread)
            if self.added is not None:
                found.append(self.added.log_jacobian(usual))
                usual[..., list(self.added.levels)] = self.added.inverse(usual)
        return usual, found
