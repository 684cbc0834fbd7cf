"""Which widths of priors turn the preference of the evidence: against models whose evidence is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from linear_in_logarithms import NAMES, Known
from scipy.optimize import brentq

from skinbayes.comparison.models import compare
from skinbayes.comparison.prior_widths import ALL, prior_widths
from skinbayes.comparison.verdicts import AHEAD

FIRST, SECOND = NAMES
WITH = Known((0.2, 0.0), (0.5, 0.3), 0.2, "growing")
WITHOUT = Known((0.2, 0.0), (0.5, 0.0), 0.2, "steady")


@pytest.fixture(scope="module")
def fits():
    return [WITHOUT.fit(), WITH.fit()]


@pytest.fixture(scope="module")
def found(fits):
    return prior_widths(fits)


def bayes_factor(first, second):
    return first.log_evidence() - second.log_evidence()


@pytest.mark.parametrize("quantity", [FIRST, SECOND, ALL])
def test_the_preference_turns_where_the_known_evidence_does(found, quantity):
    (scan,) = [entry for entry in found.scans if entry.quantity == quantity]
    names = NAMES if quantity == ALL else (quantity,)
    assert (scan.preferred, scan.other) == ("growing", "steady")

    def reaching(reach):
        return bayes_factor(*(model.reaching(reach, *names) for model in (WITH, WITHOUT)))

    for factor, value in ((0.5, scan.narrower), (2.0, scan.wider)):
        factors = [factor if name in names else 1.0 for name in NAMES]
        assert value == pytest.approx(bayes_factor(*(m.wider(*factors) for m in (WITH, WITHOUT))), abs=0.05)
    if reaching(100.0) > 0:
        assert scan.turns_at is None and scan.known_to == 100.0
    else:
        assert scan.turns_at == pytest.approx(brentq(reaching, 1.0, 100.0), rel=0.15)


def test_it_is_said_in_words(fits):
    compared = compare(fits, refit=False)
    said = " ".join(compared.sentences())
    assert f"The preference of the evidence for 'growing' over 'steady' turns if {SECOND} may be 4." in said
    assert f"stays if {FIRST} may be 100 times larger or smaller." in said
    kept = compared.to_dict()["prior_widths"]["scans"]
    assert [entry["quantity"] for entry in kept] == [*NAMES, ALL]


def test_what_a_sentence_does_hangs_on_no_word_in_it(fits):
    named = replace(WITH, widths=(0.5, 1.2), name="preferred, apart, better than").fit()
    statements = compare([fits[0], fits[1], named], refit=False).statements()
    ahead = [one.text for one in statements if one.kind == AHEAD]
    assert not any("WARNING" in text or "is not given" in text for text in ahead)
    # whether the preference turns, and whether it stays, is one answer
    assert any(" turns if " in text for text in ahead) and any(" stays if " in text for text in ahead)


def test_models_that_differ_in_widths_only_are_warned_of(fits):
    wide = replace(WITH, widths=(0.5, 1.2), name="growing-wide").fit()
    ((first, second, labels, only_widths),) = prior_widths([fits[1], wide]).same_model
    assert (first, second, labels, only_widths) == ("growing", "growing-wide", (SECOND,), True)
    (sentence, *_) = prior_widths([fits[1], wide]).sentences()
    assert (
        sentence.startswith("WARNING")
        and "is a choice of the prior and says nothing about the data" in sentence
    )
    assert sentence in compare([fits[1], wide], refit=False).sentences()


def test_the_same_model_with_other_middles_of_priors_is_told_of(fits):
    moved = replace(WITH, means=(0.2, 0.3)).fit()
    ((*_, labels, only_widths),) = prior_widths([fits[1], moved]).same_model
    assert labels == (SECOND,) and not only_widths
    assert "judges these priors, not the physics" in prior_widths([fits[1], moved]).sentences()[0]


def test_other_models_are_not_the_same(fits, found):
    assert found.same_model == () and prior_widths([fits[1], fits[1]]).same_model == ()


def test_without_evidence_or_models_there_is_nothing_to_scan(fits):
    sampling = {**fits[0].provenance["sampling"], "log_evidence": None}
    unknown = replace(fits[0], provenance={**fits[0].provenance, "sampling": sampling})
    assert prior_widths([unknown, fits[1]]).scans == ()
    assert prior_widths([replace(fits[0], problem=None), fits[1]]).sentences() == []


@pytest.mark.slow
def test_what_draws_cannot_tell_is_sampled_anew_once():
    # the data hardly see the second parameter, so that its posterior is its prior
    fits = [replace(known, noise=4.0).fit() for known in (WITH, WITHOUT)]
    calls = []
    plain = {scan.quantity: scan for scan in prior_widths(fits).scans}
    again = {scan.quantity: scan for scan in prior_widths(fits, True, lambda *done: calls.append(done)).scans}
    assert plain[SECOND].known_to < 100 and again[SECOND].known_to == 100
    assert calls[0] == (0, 3) and calls[-1] == (3, 3)
    models = [replace(known, noise=4.0) for known in (WITH, WITHOUT)]
    sign = 1 if bayes_factor(*models) > 0 else -1
    expected = sign * bayes_factor(*(known.wider(1.0, 2.0) for known in models))
    assert again[SECOND].wider == pytest.approx(expected, abs=0.05)
    assert np.isfinite(again[ALL].log_bayes_factor)
