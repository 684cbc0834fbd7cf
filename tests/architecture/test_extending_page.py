"""The examples of docs/extending.md run as they stand, and a package that offers a forward model is found."""

from __future__ import annotations

import json
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


def install(modules: dict[str, str], entry_points: str, folder: Path) -> str:
    """Install a package, as a build tool makes its wheel; the beginning of a program that finds it."""
    path, site = folder / "of_ones_own-1.0-py3-none-any.whl", folder / "site"
    info = "of_ones_own-1.0.dist-info"
    with zipfile.ZipFile(path, "w") as wheel:
        for name, text in modules.items():
            wheel.writestr(f"{name}.py", text)
        wheel.writestr(f"{info}/METADATA", "Metadata-Version: 2.1\nName: of-ones-own\nVersion: 1.0\n")
        wheel.writestr(
            f"{info}/WHEEL", "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
        )
        wheel.writestr(f"{info}/entry_points.txt", entry_points)
        wheel.writestr(f"{info}/RECORD", "")
    installed = subprocess.run(
        [sys.executable, "-m", "pip", "install", "--no-deps", "--no-index", "--quiet", "--target", site, path],
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert installed.returncode == 0, installed.stderr
    return f"import sys; sys.path.insert(0, {str(site)!r}); "


ONE_AFTER_THE_OTHER = """
import contextlib, io, json
from skinbayes.cli import main
for words in {commands}:
    sys.argv[1:], status, said = words, 0, io.StringIO()
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(said):
        try:
            main()
        except SystemExit as ended:
            status = ended.code or 0
    print(json.dumps([status, said.getvalue()]))
"""


def commands(start: str, folder: Path, *words: list[str]) -> list[tuple[int, str]]:
    """Exit status and what is said of commands, in a process of their own that knows of the installed package."""
    program = start + ONE_AFTER_THE_OTHER.format(commands=list(words))
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0 and not done.stderr, done.stderr
    return [tuple(json.loads(line)) for line in done.stdout.splitlines()]


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
    start = install({"coated_skin": module}, f"[skinbayes.forward_models]\n{entry}\n", tmp_path)
    (tmp_path / "cream.toml").write_text(MODEL_FILE, encoding="utf-8")
    (tmp_path / "cream.csv").write_text(
        "cream_mass_per_area [mg/cm^2],friction_coefficient [1]\n0,0.5\n1,0.8\n", encoding="utf-8"
    )
    first, *others = commands(
        start, tmp_path, ["check", "cream.toml"], ["show", "cream.csv"], ["check", "forearm-glass"]
    )
    assert first[0] == status, first[1]
    if status:
        assert (
            "the forward model 'coated-skin' is offered by the installed package 'of-ones-own', but cannot be used"
            in first[1]
        )
    assert [status for status, _ in others] == [0, 0], others


ENGINES_PAGE = (ROOT / "docs" / "engines.md").read_text(encoding="utf-8")
CONSTANT = """
title = "Readings with long tails"
forward = "constant"

[data]
file = "readings.csv"
observable = "friction_coefficient"

[parameters]
typical_friction_coefficient = { uniform = [0, 2] }

[noise]
family = "laplace"
noise_scale = 0.1
"""


def test_an_installed_package_offers_noise_and_an_engine(tmp_path: Path) -> None:
    """Those of the pages, one that is not there, one under a name that is taken, one of another name than its entry point."""
    noise = re.sub(
        r"sb\.register_noise\((sb\.NoiseFamily\(.*\n\))\)",
        r"NOISE = \1",
        BLOCKS["A noise family"],
        flags=re.S,
    )
    engine = re.search(r"```python\n(.*?class PriorImportance.*?)\n\nsb\.register_engine", ENGINES_PAGE, re.S)
    assert engine is not None and "NOISE = " in noise
    entries = [
        "[skinbayes.noise_families]", "laplace = noise:NOISE", "cauchy = noise:NOISE", "gaussian = noise:NOISE", "",
        "[skinbayes.engines]", "prior-importance = engine:ENGINE", "a-class = engine:PriorImportance",
        "gone = engine:MISSING", "nested = engine:ENGINE",
    ]  # fmt: skip
    modules = {"noise": noise, "engine": f"{engine[1]}\n\nENGINE = PriorImportance()\n"}
    start = install(modules, "\n".join(entries), tmp_path)
    (tmp_path / "mine.toml").write_text(CONSTANT, encoding="utf-8")
    (tmp_path / "cauchy.toml").write_text(CONSTANT.replace("laplace", "cauchy"), encoding="utf-8")
    (tmp_path / "readings.csv").write_text("friction_coefficient [1]\n0.5\n0.6\n0.9\n", encoding="utf-8")
    (fitted,) = commands(
        start, tmp_path, ["fit", "mine.toml", "--engine", "prior-importance", "--ess", "100"]
    )
    assert fitted[0] == 0, fitted[1]
    refusals = (
        (["check", "cauchy.toml"], "noise.family: the noise family 'cauchy' is offered by the installed package 'of-ones-own'"),
        (["fit", "mine.toml", "--engine", "gone"], "engine 'gone' is offered by the installed package 'of-ones-own', but cannot"),
        (["fit", "mine.toml", "--engine", "a-class"], "an object with run"),
        (["fit", "mine.toml", "--engine", "prior-imports"], "did you mean 'prior-importance'"),
        (["fit", "mine.toml", "--engine", "nested", "--engine-option", "live_points=1"], "at least 20"),
    )  # fmt: skip
    *refused, (status, _) = commands(
        start, tmp_path, *(words for words, _ in refusals), ["check", "forearm-glass"]
    )
    for (_, expected), (its_status, said) in zip(refusals, refused, strict=True):
        assert its_status == 2 and expected in said and "Traceback" not in said
        assert len(said.splitlines()) == 1
    assert status == 0  # the others disturb nobody
