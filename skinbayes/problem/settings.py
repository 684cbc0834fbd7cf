"""Values that the user sets over a model file: ``--set NAME=VALUE``."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from unicodedata import normalize

from skinbayes.errors import InputError
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec, parse_value
from skinbayes.forward import ROUGHNESS_INPUTS, ForwardModel
from skinbayes.forward.base import partners
from skinbayes.vocabulary import QUANTITIES, suggestions


def apply_settings(
    spec: ModelSpec, forward: ForwardModel, settings: Mapping[str, str], columns: Collection[str] = ()
) -> tuple[list[ParameterSpec], str | None, set[str]]:
    """Replace parameters of a model file by set values.

    Parameters
    ----------
    spec, forward : the model
    columns : inputs that come as columns of conditions given by the user; they win over parameters of the file
    settings : name (or ``name[level]``) to text with unit; ``surface`` names a surface or a spectrum file

    Returns
    -------
    parameters : parameters of the forward model after the settings
    surface : the surface set, or None
    names : names that were set; they win over columns of the data

    Raises
    ------
    InputError
        Unknown name or level, value without unit or outside its range, or two settings that exclude each other.
    """
    parameters = list(spec.parameters)
    surface: str | None = None
    done: set[str] = set()
    known = {*forward.input_names(), *(("surface",) if forward.uses_surface else ())}
    for written, text in settings.items():
        key = normalize("NFC", written)  # as levels have it
        if key == "surface" and forward.uses_surface:
            surface = text
            continue
        name, _, level = key.removesuffix("]").partition("[")
        if name not in known or name not in QUANTITIES:
            raise InputError(f"--set {key}: '{spec.name}' has no input '{name}'.{suggestions(name, sorted(known))} "
                             f"It takes {', '.join(sorted(known))}")  # fmt: skip
        value = parse_value(QUANTITIES[name], text, f"--set {key}")
        parameters = _replace(parameters, name, level, value, key, text)
        done.add(name)
    if surface is not None:
        # a surface that is set replaces the roughness of the file, except what is set beside it
        parameters = [p for p in parameters if p.name not in ROUGHNESS_INPUTS or p.name in done]
    parameters = [p for p in parameters if p.name not in columns or p.name in done]
    parameters, dropped = _resolve_alternatives(parameters, forward, done | set(columns))
    return parameters, surface, done | dropped


def _replace(
    parameters: list[ParameterSpec], name: str, level: str, value: float, key: str, text: str
) -> list[ParameterSpec]:
    new = ParameterSpec.of_value(name, value, "set by the user", {"fixed": text})
    if not level:
        # what the file ties to one of its levels follows the value of all of them
        return [
            *(_tied_to_whole(p, name) if p.same_as else p for p in parameters if p.name != name),
            new,
        ]
    if whole := next((p for p in parameters if p.name == name and p.same_as and p.level is None), None):
        raise InputError(
            f"--set {key}: the model file ties all of {name} to {whole.same_as}; set {name} without a level, or {whole.same_as}"
        )
    levels = [p.level for p in parameters if p.name == name]
    if level not in levels:
        found = ", ".join(str(item) for item in levels if item) or "no levels"
        raise InputError(f"--set {key}: {name} has {found}; '{level}' is not one of them")
    return [
        replace(new, by=p.by, level=level, by_column=p.by_column)
        if p.name == name and p.level == level
        else p
        for p in parameters
    ]


def _tied_to_whole(parameter: ParameterSpec, name: str) -> ParameterSpec:
    tied = str(parameter.same_as).partition("[")[0] == name
    return replace(parameter, same_as=name) if tied else parameter


def _resolve_alternatives(
    parameters: list[ParameterSpec], forward: ForwardModel, given: set[str]
) -> tuple[list[ParameterSpec], set[str]]:
    """What the user gives (a load) drops another way to say the same that stands in the file (a nominal pressure)."""
    dropped: set[str] = set()
    for entry in forward.alternatives():
        chosen = [names for names in entry if given & set(names)]
        if not chosen:
            continue
        single = [names for names in chosen if len(names) == 1]
        if single and len(chosen) > 1:
            found = sorted(given & {name for names in chosen for name in names})
            raise InputError(f"{' and '.join(found)} exclude each other; give one of them")
        others = {name for names in entry if names not in chosen for name in names}
        if single:
            dropped |= others
        else:
            dropped |= {name for names in entry if names not in chosen and len(names) == 1 for name in names}
    dropped |= {
        name
        for name in forward.goes_with
        if name not in given and dropped.intersection(partners(forward.goes_with, name))
    }
    return [p for p in parameters if p.name not in dropped], dropped
