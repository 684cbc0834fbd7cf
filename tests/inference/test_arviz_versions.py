"""Results are ArviZ results, for ArviZ below 1 and from 1 on, in this interpreter and in others that are at hand."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import warnings
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
from small_models import three_parameters

from skinbayes.comparison import compare
from skinbayes.comparison.scores import score
from skinbayes.fit import Fit, load_fit, sample
from skinbayes.fit.arviz_adapter import arviz

ROOT = Path(__file__).resolve().parents[2]
MAJOR = int(version("arviz").split(".")[0])
VARIABLES = {"frictional_shear_stress", "young_modulus_layer", "noise_scale"}


@pytest.fixture(scope="module")
def fit(tmp_path_factory: pytest.TempPathFactory) -> Fit:
    return sample(
        three_parameters(tmp_path_factory.mktemp("arviz")),
        seed=3,
        ess=2000,
        walkers=64,
        max_steps=400,
        importance=False,  # R-hat is compared too
    )


@pytest.fixture(scope="module")
def path(fit: Fit, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return fit.save(tmp_path_factory.mktemp("file") / "result.nc")


def test_arviz_reads_the_file(fit: Fit, path: Path) -> None:
    data = arviz().from_netcdf(path)
    found = set(data.groups()) if MAJOR < 1 else {name.strip("/") for name in data.groups}
    assert set(fit.groups) <= found
    assert set(data["posterior"].data_vars) >= VARIABLES
    np.testing.assert_array_equal(
        data["posterior"]["noise_scale"].values, fit.groups["posterior"]["noise_scale"].values
    )


def test_to_arviz_is_the_type_of_the_installed_version(fit: Fit) -> None:
    made = fit.to_arviz()
    assert type(made).__name__ == ("InferenceData" if MAJOR < 1 else "DataTree")
    np.testing.assert_array_equal(made["posterior"]["noise_scale"], fit.groups["posterior"]["noise_scale"])
    np.testing.assert_array_equal(
        made["observed_data"]["friction_coefficient"],
        fit.problem.observed,  # type: ignore[union-attr]
    )


def test_summary_of_arviz_agrees(fit: Fit) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        table = arviz().summary(fit.to_arviz(), var_names=["noise_scale"], round_to="none")
    assert float(table["mean"].iloc[0]) == pytest.approx(fit.draws("noise_scale").mean(), rel=1e-6)
    assert float(table["r_hat"].iloc[0]) < 1.01
    assert float(table["ess_bulk"].iloc[0]) > 2000


def test_leave_one_out_by_arviz_agrees_with_refitting_by_weights(fit: Fit) -> None:
    result = score(fit)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        direct = arviz().loo(fit.to_arviz(), pointwise=True)
    elpd = direct.elpd_loo if hasattr(direct, "elpd_loo") else direct.elpd
    p = direct.p_loo if hasattr(direct, "p_loo") else direct.p
    # its tails are a little longer or shorter, by the autocorrelation of the draws
    assert result.single.elpd == pytest.approx(float(elpd), abs=0.02)
    assert result.effective_parameters == pytest.approx(float(p), abs=0.02)
    shapes = [entry.pareto_k for entry in result.single.levels]
    np.testing.assert_allclose(shapes, direct.pareto_k.values.ravel(), atol=0.15)
    # plain importance sampling, p(y_i | y_-i) = 1/E[1/p(y_i | θ)]: noisier than Pareto smoothing, but the same quantity
    log_p = fit.groups["log_likelihood"]["friction_coefficient"].values.reshape(-1, 11)
    plain = -np.log(np.mean(np.exp(-log_p), axis=0))
    np.testing.assert_allclose(result.single.pointwise, plain, atol=0.05)
    assert result.single.pointwise.sum() == pytest.approx(result.single.elpd, rel=1e-12)
    assert 1.0 < result.effective_parameters < 4.0  # two combinations are determined


def test_the_posterior_predictive_check_of_arviz_accepts_the_groups(fit: Fit) -> None:
    made = fit.to_arviz()
    predicted = np.asarray(made["posterior_predictive"]["friction_coefficient"])
    assert predicted.shape[-1] == 11
    fraction = (predicted < np.asarray(made["observed_data"]["friction_coefficient"])).mean(axis=(0, 1))
    assert (fraction > 0.005).all() and (fraction < 0.995).all()


SCRIPT = """
import sys
import arviz as az
from skinbayes.comparison import compare
from skinbayes.fit import load_fit
fit = load_fit(sys.argv[1])
data = az.from_netcdf(sys.argv[1])
print(int(az.__version__.split(".")[0]), repr(float(data["posterior"]["noise_scale"].values.sum())))
model = compare([fit, fit], refit=False).models[0]
print(repr(float(model.elpd_loo)))
print(repr(float(fit.summary().loc["noise_scale", "median"])))
"""


def other_interpreters() -> list[str]:
    """Interpreters beside this one, or named in SKINBAYES_OTHER_PYTHON, that have ArviZ of another major version."""
    named = os.environ.get("SKINBAYES_OTHER_PYTHON", "").split(os.pathsep)
    found = [shutil.which(f"python3.{minor}") for minor in (11, 12, 13, 14)]
    question = "import arviz, h5netcdf; print(arviz.__version__.split('.')[0])"
    usable = []
    for candidate in dict.fromkeys(filter(None, [*named, *found])):
        if Path(candidate).resolve() == Path(sys.executable).resolve() and candidate not in named:
            continue
        answer = subprocess.run(
            [candidate, "-W", "ignore", "-c", question], capture_output=True, text=True, check=False
        )
        if answer.returncode == 0 and answer.stdout.strip().isdigit() and int(answer.stdout) != MAJOR:
            usable.append(candidate)
    return usable


def test_the_other_arviz_reads_the_same_numbers(fit: Fit, path: Path) -> None:
    interpreters = other_interpreters()
    if not interpreters:
        pytest.skip("no interpreter with another major version of ArviZ is at hand")
    done = subprocess.run(
        [interpreters[0], "-W", "ignore", "-c", SCRIPT, str(path)],
        capture_output=True, text=True, check=True, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    lines = done.stdout.splitlines()
    major, total = lines[0].split()
    assert int(major) != MAJOR
    assert float(total) == fit.groups["posterior"]["noise_scale"].values.sum()
    here = compare([fit, load_fit(path)], refit=False).models[0]
    # the two versions smooth the tails slightly differently
    assert float(lines[1]) == pytest.approx(here.elpd_loo, abs=0.02)
    assert float(lines[2]) == fit.summary().loc["noise_scale", "median"]
