"""Importance sampling after exploration, and the evidence: against densities whose integrals and quantiles are known."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import multivariate_normal, multivariate_t, norm
from scipy.stats import t as student

from skinbayes.sampling.draws import Draws, weighted_quantiles
from skinbayes.sampling.ensemble_engine import EnsembleEngine
from skinbayes.sampling.evidence import bridge
from skinbayes.sampling.importance import Refusal, importance_draws
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.store import SampleStore
from skinbayes.sampling.weighted_draws import ImportanceDraws, _effective
from skinbayes.statistics.student_mixture import StudentMixture, fit_mixture

LEVELS = np.array([0.05, 0.5, 0.95])


@dataclasses.dataclass(frozen=True)
class Known:
    """A density, and how wide its starts lie."""

    function: Callable[[np.ndarray], np.ndarray]
    dimension: int
    spread: float = 2.0
    fingerprint: str = "known"

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(f"x{i}" for i in range(self.dimension))

    def log_density(self, position):
        return self.function(position)

    def starts(self, rng, count):
        return self.spread * rng.normal(size=(count, self.dimension))

    def prior_transform(self, unit):
        return self.spread * norm.ppf(unit)

    def integrated_out(self, position, rng):
        return {}


def normal(position):
    """Correlated, with an integral of e²; independent of the number of rows."""
    dimension = position.shape[1]
    first = position[:, :1]
    rest = (position[:, 1:] - 0.8 * first) / 0.6
    return norm.logpdf(np.hstack([first, rest])).sum(axis=1) - (dimension - 1) * np.log(0.6) + 2.0


def two_modes(position):
    parts = [
        np.log(part) + norm.logpdf(position - np.r_[place, 0.0, 0.0]).sum(axis=1)
        for part, place in ((0.25, -3.0), (0.75, 3.0))
    ]
    return np.logaddexp(*parts) + 1.0


def box(position):
    inside = (np.abs(position) < 1.0).all(axis=1)
    return np.where(inside, 0.0, -np.inf)


def heavy(position):
    return multivariate_t(np.zeros(3), np.eye(3), df=5).logpdf(position)


def ridge(position):
    """A ridge 10,000 times longer than wide."""
    along, across = (
        (position[:, 0] + position[:, 1]) / np.sqrt(2),
        (position[:, 0] - position[:, 1]) / np.sqrt(2),
    )
    return norm.logpdf(along, scale=100.0) + norm.logpdf(across, scale=0.01) + norm.logpdf(position[:, 2])


def below_of_two_modes(levels):
    grid = np.linspace(-8.0, 8.0, 4001)
    return np.interp(levels, 0.25 * norm.cdf(grid, -3.0) + 0.75 * norm.cdf(grid, 3.0), grid)


def run(target, seed=1, **options) -> Draws:
    return EnsembleEngine().run(
        target, SamplerOptions(seed=seed, importance=True, **{"ess": 1000, **options})
    )


def test_density_and_draws_of_a_mixture_belong_together():
    mixture = StudentMixture(
        np.array([0.3, 0.7]), np.array([[0.0, 1.0], [2.0, -1.0]]),
        np.array([[[1.0, 0.0], [0.5, 0.2]], [[0.3, 0.0], [0.0, 2.0]]]), np.array([5.0, 8.0]),
    )  # fmt: skip
    reference = [multivariate_t(m, L @ L.T, df=nu) for m, L, nu in
                 zip(mixture.means, mixture.factors, mixture.degrees_of_freedom, strict=True)]  # fmt: skip
    x = mixture.draw(20_000, np.random.default_rng(1))
    parts = [np.log(part) + one.logpdf(x) for part, one in zip(mixture.weights, reference, strict=True)]
    np.testing.assert_allclose(mixture.log_density(x), np.logaddexp(*parts), rtol=1e-10)
    # the mean of 1/density over its own draws, inside a square, is the area of the square
    inside = (np.abs(x) < 1.0).all(axis=1)
    ratios = np.where(inside, np.exp(-mixture.log_density(x)), 0.0)
    assert abs(ratios.mean() - 4.0) < 4 * ratios.std() / np.sqrt(len(x))
    # and a fit to its draws is about as likely as itself
    fitted = fit_mixture(x[:3000], x[3000:6000], np.random.default_rng(3))
    assert fitted.log_density(x[6000:]).mean() > mixture.log_density(x[6000:]).mean() - 0.02


def test_a_mixture_fitted_to_weighted_points_is_that_of_what_they_weigh():
    """Draws of a wide distribution with the weights of two narrow ones, which as points alone they do not show."""
    rng = np.random.default_rng(5)
    x = 4.0 * rng.normal(size=(8000, 2))

    def two(points):
        return np.logaddexp(*(np.log(0.5) + norm.logpdf(points - m).sum(axis=1) for m in (-4.0, 4.0)))

    weights = np.exp(two(x) - norm.logpdf(x, scale=4.0).sum(axis=1))
    fitted = fit_mixture(x[:4000], x[4000:], rng, weights=(weights[:4000], weights[4000:]))
    assert fitted.weights.size >= 2
    points = np.concatenate([rng.normal(size=(2000, 2)) + m for m in (-4.0, 4.0)])
    lost = (two(points) - fitted.log_density(points)).mean()
    assert -0.01 < lost < 0.05
    # one that is known and better than what is found from anywhere stays
    single = fit_mixture(x[:4000], x[4000:], rng, 1, (weights[:4000], weights[4000:]))
    kept = fit_mixture(x[:4000], x[4000:], rng, 1, (weights[:4000], weights[4000:]), fitted)
    assert single.weights.size == 1 and kept.weights.size == fitted.weights.size


@pytest.mark.parametrize("kind", ["thin", "one point", "a constant coordinate", "far points", "one weight"])
def test_a_mixture_of_points_too_thin_for_double_precision_is_one_all_the_same(kind):
    """Ten thousand rows leave ridges that are thinner against their length than a covariance can hold."""
    rng = np.random.default_rng(7)
    for _ in range(40):
        dimension, count = int(rng.integers(1, 8)), int(rng.integers(3, 400))
        stretched = np.linalg.qr(rng.normal(size=(dimension, dimension)))[0] * 10 ** rng.uniform(
            -12, 3, dimension
        )
        x = rng.normal(size=(count, dimension)) @ stretched.T + 10 ** rng.uniform(-3, 6) * rng.normal(
            size=dimension
        )
        weights = np.exp(10 ** rng.uniform(-2, 2) * rng.normal(size=count))
        if kind == "one point":
            x[:] = x[0]
        elif kind == "a constant coordinate":
            x[:, 0] = 3.0
        elif kind == "far points":
            x[:3] += 1e8
        elif kind == "one weight":
            weights = np.full(count, 1e-320)
            weights[0] = 1.0
        halves = (weights[::2], weights[1::2])
        mixture = fit_mixture(x[::2], x[1::2], rng, weights=halves).with_wide_component(0.1, 3.0)
        assert np.isfinite(mixture.draw(100, rng)).all()
        assert not np.isnan(mixture.log_density(x)).any()


@pytest.mark.parametrize(("target", "log_evidence", "quantiles"), [
    (Known(normal, 2), 2.0, norm.ppf(LEVELS)),
    (Known(normal, 8), 2.0, norm.ppf(LEVELS)),
    (Known(two_modes, 3, 4.0), 1.0, below_of_two_modes(LEVELS)),
    (Known(box, 4, 0.15), 4 * np.log(2.0), 2 * LEVELS - 1),
    (Known(heavy, 3), 0.0, student.ppf(LEVELS, 5)),
    (Known(ridge, 3, 30.0), 0.0, norm.ppf(LEVELS) * np.sqrt((100.0**2 + 0.01**2) / 2)),
], ids=["normal 2", "normal 8", "two modes", "box", "heavy tails", "ridge"])  # fmt: skip
def test_known_densities(target, log_evidence, quantiles):
    found = run(target)
    assert found.diagnostics["converged"] and found.diagnostics["pareto_k"] <= 0.5
    value, error = found.log_evidence
    assert abs(value - log_evidence) < 4 * error and error < 0.03
    weights = np.exp(found.log_weights[0] - found.log_weights.max())
    below = [weights[found.samples[0, :, 0] <= place].sum() / weights.sum() for place in quantiles]
    error = np.sqrt(LEVELS * (1 - LEVELS) / found.diagnostics["ess_tail"][0])
    assert np.all(np.abs(below - LEVELS) < 4 * error)
    assert found.diagnostics["ess_bulk"].min() >= 1000
    # a few evaluations for an effective draw, where walkers need tens
    assert found.diagnostics["evaluations"] < 20 * found.diagnostics["ess_bulk"].min()


def test_one_seed_gives_the_same_draws_with_any_number_of_workers_and_when_resumed(tmp_path: Path):
    target = Known(normal, 4)
    whole = run(target, seed=5, walkers=16)
    shared = run(target, seed=5, walkers=16, cores=2)
    np.testing.assert_array_equal(whole.samples, shared.samples)
    options = SamplerOptions(seed=5, importance=True, ess=1000, walkers=16)

    def stop(progress):
        if progress.steps >= 25:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        EnsembleEngine().run(target, options, SampleStore(tmp_path / "steps"), stop)
    resumed = EnsembleEngine().run(target, options, SampleStore(tmp_path / "steps", resume=True))
    np.testing.assert_array_equal(whole.samples, resumed.samples)
    np.testing.assert_array_equal(whole.log_weights, resumed.log_weights)
    assert whole.log_evidence == resumed.log_evidence


def test_a_run_resumed_after_refused_draws_tries_when_it_would_have(tmp_path: Path, monkeypatch):
    """A refusal that cost much puts the next attempt off; a resumed run knows of it, and counts what it cost."""
    from skinbayes.sampling import finish

    def at_first_refused(chains, *arguments):
        fresh = chains.shape[1] < 16 * 25  # the later half of the first 25 steps
        return Refusal("too uneven", 10_000) if fresh else importance_draws(chains, *arguments)

    monkeypatch.setattr(finish, "importance_draws", at_first_refused)
    target = Known(normal, 4)
    options = SamplerOptions(seed=5, ess=1000, walkers=16)
    whole = EnsembleEngine().run(target, options)
    assert whole.diagnostics["steps"] == 75
    assert whole.diagnostics["evaluations"] > 10_000 + whole.log_weights.size

    def stop(progress):
        if progress.steps >= 50:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        EnsembleEngine().run(target, options, SampleStore(tmp_path / "steps"), stop)
    resumed = EnsembleEngine().run(target, options, SampleStore(tmp_path / "steps", resume=True))
    np.testing.assert_array_equal(whole.samples, resumed.samples)
    assert whole.diagnostics["evaluations"] == resumed.diagnostics["evaluations"]


def test_draws_that_wait_for_ensembles_are_the_same_when_resumed(tmp_path: Path, monkeypatch):
    from skinbayes.sampling import importance

    def lagging(found, explored, *others):
        return "they lag behind" if explored.shape[1] < 16 * 25 else behind(found, explored, *others)

    behind = importance._behind
    monkeypatch.setattr(importance, "_behind", lagging)
    target, options = Known(normal, 4), SamplerOptions(seed=5, ess=1000, walkers=16)
    whole = EnsembleEngine().run(target, options)
    assert whole.diagnostics["steps"] == 50

    def stop(progress):
        if progress.steps >= 25:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        EnsembleEngine().run(target, options, SampleStore(tmp_path / "steps"), stop)
    resumed = EnsembleEngine().run(target, options, SampleStore(tmp_path / "steps", resume=True))
    np.testing.assert_array_equal(whole.samples, resumed.samples)
    assert whole.diagnostics["evaluations"] == resumed.diagnostics["evaluations"]


def explored(rng, places, count=1500):
    """Independent draws of normal distributions about places, one ensemble each."""
    return np.array([place + rng.normal(size=(count, 2)) for place in places])


def test_a_proposal_that_misses_what_an_ensemble_found_is_refused():
    def density(x):
        far = norm.logpdf(x - 40.0).sum(axis=1)
        return np.logaddexp(norm.logpdf(x).sum(axis=1), far)

    rng = np.random.default_rng(1)
    chains = explored(rng, [0.0, 0.0, 0.0, 40.0])
    log_density = np.array([density(chain) for chain in chains])
    found = importance_draws(chains, log_density, density, 500, rng)
    if isinstance(found, ImportanceDraws):  # found both: then with their weights
        weights = np.exp(found.log_weights)
        assert weights[found.positions[:, 0] > 20].sum() / weights.sum() == pytest.approx(0.5, abs=0.05)
    else:
        assert found[0]


def test_weights_without_a_variance_are_refused():
    # the tails of the target are those of a Cauchy distribution, which no proposal here reaches
    def density(x):
        return -np.log1p(np.square(x)).sum(axis=1)

    rng = np.random.default_rng(1)
    chains = rng.standard_cauchy(size=(4, 2000, 3))
    found = importance_draws(chains, np.array([density(chain) for chain in chains]), density, 500, rng)
    assert isinstance(found, tuple) and found[0]


def test_disagreeing_quantiles_are_refused():
    # what was explored is too narrow by a third, whatever the weights say
    rng = np.random.default_rng(4)
    chains = 0.67 * rng.normal(size=(4, 1500, 2))

    def density(x):
        return norm.logpdf(x).sum(axis=1)

    found = importance_draws(chains, np.array([density(chain) for chain in chains]), density, 500, rng)
    assert isinstance(found, tuple) and "quantile" in found[0]


def test_where_it_is_refused_walkers_go_on():
    def funnel(x):
        return norm.logpdf(x[:, 0], scale=3.0) + norm.logpdf(x[:, 1:], scale=np.exp(x[:, :1] / 2)).sum(axis=1)

    found = run(Known(funnel, 4), max_steps=150)
    assert found.log_weights is None and not found.diagnostics["converged"]


def test_bridge_sampling_has_the_error_it_states():
    ratios = []
    for seed in range(200):
        rng = np.random.default_rng(seed)
        target, proposal = (
            multivariate_normal(np.zeros(3)),
            multivariate_t(np.zeros(3), 1.3 * np.eye(3), df=8),
        )
        draws = rng.normal(size=(4, 250, 3))
        others = proposal.rvs(1000, random_state=rng)
        found = bridge(
            target.logpdf(draws) - proposal.logpdf(draws),
            target.logpdf(others) - proposal.logpdf(others),
            1000,
        )
        ratios.append((found.value / found.error, found.plain / found.plain_error))
    assert np.all(np.abs(np.mean(ratios, axis=0)) < 0.25)
    assert np.all((np.std(ratios, axis=0) > 0.75) & (np.std(ratios, axis=0) < 1.15))


def test_one_point_with_all_the_weight_teaches_no_matrix() -> None:
    """As where the posterior is so narrow that one of the first draws lies in it."""
    mixture = StudentMixture(np.ones(1), np.zeros((1, 3)), np.eye(3)[np.newaxis], np.full(1, 5.0))
    x = np.random.default_rng(1).normal(size=(200, 3))
    weights = np.zeros(200)
    weights[0] = 1.0
    found = mixture.refitted(x, weights)
    assert np.isfinite(found.log_density(x)).all()
    assert (np.linalg.det(found.factors) > 0).all()


@pytest.mark.slow
def test_evidence_of_normal_distributions_in_up_to_twenty_dimensions():
    near, within = [], []
    for seed in range(100):
        dimension = 2 + seed % 19
        value, error = run(Known(normal, dimension), seed=seed, ess=2000).log_evidence
        near.append(abs(value - 2.0) < 0.02)
        within.append(abs(value - 2.0) < 3 * error)
    print(f"ln Z of 100 densities: {sum(near)} within 0.02, {sum(within)} within three standard errors")
    assert sum(near) >= 95 and sum(within) >= 95


def test_weighted_quantiles_of_the_draws_are_those_of_the_density():
    found = run(Known(normal, 3), seed=2, ess=4000)
    weights = np.exp(found.log_weights[0])
    np.testing.assert_allclose(
        weighted_quantiles(found.samples[0, :, 0], weights, LEVELS), norm.ppf(LEVELS), atol=0.1
    )


def test_weights_that_rest_on_one_draw_are_one_draw() -> None:
    """Squares of the other weights underflow; the ratio of variances was reached with a RuntimeWarning, and was infinite."""
    weights = np.array([1.0, 1e-200, 1e-190])
    tail = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    assert _effective(tail, weights).tolist() == [1.0, 1.0]
    plain = np.ones(4)
    assert _effective(np.array([[0.0], [0.0], [1.0], [1.0]]), plain) == pytest.approx([4.0])
