"""A problem for each person, each file, or each line of a table of settings."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from skinbayes.errors import InputError
from skinbayes.files.dataset import Data, Dataset
from skinbayes.files.joint_model import is_joint
from skinbayes.files.modelfile import ModelSpec, load_model, read_model
from skinbayes.files.settings_table import read_settings
from skinbayes.files.toml_text import toml_text
from skinbayes.forward.base import TiedRanges, multiples_of
from skinbayes.problem.bind import bind
from skinbayes.problem.problem import Problem
from skinbayes.problem.rows import selected_dataset


def problems_of_each(
    model: str | Path | Problem,
    data: Data | Iterable[str | Path] | None = None,
    *,
    column: str | None = None,
    table: str | Path | None = None,
    settings: Mapping[str, str] | None = None,
) -> dict[str, Problem | InputError]:
    """The same model bound to many data sets, for :func:`skinbayes.fit_each`.

    Parameters
    ----------
    model : shipped model, path of a model file of one experiment, or a problem
    data : the data instead of those of the model file; or the files of which each is a data set, if neither ``column`` nor
        ``table`` is given
    column : label column: the rows of each of its labels are a data set. Effects that rows of one label share (``[groups]`` of
        that column) are left out, since each fit has one label
    table : a CSV with a line for each fit: a column ``name`` if wanted, the others are what ``settings`` may fix
    settings : values to fix in all of them, as :func:`skinbayes.load_problem` takes them

    Returns
    -------
    dict
        Name (label, file or line) to problem, in the order of the data; or to the error that says why there is none.

    Raises
    ------
    InputError
        A file cannot be read, the column is no label column, or no problem can be made at all.

    Examples
    --------
    >>> problems = problems_of_each("finger-water", "fehlberg2025-finger-stribeck", column="person")
    >>> len(problems), problems["ID01"].conditions.n_rows
    (11, 1)
    """
    base = _Base.of(model, settings or {})
    if column is not None and table is not None:
        raise InputError(f"column '{column}' and table {table} given; expected one of them")
    if column is not None:
        return _with_one(_of_labels(base, _one(data), column), base)
    if table is not None:
        return _with_one(_of_settings(base, _one(data), Path(table)), base)
    files = [] if data is None or _is_one(data) else [one for one in data if isinstance(one, str | Path)]  # type: ignore[union-attr]
    if not files:
        raise InputError("expected a column, a table of settings, or a list of files as data")
    return _with_one(_of_files(base, files), base)


@dataclass(frozen=True)
class _Base:
    """What all problems have in common."""

    spec: ModelSpec
    settings: Mapping[str, str]
    problem: Problem | None = None

    @classmethod
    def of(cls, model: str | Path | Problem, settings: Mapping[str, str]) -> _Base:
        """From a problem, or from the name of a model."""
        if isinstance(model, Problem):
            return cls(model.spec, {**model.settings, **settings}, model)
        if is_joint(model):
            raise InputError(f"{model}: a model of several experiments; expected one of one experiment")
        return cls(load_model(model), settings)

    def dataset(self, data: Data | None) -> Dataset:
        """The data of all of them."""
        if data is None and self.problem is not None and self.problem.dataset is not None:
            return self.problem.dataset
        return selected_dataset(self.spec, data)

    def bound(
        self, dataset: Dataset, settings: Mapping[str, str] | None = None, other: bool = True
    ) -> Problem | InputError:
        """One of them; or why it cannot be."""
        problem, given = self.problem, dict(self.settings) | dict(settings or {})
        more: dict[str, Any] = {}
        if problem is not None:
            drawn = None if problem.surface_prior is None else problem.surface_prior.draws
            more = {"forward": problem.forward, "surface": drawn or problem.tables.spectrum}
        try:
            return bind(self.spec, dataset, settings=given, other_data=other, **more)
        except InputError as error:
            return error


def share_preparation(problems: Iterable[Problem], progress: Any = None, cores: int = 1) -> None:
    """Prepare the forward model, such as its tables of films, once for all problems that can share it.

    Parameters
    ----------
    problems : any
    progress : called with the number of steps done and their total
    cores : processes that share the work
    """
    together: dict[Any, list[Problem]] = {}
    for problem in problems:
        if "model" in problem.__dict__:
            continue
        if problem.surface_prior is not None:
            problem.prepare(progress, cores)
            continue
        spectrum = problem.tables.spectrum
        key = (
            problem.forward.name,
            tuple(sorted(problem.forward.chosen.items())),
            None if spectrum is None else (spectrum.wavevector.tobytes(), spectrum.node_power.tobytes()),
        )
        together.setdefault(key, []).append(problem)
    for alike in together.values():
        first = alike[0]
        wanted = first.forward.prepare is not None and all(one.free for one in alike)
        hull = _hull([one.ranges() for one in alike]) if wanted else None
        model = first.prepared_for_many(progress, cores, hull)
        for problem in alike[1:]:
            problem.__dict__["model"] = model


def _hull(ranges: Sequence[TiedRanges]) -> TiedRanges:
    """Ranges that hold all others; inputs vary together if they do everywhere."""
    names = set.intersection(*(set(one) for one in ranges))
    ends = {
        name: (min(r[name][0] for r in ranges), max(r[name][1] for r in ranges))
        for name in ranges[0]
        if name in names
    }
    first = multiples_of(ranges[0])
    tied = {
        n: first[n] for n in first if n in names and all(multiples_of(r).get(n) == first[n] for r in ranges)
    }
    return TiedRanges(ends, tied)


def _is_one(data: Any) -> bool:
    """Whether it is one data set, not several files."""
    return isinstance(data, str | Path | Mapping | Dataset) or hasattr(data, "columns")


def _one(data: Any) -> Data | None:
    if data is None or _is_one(data):
        return data
    raise InputError("data: several files found; expected one data set with a column or a table of settings")


def _of_labels(base: _Base, data: Data | None, column: str) -> dict[str, Problem | InputError]:
    dataset = base.dataset(data)
    base = replace(base, spec=without_groups(base.spec, column))
    of_column = dataset.columns.get(column)
    labels = dataset.labels(column)  # refuses a column that has none
    assert of_column is not None
    found: dict[str, Problem | InputError] = {}
    for label in labels:
        if not label:
            continue
        part = replace(dataset.rows(of_column == label), in_memory=True, selection={})
        found[label] = base.bound(part)
    return found


def _of_files(base: _Base, files: Sequence[str | Path]) -> dict[str, Problem | InputError]:
    stems = [Path(file).stem for file in files]
    found: dict[str, Problem | InputError] = {}
    for file, stem in zip(files, stems, strict=True):
        name = stem if stems.count(stem) == 1 else str(file)
        try:
            found[name] = base.bound(selected_dataset(base.spec, str(file)))
        except InputError as error:
            found[name] = error
    return found


def _of_settings(base: _Base, data: Data | None, table: Path) -> dict[str, Problem | InputError]:
    dataset = base.dataset(data)
    found: dict[str, Problem | InputError] = {}
    for name, line in read_settings(table).items():
        if both := set(line) & set(base.settings):
            raise InputError(
                f"{table}: {', '.join(sorted(both))} is given in the table and by the settings; drop one"
            )
        found[name] = base.bound(dataset, line, other=data is not None)
    return found


def _with_one(found: dict[str, Problem | InputError], base: _Base) -> dict[str, Problem | InputError]:
    """Refuse a set of nothing but errors, with the first of them."""
    if not found:
        raise InputError(f"{base.spec.path}: nothing to fit: no label, file or line found")
    first = next(iter(found.values()))
    if isinstance(first, InputError) and all(isinstance(one, InputError) for one in found.values()):
        raise first
    return found


def without_groups(spec: ModelSpec, column: str) -> ModelSpec:
    """The model without effects that rows of one label of a column share."""
    if all(scale.level != column for scale in spec.groups):
        return spec
    content = tomllib.loads(spec.text)
    content["groups"] = {name: block for name, block in content["groups"].items() if name != column}
    if not content["groups"]:
        del content["groups"]
    return replace(read_model(content, spec.path, ""), text=toml_text(content))
