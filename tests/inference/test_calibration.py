"""The calibration of small models of skin by the whole pipeline: over the prior, the truth is a posterior draw like any other."""

from __future__ import annotations

from pathlib import Path

import pytest
from small_models import finger, student, three_parameters

import skinbayes as sb
from skinbayes.problem import Problem


def relative(folder: Path) -> Problem:
    """Normal scatter in proportion to the prediction, and a factor between model and truth."""
    return finger(
        folder,
        'frictional_shear_stress = { lognormal = ["10 MPa", 0.5] }\n'
        'young_modulus_layer = { uniform = ["3 MPa", "12 MPa"] }',
        'family = "relative"\nnoise_scale = { lognormal = [0.2, 0.3] }\ndiscrepancy_factor = { lognormal = [1.0, 0.1] }',
        "relative.toml",
    )


@pytest.mark.slow
@pytest.mark.parametrize("build", [three_parameters, student, relative])
def test_ranks_are_uniform_and_intervals_cover(build, tmp_path: Path) -> None:
    found = sb.calibrate(build(tmp_path), simulations=100, seed=31, ess=400, max_steps=6000)
    print(found)
    p = {name: found.p_value(name) for name in found.quantities}
    assert min(p.values()) > 1e-3, p
    for name in found.names:
        for level in (0.5, 0.9):
            hits, count, chance = found.coverage(name, level)
            assert chance > 1e-3, f"{name}: {hits} of {count} in the {level:.0%} interval"
    assert found.evidence_p_value() > 1e-3


def test_few_simulations(tmp_path: Path) -> None:
    found = sb.calibrate(three_parameters(tmp_path), simulations=4, seed=32, ess=200, max_steps=1000)
    # under calibration p values are uniform, of 4 quantities
    assert min(found.p_value(name) for name in found.quantities) > 1e-4
    assert found.failed == 0
