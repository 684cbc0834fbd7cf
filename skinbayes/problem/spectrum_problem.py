"""The problem that a measured spectrum poses: which surface has it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.special import digamma, polygamma

from skinbayes.errors import InputError
from skinbayes.forward.roughness_spectrum import FACTORS, KNOTS
from skinbayes.problem.build import build_problem
from skinbayes.problem.problem import Problem
from skinbayes.topography import MeasuredSpectrum

FEWEST_ROWS = 4
"""Bands below which four parameters of a spectrum cannot be asked for."""

NEVER_MEASURED = ("1e7 1/m", "1e10 1/m")
"""Wavelengths of 0.6 µm, which interferometers just miss, and of 0.6 nm, a few atoms."""


def spectrum_problem(
    measured: MeasuredSpectrum | Sequence[MeasuredSpectrum],
    *,
    shape: str = "self-affine",
    wavevector_min: float | None = None,
    parameters: Mapping[str, Any] | None = None,
    name: str = "surface",
) -> Problem:
    """The problem of finding the surface that has a measured spectrum, for :func:`skinbayes.sample`.

    One spectrum scatters as averages of periodogram ordinates do: gamma distributed with as many degrees of freedom as twice the
    ordinates averaged, beside a scatter that is fitted. Of several places each
    has an effect of its own, and ln C is taken as normal, with the mean and the variance that it has.

    Parameters
    ----------
    measured : a spectrum, or one for each place
    shape : ``"self-affine"`` with a plateau, or ``"free-form"``: that times a spline through six factors
    wavevector_min : q0 of the surface, 1/m, longer waves than those do not count as roughness; the lower end of the band if None
    parameters : priors or values in place of the usual ones, as `build_problem` takes them
    name : what the problem is called

    Returns
    -------
    Problem

    Raises
    ------
    InputError
        Spectra of fewer than four bands, or parameters that do not fit.

    Examples
    --------
    >>> import numpy as np
    >>> from skinbayes.topography import MeasuredSpectrum
    >>> q = np.geomspace(1e4, 1e6, 20)
    >>> measured = MeasuredSpectrum(q, power_spectral_density=1e-20 * (q / 1e4) ** -3.6, independent_modes=np.full(20, 50.0),
    ...     wavevector_min=1e4, wavevector_max=1e6, source="made up")
    >>> spectrum_problem(measured).names
    ('rms_height', 'hurst_exponent', 'wavevector_rolloff', 'wavevector_max', 'noise_scale')
    """
    each = [measured] if isinstance(measured, MeasuredSpectrum) else list(measured)
    if not each:
        raise InputError("no spectrum given; expected one, or one for each place")
    bands = [_reliable(one) for one in each]
    columns = _one_place(bands[0]) if len(bands) == 1 else _several_places(bands)
    low = min(one.wavevector_min for one in bands)
    high = max(one.wavevector_max for one in bands)
    least = low if wavevector_min is None else float(wavevector_min)
    if not 0 < least <= low:
        raise InputError(
            f"wavevector_min is {least:g} 1/m, but must be > 0 and at most that of the spectrum, {low:g} 1/m."
        )
    priors = _priors(least, low, high) | (_free_form(low, high) if shape == "free-form" else {})
    sources = "; ".join(dict.fromkeys(one.source for one in bands if one.source))
    return build_problem(
        "roughness-spectrum", columns, name=name, title=f"Power spectrum of {name}",
        description=f"Which surface has the measured power spectrum. {sources}".strip(),
        parameters=priors | dict(parameters or {}), options={"shape": shape}, spread="use",
        **_noise(len(bands)),
    )  # fmt: skip


def _reliable(one: MeasuredSpectrum) -> MeasuredSpectrum:
    """The bands in which a spectrum is reliable."""
    inside = one.reliable
    if inside.sum() < FEWEST_ROWS:
        raise InputError(
            f"{one.source or 'the spectrum'}: {inside.sum()} bands of wavevectors between {one.wavevector_min:g} and "
            f"{one.wavevector_max:g} 1/m; expected at least {FEWEST_ROWS}"
        )
    return replace(
        one,
        wavevector=one.wavevector[inside],
        power_spectral_density=one.power_spectral_density[inside],
        independent_modes=one.independent_modes[inside],
    )


def _one_place(one: MeasuredSpectrum) -> dict[str, Any]:
    return {
        "wavevector": one.wavevector,
        "power_spectral_density": one.power_spectral_density,
        "power_spectral_density_standard_error": one.power_spectral_density * one.relative_standard_error,
    }


def _several_places(bands: Sequence[MeasuredSpectrum]) -> dict[str, Any]:
    """All bands, corrected for the mean of the logarithm of a gamma variable, with its standard deviation."""
    q, power, modes = (
        np.concatenate([getattr(one, name) for one in bands])
        for name in ("wavevector", "power_spectral_density", "independent_modes")
    )
    power = power * modes * np.exp(-digamma(modes))
    return {
        "place": np.repeat(
            [f"place {i + 1}" for i in range(len(bands))], [one.wavevector.size for one in bands]
        ),
        "wavevector": q,
        "power_spectral_density": power,
        "power_spectral_density_standard_error": power * np.sqrt(polygamma(1, modes)),
    }


def _priors(least: float, low: float, high: float) -> dict[str, Any]:
    weak = "weak on purpose"
    most = max(float(NEVER_MEASURED[0].split()[0]), high)
    return {
        "rms_height": {"loguniform": ["1 nm", "10 mm"], "source": weak},
        "hurst_exponent": {"uniform": [0, 1], "source": weak},
        "wavevector_min": {"fixed": least, "source": "longer waves are not counted as roughness"},
        "wavevector_rolloff": {"loguniform": [least, high], "source": "anywhere in the measured band"},
        "wavevector_max": {
            "loguniform": [most, NEVER_MEASURED[1]],
            "source": "not measured: from where optical instruments end to a few atoms",
        },
    }


def _free_form(low: float, high: float) -> dict[str, Any]:
    factor = {"lognormal": [1, 0.5], "source": "the spectrum may depart from a self-affine one by a factor"}
    ends = {
        name: {"fixed": end, "source": "the measured band"}
        for name, end in zip(KNOTS, (low, high), strict=True)
    }
    return ends | dict.fromkeys(FACTORS, factor)


def _noise(places: int) -> dict[str, Any]:
    source = "beyond the scatter of periodograms: what the form of the spectrum misses"
    scale = {"half_normal": 0.2, "source": source}
    if places == 1:
        return {"noise": {"family": "gamma", "noise_scale": scale}}
    between = {"half_normal": 0.5, "source": "places on one surface differ in height by a quarter or so"}
    return {"noise": {"family": "lognormal", "noise_scale": scale}, "groups": {"place": between}}
