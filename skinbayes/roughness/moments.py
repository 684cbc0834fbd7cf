"""Moments of a power spectrum and the surface area they imply."""

from __future__ import annotations

import numpy as np
from scipy.special import erfcx

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.roughness.spectrum import PowerSpectrum


def spectral_moment(spectrum: PowerSpectrum, order: float) -> FloatArray:
    """Moment ``2π ∫ q^(1+order) C(q) dq`` of an isotropic power spectrum (Eq. 1 of the paper).

    Order 0 is the mean square height, order 2 the mean square of the gradient's magnitude, order 4 that of
    the Laplacian. (Nayak's moments m2 and m4 are those of a straight profile, 1/2 and 3/8 of these.)

    Parameters
    ----------
    spectrum : power spectrum, C in m^4
    order : any real number, dimensionless

    Returns
    -------
    moment : m^(2 − order), batch shape of the spectrum

    References
    ----------
    Nayak, J. Lubr. Technol. 93 (1971) 398, doi 10.1115/1.3451608.

    Examples
    --------
    >>> from skinbayes.roughness import SelfAffineSpectrum
    >>> surface = SelfAffineSpectrum(rms_height=1e-6, hurst_exponent=0.8, wavevector_min=1e4,
    ...     wavevector_rolloff=1e4, wavevector_max=1e8)
    >>> print(f"{spectral_moment(surface, 0):.3e}")
    1.000e-12
    """
    return np.asarray(2 * np.pi * spectrum.partial_moment(1.0 + order))[()]


def rms_height(spectrum: PowerSpectrum) -> FloatArray:
    """Root-mean-square height, ``sqrt(2π ∫ q C dq)`` (Eq. 1 of the paper).

    Parameters
    ----------
    spectrum : power spectrum, C in m^4

    Returns
    -------
    rms_height : m, batch shape of the spectrum

    References
    ----------
    Persson et al., J. Phys.: Condens. Matter 17 (2005) R1, doi 10.1088/0953-8984/17/1/R01.

    Examples
    --------
    >>> from skinbayes.roughness import named_surface
    >>> print(f"{rms_height(named_surface('paper_reference')):.3e}")
    2.240e-05
    """
    return np.asarray(np.sqrt(spectral_moment(spectrum, 0.0)))[()]


def rms_slope(spectrum: PowerSpectrum) -> FloatArray:
    """Root-mean-square of the gradient's magnitude, ``sqrt(2π ∫ q³ C dq)`` (Eq. 1 of the paper).

    Parameters
    ----------
    spectrum : power spectrum, C in m^4

    Returns
    -------
    rms_slope : dimensionless, batch shape of the spectrum

    References
    ----------
    Persson et al., J. Phys.: Condens. Matter 17 (2005) R1, doi 10.1088/0953-8984/17/1/R01.

    Examples
    --------
    >>> from skinbayes.roughness import named_surface
    >>> print(f"{rms_slope(named_surface('paper_reference')):.5f}")
    2.79993
    """
    return np.asarray(np.sqrt(spectral_moment(spectrum, 2.0)))[()]


def total_area_ratio(rms_slope: ArrayLike) -> FloatArray:
    """True surface area over projected area of a surface with Gaussian gradients.

    ``A_tot/A0 = ⟨sqrt(1 + |∇h|²)⟩ = 1 + (√π/2) s erfcx(1/s)``, with s the rms slope and erfcx the scaled
    complementary error function. The paper states the value for its surface in Sect. 3.

    Parameters
    ----------
    rms_slope : s, dimensionless, ≥ 0, any shape; negative gives nan

    Returns
    -------
    total_area_ratio : dimensionless, shape of ``rms_slope``

    References
    ----------
    Persson & Tosatti, J. Chem. Phys. 115 (2001) 5597, doi 10.1063/1.1398300.

    Examples
    --------
    >>> print(f"{total_area_ratio(2.8):.4f}")
    2.7295
    """
    slope = np.asarray(rms_slope, dtype=np.float64)
    with np.errstate(all="ignore"):
        ratio = 1 + np.sqrt(np.pi) / 2 * slope * erfcx(1 / slope)
        return np.where(slope > 0, ratio, np.where(slope == 0, 1.0, np.nan))[()]
