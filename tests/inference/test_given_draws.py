"""Results from draws of anybody's sampler: every form gives the same, and what cannot be is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray
from numpy.testing import assert_allclose
from small_models import same_draws, two_parameters

import skinbayes as sb
from skinbayes.fit.arviz_adapter import to_arviz
from skinbayes.report import write_report


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory) -> sb.Problem:
    return two_parameters(tmp_path_factory.mktemp("model"))


@pytest.fixture(scope="module")
def theta(problem: sb.Problem) -> np.ndarray:
    """Draws of the posterior by rejection, an exact sampler."""
    rng = np.random.default_rng(1)
    prior = problem.draw_prior(rng, 40_000)
    value = problem.log_likelihood(prior)
    kept = prior[np.log(rng.random(len(prior))) < value - value.max()]
    return kept[: len(kept) // 2 * 2].reshape(2, -1, 2)


def test_every_form_gives_the_same_result(problem: sb.Problem, theta: np.ndarray) -> None:
    columns = {name: theta[..., i] for i, name in enumerate(problem.names)}
    dataset = xarray.Dataset({name: (("chain", "draw"), values) for name, values in columns.items()})
    reference = sb.Fit.from_draws(problem, theta)
    others = [columns, dataset, dataset.transpose("draw", "chain"), to_arviz({"posterior": dataset})]
    for given in others:
        same_draws(reference, sb.Fit.from_draws(problem, given))
    flat = theta.reshape(-1, 2)
    frame = pandas.DataFrame(flat, columns=list(problem.names)).assign(other=1.0)
    same_draws(sb.Fit.from_draws(problem, flat), sb.Fit.from_draws(problem, frame))
    assert_allclose(reference.theta(), flat, rtol=1e-12)
    assert reference.converged and reference.provenance["sampling"]["r_hat"][0] < 1.01
    # no R-hat of a single chain
    assert "r_hat" not in sb.Fit.from_draws(problem, flat).summary()


def test_the_same_posterior_from_weights(problem: sb.Problem, theta: np.ndarray, tmp_path: Path) -> None:
    prior = problem.draw_prior(np.random.default_rng(2), 40_000)
    fit = sb.Fit.from_draws(problem, prior, problem.log_likelihood(prior))
    exact = theta.reshape(-1, 2)
    for i, name in enumerate(problem.names):
        # fraction of the exact draws below, about 1000 of each kind: five standard errors
        for fraction, value in zip((0.05, 0.5, 0.95), fit.quantiles(name), strict=True):
            error = np.sqrt(
                fraction * (1 - fraction) * (1 / len(exact) + 1 / fit.provenance["sampling"]["ess_bulk"][0])
            )
            assert abs((exact[:, i] < value).mean() - fraction) < 5 * error
    assert write_report(fit, tmp_path / "page.html").stat().st_size > 10_000
    assert sb.load_fit(fit.save(tmp_path / "run.nc")).summary().equals(fit.summary())


def test_levels_of_a_parameter_are_a_dimension_or_part_of_the_name() -> None:
    problem = sb.load_problem("forearm-glass")
    theta = problem.draw_prior(np.random.default_rng(1), 200)
    fit = sb.Fit.from_draws(problem, theta)
    assert not fit.converged and "200" not in fit.names
    again = sb.Fit.from_draws(problem, fit.groups["posterior"])
    assert_allclose(again.theta(), theta, rtol=1e-12)
    shuffled = fit.groups["posterior"].isel(state=[1, 0])
    assert_allclose(sb.Fit.from_draws(problem, shuffled).theta(), theta, rtol=1e-12)
    assert_allclose(
        sb.Fit.from_draws(problem, dict(zip(problem.names, theta.T, strict=True))).theta(), theta, rtol=1e-12
    )


def test_what_cannot_be_is_said(problem: sb.Problem, theta: np.ndarray) -> None:
    for given, said in (
        (theta[..., :1], r"expected \(draws, 2\).*frictional_shear_stress, noise_scale"),
        ({"noise_scale": theta[0, :, 1]}, "none of frictional_shear_stress; found those of noise_scale"),
        (-theta, "lie where its prior has no mass"),
        ({"frictional_shear_stress": theta[0, :, 0], "noise_scale": theta[0, :9, 1]}, "as many of each"),
    ):
        with pytest.raises(sb.InputError, match=said):
            sb.Fit.from_draws(problem, given)
    with pytest.raises(sb.InputError, match="log_weights: shape"):
        sb.Fit.from_draws(problem, theta, np.zeros(3))
    with pytest.raises(sb.InputError, match="nothing to infer"):
        sb.Fit.from_draws(sb.load_problem("contact-area"), theta)
