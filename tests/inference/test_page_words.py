"""What page and terminal say beside the numbers: fit, silence, shares, rows, and one rule for all of it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import xarray
from made_up_fit import made_up_fit

from skinbayes.diagnose import identify
from skinbayes.diagnose.rule import verdict
from skinbayes.fit import Fit
from skinbayes.phrases import percent
from skinbayes.plot.numbers import fraction, interval
from skinbayes.plot.updates import fit_updates
from skinbayes.report import digest, opening, quality, remarks, sentences
from skinbayes.report.tables import derived_rows
from skinbayes.statistics.agreement import examine


@cache
def fit_of(parameters: int = 9, rows: int = 12) -> Fit:
    made = made_up_fit(parameters, rows, not_updated=("yield_stress",))
    provenance = {**made.provenance, "noise": {"friction_coefficient": "lognormal"}, "priors": {}}
    sampling = {**made.provenance["sampling"], "verdict": "Converged.", "missing": []}
    return replace(made, provenance={**provenance, "sampling": sampling})


def with_posterior(fit: Fit, **variables: xarray.DataArray) -> Fit:
    posterior = fit.groups["posterior"].assign(variables)
    prior = fit.groups["prior"]
    length = prior.sizes["draw"]
    for name, value in variables.items():
        if name not in prior:  # draws of a derived quantity before the data: any will do
            repeated = np.resize(np.asarray(value), (1, length, *value.shape[2:]))
            prior = prior.assign({name: (value.dims, repeated)})
    return replace(fit, groups={**fit.groups, "posterior": posterior, "prior": prior})


def by_row(name: str, draws: np.ndarray, **attributes: str) -> xarray.DataArray:
    """A derived quantity of each row; draws of shape ``(chain, draw, row)``."""
    rows = [str(i + 1) for i in range(draws.shape[-1])]
    attributes = {"units": "1", "kind": "derived", "symbol": name, **attributes}
    return xarray.DataArray(
        draws, dims=("chain", "draw", "row"), coords={"row": rows}, name=name, attrs=attributes
    )


def test_misfit_is_said_at_the_top_and_in_the_terminal() -> None:
    fit = fit_of()
    assert not fit.agreement.misfit
    observed = fit.groups["observed_data"].copy()
    observed["friction_coefficient"] = observed["friction_coefficient"] * np.r_[np.ones(11), 10.0]
    bad = replace(fit, groups={**fit.groups, "observed_data": observed})
    assert bad.agreement.misfit
    said = " ".join(quality.verdict(bad))
    assert said.startswith("The model misses something:") and "row 12 is far out" in said
    assert said in remarks(bad)


def test_many_rows_are_not_far_out_by_chance() -> None:
    """A model that is right is called wrong in few of many data sets drawn from it."""
    fit = made_up_fit(1, 165)
    draws = fit.groups["posterior_predictive"]["friction_coefficient"].values.reshape(-1, 165)
    rng = np.random.default_rng(4)
    found = 0
    for _ in range(40):
        observed = fit.groups["observed_data"].copy()
        observed["friction_coefficient"] = ("row", rng.permuted(draws, axis=0)[0])
        found += bool(replace(fit, groups={**fit.groups, "observed_data": observed}).agreement.far)
    assert found <= 8  # 5 % each: 2 expected, more than 8 once in 100,000


def test_few_draws_do_not_make_rows_far_out() -> None:
    """Of 165 data about one lies beyond all of 256 draws on either side, without being far out."""
    rng = np.random.default_rng(8)
    found = [
        examine(rng.normal(size=165), rng.normal(size=(256, 165)), of_one_kind=True).far for _ in range(40)
    ]
    assert sum(map(bool, found)) <= 8  # as above
    assert examine(np.r_[rng.normal(size=164), 6.0], rng.normal(size=(256, 165)), of_one_kind=True).far == (
        164,
    )


def test_a_fitted_scatter_is_no_praise() -> None:
    fit = fit_of()
    said = " ".join(quality.verdict(fit))
    assert (
        f"That is little: the scatter was fitted too ({percent(float(np.median(fit.draws('noise_scale'))))} of μ)"
        in said
    )
    assert "12 of 12" in said or "11 of 12" in said or "10 of 12" in said
    assert not any("Noise scale" in line for line in [*sentences.learnt(fit), *sentences.not_learnt(fit)])
    assert any(line.startswith("Noise scale") for line in sentences.scatter(fit))
    assert "noise" not in opening.question(fit) + opening.answer(fit)


def test_one_rule_says_about_what_only_the_prior_speaks() -> None:
    fit = fit_of()
    silent = [label for label, update in fit_updates(fit).items() if update.verdict == "not updated"]
    assert silent == ["yield_stress"]
    assert [line.split(":")[0] for line in sentences.not_learnt(fit)] == ["Yield stress σ_Y"]
    assert "Only the prior speaks about yield_stress." in remarks(fit)
    assert opening.unanswered(fit)[0] == "About σ_Y only the prior speaks."
    assert digest(fit)["priors"]["yield_stress"]["verdict"] == "not updated"
    # a posterior that is as wide as the prior but elsewhere has been moved: location counts
    moved = with_posterior(fit, yield_stress=fit.groups["posterior"]["yield_stress"].copy() * np.exp(0.6))
    assert sentences.not_learnt(moved) == [] and "do not narrow" in " ".join(sentences.learnt(moved))
    assert not any("Only the prior" in line for line in remarks(moved))
    assert [verdict(0.95), verdict(0.95, 0.9), verdict(0.5), verdict(0.2, 0.999)] == [
        "not updated", "moved", "updated", "contradicted",
    ]  # fmt: skip


def test_the_check_expects_and_does_not_claim() -> None:
    draws = np.exp(0.5 * np.random.default_rng(0).normal(size=(40, 3)))
    found = identify(("a", "b", "c"), lambda t: np.log(t[:, :1] * t[:, 1:2]) + 1e-4 * t[:, 2:], draws, 0.05)
    said = " ".join(found.sentences())
    assert "Only the prior will speak about c, as far as can be said before sampling" in said
    assert found.spread_ratios["c"] == pytest.approx(1.0, abs=1e-3)


def test_exponents_that_change_sign_are_no_combination() -> None:
    draws = np.exp(0.6 * np.random.default_rng(1).normal(size=(60, 2)))

    def bent(theta: np.ndarray) -> np.ndarray:  # the power of b is ln b, which is of both signs
        return (np.log(theta[:, :1]) + np.log(theta[:, 1:]) ** 2).astype(float)

    found = identify(("a", "b"), bent, draws, 0.05)
    assert found.joint.directions == 1 and found.joint.combinations == ()
    assert "^(" not in " ".join(found.sentences())


def test_exponents_that_vary_are_not_written_as_ranges() -> None:
    draws = np.exp(0.6 * np.random.default_rng(1).normal(size=(60, 2)))
    said = " ".join(
        identify(("a", "b"), lambda t: np.log(t.sum(axis=1, keepdims=True)), draws, 0.05).sentences()
    )
    assert "a combination of a and b (its exponents vary over the prior)" in said and "^(" not in said


@pytest.mark.parametrize(
    ("count", "total", "text"),
    [(0, 4000, "less than 0.03 %"), (0, 3000, "less than 0.04 %"), (4000, 4000, "more than 99.97 %"),
     (1, 4000, "0.025 %"), (0, 10000, "less than 0.01 %"), (0, 7, "less than 20 %"), (9, 10, "90 %")],
)  # fmt: skip
def test_none_of_some_draws_is_less_than_one_of_them(count: int, total: int, text: str) -> None:
    assert fraction(count, total) == text


def test_a_prior_that_never_reaches_the_posterior_is_said_with_its_draws() -> None:
    fit = fit_of()
    far = with_posterior(fit, yield_stress=fit.groups["posterior"]["yield_stress"].copy() * 1e3)
    (line,) = (said for said in sentences.disagreements(far) if said.startswith("Yield stress"))
    assert "but less than 0.05 % of the prior" in line  # of 2000 draws
    assert line in remarks(far)


def test_a_quantity_of_each_row_has_one_sentence() -> None:
    rng = np.random.default_rng(2)
    draws = 0.4 * np.exp(0.1 * rng.normal(size=(4, 300, 1))) * np.linspace(1.0, 1.5, 12)
    fit = with_posterior(fit_of(), made_up=by_row("made_up", draws, long_name="what friction measures"))
    (line,) = sentences.learnt_products(fit)
    assert line.count("It is what friction measures.") == 1 and "(12 rows)" in line
    medians = np.median(draws.reshape(-1, 12), axis=0)
    assert f"{interval(medians.min(), medians.max(), '1')} from row to row" in line
    same = with_posterior(fit_of(), made_up=by_row("made_up", np.repeat(draws[..., :1], 12, axis=-1)))
    assert "in all 12 rows" in sentences.learnt_products(same)[0]


def test_rows_of_one_median_keep_their_interval() -> None:
    """A plastic fraction whose median is 1 in all rows but whose interval begins at 0.04 is not just 1."""
    draws = np.ones((4, 300, 12))
    draws[:, :60] = np.linspace(0.02, 0.06, 60)[:, np.newaxis]
    fit = with_posterior(fit_of(), plastic_fraction=by_row("plastic_fraction", draws))
    (row,) = [row for row in derived_rows(fit)[0] if row["name"].startswith("plastic fraction")]
    low, high = np.quantile(draws, [0.05, 0.95])
    assert row["median"] == "1 in all rows"
    assert row["interval"] == interval(low, high, "1") and low < 0.1 < high


def test_more_effective_draws_than_stored_are_explained() -> None:
    fit = fit_of()
    assert quality.more_than_kept(fit) == ""  # 1200 of 1200
    sampling = {**fit.provenance["sampling"], "ess_bulk": [5000.0] * 9}
    more = replace(fit, provenance={**fit.provenance, "sampling": sampling})
    assert "1200 draws of them are kept" in quality.more_than_kept(more)
    assert quality.more_than_kept(more) in remarks(more)
