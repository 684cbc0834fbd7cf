"""The rough surface of a problem: a named one, a measured spectrum, or parameters."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.files.stated_surface import StatedSurface
from skinbayes.forward import ROUGHNESS_INPUTS
from skinbayes.roughness import TabulatedSpectrum, named_surface


@dataclass(frozen=True)
class Surface:
    """What is known about a surface.

    Attributes
    ----------
    name : of a named surface, or None
    spectrum : measured spectrum, or None
    file : its file, or None
    stated : what the model file says about it, or None
    parameters : the five roughness parameters of a named surface; empty otherwise
    """

    name: str | None = None
    spectrum: TabulatedSpectrum | None = None
    file: Path | None = None
    stated: StatedSurface | None = None
    parameters: tuple[ParameterSpec, ...] = ()


def choose_surface(spec: ModelSpec, given: str | TabulatedSpectrum | None) -> Surface:
    """The surface that is given (its name, the path of a spectrum, or a spectrum), or else that of the model file.

    Raises :class:`InputError` for a name that is not known or a file that holds no spectrum.
    """
    if isinstance(given, TabulatedSpectrum):
        return Surface(spectrum=given)
    name, file, stated = spec.surface_name, spec.surface_file, spec.surface_stated
    if given is not None:
        is_file = given.endswith(".csv") or Path(given).exists()
        name, file, stated = (None, Path(given), None) if is_file else (given, None, None)
    if file is not None:
        from skinbayes.files.spectrum import read_spectrum

        return Surface(spectrum=read_spectrum(file, stated), file=file.resolve(), stated=stated)
    if name is None:
        return Surface()
    try:
        named = named_surface(name)
    except InputError as error:
        raise InputError(f"{spec.path}: surface.name: {error}") from None
    values = {key: float(np.asarray(getattr(named, key))) for key in ROUGHNESS_INPUTS}
    parameters = (ParameterSpec.of_value(key, value, f"surface {name}") for key, value in values.items())
    return Surface(name=name, parameters=tuple(parameters))
