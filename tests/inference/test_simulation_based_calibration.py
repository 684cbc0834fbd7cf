"""Calibration finds what is wrong, passes what is right, counts what fails, and gives the same numbers however it is run.

Right pipelines are doubted with probability 0.05 each; seeds are those of the first try.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from exact_engines import FromPrior, constant

import skinbayes as sb
from skinbayes.calibration import Calibration
from skinbayes.calibration.directory import SIMULATIONS
from skinbayes.errors import FingerprintMismatch, InputError, MachineError, RepairWarning
from skinbayes.problem.simulated import draw_possible, with_data

NAME = "typical_friction_coefficient"


@pytest.fixture(scope="module")
def right() -> Calibration:
    found = sb.calibrate(constant(), simulations=60, seed=3, engine=FromPrior())
    assert isinstance(found, Calibration)
    return found


def test_a_right_pipeline_passes(right: Calibration) -> None:
    assert right.passed()
    assert right.failed == 0
    assert "Nothing speaks against calibration in 60 simulations" in right.sentence()
    for level in (0.5, 0.9):
        hits, count, p = right.coverage(NAME, level)
        assert count == 60
        assert p > 1e-3, f"{hits} of 60 in the {level:.0%} interval"
    scores, contraction = right.recovery(NAME)
    assert abs(scores.mean()) < 3.3 / np.sqrt(60)
    assert 0.6 < contraction.mean() < 1.0  # two data, width 0.106, of a prior of width 0.289
    # both ways to ln Z have errors of about 2 %; 60 scores scatter about 1 by 0.09
    assert 0.7 < right.evidence_scores().std() < 1.3


def test_noise_taken_half_as_wide_is_found() -> None:
    found = sb.calibrate(constant(), simulations=40, seed=3, engine=FromPrior(power=4.0))
    assert not found.passed()
    assert "Not calibrated" in found.sentence()
    hits, count, p = found.coverage(NAME, 0.9)
    assert p < 1e-3, f"{hits} of {count}"


def test_a_wrong_prior_is_found() -> None:
    # on the unbounded scale; the data move the posterior back, so that it takes a steep one
    found = sb.calibrate(constant(), simulations=40, seed=3, engine=FromPrior(slope=3.0))
    assert found.p_value(NAME) < 1e-3
    # all to one side
    assert found.levels(NAME).mean() < 0.4


def test_fits_that_fail_are_counted_and_shown() -> None:
    found = sb.calibrate(constant(), simulations=15, seed=3, engine=FromPrior(broken=3, unfinished=2))
    broken = sum(found.errors.values())
    unfinished = sum(not one.converged and bool(one.ranks) for one in found.simulations)
    assert broken > 0
    assert unfinished > 0
    assert found.failed == broken + unfinished
    assert list(found.errors) == ["RuntimeError: no such posterior"]
    assert len(found.ranks(NAME)) == 15 - broken
    assert len(found.ranks(NAME, converged_only=True)) == 15 - broken - unfinished
    document = found.to_dict()
    assert (document["failed"], document["not_converged"]) == (broken + unfinished, unfinished)
    assert f"{unfinished} did not converge and are counted in" in found.sentence()
    assert f"{broken} ended in an error" in found.sentence()


def test_nothing_but_errors_is_no_pass() -> None:
    found = sb.calibrate(constant(), simulations=2, engine=FromPrior(broken=1))
    assert not found.passed()
    assert found.sentence().startswith("None of 2 fits")
    json.dumps(found.to_dict(), allow_nan=False)


def same(first: Calibration, second: Calibration) -> None:
    one, other = ([replace(s, seconds=0.0) for s in c.simulations] for c in (first, second))
    assert one == other


def test_it_goes_on_where_it_was_and_shows_damage(right: Calibration, tmp_path: Path) -> None:
    run = tmp_path / "run"

    def some(count: int) -> Calibration:
        found = sb.calibrate(constant(), simulations=count, seed=3, engine=FromPrior(), directory=run)
        assert isinstance(found, Calibration)
        return found

    some(3)
    lines = (run / SIMULATIONS).read_bytes().splitlines(keepends=True)
    assert len(lines) == 3
    # killed while it wrote the third line, and a number changed in the second
    (run / SIMULATIONS).write_bytes(lines[0] + lines[1].replace(b'"again": 0', b'"again": 1') + lines[2][:50])
    with pytest.warns(RepairWarning, match="2 of 3 lines"):
        some(2)
    longer = some(4)
    assert len((run / SIMULATIONS).read_bytes().splitlines()) == 4
    same(longer, replace(right, simulations=right.simulations[:4]))
    with pytest.raises(FingerprintMismatch, match="other seed"):
        sb.calibrate(constant(), simulations=1, seed=4, engine=FromPrior(), directory=run)
    with pytest.raises(FingerprintMismatch, match="fingerprints"):
        sb.calibrate(constant(0.5), simulations=1, seed=3, engine=FromPrior(), directory=run)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("years of work")
    with pytest.raises(InputError, match=r"holds thesis\.txt"):
        sb.calibrate(constant(), simulations=1, engine=FromPrior(), directory=tmp_path / "mine")


def test_two_processes_give_the_same_numbers(right: Calibration) -> None:
    found = sb.calibrate(constant(), simulations=4, seed=3, engine=FromPrior(), cores=2)
    assert isinstance(found, Calibration)
    same(found, replace(right, simulations=right.simulations[:4]))


def test_a_machine_that_fails_is_no_failing_fit() -> None:
    class Full(FromPrior):
        def run(self, *arguments: object) -> None:  # type: ignore[override]
            raise MachineError("no memory")

    with pytest.raises(MachineError, match="no memory"):
        sb.calibrate(constant(), simulations=1, engine=Full())


def test_the_spread_of_ln_stays_with_simulated_data() -> None:
    problem = sb.build_problem(
        "constant",
        {"friction_coefficient [1]": [0.5, 1.0], "friction_coefficient_standard_deviation [1]": [0.05, 0.2]},
        parameters={"typical_friction_coefficient": {"uniform": [0.4, 1.4]}},
        noise={"family": "lognormal", "noise_scale": 0.1},
        spread="use",
    )
    theta = problem.prior_medians()
    changed = with_data(problem, np.array([1.0, 0.5]))
    assert changed.noise_width(theta) == pytest.approx(problem.noise_width(theta))
    assert problem.noise_width(theta) == pytest.approx(np.hypot(0.1, [0.1, 0.2]))
    theta = draw_possible(problem, np.random.default_rng(1))
    assert theta is not None
    assert theta.shape == (1,)


def test_models_of_other_data_are_refused() -> None:
    other = sb.build_problem(
        "constant", {"friction_coefficient [1]": [0.5]}, parameters={NAME: {"uniform": [0, 1]}},
        noise={"family": "gaussian", "noise_scale": 0.1}, name="other",
    )  # fmt: skip
    with pytest.raises(InputError, match="'other' is not of the same data as 'constant'"):
        sb.calibrate(constant(), other, simulations=1)


def test_odds_of_two_models() -> None:
    # the wide prior pays for its width unless the data lie beyond the narrow one
    models = constant(), constant(3.0, "wide")
    found = sb.calibrate(*models, simulations=60, seed=2, engine=FromPrior())
    assert found.passed(), found.sentence()
    assert found.failed == 0
    assert sum(count for *_, count, _ in found.bins()) == 60
    # closed form: with noise far narrower than the priors, Z1/Z2 is 3 where the data fit the narrow prior
    p, second = found.probabilities()
    assert np.median(p[~second]) == pytest.approx(0.25, abs=0.03)
    wrong = replace(
        found,
        simulations=tuple(
            replace(s, fits=[replace(f, log_evidence=(f.log_evidence[0] - 3.0 * i, 0.0)) for i, f in enumerate(s.fits)])
            for s in found.simulations
        ),
    )  # fmt: skip
    assert not wrong.passed()
    assert "are wrong" in wrong.sentence()
