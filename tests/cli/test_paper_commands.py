"""``plot``, ``table`` and ``methods``: what a paper needs from a run."""

from __future__ import annotations

import csv
import io
import re
import shutil
import subprocess
from dataclasses import replace
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from command_line import run

import skinbayes as sb
from skinbayes.fit import storage

HOSTILE = r"a_b & 50 % \input{x} #1 $y ~^ {皮} <b> | *z* [c]"


@pytest.fixture(scope="module")
def fit() -> sb.Fit:
    """Eleven loads, weighted draws of the prior."""
    problem = sb.load_problem("finger-water")
    before = problem.draw_prior(np.random.default_rng(1), 200)
    return sb.Fit.from_draws(problem, before, log_weights=problem.log_likelihood(before))


@pytest.fixture(scope="module")
def place(fit: sb.Fit, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the fit as one file."""
    folder = tmp_path_factory.mktemp("paper")
    fit.save(folder / "fit.nc")
    return folder


READ = cache(storage.load_any_fit)


@pytest.fixture(autouse=True)
def read_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reading a run takes most of the time of these commands: each is read once."""
    monkeypatch.setattr(storage, "load_any_fit", READ)


def test_names_of_figures_are_listed(capsys: pytest.CaptureFixture[str], place: Path) -> None:
    outcome = run(capsys, "plot", place / "fit.nc", "--json")
    assert outcome.status == 0
    assert {"data", "predictive", "prior-posterior", "corner", "profile-wavevector"} <= set(
        outcome.document()["figures"]
    )


@pytest.mark.parametrize(("width", "millimetres"), [("84 mm", 84.0), ("174mm", 174.0)])
def test_a_pdf_has_its_width_and_its_fonts(
    capsys: pytest.CaptureFixture[str], place: Path, width: str, millimetres: float
) -> None:
    file = place / f"{millimetres}.pdf"
    assert run(capsys, "plot", place / "fit.nc", "data", "-o", file, "--width", width).status == 0
    content = file.read_bytes()
    box = re.search(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", content)
    assert box is not None
    assert float(box[1]) / 72.0 * 25.4 == pytest.approx(millimetres, abs=0.1)
    fonts = re.findall(rb"/FontDescriptor /FontName|/Type /FontDescriptor", content)
    assert fonts and content.count(b"/FontFile2") == len(fonts) and b"/Type3" not in content
    assert b"/Subtype /Image" not in content


def test_an_svg_has_its_width_and_letters_of_journal_size(
    capsys: pytest.CaptureFixture[str], place: Path, fit: sb.Fit
) -> None:
    file = place / "one.svg"
    assert run(capsys, "plot", place / "fit.nc", "data", "-o", file, "--width", "174 mm").status == 0
    root = ElementTree.parse(file).getroot()
    assert root.attrib["width"].endswith("pt")
    assert float(root.attrib["width"].removesuffix("pt")) / 72.0 * 25.4 == pytest.approx(174.0, abs=0.1)
    assert not list(root.iter("{http://www.w3.org/2000/svg}text"))  # outlines: no font is needed
    assert not list(root.iter("{http://www.w3.org/2000/svg}image"))
    from skinbayes.plot.journal import journal_file

    for width in ("84 mm", "174 mm"):
        figure = fit.plot_prior_posterior(width)
        journal_file(figure, "svg")
        drawn = [
            text for ax in figure.axes for text in (ax.xaxis.label, ax.yaxis.label, *ax.get_xticklabels())
        ]
        assert all(7.0 <= float(text.get_fontsize()) <= 9.0 for text in drawn)


def test_a_fit_that_has_not_converged_says_so_in_its_figure_and_no_other_has_a_title(fit: sb.Fit) -> None:
    from skinbayes.plot.journal import journal_file

    sampling = fit.provenance["sampling"]
    for converged in (True, False):
        one = replace(fit, provenance={**fit.provenance, "sampling": {**sampling, "converged": converged}})
        figure = one.plot_predictive("84 mm")
        journal_file(figure, "pdf")
        assert bool(figure.get_suptitle()) is not converged


def test_several_figures_go_into_a_folder(capsys: pytest.CaptureFixture[str], place: Path) -> None:
    names = ("predictive", "prior-posterior")
    outcome = run(capsys, "plot", place / "fit.nc", *names, "--format", "svg", "-o", place / "figs", "--json")
    assert outcome.status == 0
    written = outcome.document()["figures"]
    assert [Path(written[name]["file"]).name for name in names] == ["predictive.svg", "prior-posterior.svg"]
    assert all(Path(entry["file"]).stat().st_size and entry["caption"] for entry in written.values())
    again = run(capsys, "plot", place / "fit.nc", "predictive", "-o", place / "figs" / "predictive.svg")
    assert again.status == 2 and "exists already" in again.errors


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["corne"], "Did you mean 'corner'?"),
        (["data", "--width", "2 m"], "expected 60 to 600 mm"),
        (["data", "--width", "84"], "no unit"),
        (["data", "--format", "jpg"], "expected pdf or svg or png"),
        (["data", "-o", "x.docx"], "ends with .pdf or .svg or .png"),
        (["data", "-o", "x.svg", "--format", "pdf"], "--format is pdf"),
        (["data", "--against", "loads"], "can be drawn against normal_force"),
        (["corner", "--against", "normal_force"], "expected it with 'data'"),
    ],
)
def test_errors_say_what_was_expected(
    capsys: pytest.CaptureFixture[str], place: Path, arguments: list[str], message: str
) -> None:
    outcome = run(capsys, "plot", place / "fit.nc", *arguments)
    assert outcome.status == 2 and message in outcome.errors


def test_the_table_is_the_summary(capsys: pytest.CaptureFixture[str], place: Path, fit: sb.Fit) -> None:
    for name, derived in (("parameters", False), ("derived", True)):
        outcome = run(capsys, "table", place / "fit.nc", name, "--format", "csv")
        assert outcome.status == 0
        rows = list(csv.DictReader(io.StringIO(outcome.output)))
        summary = fit.summary(derived=derived)
        labels = [row["quantity" if derived else "parameter"] for row in rows]
        assert labels == [label for label in summary.index if (label not in fit.names) == derived]
        for row, label in zip(rows, labels, strict=True):
            assert [float(row[key]) for key in ("median", "q05", "q95")] == pytest.approx(
                summary.loc[label, ["median", "q05", "q95"]].astype(float).tolist(), rel=1e-14
            )
            assert row["unit"] == summary.loc[label, "unit"]


def test_predictions_are_those_of_the_posterior(
    capsys: pytest.CaptureFixture[str], place: Path, fit: sb.Fit
) -> None:
    document = run(capsys, "table", place / "fit.nc", "predictions", "--json").document()
    drawn = fit.groups["posterior_predictive"]["friction_coefficient"].values.reshape(
        -1, len(document["rows"])
    )
    found = [[row["q05"], row["median"], row["q95"]] for row in document["rows"]]
    np.testing.assert_allclose(np.array(found).T, np.quantile(drawn, [0.05, 0.5, 0.95], axis=0), rtol=1e-12)
    observed = fit.groups["observed_data"]["friction_coefficient"].values
    np.testing.assert_array_equal([row["observed"] for row in document["rows"]], observed)


def test_numbers_of_the_printed_table_are_those_of_the_csv(fit: sb.Fit) -> None:
    from skinbayes.report import paper_table

    table = paper_table(fit, "parameters")
    for row in table.text("markdown").splitlines():
        if row.startswith("| frictional shear stress"):
            median, unit = row.split(" | ")[4], row.split(" | ")[2]
            assert unit == "MPa"
            assert float(median) == pytest.approx(
                fit.quantiles("frictional_shear_stress", 0.5) / 1e6, rel=5e-3
            )
            break
    else:
        raise AssertionError("no such row")


def hostile(fit: sb.Fit) -> sb.Fit:
    """The fit with texts that mean something in LaTeX and Markdown."""
    told = dict(fit.provenance)
    label = fit.names[0]
    told["priors"] = {**told["priors"], label: {**told["priors"][label], "text": HOSTILE, "source": HOSTILE}}
    told["title"] = HOSTILE
    told["data"] = {**told["data"], "name": HOSTILE}
    return replace(fit, provenance=told)


def test_what_means_something_elsewhere_is_escaped(fit: sb.Fit) -> None:
    from skinbayes.report import methods_text, paper_table

    for text in (paper_table(hostile(fit), "parameters").text("latex"), methods_text(hostile(fit), "latex")):
        assert r"\& 50 \% \textbackslash{}input\{x\} \#1 \$y \textasciitilde{}\textasciicircum{}" in text
        assert "皮" not in text and r"\input{" not in text
        body = "\n".join(line for line in text.splitlines() if not line.startswith("% needs"))
        assert body.isascii()
        assert not re.search(r"(?<!\\)[%#]", body)
        assert body.replace(r"\{", "").replace(r"\}", "").count("{") == body.replace(r"\{", "").replace(
            r"\}", ""
        ).count("}")
    table = paper_table(hostile(fit), "parameters").text("markdown")
    assert r"\<b\> \| \*z\* \[c\]" in table
    cells = {len(re.findall(r"(?<!\\)\|", line)) for line in table.splitlines() if line.startswith("|")}
    assert cells == {7}


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no LaTeX here")
def test_latex_takes_what_is_written(fit: sb.Fit, tmp_path: Path) -> None:
    from skinbayes.report import methods_text, paper_table

    bad = hostile(fit)
    parts = [
        paper_table(bad, name).text("latex") for name in ("parameters", "derived", "fixed", "predictions")
    ]
    document = "\n\n".join([
        r"\documentclass{article}\usepackage{booktabs}\begin{document}", methods_text(bad, "latex"), *parts, r"\end{document}",
    ])  # fmt: skip
    (tmp_path / "paper.tex").write_text(document, encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "paper.tex"]
    outcome = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert outcome.returncode == 0, outcome.stdout[-2000:]
    assert "Missing character" not in outcome.stdout


def test_methods_say_what_the_run_has(capsys: pytest.CaptureFixture[str], place: Path, fit: sb.Fit) -> None:
    outcome = run(capsys, "methods", place / "fit.nc")
    assert outcome.status == 0
    text = outcome.output
    assert ("NOT CONVERGED" in text) is not fit.converged
    for label in fit.names:
        assert fit.provenance["priors"][label]["text"] in text
    assert f"skinbayes {sb.__version__}" in text and f"{len(fit.names)} parameters were inferred" in text
    assert "11 values of friction coefficient in 11 rows" in text
    # these draws come from no engine of the package, and no engine is named
    assert "emcee of skinbayes" not in text and "evidence" not in text
    assert text.count("\n[") == len(fit.cite())
    assert max(map(int, re.findall(r"\[(\d+)", text))) == len(fit.cite())


def test_keys_of_the_text_are_those_of_the_bibliography(
    capsys: pytest.CaptureFixture[str], place: Path
) -> None:
    latex = run(capsys, "methods", place / "fit.nc", "--format", "latex").output
    assert run(capsys, "methods", place / "fit.nc", "-o", place / "works.bib").status == 0
    keys = set(re.findall(r"^@\w+\{([^,]+),", (place / "works.bib").read_text(), re.MULTILINE))
    cited = {key for group in re.findall(r"\\cite\{([^}]+)\}", latex) for key in group.split(",")}
    assert cited and cited == keys


def test_formats_and_tables_that_are_not_there(capsys: pytest.CaptureFixture[str], place: Path) -> None:
    for arguments, message in (
        (("table", place / "fit.nc", "parameter"), "Did you mean 'parameters'?"),
        (("table", place / "fit.nc", "--format", "xlsx"), "expected csv or latex or markdown"),
        (("methods", place / "fit.nc", "-o", place / "x.doc"), "ends with .txt or .md or .tex or .bib"),
        (("table", place / "fit.nc", "-o", place / "fit.nc", "--format", "csv"), "exists already"),
    ):
        outcome = run(capsys, *arguments)
        assert outcome.status == 2 and message in outcome.errors
