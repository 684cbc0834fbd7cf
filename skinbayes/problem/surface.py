"""The rough surface of a problem: a named one, a measured spectrum, or parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.files.stated_surface import StatedSurface
from skinbayes.files.surface_draws import SurfaceDraws, holds_draws, read_surface_draws
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
    parameters : the five roughness parameters of a named surface, or those that draws of a surface leave fixed
    draws : what an earlier fit, or the user, knows of the surface, or None
    """

    name: str | None = None
    spectrum: TabulatedSpectrum | None = None
    file: Path | None = None
    stated: StatedSurface | None = None
    parameters: tuple[ParameterSpec, ...] = ()
    draws: SurfaceDraws | None = None


def choose_surface(spec: ModelSpec, given: str | TabulatedSpectrum | SurfaceDraws | None) -> Surface:
    """The surface that is given (its name, the path of a spectrum or of draws, or either), or else that of the model file.

    Raises :class:`InputError` for a name that is not known or a file that holds no spectrum.
    """
    if isinstance(given, TabulatedSpectrum):
        return Surface(spectrum=given)
    if isinstance(given, SurfaceDraws):
        return _of_draws(given)
    name, file, stated = spec.surface_name, spec.surface_file, spec.surface_stated
    draws = spec.surface_posterior
    if given is not None:
        is_file = given.endswith((".csv", ".nc")) or Path(given).exists()
        name, file, stated = (None, Path(given), None) if is_file else (given, None, None)
        draws = file if file is not None and holds_draws(file) else None
    if draws is not None:
        return _of_draws(read_surface_draws(draws))
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
    return Surface(name=name, parameters=_parameters(values, f"surface {name}"))


def _of_draws(draws: SurfaceDraws) -> Surface:
    return Surface(draws=draws, parameters=_parameters(draws.fixed, f"the surface of {draws.source}"))


def _parameters(values: Mapping[str, float], source: str) -> tuple[ParameterSpec, ...]:
    return tuple(ParameterSpec.of_value(key, value, source) for key, value in values.items())
