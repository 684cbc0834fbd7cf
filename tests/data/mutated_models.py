"""Shipped model files with something strange in one to three places, as text."""

from __future__ import annotations

import copy
import json
import random
import tomllib
from typing import Any

from skinbayes.files.locate import shipped_folder, shipped_names

SHIPPED = {name: (shipped_folder("models") / f"{name}.toml").read_text() for name in shipped_names("models")}

STRANGE: tuple[Any, ...] = (
    [], {}, [[]], [{}], {"a": {"b": []}}, True, False, float("nan"), float("inf"), -float("inf"), 0, -0.0, -1, 1, 2.5,
    1e-300, 1e300, 5e-324, 10**400, -(10**30), 2**63, "", " ", "nan", "inf", "-inf Pa", "none", "use", "nan Pa", "0", "0 Pa",
    "1e-300 Pa", "1e300 Pa", "1e400 m", "-5 um", "5 um", "water", "state", "person", "\u200b", "e\u0301", "\u202e", "ﬀ",
    "\U0001d7d9 Pa",
    "x" * 5000, "..", "/", "/dev/null", "data.csv", "gaussian", "lognormal", "student_t", "person", "liquid",
    [1, 2], ["1 MPa", "2 MPa"], ["2 MPa", "1 MPa"], ["a"] * 3, [0, 0], [1e-300, 1e300], [float("nan")] * 2,
)  # fmt: skip

PRIORS: tuple[Any, ...] = (
    {"half_normal": 1e-308}, {"half_normal": 1e-12}, {"half_normal": 1e6}, {"fixed": 0}, {"fixed": 1e-200}, {"fixed": 1e200},
    {"uniform": [0, 1]}, {"uniform": [1, 1]}, {"uniform": [1, 0]}, {"uniform": [-1e300, 1e300]}, {"loguniform": [1e-300, 1e300]},
    {"normal": [0, 1e-300]}, {"normal": [1e300, 1]}, {"normal": [-1000, 1]}, {"lognormal": [1, 100]}, {"lognormal": [1, 1e-12]},
    {"lognormal": [1e-300, 1]}, {"lognormal": [1, 1e300]}, {"normal": [0, 1]}, {"beta": [1e-3, 1e-3]}, {"gamma": [1e-3, 1]},
)  # fmt: skip

UNITS = ("Pa", "m", "1/m", "N/m", "Pa s", "m/s", "K", "rad", "s", "N", "")


def mutated(name: str, seed: int) -> str:
    """The shipped model ``name`` with one to three mutations; the same seed gives the same text."""
    chooser = random.Random(f"{name} {seed}")
    tree = tomllib.loads(SHIPPED[name])
    for _ in range(chooser.choice((1, 1, 1, 2, 3))):
        _mutate(tree, chooser)
    return to_toml(tree)


def to_toml(tree: dict[str, Any]) -> str:
    """TOML of a tree: each top key on a line of its own, all below it inline."""
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in tree.items())


def _mutate(tree: dict[str, Any], chooser: random.Random) -> None:
    places = list(_places(tree))
    if not places:
        return
    holder, key = chooser.choice(places)
    match chooser.randrange(9):
        case 0:
            del holder[key]
        case 1 | 2 | 3:
            holder[key] = copy.deepcopy(chooser.choice(STRANGE))
        case 4:
            other, other_key = chooser.choice(places)
            holder[key] = copy.deepcopy(other[other_key])
        case 5 if isinstance(holder, dict):
            other, other_key = chooser.choice(places)
            new = (
                str(other_key)
                if chooser.random() < 0.7
                else chooser.choice(("", "by", "fixed", "é", "x" * 300, "source"))
            )
            holder[new] = holder.pop(key)
        case 6:
            holder[key] = [holder[key]]
        case 7:
            holder[key] = _numbers(holder[key], chooser)
        case _:
            parameters = [
                p
                for p in places
                if isinstance(p[0], dict) and isinstance(p[0][p[1]], dict) and set(p[0][p[1]]) & _FAMILIES
            ]
            if parameters:
                holder, key = chooser.choice(parameters)
                holder[key] = _with_unit(chooser.choice(PRIORS), holder[key]) | {"source": "a test"}


_FAMILIES = {"fixed", "uniform", "loguniform", "normal", "lognormal", "half_normal", "beta", "gamma"}


def _with_unit(prior: dict[str, Any], replaced: dict[str, Any]) -> dict[str, Any]:
    """The prior in the unit of what it replaces."""
    unit = ""
    for family in _FAMILIES & set(replaced):
        first = (
            replaced[family][0]
            if isinstance(replaced[family], list) and replaced[family]
            else replaced[family]
        )
        if isinstance(first, str):
            unit = first.partition(" ")[2]
    ((family, raw),) = prior.items()
    numbers = raw if isinstance(raw, list) else [raw]
    second_is_value = family not in ("lognormal",)
    written = [f"{x} {unit}" if unit and (i == 0 or second_is_value) else x for i, x in enumerate(numbers)]
    return {family: written if isinstance(raw, list) else written[0]}


def _numbers(item: Any, chooser: random.Random) -> Any:
    """The same shape with other numbers, units kept."""
    if isinstance(item, dict):
        return {key: _numbers(value, chooser) for key, value in item.items()}
    if isinstance(item, list):
        return [_numbers(value, chooser) for value in item]
    factor = chooser.choice(
        (0.0, -1.0, 1e-9, 1e-3, 0.5, 2.0, 1e3, 1e9, 1e100, 1e-100, float("nan"), float("inf"))
    )
    if isinstance(item, (int, float)) and not isinstance(item, bool):
        return item * factor
    if isinstance(item, str):
        number, _, unit = item.partition(" ")
        try:
            return f"{float(number) * factor} {unit}"
        except ValueError:
            return item
    return item


def _places(item: Any) -> Any:
    """Every ``(holder, key)`` below."""
    entries = item.items() if isinstance(item, dict) else enumerate(item) if isinstance(item, list) else ()
    for key, value in list(entries):
        yield item, key
        yield from _places(value)


def _key(key: str) -> str:
    return json.dumps(str(key))


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    return json.dumps(value) if isinstance(value, str) else repr(value)
