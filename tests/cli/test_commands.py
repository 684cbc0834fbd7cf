"""Every command, with and without --json: one document on standard output, progress and messages elsewhere."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from command_line import environment, run, run_process

from skinbayes.problem import load_problem

COMMANDS = ("models", "datasets", "show", "check", "prior", "predict", "fit", "compare", "report")
READING = (
    ["models"], ["datasets"], ["show", "forearm-glass"], ["show", "contact-area"], ["show", "finger-water"],
    ["show", "adams2007-forearm-glass"], ["show", "stratum-corneum-modulus"], ["check", "forearm-glass"],
    ["check", "finger-water"], ["prior", "forearm-glass", "--draws", "200"], ["predict", "contact-area"],
    ["predict", "forearm-glass-separate"],
)  # fmt: skip


def is_quiet(words, errors):
    """Nothing on standard error, but that medians of the prior are no result where there are free parameters."""
    if words == ["predict", "forearm-glass-separate"]:
        return errors.startswith("note: this is no result of a fit") and errors.count("\n") == 1
    return errors == ""


@pytest.mark.parametrize("words", READING, ids=" ".join)
def test_one_json_document(words, capsys):
    outcome = run(capsys, *words, "--json")
    assert outcome.status == 0 and is_quiet(words, outcome.errors)
    document = outcome.document()  # strict: fails on NaN, and on anything before or after the document
    assert isinstance(document, dict) and document
    assert outcome.output.endswith("}\n")


@pytest.mark.parametrize("words", READING, ids=" ".join)
def test_text_for_people(words, capsys):
    outcome = run(capsys, *words)
    assert outcome.status == 0 and is_quiet(words, outcome.errors)
    assert len(outcome.output.splitlines()) > 3
    assert "nan" not in outcome.output.lower().split()
    assert "\x1b" not in outcome.output  # no colours when it is not a terminal


def test_lists_hold_what_is_shipped(capsys):
    models = run(capsys, "models", "--json").document()["models"]
    assert {"forearm-glass", "forearm-glass-separate", "finger-water", "contact-area"} <= {
        m["name"] for m in models
    }
    datasets = run(capsys, "datasets", "--json").document()["datasets"]
    assert {"adams2007-forearm-glass", "fehlberg2025-finger-stribeck"} <= {d["name"] for d in datasets}
    for entry in datasets:
        assert entry["licence"] and entry["title"] and entry["rows"] > 0
    text = run(capsys, "models").output
    for entry in models:
        assert (
            sum(
                line.lstrip().startswith(f"{entry['name']} ") and line[:2].strip() != ""
                for line in text.splitlines()
            )
            == 1
        )


def test_show_says_where_priors_come_from(capsys):
    document = run(capsys, "show", "forearm-glass", "--json").document()
    problem = load_problem("forearm-glass")
    named = {p["name"]: p for p in document["parameters"]}
    assert set(problem.names) <= set(named)
    for name in problem.names:
        assert named[name]["prior"] and named[name]["source"]
    assert named["yield_stress[wet]"]["fixed"] == "inf"


def test_predict_document(capsys):
    document = run(
        capsys,
        "predict",
        "contact-area",
        "--set",
        "yield_stress=inf",
        "--set",
        "area_correction=none",
        "--json",
    ).document()
    assert set(document) == {"model", "parameters", "conditions", "prediction"}
    assert (
        document["parameters"]["yield_stress"] == "inf" and document["parameters"]["area_correction"] is None
    )
    assert document["parameters"]["young_modulus_layer"] == 7e6
    wavevector = document["conditions"]["wavevector"]
    assert (
        len(wavevector) == 61 and wavevector[0] == pytest.approx(1e3) and wavevector[-1] == pytest.approx(1e9)
    )
    area = document["prediction"]["relative_contact_area"]
    assert len(area) == 61 and np.all(np.diff(area) <= 0)


def test_predict_with_a_table_of_conditions(capsys, tmp_path):
    rows = tmp_path / "rows.csv"
    rows.write_text("state,normal_force [mN],sphere_radius [mm]\nwet,200,8\nwet,500,8\n")
    document = run(capsys, "predict", "forearm-glass", "--conditions", rows, "--json").document()
    assert document["conditions"]["normal_force"] == [0.2, 0.5] and document["conditions"]["state"] == [
        "wet",
        "wet",
    ]
    assert len(document["prediction"]["friction_coefficient"]) == 2


FIT = ("forearm-glass", "--seed", "3", "--ess", "500")


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    outcome = run_process("fit", *FIT, "--json", "-o", folder / "first", cwd=folder, timeout=300)
    return folder, outcome


def test_fit_document(runs):
    folder, outcome = runs
    assert outcome.status == 0, outcome.errors
    document = outcome.document()
    assert document["converged"] is True and document["seed"] == 3
    # by quadrature, see test_leave_out.py
    assert abs(document["log_evidence"] + 1.764) < 4 * document["log_evidence_error"] + 0.005 < 0.1
    assert Path(document["run"]) == folder / "first"
    assert set(document["parameters"]) == set(load_problem("forearm-glass").names)
    for values in document["parameters"].values():
        assert {"unit", "median", "q05", "q95", "ess_bulk", "ess_tail"} == set(values)
        assert values["q05"] < values["median"] < values["q95"] and values["ess_bulk"] >= 500
    assert document["log_likelihood_evaluations"] > 5_000 and document["seconds"] > 0


def test_fit_for_people_and_again(runs, capsys, monkeypatch):
    folder, _ = runs
    monkeypatch.chdir(folder)
    again = run(capsys, "fit", *FIT, "-o", "first")
    assert again.status == 2 and again.output == "" and "--resume" in again.errors
    resumed = run(capsys, "fit", *FIT, "-o", "first", "--resume")
    assert resumed.status == 0
    for name in load_problem("forearm-glass").names:
        assert name in resumed.output
    assert "Converged" in resumed.output and "NOT CONVERGED" not in resumed.output
    assert "skinbayes report first" in resumed.output


def test_not_converged_is_said_loudly(runs, capsys, monkeypatch):
    folder, _ = runs
    monkeypatch.chdir(folder)
    words = ("fit", "forearm-glass", "--seed", "3", "--ess", "1000000", "--max-steps", "100",
             "--engine-option", "importance=false")  # fmt: skip
    document = run(capsys, *words, "-o", "short", "--json")
    assert document.status == 3
    assert document.document()["converged"] is False and "Not converged" in document.document()["verdict"]
    text = run(capsys, *words, "-o", "short", "--resume")
    assert text.status == 3 and "NOT CONVERGED" in text.output
    compared = run(capsys, "compare", "first", "short", "--no-refit", "--json")
    assert compared.status == 0
    assert any("NOT CONVERGED" in sentence for sentence in compared.document()["sentences"])


def test_compare(runs, capsys):
    folder, _ = runs
    document = run(capsys, "compare", folder / "first", folder / "first", "--no-refit", "--json").document()
    assert [model["elpd_difference"] for model in document["models"]] == [0.0, 0.0]
    assert {"name", "elpd_loo", "elpd_loo_se", "weight"} <= set(document["models"][0])
    text = run(capsys, "compare", folder / "first", folder / "first", "--no-refit")
    assert text.status == 0 and "do not tell" in " ".join(text.output.split())
    assert run(capsys, "compare", folder / "first").status == 2


def test_report(runs, capsys):
    folder, _ = runs
    outcome = run(capsys, "report", folder / "first", "--json")
    assert outcome.status == 0 and outcome.errors == ""
    page = Path(outcome.document()["report"])
    assert page == folder / "first" / "report.html" and page.read_text(encoding="utf-8").lstrip().startswith(
        "<!"
    )
    elsewhere = run(capsys, "report", folder / "first", "-o", folder / "no" / "page.html")
    assert elsewhere.status == 2 and "there is no folder" in elsewhere.errors


@pytest.mark.parametrize("command", COMMANDS)
def test_help(command, capsys):
    outcome = run(capsys, command, "--help")
    assert (
        outcome.status == 0 and "--json" in outcome.output and "Usage: skinbayes " + command in outcome.output
    )


def test_help_of_everything_is_quick_and_imports_nothing_heavy(capsys):
    outcome = run(capsys, "--help")
    assert outcome.status == 0
    for command in COMMANDS:
        assert command in outcome.output
    assert "130 interrupted" in " ".join(outcome.output.split())
    script = (
        "import sys\nfrom skinbayes.cli import main\n"
        "try:\n    main(['--help'])\nexcept SystemExit:\n    pass\n"
        "heavy = {'numpy', 'scipy', 'pandas', 'xarray', 'matplotlib', 'arviz', 'emcee', 'pint', 'pydantic', 'h5py', 'rich'}\n"
        "print(sorted(heavy & set(sys.modules)), file=sys.stderr)\n"
    )
    began = time.process_time()
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, env=environment()
    )
    assert done.stderr.strip() == "[]"
    assert time.process_time() - began < 0.5  # of this process; the child's modules are what makes it slow


def test_version_and_nothing(capsys):
    from skinbayes import __version__

    assert run(capsys, "--version").output.strip().endswith(__version__)
    nothing = run(capsys)
    assert "Usage" in nothing.output + nothing.errors


def test_a_pipe_that_closes_early():
    process = subprocess.Popen(
        [sys.executable, "-c", "from skinbayes.cli import main; main(['show', 'fehlberg2025-finger-stribeck'])"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment(),
    )  # fmt: skip
    process.stdout.close()
    errors = process.stderr.read()
    process.wait(timeout=60)
    process.stderr.close()
    assert b"Traceback" not in errors


def test_json_is_the_same_in_a_process_of_its_own(capsys):
    outcome = run_process("predict", "contact-area", "--json")
    assert outcome.status == 0 and outcome.errors == ""
    assert json.loads(outcome.output) == run(capsys, "predict", "contact-area", "--json").document()
