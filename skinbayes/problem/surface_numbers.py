"""What the roughness of a problem amounts to: height, slope, true area and band."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.contact_inputs import spectrum_of
from skinbayes.roughness import rms_height, rms_slope, total_area_ratio
from skinbayes.units import format_quantity

if TYPE_CHECKING:
    from skinbayes.problem.bound import BoundModel


def surface_numbers(problem: BoundModel, theta: FloatArray) -> dict[str, float]:
    """Numbers of the surface of the first row at one parameter vector ``(D,)``, SI; empty where no surface enters.

    ``rms_height`` (m), ``rms_slope``, ``total_area_ratio`` (true over nominal area of a Gaussian surface), ``wavevector_min`` and
    ``wavevector_max`` (1/m).
    """
    if not problem.forward.uses_surface:
        return {}
    inputs = {name: np.asarray(value)[0, 0] for name, value in problem.inputs(theta[np.newaxis]).items()}
    spectrum = spectrum_of(inputs, problem.tables)
    slope = rms_slope(spectrum)
    found = {
        "rms_height": rms_height(spectrum),
        "rms_slope": slope,
        "total_area_ratio": total_area_ratio(slope),
        "wavevector_min": spectrum.wavevector_min,
        "wavevector_max": spectrum.wavevector_max,
    }
    return {name: float(np.squeeze(value)) for name, value in found.items()}


def surface_sentence(problem: BoundModel, theta: FloatArray, where: str) -> list[str]:
    """The same in a sentence; ``where`` says at which parameters. None where no surface enters."""
    words = surface_words(problem, theta)
    return [f"Surface{where}: {words}."] if words else []


def surface_words(problem: BoundModel, theta: FloatArray) -> str:
    """The same in words; empty where no surface enters."""
    found = surface_numbers(problem, theta)
    if not found:
        return ""
    low, high = (format_quantity(found[f"wavevector_{end}"], "1/m", 3) for end in ("min", "max"))
    return (
        f"rms height {format_quantity(found['rms_height'], 'm', 3)}, rms slope {found['rms_slope']:.3g}, true "
        f"area {found['total_area_ratio']:.3g} times the nominal one, wavevectors from {low} to {high}"
    )
