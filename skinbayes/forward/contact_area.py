"""Forward model ``contact-area``: the relative contact area against wavevector or magnification (Eqs. 2–4, Fig. 6)."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import effective_modulus, surface_response, twice_stress_variance
from skinbayes.forward.base import ForwardModel, Inputs, Profile, Tables
from skinbayes.forward.contact_inputs import (
    ENTERS_VARIANCE,
    FURTHER,
    PRESSURE_ALTERNATIVES,
    PRESSURE_AND_SLOPE,
    SOLID_ALTERNATIVES,
    contact_area_of,
    skin_of,
    spectrum_of,
    validate_contact,
)
from skinbayes.roughness import PowerSpectrum


def wavevector_of(inputs: Inputs, spectrum: PowerSpectrum) -> FloatArray:
    """Return the largest wavevector included [1/m]: given, from the magnification (q = ζ q0), or the end of the band."""
    if "wavevector" in inputs:
        return np.asarray(inputs["wavevector"], dtype=float)
    if "magnification" in inputs:
        return np.asarray(inputs["magnification"] * spectrum.wavevector_min, dtype=float)
    return np.asarray(spectrum.wavevector_max, dtype=float)


def _twice_stress_variance(inputs: Inputs, tables: Tables, wavevector: FloatArray) -> FloatArray:
    """Twice the stress variance at one wavevector a row, shape ``(B, N)``."""
    if all(np.shape(inputs[name])[-1:] in ((), (1,)) for name in ENTERS_VARIANCE if name in inputs):
        # nothing but the wavevector differs from row to row: one cumulative integral serves all rows
        batch = {
            name: np.atleast_2d(value)[:, 0] for name, value in inputs.items() if name in ENTERS_VARIANCE
        }
        return twice_stress_variance(
            spectrum_of(batch, tables), skin_of({**inputs, **batch}), wavevector=wavevector
        )
    return twice_stress_variance(
        spectrum_of(inputs, tables), skin_of(inputs), wavevector=wavevector[..., np.newaxis]
    )[..., 0]


def _evaluate(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    spectrum, skin = spectrum_of(inputs, tables), skin_of(inputs)
    wavevector = wavevector_of(inputs, spectrum)
    area = contact_area_of(inputs, tables, _twice_stress_variance(inputs, tables, wavevector))
    return {
        "relative_contact_area": area.total,
        "relative_contact_area_elastic": area.elastic,
        "relative_contact_area_plastic": area.plastic,
        "plastic_fraction": area.plastic_fraction,
        "surface_response": surface_response(skin, wavevector[..., np.newaxis])[..., 0],
        "effective_modulus": effective_modulus(skin, wavevector[..., np.newaxis])[..., 0],
    }


def _grid(inputs: Inputs, tables: Tables) -> FloatArray:
    spectrum = spectrum_of(inputs, tables)
    return np.geomspace(np.min(spectrum.wavevector_min), np.max(spectrum.wavevector_max), 121)


def _profile(inputs: Inputs, tables: Tables, wavevector: FloatArray) -> FloatArray:
    spectrum = spectrum_of(inputs, tables)
    column = {name: np.asarray(value)[..., np.newaxis] for name, value in inputs.items()}
    return contact_area_of(
        column, tables, twice_stress_variance(spectrum, skin_of(inputs), wavevector=wavevector)
    ).total


CONTACT_AREA_PROFILE = Profile(
    name="contact_area",
    title="Contact area against magnification",
    abscissa="wavevector",
    ordinate="relative_contact_area",
    grid=_grid,
    evaluate=_profile,
)
"""Fig. 6 of the paper: how the contact area shrinks as finer roughness is resolved."""

MODEL = ForwardModel(
    name="contact-area",
    summary="relative contact area of rough elastoplastic skin or another solid against wavevector or magnification",
    observables=(
        "relative_contact_area",
        "relative_contact_area_elastic",
        "relative_contact_area_plastic",
        "plastic_fraction",
        "surface_response",
        "effective_modulus",
    ),
    required=(SOLID_ALTERNATIVES, PRESSURE_ALTERNATIVES),
    **{**FURTHER, "accepted": (*FURTHER["accepted"], "wavevector", "magnification")},
    exclusive=((("wavevector",), ("magnification",)),),
    evaluate=_evaluate,
    validate=validate_contact,
    **PRESSURE_AND_SLOPE,
    profiles=(CONTACT_AREA_PROFILE,),
)
