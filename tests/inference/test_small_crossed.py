"""Few people at few sites: the ridge between levels of a parameter and effects of a group is sampled, tails included."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from small_crossed import Crossed, by_regression

from skinbayes.fit import sample
from skinbayes.report.sentences import open_ends
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.options import SamplerOptions

SITE_AND_PERSON = {"person": "half_normal = 0.5", "body_site": "half_normal = 0.5"}
DESIGNS = {
    "2x3": Crossed(2, 3),
    "2x2": Crossed(2, 2),
    "3x2": Crossed(3, 2),
    "4x2": Crossed(4, 2),
    "2x6": Crossed(2, 6),
    "1x5, effects of sites": Crossed(1, 5, by=None, groups={"body_site": "half_normal = 0.5"}),
    "2x3, wide scale": Crossed(2, 3, groups={"person": "half_normal = 0.9"}),
    "2x3, flat scale": Crossed(2, 3, groups={"person": "uniform = [0, 3]"}),
    "2x3, lognormal scale": Crossed(2, 3, groups={"person": "lognormal = [0.3, 0.7]"}),
    "2x3, two groups": Crossed(2, 3, by=None, groups=SITE_AND_PERSON),
    "2x3, levels and two groups": Crossed(2, 3, groups=SITE_AND_PERSON),
    "2x3, by person and effects of people": Crossed(2, 3, by="person"),
    "2x3, uniform": Crossed(2, 3, stress='uniform = ["0.5 MPa", "500 MPa"]'),
    "2x3, little scatter": Crossed(2, 3, noise=0.01),
}

ADDED = {
    "2x3": Crossed(2, 3, family="gaussian"),
    "2x2": Crossed(2, 2, family="gaussian"),
    "3x3": Crossed(3, 3, family="gaussian"),
    "1x5, effects of sites": Crossed(
        1, 5, by=None, groups={"body_site": "half_normal = 0.5"}, family="gaussian"
    ),
    "2x3, levels and two groups": Crossed(2, 3, groups=SITE_AND_PERSON, family="gaussian"),
    "2x3, uniform": Crossed(2, 3, stress='uniform = ["0.5 MPa", "500 MPa"]', family="gaussian"),
}


def assert_agrees(fit, exact) -> None:
    """Probabilities below the 5, 50 and 95 % quantiles of the fit, by the exact weights, within five standard errors."""
    for i, name in enumerate(fit.provenance["names"]):
        values = fit.draws(name)
        size = fit.provenance["sampling"]["ess_tail"][i]
        for level in (0.05, 0.5, 0.95):
            below = exact.draws[:, i] < np.quantile(values, level)
            found = exact.weights @ below
            # the weights of a tail are few and uneven: their own error counts
            variance = np.square(exact.weights * (below - found)).sum() + level * (1.0 - level) / size
            assert found == pytest.approx(level, abs=5.0 * np.sqrt(variance)), name


def test_two_people_at_two_sites_within_a_budget(tmp_path) -> None:
    problem = Crossed(2, 2, loads=(200, 1000)).problem(tmp_path, seed=3)
    fit = sample(problem, seed=3, max_steps=1000)
    assert fit.converged
    assert fit.provenance["sampling"]["evaluations"] <= 512 * 1001
    exact = by_regression(problem, np.random.default_rng(8), 10_000)
    assert exact.effective_size > 500
    assert_agrees(fit, exact)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("design", DESIGNS)
def test_small_designs_converge_to_the_exact_posterior(design, seed, tmp_path) -> None:
    problem = DESIGNS[design].problem(tmp_path, seed)
    fit = sample(problem, seed=seed, max_steps=3000)
    print(design, seed, fit.provenance["sampling"]["verdict"])
    assert fit.converged
    # a prior flat in the shear stress prefers wide effects, of which the prior draws hold few
    exact = by_regression(
        problem, np.random.default_rng(seed), 160_000 if design == "2x3, uniform" else 40_000
    )
    assert exact.effective_size > 1000
    assert_agrees(fit, exact)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("design", ADDED)
def test_effects_that_are_added_converge_to_the_exact_posterior(design, seed, tmp_path) -> None:
    problem = ADDED[design].problem(tmp_path, seed)
    fit = sample(problem, seed=seed, max_steps=2000)
    print(design, seed, fit.provenance["sampling"]["verdict"])
    assert fit.converged
    exact = by_regression(problem, np.random.default_rng(seed), 160_000)
    assert exact.effective_size > 500
    assert_agrees(fit, exact)


def test_the_density_ends_at_the_walls_and_is_the_posterior_between_them(tmp_path) -> None:
    problem = Crossed(2, 2).problem(tmp_path, seed=1)
    target = problem.target()
    theta = problem.draw_prior(np.random.default_rng(1), 50)
    place = target.transform.forward(theta)
    jacobian = np.log(theta).sum(axis=1)
    np.testing.assert_allclose(target.log_density(place), problem.log_posterior(theta) + jacobian, rtol=1e-9)
    first = problem.names.index("frictional_shear_stress[volar forearm]")
    for wall in (0.499e6, 501e6):
        beyond = place.copy()
        beyond[:, first] = np.log(wall)
        assert (target.log_density(beyond) == -np.inf).all()
    # a factor common to all levels is one shift, wherever it is applied
    shifted = theta.copy()
    shifted[:, first : first + 2] *= 1.5
    assert np.ptp((target.transform.forward(shifted) - place)[:, first : first + 2]) < 1e-12


def test_other_coordinates_are_another_run(tmp_path) -> None:
    grouped = Crossed(2, 2).problem(tmp_path, seed=1)
    assert grouped.target().fingerprint == grouped.fingerprint + "-walls"
    positive = Crossed(2, 2, stress='lognormal = ["15 MPa", 1.0]').problem(tmp_path, seed=1)
    assert positive.target().fingerprint == positive.fingerprint


def test_a_short_run_says_what_it_lacks_and_what_to_do(tmp_path) -> None:
    told = []
    problem = Crossed(2, 2, loads=(200,)).problem(tmp_path, seed=1)
    fit = sample(problem, seed=1, max_steps=200, progress=told.append, importance=False)
    verdict = fit.provenance["sampling"]["verdict"]
    assert not fit.converged
    assert "Cause: " in verdict and "What to do: " in verdict and "--resume --max-steps" in verdict
    assert any(name in verdict for name in problem.names)
    assert told[0].phase == "starting"
    assert told[-1].report is not None and told[-1].phase in ("settling", "collecting")
    for progress in told:
        assert "effective sample size 0" not in progress.sentence()
        assert len(progress.sentence(60)) <= 60


def test_progress_of_a_run_that_needs_more_draws_tells_the_time_to_go() -> None:
    from sampling_targets import UnitGaussian

    told = []
    run_ensembles(
        UnitGaussian(2),
        SamplerOptions(importance=False, seed=1, ess=60_000, max_steps=2000),
        progress=told.append,
    )
    collecting = [p for p in told if p.phase == "collecting"]
    assert collecting and told[-1].phase == "done"
    for progress in collecting:
        assert progress.sentence().startswith("found; effective sample size ")
        assert progress.seconds_to_go is not None
        assert progress.steps_needed == pytest.approx(told[-1].steps, rel=0.5)


def assert_keeps_the_density(target, place) -> None:
    """One row or many to the last bit, and the Jacobian by differences."""
    assert np.array_equal(target.log_density(place), [target.log_density(row[None])[0] for row in place])
    step = 1e-6
    for row, claimed in zip(place, target.transform.log_jacobian(place), strict=True):
        moves = step * np.eye(len(row))
        up, down = target.transform.inverse(row + moves), target.transform.inverse(row - moves)
        assert claimed == pytest.approx(np.linalg.slogdet((up - down) / (2 * step))[1], abs=1e-6)


@pytest.mark.parametrize("groups", [{"person": "half_normal = 0.5"}, SITE_AND_PERSON])
def test_levels_that_effects_are_added_to_are_what_they_predict(groups, tmp_path) -> None:
    problem = Crossed(2, 3, groups=groups, family="gaussian").problem(tmp_path, seed=2)
    target = problem.target()
    levels, width = list(target.transform.added.levels), target.transform.added.width
    assert len(target.transform.funnels) == len(groups) - 1
    theta = problem.draw_prior(np.random.default_rng(3), 20)
    theta[:, levels] = np.minimum(theta[:, levels], 100e6)  # differences of steeper ones are coarse
    place = target.transform.forward(theta)
    np.testing.assert_allclose(target.transform.inverse(place), theta, rtol=1e-9)
    assert_keeps_the_density(target, place)
    # an amount that effects take from all data is one shift of all levels, however the skin deforms
    stress, hardness = np.array([[10e6], [20e6], [30e6]]), problem.names.index("yield_stress")
    moved = np.tile(problem.prior_medians(), (3, 1))
    moved[:, levels] = stress + np.array([0.0, 5e6, 10e6])
    moved[:, hardness] *= [1.0, 1.2, 0.8]
    moved[:, levels] *= moved[:, [hardness]] / moved[0, hardness]
    predicted = problem.predict(moved)["friction_coefficient"].reshape(3, 2, 3, -1)[:, 0, :, 0]
    coordinates = target.transform.forward(moved)[:, levels] - width * np.log(predicted)
    if len(groups) == 1:
        np.testing.assert_allclose(coordinates, predicted, rtol=1e-3)


def test_a_level_that_effects_stand_for_is_named(tmp_path) -> None:
    problem = Crossed(2, 3, family="gaussian").problem(tmp_path, seed=1)
    rng = np.random.default_rng(1)
    prior = problem.draw_prior(rng, 4000)
    bounded = prior.copy()
    levels = [i for i, name in enumerate(problem.names) if name.startswith("frictional")]
    bounded[:, levels] = 20e6 * np.exp(0.5 * rng.normal(size=(4000, 3)))

    def said(posterior):
        fit = SimpleNamespace(
            problem=problem,
            names=problem.names,
            shown_names=problem.names,
            theta=lambda which="posterior": prior if which == "prior" else posterior,
            draws=lambda label: posterior[:, problem.names.index(label)],
            symbol=lambda label: label,
            unit=lambda label: "Pa",
        )
        return open_ends(fit)

    assert said(bounded) == []
    # by importance sampling a tenth of the posterior is as flat as this, where both people have a large effect
    drawn = bounded.copy()
    drawn[:400, problem.names.index("frictional_shear_stress[dorsal forearm]")] = 0.5e6 * np.exp(
        rng.uniform(0, 1, 400)
    )
    (sentence,) = said(drawn)
    assert "dorsal forearm" in sentence and "effects of person" in sentence
    assert "tighter prior on the scale of the groups of person" in sentence


def test_straightened_funnels_keep_the_density(tmp_path) -> None:
    problem = Crossed(2, 3, groups=SITE_AND_PERSON).problem(tmp_path, seed=2)
    target = problem.target()
    (funnel,) = target.transform.funnels
    assert [problem.names[i] for i in funnel.levels] == [
        n for n in problem.names if n.startswith("frictional")
    ]
    assert problem.names[funnel.scale] == "group_scale[body_site]"
    theta = problem.draw_prior(np.random.default_rng(3), 20)
    place = target.transform.forward(theta)
    np.testing.assert_allclose(target.transform.inverse(place), theta, rtol=1e-10)
    assert_keeps_the_density(target, place)
    # the deviations are as wide in the neck as in the mouth
    levels = list(funnel.levels)
    for scale in (1e-3, 0.03, 0.5):
        narrow = place.copy()
        narrow[:, funnel.scale] = np.log(scale)
        deviations = np.log(target.transform.inverse(narrow)[:, levels])
        deviations -= deviations.mean(axis=1, keepdims=True) + np.array(funnel.centre)
        coordinates = place[:, levels] - place[:, levels].mean(axis=1, keepdims=True)
        np.testing.assert_allclose(
            deviations, coordinates * np.hypot(scale, funnel.width), rtol=1e-6, atol=1e-9
        )
