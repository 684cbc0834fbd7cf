"""Forward model ``roughness-spectrum``: the power spectrum of a rough surface against wavevector (Eq. 1, Figs. 3 and 4)."""

from __future__ import annotations

from functools import partial

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.forward.base import ROUGHNESS_INPUTS, ForwardModel, Inputs, Tables
from skinbayes.roughness import SelfAffineSpectrum, rms_slope, total_area_ratio, validate_spectrum
from skinbayes.roughness.spline import natural_spline

FACTORS = tuple(f"spectrum_factor_{i}" for i in range(1, 7))
"""Factors on the spectrum at knots at equal ratios of wavevectors, between which a spline runs."""

KNOTS = ("spectrum_knot_first", "spectrum_knot_last")

_POINTS = 400
"""Wavevectors over the whole band at which mean square height and slope of a free form are summed."""


def _spectrum(inputs: Inputs) -> tuple[SelfAffineSpectrum, dict[str, FloatArray]]:
    """The self-affine spectrum, and all inputs but the wavevector, each ``(B or 1, N or 1, 1)``."""
    column = {name: np.atleast_2d(value)[..., None] for name, value in inputs.items() if name != "wavevector"}
    return SelfAffineSpectrum(**{name: column[name][..., 0] for name in ROUGHNESS_INPUTS}), column


def _log_factor(column: Inputs, wavevector: FloatArray) -> FloatArray:
    """ln of the factor on the self-affine spectrum at wavevectors ``(..., K)``; constant beyond the knots."""
    first, last = (np.unique(column[name]) for name in KNOTS)
    values = np.stack(np.broadcast_arrays(*(np.log(column[name]) for name in FACTORS)), axis=-1)
    return natural_spline(np.log(wavevector / first[0]) / np.log(last[0] / first[0]), values)


def _means(spectrum: SelfAffineSpectrum, column: Inputs) -> tuple[FloatArray, FloatArray]:
    """Means of the factor with the weights of mean square height and of mean square slope, ``(B, N or 1)``."""
    share = np.linspace(0.0, 1.0, _POINTS)
    low, high = np.log(column["wavevector_min"]), np.log(column["wavevector_max"])
    q = np.exp(low + share * (high - low))
    # relative to q at the ends of the weights, so that no power of q overflows
    power = spectrum.power(np.clip(q, np.exp(low), np.exp(high)))
    factor = np.exp(_log_factor(column, q))
    found = []
    for order in (2, 4):
        weight = power * q**order
        found.append(np.trapezoid(weight * factor, share) / np.trapezoid(weight, share))
    return found[0], found[1]


def _evaluate(inputs: Inputs, tables: Tables, shape: str) -> dict[str, FloatArray]:
    spectrum, column = _spectrum(inputs)
    q = np.atleast_2d(inputs["wavevector"])
    power = spectrum.power(q[..., None])[..., 0]
    if shape == "free-form":
        # the rms height stays that of the whole spectrum, whatever the factors are
        power = power * np.exp(_log_factor(column, q[..., None])[..., 0]) / _means(spectrum, column)[0]
    return {"power_spectral_density": power}


def _derived(inputs: Inputs, tables: Tables, shape: str) -> dict[str, FloatArray]:
    spectrum, column = _spectrum(inputs)
    slope = rms_slope(spectrum)
    if shape == "free-form":
        of_height, of_slope = _means(spectrum, column)
        slope = slope * np.sqrt(of_slope / of_height)
    return {"rms_slope": slope, "total_area_ratio": total_area_ratio(slope)}


def _validate(inputs: Inputs, tables: Tables, shape: str) -> None:
    validate_spectrum(_spectrum(inputs)[0])
    if shape != "free-form":
        return
    first, last = (np.unique(inputs[name]) for name in KNOTS)
    if first.size > 1 or last.size > 1 or not first[0] < last[0]:
        raise InputError(
            f"{KNOTS[0]} and {KNOTS[1]} are {first[0]:g} and {last[0]:g} 1/m; expected one fixed value each, the second larger"
        )


def _variant(shape: str = "self-affine") -> ForwardModel:
    return ForwardModel(
        name="roughness-spectrum",
        summary="power spectrum of a rough surface against wavevector: self-affine with a plateau, or of a free form",
        observables=("power_spectral_density",),
        required=("wavevector", *((*KNOTS, *FACTORS) if shape == "free-form" else ())),
        evaluate=partial(_evaluate, shape=shape),
        derived=partial(_derived, shape=shape),
        derived_names=("rms_slope", "total_area_ratio"),
        blocks=("rms_slope",),
        validate=partial(_validate, shape=shape),
        options={"shape": ("self-affine", "free-form")},
        variant=_variant,
        chosen={"shape": shape},
    )


MODEL = _variant()
