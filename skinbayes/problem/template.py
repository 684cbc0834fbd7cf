"""Which columns the data of a model need: the header of a CSV to be filled in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from skinbayes.errors import InputError
from skinbayes.files.find_dataset import find_dataset
from skinbayes.files.joint_model import load_joint_model
from skinbayes.files.modelfile import ModelSpec, load_model
from skinbayes.files.parameter_block import label_column
from skinbayes.files.scatter_block import ORDER
from skinbayes.files.table import read_table
from skinbayes.forward import ROUGHNESS_INPUTS, ForwardModel, forward_model
from skinbayes.forward.base import partners
from skinbayes.problem.joint_bind import experiment_of
from skinbayes.problem.rheology import REPLACED
from skinbayes.units import split_header
from skinbayes.vocabulary import LABELS, QUANTITIES, STANDARD_DEVIATION_SUFFIX, suggestions


@dataclass(frozen=True)
class TemplateColumn:
    """A column that the data of a model need.

    Attributes
    ----------
    name : quantity, spread of a quantity, or label
    unit : SI unit; None for labels
    meaning : what the column holds
    why : why the model needs it
    """

    name: str
    unit: str | None
    meaning: str
    why: str

    @property
    def header(self) -> str:
        """As it stands in the header of the CSV."""
        return self.name if self.unit is None else f"{self.name} [{self.unit}]"


@dataclass(frozen=True)
class DataTemplate:
    """The header of a CSV for a model.

    Attributes
    ----------
    model : name of the model
    columns : labels, inputs and observables, each with its spread if the model uses it
    notes : sentences on choices that a user has
    """

    model: str
    columns: tuple[TemplateColumn, ...]
    notes: tuple[str, ...]

    @property
    def header(self) -> str:
        """The header line of the CSV."""
        return ",".join(column.header for column in self.columns)


def data_template(name: str | Path) -> DataTemplate:
    """Columns that the data of a model need, derived from its model file; the data themselves need not exist.

    Parameters
    ----------
    name : shipped model or path of a model file

    Returns
    -------
    DataTemplate
        the observables, the inputs that the forward model requires and the model file does not give, and the label columns
        that it names. Of alternative sets of inputs the one that the model's own data have, or else the first of those that
        lack least and use most of what is given

    Raises
    ------
    InputError
        for a model file that cannot be used

    Examples
    --------
    >>> data_template("drying").header
    'time [s],friction_coefficient [1]'
    """
    return template_of(load_model(name))


def joint_templates(name: str | Path) -> dict[str, DataTemplate]:
    """Columns that the data of each experiment of a model need, by its name."""
    spec = load_joint_model(name)
    return {experiment: template_of(experiment_of(spec, experiment)) for experiment in spec.experiments}


def template_of(spec: ModelSpec) -> DataTemplate:
    """Columns that the data of a validated model need."""
    forward = forward_model(spec.forward, f"{spec.path}: forward").with_options(spec.options)
    notes: list[str] = []
    labels = [
        TemplateColumn(label, None, LABELS.get(label, "label of the row"), why)
        for label, why in _labels(spec).items()
    ]
    used = "the model uses the spread of its inputs" if spec.input_spread == "use" else ""
    inputs = _columns(_inputs(spec, forward, notes), used)
    added = "the model adds it to its noise" if spec.spread == "use" else ""
    why = "what the model explains" if spec.observables else "what the model predicts"
    observables = _columns(dict.fromkeys(spec.observables or forward.observables[:1], why), added)
    if not spec.observables:
        others = ", ".join(forward.observables[1:])
        notes.append(
            "This model has no data: to fit some, give a copy of its file a [data] and a [noise] block; for 'predict "
            f"--conditions' leave out {forward.observables[0]}."
            + (f" It also predicts {others}." if others else "")
        )
    notes.append("Any unit that converts may stand in the brackets, such as mm/s; every row needs all cells.")
    return DataTemplate(spec.name, (*labels, *inputs, *observables), tuple(notes))


def _columns(reasons: Mapping[str, str], why_spread: str) -> list[TemplateColumn]:
    """Columns of quantities, each with the reason why; those of their spreads as well if there is a reason for them."""
    found = []
    for name, why in reasons.items():
        unit, meaning = (
            QUANTITIES[name].unit,
            f"standard deviation of {name} in this row, such as its reading error",
        )
        found.append(TemplateColumn(name, unit, QUANTITIES[name].meaning, why))
        if why_spread:
            found.append(TemplateColumn(name + STANDARD_DEVIATION_SUFFIX, unit, meaning, why_spread))
    return found


def _labels(spec: ModelSpec) -> dict[str, str]:
    """Label column to the reason why the model needs it."""
    reasons: dict[str, list[str]] = {}
    levels: dict[tuple[str, str], list[str]] = {}
    for parameter in (*spec.parameters, *spec.noise_parameters):
        if parameter.by_column and parameter.level is not None:
            levels.setdefault((str(parameter.by), parameter.name), []).append(parameter.level)
    for (column, name), known in levels.items():
        reasons.setdefault(column, []).append(f"{name} differs by it: {', '.join(known)}")
    for scale in spec.groups:
        reasons.setdefault(str(scale.level), []).append("rows with the same one share an effect")
    for block in (spec.discrepancy, spec.correlation):
        if block is not None and block.within is not None:
            reasons.setdefault(block.within, []).append("each has a curve or a series of its own")
    for column, kept in spec.rows.items():
        label_column(column, f"{spec.path}: data.rows")
        own = _own_columns(spec)
        if own and column not in own:
            raise InputError(
                f"{spec.path}: data.rows: the data of the model have no column '{column}'.{suggestions(column, own)}"
            )
        reasons.setdefault(column, []).append(f"the model takes the rows with {', '.join(kept)}")
    for population in spec.populations:
        for column in population.columns:
            reasons.setdefault(column, []).append(f"{population.name} has a population over it")
    if spec.rheology_by is not None:
        reasons.setdefault(spec.rheology_by, []).append("each has its flow curve")
    return {column: "; ".join(said) for column, said in reasons.items()}


def _inputs(spec: ModelSpec, forward: ForwardModel, notes: list[str]) -> dict[str, str]:
    """Numeric input to the reason why it is a column; notes on alternatives are added to ``notes``."""
    given = {parameter.name for parameter in spec.parameters}
    if any((spec.surface_name, spec.surface_file, spec.surface_posterior)) or not forward.uses_surface:
        given |= set(ROUGHNESS_INPUTS)
    if spec.rheology is not None:
        given.add(REPLACED)
    found = {
        name: "it varies in the conditions of the model"
        for name, values in spec.conditions.items()
        if name not in given and values.dtype.kind == "f"
    }
    needed = "the forward model needs it and the model file does not give it"
    own = _own_columns(spec)
    for name in (name for name in forward.goes_with if name in given):
        without = (other for other in partners(forward.goes_with, name) if other not in given)
        found |= dict.fromkeys(without, f"{name} has no effect without it")
    for covariate in spec.covariates:
        found.setdefault(covariate.column, f"covariate '{covariate.name}' of {covariate.acts_on}")
    for entry in (*forward.required, *ROUGHNESS_INPUTS):
        here = given | set(found)
        if isinstance(entry, str):
            if entry not in here:
                found[entry] = needed
            continue
        missing = [[name for name in names if name not in here] for names in entry]
        if not all(missing):  # one alternative is complete
            notes += _instead(entry, missing, given)
            continue
        best = _best(entry, missing, own)
        found |= dict.fromkeys(missing[best], needed)
        others = "; or ".join(" and ".join(names) for i, names in enumerate(missing) if i != best)
        notes.append(f"Instead of {' and '.join(missing[best])}: {others}.")
    along = (
        {}
        if spec.discrepancy is None
        else dict.fromkeys(spec.discrepancy.columns, "the discrepancy is a curve along it")
    )
    along |= {} if spec.correlation is None else {spec.correlation.along: "the noise is correlated along it"}
    found |= {name: why for name, why in along.items() if name != ORDER and name not in found}
    return found


def _instead(entry: tuple[tuple[str, ...], ...], missing: list[list[str]], given: set[str]) -> list[str]:
    """A note on what may stand in place of columns that the conditions of the model made complete."""
    chosen = [name for name in entry[missing.index([])] if name not in given]
    others = [
        [name for name in names if name not in given] for names in entry if not set(chosen) <= set(names)
    ]
    told = "; or ".join(" and ".join(names) for names in others if names)
    return [f"Instead of {' and '.join(chosen)}: {told}."] if chosen and told else []


def _best(entry: tuple[tuple[str, ...], ...], missing: list[list[str]], own: set[str]) -> int:
    """The alternative that the data have, then the one that lacks least, then the one of which most is given."""

    def rank(i: int) -> tuple[bool, int, int]:
        return not set(missing[i]) <= own, len(missing[i]), len(missing[i]) - len(entry[i])

    return min(range(len(entry)), key=rank)


def _own_columns(spec: ModelSpec) -> set[str]:
    """Names in the header of the model's data; none if they are not there (yet) or cannot be read."""
    if spec.dataset is None:
        return set()
    try:
        _, path, _ = find_dataset(spec.dataset)
        return {split_header(header)[0] for header in read_table(path).header}
    except InputError:
        return set()
