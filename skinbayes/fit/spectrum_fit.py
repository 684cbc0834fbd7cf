"""Fit of a measured power spectrum."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from skinbayes.fit.fit import Fit
from skinbayes.fit.run import sample
from skinbayes.problem.spectrum_problem import spectrum_problem

if TYPE_CHECKING:
    from skinbayes.topography import MeasuredSpectrum


def fit_spectrum(
    measured: MeasuredSpectrum | Sequence[MeasuredSpectrum],
    *,
    shape: str = "self-affine",
    wavevector_min: float | None = None,
    parameters: Mapping[str, Any] | None = None,
    name: str = "surface",
    **options: Any,
) -> Fit:
    """Which surface has a measured power spectrum: its posterior, including waves shorter than any that were measured.

    C(q) is constant up to the roll-off q_r and falls as q^(−2(1+H)) up to q1, Sect. 3 of the paper; ``"free-form"`` multiplies
    that with a spline through six factors. Averages of periodogram ordinates are gamma distributed about C. ``wavevector_max``,
    q1, has a prior of its own that the data hardly change, and its uncertainty is in that of ``rms_slope`` and
    ``total_area_ratio``.

    Parameters
    ----------
    measured : a spectrum, or one for each place; scatter between places is an effect of ``place``
    shape : ``"self-affine"`` or ``"free-form"``; `skinbayes.compare` says which the data prefer
    wavevector_min : q0, 1/m; the lower end of the measured band if None
    parameters : priors or values in place of the usual ones, such as ``{"wavevector_max": "1e9 1/m"}``
    name : what the fit is called
    options : of :func:`skinbayes.sample`, such as ``seed``, ``ess``, ``directory``

    Returns
    -------
    Fit
        Draws of ``rms_height`` (of all waves from q0 to q1), ``hurst_exponent``, ``wavevector_rolloff``, ``wavevector_max``,
        ``rms_slope`` and ``total_area_ratio``. ``fit.surface()`` carries them into a friction model.

    Raises
    ------
    InputError
        Spectra of fewer than four bands in their reliable range, or parameters that do not fit.

    References
    ----------
    Percival & Walden, Spectral Analysis for Physical Applications (1993), doi 10.1017/CBO9780511622762.

    Examples
    --------
    >>> import numpy as np
    >>> from skinbayes.topography import MeasuredSpectrum
    >>> q = np.geomspace(1e4, 1e6, 20)
    >>> measured = MeasuredSpectrum(q, power_spectral_density=1e-20 * (q / 1e4) ** -3.6, independent_modes=np.full(20, 500.0),
    ...     wavevector_min=1e4, wavevector_max=1e6, source="made up")
    >>> fit = fit_spectrum(measured, seed=1, ess=200)
    >>> print(f"{fit.quantiles('hurst_exponent')[1]:.1f}")
    0.8
    """
    problem = spectrum_problem(
        measured, shape=shape, wavevector_min=wavevector_min, parameters=parameters, name=name
    )
    return sample(problem, **options)
