"""The examples of docs/extending.md run as they stand, and a package that offers a forward model is found."""

from __future__ import annotations

import re
import subprocess
import sys
import textwrap
import zipfile
from pathlib import Path

import pytest
from source_tree import ROOT

PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
BLOCKS = dict(
    zip(re.findall(r"^## (.+)$", PAGE, re.M), re.findall(r"```python\n(.*?)```", PAGE, re.S), strict=True)
)

AFTER = {
    "A data frame": """
        again = sb.load_problem("my-forearm.toml")
        assert again.fingerprint == problem.fingerprint and again.names[-1] == "group_scale[session]"
        assert fit.converged
    """,
    "A forward model": """
        problem = sb.build_problem("coated-skin", {"cream_mass_per_area [mg/cm^2]": [0, 1], "friction_coefficient": [0.5, 0.8]},
            parameters={"typical_friction_coefficient": 0.5, "coated_friction_coefficient": {"uniform": [0, 2]},
                        "monolayer_mass_per_area": "1 mg/cm^2"}, noise={"family": "gaussian", "noise_scale": 0.1})
        assert np.allclose(problem.predict([1.0])["friction_coefficient"], [0.5, 0.5 + 0.5 * (1 - np.exp(-1))])
        assert problem.check().identifiability is not None
    """,
    "An emulator": """
        times = np.geomspace(10.0, 1000.0, 12)
        problem = sb.build_problem("fading-cream", {"time": times, "friction_coefficient": np.linspace(0.3, 0.5, 12)},
            parameters={"typical_friction_coefficient": {"lognormal": [0.5, 0.3]}, "fading_time": {"loguniform": [30, 900]}},
            noise={"family": "lognormal", "noise_scale": 0.05})
        exact = 0.4 * (1 - 0.5 / (1 + times / 200.0))  # exponentially spread rates
        assert np.allclose(problem.predict([0.4, 200.0])["friction_coefficient"], exact, rtol=1.1e-3)
        assert "are interpolated between" in problem.model.accuracy
    """,
    "A noise family": """
        from scipy import stats
        problem = sb.build_problem("constant", {"friction_coefficient": [0.5, 0.8]},
            noise={"family": "laplace", "noise_scale": 0.1}, parameters={"typical_friction_coefficient": {"uniform": [0, 2]}})
        assert np.isclose(problem.log_likelihood([0.6]), stats.laplace.logpdf([0.5, 0.8], 0.6, 0.06).sum())
    """,
    "A column": """
        problem = sb.build_problem(
            "constant", {"operator": ["A", "B"], "weather [degC]": [20, 21], "sebum_level [ug/cm^2]": [50, 100],
             "friction_coefficient": [0.5, 0.8]},
            parameters={"typical_friction_coefficient": {"by": "operator", "A": 0.5, "B": {"uniform": [0, 2]}}},
            covariates={"grease": {"column": "sebum_level", "acts_on": "friction_coefficient", "reference": "50 ug/cm^2",
                                  "exponent": 1.0}},
            noise={"family": "gaussian", "noise_scale": 0.1})
        assert problem.predict([0.4])["friction_coefficient"].round(9).tolist() == [0.5, 0.8]
        assert any("weather" in sentence for sentence in problem.check().setup)
    """,
}  # fmt: skip


def run(code: str, folder: Path, **environment: str) -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], cwd=folder, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("title", BLOCKS)
def test_the_example_runs_as_it_stands(title: str, tmp_path: Path) -> None:
    assert BLOCKS[title].count("\n") <= 30
    run(f"{BLOCKS[title]}\n{textwrap.dedent(AFTER[title])}", tmp_path)


def wheel_of(module: str, entry: str, folder: Path) -> Path:
    """A wheel of a package of one module, as a build tool makes it."""
    path = folder / "coated_skin-1.0-py3-none-any.whl"
    info = "coated_skin-1.0.dist-info"
    with zipfile.ZipFile(path, "w") as wheel:
        wheel.writestr("coated_skin.py", module)
        wheel.writestr(f"{info}/METADATA", "Metadata-Version: 2.1\nName: coated-skin\nVersion: 1.0\n")
        wheel.writestr(
            f"{info}/WHEEL", "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
        )
        wheel.writestr(f"{info}/entry_points.txt", f"[skinbayes.forward_models]\n{entry}\n")
        wheel.writestr(f"{info}/RECORD", "")
    return path


MODEL_FILE = """
title = "Cream"
forward = "coated-skin"

[data]
file = "cream.csv"
observable = "friction_coefficient"

[parameters]
typical_friction_coefficient = 0.5
coated_friction_coefficient = { uniform = [0, 2] }
monolayer_mass_per_area = "1 mg/cm^2"

[noise]
family = "gaussian"
noise_scale = 0.1
"""


@pytest.mark.parametrize(
    ("entry", "status"), [("coated-skin = coated_skin:MODEL", 0), ("coated-skin = coated_skin:MISSING", 2)]
)
def test_an_installed_package_offers_its_model_to_the_command_line(
    entry: str, status: int, tmp_path: Path
) -> None:
    module = BLOCKS["A forward model"].replace("sb.register_forward_model(MODEL)\n", "")
    wheel, site = wheel_of(module, entry, tmp_path), tmp_path / "site"
    installed = subprocess.run(
        [sys.executable, "-m", "pip", "install", "--no-deps", "--no-index", "--quiet", "--target", site, wheel],
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert installed.returncode == 0, installed.stderr
    (tmp_path / "cream.toml").write_text(MODEL_FILE, encoding="utf-8")
    (tmp_path / "cream.csv").write_text(
        "cream_mass_per_area [mg/cm^2],friction_coefficient [1]\n0,0.5\n1,0.8\n", encoding="utf-8"
    )
    start = f"import sys; sys.path.insert(0, {str(site)!r}); from skinbayes.cli import main; "
    for command in (["check", "cream.toml"], ["show", "cream.csv"], ["check", "forearm-glass"]):
        done = subprocess.run(
            [sys.executable, "-c", f"{start}sys.argv[1:] = {command}; main()"],
                cwd=tmp_path, capture_output=True, text=True, timeout=300,
        )  # fmt: skip
        expected = 0 if command[1] != "cream.toml" else status
        assert done.returncode == expected, done.stderr
        if expected:
            assert (
                "the forward model 'coated-skin' is offered by the installed package 'coated-skin', but cannot be used"
                in done.stderr
            )
