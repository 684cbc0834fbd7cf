"""What a report says in words, against fits whose content is known."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from made_up_fit import made_up_fit

from skinbayes.fit import Fit
from skinbayes.phrases import percent
from skinbayes.plot.numbers import interval, quantity
from skinbayes.report import quality, sentences
from skinbayes.report.markup import links, symbols
from skinbayes.report.ridges import ridge_sentences


def with_draws(fit: Fit, name: str, values: np.ndarray) -> Fit:
    posterior = fit.groups["posterior"].copy()
    posterior[name] = posterior[name].copy(data=values.reshape(posterior[name].shape))
    return replace(fit, groups={**fit.groups, "posterior": posterior})


def test_each_parameter_is_either_learnt_or_not() -> None:
    fit = made_up_fit(4, 3, not_updated=("yield_stress",))
    learnt, not_learnt = sentences.learnt(fit), sentences.not_learnt(fit)
    assert len(learnt) == 3
    assert [line.split(":")[0] for line in not_learnt] == ["Yield stress σ_Y"]
    assert "only the prior speaks" in not_learnt[0]


def test_what_was_learnt_gives_median_interval_and_factors() -> None:
    fit = made_up_fit(1, 3)
    draws, before = fit.draws("frictional_shear_stress"), fit.draws("frictional_shear_stress", "prior")
    low, middle, high = np.quantile(draws, [0.05, 0.5, 0.95])
    (line,) = sentences.learnt(fit)
    assert line.startswith(f"Frictional shear stress σ_f: {quantity(middle, 'Pa')};")
    assert interval(low, high, "Pa", joint=" and ") in line
    after, prior = (float(found) for found in re.findall(r"([\d.]+) times", line))
    assert after == pytest.approx(high / low, rel=0.05)
    assert prior == pytest.approx(np.exp(np.ptp(np.quantile(np.log(before), [0.05, 0.95]))), rel=0.05)


def test_contradiction_between_data_and_prior_is_said() -> None:
    fit = made_up_fit(1, 3)
    far = with_draws(fit, "frictional_shear_stress", fit.draws("frictional_shear_stress") * 100.0)
    (line,) = sentences.learnt(far)
    assert "contradict the prior" in line
    (why,) = sentences.disagreements(far)
    assert "contradict the prior" in why and "lies above" in why


def test_ridge_is_found_with_its_exponent() -> None:
    fit = made_up_fit(2, 3)
    stress = fit.draws("frictional_shear_stress")
    noise = np.exp(0.01 * np.random.default_rng(0).normal(size=stress.size))
    tied = with_draws(fit, "young_modulus_layer", 1e-8 * stress**2 * noise)
    (line,) = ridge_sentences(tied)
    assert "E0 / σ_f^2" in line
    # 90 % of a lognormal of width 0.01: exp(2·1.645·0.01) = 1.033, to 5 % by chance
    found = re.search(r"is known within ([\d.]+) %, from end to end", line)
    assert found and float(found[1]) == pytest.approx(3.3, abs=0.3)
    assert "alone, σ_f is known only within a factor of" in line
    inverse = with_draws(fit, "young_modulus_layer", 1e14 / stress * noise)
    assert "E0 · σ_f is known" in ridge_sentences(inverse)[0]
    assert ridge_sentences(fit) == []


def test_names_become_symbols_but_only_whole_ones() -> None:
    fit = made_up_fit(3, 2)
    text = "frictional_shear_stress / (young_modulus_layer · rms_slope); frictional_shear_stresses stay"
    assert (
        sentences.with_symbols(fit, text)
        == "σ_f / (E0 · root-mean-square slope); frictional_shear_stresses stay"
    )


def test_agreement_counts_data_in_their_intervals() -> None:
    fit = made_up_fit(2, 40)
    draws = fit.groups["posterior_predictive"]["friction_coefficient"].values.reshape(-1, 40)
    observed = fit.groups["observed_data"]["friction_coefficient"].values
    low, high = np.quantile(draws, [0.05, 0.95], axis=0)
    inside = int(((observed >= low) & (observed <= high)).sum())
    assert 30 <= inside < 40
    said = quality.agreement(fit)
    assert said[0].startswith(f"{inside} of 40 data lie in the 5–95 % range")
    assert "mean of the data is reproduced" in " ".join(said)


def test_misfit_is_said() -> None:
    fit = made_up_fit(2, 10, row_names=[f"row {i}" for i in range(10)])
    observed = fit.groups["observed_data"].copy()
    observed["friction_coefficient"] = observed["friction_coefficient"] * np.r_[np.ones(9), 10.0]
    bad = quality.agreement(replace(fit, groups={**fit.groups, "observed_data": observed}))
    assert any("row 9" in line and "does not explain it" in line for line in bad)
    assert any("scatter between rows of the data is not reproduced" in line for line in bad)


def test_few_data_are_weak_evidence() -> None:
    assert "weak evidence" in quality.agreement(made_up_fit(2, 2))[-1]
    assert quality.agreement(made_up_fit(1, 1))[0].startswith("The single datum")


def test_percentages_are_never_rounded_to_nothing() -> None:
    assert [percent(v) for v in (0.0, 1e-5, 0.04, 0.5, 1.0)] == [
        "0 %",
        "less than 0.1 %",
        "4 %",
        "50 %",
        "100 %",
    ]


@pytest.mark.parametrize("mark", [symbols, links])
@pytest.mark.parametrize(
    "text", ["<script>alert(1)</script>", "a_<b>", "E0\"onload='x'", "10.1234/<img src=x>", "x^(<i>)", "&lt;"]
)
def test_marked_up_text_is_escaped(mark, text: str) -> None:
    from html import unescape

    marked = mark(text)
    bare = re.sub(r'</?(sub|sup|a)( href="https://doi\.org/10\.[^"<>\s]*")?>', "", marked)
    assert "<" not in bare and ">" not in bare and '"' not in bare and "'" not in bare
    assert unescape(bare).replace("^", "") == re.sub(r"(?<=\w)_(?=\w)", "", text).replace("^", "")
