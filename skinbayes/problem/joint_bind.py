"""Bind each experiment of a model to its data, with the parameters that it takes."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

from skinbayes.errors import InputError
from skinbayes.files.dataset import Data, Dataset
from skinbayes.files.joint_model import EXPERIMENT, EXPERIMENTS, JointSpec
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.files.surface_draws import SurfaceDraws
from skinbayes.forward import ForwardModel, forward_model
from skinbayes.phrases import and_list
from skinbayes.problem.bind import bind
from skinbayes.problem.joint import JointProblem, joint_problem
from skinbayes.problem.rows import selected_dataset
from skinbayes.roughness import TabulatedSpectrum
from skinbayes.vocabulary import suggestions


def bind_joint(
    spec: JointSpec,
    data: Mapping[str, Data] | None = None,
    *,
    settings: Mapping[str, str] | None = None,
    forwards: Mapping[str, ForwardModel] | None = None,
    surface: TabulatedSpectrum | SurfaceDraws | None = None,
    rheologies: Mapping[str, Dataset] | None = None,
) -> JointProblem:
    """Make one problem of the experiments of a validated model.

    Parameters
    ----------
    spec : the model
    data : experiment to data in place of those that the model names; of a :class:`Dataset` all rows are used
    settings : values to fix; each is set in all experiments that take it, ``name[experiment]`` where it is not shared
    forwards : experiment to its forward model, if not the one of the name that the model gives
    surface : a measured spectrum in place of the surface of the model
    rheologies : experiment to flow curves in place of those that the model names

    Raises
    ------
    InputError
        Anything that does not fit together; the message says where, and in which experiment.
    """
    given = dict(data or {})
    if unknown := [name for name in given if name not in spec.experiments]:
        raise InputError(
            f"{spec.path}: data of '{unknown[0]:.60}' given.{suggestions(unknown[0], list(spec.experiments))} Expected those of "
            f"{' or '.join(spec.experiments)}"
        )
    known = {
        name: _forward_of(spec, name, forwards[name] if forwards else None, settings or {})
        for name in spec.experiments
    }
    _check_taken(spec, known)
    own_settings = _settings(spec, known, settings or {})
    bound = {}
    for name, one in spec.experiments.items():
        forward = known[name]
        alone = experiment_of(spec, name, forward)
        if name not in given and one.dataset is None:
            raise InputError(
                f"{spec.path}: {EXPERIMENTS}.{name} explains data that you bring: give them with --data {name}=FILE.csv "
                f"('skinbayes template {spec.path}' writes the header of such a file)"
            )
        try:
            found = given.get(name)
            dataset = found if found is None or isinstance(found, Dataset) else selected_dataset(alone, found)
            bound[name] = bind(
                alone,
                dataset,
                forward=forward,
                surface=surface if forward.uses_surface else None,
                rheology=(rheologies or {}).get(name),
                settings=own_settings[name],
                other_data=found is not None,
            )
        except InputError as error:
            place = f"{spec.path}: "
            if not str(error).startswith(place):
                raise
            raise InputError(f"{place}{EXPERIMENTS}.{name}: {str(error).removeprefix(place)}") from None
    return joint_problem(spec, bound, settings)


def _forward_of(
    spec: JointSpec, name: str, forward: ForwardModel | None, settings: Mapping[str, str]
) -> ForwardModel:
    """Forward model of an experiment with its options, which say what it takes."""
    one, place = spec.experiments[name], f"{spec.path}: {EXPERIMENTS}.{name}"
    forward = forward or forward_model(one.forward, f"{place}.forward")
    set_here = {
        word: settings[key]
        for word in forward.options
        for key in (word, f"{word}[{name}]")
        if key in settings
    }
    return forward.with_options(one.options | set_here, f"{place}.options")


def _check_taken(spec: JointSpec, forwards: Mapping[str, ForwardModel]) -> None:
    """Refuse parameters, and a surface, that no experiment would take."""
    for p in spec.parameters:
        takers = [p.level] if p.by == EXPERIMENT else list(forwards)
        inputs = sorted({name for taker in takers for name in forwards[str(taker)].input_names()})
        if p.name not in inputs:
            models = and_list([f"'{forwards[str(taker)].name}'" for taker in takers])
            one = len(takers) == 1
            has = f"the forward model {models} has no" if one else f"none of the forward models {models} has"
            raise InputError(
                f"{spec.path}: parameters.{p.label}: {has} such input.{suggestions(p.name, inputs)} "
                f"Expected one of {', '.join(inputs)}"
            )
    has_surface = any((spec.surface_name, spec.surface_file, spec.surface_posterior))
    if has_surface and not any(forward.uses_surface for forward in forwards.values()):
        raise InputError(f"{spec.path}: surface: none of the experiments has a rough surface; drop it")


def _of_experiment(spec: JointSpec, forward: ForwardModel, name: str) -> tuple[ParameterSpec, ...]:
    """The parameters that one experiment takes, under the names that it has for them."""
    apart = {p.name for p in spec.parameters if p.by == EXPERIMENT}

    def alone(p: ParameterSpec) -> ParameterSpec:
        if p.same_as is not None:
            root, _, level = p.same_as.removesuffix("]").partition("[")
            p = replace(p, same_as=root) if root in apart and level == name else p
        return replace(p, by=None, level=None, by_column=False) if p.by == EXPERIMENT else p

    return tuple(
        alone(p)
        for p in spec.parameters
        if p.name in forward.input_names() and (p.by != EXPERIMENT or p.level == name)
    )


def _settings(
    spec: JointSpec, forwards: Mapping[str, ForwardModel], settings: Mapping[str, str]
) -> dict[str, dict[str, str]]:
    """The settings that each experiment takes."""
    found: dict[str, dict[str, str]] = {name: {} for name in forwards}
    for key, text in settings.items():
        name, _, level = key.removesuffix("]").partition("[")
        takers = [e for e, forward in forwards.items() if name in _settable(forward)]
        if not takers:
            known = sorted({word for forward in forwards.values() for word in _settable(forward)})
            raise InputError(
                f"--set {key}: '{spec.name}' has no input '{name:.60}'.{suggestions(name, known)} It takes {', '.join(known)}"
            )
        if level in takers and name not in spec.shared:
            found[level][name] = text
        else:
            for experiment in takers:
                found[experiment][key] = text
    return found


def _settable(forward: ForwardModel) -> Collection[str]:
    surface: Sequence[str] = ("surface",) if forward.uses_surface else ()
    return {*forward.input_names(), *forward.options, *surface}


def experiment_of(spec: JointSpec, name: str, forward: ForwardModel | None = None) -> ModelSpec:
    """One experiment as a model of its own, with the parameters and the surface that it takes."""
    one = spec.experiments[name]
    forward = forward or _forward_of(spec, name, None, {})
    names = ("surface_name", "surface_file", "surface_stated", "surface_posterior")
    surface: dict[str, Any] = {key: getattr(spec, key) if forward.uses_surface else None for key in names}
    return replace(
        one,
        parameters=_of_experiment(spec, forward, name),
        **surface,
    )
