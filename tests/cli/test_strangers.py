"""What a stranger met on the command line and in Python: each once wrong, unclear or a traceback."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest
from command_line import run
from small_models import two_parameters

import skinbayes as sb
from skinbayes.errors import InputError, RepairWarning
from skinbayes.files.locate import shipped_names
from skinbayes.files.modelfile import load_model
from skinbayes.files.parameter_block import parse_parameter
from skinbayes.fit import load_fit, storage
from skinbayes.problem import Problem, load_problem
from skinbayes.units import parse_quantity
from skinbayes.vocabulary import QUANTITIES


def test_the_width_of_a_temperature_has_no_zero() -> None:
    """A spread of 2 degC was taken for 275.15 K."""
    for width in ("2 degC", "2 K", "3.6 degF"):
        prior = parse_parameter(QUANTITIES["temperature"], {"normal": ["20 degC", width]}, "x").prior
        assert prior is not None
        low, high = prior.interval(0.9)
        assert prior.median == pytest.approx(293.15) and high - low == pytest.approx(
            2 * 1.6448536 * 2, rel=1e-6
        )


@pytest.mark.parametrize("text", ["-300 degC", "-5 K", "-460 degF"])
def test_below_absolute_zero(text: str) -> None:
    with pytest.raises(InputError, match="below absolute zero"):
        parse_quantity(text, "K", where="here")
    assert parse_quantity("-273.15 degC", "K", where="here") == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("text", ["3 % %", "3 %^2", "3 %2", "3 % \u2030", "3 percent percent", "3 %/%"])
def test_a_share_of_a_share_is_a_slip(text: str) -> None:
    with pytest.raises(InputError, match="unknown unit"):
        parse_quantity(text, "1", where="here")
    assert parse_quantity("3 %", "1", where="here") == 0.03
    assert parse_quantity("3 %/s", "1/s", where="here") == 0.03


@pytest.mark.skipif(sys.platform == "win32", reason="no such files")
def test_overwriting_what_is_no_text(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe")
    os.mkfifo(tmp_path / "pipe.toml")
    assert run(capsys, "new", "finger-null", "-o", tmp_path / "bytes.toml", "--overwrite").status == 0
    for command in ("new", "template"):
        refused = run(capsys, command, "finger-null", "-o", tmp_path / "pipe.toml", "--overwrite")
        assert refused.status == 2 and "no ordinary file" in refused.errors
    assert (tmp_path / "pipe.toml").is_fifo()


@pytest.mark.parametrize("model", shipped_names("models"))
def test_a_copy_does_not_say_of_new_data_what_held_for_the_old(
    model: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(capsys, "new", model, "-o", tmp_path / "mine.toml").status == 0
    for copied, shipped in zip(
        load_model(tmp_path / "mine.toml").noise_parameters, load_model(model).noise_parameters, strict=True
    ):
        assert (copied.value, copied.prior) == (shipped.value, shipped.prior)
        assert not shipped.source or (copied.source != shipped.source and model in copied.source)


def test_a_problem_prints_as_a_summary() -> None:
    for name in shipped_names("models"):
        lines = str(load_problem(name)).splitlines()
        assert len(lines) <= 32 and max(map(len, lines)) <= 200
    said = str(load_problem("forearm-glass"))
    assert "2 rows of adams2007-forearm-glass" in said and "frictional_shear_stress: loguniform" in said


def test_every_short_help_fits(capsys: pytest.CaptureFixture[str]) -> None:
    shown = run(capsys, "--help")
    assert shown.status == 0 and "..." not in shown.output.partition("Commands:")[2]


def test_expensive_physics_is_checked_with_few_evaluations(monkeypatch: pytest.MonkeyPatch) -> None:
    """2,800 solutions took 30 s."""
    problem, counts = load_problem("drying-glass", settings={"closure": "sharp"}), []
    evaluate = Problem.evaluate

    def counted(self, inputs, *more, **named):
        counts.append(max(len(values) for values in inputs.values()))
        return evaluate(self, inputs, *more, **named)

    monkeypatch.setattr(Problem, "evaluate", counted)
    assert "All of 200 prior draws" in " ".join(problem.check().sentences())
    assert sum(counts) < 500


def test_a_lone_result_of_another_version(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fit = sb.sample(two_parameters(tmp_path), max_steps=100, directory=tmp_path / "run")
    # too short a run to know any effective sample size
    assert fit.summary()[["ess_bulk", "ess_tail"]].min().min() != 0
    alone = fit.save(tmp_path / "alone.nc")
    assert load_fit(alone).problem is not None
    with (tmp_path / "run" / "summary.csv").open("a") as table:
        table.write("mine,1\n")
    with pytest.warns(RepairWarning, match=r"summary\.csv: damaged, or changed"):
        assert load_fit(tmp_path / "run").names == fit.names
    monkeypatch.setattr(storage, "__version__", "9.9")
    monkeypatch.setattr(storage, "_is_identical", lambda *a: False)
    with pytest.warns(RepairWarning, match=r"written by version 0\.1\.0 of skinbayes, this is 9\.9"):
        assert load_fit(alone).problem is None
