"""What a user calls says what it does, takes, returns and raises, and shows an example that test_doctests.py runs."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Iterator
from typing import Any

import pytest

import skinbayes
from skinbayes.sampling import Engine

SECTIONS = re.compile(r"\n(Parameters|Attributes|Returns|Raises|Examples)\n-+\n")


def called() -> Iterator[tuple[str, Any]]:
    """Functions, classes and public methods of what ``import skinbayes`` offers; `Engine` is what a user may write."""
    exported = [getattr(skinbayes, name) for name in skinbayes.__all__ if name != "__version__"]
    for found in (*exported, Engine):
        yield found.__name__, found
        if inspect.isclass(found):
            for name, plain in inspect.getmembers_static(found):
                function = plain.__func__ if isinstance(plain, classmethod | staticmethod) else plain
                field = name in getattr(found, "__dataclass_fields__", ())
                if name[0] != "_" and inspect.isfunction(function) and not field:
                    yield f"{found.__name__}.{name}", function


CALLED = dict(called())


def sections(found: Any) -> dict[str, str]:
    parts = SECTIONS.split("\n" + inspect.getdoc(found))
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def described(body: str) -> set[str]:
    names = re.findall(r"^(\*{0,2}\w[^:\n]*?) : ", body, re.MULTILINE)
    return {name.strip().lstrip("*") for entry in names for name in entry.split(",")}


@pytest.mark.parametrize("name", CALLED)
def test_every_argument_is_described(name: str) -> None:
    if inspect.isclass(CALLED[name]) and not hasattr(CALLED[name], "__dataclass_fields__"):
        return  # an error and a protocol: their methods and their text are what matters
    fields = {
        n for n in inspect.signature(CALLED[name]).parameters if n not in ("self", "cls") and n[0] != "_"
    }
    body = sections(CALLED[name]).get("Attributes" if inspect.isclass(CALLED[name]) else "Parameters", "")
    assert fields <= described(body), f"{name}: {', '.join(sorted(fields - described(body)))}"


@pytest.mark.parametrize("name", [n for n in CALLED if not inspect.isclass(CALLED[n])])
def test_results_are_described(name: str) -> None:
    result = CALLED[name].__annotations__["return"]
    assert result == "None" or "Returns" in sections(CALLED[name])


@pytest.mark.parametrize("name", [n for n in CALLED if not inspect.isclass(CALLED[n])])
def test_what_is_raised_is_said(name: str) -> None:
    tree = ast.parse(textwrap.dedent(inspect.getsource(CALLED[name])))
    raises = any(isinstance(node, ast.Raise) and node.exc is not None for node in ast.walk(tree))
    assert not raises or "Raises" in sections(CALLED[name])


@pytest.mark.parametrize("name", CALLED)
def test_an_example_is_shown(name: str) -> None:
    assert ">>> " in sections(CALLED[name]).get("Examples", "")
