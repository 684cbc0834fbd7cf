"""What is public is documented, annotated and, where it is physics, says its units and its source."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from dataclasses import is_dataclass
from importlib import import_module
from inspect import cleandoc
from itertools import combinations
from typing import Any

import pytest
from source_tree import PACKAGE, Definition, public_definitions

import skinbayes

DOCUMENTED = ("roughness", "topography", "contact", "wetting", "lubrication", "friction", "statistics", "sampling", "diagnose",
              "files", "forward", "problem", "fit", "comparison", "calibration", "plot", "report", "units", "vocabulary",
              "errors", "arrays", "reproduce")  # fmt: skip

ATOM = r"(?:Pa|m|s|kg|N|J|W|rad|mol)(?:[²³⁴]|\^-?\d|\^\(\d − \w+\))?"
UNIT = re.compile(
    rf"(?:^|\s)(?:1/)?\(?{ATOM}(?:[ /·]\(?(?:{ATOM}|K)\)?)*(?=[,;.)\s]|$)|dimensionless|, K(?=[,;.]|$)",
    re.MULTILINE,
)
"""A unit as docstrings write it: ``Pa``, ``1/m``, ``m^4``, ``J/kg``, ``dimensionless``; the K of shapes is none."""

NUMERIC = {"ArrayLike", "FloatArray", "float", "int"}
"""Words of an annotation that make an argument a number or an array of numbers."""


def here(*packages: str) -> list[str]:
    """Those of some packages that this version has."""
    return [package for package in packages if (PACKAGE / package / "__init__.py").is_file()]


def physics_callables() -> Iterator[tuple[str, Any]]:
    """Functions and classes that the physics packages export."""
    for package in here("roughness", "topography", "contact", "friction", "wetting", "lubrication"):
        module = import_module(f"skinbayes.{package}")
        for name in module.__all__:
            if callable(found := getattr(module, name)):
                yield f"{package}.{name}", found


PHYSICS = dict(physics_callables())
FUNCTIONS = sorted(name for name, found in PHYSICS.items() if not isinstance(found, type))


def entries(docstring: str) -> dict[str, str]:
    """Name to description of the numpydoc sections Parameters and Attributes."""
    found: dict[str, str] = {}
    sections = re.split(r"\n([A-Z][a-z]+)\n-+\n", "\n" + cleandoc(docstring))
    for title, body in zip(sections[1::2], sections[2::2], strict=True):
        if title in ("Parameters", "Attributes"):
            for block in re.split(r"\n(?=\S)", body):
                names, _, text = block.partition(" : ")
                found |= {name.strip(): text for name in names.split(",")}
    return found


def numeric_names(found: Any) -> list[str]:
    """Arguments of a function, or fields of a class, that are numbers."""
    annotations = {k: str(v) for k, v in found.__annotations__.items() if k != "return"}
    return [
        name
        for name, text in annotations.items()
        if NUMERIC & set(re.findall(r"\w+", text)) and name[0] != "_"
    ]


def test_top_level_names() -> None:
    assert skinbayes.__all__ == ["Dataset", "Fit", "ForwardModel", "InputError", "JointFit", "JointProblem", "NoiseFamily",
                                 "Problem", "Quantity", "__version__", "build_joint_problem", "build_problem", "calibrate",
                                 "compare", "emulated", "fit_each", "fit_spectrum", "load_dataset", "load_fit",
                                 "load_joint_fit", "load_joint_problem", "load_problem", "problems_of_each",
                                 "reduce_recordings", "register_engine", "register_forward_model", "register_noise",
                                 "register_quantity", "sample"]  # fmt: skip
    for name in skinbayes.__all__:
        assert getattr(skinbayes, name) is not None
    assert dir(skinbayes) == sorted(skinbayes.__all__)
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = skinbayes.no_such_name


@pytest.mark.parametrize(
    "package",
    here(
        "roughness",
        "topography",
        "contact",
        "friction",
        "wetting",
        "lubrication",
        "statistics",
        "diagnose",
        "files",
        "forward",
        "problem",
        "fit",
        "calibration",
        "reproduce",
    ),
)
def test_packages_list_what_they_export(package: str) -> None:
    module = import_module(f"skinbayes.{package}")
    assert module.__doc__
    assert list(module.__all__) == sorted(
        module.__all__, key=lambda name: (not name.isupper(), name)
    ) or list(module.__all__) == sorted(module.__all__)
    assert all(hasattr(module, name) for name in module.__all__)


def test_everything_public_has_a_docstring() -> None:
    bare = [name for name, node in public_definitions(DOCUMENTED) if not ast.get_docstring(node)]
    assert not bare, "\n".join(bare)


def unannotated(node: Definition) -> list[str]:
    if isinstance(node, ast.ClassDef):
        return []
    arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    extra = [argument for argument in (node.args.vararg, node.args.kwarg) if argument is not None]
    missing = [a.arg for a in (*arguments, *extra) if a.annotation is None and a.arg not in ("self", "cls")]
    return missing + (["return"] if node.returns is None else [])


def test_everything_public_is_annotated() -> None:
    wrong = {
        name: left for name, node in public_definitions((*DOCUMENTED, "cli")) if (left := unannotated(node))
    }
    assert not wrong, wrong


@pytest.mark.parametrize("name", sorted(PHYSICS))
def test_physics_states_the_unit_of_every_number(name: str) -> None:
    described = entries(PHYSICS[name].__doc__ or "")
    for argument in numeric_names(PHYSICS[name]):
        assert argument in described, f"{name}: '{argument}' is not described"
        assert UNIT.search(described[argument]), f"{name}: no unit in '{argument} : {described[argument]}'"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_physics_states_the_unit_of_its_result(name: str) -> None:
    doc = cleandoc(PHYSICS[name].__doc__ or "")
    if PHYSICS[name].__annotations__["return"] == "None":
        assert "Raises\n" in doc, f"{name} returns nothing and raises nothing"
        return
    returns = re.search(r"\nReturns\n-+\n(.*?)(?:\n\n|\Z)", doc, re.DOTALL)
    assert returns is not None, f"{name}: no section Returns"
    # a named tuple states the units of its fields, which the test above holds
    named = re.search(r"`(\w+)`", returns[1])
    stated = named is not None and any(key.endswith(f".{named[1]}") for key in PHYSICS)
    assert stated or UNIT.search(returns[1]), f"{name}: no unit in '{returns[1].strip()}'"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_physics_names_its_source(name: str) -> None:
    doc = PHYSICS[name].__doc__ or ""
    assert re.search(r"\b10\.\d{4,9}/\S+", doc), f"{name}: no DOI"
    assert re.search(r"\b(Eqs?\.|Sect\.|Fig\.|Chap\.) ?[\dA-Z]", doc), (
        f"{name}: no equation, section or figure"
    )


@pytest.mark.parametrize("name", FUNCTIONS)
def test_physics_shows_a_checked_example(name: str) -> None:
    assert ">>> " in (PHYSICS[name].__doc__ or ""), f"{name}: no example"


SIGNATURES = {
    name: tuple(inspect.signature(found).parameters.values())
    for name, found in PHYSICS.items()
    if not getattr(found, "_is_protocol", False)
}
"""Arguments of functions and constructors; those of named tuples are the fields of a result."""

METHODS = {
    f"{name}.{method}": tuple(inspect.signature(getattr(found, method)).parameters.values())[
        not isinstance(plain, classmethod) :
    ]
    for name, found in PHYSICS.items()
    if isinstance(found, type)
    for method, plain in vars(found).items()
    if method[0] != "_" and (inspect.isfunction(plain) or isinstance(plain, classmethod))
}
CALLED = METHODS | {
    name: arguments
    for name, arguments in SIGNATURES.items()
    if not (isinstance(PHYSICS[name], type) and issubclass(PHYSICS[name], tuple))
}


def is_positional(argument: inspect.Parameter) -> bool:
    return argument.kind in (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)


@pytest.mark.parametrize("name", sorted(CALLED))
def test_arguments_beyond_the_first_two_need_their_name(name: str) -> None:
    positional = [argument.name for argument in CALLED[name] if is_positional(argument)]
    assert len(positional) <= 2
    found = PHYSICS.get(name)
    if is_dataclass(found) and "__init__" not in inspect.getsource(found):
        assert len(CALLED[name]) <= 2 or len(positional) <= 1, "fields that could be taken for each other"


def disagreements(signatures: dict[str, list[str]]) -> list[str]:
    """Pairs of names that two signatures have in different order."""
    orders: dict[tuple[str, str], str] = {}
    for name, arguments in signatures.items():
        for pair in combinations(arguments, 2):
            orders.setdefault(pair, name)
    return [
        f"{orders[a, b]}: {a}, {b}; {orders[b, a]}: {b}, {a}" for a, b in orders if a < b and (b, a) in orders
    ]


def test_arguments_of_one_name_stand_in_one_order() -> None:
    assert not disagreements({name: [x.name for x in arguments] for name, arguments in SIGNATURES.items()})
    assert disagreements({"one": ["a", "b", "c"], "other": ["c", "a"]}) == ["one: a, c; other: c, a"]


KINDS = (
    ("normal_force", "load_per_length", "mean_pressure"),
    ("sphere_radius", "cylinder_radius", "radius_along", "radius_across", "effective_contact_radius"),
    ("reduced_modulus",),
)
"""Arguments of one kind under several names: load, then shape, then stiffness."""


@pytest.mark.parametrize("name", FUNCTIONS)
def test_arguments_of_one_kind_stand_in_one_order(name: str) -> None:
    rank = {argument: place for place, kind in enumerate(KINDS) for argument in kind}
    ranks = [rank[argument.name] for argument in SIGNATURES[name] if argument.name in rank]
    assert ranks == sorted(ranks)


def test_what_could_be_exchanged_needs_its_name() -> None:
    """Force and radius of a ball in the wrong order gave a friction coefficient of 0.124 in place of 0.915, with a cylinder."""
    from skinbayes.contact import LayeredSkin
    from skinbayes.lubrication import lubricated_films, stribeck_curve
    from skinbayes.roughness import named_surface

    skin, surface = (
        LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6),
        named_surface("paper_reference"),
    )
    with pytest.raises(TypeError, match="positional"):
        stribeck_curve([1e-3], 8e-3, 0.2, skin, surface, 15e6)  # type: ignore[misc]
    with pytest.raises(TypeError, match="positional"):
        lubricated_films([1e-3], 4.5e-3, 21.9, 26.7e3)  # type: ignore[misc]
    curve = stribeck_curve(
        [1e-3],
        sphere_radius=8e-3,
        normal_force=0.2,
        skin=skin,
        spectrum=surface,
        frictional_shear_stress=15e6,
    )
    assert curve.friction_coefficient == pytest.approx([1.006], abs=5e-4)
