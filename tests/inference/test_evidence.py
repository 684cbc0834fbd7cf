"""The evidence of a model of data: against quadrature over the priors, and what a comparison says of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import logsumexp
from small_models import student, three_parameters, two_parameters

from skinbayes.comparison import compare
from skinbayes.comparison.models import compare_scores
from skinbayes.comparison.scores import score
from skinbayes.fit import sample
from skinbayes.problem.other_priors import priors_of, with_priors
from skinbayes.statistics.widening import widened


@pytest.fixture(scope="module")
def problems(tmp_path_factory):
    folder = tmp_path_factory.mktemp("models")
    return {"two": two_parameters(folder), "three": three_parameters(folder), "student": student(folder)}


@pytest.fixture(scope="module")
def fits(problems):
    return {name: sample(problem, seed=2, importance=True) for name, problem in problems.items()}


@pytest.mark.parametrize(("name", "nodes"), [("two", 400), ("three", 120)])
def test_evidence_is_the_mean_likelihood_under_the_prior(problems, fits, name, nodes):
    problem = problems[name]
    # midpoints of equal cells of the unit cube, which the prior maps to equal masses
    line = (np.arange(nodes) + 0.5) / nodes
    cube = np.stack(np.meshgrid(*[line] * problem.dimension, indexing="ij"), axis=-1)
    parts = []
    for slab in cube.reshape(nodes, -1, problem.dimension):
        found = problem.log_likelihood(problem.prior_transform(slab))
        parts.append(logsumexp(found))
    expected = logsumexp(parts) - problem.dimension * np.log(nodes)
    value, error = fits[name].provenance["sampling"]["log_evidence"]
    assert error < 0.03
    assert abs(value - expected) < max(3 * error, 0.01)


def test_the_page_says_how_the_draws_were_made(fits):
    from skinbayes.report.quality import convergence

    said = " ".join(convergence(fits["two"]))
    assert "independent draws by importance sampling" in said and "ln of the evidence is" in said
    assert "R-hat" not in said and "tried and given up" not in said


def test_a_comparison_shows_evidence_where_all_models_have_it(fits):
    found = compare([fits["two"], fits["student"]], refit=False)
    assert found.has_evidence
    probabilities = {model.name: model.probability for model in found.models}
    assert sum(probabilities.values()) == pytest.approx(1.0)
    values = [fit.provenance["sampling"]["log_evidence"][0] for fit in (fits["two"], fits["student"])]
    odds = probabilities[fits["two"].name] / probabilities[fits["student"].name]
    assert np.log(odds) == pytest.approx(values[0] - values[1])
    assert any(sentence.startswith("Evidence: ") for sentence in found.sentences())
    assert found.to_dict()["models"][0]["log_evidence"] in values


def test_without_the_evidence_of_one_model_there_is_none(fits):
    scores = [score(fits["two"]), replace(score(fits["student"]), log_evidence=None)]
    found = compare_scores(scores)
    assert not found.has_evidence and found.models[0].probability is None
    assert not any("vidence" in sentence for sentence in found.sentences())


def test_evidence_and_predictive_density_may_disagree(fits):
    first, second = score(fits["two"]), score(fits["student"])
    better, worse = (first, second) if first.single.elpd > second.single.elpd else (second, first)
    found = compare_scores(
        [replace(better, log_evidence=(0.0, 0.1)), replace(worse, log_evidence=(5.0, 0.1))]
    )
    said = " ".join(found.sentences())
    assert f"'{worse.name}' made the data exp(5.00 ± 0.14) times as probable" in said
    assert f"predicted best by '{better.name}' instead" in said


def test_the_density_kept_is_that_of_the_draws_kept(fits):
    fit = fits["two"]
    theta = fit.theta()
    target = fit.problem.target()
    expected = target.log_density(target.transform.forward(theta))
    np.testing.assert_allclose(fit.groups["sample_stats"]["lp"].values.ravel(), expected, atol=1e-9)


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_evidence_under_other_priors_is_the_mean_likelihood_under_them(problems, fits, factor):
    def log_mean(problem, nodes=300):
        line = (np.arange(nodes) + 0.5) / nodes
        cube = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
        return logsumexp(problem.log_likelihood(problem.prior_transform(cube))) - 2 * np.log(nodes)

    other = with_priors(problems["two"], [widened(prior, factor) for prior in priors_of(problems["two"])])
    found = fits["two"].prior_sensitivity().of(problems["two"].names, factor)
    expected = log_mean(other) - log_mean(problems["two"])
    assert found.reliable and abs(found.log_evidence_change - expected) < 4 * found.error + 0.005
