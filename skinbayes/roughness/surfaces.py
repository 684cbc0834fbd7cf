"""Named surfaces of the paper."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from skinbayes.errors import InputError
from skinbayes.roughness.spectrum import SelfAffineSpectrum


@dataclass(frozen=True, kw_only=True)
class NamedSurface:
    """A surface with a name.

    Attributes
    ----------
    name : the name used in model files
    description : where its numbers come from, and what is wrong with them, if anything
    spectrum : its power spectrum, scalar parameters
    """

    name: str
    description: str
    spectrum: SelfAffineSpectrum


def _wrist(rms_height: float, wavevector_rolloff: float) -> SelfAffineSpectrum:
    return SelfAffineSpectrum(
        rms_height=rms_height,
        hurst_exponent=0.78,
        wavevector_min=1e3,
        wavevector_rolloff=wavevector_rolloff,
        wavevector_max=1e9,
    )


_ALL = (
    NamedSurface(
        name="paper_reference",
        description="Wrist skin of Persson et al. 2013, Sect. 3, with the plateau up to q_r = 6.345e3 1/m that the text does "
        "not print but its slope of 2.8 and total area of 2.7 A0 require.",
        spectrum=_wrist(22.4e-6, 6.345e3),
    ),
    NamedSurface(
        name="paper_reference_sharp",
        description="The same amplitude at large wavevectors without a plateau: h_rms = 70.8 µm instead of 22.4 µm, "
        "slope 2.8.",
        spectrum=_wrist(70.8e-6, 1e3),
    ),
    NamedSurface(
        name="paper_printed",
        description="The four numbers printed in Persson et al. 2013, Sect. 3. Inconsistent: they give slope 0.88 and total "
        "area 1.31 A0, not the 2.8 and 2.7 A0 printed beside them. For comparison only.",
        spectrum=_wrist(22.4e-6, 1e3),
    ),
)

SURFACES: Mapping[str, NamedSurface] = MappingProxyType({surface.name: surface for surface in _ALL})
"""Every named surface by name."""


def named_surface(name: str) -> SelfAffineSpectrum:
    """The power spectrum of a named surface (Sect. 3 of the paper; see `SURFACES` for their descriptions).

    Parameters
    ----------
    name : one of ``SURFACES``

    Returns
    -------
    spectrum : self-affine spectrum in SI units (m, 1/m) with scalar parameters

    Raises
    ------
    InputError
        if there is no surface of that name; the message lists those there are

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2.

    Examples
    --------
    >>> print(f"{named_surface('paper_reference').wavevector_rolloff:.0f}")
    6345
    """
    try:
        return SURFACES[name].spectrum
    except KeyError:
        raise InputError(
            f"There is no surface called {name!r}; known surfaces are {', '.join(SURFACES)}."
        ) from None
