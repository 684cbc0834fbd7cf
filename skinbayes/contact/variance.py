"""Width of the distribution of contact stress that roughness causes."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.solid import ElasticSolid
from skinbayes.roughness._fields import with_axes
from skinbayes.roughness.spectrum import PowerSpectrum

SATURATION = 10.0
"""qd above which S is taken as 1 when stresses are summed over wavevectors; S² − 1 is below 4e-7 there."""


def twice_stress_variance(
    spectrum: PowerSpectrum, skin: ElasticSolid, *, wavevector: ArrayLike | None = None
) -> FloatArray:
    """Twice the variance of the stress in complete contact, ``V = π ∫ q³ C(q) E_eff(q)² dq = 2 ⟨(σ − p0)²⟩``, Pa².

    V is ``4 p0² G`` with G of Eq. 3 of the paper; √V is what pressure is divided by in the error functions of the theory.

    Parameters
    ----------
    spectrum : power spectrum, C in m^4
    skin : moduli in Pa, thickness in m; broadcasts with the spectrum
    wavevector : upper end of the band, 1/m, shape ``(K,)`` or ``(..., K)``, or a scalar; None for the whole
        band. Below the band V is 0, beyond it V is that of the whole band.

    Returns
    -------
    twice_stress_variance : Pa², batch shape, plus the axis of ``wavevector`` if given; nan for impossible
        parameters

    Notes
    -----
    Gauss–Legendre in ln q where the layer is felt, a closed form above. The relative error is below 1e-7 for
    skin (d from 5 to 100 µm, q0 from 3e2 to 5e3 1/m, E0/E1 from 1 to 1e6), and below 5e-5 for d from 0.1 µm
    to 1 mm, q0 from 1e2 to 1e5 1/m and E0/E1 from 1e-3 to 1e7; 3e-4 with a plateau of eight decades. A tabulated
    spectrum is integrated to 2e-5 of V at every wavevector.

    References
    ----------
    Persson, J. Chem. Phys. 115 (2001) 3840, doi 10.1063/1.1388626.

    Examples
    --------
    >>> from skinbayes.roughness import named_surface
    >>> from skinbayes.contact import LayeredSkin
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> print(f"{twice_stress_variance(named_surface('paper_reference'), wet):.5e}")
    3.36644e+14
    """
    if wavevector is None:
        upper, axes = None, 0
    else:
        upper, axes = np.atleast_1d(np.asarray(wavevector, dtype=np.float64)), 1
    with np.errstate(all="ignore"):
        total = integrated(spectrum, skin, upper, axes)
    return np.asarray(total if wavevector is None or np.ndim(wavevector) else total[..., 0])[()]


def integrated(
    spectrum: PowerSpectrum, skin: ElasticSolid, upper: FloatArray | None = None, axes: int = 0
) -> FloatArray:
    """`twice_stress_variance` up to wavevectors on ``axes`` last axes, or of the whole band; silences no warnings."""
    saturation = SATURATION / skin.transition_length
    nodes, weights, remainder = spectrum.slope_quadrature(saturation, upper)
    # sums must run along a contiguous last axis, so that a batch and its rows agree to the last bit
    terms = np.ascontiguousarray(weights * np.square(skin.inverse_response(nodes, axes + 1)))
    modulus = with_axes(skin.surface_modulus, axes)
    return np.asarray(np.pi * np.square(modulus) * (terms.sum(axis=-1) + remainder))
