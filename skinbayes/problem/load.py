"""Problems from model files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from skinbayes.errors import InputError
from skinbayes.files.dataset import Data, Dataset
from skinbayes.files.joint_model import is_joint, load_joint_model
from skinbayes.files.modelfile import ModelSpec, find_model, load_model
from skinbayes.problem.bind import bind
from skinbayes.problem.joint import JointProblem
from skinbayes.problem.joint_bind import bind_joint
from skinbayes.problem.problem import Problem
from skinbayes.problem.rows import selected_dataset


def load_problem(
    name: str | Path,
    data: Data | None = None,
    settings: Mapping[str, str] | None = None,
    conditions: Data | None = None,
    rheology: str | Path | None = None,
) -> Problem:
    """Bind a model file to its data.

    Parameters
    ----------
    name : shipped model or path of a model file
    data : a CSV of the user's own (or a data set, a data frame, a mapping of columns) to use instead of the one named in the
        model file; of a :class:`Dataset` all rows are used, whichever the model file selects
    settings : values to fix, as text with unit: ``{"yield_stress": "40 MPa", "surface": "paper_printed"}``;
        ``name[level]`` fixes one level of a parameter that differs by group
    conditions : a CSV (or as ``data``) of rows to predict instead of the data's; such a problem has no likelihood
    rheology : a CSV of flow curves (or a data set) to use instead of the one named in the model file

    Returns
    -------
    Problem

    Raises
    ------
    InputError
        Anything in the model file, the data or the settings that cannot be used; the message says where.

    Examples
    --------
    >>> load_problem("contact-area").dimension
    0
    """
    if is_joint(name):
        raise InputError(
            f"{find_model(name)}: a model of several experiments; in Python skinbayes.load_joint_problem loads it"
        )
    spec = load_model(name)
    if rheology is not None:
        spec = replace(spec, rheology=str(rheology))
    if conditions is not None or data is None:
        return bind(spec, settings=settings, conditions=conditions)
    if not spec.observables:
        raise InputError(f"{spec.path}: the model has no [data] block, so data cannot be given to it")
    if isinstance(data, Dataset):
        return bind(spec, data, settings=settings, other_data=True)
    dataset = selected_dataset(spec, data)
    return bind(_of_other_data(spec, dataset), dataset, settings=settings, other_data=True)


def load_any_problem(
    name: str | Path,
    data: Data | Mapping[str, Data] | None = None,
    settings: Mapping[str, str] | None = None,
) -> Problem | JointProblem:
    """Bind a model file of one experiment or of several."""
    if is_joint(name):
        return load_joint_problem(name, data, settings)  # type: ignore[arg-type]  # which refuses other data in words
    return load_problem(name, data, settings)


def load_joint_problem(
    name: str | Path, data: Mapping[str, Data] | None = None, settings: Mapping[str, str] | None = None
) -> JointProblem:
    """Bind a model file of several experiments to their data.

    Parameters
    ----------
    name : path of the model file
    data : experiment to a CSV of the user's own (or a data set, a data frame, a mapping of columns) to use instead of the one
        named in the model file; of a :class:`Dataset` all rows are used
    settings : values to fix, as text with unit, in all experiments that take them; ``name[experiment]`` fixes one that differs
        by experiment

    Returns
    -------
    JointProblem

    Raises
    ------
    InputError
        Anything in the model file, the data or the settings that cannot be used; the message says where.

    Examples
    --------
    >>> load_joint_problem("forearm-glass")
    Traceback (most recent call last):
    skinbayes.errors.InputError: forearm-glass: a model of one experiment; load_problem loads it
    """
    if not is_joint(name):
        raise InputError(f"{name}: a model of one experiment; load_problem loads it")
    spec = load_joint_model(name)
    if data is not None and not (isinstance(data, Mapping) and set(data) & set(spec.experiments)):
        one = next(iter(spec.experiments))
        raise InputError(
            f"{spec.path}: one data set given to a model of several experiments ({', '.join(spec.experiments)}); expected which "
            f"experiment it belongs to: --data {one}=FILE.csv, or data={{'{one}': ...}} in Python"
        )
    return bind_joint(spec, data, settings=settings)


def _of_other_data(spec: ModelSpec, dataset: Dataset) -> ModelSpec:
    """The model with a title and a description that do not tell of the data it was written for."""
    name = dataset.path.name
    return replace(
        spec,
        title=f"{name}, with the model '{spec.name}'",
        description=f"The data are the user's own, {name}. Forward model, priors and noise are those of '{spec.name}' "
        f"({spec.title}); whether they suit these data is for the user to say.",
    )
