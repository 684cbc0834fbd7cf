"""The pages on the commonest work and on load and time say what is so: their programs run, their commands give their numbers."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
from command_line_page import run
from source_tree import ROOT

import skinbayes as sb
from skinbayes.problem.template import data_template

PAGE = (ROOT / "docs" / "ready-models.md").read_text(encoding="utf-8")
READY = {"load-series": "loads.csv", "sites": "sites.csv", "treatment": "cream.csv"}
SLOW = pytest.param("stribeck-own", marks=pytest.mark.slow)
TABLES = READY | {"stribeck-own": "curve.csv"}


def blocks(page: str, language: str) -> list[str]:
    found = re.findall(r"^```(\w*)\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    return [text for word, text in found if word == language]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the first program of the page has written its tables."""
    return written(tmp_path_factory.mktemp("work"), blocks(PAGE, "python")[0])


def written(place: Path, program: str) -> Path:
    """The folder, after a program has run in it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place)
        exec(program, {})
    return place


def truths() -> dict[str, float]:
    """Result to the truth that its table states."""
    rows = re.findall(r"^\| `([\w\[\]]+)` \| ([-\d.]+)[^|]*\| ", PAGE, re.MULTILINE)
    return {name: float(value) for name, value in rows}


@pytest.mark.parametrize("model", [*READY, SLOW])
def test_the_tables_fit_the_models(model: str, folder: Path, tmp_path: Path) -> None:
    """A copy of the model, the header of its template, and the table of the page belong together."""
    run(f"skinbayes new {model} -o {tmp_path / 'mine.toml'}", folder)
    if model not in READY:
        written(folder, blocks(PAGE, "python")[1])
    header = (folder / TABLES[model]).read_text(encoding="utf-8").splitlines()[0]
    names = {column.split(" [")[0] for column in header.split(",")}
    expected = {column.name for column in data_template(tmp_path / "mine.toml").columns}
    instead = {"speed_viscosity_product"} if "speed_viscosity_product" in expected else set()
    assert expected - instead <= names
    problem = sb.load_problem(tmp_path / "mine.toml", folder / TABLES[model])
    assert problem.names == sb.load_problem(model).names


def compare_with_page(results: dict[str, dict[str, float]]) -> None:
    """Medians and intervals of the page that are among the results, to the digits shown and what draws leave open."""
    shown = re.findall(
        r"^\| `([\w\[\]]+)` \|[^|]*\| ([-\d.]+) \| ([-\d.]+) to ([-\d.]+) \|$", PAGE, re.MULTILINE
    )
    rows = [(name, values) for name, *values in shown if name in results]
    assert rows
    for name, values in rows:
        found = results[name]
        width = found["q95"] - found["q05"]
        for text, key in zip(values, ("median", "q05", "q95"), strict=True):
            # 9000 effective draws leave 1 % of the interval open in the middle, 2 % at its ends
            last_digit = 10.0 ** -len(text.partition(".")[2])
            assert abs(float(text) - found[key]) < 0.6 * last_digit + 0.04 * width, (name, key)


@pytest.mark.slow
@pytest.mark.parametrize("model", TABLES)
def test_the_commands_give_the_numbers_of_the_page(model: str, folder: Path) -> None:
    if model not in READY:
        written(folder, blocks(PAGE, "python")[1])
    start = f"skinbayes fit {model} --data {TABLES[model]}"
    command = next(line for line in PAGE.splitlines() if line.startswith(start))
    said = json.loads(run(f"{command} --json", folder))
    assert said["converged"]
    place = folder / shlex.split(command)[-1]
    compare_with_page(sb.load_fit(place).summary(derived=True).to_dict("index"))


def test_the_truths_of_the_page_are_those_of_its_program() -> None:
    program = blocks(PAGE, "python")[0]
    known = truths()
    assert known["covariate_exponent[load]"] == float(re.search(r"load\*\*(-[\d.]+)", program)[1])  # type: ignore[index]
    assert known["noise_scale"] == float(re.search(r"lognormal\(0, ([\d.]+)\):.3f", program)[1])  # type: ignore[index]
    assert known["after_over_before"] == float(re.search(r'"after": ([\d.]+)', program)[1])  # type: ignore[index]
    assert f"lognormal(0, {known['group_scale[person]']})" in program
    assert f"lognormal(0, {known['group_scale[session]']})" in program


def test_the_dwell_model_of_the_page_finds_a_growth(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "load-and-time.md").read_text(encoding="utf-8")
    (tmp_path / "dwell.toml").write_text(blocks(page, "toml")[0], encoding="utf-8")
    rows = [f"{dwell},0.5,200,1.0" for dwell in (0, 2, 5, 10, 20, 40)]
    header = "dwell_time [s],normal_force [N],nominal_contact_area [mm^2],friction_coefficient [1]"
    (tmp_path / "dwell.csv").write_text("\n".join([header, *rows]), encoding="utf-8")
    problem = sb.load_problem(tmp_path / "dwell.toml")
    friction = problem.predict_data(problem.prior_medians())
    # half at once and 10 s at the prior medians: 1 - 0.5 exp(-t/10 s)
    assert friction[3] / friction[0] == pytest.approx((1 - 0.5 * 2.718281828**-1) / 0.5, rel=1e-6)
    said = " ".join(problem.check().sentences())
    assert "contact_growth_time" in said
