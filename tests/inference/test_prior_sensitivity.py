"""Evidence and posterior under other priors: against a problem that is linear and normal in logarithms, and closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from linear_in_logarithms import NAMES, Known
from scipy.stats import norm

from skinbayes.fit import Fit
from skinbayes.fit.arviz_adapter import power_scaling
from skinbayes.fit.other_priors import OtherPriors
from skinbayes.fit.tree import weighted_group
from skinbayes.problem import build_problem
from skinbayes.report.sensitivity import page_sensitivity, sensitivity_rows

FIRST, SECOND = NAMES
KNOWN = Known()


@pytest.fixture(scope="module")
def fit() -> Fit:
    return KNOWN.fit()


@pytest.fixture(scope="module")
def found(fit: Fit):
    return fit.prior_sensitivity()


def null(prior, noise=0.1, draws=None) -> Fit:
    """One friction coefficient with a normal likelihood, draws of its posterior by rejection."""
    problem = build_problem(
        "constant", {"friction_coefficient": [0.5, 0.56, 0.47]}, parameters={"typical_friction_coefficient": prior},
        noise={"family": "gaussian", "noise_scale": noise},
    )  # fmt: skip
    before = problem.draw_prior(np.random.default_rng(3), 100_000)
    likelihood = problem.log_likelihood(before)
    kept = np.log(np.random.default_rng(4).random(len(before))) < likelihood - likelihood.max()
    return Fit.from_draws(problem, before[kept][:4000])


def test_the_model_of_these_tests_is_linear_in_logarithms():
    problem = KNOWN.problem()
    # ln Z = ln prior + ln likelihood − ln posterior at any point
    mean, covariance = KNOWN.moments()
    point = np.exp(mean)
    inverse = np.linalg.inv(covariance)
    posterior = 0.5 * np.log(np.linalg.det(inverse)) - np.log(2 * np.pi) - mean.sum()
    assert problem.log_posterior(point) - posterior == pytest.approx(KNOWN.log_evidence(), abs=1e-9)


@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("changed", [(FIRST,), (SECOND,), NAMES])
def test_evidence_and_posterior_are_those_of_the_other_priors(found, changed, factor):
    other = KNOWN.wider(*(factor if name in changed else 1.0 for name in NAMES))
    entry = found.of(changed, factor)
    assert entry.reliable and not entry.refitted
    expected = other.log_evidence() - KNOWN.log_evidence()
    assert abs(entry.log_evidence_change - expected) < 4 * entry.error and entry.error < 0.05
    (mean, covariance), (new_mean, new_covariance) = KNOWN.moments(), other.moments()
    for place, name in enumerate(NAMES):
        width, new_width = np.sqrt([covariance[place, place], new_covariance[place, place]])
        shift, error = entry.shifts[name]
        assert abs(shift - (new_mean - mean)[place] / width) < 4 * error + 0.02
        ratio, error = entry.width_ratios[name]
        # the width before is uncertain too
        assert abs(ratio - new_width / width) < 4 * np.hypot(error, 0.02)


def test_where_weights_cannot_tell_the_model_is_sampled_anew():
    # the second parameter is hardly seen by data of this width
    known = Known(means=(0.4, 0.0), widths=(1.0, 0.02), noise=0.3)
    fit = known.fit()
    weighted = fit.prior_sensitivity().of([SECOND], 2.0)
    assert not weighted.reliable and weighted.shifts == {}
    other = OtherPriors(fit, refit=True)
    again = other.under({SECOND: 2.0})
    assert again.reliable and again.refitted
    expected = known.wider(1.0, 2.0).log_evidence() - known.log_evidence()
    assert abs(again.change - expected) < 4 * again.error and again.error < 0.05
    # what was sampled with the wider prior tells about those between without being asked again
    between = other.under({SECOND: 1.6}, refit=False)
    expected = known.wider(1.0, 1.6).log_evidence() - known.log_evidence()
    assert between.reliable and abs(between.change - expected) < 4 * between.error


def test_a_uniform_prior_wider_than_the_likelihood_costs_its_width_alone():
    found = null({"uniform": [0.1, 1.1]}).prior_sensitivity()
    name = ("typical_friction_coefficient",)
    half, twice = found.of(name, 0.5), found.of(name, 2.0)
    assert half.reliable and half.log_evidence_change == pytest.approx(np.log(2.0), abs=0.01)
    # the lower end stops at zero: from 0 to 1.6 instead of -0.4 to 1.6
    assert twice.reliable and twice.log_evidence_change == pytest.approx(-np.log(1.6), abs=1e-6)
    assert twice.held == ("the lower end of typical_friction_coefficient",)
    assert any("cannot be: the lower end of" in sentence for sentence in found.sentences())


def test_draws_of_a_proposal_beyond_a_prior_change_nothing():
    """They have no weight; their ratio of densities, 0/0, once left every change of a bounded prior unknown."""
    fit = null({"uniform": [0.1, 1.1]})
    theta = np.append(fit.theta(), [[0.05], [1.2]], axis=0)[np.newaxis]
    log_weights = np.append(np.zeros(len(fit.theta())), [-np.inf, -np.inf])[np.newaxis]
    weighted = weighted_group(fit.problem.names, theta, log_weights)
    found = replace(fit, groups={**fit.groups, "weighted_posterior": weighted}).prior_sensitivity()
    half = found.of(["typical_friction_coefficient"], 0.5)
    assert half.reliable and half.log_evidence_change == pytest.approx(np.log(2.0), abs=0.01)


def test_a_uniform_prior_that_cuts_the_posterior_off_cannot_be_widened_by_weights():
    fit = null({"uniform": [0.1, 0.5]})
    twice = fit.prior_sensitivity().of(["typical_friction_coefficient"], 2.0)
    assert not twice.reliable
    again = OtherPriors(fit, refit=True).under({"typical_friction_coefficient": 2.0})
    mean, error = 0.51, 0.1 / np.sqrt(3)
    masses = [
        norm.cdf(high, mean, error) - norm.cdf(low, mean, error) for low, high in ((0.1, 0.5), (0.0, 0.7))
    ]
    expected = np.log(masses[1] / 0.7) - np.log(masses[0] / 0.4)
    assert again.reliable and abs(again.change - expected) < 4 * again.error


@pytest.mark.parametrize("prior", [{"lognormal": [0.5, 0.4]}, {"uniform": [0.1, 1.1]}])
def test_without_a_likelihood_only_the_prior_speaks(prior):
    found = null(prior, noise=1e4).prior_sensitivity()
    assert [entry.speaks for entry in found.informed] == ["prior"]
    assert found.sentences()[0] == "Only the prior speaks about typical_friction_coefficient."


def test_prior_and_data_far_apart_are_a_conflict():
    found = null({"lognormal": [0.25, 0.15]}).prior_sensitivity()
    assert [entry.speaks for entry in found.informed] == ["conflict"]
    assert found.sentences()[0].startswith("Prior and data pull against each other in typical_friction")


def test_data_that_outweigh_the_prior_speak_alone():
    found = null({"lognormal": [0.5, 3.0]}).prior_sensitivity()
    assert [entry.speaks for entry in found.informed] == ["data"]


def distance(first, second, ends):
    """Cumulative Jensen–Shannon distance of two normal distributions between two ends, by quadrature."""
    x = np.linspace(*ends, 20_001)
    found = []
    for sign in (1, -1):
        p, q = (norm.cdf(sign * (x - mean) / width) for mean, width in (first, second))
        parts = [
            np.trapezoid(a * np.log2(2 * a / (a + b)), x) + np.trapezoid(b - a, x) / (2 * np.log(2))
            for a, b in ((p, q), (q, p))
        ]
        found.append(np.sqrt(sum(parts) / np.trapezoid(p + q, x)))
    return max(found)


@pytest.mark.parametrize("part", ["prior", "likelihood"])
def test_power_scaling_against_quadrature(fit, found, part):
    theta = np.log(fit.theta())
    for place, entry in enumerate(found.informed):
        known = [KNOWN.moments(**{f"{part}_power": power}) for power in (1 / 1.01, 1.0, 1.01)]
        lower, middle, upper = [(m[place], np.sqrt(c[place, place])) for m, c in known]
        ends = theta[:, place].min(), theta[:, place].max()
        distances = [distance(middle, other, ends) for other in (lower, upper)]
        expected = sum(distances) / (2 * np.log2(1.01))
        assert getattr(entry, part) == pytest.approx(expected, rel=0.15)


def test_a_flat_part_has_no_power():
    draws = np.random.default_rng(1).normal(size=(500, 2))
    found = power_scaling(draws, np.zeros(500), -0.5 * np.square(draws).sum(axis=1))
    assert (found["prior"] == 0.0).all() and (found["likelihood"] > 0.05).all()


def test_table_and_page_show_the_findings(fit, found):
    rows = sensitivity_rows(found)
    assert [row[0] for row in rows] == [*NAMES, "all together"]
    change = found.of([FIRST], 2.0)
    assert rows[0][2] == f"{change.log_evidence_change:+.2f} ± {change.error:.2f}"
    assert page_sensitivity(fit) == (rows, found.sentences())
    assert page_sensitivity(replace(fit, problem=None)) == ([], [])


def test_sentences_name_what_moves(found):
    said = " ".join(found.sentences())
    assert "posterior standard deviations" in said and "ln of the evidence changes by" in said
    assert found.to_dict()["sentences"] == found.sentences()
