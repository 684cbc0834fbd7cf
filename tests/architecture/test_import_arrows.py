"""Each floor of docs/architecture.md knows only those below it; read from the imports, also those inside functions."""

from __future__ import annotations

import ast
import sys
from graphlib import CycleError, TopologicalSorter

import pytest
from source_tree import HEAVY, ROOT, Import, all_imports, floor_of, imports_of, modules, tree_of

WORDS = {"errors", "arrays", "constants", "defaults", "phrases", "vocabulary"}
FILES = {"atomic", "sealed"}
PHYSICS = {"roughness", "topography", "contact", "friction", "wetting", "lubrication"}
STATISTICS = {"statistics", "sampling", "diagnose"}

MAY_KNOW: dict[str, set[str]] = {
    "errors": set(),
    "arrays": set(),
    "constants": set(),
    "atomic": set(),
    "sealed": set(),
    "phrases": set(),
    "defaults": set(),
    "synonyms": set(),
    "version": set(),
    "quantity": set(),
    "quantities": {"quantity"},
    "vocabulary": {"errors", "quantities", "quantity", "synonyms"},
    "units": {"errors", "arrays", "vocabulary", "constants"},
    "plugins": {"vocabulary"},
    "emulation": {"errors", "arrays"},
    # physics
    "roughness": {"errors", "arrays", "constants"},
    "topography": {"errors", "arrays", "constants", "roughness"},
    "contact": {"errors", "arrays", "constants", "roughness"},
    "friction": {"errors", "arrays", "constants"},
    "wetting": {"errors", "arrays", "constants", "emulation", "roughness", "contact", "friction"},
    "lubrication": {"errors", "arrays", "constants", "emulation", "roughness", "contact", "friction"},
    # force against time
    "recordings": {"errors", "arrays"},
    # statistics that know nothing of skin
    "statistics": {"errors", "arrays"},
    "sampling": {"errors", "arrays", "defaults", *FILES, "statistics", "version"},
    "diagnose": {"errors", "arrays", "phrases", "statistics"},
    # where they meet
    "files": {*WORDS, "sealed", "plugins", "units", "roughness", "topography", "recordings", "statistics", "synonyms", "version"},
    "forward": {*WORDS, "plugins", "emulation", *PHYSICS},
    "problem": {*WORDS, "atomic", "units", "emulation", "roughness", "topography", "statistics", "diagnose", "files",
                "forward", "version"},
    "fit": {*WORDS, *FILES, "plugins", "units", "statistics", "sampling", "diagnose", "files", "topography", "problem",
            "version"},
    "comparison": {*WORDS, "units", "statistics", "problem", "fit"},
    "calibration": {*WORDS, *FILES, "statistics", "sampling", "problem", "fit"},
    "each": {*WORDS, *FILES, "sampling", "files", "forward", "problem", "fit"},
    # the paper beside the physics
    "reproduce": {*WORDS, "units", "files", *PHYSICS},
    # faces
    "plot": {*WORDS, "atomic", "units", "topography", "reproduce", "roughness", "recordings", "statistics", "diagnose", "forward",
             "problem", "fit", "comparison", "calibration"},
    "report": {*WORDS, "atomic", "units", "roughness", "topography", "recordings", "statistics", "diagnose", "files", "forward",
               "problem", "fit", "comparison", "calibration", "plot", "reproduce"},
    "cli": {*WORDS, "atomic", "units", "topography", "recordings", "files", "forward", "problem", "fit", "each", "comparison",
            "calibration", "plot", "report", "reproduce", "version"},
    "__main__": {"cli"},
    # the shop window names its goods but opens them when asked
    "skinbayes": {"version", "errors", "vocabulary", "statistics", "sampling", "files", "forward", "problem", "fit", "each",
                  "comparison", "calibration"},
}  # fmt: skip
"""Floor to the floors it may import, besides itself."""

METHODS_MAY_DRAW = {
    "skinbayes.fit.drawn_fit": {"DrawnFit"},
    "skinbayes.calibration.result": {"Calibration", "OddsCalibration"},
}
"""``plot_*`` of results reach up to the figures, lazily: a convenience of the result, not a dependency of the module."""

HOMES: dict[str, set[str]] = {
    "SurfaceTopography": {"files"},
    "arviz": {"fit"},
    "click": {"cli"},
    "distributed": {"sampling"},
    "corner": {"plot"},
    "dynesty": {"sampling"},
    "emcee": {"sampling"},
    "h5netcdf": {"fit"},
    "h5py": {"files", "sampling", "fit"},
    "jinja2": {"report"},
    "matplotlib": {"plot", "report"},
    "numpy": set(MAY_KNOW)
    - {
        "skinbayes",
        "errors",
        "phrases",
        "quantities",
        "quantity",
        "synonyms",
        "vocabulary",
        "defaults",
        *FILES,
    },
    "pandas": {"calibration", "each", "files", "fit", "plot", "report"},
    "pint": {"units"},
    "PIL": {"files"},
    "platformdirs": {"emulation"},
    "pydantic": {"files", "fit"},
    "rich": {"cli"},
    "tomlkit": {"files"},
    "scipy": {
        *PHYSICS,
        *STATISTICS,
        "recordings",
        "files",
        "problem",
        "fit",
        "comparison",
        "calibration",
        "plot",
        "reproduce",
    },
    "xarray": {"fit", "plot", "report"},
}
"""Library to the floors that may import it; a library that is not here is not a dependency."""


def reaches_up_lazily(found: Import) -> bool:
    return (
        found.module in METHODS_MAY_DRAW
        and floor_of(found.target) == "plot"
        and len(found.inside) == 2
        and found.inside[0] in METHODS_MAY_DRAW[found.module]
        and found.inside[1].startswith("plot_")
    )


def within(target: str, library: str) -> bool:
    return target == library or target.startswith(library + ".")


def test_every_floor_has_a_rule_and_a_place_in_the_drawing() -> None:
    floors = {floor_of(module) for module in modules()}
    assert floors <= set(MAY_KNOW), f"no rule for {sorted(floors - set(MAY_KNOW))}"
    drawing = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8").split("## Arrays")[0]
    missing = [f for f in floors - {"skinbayes"} if not any(f"{f}{end}" in drawing for end in (".py", "/"))]
    assert not missing, f"docs/architecture.md does not draw {sorted(missing)}"


@pytest.mark.parametrize("floor", sorted({floor_of(module) for module in modules()}))
def test_floor_knows_only_those_below(floor: str) -> None:
    wrong = [
        str(found)
        for module in modules()
        if floor_of(module) == floor
        for found in imports_of(module)
        if within(found.target, "skinbayes")
        and floor_of(found.target) not in MAY_KNOW[floor] | {floor}
        and not reaches_up_lazily(found)
    ]
    assert not wrong, "\n".join(wrong)


def test_the_rules_themselves_have_no_circle() -> None:
    below = {floor: known - {"skinbayes"} for floor, known in MAY_KNOW.items()}
    settled: set[str] = set()
    while left := [floor for floor in below if floor not in settled]:
        free = [floor for floor in left if below[floor] <= settled]
        assert free, f"a circle among {left}"
        settled |= set(free)


def test_no_module_needs_one_that_needs_it() -> None:
    # imports inside functions and for annotations only count as well: a circle of names is one of ideas
    needs: dict[str, set[str]] = {}
    for module in modules():
        needs[module] = set()
        for node in ast.walk(tree_of(module)):
            if isinstance(node, ast.ImportFrom) and node.module and within(node.module, "skinbayes"):
                deeper = {f"{node.module}.{alias.name}" for alias in node.names}
                needs[module] |= (deeper & set(modules())) or {node.module}
    try:
        TopologicalSorter(needs).prepare()
    except CycleError as circle:
        pytest.fail(f"a circle of imports: {' -> '.join(circle.args[1])}")


def test_statistics_know_no_skin_and_physics_no_inference() -> None:
    # said once more in plain words, so that a careless change of the table above is seen
    skin = {
        *PHYSICS,
        "files",
        "forward",
        "problem",
        "fit",
        "comparison",
        "plot",
        "report",
        "cli",
        "vocabulary",
        "units",
    }
    assert not any(MAY_KNOW[floor] & skin for floor in STATISTICS)
    assert not any(
        MAY_KNOW[floor] - {"errors", "arrays", "constants", "emulation"} - PHYSICS for floor in PHYSICS
    )
    assert not MAY_KNOW["files"] & {"forward", "problem", "sampling", "fit"}
    assert not MAY_KNOW["problem"] & {"sampling", "fit", "plot", "report", "cli"}
    assert not MAY_KNOW["fit"] & {"plot", "report", "cli"}


def test_libraries_stay_in_their_rooms() -> None:
    wrong = []
    for found in all_imports():
        library = found.target.partition(".")[0]
        if library in sys.stdlib_module_names or library == "skinbayes":
            continue
        if library not in HOMES:
            wrong.append(f"{found}, which is not a dependency")
        elif floor_of(found.module) not in HOMES[library]:
            wrong.append(f"{found}; expected only in {', '.join(sorted(HOMES[library]))}")
    assert not wrong, "\n".join(wrong)


def test_heavy_libraries_are_imported_where_they_are_used() -> None:
    wrong = [str(f) for f in all_imports() if not f.lazy and any(within(f.target, name) for name in HEAVY)]
    assert not wrong, "\n".join(wrong)


def test_only_the_command_line_writes_to_the_terminal() -> None:
    wrong = []
    for module in modules():
        if floor_of(module) == "cli":
            continue
        for node in ast.walk(tree_of(module)):
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id in ("print", "input")
            ):
                wrong.append(f"{module}, line {node.lineno}: {node.func.id}()")
            if isinstance(node, ast.Attribute) and node.attr in (
                "stdout",
                "stderr",
                "stdin",
                "argv",
                "echo",
                "secho",
            ):
                wrong.append(f"{module}, line {node.lineno}: .{node.attr}")
            if isinstance(node, ast.ImportFrom) and node.module == "sys":
                wrong.append(
                    f"{module}, line {node.lineno}: from sys import; write sys.NAME, so that it can be seen"
                )
    assert not wrong, "\n".join(wrong)


def test_nothing_runs_text_from_a_file() -> None:
    # a model file is data: whoever opens a stranger's file runs nothing
    wrong = []
    for module in modules():
        for node in ast.walk(tree_of(module)):
            name = (
                getattr(node.func, "id", getattr(node.func, "attr", "")) if isinstance(node, ast.Call) else ""
            )
            if name in ("eval", "exec", "compile", "__import__", "system", "popen") and not _is_regex(node):
                wrong.append(f"{module}, line {node.lineno}: {name}()")
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("pickle.load", "pickle.dump"):
                wrong.append(
                    f"{module}, line {node.lineno}: pickle on disk; files are TOML, CSV, netCDF and HDF5"
                )
    wrong += [
        str(found)
        for found in all_imports()
        if found.target.partition(".")[0] in ("shelve", "marshal", "dill")
    ]
    assert not wrong, "\n".join(wrong)


def _is_regex(call: ast.Call) -> bool:
    return ast.unparse(call.func) == "re.compile"
