"""``[noise]`` of a model file: how each observable scatters about the forward model."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from skinbayes.errors import InputError
from skinbayes.files.parameter_block import ParameterSpec, parse_levels, parse_parameter
from skinbayes.plugins import NOISE_FAMILIES as ENTRY_POINTS
from skinbayes.plugins import check_name, installed
from skinbayes.statistics.noise import NoiseFamily
from skinbayes.statistics.noise_families import NOISE_FAMILIES, register_noise
from skinbayes.vocabulary import QUANTITIES, Quantity, suggestions

NOISE_PARAMETERS = ("noise_scale", "discrepancy_factor", "discrepancy_scale")
"""Parameters of ``[noise]`` that every family has; those of the shape of a family come to them."""


OBSERVABLE = "observable"
"""What the noise of a model with several observables differs by."""


def unusable_noise_families() -> dict[str, str]:
    """What is wrong with noise families of installed packages that cannot be used; the others become known."""
    return installed(ENTRY_POINTS, _accept)[1]


def _accept(name: str, family: NoiseFamily) -> None:
    check_name(name, family, "NoiseFamily")
    register_noise(family)


def noise_parameter_names() -> tuple[str, ...]:
    """Every parameter that can stand in ``[noise]``, of all families that are known."""
    shapes = [name for family in NOISE_FAMILIES.values() for name in family.shape_parameters]
    return tuple(dict.fromkeys((*NOISE_PARAMETERS, *shapes)))


def read_noise(
    block: dict[str, Any], observables: list[str], several: bool, where: Callable[..., str]
) -> tuple[dict[str, str], tuple[ParameterSpec, ...]]:
    """Read ``[noise]``.

    Parameters
    ----------
    block : its content: the noise of the one observable, or, where there are ``several``, one table for each
    observables : names
    several : whether the model file lists observables
    where : place of a key, for messages

    Returns
    -------
    families : observable to name of its noise family
    parameters : all parameters of noise and discrepancy; ``noise_scale[peak_time]`` where there are several observables

    Raises
    ------
    InputError
        Unknown family, key or observable, or a parameter missing.
    """
    for observable in observables:
        if observable not in QUANTITIES:
            key = "observables" if several else "observable"
            raise InputError(
                f"{where('data', key)}: unknown quantity '{observable}'.{suggestions(observable, list(QUANTITIES))}"
            )
    if not several:
        family, parameters = _one_observable(block, observables[0], None, where, ("noise",))
        return {observables[0]: family}, parameters
    if unknown := [name for name in block if name not in observables]:
        raise InputError(
            f"{where('noise', unknown[0])}: found {unknown[0]!r}.{suggestions(unknown[0], observables)} "
            f"Expected one table for each observable: {', '.join(f'[noise.{name}]' for name in observables)}"
        )
    families: dict[str, str] = {}
    found: tuple[ParameterSpec, ...] = ()
    for observable in observables:
        place = ("noise", observable)
        entry = block.get(observable)
        if not isinstance(entry, dict):
            raise InputError(f"{where(*place)}: [noise.{observable}] is missing")
        families[observable], parameters = _one_observable(entry, observable, observable, where, place)
        found += parameters
    return families, found


def _one_observable(
    block: dict[str, Any],
    observable: str,
    level: str | None,
    where: Callable[..., str],
    place: tuple[str, ...],
) -> tuple[str, tuple[ParameterSpec, ...]]:
    family, broken = block.get("family"), unusable_noise_families()
    names = list(NOISE_FAMILIES)
    if family not in names:
        if str(family) in broken:
            raise InputError(
                f"{where(*place, 'family')}: the noise family '{family}' is {broken[str(family)]}"
            )
        hint = suggestions(str(family), names)
        raise InputError(
            f"{where(*place, 'family')}: found {family!r}.{hint} Expected one of {', '.join(names)}"
        )
    noise = NOISE_FAMILIES[str(family)]
    unit = "1" if noise.relative else QUANTITIES[observable].unit
    parameters: list[ParameterSpec] = []
    for name, entry in block.items():
        if name == "family":
            continue
        quantity = _noise_quantity(name, noise, where(*place, name))
        unit_here = unit if name == "noise_scale" else None
        if level is None:
            parameters += parse_levels(
                quantity, entry, lambda *keys, name=name: where(*place, name, *keys), unit_here
            )
        else:
            parameters.append(
                parse_parameter(quantity, entry, where(*place, name), unit_here, OBSERVABLE, level)
            )
    given = {parameter.name for parameter in parameters}
    if missing := [name for name in ("noise_scale", *noise.shape_parameters) if name not in given]:
        raise InputError(f"{where(*place)}: noise family '{family}' needs {' and '.join(missing)}")
    return str(family), tuple(parameters)


def _noise_quantity(name: str, noise: NoiseFamily, where: str) -> Quantity:
    if name not in (*NOISE_PARAMETERS, *noise.shape_parameters):
        if owners := [other.name for other in NOISE_FAMILIES.values() if name in other.shape_parameters]:
            raise InputError(
                f"{where}: noise family '{noise.name}' has no {QUANTITIES[name].meaning if name in QUANTITIES else name}; "
                f"{' and '.join(owners)} {'have' if len(owners) > 1 else 'has'}"
            )
        known = ["family", *NOISE_PARAMETERS, *noise.shape_parameters]
        raise InputError(
            f"{where}: unknown key '{name}'.{suggestions(name, known)} Expected {', '.join(known)}"
        )
    if name not in QUANTITIES:
        raise InputError(
            f"{where}: '{name}' of noise family '{noise.name}' is no known quantity; declare it first with "
            "skinbayes.register_quantity"
        )
    return QUANTITIES[name]
