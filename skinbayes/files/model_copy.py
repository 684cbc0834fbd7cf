"""A shipped model as a file of the user's own: its text, with title and data exchanged."""

from __future__ import annotations

import json
import os
import re
from dataclasses import dataclass
from pathlib import Path

from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset, load_dataset
from skinbayes.files.locate import shipped_folder, shipped_names
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
    spec = load_model(shipped_folder("models") / f"{name}.toml")
    changes: list[str] = []
    lines = spec.text.splitlines()
    _retitle(lines, spec, None if data is None else Path(data))
    _resource_noise(lines, spec)
    if data is not None:
        if not spec.observables:
            raise InputError(
                f"'{name}' has no [data] block, so it cannot take data: copy it without --data, and give the copy a [data] and "
                "a [noise] block (docs/model-files.md)"
            )
        _take_data(lines, spec, load_dataset(data, missing="keep"), target, changes)
    return ModelCopy("\n".join(lines) + "\n", tuple(changes))


def _retitle(lines: list[str], spec: ModelSpec, data: Path | None) -> None:
    first, last = _block(lines, "description")
    told = f"Model of {data.name}" if data is not None else "My own model"
    about = "the data" if data is None else f"the data in {data.name}"
    text = [
        f"Say here what {about} are: who or what was measured, how, and where. Forward model, priors and noise were copied",
        f"from the shipped model '{spec.name}' ({spec.title}).",
    ]
    escaped = [json.dumps(line, ensure_ascii=False)[1:-1] for line in text]
    lines[first:last] = ['description = """', *escaped, '"""']
    first, last = _block(lines, "title")
    lines[first:last] = [f"title = {json.dumps(f'{told}, after {spec.name}', ensure_ascii=False)}"]
    lines.insert(
        0,
        f"# Copied from the shipped model '{spec.name}'. Every value and prior is yours now: change what you know better.",
    )


def _resource_noise(lines: list[str], spec: ModelSpec) -> None:
    """Say of the noise that it was copied: the shipped reasons are about the data of the shipped model."""
    reason = (
        f"Copied from '{spec.name}', whose own data it describes; say what you know of the scatter of yours"
    )
    inside = False
    for i, line in enumerate(lines):
        if line.startswith("["):
            inside = re.match(r"\[noise[].]", line) is not None
        elif inside:
            lines[i] = re.sub(r'\bsource = "[^"]*"', f'source = "{reason}"', line)


def _take_data(lines: list[str], spec: ModelSpec, dataset: Dataset, target: Path, changes: list[str]) -> None:
    """Point ``[data]`` at a CSV: its path, all its rows, its spreads; parameters that are its columns become comments."""
    path = os.path.relpath(dataset.path.resolve(), target.resolve().parent)
    spreads = [base for name in dataset.units if (base := spread_of(name)) and lookup(name) is not None]
    start, end = _table(lines, "data")
    kept = [
        line
        for line in lines[start:end]
        if not re.match(r"\s*(dataset|file|rows|spread|input_spread)\s*=", line)
    ]
    kept.insert(0, f"file = {json.dumps(Path(path).as_posix(), ensure_ascii=False)}")
    last = max(i for i, line in enumerate(kept) if line.strip()) + 1
    of_inputs = [name for name in spreads if name not in spec.observables]
    for key, have, written in (
        ("input_spread", bool(of_inputs), spec.input_spread),
        ("spread", set(spec.observables) <= set(spreads), spec.spread),
    ):
        if have or written is not None or (key == "spread" and len(of_inputs) < len(spreads)):
            kept.insert(last, f'{key} = "{"use" if have else "ignore"}"')
            changes.append(
                f"{key}: {'used, as the data have it' if have else 'ignored, as the data lack it'}."
            )
    lines[start:end] = kept
    if spec.rows:
        changes.append("All rows are taken; the shipped model takes some of its own data only.")
    for name in sorted({p.name for p in spec.parameters} & set(dataset.columns)):
        _comment_out(lines, name)
        changes.append(f"{name}: a column of the data, so the parameter became a comment.")


def _block(lines: list[str], key: str) -> tuple[int, int]:
    """First line of a key of the top level and the line after its value, which may be a text of several lines."""
    first = next(i for i, line in enumerate(lines) if re.match(rf"{key}\s*=", line))
    if lines[first].count('"""') != 1:
        return first, first + 1
    return first, next(i for i in range(first + 1, len(lines)) if '"""' in lines[i]) + 1


def _table(lines: list[str], name: str) -> tuple[int, int]:
    """The lines below the header of a table, up to the next one."""
    start = next(i for i, line in enumerate(lines) if re.match(rf"\s*\[{re.escape(name)}\]", line)) + 1
    return start, next((i for i in range(start, len(lines)) if lines[i].startswith("[")), len(lines))


def _comment_out(lines: list[str], parameter: str) -> None:
    inside = False
    for i, line in enumerate(lines):
        if line.startswith("["):
            inside = re.match(rf"\[parameters\.{parameter}[].]", line) is not None
        if line.strip() and (inside or re.match(rf"{parameter}\s*=", line)):
            lines[i] = f"# {line}"
