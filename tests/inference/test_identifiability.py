"""Findings on synthetic problems whose structure is known, and on ones where a single draw would mislead."""

import json
from math import inf

import numpy as np
import pytest

from skinbayes.diagnose import identify
from skinbayes.diagnose.combinations import decompose, nice, simplest_basis
from skinbayes.diagnose.sensitivities import sensitivities
from skinbayes.errors import InputError

NAMES = ("a", "b", "c", "d", "e")


def positive_draws(count=60, dimension=5, spread=0.6, seed=1):
    return np.exp(spread * np.random.default_rng(seed).normal(size=(count, dimension)))


def columns(*functions):
    """Predictions from functions of (a, b, c, d, e)."""
    return lambda theta: np.stack([np.log(function(*theta.T)) for function in functions], axis=1)


def text_of(found):
    return [combination.text for combination in found.joint.combinations]


@pytest.mark.parametrize(
    ("function", "text", "exponents"),
    [
        (lambda a, b, c, d, e: a / b, "a / b", {"a": 1, "b": -1}),
        (lambda a, b, c, d, e: a / (b * c**2), "a / (b · c^2)", {"a": 1, "b": -1, "c": -2}),
        (lambda a, b, c, d, e: (a / (b * c**2)) ** 3, "a / (b · c^2)", {"a": 1, "b": -1, "c": -2}),
        (lambda a, b, c, d, e: 1 / (d * e), "d · e", {"d": 1, "e": 1}),
        (lambda a, b, c, d, e: a * np.sqrt(b), "a^2 · b", {"a": 2, "b": 1}),
        (lambda a, b, c, d, e: a**2 * c ** (1 / 3), None, None),
        (lambda a, b, c, d, e: a * b**0.14, "a · b^0.14", {"a": 1, "b": 0.14}),
        (lambda a, b, c, d, e: c**5, "c", {"c": 1}),
    ],
)
def test_one_power_law_is_named(function, text, exponents):
    found = identify(NAMES, columns(function), positive_draws(), 0.1)
    assert found.joint.directions == 1
    (combination,) = found.joint.combinations
    if exponents is None:  # a sixth is not a simple fraction: a cube or the number itself may be written
        assert combination.exponents["a"] / combination.exponents["c"] == pytest.approx(6.0, rel=1e-2)
        return
    assert combination.text == text
    assert combination.exponents == pytest.approx(exponents, abs=1e-4)
    assert combination.exact
    assert combination.constant
    assert set(found.absent) == set(NAMES) - set(exponents)


def test_spread_ratios_are_those_of_the_gaussian_problem():
    """Closed form: one datum of ln(a/b) with noise n, prior spreads s: precision of the difference adds up."""
    spread, noise = 0.6, 0.2
    found = identify(
        ("a", "b"),
        columns2(lambda a, b: a / b),
        positive_draws(60, 2),
        noise,
        prior_standard_deviation=spread,
    )
    ratio = 1.0 / np.sqrt(1.0 + 2.0 * spread**2 / noise**2)
    assert found.joint.spread_ratios[0] == pytest.approx(ratio, rel=1e-6)
    assert found.joint.combinations[0].spread_ratio == pytest.approx(ratio, rel=1e-6)
    assert found.spread_ratios["a"] == pytest.approx(np.sqrt(0.5 + 0.5 * ratio**2), rel=1e-6)


def columns2(*functions):
    return lambda theta: np.stack([np.log(function(*theta.T)) for function in functions], axis=1)


def test_slopes_agree_with_derivatives_by_hand():
    points = positive_draws(7, 2)

    def predict(theta):
        return np.stack([np.sin(theta[:, 0]) * theta[:, 1], theta[:, 0] ** 2 + theta[:, 1]], axis=1)

    found = sensitivities(("x", "y"), predict, points, (False, True), np.array([0.1, 0.1]))
    x, y = points.T
    expected = np.stack(
        [np.stack([np.cos(x) * y, np.sin(x) * y], axis=-1), np.stack([2 * x, y], axis=-1)], axis=1
    )
    np.testing.assert_allclose(found.slopes, expected, rtol=1e-6, atol=1e-6)  # step 1e-3 squared


def test_groups_that_share_a_parameter():
    """The shape of a friction problem: one row a/b, another a/(c·d)."""
    found = identify(
        NAMES,
        columns(lambda a, b, c, d, e: a / b, lambda a, b, c, d, e: 2 * a / (c * d)),
        positive_draws(),
        0.1,
        groups={"dry": [0], "wet": [1]},
    )
    dry, wet, joint = found.groups
    assert [group.label for group in found.groups] == ["dry", "wet", "all rows"]
    assert dry.combinations[0].text == "a / b"
    assert wet.combinations[0].text == "a / (c · d)"
    assert dry.silent == ("c", "d", "e")
    assert wet.silent == ("b", "e")
    assert [combination.text for combination in joint.combinations] == ["a / b", "a / (c · d)"]
    assert joint.directions == 2
    assert found.absent == ("e",)
    texts = [freedom.text for freedom in found.freedoms]
    assert "Raising c by 10 % and lowering d by 9.1 %" in texts
    assert "Raising a, b and c by 10 % each" in texts
    assert len(texts) == 2  # four influential parameters less two directions
    assert all(freedom.exact and freedom.constant for freedom in found.freedoms)
    words = " ".join(found.sentences())
    assert "only the combination a / b is determined" in words
    assert "2 of 5 independent directions" in words
    assert "Only the prior speaks about e, which enters no prediction." in words


def test_said_changes_really_change_nothing():
    predict = columns(
        lambda a, b, c, d, e: a**2 / (b * np.sqrt(c)),
        lambda a, b, c, d, e: d * c**1.5 / a,
        lambda a, b, c, d, e: a**2 / (b * np.sqrt(c)) * 3,
    )
    found = identify(NAMES, predict, positive_draws(), 0.05)
    assert found.freedoms
    base = positive_draws(20, seed=9)
    for freedom in found.freedoms:
        moved = base.copy()
        for name, amount in freedom.changes.items():
            moved[:, NAMES.index(name)] *= 1.0 + amount
        np.testing.assert_allclose(
            predict(moved), predict(base), atol=1e-5
        )  # powers: exact beyond first order


def test_everything_identified():
    found = identify(
        ("a", "b"), columns2(lambda a, b: a * b, lambda a, b: a / b), positive_draws(60, 2), 0.05
    )
    assert text_of(found) == ["a", "b"]
    assert found.freedoms == ()
    assert found.only_prior == ()
    assert "Together the data inform all 2 parameters." in found.sentences()


def test_noise_decides_what_is_informed():
    predict = columns2(lambda a, b: a * b, lambda a, b: a * b * b**0.05)
    draws = positive_draws(60, 2)
    assert identify(("a", "b"), predict, draws, 1e-3).joint.directions == 2
    loud = identify(("a", "b"), predict, draws, 0.1)
    assert loud.joint.directions == 1
    assert loud.joint.combinations[0].text == "a · b"
    assert not loud.freedoms[0].exact
    assert "less than their noise" in loud.freedoms[0].sentence()
    deaf = identify(("a", "b"), predict, draws, 50.0)
    assert deaf.joint.directions == 0
    assert deaf.only_prior == ("a", "b")
    assert deaf.absent == ()
    assert "tells next to nothing" in deaf.sentences()[0]
    assert "their effect is below the noise" in deaf.sentences()[-1]


def test_weak_parameters_are_dropped_and_mentioned():
    found = identify(NAMES, columns(lambda a, b, c, d, e: a / b * c**0.02), positive_draws(), 0.01)
    (combination,) = found.joint.combinations
    assert combination.text == "a / b"
    assert combination.weak == ("c",)
    assert not combination.exact
    assert any("a / b (approximately)" in line for line in found.sentences())
    assert any("c plays a small part" in line for line in found.sentences())


def test_sum_has_exponents_that_vary():
    found = identify(("a", "b"), columns2(lambda a, b: a + b), positive_draws(60, 2), 0.05)
    (combination,) = found.joint.combinations
    assert found.joint.directions == 1
    assert not combination.constant
    low, high = combination.ranges["b"]  # b/a over the prior: e^(±1.645 · 0.6 · √2) without sampling error
    assert low == pytest.approx(np.exp(-1.4), rel=0.5)
    assert high == pytest.approx(np.exp(1.4), rel=0.5)
    assert "exponents vary over the prior" in found.sentences()[0]
    assert "in a proportion that varies over the prior" in found.freedoms[0].sentence()


def test_one_draw_would_mislead_where_a_regime_changes():
    """min(a, b): at any one draw a single parameter acts, and the other one seems to enter nothing."""
    predict = columns2(lambda a, b: np.minimum(a, b))
    draws = positive_draws(60, 2)
    one = identify(("a", "b"), predict, draws[:1], 0.05, prior_standard_deviation=0.6)
    assert len(one.joint.combinations[0].exponents) == 1
    assert len(one.absent) == 1
    many = identify(("a", "b"), predict, draws, 0.05)
    assert many.absent == ()
    assert many.only_prior == ()
    (combination,) = many.joint.combinations
    assert combination.ranges == {"a": (0.0, pytest.approx(1.0)), "b": (0.0, pytest.approx(1.0))}
    assert not combination.constant


def test_one_draw_would_mislead_where_the_slope_vanishes():
    """(ln b)² is flat at its bottom: a draw there says b does nothing."""

    def predict(theta):
        return np.log(theta[:, :1]) + 2.0 * np.log(theta[:, 1:]) ** 2

    draws = positive_draws(60, 2)
    draws[0, 1] = 1.0
    one = identify(("a", "b"), predict, draws[:1], 0.05, prior_standard_deviation=0.6)
    assert one.absent == ("b",)
    assert identify(("a", "b"), predict, draws, 0.05).only_prior == ()


def test_number_of_directions_may_depend_on_the_draw():
    predict = columns2(lambda a, b: a, lambda a, b: 1.0 + 0.1 * b**4)
    found = identify(("a", "b"), predict, positive_draws(60, 2), 0.1)
    assert found.joint.directions_range == (1, 2)
    assert any("between 1 and 2 combinations" in line for line in found.sentences())


def test_derived_quantity_replaces_its_parameters():
    """f = b·c^0.7 is offered, a/f is identified; g = c·d is offered too but does not act alike."""

    def derived(theta):
        a, b, c, d, _ = theta.T
        return {"f": b * c**0.7, "g": c * d, "answer": a / (b * c**0.7) * d, "constant": 0 * a + 2.0}

    found = identify(
        NAMES, columns(lambda a, b, c, d, e: a / (b * c**0.7) * d), positive_draws(), 0.1, derived=derived
    )
    (combination,) = found.joint.combinations
    assert combination.text == "a · d / f"
    assert combination.exponents == pytest.approx({"a": 1, "d": 1, "f": -1}, abs=1e-4)
    assert combination.exact


def test_derived_quantity_with_varying_inner_exponents():
    """f = b + c: exponents of b and c vary, those of a and f do not."""
    found = identify(
        NAMES,
        columns(lambda a, b, c, d, e: a / (b + c) ** 2),
        positive_draws(),
        0.05,
        derived=lambda theta: {"f": (theta[:, 1] + theta[:, 2])[:, None]},
    )
    (combination,) = found.joint.combinations
    assert combination.text == "a / f^2"
    assert combination.constant


def test_derived_quantity_of_each_row():
    loads = np.array([1.0, 2.0, 5.0])

    def predict(theta):
        return np.log(theta[:, :1] / (theta[:, 1:2] + theta[:, 2:3] * loads))

    def derived(theta):
        return {"f": theta[:, 1:2] + theta[:, 2:3] * loads}

    found = identify(
        ("a", "b", "c"), predict, positive_draws(60, 3), 0.05, derived=derived, groups={"first": [0]}
    )
    assert found.groups[0].combinations[0].text == "a / f"


def test_derived_quantity_of_one_parameter_is_mentioned():
    found = identify(
        NAMES,
        columns(lambda a, b, c, d, e: a / b),
        positive_draws(),
        0.1,
        derived=lambda theta: {"slope": 3.0 * theta[:, 1], "other": theta[:, 4] ** 2},
    )
    assert [(item.derived, item.parameter, item.power) for item in found.equivalents] == [("slope", "b", 1.0)]
    words = found.equivalents[0].sentence()
    assert "only b moves slope, which is proportional to b" in words
    assert words.endswith("said to determine a / slope.")


def test_derived_quantity_that_is_a_power_of_one_parameter():
    found = identify(
        NAMES,
        columns(lambda a, b, c, d, e: a / b),
        positive_draws(),
        0.1,
        derived=lambda theta: {"square": theta[:, 1] ** 2},
    )
    (item,) = found.equivalents
    assert item.power == 2.0
    assert item.reads == ("a / square^(1/2)",)


def test_parameters_that_are_not_positive_enter_by_themselves():
    rng = np.random.default_rng(2)
    draws = np.column_stack([np.exp(0.5 * rng.normal(size=50)), rng.normal(size=50)])

    def predict(theta):
        return np.log(theta[:, :1]) + 0.3 * theta[:, 1:]

    found = identify(("a", "x"), predict, draws, 0.05)
    (combination,) = found.joint.combinations
    assert combination.text == "a with x"
    assert combination.exponents == pytest.approx({"a": 1.0, "x": 0.3}, abs=1e-6)
    (freedom,) = found.freedoms
    assert freedom.changes == pytest.approx({"a": 0.1, "x": -np.log(1.1) / 0.3}, rel=1e-6)
    assert "lowering x by 0.32" in freedom.text


def test_plain_predictions_work_as_well():
    found = identify(("a", "b"), lambda t: t[:, :1] / t[:, 1:], positive_draws(60, 2), 0.05)
    assert text_of(found) == ["a / b"]


def test_failed_draws_are_counted():
    draws = positive_draws(40, 2)
    draws[:3, 0] = 1e6

    def predict(theta):
        return np.where(theta[:, :1] > 1e5, -inf, np.log(theta[:, :1]))

    found = identify(("a", "b"), predict, draws, 0.1, prior_standard_deviation=0.6)
    assert (found.points, found.failed_points) == (37, 3)
    assert found.sentences()[-1] == "3 of 40 prior draws had no finite prediction."
    with pytest.raises(InputError, match="No prior draw"):
        identify(("a", "b"), lambda t: np.full((len(t), 1), np.nan), draws, 0.1)


def test_refusals():
    draws = positive_draws(10, 2)
    predict = columns2(lambda a, b: a)
    with pytest.raises(InputError, match="expected \\(draws, 3\\)"):
        identify(("a", "b", "c"), predict, draws, 0.1)
    with pytest.raises(InputError, match="noise of each row"):
        identify(("a", "b"), predict, draws, 0.0)
    draws[:, 1] = 2.0
    with pytest.raises(InputError, match="prior of b has standard deviation 0"):
        identify(("a", "b"), predict, draws, 0.1)


def test_findings_go_to_json():
    found = identify(NAMES, columns(lambda a, b, c, d, e: a / b), positive_draws(), 0.1, groups={"one": [0]})
    document = json.loads(json.dumps(found.as_dict()))
    assert document["groups"][-1]["combinations"][0]["exponents"] == {"a": 1.0, "b": -1.0}
    assert len(document["groups"]) == 1  # a group of all rows is not repeated


def test_many_rows_have_the_singular_values_of_the_full_matrix():
    matrix = np.random.default_rng(3).normal(size=(4, 200, 5))
    np.testing.assert_allclose(decompose(matrix).values, np.linalg.svd(matrix, compute_uv=False), rtol=1e-10)


def test_simplest_basis_spans_the_space():
    """Random rotations of a sparse basis: the sparse vectors come back."""
    rng = np.random.default_rng(4)
    sparse = np.array([[1.0, -1, 0, 0, 0, 0], [0, 0, 1, 0.5, 0, 0], [0, 0, 0, 0, 1, -1]])
    bases = np.stack([np.linalg.qr((rng.normal(size=(3, 3)) @ sparse).T)[0].T for _ in range(10)])
    found = simplest_basis(bases)
    assert len(found) == 3
    for vector, expected in zip(found, sparse, strict=True):
        np.testing.assert_allclose(vector, np.tile(expected, (10, 1)), atol=1e-9)


def test_nice_fractions():
    assert nice(np.full(9, 0.667)) == pytest.approx(2 / 3)
    assert nice(np.full(9, -2.02)) == -2.0
    assert nice(np.full(9, 0.14)) is None
    assert nice(np.array([0.9, 1.0, 1.1])) is None
    assert nice(np.zeros(3)) is None


def test_many_rows_use_fewer_draws():
    calls = []

    def predict(theta):
        calls.append(len(theta))
        return np.log(theta[:, :1] / theta[:, 1:]) + np.zeros(60_000)

    found = identify(("a", "b"), predict, positive_draws(60, 2), 0.1)
    assert found.points == 8
    assert max(calls) == 16
    assert text_of(found) == ["a / b"]
