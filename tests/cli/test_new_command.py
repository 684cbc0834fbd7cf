"""``skinbayes new`` copies a shipped model so that it works where it lies; README's three steps do as they say."""

from __future__ import annotations

import re
import shlex
import textwrap
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_line import ROOT, run

import skinbayes as sb
from skinbayes.files import load_dataset, shipped_names
from skinbayes.files.modelfile import load_model
from skinbayes.problem import load_problem
from skinbayes.problem.template import data_template

README = (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("model", shipped_names("models"))
def test_a_copy_is_the_model_under_another_name(
    model: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    done = run(capsys, "new", model, "-o", tmp_path / "deep" / "mine.toml")
    assert done.status == 0 and "skinbayes check" in done.errors
    mine, shipped = load_model(tmp_path / "deep" / "mine.toml"), load_model(model)
    for name in (
        "forward",
        "parameters",
        "dataset",
        "rows",
        "observables",
        "groups",
        "baseline_models",
        "derived",
    ):
        assert getattr(mine, name) == getattr(shipped, name), name
    # what is said of the scatter of other data is marked as such
    own, others = ([replace(p, source="") for p in spec.noise_parameters] for spec in (mine, shipped))
    assert own == others
    assert mine.title != shipped.title and model in mine.title
    assert model in mine.description and shipped.description[:40] not in mine.description
    assert load_problem(tmp_path / "deep" / "mine.toml").fingerprint == load_problem(model).fingerprint


@pytest.mark.parametrize("model", [m for m in shipped_names("models") if load_model(m).dataset])
def test_a_copy_for_data_of_ones_own(model: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The data of the model under its template, in a folder beside that of the copy."""
    (tmp_path / "data").mkdir()
    data = load_dataset(str(load_model(model).dataset)).select(load_model(model).rows)
    columns = [column.name for column in data_template(model).columns]
    text = [data_template(model).header]
    text += [",".join(str(data.columns[name][row]) for name in columns) for row in range(data.n_rows)]
    (tmp_path / "data" / "mine.csv").write_text("\n".join(text) + "\n", encoding="utf-8")
    target = tmp_path / "models" / "own.toml"
    assert run(capsys, "new", model, "--data", tmp_path / "data" / "mine.csv", "-o", target).status == 0
    problem, shipped = load_problem(target), load_problem(model)
    assert problem.names == shipped.names and problem.dataset is not None
    assert problem.dataset.path.resolve() == (tmp_path / "data" / "mine.csv").resolve()
    assert problem.conditions.n_rows == shipped.conditions.n_rows
    assert problem.observed == pytest.approx(shipped.observed, rel=1e-14)
    theta = shipped.prior_medians()[np.newaxis]
    mine, theirs = problem.inputs(theta), shipped.inputs(theta)
    assert mine.keys() == theirs.keys()
    for name, values in theirs.items():
        assert mine[name] == pytest.approx(values, rel=1e-14), name
    assert "mine.csv" in problem.spec.title


X, Y = "speed_viscosity_product", "friction_coefficient"
SPREAD = "standard_deviation"
CURVES = {
    "plain": (f"{X} [N/m],{Y} [1]\n1e-3,0.5\n1e-2,0.3\n", "ignore", "ignore"),
    "spread": (f"{X} [N/m],{Y} [1],{Y}_{SPREAD} [1]\n1e-3,0.5,0.1\n1e-2,0.3,0.1\n", "use", "ignore"),
    "own load": (f"{X} [N/m],normal_force [N],{Y} [1]\n1e-3,0.5,0.5\n1e-2,0.6,0.3\n", "ignore", "ignore"),
    "own ball": (
        f"{X} [N/m],{X}_{SPREAD} [N/m],sphere_radius [mm],{Y} [1]\n1e-3,1e-4,5,0.5\n1e-2,1e-3,5,0.3\n", "ignore", "use",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CURVES)
def test_a_stribeck_curve_without_spread(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    content, spread, input_spread = CURVES[case]
    Path("curve.csv").write_text(content)
    if case in ("plain", "spread"):
        refused = run(capsys, "check", "stribeck-ball", "--data", "curve.csv")
        assert refused.status == 2
        # both ways out are said, and the command that is shown is the second one
        assert "Either add" in refused.errors and '= "ignore"' in refused.errors
        command = re.search(r"'skinbayes (new [^']*)'", refused.errors)
        assert command is not None
        assert run(capsys, *shlex.split(command[1])).status == 0
    else:
        assert run(capsys, "new", "stribeck-ball", "--data", "curve.csv", "-o", "mine.toml").status == 0
    block = tomllib.loads(Path("mine.toml").read_text(encoding="utf-8"))["data"]
    assert (block["spread"], block["input_spread"], block["file"]) == (spread, input_spread, "curve.csv")
    assert load_problem("mine.toml").conditions.n_rows == 2


def test_the_way_out_that_a_users_own_file_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "curve.csv").write_text(CURVES["plain"][0])
    text = (ROOT / "models" / "stribeck-ball.toml").read_text(encoding="utf-8")
    (tmp_path / "mine.toml").write_text(
        text.replace("[data]", '[data]\nfile = "curve.csv"'), encoding="utf-8"
    )
    refused = run(capsys, "check", tmp_path / "mine.toml")
    assert (
        "Either add" in refused.errors
        and "of the model file" in refused.errors
        and "skinbayes new" not in refused.errors
    )


def test_a_column_that_is_missing_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "mine.csv").write_text(
        "normal_force [mN],sphere_radius [mm],friction_coefficient [1]\n200,8,0.3\n"
    )
    text = (ROOT / "models" / "forearm-glass.toml").read_text(encoding="utf-8")
    (tmp_path / "my.toml").write_text(
        text.replace('dataset = "adams2007-forearm-glass"', 'file = "mine.csv"'), "utf-8"
    )
    refused = run(capsys, "check", tmp_path / "my.toml")
    assert refused.status == 2 and "no column 'state'" in refused.errors and "template" in refused.errors


def test_what_new_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "mine.toml"
    target.write_text("precious\n")
    refused = run(capsys, "new", "forearm-glass", "-o", target)
    assert refused.status == 2 and "exists already" in refused.errors and target.read_text() == "precious\n"
    assert run(capsys, "new", "forearm-glass", "-o", target, "--overwrite").status == 0
    for words, said in (
        (["forearm-glas", "-o", tmp_path / "a.toml"], "Did you mean 'forearm-glass'"),
        (["forearm-glass", "-o", tmp_path / "a.txt"], "ends in .toml"),
        (["forearm-glass", "-o", tmp_path / "a.toml", "--data", tmp_path / "no.csv"], "no.csv"),
        (["contact-area", "-o", tmp_path / "a.toml", "--data", "adams2007-forearm-glass"], "[data]"),
        (["finger-stribeck", "-o", tmp_path / "finger-null.toml"], "baseline_models"),
    ):
        refused = run(capsys, "new", *words)
        assert refused.status == 2 and said in refused.errors
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"]


def test_data_of_ones_own_do_not_carry_the_title_of_a_paper(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shipped = load_model("finger-water")
    Path("ours.csv").write_text(
        "normal_force [N],nominal_contact_area [cm^2],friction_coefficient [1],liquid\n0.5,3,1.2,water\n0.6,3,1.4,water\n"
    )
    problem = load_problem("finger-water", data="ours.csv")
    assert "ours.csv" in problem.spec.title and "finger-water" in problem.spec.title
    assert "own" in problem.spec.description and shipped.description[:30] not in problem.spec.description
    assert load_problem("finger-water").spec.title == shipped.title
    done = run(
        capsys, "fit", "finger-water", "--data", "ours.csv", "--ess", "20", "--max-steps", "100", "--report"
    )
    assert (
        done.status in (0, 3)
        and "ours.csv" in done.output
        and shipped.title not in done.output.splitlines()[0]
    )
    page = Path("runs/finger-water-seed1/report.html").read_text(encoding="utf-8")
    (heading,) = re.findall(r"<h1>(.*?)</h1>", page, re.DOTALL)
    assert "ours.csv" in heading and shipped.title not in heading
    fit = sb.load_fit("runs/finger-water-seed1")
    assert fit.provenance["title"] == problem.spec.title
    assert fit.provenance["description"] == problem.spec.description


def test_the_three_steps_of_the_readme(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    section = README.split("## Your own data, in three steps")[1].split("\n## ")[0]
    fences = [
        (language, textwrap.dedent(content))
        for language, content in re.findall(r"^ *```(\w+)\n(.*?)^ *```$", section, re.MULTILINE | re.DOTALL)
    ]
    assert [language for language, _ in fences] == ["csv", "console", "toml", "console"]
    monkeypatch.chdir(tmp_path)
    for language, content in fences:
        if language == "csv":
            Path("mine.csv").write_text(content, encoding="utf-8")
            asked = {column.name for column in data_template("forearm-glass").columns}
            assert asked == {header.split(" [")[0] for header in content.splitlines()[0].split(",")}
        elif language == "toml":
            header = content.splitlines()[0]
            text = Path("my-model.toml").read_text(encoding="utf-8")
            changed = re.sub(rf"^{re.escape(header)}\n(?:[^\[\n].*\n)*", content, text, flags=re.MULTILINE)
            assert changed != text
            Path("my-model.toml").write_text(changed, encoding="utf-8")
        else:
            for line in content.splitlines():
                words = shlex.split(line.removeprefix("$ skinbayes "))
                done = run(capsys, *words)
                assert done.status == 0, (line, done.errors)
    assert Path("runs/my-model-seed1/report.html").exists()
    assert "mine.csv" in load_problem("my-model.toml").spec.title
