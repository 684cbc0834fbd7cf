"""What is not used is not imported: seen in a fresh interpreter."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest
from source_tree import HEAVY, ROOT

SHOW = "import json, sys; print(json.dumps(sorted(sys.modules)))"


def modules_after(code: str) -> set[str]:
    """Names of all modules that are loaded after running ``code`` in a new interpreter."""
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\n{SHOW}"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return set(json.loads(done.stdout.splitlines()[-1]))


def loaded(names: list[str], present: set[str]) -> list[str]:
    return [
        name for name in names if any(module == name or module.startswith(name + ".") for module in present)
    ]


def test_importing_the_package_imports_no_library() -> None:
    present = modules_after("import skinbayes; skinbayes.__version__; dir(skinbayes)")
    assert not loaded([*HEAVY, "numpy", "scipy", "pydantic", "click"], present)


@pytest.mark.parametrize("arguments", [["--help"], ["fit", "--help"], ["--version"], ["no-such-command"]])
def test_help_imports_neither_numpy_nor_scipy(arguments: list[str]) -> None:
    code = f"""
from skinbayes.cli import main
try:
    main({arguments!r})
except SystemExit:
    pass
"""
    assert not loaded([*HEAVY, "numpy", "scipy", "pydantic"], modules_after(code))


def test_physics_alone_imports_numpy_and_scipy_only() -> None:
    present = modules_after("import skinbayes.roughness, skinbayes.contact, skinbayes.friction")
    assert loaded(["numpy"], present)
    assert not loaded([*HEAVY, "pydantic", "click"], present)
    assert not {
        m for m in present if m.startswith(("skinbayes.statistics", "skinbayes.files", "skinbayes.forward"))
    }


def test_binding_a_model_needs_no_sampler_and_no_figures() -> None:
    present = modules_after("import skinbayes; p = skinbayes.load_problem('forearm-glass')")
    assert not loaded(["arviz", "corner", "emcee", "matplotlib", "pandas", "rich", "xarray"], present)


def test_a_fit_without_figures_imports_no_figures() -> None:
    code = "import skinbayes; skinbayes.Fit, skinbayes.sample, skinbayes.load_fit, skinbayes.compare"
    assert not loaded(["arviz", "corner", "emcee", "matplotlib", "pandas", "xarray"], modules_after(code))
