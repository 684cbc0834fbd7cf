"""Frozen objects of arrays, numbers and texts as arrays by name and what JSON can hold, and back; tables kept so on disk."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar, get_origin, get_type_hints

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.emulation.cache import Unfinished, cached
from skinbayes.errors import InputError

Table = TypeVar("Table")
_NONE = "none"  # in the metadata: there is no table


def to_arrays(table: Any) -> tuple[dict[str, FloatArray], dict[str, Any]]:
    """The fields of a dataclass, those of dataclasses inside it under ``field_`` names: arrays, and the rest."""
    arrays: dict[str, FloatArray] = {}
    metadata: dict[str, Any] = {}
    for field in fields(table):
        value = getattr(table, field.name)
        if is_dataclass(value):
            for into, part in zip((arrays, metadata), to_arrays(value), strict=True):
                into.update({f"{field.name}_{name}": found for name, found in part.items()})
        elif isinstance(value, np.ndarray):
            arrays[field.name] = value
        else:
            metadata[field.name] = value
    return arrays, metadata


def from_arrays(
    cls: type[Table], arrays: Mapping[str, Any], metadata: Mapping[str, Any], prefix: str = ""
) -> Table:
    """The object that `to_arrays` took apart; `InputError` if something is missing."""
    found: dict[str, Any] = {}
    for name, kind in get_type_hints(cls).items():
        key = f"{prefix}{name}"
        if is_dataclass(kind) and isinstance(kind, type):
            found[name] = from_arrays(kind, arrays, metadata, f"{key}_")
        elif key in arrays:
            found[name] = np.ascontiguousarray(arrays[key], dtype=np.float64)
        elif key in metadata:
            found[name] = tuple(metadata[key]) if get_origin(kind) is tuple else metadata[key]
        else:
            raise InputError(f"A {cls.__name__} lacks {name}.")
    return cls(**found)


def kept_table(
    kind: str, key: Mapping[str, Any] | None, cls: type[Table], build: Callable[[Unfinished], Table | None]
) -> Table | None:
    """The table, a frozen dataclass, that ``build`` gives, or None if it gives none; from disk if it was built before.

    Parameters
    ----------
    kind, key : see `cached`; nothing is kept if the key is None
    cls : class of the table
    build : makes the table; is given the place where it may keep what is done so far
    """

    def stored(unfinished: Unfinished) -> tuple[dict[str, FloatArray], dict[str, Any]]:
        table = build(unfinished)
        return ({}, {_NONE: True}) if table is None else to_arrays(table)

    arrays, metadata = stored(Unfinished(None, "")) if key is None else cached(kind, key, stored)
    return None if _NONE in metadata else from_arrays(cls, arrays, metadata)
