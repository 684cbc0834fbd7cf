"""``fit --set`` and ``fit --engine-option``: values set over the model file, and what an engine can be told."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import run

from skinbayes.fit import load_fit

QUICK = (
    "--ess",
    "10",
    "--max-steps",
    "100",
    "--engine-option",
    "walkers=16",
    "--engine-option",
    "ensembles=2",
)


def test_a_parameter_that_is_set_is_not_inferred(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    words = ("fit", "finger-null", "--set", "typical_friction_coefficient=0.7", "-o", "run", *QUICK, "--json")
    done = run(capsys, *words)
    assert done.status in (0, 3), done.errors
    assert "typical_friction_coefficient" not in done.document()["parameters"]
    fit = load_fit("run")
    (held,) = [p for p in fit.problem.fixed if p.name == "typical_friction_coefficient"]
    assert held.value == 0.7 and held.source == "set by the user"
    assert fit.provenance["sampling"]["walkers"] == 16 and fit.provenance["sampling"]["ensembles"] == 2
    # without the setting it is another problem
    refused = run(capsys, "fit", "finger-null", "-o", "run", *QUICK, "--resume")
    assert refused.status == 2 and "run" in refused.errors


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--engine-option", "live_points=100"], "no option 'live_points'; expected some of seed, ess, cores"),
        (["--engine-option", "walkers=many"], "walkers: 'many' found, a whole number"),
        (["--engine-option", "walkers"], "expected NAME=VALUE"),
        (["--engine-option", "seed=3"], "expected as --seed"),
        (["--engine", "nested", "--engine-option", "live_points=5"], "live_points: 5 found, a whole number of at least 20"),
        (["--engine", "nested", "--engine-option", "live_point=50"], "expected some of seed, ess, cores, expensive, live_points"),
        (["--engine", "nested", "--max-steps", "500"], "engine 'nested': no option 'max_steps'; expected some of"),
        (["--set", "typical_friction=0.7"], "Did you mean 'typical_friction_coefficient'"),
        (["--set", "typical_friction_coefficient=1", "--set", "typical_friction_coefficient=2"], "set twice"),
    ],
)  # fmt: skip
def test_options_that_cannot_be(
    words: list[str],
    said: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    refused = run(capsys, "fit", "finger-null", *words)
    assert refused.status == 2 and said in refused.errors
    assert not list(tmp_path.iterdir())
