"""Coordinates in which noise with a memory is no ridge."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.problem import Problem
from skinbayes.statistics.innovations import InnovationTransform
from skinbayes.statistics.transforms import VectorTransform


def made(noise: dict[str, Any], **tables: Any) -> Problem:
    """Twelve rows in time of four people."""
    rng = np.random.default_rng(1)
    return sb.build_problem(
        "constant",
        {
            "person": [*"aaabbbcccddd"],
            "time [s]": 2.0 * np.arange(12),
            "friction_coefficient [1]": np.exp(0.1 * rng.normal(size=12)),
        },
        parameters={"typical_friction_coefficient": {"loguniform": [0.1, 10.0]}},
        noise={"family": "lognormal", **noise},
        **tables,
    )


WEAK = {"half_normal": 0.2}
CASES: tuple[tuple[dict[str, Any], dict[str, Any]], ...] = (
    ({"noise_scale": WEAK, "correlation": {"along": "time"}}, {}),
    ({"noise_scale": {"uniform": [0.0, 0.5]}, "correlation": {"along": "time", "drift": 0.1}}, {}),
    ({"noise_scale": WEAK, "correlation": {"along": "time", "independent": {"uniform": [0, 1]}}}, {}),
    ({"noise_scale": WEAK, "correlation": {"along": "time", "independent": 0.3}}, {}),
    (
        {"noise_scale": {"by": "person", **dict.fromkeys("abcd", WEAK)}, "correlation": {"along": "time"}},
        {"groups": {"person": {"scale": WEAK}}},
    ),
)


@pytest.mark.parametrize(("noise", "tables"), CASES)
def test_there_and_back_with_the_jacobian_of_differences(
    noise: dict[str, Any], tables: dict[str, Any]
) -> None:
    problem = made(noise, **tables)
    transform = pickle.loads(pickle.dumps(problem.target().transform))
    assert isinstance(transform, InnovationTransform)
    theta = problem.draw_prior(np.random.default_rng(2), 6)
    place = transform.forward(theta)
    np.testing.assert_allclose(transform.inverse(place), theta, rtol=1e-9)
    moves = 1e-5 * np.eye(problem.dimension)
    for row, x, claimed in zip(place, theta, transform.log_jacobian(place), strict=True):
        slopes = (transform.inverse(row + moves) - transform.inverse(row - moves)) / 2e-5 / x
        assert np.log(abs(np.linalg.det(slopes))) + np.log(x).sum() == pytest.approx(claimed, abs=1e-6)


def test_the_coordinate_is_the_standard_deviation_of_what_is_new() -> None:
    """Differences of a long simulated series less its memory, against the coordinate; error of a standard deviation of 40,000."""
    problem = made({"noise_scale": WEAK, "correlation": {"along": "time"}})
    (memory,) = problem.target().transform.memories
    scale, length = 0.3, 4.0
    place = problem.target().transform.forward(np.array([[1.0, scale, length]]))
    rho, rng = np.exp(-memory.gap / length), np.random.default_rng(3)
    row = rng.normal(size=40_000)
    following = rho * row + np.sqrt(1.0 - rho**2) * rng.normal(size=row.size)
    assert np.corrcoef(row, following)[0, 1] == pytest.approx(rho, abs=0.01)
    new = scale * (following - rho * row)
    assert np.exp(place[0, 1]) == pytest.approx(new.std(), rel=0.015)


def test_without_a_memory_nothing_changes() -> None:
    for noise in ({"noise_scale": WEAK}, {"noise_scale": 0.1, "correlation": {"along": "time"}}):
        problem = made(noise)
        usual = VectorTransform.for_supports([p.prior.support for p in problem.free if p.prior])
        assert problem.target().transform == usual


def test_impossible_scales_are_impossible() -> None:
    problem = made({"noise_scale": {"uniform": [0.0, 0.5]}, "correlation": {"along": "time"}})
    target = problem.target()
    place = target.transform.forward(np.array([[1.0, 0.4, 5.0]]))
    assert np.isfinite(target.log_density(place))
    assert target.log_density(place + np.array([0.0, 1.0, 0.0])) == -np.inf
