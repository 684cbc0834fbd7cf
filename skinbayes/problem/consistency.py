"""What must fit together between a model file, its forward model and its rows."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from skinbayes.errors import InputError
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import RESERVED_NAMES, ParameterSpec
from skinbayes.forward import ROUGHNESS_INPUTS, ForwardModel
from skinbayes.forward.base import partners
from skinbayes.problem.inputs import Conditions
from skinbayes.problem.observations import Observation
from skinbayes.roughness import PowerSpectrum
from skinbayes.vocabulary import LABELS, QUANTITIES, lookup, meant, suggestions


def near_miss(columns: Collection[str], wanted: Collection[str]) -> str:
    """A sentence on the first column of unknown name that may have been meant to be one of those wanted; empty without one."""
    for column in columns:
        if lookup(column) is None and (found := meant(column, wanted)):
            return f" The data have a column '{column}': did you mean '{found[0][0]}'?"
    return ""


def check_names(
    spec: ModelSpec, forward: ForwardModel, parameters: Sequence[ParameterSpec], conditions: Conditions
) -> None:
    """Refuse parameters that the forward model does not take, or that the data give as well."""
    known = forward.input_names()
    for parameter in parameters:
        if parameter.name not in known:
            raise InputError(
                f"{spec.path}: parameters.{parameter.name}: the forward model '{forward.name}' has no such input."
                f"{suggestions(parameter.name, list(known))} It takes {', '.join(known)}"
            )
        if parameter.name in conditions.values:
            raise InputError(
                f"{spec.path}: '{parameter.name}' is given twice: as a parameter and as a column of the data; drop one"
            )


def check_populations(spec: ModelSpec, parameters: Sequence[ParameterSpec]) -> None:
    """Refuse ties to a parameter that differs from person to person, whose value at a row is not that of the population."""
    names = {population.name for population in spec.populations}
    for p in parameters:
        if p.same_as is not None and p.same_as.partition("[")[0] in names:
            raise InputError(
                f"{spec.path}: parameters.{p.label}.same_as: '{p.same_as}' has a population, which a tied parameter cannot "
                "follow; expected a parameter without one"
            )


def check_required(
    spec: ModelSpec,
    forward: ForwardModel,
    given: set[str],
    table: PowerSpectrum | None,
    columns: Collection[str] = (),
) -> None:
    """Refuse a model that lacks an input its forward model needs, or has one that would be ignored.

    Of the ``columns`` of the data the one that may have been meant is named.
    """
    for entry in forward.required:
        if isinstance(entry, str):
            if entry not in given:
                why = f" ({forward.why_needed[entry]})" if entry in forward.why_needed else ""
                raise InputError(
                    f"{spec.path}: '{forward.name}' needs {entry}{why}: give it in [parameters] or as a column of the data."
                    f"{near_miss(columns, [entry])}".rstrip(".")
                )
        elif not any(set(names) <= given for names in entry):
            options = "; or ".join(" and ".join(names) for names in entry)
            best = max(entry, key=lambda names: len(given & set(names)) / len(names))
            absent = " and ".join(name for name in best if name not in given)
            lacking = f" Not given: {absent}." if given & set(best) else ""
            raise InputError(
                f"{spec.path}: '{forward.name}' needs {options}: in [parameters] or as columns of the data.{lacking}"
                f"{near_miss(columns, [name for names in entry for name in names if name not in given])}".rstrip(
                    "."
                )
            )
    for name in (name for name in forward.goes_with if name in given):
        lacking = " and ".join(other for other in partners(forward.goes_with, name) if other not in given)
        if lacking:
            raise InputError(
                f"{spec.path}: '{name}' has no effect without {lacking}; drop it, or give {lacking}"
            )
    inert = [name for name in ROUGHNESS_INPUTS if name in given and name != "rms_height"]
    if table is not None and inert:
        raise InputError(
            f"{spec.path}: '{inert[0]}' has no effect on a tabulated spectrum; of the roughness parameters only "
            "rms_height can be given beside one"
        )
    if (
        forward.uses_surface
        and table is None
        and (missing := [n for n in ROUGHNESS_INPUTS if n not in given])
    ):
        raise InputError(
            f"{spec.path}: the roughness is incomplete: {', '.join(missing)} missing; name a surface in [surface], or give "
            "all five roughness parameters"
        )


def check_scatter(spec: ModelSpec, observations: Sequence[Observation]) -> None:
    """Refuse data that may not scatter at all: no noise, no known spread and no discrepancy."""
    for observation in observations:
        scatter = [
            p
            for p in spec.noise_parameters
            if p.name in ("noise_scale", "discrepancy_scale") and p.level in (None, observation.name)
        ]
        if not (observation.spread > 0).all() and scatter and all(p.value == 0 for p in scatter):
            raise InputError(
                f"{spec.path}: noise: noise_scale is 0 and {observation.name} has data without a known spread, so that they "
                'could not differ from the prediction; give a noise_scale > 0, or spread = "use" with a spread for every row'
            )


def check_derived(
    spec: ModelSpec,
    forward: ForwardModel,
    parameters: Sequence[ParameterSpec],
    conditions: Conditions,
    whole_data: bool,
    further: Sequence[str] = (),
) -> None:
    """Refuse derived products of factors that do not exist, or of rows that the model's own data do not have."""
    if not spec.derived:
        return
    known = {p.name for p in parameters} | set(conditions.values) | set(forward.derived_names) | set(further)
    known |= {p.label for p in parameters if p.by_column}
    taken = {*QUANTITIES, *LABELS, *RESERVED_NAMES, *known}
    for name, block in spec.derived.items():
        if name in taken or not (name.isidentifier() and name.isascii()):
            raise InputError(
                f"{spec.path}: derived.{name[:60]}: expected a new name of letters, digits and underscores that is not the name "
                "of a quantity"
            )
        for column, levels in block.rows.items():
            if whole_data and column not in conditions.labels:
                has = ", ".join([*conditions.labels, *conditions.values]) or "none that the model takes"
                raise InputError(
                    f"{spec.path}: the data have no column '{column}', by which derived.{name} chooses rows; columns: {has}. "
                    f"Add it ('skinbayes template {spec.path.name}' prints the header that the model needs), or take what "
                    f"differs by {column} out of the model file"
                )
            unknown = set(levels) - set(conditions.labels.get(column, ()))
            if unknown and whole_data:
                raise InputError(
                    f"{spec.path}: derived.{name}.rows: no row has {column} = {sorted(unknown)[0]!r}"
                )
        for factor in block.product:
            if factor not in known:
                raise InputError(
                    f"{spec.path}: derived.{name}: unknown factor '{factor}'.{suggestions(factor, sorted(known))} "
                    f"Expected one of {', '.join(sorted(known))}"
                )
