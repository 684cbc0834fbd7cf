"""Groups, validity, ridges and disagreement with the prior, in words and for machines, against draws chosen by hand."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from grouped_fit import MEANING, finger_fit, with_effects, with_flags
from made_up_fit import made_up_fit
from test_report_sentences import with_draws

from skinbayes.report import digest, sentences
from skinbayes.report.groups import effect_rows, group_findings, group_sentences
from skinbayes.report.quality import agreement
from skinbayes.report.ridges import posterior_ridges, ridge_sentences
from skinbayes.report.validity import validity_sentences


def known_effects() -> tuple:
    """Liquids with effects from −0.7 to 0.7, people with next to none."""
    centres = np.linspace(-0.7, 0.7, 15)
    fit = with_effects(finger_fit(), "liquid", centres, 0.05, 0.4)
    return with_effects(fit, "person", np.zeros(11), 0.05, 0.1), centres


def test_people_differ_and_the_theory_misses_liquids() -> None:
    fit, _ = known_effects()
    people, liquids, noise = group_sentences(fit)
    assert people.startswith("How people differ: 10 % of μ (standard deviation; 90 %: ")
    ends = [float(found) for found in re.findall(r"90 %: ([\d.]+) to ([\d.]+) %", people)[0]]
    np.testing.assert_allclose(
        ends, 100 * np.quantile(fit.draws("group_scale[person]"), [0.05, 0.95]), rtol=0.05
    )
    assert "None of 11 people lies off the middle" in people
    assert liquids.startswith("The theory's misfit from liquid to liquid: 40 % of μ")
    factor = float(re.findall(r"typically a factor of ([\d.]+) up or down", liquids)[0])
    assert factor == pytest.approx(np.exp(np.median(fit.draws("group_scale[liquid]"))), abs=0.005)
    # 0.05 wide about steps of 0.1: all but the one at 0 lie off
    assert "14 of 15 liquids lie off the middle" in liquids
    assert re.search(
        r"lowest: water \(×\u00a00\.(49|50)", liquids
    )  # exp(−0.7) = 0.4966; water is the first of the data
    assert noise.startswith("Beside the noise: single values scatter about all this by")


def test_shares_of_variance_and_ratios_follow_from_the_scales() -> None:
    fit, centres = known_effects()
    people, liquids = group_findings(fit)
    noise = float(np.median(fit.draws("noise_scale")))
    assert liquids.over_noise is not None and people.over_noise is not None
    assert liquids.over_noise[1] == pytest.approx(0.4 / noise, rel=0.05)
    whole = 0.1**2 + 0.4**2 + noise**2
    assert liquids.variance_fraction == pytest.approx(0.4**2 / whole, abs=0.03)
    assert people.variance_fraction == pytest.approx(0.1**2 / whole, abs=0.01)
    middle = [found[1] for found in liquids.effects.values()]
    np.testing.assert_allclose(middle, centres, atol=0.02)
    rows = [row for row in effect_rows(fit) if row[0] == "liquid"]
    assert rows[0][2].startswith("× 2.0")  # exp(0.7) = 2.014, highest first


def test_without_knowledge_of_liquids_they_just_differ() -> None:
    fit = finger_fit()
    constant = fit.groups["constant_data"].drop_vars("viscosity")
    assert (
        "How liquids differ"
        in group_sentences(replace(fit, groups={**fit.groups, "constant_data": constant}))[1]
    )


def test_agreement_says_that_it_knows_the_effects() -> None:
    assert "the very people and liquids that were measured" in " ".join(agreement(finger_fit()))
    assert group_sentences(made_up_fit(2, 3)) == [] == group_findings(made_up_fit(2, 3))


# -- validity --------------------------------------------------------------------------------------------------------


def liquids() -> np.ndarray:
    return finger_fit().groups["constant_data"]["liquid"].values.astype(str)


def test_rows_at_the_edge_are_counted_and_named() -> None:
    honey = np.where(liquids() == "honey", 1.0, 0.0)
    honey[liquids() == "honey + 3 g starch"] = 0.3
    (first, rest) = validity_sentences(with_flags(finger_fit(), wide=honey))
    assert first.startswith(
        "The contact is wider than half the radius of the ball: 22 of 165 rows, 11 of them in more than half"
    )
    fraction = (11 * 1.0 + 11 * 0.3) / 165
    assert f"{100 * fraction:.2g} % of the posterior predictions" in first
    assert first.endswith("All rows of honey and honey + 3 g starch.")
    assert "at its edge" in rest


def test_single_rows_are_named_and_many_are_summarised() -> None:
    names = finger_fit().groups["observed_data"]["row"].values
    one = np.zeros(165)
    one[7] = 0.2
    assert f"Row {names[7]}." in validity_sentences(with_flags(finger_fit(), wide=one))[0]
    people = finger_fit().groups["constant_data"]["person"].values.astype(str)
    many = np.where((people == "ID04") | (people == "ID07"), 1.0, 0.0)
    many[np.flatnonzero(people == "ID04")[0]] = many[np.flatnonzero(people == "ID07")[0]] = 0.0
    said = validity_sentences(with_flags(finger_fit(), wide=many))[0]
    assert "Most often rows of ID04 (14 of 15) and ID07 (14 of 15)." in said
    both = np.where((people == "ID04") | (liquids() == "water"), 1.0, 0.0)
    both[np.flatnonzero(people == "ID07")[3:13]] = 1.0
    said = validity_sentences(with_flags(finger_fit(), wide=both))[0]
    assert "All rows of ID04, all rows of water and of the others most often rows of ID07 (10 of 15)." in said
    but = np.where(liquids() == "water", 0.0, 1.0)
    assert "All rows of all liquids but water." in validity_sentences(with_flags(finger_fit(), wide=but))[0]
    assert "These are all rows." in validity_sentences(with_flags(finger_fit(), wide=np.ones(165)))[0]


def test_nothing_to_say_is_said_too() -> None:
    (said,) = validity_sentences(with_flags(finger_fit(), wide=np.full(165, 0.04)))
    assert said.startswith("Nothing to say: no row is marked in 5 %") and MEANING in said
    (said,) = validity_sentences(finger_fit())
    assert "marks no predictions as doubtful" in said
    flagged = with_flags(finger_fit(), wide=np.ones(165))
    groups = {name: group for name, group in flagged.groups.items() if name != "validity"}
    assert "not looked at" in validity_sentences(replace(flagged, groups=groups))[0]


def test_machines_get_the_same() -> None:
    fit = with_flags(known_effects()[0], wide=np.where(liquids() == "honey", 0.5, 0.0))
    found = digest(fit)
    assert found["validity"]["wide"]["rows"] == 11 == len(found["validity"]["wide"]["fraction_by_row"])
    assert found["validity"]["wide"]["fraction"] == pytest.approx(0.5 * 11 / 165)
    assert found["validity"]["wide"]["meaning"] == MEANING
    assert set(found["groups"]) == {"person", "liquid"}
    scale = found["groups"]["liquid"]["scale"]
    np.testing.assert_allclose(
        [scale["q05"], scale["median"], scale["q95"]],
        np.quantile(fit.draws("group_scale[liquid]"), [0.05, 0.5, 0.95]),
    )
    assert len(found["groups"]["liquid"]["effects"]) == 15
    assert set(found["priors"]) == set(fit.names)


# -- ridges and priors -----------------------------------------------------------------------------------------------


def test_ridge_says_how_little_is_known_alone() -> None:
    fit = made_up_fit(2, 3)
    rng = np.random.default_rng(4)
    stress = fit.draws("frictional_shear_stress")
    wide = 15e6 * np.exp(0.5 * rng.normal(size=stress.size))
    tied = with_draws(fit, "frictional_shear_stress", wide)
    tied = with_draws(
        tied, "young_modulus_layer", 7e6 * (wide / 15e6) ** -0.6 * np.exp(0.02 * rng.normal(size=wide.size))
    )
    (ridge,) = posterior_ridges(tied)
    assert ridge.exponent == pytest.approx(-0.6, abs=0.01) and ridge.combination == "E0 · σ_f^0.60"
    # 90 % of a lognormal of width w: exp(2·1.645·w)
    assert ridge.factor == pytest.approx(np.exp(3.29 * 0.02), rel=0.02)
    assert ridge.factors_alone is not None
    np.testing.assert_allclose(ridge.factors_alone, np.exp([3.29 * 0.5, 3.29 * 0.3]), rtol=0.1)
    (said,) = ridge_sentences(tied)
    assert "E0 · σ_f^0.60 is known within 6.6 %, from end to end" in said
    assert "alone, σ_f is known only within a factor of 5.3 and E0 within a factor of 2.7" in said
    assert digest(replace(tied, groups={**tied.groups}))["ridges"][0]["first"] == "frictional_shear_stress"


def test_posterior_beyond_the_range_of_the_prior_is_said() -> None:
    fit = made_up_fit(1, 3)
    name = "frictional_shear_stress"
    before, draws = fit.draws(name, "prior"), fit.draws(name)
    assert sentences.disagreements(fit) == []
    for quantile, words in ((0.97, "pull against each other"), (0.999, "contradict the prior")):
        moved = with_draws(fit, name, draws * np.quantile(before, quantile) / np.median(draws))
        (said,) = sentences.disagreements(moved)
        assert words in said and "lies above" in said and said.startswith("Frictional shear stress σ_f:")
    inside = with_draws(fit, name, draws * np.quantile(before, 0.93) / np.median(draws))
    assert sentences.disagreements(inside) == []


def test_effects_that_lie_on_one_side_are_said_to_swallow_a_common_misfit() -> None:
    balanced, centres = known_effects()
    assert "one side" not in group_sentences(balanced)[1]
    lopsided = with_effects(balanced, "liquid", centres + 0.6, 0.05, 0.4)
    said = group_sentences(lopsided)[1]
    # 0.6 is six standard deviations of a mean of fifteen effects of scale 0.4; exp(0.6) = 1.82
    assert "on one side, at ×\u00a01.8" in said and "misses of all liquids alike" in said
    assert digest(lopsided)["groups"]["liquid"]["mean"]["median"] == pytest.approx(0.6, abs=0.02)
