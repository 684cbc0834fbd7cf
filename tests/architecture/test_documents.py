"""What the documents promise is there: commands, links, numbers, versions."""

from __future__ import annotations

import re
import shlex
import tomllib
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from command_line_page import PAGE, run
from source_tree import ROOT

import skinbayes as sb
from skinbayes.cli.main import cli
from skinbayes.files.locate import shipped_names

README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")])


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


def test_two_commands_of_one_line_each() -> None:
    first, second = (block.strip() for block in blocks("sh"))
    assert "\n" not in first + second
    for command in (first, second):
        venv = re.match(r"python3 -m venv (\S+) && (\S+)/bin/pip install -q ", command)
        assert venv is not None
        assert venv[1] == venv[2]
    words = shlex.split(first.rpartition("&&")[2])
    assert words[0].endswith("/bin/skinbayes")
    name, *arguments = words[1:]
    assert cli.commands[name].make_context(name, arguments).params["model"] in shipped_names("models")
    assert "'.[test]'" in second
    assert second.endswith("-m pytest -n 2")


def test_ci_takes_its_commands_from_the_readme() -> None:
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert "README.md" in script
    assert "pytest" not in script


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(document: Any) -> None:
    links = re.findall(r"\]\(([^)#\s]+)[^)]*\)", document.read_text(encoding="utf-8"))
    missing = [link for link in links if "://" not in link and not (document.parent / link).exists()]
    assert not missing


def test_every_document_is_linked_from_the_readme() -> None:
    linked = {link.partition("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", README)}
    pages = {str(path.relative_to(ROOT)) for path in DOCUMENTS} - {"README.md"}
    assert pages <= linked


def test_the_models_are_listed() -> None:
    table = re.search(r"^## Models\n(.*?)^## ", README, re.MULTILINE | re.DOTALL)
    assert table is not None
    assert sorted(re.findall(r"^\| `([\w-]+)` \|", table[1], re.MULTILINE)) == sorted(shipped_names("models"))


def test_check_says_what_the_readme_quotes(tmp_path: Any) -> None:
    said = " ".join(run("skinbayes check forearm-glass", tmp_path).split())
    quotes = re.findall(r"^> - (.*)$", README, re.MULTILINE)
    assert len(quotes) == 3
    for quote in quotes:
        assert quote in said


def test_the_comparison_is_the_one_of_the_command_line_page() -> None:
    quoted = re.search(
        r"difference of ([\d.]+) in predictive density.* probabilities of (0\.\d+) and (0\.\d+)", README
    )
    assert quoted is not None
    page = PAGE.read_text(encoding="utf-8")
    assert f"differ by {quoted[1]} " in page
    shown = re.findall(r"^ forearm-glass\S* .* (0\.\d{3})$", page, re.MULTILINE)
    assert [f"{float(one):.2f}" for one in shown] == [quoted[2], quoted[3]]


def test_python_example_and_the_table_of_results() -> None:
    first, second = blocks("python")
    names: dict[str, Any] = {}
    exec(first, names)
    summary = names["fit"].summary(derived=True)
    scale = {"MPa": 1e6, "µm": 1e-6}
    rows = re.findall(r"^\| ([^|]+) \| ([\d.e-]+) \| ([\d.e-]+) \| ([\d.e-]+) \|$", README, re.MULTILINE)
    meant = {
        "frictional shear stress": "frictional_shear_stress",
        "modulus of the wet": "young_modulus_layer[wet]",
        "yield stress of the dry": "yield_stress[dry]",
        "rms roughness": "rms_height",
        "σ_f/σ_Y": "shear_stress_over_yield_stress",
        "σ_f/(E0": "shear_stress_over_modulus_slope",
        "relative contact area, dry": "relative_contact_area[dry]",
        "relative contact area, wet": "relative_contact_area[wet]",
    }
    assert len(rows) == len(meant)
    for words, *values in rows:
        row = summary.loc[next(label for start, label in meant.items() if words.startswith(start))]
        factor = scale.get(words.rpartition(", ")[2], 1.0)
        shown = np.array([float(value) for value in values]) * factor
        # quantiles of 8000 effective draws: 3 % in the middle, 5 % in the tails
        assert shown == pytest.approx(row[["median", "q05", "q95"]].to_numpy(dtype=float), rel=0.05)

    area: dict[str, Any] = {}
    exec(second.replace("relative_contact_area(6830.0", "result = relative_contact_area(6830.0"), area)
    assert f"{area['result']:.2e}" == "6.48e-04"
    assert "# 6.48e-4" in second


def test_the_types_of_the_architecture_are_where_it_says() -> None:
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \| `([\w.]+)` \|", page, re.MULTILINE)
    assert len(rows) > 5
    for types, module in rows:
        home = import_module(f"skinbayes.{module}")
        missing = [name for name in re.findall(r"`(\w+)`", types) if not hasattr(home, name)]
        assert not missing, f"skinbayes.{module} has no {', '.join(missing)}"


def test_one_version_everywhere() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    latest = re.search(r"^## \[([\d.]+)\]", changes, re.MULTILINE)
    assert latest is not None
    assert sb.__version__ == project["version"] == latest[1]
    assert f"\nversion: {sb.__version__}\n" in citation
    assert project["license"] in citation
