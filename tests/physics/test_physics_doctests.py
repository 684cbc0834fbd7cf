"""The examples in the docstrings of the physics modules are right, and every public function has one."""

import doctest
import importlib
import inspect
import pkgutil

import pytest

import skinbayes.contact
import skinbayes.friction
import skinbayes.roughness
import skinbayes.wetting

PACKAGES = (skinbayes.roughness, skinbayes.contact, skinbayes.friction, skinbayes.wetting)
MODULES = [
    f"{package.__name__}.{module.name}"
    for package in PACKAGES
    for module in pkgutil.iter_modules(package.__path__)
]
PUBLIC = [(package.__name__, name) for package in PACKAGES for name in package.__all__]


@pytest.mark.parametrize("name", MODULES)
def test_examples_of(name):
    result = doctest.testmod(importlib.import_module(name))
    assert result.failed == 0


@pytest.mark.parametrize(("module", "name"), PUBLIC)
def test_every_public_function_names_units_source_and_an_example(module, name):
    thing = getattr(importlib.import_module(module), name)
    if inspect.isfunction(thing):
        for part in (
            "Parameters",
            "Raises" if name.startswith("validate") else "Returns",
            "References",
            "doi",
            ">>>",
        ):
            assert part in thing.__doc__, f"{module}.{name} lacks {part}"
