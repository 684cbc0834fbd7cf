"""The model file of a problem."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from skinbayes.atomic import write_atomically
from skinbayes.errors import InputError
from skinbayes.files.locate import shipped_folder, shipped_names
from skinbayes.files.noise_block import noise_parameter_names
from skinbayes.files.parameter_block import ParameterSpec, parse_parameter
from skinbayes.files.population_block import PopulationSpec
from skinbayes.files.scatter_block import CORRELATION_KEYS, SCATTER_PARAMETERS, DiscrepancySpec
from skinbayes.files.spectrum import spectrum_text
from skinbayes.files.stated_surface import stated_text
from skinbayes.files.toml_text import toml_text
from skinbayes.files.written import written_parameter, written_value
from skinbayes.problem.bound import BoundModel
from skinbayes.problem.rheology import flow_curves_text
from skinbayes.vocabulary import LABELS, QUANTITIES


def model_files(problem: BoundModel, path: Path) -> dict[Path, str]:
    """Model file of a problem, and the files beside it that it needs: path to text.

    Settings, replaced priors, and data of another place than the original model file's are in it; comments of that file are not.

    Parameters
    ----------
    problem : any problem
    path : where the model file will be

    Raises
    ------
    InputError
        A prior that a model file cannot state: one that was cut off.
    """
    files: dict[Path, str] = {}
    content = model_content(problem, path, files, path.stem)
    return {path: toml_text(content), **files}


def model_content(problem: BoundModel, path: Path, files: dict[Path, str], stem: str) -> dict[str, Any]:
    """Tables of the model file of a problem at ``path``.

    Parameters
    ----------
    problem, path : as for :func:`model_files`
    files : is given the files beside it that it needs
    stem : what their names begin with
    """
    spec = problem.spec

    def beside(what: str, text: str) -> str:
        name = f"{stem}-{what}.csv"
        files[path.with_name(name)] = text
        return name

    content: dict[str, Any] = {
        "format": 1,
        "title": spec.title,
        "description": spec.description,
        "forward": spec.forward,
    }
    usual = {name: values[0] for name, values in problem.forward.options.items()}
    content["options"] = {} if problem.forward.chosen == usual else dict(problem.forward.chosen)
    if spec.observables:
        content["data"] = _data(problem, path, beside)
    if problem.surface_prior is not None:
        draws = problem.surface_prior.draws
        content["surface"] = {"posterior": _located(draws.file, path) or beside("surface", draws.text())}
    elif problem.tables.spectrum is not None:
        content["surface"] = {
            "file": _located(spec.surface_file, path)
            or beside("spectrum", spectrum_text(problem.tables.spectrum)),
            **({} if spec.surface_file is None else stated_text(spec.surface_stated)),
        }
    elif spec.surface_name is not None:
        content["surface"] = {"name": spec.surface_name}
    named = {p.name for p in problem.parameters}
    inputs = problem.forward.input_names()
    written = (p for p in problem.parameters if p.name in inputs and p.entry is not None)
    content["parameters"] = _by_level(spec.path, written)
    for population in spec.populations:
        if population.name in content["parameters"]:
            content["parameters"][population.name] = _population(
                problem, population, content["parameters"][population.name]
            )
    if spec.noise:
        content["noise"] = _noise(problem)
    if spec.groups:
        scales = [p for p in problem.parameters if p.name == "group_scale"]
        content["groups"] = {str(p.level): {"scale": _entry(spec.path, p)} for p in scales}
    shared = {p.label: _entry(spec.path, p) for p in problem.parameters if p.name in SCATTER_PARAMETERS}
    if spec.discrepancy is not None:
        content["discrepancy"] = _discrepancy(spec.discrepancy, shared)
    if spec.correlation is not None:
        one = spec.correlation
        content["noise"]["correlation"] = (
            {"along": one.along}
            | ({"within": one.within} if one.within else {})
            | {key: shared[name] for key, name in CORRELATION_KEYS.items() if name in shared}
        )
    if spec.covariates:
        content["covariates"] = {
            c.name: {
                "column": c.column,
                "acts_on": c.acts_on,
                "reference": written_value(c.reference, QUANTITIES[c.column].unit, c.name),
                "exponent": next(
                    _entry(spec.path, p)
                    for p in problem.parameters
                    if p.name == "covariate_exponent" and p.level == c.name
                ),
            }
            for c in spec.covariates
        }
    if spec.rheology is not None and spec.rheology_by is not None:
        place = _dataset(spec.rheology, path) or {
            "file": beside("rheology", flow_curves_text(problem.flow_curves, spec.rheology_by))
        }
        content["rheology"] = {**place, "by": spec.rheology_by}
    content["derived"] = {
        name: block.model_dump(exclude_defaults=True) for name, block in spec.derived.items()
    }
    content["conditions"] = {
        key: {
            "values": values.tolist()
            if key in LABELS
            else [written_value(v, QUANTITIES[key].unit, key) for v in values.tolist()]
        }
        for key, values in spec.conditions.items()
        if key not in named
    }
    content["baseline_models"] = [
        _located(Path(y), path) if y.endswith(".toml") else y for y in spec.baseline_models
    ]
    return content


def write_model(problem: BoundModel, path: Path) -> str:
    """Write the files of :func:`model_files`; the text of the model file is returned.

    Raises :class:`InputError` if one of them is there already.
    """
    return write_files(model_files(problem, path), path)


def write_files(files: Mapping[Path, str], path: Path) -> str:
    """Write files that are not there yet; the text of that at ``path`` is returned."""
    for file in files:
        if file.exists() or file.is_symlink():
            raise InputError(f"{file}: there already; nothing was written. Give another name")
    for file, text in files.items():
        write_atomically(file, text.encode())
    return files[path]


def _discrepancy(spec: DiscrepancySpec, entries: Mapping[str, Any]) -> dict[str, Any]:
    several = len(spec.columns) > 1
    found: dict[str, Any] = {"along": list(spec.columns) if several else spec.columns[0]}
    found |= {"within": spec.within} if spec.within else {}
    found |= {"axis": spec.axis} if spec.axis else {}
    for key in ("size", "length"):
        each = {column: entries.get(f"discrepancy_{key}[{column}]") for column in spec.columns}
        if all(each.values()):
            found[key] = {"by": "column", **each} if several else next(iter(each.values()))
    return found


def _data(problem: BoundModel, path: Path, beside: Any) -> dict[str, Any]:
    spec, dataset = problem.spec, problem.dataset
    block: dict[str, Any] = {}
    rows = spec.rows
    if dataset is not None:
        rows = dict(dataset.selection)
        place = None if dataset.in_memory else _dataset(str(dataset.path), path)
        block |= place or {"file": beside("data", dataset.to_csv())}
        rows = rows if place else {}  # what is written beside has the selected rows only
    elif spec.dataset is not None:
        block |= _dataset(spec.dataset, path) or {"file": spec.dataset}
    several = len(spec.observables) > 1
    block["observables" if several else "observable"] = (
        list(spec.observables) if several else spec.observables[0]
    )
    if rows:
        block["rows"] = {column: list(levels) for column, levels in rows.items()}
    block |= {"spread": spec.spread} if spec.spread else {}
    block |= {"input_spread": spec.input_spread} if spec.input_spread else {}
    return block | ({"missing": spec.missing} if spec.missing else {})


def _dataset(name: str, path: Path) -> dict[str, str] | None:
    """How a model file at ``path`` names a data set; None if it is in no file."""
    if name in shipped_names("datasets"):
        return {"dataset": name}
    folder = Path(name).parent
    if folder.parent == shipped_folder("datasets"):
        return {"dataset": folder.name}
    located = _located(Path(name), path)
    return None if located is None else {"file": located}


def _located(file: Path | None, path: Path) -> str | None:
    """A file as seen from the folder of the model file; None if it is not there."""
    if file is None or not file.exists():
        return None
    return Path(os.path.relpath(file.resolve(), path.resolve().parent)).as_posix()


def _noise(problem: BoundModel) -> dict[str, Any]:
    spec, names = problem.spec, noise_parameter_names()
    found = [p for p in problem.parameters if p.name in names]
    if len(spec.observables) == 1:
        return {"family": spec.noise[spec.observables[0]], **_by_level(spec.path, found)}
    return {
        observable: {"family": family}
        | {p.name: _entry(spec.path, p) for p in found if p.level == observable}
        for observable, family in spec.noise.items()
    }


def _by_level(path: Path, parameters: Iterable[ParameterSpec]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for parameter in parameters:
        entry = _entry(path, parameter)
        if parameter.level is None:
            found[parameter.name] = entry
        else:
            found.setdefault(parameter.name, {"by": parameter.by})[parameter.level] = entry
    return found


def _population(problem: BoundModel, one: PopulationSpec, median: dict[str, Any]) -> dict[str, Any]:
    """``by`` and ``population`` of a parameter; replaced priors of its scales and effects are in it."""
    here = {p.label: p for p in problem.parameters}

    def entry(p: ParameterSpec) -> dict[str, Any]:
        return _entry(problem.spec.path, here.get(p.label, p))

    block = {**median, "scale": entry(one.scale)}
    if one.within_scale is not None:
        block["within"] = {"column": one.within, "scale": entry(one.within_scale)}
    if one.contrast is not None:
        contrast = one.contrast
        block["contrast"] = {
            "column": contrast.column,
            "reference": contrast.reference,
            "effect": entry(contrast.effect),
        }
        block["contrast"] |= {} if contrast.scale is None else {"scale": entry(contrast.scale)}
    return {"by": one.by, "population": block}


def _entry(path: Path, parameter: ParameterSpec) -> dict[str, Any]:
    """Value or prior as it was written, if it still is that; otherwise in SI."""
    quantity, unit, where = QUANTITIES[parameter.name], parameter.unit, f"{path}: {parameter.label}"
    source = {"source": parameter.source} if parameter.source else {}
    if parameter.same_as is not None:
        return {
            "same_as": parameter.same_as,
            **({} if parameter.times == 1 else {"times": parameter.times}),
            **source,
        }

    def says(entry: Mapping[str, Any]) -> bool:
        read = parse_parameter(quantity, entry, where, unit)
        return (read.value, read.prior) == (parameter.value, parameter.prior)

    if parameter.entry is not None and says(parameter.entry):
        return {**parameter.entry, **source}
    if parameter.prior is None:
        return {"fixed": written_value(parameter.value, unit, where), **source}
    entry: dict[str, Any] = written_parameter(parameter.prior, unit, where)
    if not says(entry):
        raise InputError(
            f"{where}: a prior cut off at {parameter.prior.support} cannot be written in a model file"
        )
    return {**entry, **source}
