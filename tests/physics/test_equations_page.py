"""Every function that docs/equations.md names exists, and every equation of the paper is accounted for."""

import importlib
import re
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "equations.md").read_text(encoding="utf-8")
NAMES = sorted(set(re.findall(r"`(skinbayes(?:\.\w+)+)`", PAGE)))


def test_the_page_names_functions():
    assert len(NAMES) > 10


@pytest.mark.parametrize("dotted", NAMES)
def test_named_function_exists(dotted):
    module, _, name = dotted.rpartition(".")
    assert callable(getattr(importlib.import_module(module), name))


@pytest.mark.parametrize("label", [*(f"Eq. {n}" for n in range(1, 10)), "Eq. B1", "Appendix A", "Appendix C"])
def test_equation_is_in_the_table(label):
    assert re.search(rf"^\| {re.escape(label)}\b", PAGE, re.MULTILINE)
