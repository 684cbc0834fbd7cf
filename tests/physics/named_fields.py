"""Skins and surfaces from their parameters in a row, for tests that draw or vary all of them alike."""

from collections.abc import Iterable

from numpy.typing import ArrayLike

from skinbayes.contact import LayeredSkin
from skinbayes.roughness import SelfAffineSpectrum


def skin_from(values: Iterable[ArrayLike]) -> LayeredSkin:
    """Skin of E0, E1, ν0, ν1 and d."""
    return LayeredSkin(**dict(zip(LayeredSkin.__dataclass_fields__, values, strict=True)))


def surface_from(values: Iterable[ArrayLike]) -> SelfAffineSpectrum:
    """Surface of h_rms, H, q0, q_r and q1."""
    return SelfAffineSpectrum(**dict(zip(SelfAffineSpectrum.__dataclass_fields__, values, strict=True)))
