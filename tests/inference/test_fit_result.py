"""The result of a fit: its groups, numbers, files, and that interrupted runs end as if nothing had happened."""

from __future__ import annotations

import json
import shutil
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from small_models import FINGER, same_draws, two_parameters, write_model

from skinbayes.errors import FingerprintMismatch, InputError, RepairWarning
from skinbayes.fit import Fit, load_fit, sample
from skinbayes.problem import load_problem

ROOT = Path(__file__).resolve().parents[2]
SMALL = {"seed": 5, "ess": 1000, "walkers": 32, "importance": False}
TINY = {"seed": 1, "ess": 50, "walkers": 32, "max_steps": 200, "importance": False}


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("runs") / "forearm"


@pytest.fixture(scope="module")
def fit(directory: Path) -> Fit:
    return sample(load_problem("forearm-glass"), directory=directory, **SMALL)


# -- schema ----------------------------------------------------------------------------------------------------------


def test_groups_and_dimensions_follow_the_schema(fit: Fit) -> None:
    assert set(fit.groups) == {
        "posterior", "sample_stats", "prior", "prior_predictive", "posterior_predictive", "log_likelihood",
        "observed_data", "constant_data", "validity",
    }  # fmt: skip
    for name, group in fit.groups.items():
        for variable in group.data_vars.values():
            if name in ("observed_data", "constant_data", "validity"):
                assert variable.dims == ("row",)
            else:
                assert variable.dims[:2] == ("chain", "draw")
            if variable.dtype.kind == "f":
                assert np.isfinite(variable.values).all(), f"{name}.{variable.name}"
                assert "units" in variable.attrs or name == "sample_stats", f"{name}.{variable.name}"
    posterior = fit.groups["posterior"]
    assert posterior.sizes["chain"] == 4
    assert posterior["young_modulus_layer"].dims == ("chain", "draw", "state")
    assert posterior["young_modulus_layer"].coords["state"].values.tolist() == ["dry", "wet"]
    assert fit.groups["posterior_predictive"]["friction_coefficient"].dims == ("chain", "draw", "row")
    assert fit.groups["observed_data"]["friction_coefficient"].values.tolist() == [0.3, 1.4]
    assert fit.groups["constant_data"]["state"].values.tolist() == ["dry", "wet"]
    assert posterior["frictional_shear_stress"].attrs["units"] == "Pa"


def test_draws_belong_together(fit: Fit) -> None:
    problem = load_problem("forearm-glass")
    theta = fit.theta()
    assert theta.shape == (fit.groups["posterior"].sizes["chain"] * fit.groups["posterior"].sizes["draw"], 7)
    some = slice(0, None, 97)
    pointwise = fit.groups["log_likelihood"]["friction_coefficient"].values.reshape(len(theta), 2)
    assert_allclose(
        pointwise[some], problem.log_likelihood(theta[some], pointwise=True), rtol=1e-12, atol=1e-12
    )
    lp = fit.groups["sample_stats"]["lp"].values.ravel()
    target = problem.target()
    assert_allclose(lp[some], target.log_density(target.transform.forward(theta[some])), rtol=1e-9, atol=1e-9)
    ratio = fit.draws("shear_stress_over_yield_stress")
    assert_allclose(ratio, fit.draws("frictional_shear_stress") / fit.draws("yield_stress[dry]"), rtol=1e-14)


def test_summary_is_quantiles_of_the_draws(fit: Fit) -> None:
    summary = fit.summary()
    assert tuple(summary.index) == fit.names
    for label, row in summary.iterrows():
        draws = fit.draws(str(label))
        assert [row["q05"], row["median"], row["q95"]] == np.quantile(draws, [0.05, 0.5, 0.95]).tolist()
        assert row["unit"] == ("Pa" if "modulus" in str(label) or "stress" in str(label) else "m")
        assert row["ess_bulk"] >= 1000 and row["r_hat"] <= 1.01
    priors = {p.label: p.prior for p in load_problem("forearm-glass").free}
    for label, row in summary.iterrows():
        # 4000 prior draws: the fraction below each quoted quantile, within five standard errors
        for key, fraction in (("prior_q05", 0.05), ("prior_median", 0.5), ("prior_q95", 0.95)):
            assert abs(priors[label].cdf(row[key]) - fraction) < 5 * np.sqrt(fraction * (1 - fraction) / 4000)
    assert len(fit.summary(derived=True)) > len(summary)


def test_draws_are_nearly_independent(fit: Fit) -> None:
    # an effective sample size by another estimator than the stopping rule's: variance of means of blocks
    for label in fit.names:
        for chain in np.log(fit.draws(label)).reshape(4, -1):
            count = chain.size // 20
            blocks = chain[: count * 20].reshape(20, count).mean(axis=1)
            inflation = blocks.var(ddof=1) * count / chain.var()
            assert inflation < 4.0, (
                label
            )  # chi-square with 19 degrees of freedom stays below 4 for truly independent ones


def test_effective_size_agrees_with_arviz(fit: Fit) -> None:
    from skinbayes.fit.arviz_adapter import arviz

    az = arviz()
    for label in ("frictional_shear_stress", "rms_height"):
        values = fit.draws(label).reshape(4, -1)
        if int(az.__version__.split(".")[0]) < 1:
            size = float(az.ess(values))
        else:
            size = float(np.asarray(az.ess(values, chain_axis=0, draw_axis=1)))
        assert size > 0.5 * values.size, label


def test_provenance(fit: Fit) -> None:
    problem, record = load_problem("forearm-glass"), fit.provenance
    assert record["fingerprint"] == problem.fingerprint
    assert record["sampling"]["seed"] == 5 and record["sampling"]["converged"] is True and fit.converged
    assert record["data"]["sha256"] == problem.dataset.sha256 and len(record["data"]["sha256"]) == 64
    assert record["data"]["origin"]["doi"] and record["model_text"] == problem.spec.text
    for package in ("python", "skinbayes", "numpy", "scipy", "emcee", "arviz", "xarray", "h5py"):
        assert record["versions"][package][0].isdigit()
    assert record["versions"]["numpy"] == np.__version__
    assert any("10.1007/s11249-012-0053-2" in text for text in fit.cite())
    assert any("emcee" in text for text in fit.cite())
    for entry in (*record["priors"].values(), *record["fixed"].values()):
        assert entry["source"]
    json.dumps(record)


# -- files -----------------------------------------------------------------------------------------------------------


def test_layout_of_a_run(fit: Fit, directory: Path) -> None:
    names = {item.name for item in directory.iterdir()}
    assert names == {"result.nc", "summary.csv", "run.json", "model.toml", "data", "steps"}
    assert (directory / "model.toml").read_text() == load_problem("forearm-glass").spec.text
    assert (directory / "data" / "data.csv").exists()
    assert not [
        item
        for item in directory.rglob("*")
        if item.suffix in (".pkl", ".pickle", ".npy", ".part", ".partial")
    ]
    table = (directory / "summary.csv").read_text().splitlines()
    assert table[0].startswith("parameter,unit,median,q05,q95") and table[1].startswith(
        "frictional_shear_stress,Pa,"
    )


def test_no_pickle_on_disk(fit: Fit, directory: Path) -> None:
    for file in directory.rglob("*"):
        if file.is_file():
            content = file.read_bytes()
            assert not content.startswith((b"\x80\x03", b"\x80\x04", b"\x80\x05"))
            assert not zipfile.is_zipfile(file)
    with h5py.File(directory / "result.nc", "r") as opened:
        opened.visititems(lambda name, item: None)
        kinds: list[str] = []
        opened.visititems(
            lambda name, item: kinds.append(item.dtype.kind) if isinstance(item, h5py.Dataset) else None
        )
    assert "V" not in kinds  # no opaque bytes


def test_round_trip(fit: Fit, directory: Path, tmp_path: Path) -> None:
    from_run = load_fit(directory)
    assert from_run.problem is not None and from_run.problem.name == "forearm-glass"
    assert from_run.problem.dataset is not None and from_run.problem.dataset.key == "adams2007-forearm-glass"
    same_draws(fit, from_run)
    assert from_run.provenance == fit.provenance
    assert from_run.summary().equals(fit.summary())
    assert from_run.problem is not None and from_run.problem.fingerprint == fit.provenance["fingerprint"]
    alone = load_fit(fit.save(tmp_path / "alone.nc"))
    same_draws(fit, alone)
    assert alone.problem is not None
    assert alone.names == fit.names and alone.derived_labels() == fit.derived_labels()
    for name, group in fit.groups.items():
        for variable, values in group.data_vars.items():
            assert dict(alone.groups[name][variable].attrs) == dict(values.attrs)


def test_a_run_can_be_moved_and_read_without_its_sources(tmp_path: Path) -> None:
    sources = tmp_path / "sources"
    sources.mkdir()
    (sources / "mine.csv").write_text(
        "friction_coefficient [1],normal_force [N],nominal_contact_area [cm^2]\n0.8,0.3,4\n1.0,0.5,4\n0.7,1,5\n"
    )
    q = np.geomspace(1e3, 1e8, 30)
    rows = "".join(f"{a!r},{1e-20 * (a / 1e4) ** -3.6!r}\n" for a in q.tolist())
    (sources / "surface.csv").write_text(
        "# convention: paper\nwavevector [1/m],power_spectrum_2d [m^4]\n" + rows
    )
    text = FINGER.format(
        parameters='frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }\nyoung_modulus_layer = "7 MPa"',
        noise='family = "lognormal"\nnoise_scale = { half_normal = 0.5 }',
    )
    text = text.replace('dataset = "fehlberg2025-finger-stribeck"', 'file = "mine.csv"')
    text = text.replace('rows = { liquid = ["water"] }', "").replace(
        'name = "paper_reference"', 'file = "surface.csv"'
    )
    problem = load_problem(write_model(sources, text), settings={"young_modulus_bulk": "15 kPa"})
    made = sample(problem, directory=tmp_path / "run", **TINY)
    shutil.rmtree(sources)
    shutil.move(tmp_path / "run", tmp_path / "moved")
    read = load_fit(tmp_path / "moved")
    same_draws(made, read)
    assert read.problem is not None and read.problem.fingerprint == problem.fingerprint
    theta = read.theta()[:5]
    assert_array_equal(read.problem.log_posterior(theta), problem.log_posterior(theta))
    # a file alone is readable, but its problem cannot be rebuilt, and is not replaced by another
    with pytest.warns(RepairWarning, match="cannot be read"):
        alone = load_fit(read.save(tmp_path / "alone.nc"))
    assert alone.problem is None
    same_draws(made, alone)


def test_a_result_of_other_data_is_not_bound_to_the_shipped_ones(tmp_path: Path) -> None:
    data = tmp_path / "data.csv"
    data.write_text(
        "state,friction_coefficient [1],normal_force [N],sphere_radius [m]\ndry,0.4,0.5,0.008\nwet,1.1,0.5,0.008\n"
    )
    made = sample(load_problem("forearm-glass", data=data), **TINY)
    with pytest.warns(RepairWarning, match="not what was fitted"):
        assert load_fit(made.save(tmp_path / "alone.nc")).problem is None
    made = sample(load_problem("forearm-glass", settings={"layer_thickness": "30 um"}), **TINY)
    with pytest.warns(RepairWarning, match="not what was fitted"):
        assert load_fit(made.save(tmp_path / "set.nc")).problem is None


def test_a_damaged_result_is_refused(fit: Fit, tmp_path: Path) -> None:
    path = fit.save(tmp_path / "whole.nc")
    content = path.read_bytes()
    for size in (0, 7, 4096, len(content) // 2):
        (tmp_path / "cut.nc").write_bytes(content[:size])
        with pytest.raises(InputError, match="not a result written by skinbayes"):
            load_fit(tmp_path / "cut.nc")


# -- options, not converging -----------------------------------------------------------------------------------------


def test_a_short_run_is_kept_and_says_so(tmp_path: Path) -> None:
    problem, run = two_parameters(tmp_path), tmp_path / "run"
    short = sample(problem, seed=1, ess=1e6, max_steps=200, directory=run, importance=False)
    assert not short.converged
    assert "Not converged after 200 steps" in short.provenance["sampling"]["verdict"]
    assert "1000000 is asked for" in short.provenance["sampling"]["verdict"]
    read = load_fit(run)
    assert not read.converged and read.provenance["sampling"]["missing"]
    # the same run, allowed more steps, is continued from where it stopped
    more = sample(problem, seed=1, ess=20_000, directory=run, resume=True, importance=False)
    assert more.converged and more.provenance["sampling"]["steps"] > 200
    same_draws(more, sample(problem, seed=1, ess=20_000, importance=False))


@pytest.mark.parametrize("options", [
    {"seed": -1}, {"seed": 1.5}, {"seed": True}, {"ess": 0}, {"ess": np.nan}, {"cores": 0}, {"max_steps": 5},
    {"walkers": 7}, {"walkers": 8}, {"ensembles": 1}, {"r_hat": 1.0}, {"block_steps": 0},
])  # fmt: skip
def test_options_out_of_range(options, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"sampler option {next(iter(options))}"):
        sample(load_problem("forearm-glass"), directory=tmp_path / "run", **options)
    assert not (tmp_path / "run").exists()


def test_nothing_to_infer(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="nothing to infer"):
        sample(load_problem("contact-area"))
    text = FINGER.format(
        parameters='frictional_shear_stress = "10 MPa"\nyoung_modulus_layer = "7 MPa"',
        noise='family = "lognormal"\nnoise_scale = 0.3',
    )
    with pytest.raises(InputError, match="nothing to infer"):
        sample(load_problem(write_model(tmp_path, text)))


def test_impossible_priors_are_said_before_sampling(tmp_path: Path) -> None:
    # a roll-off below the smallest wavevector: no spectrum, so no prediction anywhere
    text = FINGER.format(
        parameters='frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }\nyoung_modulus_layer = "7 MPa"\n'
        'wavevector_rolloff = "10 1/m"',
        noise='family = "lognormal"\nnoise_scale = 0.3',
    )
    with pytest.raises(InputError, match="wavevector_rolloff is 10 1/m"):
        sample(load_problem(write_model(tmp_path, text)))


# -- the same draws, however they are computed -----------------------------------------------------------------------


def test_two_processes_give_the_same_draws_and_another_seed_others() -> None:
    fit = sample(load_problem("forearm-glass"), seed=5, ess=1000)
    same_draws(fit, sample(load_problem("forearm-glass"), seed=5, ess=1000, cores=2))
    other = sample(load_problem("forearm-glass"), seed=6, ess=1000)
    assert not np.array_equal(other.draws("rms_height"), fit.draws("rms_height"))
    for label in fit.names:
        assert np.median(other.draws(label)) == pytest.approx(np.median(fit.draws(label)), rel=0.1)


def test_a_finished_run_is_read_again_by_resume(fit: Fit, directory: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(directory, copy)
    same_draws(fit, sample(load_problem("forearm-glass"), directory=copy, resume=True, **SMALL))
    (copy / "result.nc").unlink()
    same_draws(fit, sample(load_problem("forearm-glass"), directory=copy, resume=True, **SMALL))


def contents(directory: Path) -> dict[str, bytes]:
    return {
        str(item.relative_to(directory)): item.read_bytes() for item in directory.rglob("*") if item.is_file()
    }


def test_another_run_in_the_directory_is_never_touched(fit: Fit, directory: Path, tmp_path: Path) -> None:
    before = contents(directory)
    other = load_problem("forearm-glass-separate")
    with pytest.raises(InputError, match="holds a result already"):
        sample(other, directory=directory, **SMALL)
    with pytest.raises(FingerprintMismatch, match="holds a run of 'forearm-glass'"):
        sample(other, directory=directory, resume=True, **SMALL)
    with pytest.raises(FingerprintMismatch, match="seed is 5 there and 6 here"):
        sample(
            load_problem("forearm-glass"),
            directory=directory,
            resume=True,
            seed=6,
            ess=1000,
            walkers=32,
            importance=False,
        )
    assert contents(directory) == before
    unfinished = tmp_path / "unfinished"
    shutil.copytree(directory, unfinished)
    (unfinished / "result.nc").unlink()
    before = contents(unfinished)
    with pytest.raises(InputError, match=r"unfinished run.*--resume"):
        sample(load_problem("forearm-glass"), directory=unfinished, **SMALL)
    assert contents(unfinished) == before
