"""The seam to engines: exact answers through it, engines from outside, weights, and what is said when it cannot be."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from sampling_targets import LinearGaussian
from scipy.special import ndtr, ndtri
from small_models import same_draws, two_parameters
from small_runs import SMALL

from skinbayes import register_engine, sample
from skinbayes.errors import FingerprintMismatch, InputError
from skinbayes.fit import load_fit
from skinbayes.sampling import Draws, EngineOptions, PlainProgress
from skinbayes.sampling.draws import weighted_quantiles
from skinbayes.sampling.engines import ENGINES, find_engine, options_for

SHARES = np.array([0.05, 0.5, 0.95])


class Importance:
    """Draws of the prior, weighed by the likelihood."""

    count = 40_000

    def run(self, target, options, store, progress):
        position = target.prior_transform(
            np.random.default_rng(options.seed).random((self.count, len(target.names)))
        )
        if progress is not None:
            progress(PlainProgress(1, "weighing"))
        return Draws(position, target.log_likelihood(position), diagnostics={"colour": "green"})


class Plain(Importance):
    """Four chains of independent draws without diagnostics, from the weighted ones."""

    def run(self, target, options, store, progress):
        drawn = super().run(target, options, store, progress)
        equal = drawn.equally_weighted(4000, np.random.default_rng(options.seed))
        return Draws(equal.reshape(4, 1000, -1))


def drawn(engine, target, **given):
    name, found = find_engine(engine)
    return found.run(target, options_for(name, found, seed=1, **given), None, None)


def hold_against_the_exact_answer(target, draws, within=4.5):
    """Shares below the exact quantiles, along coordinates and along the ridge, in standard errors of the effective size."""
    mean, covariance = target.moments()
    directions = np.concatenate([np.eye(target.dimension), np.ones((1, target.dimension))])
    size = draws.diagnostics["ess_tail" if draws.log_weights is None else "ess_bulk"].min()
    weights = np.ones(draws.samples[..., 0].size)
    if draws.log_weights is not None:
        weights = np.exp(draws.log_weights - draws.log_weights.max()).ravel()
    for direction in directions:
        values = (draws.samples.reshape(-1, target.dimension) @ direction - direction @ mean) / np.sqrt(
            direction @ covariance @ direction
        )
        found = ndtr(weighted_quantiles(values, weights, SHARES))
        assert np.all(np.abs(found - SHARES) < within * np.sqrt(SHARES * (1 - SHARES) / size)), direction


# 4.5 standard errors, 9 to 18 comparisons: once in 8000 runs by chance
@pytest.mark.parametrize(("dimension", "ridge"), [(2, 1.0), (3, 30.0), (5, 30.0)])
def test_ensembles_against_the_exact_answer(dimension, ridge) -> None:
    target = LinearGaussian(dimension, ridge)
    for importance in (False, True):
        draws = drawn("emcee", target, ess=2000, importance=importance)
        assert draws.diagnostics["converged"] and (draws.log_weights is not None) == importance
        hold_against_the_exact_answer(target, draws)


@pytest.mark.parametrize(
    ("dimension", "ridge", "live", "ess"),
    [
        (2, 100.0, 50, 200),
        pytest.param(3, 1.0, 250, 1000, marks=pytest.mark.slow),
        pytest.param(3, 300.0, 250, 1000, marks=pytest.mark.slow),
        pytest.param(5, 300.0, 250, 500, marks=pytest.mark.slow),
    ],
)
def test_nested_sampling_against_the_exact_answer(dimension, ridge, live, ess) -> None:
    pytest.importorskip("dynesty")
    target = LinearGaussian(dimension, ridge)
    draws = drawn("nested", target, ess=ess, live_points=live)
    value, error = draws.log_evidence
    assert error < 0.3
    assert abs(value - target.log_evidence()) < 4.5 * error
    hold_against_the_exact_answer(target, draws)
    assert (
        draws.diagnostics["converged"]
        and draws.effective_number >= draws.diagnostics["ess_bulk"].min() >= ess
    )


def test_nested_sampling_gives_the_same_draws_again_and_stops_when_told_to() -> None:
    pytest.importorskip("dynesty")
    target, told = LinearGaussian(2), []
    options = {"live_points": 20, "max_runs": 2, "ess": 1e5}
    draws = drawn("nested", target, **options)
    name, engine = find_engine("nested")
    again = engine.run(target, options_for(name, engine, seed=1, **options), None, told.append)
    assert_array_equal(draws.samples, again.samples)
    assert_array_equal(draws.log_weights, again.log_weights)
    assert not draws.diagnostics["converged"] and "more live points" in draws.diagnostics["verdict"]
    assert draws.diagnostics["runs"] == 2
    assert told[0].steps == 1 and "ln Z" in told[0].sentence(80)
    steps = [progress.steps for progress in told]
    assert steps == sorted(steps) and steps[-1] == draws.diagnostics["steps"]


@pytest.mark.parametrize("cores", [2, 3])
def test_nested_sampling_gives_the_same_draws_on_any_number_of_cores(cores) -> None:
    """Also where more runs were made at once than are needed."""
    pytest.importorskip("dynesty")
    target, told = LinearGaussian(2), []
    options = {"live_points": 20, "ess": 200}
    alone = drawn("nested", target, **options)
    name, engine = find_engine("nested")
    settings = options_for(name, engine, seed=1, cores=cores, **options)
    shared = engine.run(target, settings, None, told.append)
    assert_array_equal(alone.samples, shared.samples)
    assert_array_equal(alone.log_weights, shared.log_weights)
    assert alone.log_evidence == shared.log_evidence and alone.diagnostics["runs"] % cores
    assert [progress.steps for progress in told][-1] == shared.diagnostics["steps"]


# -- weights ----------------------------------------------------------------------------------------------------------


def test_resampling_takes_as_many_copies_as_the_weight_says() -> None:
    rng = np.random.default_rng(3)
    log_weights = rng.normal(size=5000)
    draws = Draws(np.arange(5000.0)[:, None], log_weights + 700.0)
    equal = draws.equally_weighted(2000, np.random.default_rng(1))
    assert equal.shape == (1, 2000, 1)
    copies = np.bincount(equal.ravel().astype(int), minlength=5000)
    expected = 2000 * np.exp(log_weights) / np.exp(log_weights).sum()
    assert np.all((copies >= np.floor(expected - 1e-9)) & (copies <= np.ceil(expected + 1e-9)))
    assert_array_equal(equal, draws.equally_weighted(2000, np.random.default_rng(1)))
    assert abs(np.corrcoef(equal[0, 1:, 0], equal[0, :-1, 0])[0, 1]) < 0.1  # in random order
    # draws of equal weight stay as they are, or are thinned evenly
    plain = Draws(np.arange(12.0).reshape(2, 6, 1))
    assert_array_equal(plain.equally_weighted(12, rng), plain.samples)
    assert plain.equally_weighted(5, rng)[..., 0].tolist() == [[0.0, 3.0], [6.0, 9.0]]


def test_quantiles_of_weighted_draws() -> None:
    rng = np.random.default_rng(4)
    values = 2.0 * rng.normal(size=200_000)  # wide draws, weighed to a unit Gaussian
    weights = np.exp(-0.5 * values**2 + values**2 / 8)
    assert_allclose(weighted_quantiles(values, weights, SHARES), ndtri(SHARES), atol=0.02)
    assert_allclose(
        weighted_quantiles(values, np.ones(len(values)), SHARES), np.quantile(values, SHARES), atol=1e-3
    )


@pytest.mark.parametrize(
    ("samples", "log_weights", "said"),
    [
        (np.zeros(3), None, "shape"),
        (np.full((3, 1), np.nan), None, "3 numbers are not finite"),
        (np.zeros((3, 1)), np.zeros(2), r"shape \(2,\) found"),
        (np.zeros((3, 1)), np.full(3, -np.inf), "nothing but"),
        (np.zeros((3, 1)), np.array([0.0, np.nan, 0.0]), "NaN"),
    ],
)
def test_draws_that_are_none(samples, log_weights, said) -> None:
    with pytest.raises(InputError, match=said):
        Draws(samples, log_weights)


# -- engines from outside ---------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory):
    return two_parameters(tmp_path_factory.mktemp("model"))


@pytest.fixture(scope="module")
def ensembles(problem):
    return sample(problem, seed=2, ess=2000, walkers=32, importance=False)


@pytest.fixture(scope="module")
def weighted(problem):
    return sample(problem, engine=Importance(), ess=500)


@pytest.mark.parametrize("engine", [Importance(), Plain()])
def test_an_engine_from_outside_finds_the_same_posterior(problem, ensembles, engine) -> None:
    told = []
    fit = sample(problem, engine=engine, ess=400, progress=told.append)
    assert fit.converged and told
    expected, found = ensembles.summary(), fit.summary()
    for label in problem.names:
        spread = (expected.loc[label, "q95"] - expected.loc[label, "q05"]) / 3.3
        size = found.loc[label, "ess_bulk"]
        for key, fraction in (("q05", 0.05), ("median", 0.5), ("q95", 0.95)):
            # density at the ends of a normal 90 % interval 0.1, in the middle 0.4
            error = np.sqrt(fraction * (1 - fraction) * (1 / size + 1 / 2000)) / (
                0.4 if fraction == 0.5 else 0.1
            )
            assert abs(found.loc[label, key] - expected.loc[label, key]) < 4.5 * error * spread, (label, key)
    run = fit.provenance["sampling"]
    assert run["engine"] == type(engine).__name__ and "emcee" not in fit.provenance["versions"]
    assert ("r_hat" in found) == ("r_hat" in run) == isinstance(engine, Plain) or type(engine) is Importance
    if type(engine) is Importance:
        assert "r_hat" not in found and run["colour"] == "green"


def test_everything_of_a_weighted_fit_agrees_with_its_weights(problem, weighted, tmp_path) -> None:
    kept = weighted.groups["weighted_posterior"]
    theta = kept["theta"].values.reshape(-1, 2)
    weights = np.exp(kept["log_weight"].values.ravel())
    weights /= weights.sum()
    assert weighted.theta().shape == (10_000, 2)
    summary = weighted.summary()
    for i, label in enumerate(weighted.names):
        # by another way: the fraction of the weight below what is quoted
        for key, fraction in (("q05", 0.05), ("median", 0.5), ("q95", 0.95)):
            assert weights[theta[:, i] <= summary.loc[label, key]].sum() == pytest.approx(
                fraction, abs=2 * weights.max()
            )
            below = (weighted.draws(label) <= summary.loc[label, key]).mean()
            assert below == pytest.approx(fraction, abs=0.01)
        mean, sd = weights @ theta[:, i], np.sqrt(weights @ (theta[:, i] - weights @ theta[:, i]) ** 2)
        assert abs(weighted.draws(label).mean() - mean) < 0.02 * sd
    size = 1.0 / np.sum(weights**2)
    assert summary["ess_bulk"].tolist() == pytest.approx([size, size])
    # predictions and densities are those of the resampled draws
    some = weighted.theta()[::500]
    pointwise = weighted.groups["log_likelihood"]["friction_coefficient"].values.reshape(10_000, -1)
    assert_allclose(pointwise[::500], problem.log_likelihood(some, pointwise=True), rtol=1e-10, atol=1e-10)
    lp = weighted.groups["sample_stats"]["lp"].values.ravel()[::500]
    assert_allclose(lp, problem.target().log_density(problem.target().transform.forward(some)), rtol=1e-9)
    # cross-validation of draws with copies is that of the weights: p(y_i | others) = Σw / Σ(w / p_i)
    from skinbayes.comparison.scores import score

    likely = (
        weights > 1e-6 * weights.max()
    )  # the rest makes the mean of 1/p one of a few draws, which PSIS smooths
    density = problem.log_likelihood(theta[likely], pointwise=True)
    expected = np.log(weights[likely].sum()) - np.log(weights[likely] @ np.exp(-density))
    assert_allclose(score(weighted).single.pointwise, expected, atol=0.05)
    # and a file keeps all of it
    again = load_fit(weighted.save(tmp_path / "run.nc"))
    same_draws(weighted, again)
    assert again.summary().equals(summary) and again.provenance == weighted.provenance


def test_what_an_engine_has_not_is_not_shown(weighted, ensembles) -> None:
    from skinbayes.cli.fit_output import _convergence
    from skinbayes.report.page import render

    page, other = render(weighted), render(ensembles)
    for word in ("R-hat", "walkers", "autocorrelation", "ensemble", "emcee"):
        assert word not in page.replace("relative_contact_area", ""), word
    for word in ("R-hat", "walkers", "ensembles", "emcee"):
        assert word in other
    assert "Colour" in page and "green" in page and "Importance" in page
    assert list(_convergence(weighted)) == ["ESS"] and list(_convergence(ensembles)) == ["ESS", "R-hat"]


def test_names_of_engines(problem) -> None:
    register_engine("by-weight", engine := Importance())
    try:
        assert find_engine("by-weight") == ("by-weight", engine) == find_engine(engine)
        register_engine("by-weight", engine)
        with pytest.raises(InputError, match="one of this name already"):
            register_engine("by-weight", Importance())
        with pytest.raises(InputError, match="did you mean 'by-weight'"):
            sample(problem, engine="byweight")
    finally:
        del ENGINES["by-weight"]
    with pytest.raises(InputError, match="expected letters, digits"):
        register_engine("by weight", engine)
    for wrong in (object(), Importance):
        with pytest.raises(InputError, match="an object with run"):
            sample(problem, engine=wrong)
    with pytest.raises(InputError, match="no option 'walkers'; expected some of seed, ess, cores"):
        sample(problem, engine=engine, walkers=16)
    assert options_for("mine", engine, seed=3) == EngineOptions(3)


def test_without_dynesty_the_message_says_what_to_install(problem, monkeypatch, tmp_path) -> None:
    monkeypatch.setattr("skinbayes.sampling.nested_engine.find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"pip install 'skinbayes\[nested\]'"):
        sample(problem, engine="nested", directory=tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_options_of_nested_sampling_are_looked_at(problem) -> None:
    pytest.importorskip("dynesty")
    for option, value in (("live_points", 3), ("max_runs", 0), ("cores", 0)):
        with pytest.raises(InputError, match=f"sampler option {option}: {value} found"):
            sample(problem, engine="nested", **{option: value})


# -- run directories --------------------------------------------------------------------------------------------------


def test_a_run_belongs_to_its_engine(problem, tmp_path) -> None:
    first = sample(problem, engine=Importance(), directory=tmp_path / "run")
    assert not (tmp_path / "run" / "steps").exists()
    same_draws(first, load_fit(tmp_path / "run"))
    with pytest.raises(FingerprintMismatch, match="engine 'Importance', not 'emcee'"):
        sample(problem, directory=tmp_path / "run", resume=True, **SMALL)
    same_draws(first, sample(problem, engine=Importance(), directory=tmp_path / "run", resume=True))


def test_files_of_another_version_are_refused_in_words(problem, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("skinbayes.fit.manifest.FORMAT", "skinbayes run 1")
    monkeypatch.setattr("skinbayes.fit.assemble.FORMAT", 1)
    fit = sample(problem, directory=tmp_path / "run", **SMALL)
    alone = fit.save(tmp_path / "alone.nc")
    monkeypatch.undo()
    said = "written by another version of skinbayes.*'skinbayes run 1' found, 'skinbayes run 2' expected"
    with pytest.raises(InputError, match=said):
        load_fit(tmp_path / "run")
    with pytest.raises(InputError, match=said):
        sample(problem, directory=tmp_path / "run", resume=True, **SMALL)
    with pytest.raises(InputError, match="format 1 found, 2 expected"):
        load_fit(alone)
