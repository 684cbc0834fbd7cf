"""Gap distributions of a flat batch of skins, each at pressures of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any, Literal, TypeVar

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import ElasticSolid, gap_distribution
from skinbayes.roughness.spectrum import PowerSpectrum, SelfAffineSpectrum
from skinbayes.roughness.tabulated import TabulatedSpectrum
from skinbayes.wetting._mixture import Mixture

Closure = Literal["gaussian", "sharp"]
Thing = TypeVar("Thing")

VERSION_OF_BRIDGES = 1
"""Of the numbers in tables of bridges and of gaps in humid air, which are kept on disk; raise it whenever these change."""


@dataclass(frozen=True, eq=False)
class GapSource:
    """What a gap distribution is made of, apart from the pressure.

    Attributes
    ----------
    spectrum, skin : each of no batch shape or of shape ``(B,)``
    area_correction : γ, dimensionless, shape ``()`` or ``(B,)``
    closure : of `gap_distribution`
    """

    spectrum: PowerSpectrum
    skin: ElasticSolid
    area_correction: FloatArray
    closure: Closure

    def at(self, pressure: FloatArray) -> tuple[Mixture, FloatArray]:
        """Components, shape ``(B, K, n)``, and mean separation (m), shape ``(B, K)``, at pressures (Pa) of shape ``(B, K)``."""
        gaps = gap_distribution(
            pressure,
            self.spectrum,
            skin=self.skin,
            area_correction=self.area_correction,
            closure=self.closure,
        )
        # a component without weight, as all are in complete contact, may have any place
        place = np.where(np.isfinite(gaps.location), gaps.location, 0.0)
        width = np.where(gaps.width > 0, gaps.width, gaps.mean[..., None])
        return Mixture(gaps.weight, place, np.where(width > 0, width, 1.0)), gaps.mean

    def select(self, rows: Any) -> GapSource:
        """The members ``rows`` of the batch."""
        gamma = self.area_correction
        return GapSource(
            map_spectrum(self.spectrum, lambda value: value[rows]),
            map_skin(self.skin, lambda value: value[rows]),
            gamma[rows] if np.ndim(gamma) else gamma,
            self.closure,
        )


def map_spectrum(spectrum: PowerSpectrum, change: Callable[[FloatArray], FloatArray]) -> PowerSpectrum:
    """The spectrum with ``change`` applied to those of its parameters that are arrays."""
    if isinstance(spectrum, SelfAffineSpectrum):
        return _changed(spectrum, change)
    if isinstance(spectrum, TabulatedSpectrum) and np.ndim(spectrum.scale):
        return TabulatedSpectrum(
            spectrum.wavevector, spectrum.node_power, scale=change(np.asarray(spectrum.scale))
        )
    return spectrum


def map_skin(skin: ElasticSolid, change: Callable[[FloatArray], FloatArray]) -> ElasticSolid:
    """The skin with ``change`` applied to those of its parameters that are arrays."""
    return _changed(skin, change)


def batch_shapes(spectrum: PowerSpectrum, skin: ElasticSolid) -> list[tuple[int, ...]]:
    """Shapes of the parameters that make a batch."""
    things: list[Any] = [skin, spectrum] if isinstance(spectrum, SelfAffineSpectrum) else [skin]
    shapes = [np.shape(getattr(thing, field.name)) for thing in things for field in fields(thing)]
    return [*shapes, np.shape(getattr(spectrum, "scale", 1.0))]


def _changed(thing: Thing, change: Callable[[FloatArray], FloatArray]) -> Thing:
    parts: Any = thing  # a frozen dataclass
    values = ((field.name, getattr(thing, field.name)) for field in fields(parts))
    changed: Thing = replace(parts, **{name: change(value) for name, value in values if np.ndim(value)})
    return changed
