"""The examples in docstrings give what they show."""

from __future__ import annotations

import doctest
from importlib import import_module

import pytest
from source_tree import modules, tree_of

WITH_EXAMPLES = [m for m in modules() if ">>> " in modules()[m].read_text(encoding="utf-8") and tree_of(m)]


@pytest.mark.parametrize("module", WITH_EXAMPLES)
def test_examples(module: str) -> None:
    """The example of a method goes on from that of its class."""
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    known: dict[str, dict[str, object]] = {}
    for test in sorted(doctest.DocTestFinder().find(import_module(module)), key=lambda test: test.name):
        test.globs |= known.get(test.name.rpartition(".")[0], {})
        runner.run(test, clear_globs=False)
        known[test.name] = test.globs
    assert runner.tries > 0
    assert runner.failures == 0
