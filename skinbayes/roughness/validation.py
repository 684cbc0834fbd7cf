"""Say in words what is wrong with a spectrum."""

from __future__ import annotations

import numpy as np

from skinbayes.errors import InputError
from skinbayes.roughness.spectrum import SelfAffineSpectrum


def validate_spectrum(spectrum: SelfAffineSpectrum) -> None:
    """Refuse a self-affine spectrum that cannot exist.

    Evaluation itself never raises: impossible members of a batch give nan. Call this where a person typed the
    numbers.

    Parameters
    ----------
    spectrum : scalar or batched parameters; the first impossible member is reported

    Raises
    ------
    InputError
        if a parameter is not finite or not positive, if H > 1, or unless q0 ≤ q_r ≤ q1 and q0 < q1

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 3).

    Examples
    --------
    >>> from skinbayes.roughness import SelfAffineSpectrum
    >>> validate_spectrum(SelfAffineSpectrum(rms_height=1e-6, hurst_exponent=1.8, wavevector_min=1e4,
    ...     wavevector_rolloff=1e4, wavevector_max=1e8))
    Traceback (most recent call last):
        ...
    skinbayes.errors.InputError: hurst_exponent is 1.8, but must be at most 1.
    """
    names = ("rms_height", "hurst_exponent", "wavevector_min", "wavevector_rolloff", "wavevector_max")
    units = (" m", "", " 1/m", " 1/m", " 1/m")
    members = np.broadcast_arrays(*(np.asarray(getattr(spectrum, name)) for name in names))
    for values in zip(*(member.reshape(-1).tolist() for member in members), strict=True):
        for name, value, unit in zip(names, values, units, strict=True):
            if not (np.isfinite(value) and value > 0):
                raise InputError(f"{name} is {value:g}{unit}, but must be a finite number > 0{unit}.")
        _, hurst, q0, q_r, q1 = values
        if hurst > 1:
            raise InputError(f"hurst_exponent is {hurst:g}, but must be at most 1.")
        if not q0 < q1:
            raise InputError(
                f"wavevector_max is {q1:g} 1/m, but must be larger than wavevector_min ({q0:g} 1/m)."
            )
        if not q0 <= q_r <= q1:
            raise InputError(
                f"wavevector_rolloff is {q_r:g} 1/m, but must lie between wavevector_min ({q0:g} 1/m) and "
                f"wavevector_max ({q1:g} 1/m)."
            )
