"""Coordinates in which noise with a memory is no ridge: what is new in each row, in place of the scale of the noise.

Rows that follow each other closely say how large the innovations are, scale² (1 − ρ²) with ρ the correlation of neighbours, and
hardly how large the noise is as a whole: scale and length of the memory grow together, bent where the length nears its limits.
The standard deviation of the innovations is known by itself. With ln of it as the coordinate in place of ln of the scale, the
length moves alone. The map shears: its Jacobian is that of the usual coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.statistics.transforms import VectorTransform


@dataclass(frozen=True)
class Innovations:
    """The parameters of one noise with a memory.

    Attributes
    ----------
    scales : places of the scales of the noise, coordinates that are logarithms
    length : place of the length of the memory
    gap : usual distance of neighbours, in the unit of the length
    independent : place of the fraction of the variance that is independent from row to row, or its value
    """

    scales: tuple[int, ...]
    length: int
    gap: float
    independent: int | float = 0.0

    @property
    def places(self) -> frozenset[int]:
        """Of all its coordinates."""
        independent = (self.independent,) if isinstance(self.independent, int) else ()
        return frozenset((*self.scales, self.length, *independent))

    def log_share(self, length: FloatArray | float, independent: FloatArray | float) -> FloatArray:
        """ln of the innovations over the scale, ½ ln(1 − ρ²), for lengths and independent fractions ``(B,)``.

        Examples
        --------
        >>> memory = Innovations(scales=(0,), length=1, gap=1.5)
        >>> np.exp(memory.log_share(np.array([1e-9, 6.7]), 0.0)).round(2)
        array([1. , 0.6])
        """
        log_memory = np.log1p(-np.asarray(independent)) - self.gap / length
        return np.asarray(0.5 * np.log(-np.expm1(2.0 * log_memory)))


_NOTHING = VectorTransform(())


@dataclass(frozen=True)
class InnovationTransform(VectorTransform):
    """Other coordinates, with innovations in place of scales of noise. Frozen, picklable.

    Attributes
    ----------
    usual : the other coordinates, of the same ``transforms``; it keeps each of the coordinates of a memory to itself
    memories : no coordinate belongs to two of them
    """

    usual: VectorTransform = _NOTHING
    memories: tuple[Innovations, ...] = ()

    def forward(self, x: FloatArray) -> FloatArray:
        """Natural coordinates ``(B, D)`` to unconstrained ones ``(B, D)``; NaN outside the support."""
        return self._sheared(self.usual.forward(x), 1.0)

    def inverse(self, z: FloatArray) -> FloatArray:
        """Unconstrained coordinates ``(B, D)`` to natural ones ``(B, D)``."""
        return self.usual.inverse(self._sheared(z, -1.0))

    def log_jacobian(self, z: FloatArray) -> FloatArray:
        """ln |det dx/dz| of each row of ``z`` (shape ``(B, D)``), shape ``(B,)``."""
        return self.usual.log_jacobian(self._sheared(z, -1.0))

    def _sheared(self, z: FloatArray, sign: float) -> FloatArray:
        found = np.array(z, dtype=float)
        with np.errstate(all="ignore"):
            for memory in self.memories:
                share = memory.log_share(self._value(z, memory.length), self._value(z, memory.independent))
                found[..., list(memory.scales)] += sign * share[..., np.newaxis]
        return found

    def _value(self, z: FloatArray, place: int | float) -> FloatArray | float:
        """A parameter of a memory, which the shear leaves alone; or the value it is fixed at."""
        return self.transforms[place].inverse(z[..., place]) if isinstance(place, int) else place
