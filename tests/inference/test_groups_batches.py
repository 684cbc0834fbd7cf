"""Crossed group effects: a batch is its vectors one by one, and impossible vectors touch no other."""

from math import inf, nan

import numpy as np
import pytest
from crossed_designs import Case, balanced_labels, balanced_log_density, random_labels

LABELS = {
    "balanced": balanced_labels(11, 15),
    "one column": random_labels(np.random.default_rng(1), 37, (6,)),
    "unbalanced": random_labels(np.random.default_rng(2), 90, (7, 13)),
    "three columns": random_labels(np.random.default_rng(3), 50, (4, 9, 2)),
    "one level": random_labels(np.random.default_rng(4), 5, (1, 1)),
}


def evaluations(case, block):
    """Everything that is computed for a batch, as functions of its arrays."""
    groups = case.groups
    return {
        "joint": groups.log_density,
        "pointwise": groups.log_density_pointwise,
        "left out": lambda *given: groups.log_density_left_out(*given, block),
        "mean": lambda *given: groups.effects_given(*given)[0],
        "covariance": lambda *given: groups.effects_given(*given)[1],
    }


@pytest.mark.parametrize("name", LABELS)
@pytest.mark.parametrize("equal_widths", [True, False])
def test_a_batch_is_its_vectors_to_the_last_bit(name, equal_widths):
    rng = np.random.default_rng(10)
    case = Case(rng, LABELS[name], batch=37, equal_widths=equal_widths)
    case.scales[5] = 0.0
    full = np.array(np.broadcast_to(case.width, case.residual.shape))
    block = rng.integers(0, 4, case.groups.n_rows)
    for evaluate in evaluations(case, block).values():
        together = evaluate(*case.arguments)
        apart = [evaluate(*(a[b : b + 1].copy() for a in case.arguments))[0] for b in range(37)]
        np.testing.assert_array_equal(together, apart)
        np.testing.assert_array_equal(together, evaluate(case.residual, full, case.scales))
        # other memory layouts, other places in the batch
        turned = evaluate(*(np.asfortranarray(a[::-1]) for a in case.arguments))
        np.testing.assert_array_equal(together, turned[::-1])


@pytest.mark.parametrize("batch", [0, 1, 127, 128, 129, 300])
def test_large_and_empty_batches_are_worked_on_in_parts(batch):
    case = Case(np.random.default_rng(11), LABELS["unbalanced"], batch=batch)
    found = case.groups.log_density(*case.arguments)
    assert found.shape == (batch,)
    apart = [case.groups.log_density(*(a[b : b + 1] for a in case.arguments))[0] for b in range(batch)]
    np.testing.assert_array_equal(found, apart)


@pytest.mark.parametrize("name", LABELS)
def test_draws_of_a_batch_are_draws_one_by_one(name):
    case = Case(np.random.default_rng(10), LABELS[name], batch=9)
    together = case.groups.draw_effects(np.random.default_rng(1), *case.arguments)
    rng = np.random.default_rng(1)
    apart = [case.groups.draw_effects(rng, *(a[b : b + 1] for a in case.arguments))[0] for b in range(9)]
    np.testing.assert_array_equal(together, apart)
    np.testing.assert_array_equal(
        case.groups.at_rows(together), [case.groups.at_rows(one[None])[0] for one in together]
    )


@pytest.mark.parametrize("name", LABELS)
@pytest.mark.parametrize(
    ("place", "value"),
    [(0, nan), (0, inf), (0, -inf), (1, 0.0), (1, -0.1), (1, nan), (1, inf), (2, -0.1), (2, nan), (2, inf)],
)
def test_impossible_vectors_get_minus_infinity_alone(name, place, value):
    case = Case(np.random.default_rng(12), LABELS[name], batch=4)
    block = np.arange(case.groups.n_rows) % 2
    arguments = [a.copy() for a in case.arguments]
    arguments[place][2, -1] = value
    good = [0, 1, 3]
    for kind, evaluate in evaluations(case, block).items():
        found, untouched = evaluate(*arguments), evaluate(*case.arguments)
        np.testing.assert_array_equal(found[good], untouched[good])
        assert np.isfinite(found[good]).all()
        if kind in ("mean", "covariance"):
            assert np.isnan(found[2]).all()
        else:
            assert (found[2] == -inf).all()
    drawn = case.groups.draw_effects(np.random.default_rng(1), *arguments)
    assert np.isnan(drawn[2]).all() and np.isfinite(drawn[good]).all()


@pytest.mark.parametrize("name", LABELS)
@pytest.mark.parametrize("scale", [1e-300, 1e-30, 1e3, 1e8, 1e12, 1e100, 1e160, 1e308])
@pytest.mark.parametrize("width", [1e-300, 1e-160, 1e-8, 1.0, 1e8, 1e160, 1e308])
@pytest.mark.parametrize("size", [1.0, 1e160])
def test_extreme_numbers_give_a_number_or_minus_infinity(name, scale, width, size):
    case = Case(np.random.default_rng(13), LABELS[name], batch=2)
    residual = case.residual.copy()
    residual[0] *= size
    widths = case.width.copy()
    widths[0] = width
    scales = case.scales.copy()
    scales[0] = scale
    block = np.arange(case.groups.n_rows) % 2
    for kind, evaluate in evaluations(case, block).items():
        found = evaluate(residual, widths, scales)
        np.testing.assert_array_equal(found[1], evaluate(*case.arguments)[1])
        if kind in ("joint", "pointwise", "left out"):
            assert not np.isnan(found).any() and (found < inf).all()


def test_rounding_grows_as_the_square_of_the_scale():
    """What the documentation says of effects much wider than the scatter, against the closed form of a balanced table."""
    rng = np.random.default_rng(14)
    groups = Case(rng, LABELS["balanced"]).groups
    for ratio, tolerance in ((1e2, 1e-10), (1e3, 1e-8), (1e4, 1e-6)):
        first, second = ratio * rng.uniform(0.5, 1.0, (2, 20))
        table = first[:, None, None] * rng.normal(size=(20, 11, 1)) + rng.normal(size=(20, 11, 15))
        table += second[:, None, None] * rng.normal(size=(20, 1, 15))
        expected = balanced_log_density(table, 1.0, first, second)
        found = groups.log_density(table.reshape(20, -1), 1.0, np.stack([first, second], axis=1))
        np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance)
