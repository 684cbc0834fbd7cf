"""A shipped model as a file of the user's own: its text, with title and data exchanged."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset, load_dataset
from skinbayes.files.locate import shipped_names
from skinbayes.files.modelfile import ModelSpec, load_model
from skinbayes.vocabulary import lookup, spread_of, suggestions


@dataclass(frozen=True)
class ModelCopy:
    """Text of a model file, and what was changed in it, in sentences."""

    text: str
    changes: tuple[str, ...]


def copy_model(name: str, target: Path, data: str | Path | None = None) -> ModelCopy:
    """Text of a copy of a shipped model.

    Parameters
    ----------
    name : shipped model
    target : file that the text will be written to; paths in it are relative to its folder
    data : CSV of the user's own, which the copy will name instead of the data of the model: spreads are used where the CSV
        has them, and what it has as a column is no parameter

    Raises
    ------
    InputError
        no such shipped model, data that cannot be read, or data for a model that takes none
    """
    shipped = shipped_names("models")
    if name not in shipped:
        raise InputError(
            f"no shipped model {name[:80]!r}.{suggestions(name, shipped)} Shipped: {', '.join(shipped)}"
        )
    import tomlkit

    spec = load_model(name)
    about = "the data" if data is None else f"the data in {Path(data).name}"
    content: Any = tomlkit.parse(spec.text)
    content["title"] = f"{'My own model' if data is None else f'Model of {Path(data).name}'}, after {name}"
    content["description"] = tomlkit.string(
        f"Say here what {about} are: who or what was measured, how, and where. Forward model, priors and noise were copied\n"
        f"from the shipped model '{name}' ({spec.title}).\n",
        multiline=True,
    )
    # the shipped reasons are about the data of the shipped model
    _state_source(
        content.get("noise", {}),
        f"Copied from '{name}', whose own data it describes; say what you know of the scatter of yours",
    )
    changes: list[str] = []
    if data is not None:
        if not spec.observables:
            raise InputError(
                f"'{name}' has no [data] block, so it cannot take data: copy it without --data, and give the copy a [data] and "
                "a [noise] block (docs/model-files.md)"
            )
        _take_data(content, spec, load_dataset(data, missing="keep"), target, changes)
    first = f"# Copied from the shipped model '{name}'. Every value and prior is yours now: change what you know better.\n"
    return ModelCopy(first + tomlkit.dumps(content), tuple(changes))


def _state_source(table: Any, source: str) -> None:
    for key, value in table.items():
        if key == "source":
            table[key] = source
        elif isinstance(value, dict):
            _state_source(value, source)


def _take_data(content: Any, spec: ModelSpec, dataset: Dataset, target: Path, changes: list[str]) -> None:
    """Point ``[data]`` at a CSV: its path, all its rows, its spreads; parameters that are its columns become comments."""
    import tomlkit

    kept = {
        k: v
        for k, v in content["data"].items()
        if k not in ("dataset", "file", "rows", "spread", "input_spread")
    }
    path = os.path.relpath(dataset.path.resolve(), target.resolve().parent)
    block: dict[str, Any] = {"file": Path(path).as_posix(), **kept}
    spreads = [base for name in dataset.units if (base := spread_of(name)) and lookup(name) is not None]
    of_inputs = [name for name in spreads if name not in spec.observables]
    for key, have, written in (
        ("spread", set(spec.observables) <= set(spreads), spec.spread),
        ("input_spread", bool(of_inputs), spec.input_spread),
    ):
        if have or written is not None or (key == "spread" and len(of_inputs) < len(spreads)):
            block[key] = "use" if have else "ignore"
            changes.append(
                f"{key}: {'used, as the data have it' if have else 'ignored, as the data lack it'}."
            )
    content["data"] = tomlkit.item(block)
    if spec.rows:
        changes.append("All rows are taken; the shipped model takes some of its own data only.")
    for name in sorted({p.name for p in spec.parameters} & set(dataset.columns)):
        removed = tomlkit.dumps({"parameters": {name: content["parameters"].pop(name).unwrap()}})
        content.add(tomlkit.nl())
        for line in removed.splitlines():
            content.add(tomlkit.comment(line))
        changes.append(f"{name}: a column of the data, so the parameter became a comment at the end.")
