"""Fresh fits agree with the reference posteriors within Monte Carlo error."""

from __future__ import annotations

import numpy as np
import pytest
from reference_posteriors import EACH, FILE, SEEDS, effective, reference_posteriors

import skinbayes as sb
from skinbayes.files.locate import shipped_names
from skinbayes.fit import Fit

REFERENCES = reference_posteriors()
QUICK = "forearm-glass"

STANDARD_ERRORS = 4.5
"""Of a comparison; that one of 200 is beyond them by chance has probability 0.0014."""


def test_they_meet_the_quality_that_they_state() -> None:
    assert {QUICK} <= set(REFERENCES) <= set(shipped_names("models"))
    assert FILE.stat().st_size < 200_000
    for name, entry in REFERENCES.items():
        assert len(entry["seeds"]) == len(SEEDS)
        for label, found in entry["parameters"].items():
            assert found["effective_draws"] >= len(SEEDS) * EACH, f"{name}: {label}"
            assert found["r_hat"] <= 1.01, f"{name}: {label}"


def fitted(name: str, seed: int, ess: float) -> Fit:
    entry, problem = REFERENCES[name], sb.load_problem(name)
    # a change of model, prior or data asks for new references
    assert problem.data_fingerprint == entry["data_fingerprint"]
    assert problem.fingerprint == entry["fingerprint"], (
        f"{name} is another model now: python tests/inference/reference_posteriors.py {name}"
    )
    fit = sb.sample(problem, seed=seed, ess=ess)
    assert fit.converged
    return fit


def disagreements(fit: Fit) -> list[str]:
    """What of a fresh fit is further from the reference than Monte Carlo errors allow."""
    entry, found = REFERENCES[fit.name], []
    for size, (label, known) in zip(effective(fit), entry["parameters"].items(), strict=True):
        draws = fit.draws(label)
        independent = min(size, len(draws))
        for text, quantile in known["quantiles"].items():
            p = float(text)
            error = np.sqrt(p * (1 - p) * (1 / independent + 1 / known["effective_draws"]))
            score = (np.mean(draws < quantile["value"]) - p) / error
            if abs(score) > STANDARD_ERRORS:
                found.append(f"{label}, {p:.0%} quantile: {score:.1f} standard errors")
    evidence, reference = fit.provenance["sampling"]["log_evidence"], entry["log_evidence"]
    if evidence is not None and reference is not None:
        score = (evidence[0] - reference["value"]) / np.hypot(evidence[1], reference["error"])
        if abs(score) > STANDARD_ERRORS:
            found.append(f"ln Z: {score:.1f} standard errors")
    return found


@pytest.fixture(scope="module")
def quick() -> Fit:
    return fitted(QUICK, seed=7, ess=400)


def test_a_fresh_fit_agrees(quick: Fit) -> None:
    assert not disagreements(quick)


def test_a_wrong_reference_is_seen(quick: Fit, monkeypatch: pytest.MonkeyPatch) -> None:
    known = REFERENCES[QUICK]["parameters"]["frictional_shear_stress"]["quantiles"]["0.5"]
    # the posterior is about a factor 1.5 wide either way: 15 % is a third of its width
    monkeypatch.setitem(known, "value", 1.15 * known["value"])
    assert len(disagreements(quick)) == 1


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(REFERENCES))
def test_fresh_fits_of_all_agree(name: str) -> None:
    assert not disagreements(fitted(name, seed=8, ess=2000))
