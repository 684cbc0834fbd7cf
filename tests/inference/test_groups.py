"""Crossed group effects against dense normal distributions, closed forms and limits."""

import pickle
from math import inf, nan

import numpy as np
import pytest
from crossed_designs import Case, balanced_labels, balanced_log_density, random_labels
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from skinbayes.errors import InputError
from skinbayes.statistics.groups import CrossedGroups

DESIGNS = [
    (6, (3,)),
    (9, (1,)),
    (12, (12, 2)),
    (25, (4, 7)),
    (40, (11, 5, 3)),
    (7, (20, 20)),
    (1, (1, 1)),
    (30, (2, 3, 4, 5)),
]
"""Rows and greatest number of levels of each column."""


@pytest.fixture(params=DESIGNS, ids=str)
def case(request):
    rows, counts = request.param
    rng = np.random.default_rng(rows)
    return Case(rng, random_labels(rng, rows, counts))


def nested_case():
    """Levels of the second column that each belong to one level of the first."""
    rng = np.random.default_rng(5)
    outer = rng.integers(0, 3, 24)
    inner = 10 * outer + rng.integers(0, 3, 24)
    return Case(rng, {"ward": outer.astype(str), "patient": inner.astype(str)})


def test_levels_in_order_of_appearance():
    groups = CrossedGroups.of_labels({"a": np.array(["z", "y", "z"]), "b": np.array(["p", "p", "q"])})
    assert groups.columns == ("a", "b")
    assert groups.levels == (("z", "y"), ("p", "q"))
    np.testing.assert_array_equal(groups.member, [[0, 1, 0], [2, 2, 3]])
    assert (groups.n_rows, groups.n_effects) == (3, 4)
    assert groups.effects_of("b") == slice(2, 4)


def test_joint_density_is_the_dense_normal(case):
    expected = [case.dense_log_density(b) for b in range(3)]
    np.testing.assert_allclose(case.groups.log_density(*case.arguments), expected, rtol=1e-11, atol=1e-11)


def test_nested_columns_and_equal_widths():
    nested = nested_case()
    assert len(nested.groups.levels[1]) > len(nested.groups.levels[0])
    for found in (nested, Case(np.random.default_rng(2), balanced_labels(4, 3), equal_widths=True)):
        expected = [found.dense_log_density(b) for b in range(3)]
        np.testing.assert_allclose(found.groups.log_density(*found.arguments), expected, rtol=1e-11)


def test_a_balanced_table_has_a_closed_form():
    case = Case(np.random.default_rng(3), balanced_labels(11, 15), batch=20)
    expected = balanced_log_density(case.residual.reshape(20, 11, 15), 0.3, *case.scales.T)
    found = case.groups.log_density(case.residual, 0.3, case.scales)
    np.testing.assert_allclose(found, expected, rtol=1e-13)


def test_each_row_left_out(case):
    found = case.groups.log_density_pointwise(*case.arguments)
    assert found.shape == case.residual.shape
    for b in range(3):
        for n in range(case.groups.n_rows):
            if case.groups.n_rows > 1:
                alone = np.arange(case.groups.n_rows) == n
                assert found[b, n] == pytest.approx(
                    case.conditional_log_density(b, alone), rel=1e-9, abs=1e-10
                )
    if case.groups.n_rows == 1:
        np.testing.assert_allclose(found[:, 0], case.groups.log_density(*case.arguments), rtol=1e-12)


def test_pointwise_is_leaving_blocks_of_one_row_out(case):
    each = case.groups.log_density_left_out(*case.arguments, np.arange(case.groups.n_rows))
    np.testing.assert_allclose(
        case.groups.log_density_pointwise(*case.arguments), each, rtol=1e-9, atol=1e-10
    )


@pytest.mark.parametrize("column", [0, 1])
def test_levels_left_out(column):
    """Whole levels: their own effect is known by its prior only, the others by the rest."""
    rng = np.random.default_rng(8)
    case = Case(rng, random_labels(rng, 30, (4, 6)))
    block = case.groups.member[column] - case.groups.member[column].min()
    found = case.groups.log_density_left_out(*case.arguments, block)
    assert found.shape == (3, len(case.groups.levels[column]))
    for b in range(3):
        for number in range(found.shape[1]):
            expected = case.conditional_log_density(b, block == number)
            assert found[b, number] == pytest.approx(expected, rel=1e-10, abs=1e-10)


def test_leaving_all_rows_out_is_the_joint_density_and_an_empty_block_is_certain(case):
    everything = np.ones(case.groups.n_rows, dtype=int)
    found = case.groups.log_density_left_out(*case.arguments, everything)
    np.testing.assert_array_equal(found[:, 0], 0.0)
    np.testing.assert_allclose(found[:, 1], case.groups.log_density(*case.arguments), rtol=1e-13)


def test_conditionals_in_sequence_multiply_to_the_joint_density():
    """ln p(r) = Σ ln p(block k | blocks before k), each from the design of the rows up to block k."""
    rng = np.random.default_rng(9)
    case = Case(rng, random_labels(rng, 24, (4, 5)))
    block = np.sort(rng.integers(0, 5, 24))
    total = 0.0
    for last in range(5):
        rows = block <= last
        groups = CrossedGroups.of_labels({name: values[rows] for name, values in case.labels.items()})
        residual, width = case.residual[:, rows], case.width[:, rows]
        total += groups.log_density_left_out(residual, width, case.scales, block[rows])[:, last]
    np.testing.assert_allclose(total, case.groups.log_density(*case.arguments), rtol=1e-11)


def test_effects_are_bayesian_linear_regression(case):
    mean, covariance = case.groups.effects_given(*case.arguments)
    incidence = case.incidence()
    for b in range(3):
        weight = 1.0 / np.broadcast_to(case.width[b], case.residual[b].shape) ** 2
        precision = np.diag(1.0 / case.prior_variance(b)) + (incidence.T * weight) @ incidence
        expected = np.linalg.inv(precision)
        np.testing.assert_allclose(covariance[b], expected, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(
            mean[b], expected @ incidence.T @ (weight * case.residual[b]), rtol=1e-9, atol=1e-12
        )
        np.testing.assert_array_equal(covariance[b], covariance[b].T)
        np.testing.assert_array_equal(case.groups.at_rows(mean)[b], (mean[b][case.groups.member]).sum(axis=0))


@pytest.mark.parametrize("counts", [(5,), (3, 5), (2, 4, 3)])
def test_draws_have_the_mean_and_covariance_of_the_posterior(counts):
    """Whitened draws are standard normal: mean, covariance (5 standard errors) and Kolmogorov–Smirnov."""
    rng = np.random.default_rng(11)
    case = Case(rng, random_labels(rng, 20, counts), batch=1)
    mean, covariance = case.groups.effects_given(*case.arguments)
    count = 20_000
    repeated = (np.repeat(values, count, axis=0) for values in case.arguments)
    drawn = case.groups.draw_effects(rng, *repeated)
    white = np.linalg.solve(np.linalg.cholesky(covariance[0]), (drawn - mean[0]).T)
    size = len(white)
    assert np.abs(white.mean(axis=1)).max() < 5 / np.sqrt(count)
    assert np.abs(white @ white.T / count - np.eye(size)).max() < 5 * np.sqrt(2 / count)
    assert min(stats.kstest(row, "norm").pvalue for row in white) > 1e-4


def test_new_effects_have_the_scale_of_their_column():
    groups = CrossedGroups.of_labels(balanced_labels(3, 2))
    scales = np.tile([[0.5, 2.0]], (20_000, 1))
    drawn = groups.draw_new_effects(np.random.default_rng(1), scales)
    np.testing.assert_allclose(drawn.std(axis=0), [0.5, 0.5, 0.5, 2.0, 2.0], rtol=5 / np.sqrt(2 * 20_000))
    assert np.abs(np.corrcoef(drawn.T) - np.eye(5)).max() < 5 / np.sqrt(20_000)
    bad = groups.draw_new_effects(np.random.default_rng(1), [[0.0, 1.0], [-1.0, 1.0], [nan, inf]])
    assert (bad[0, :3] == 0).all() and np.isfinite(bad[0]).all()
    np.testing.assert_array_equal(np.isnan(bad[1:]), [[True] * 3 + [False] * 2, [True] * 5])


def test_no_scale_is_no_effect_exactly(case):
    none = np.zeros_like(case.scales)
    width = np.broadcast_to(case.width, case.residual.shape)
    independent = stats.norm(0, width).logpdf(case.residual)
    found = case.groups.log_density(case.residual, case.width, none)
    np.testing.assert_allclose(found, independent.sum(axis=1), rtol=1e-13)
    found = case.groups.log_density_pointwise(case.residual, case.width, none)
    np.testing.assert_allclose(found, independent, rtol=1e-12)
    for array in case.groups.effects_given(case.residual, case.width, none):
        np.testing.assert_array_equal(array, 0.0)
    drawn = case.groups.draw_effects(np.random.default_rng(0), case.residual, case.width, none)
    np.testing.assert_array_equal(drawn, 0.0)


def test_a_column_without_scale_can_be_left_out():
    rng = np.random.default_rng(4)
    labels = random_labels(rng, 30, (7, 5))
    case = Case(rng, labels)
    alone = CrossedGroups.of_labels({"column1": labels["column1"]})
    scales = case.scales.copy()
    scales[:, 0] = 0.0
    np.testing.assert_allclose(
        case.groups.log_density(case.residual, case.width, scales),
        alone.log_density(case.residual, case.width, scales[:, 1:]),
        rtol=1e-13,
    )


def test_very_wide_effects_are_fixed_effects():
    """With s → ∞ the fit at the rows is weighted least squares on the levels, and differences of effects are free."""
    rng = np.random.default_rng(6)
    case = Case(rng, random_labels(rng, 40, (4, 6)))
    wide = np.full_like(case.scales, 1e4)
    mean, covariance = case.groups.effects_given(case.residual, case.width, wide)
    incidence = case.incidence()
    contrast = np.zeros(case.groups.n_effects)
    contrast[[0, 1]] = 1.0, -1.0
    for b in range(3):
        root = 1.0 / case.width[b]
        inverse = np.linalg.pinv(root[:, None] * incidence)
        expected = incidence @ (inverse @ (root * case.residual[b]))
        np.testing.assert_allclose(case.groups.at_rows(mean)[b], expected, atol=1e-6)
        spread = contrast @ inverse @ inverse.T @ contrast
        assert contrast @ covariance[b] @ contrast == pytest.approx(spread, rel=1e-4)


def test_one_level_is_a_common_offset():
    """One level in one column: the mean of n values with variance s² + w²/n, and n − 1 free deviations."""
    rng = np.random.default_rng(7)
    n, w, s = 8, 0.3, 0.9
    groups = CrossedGroups.of_labels({"all": np.full(n, "the same")})
    r = rng.normal(size=(1, n))
    expected = stats.norm(0, np.sqrt(s**2 + w**2 / n)).logpdf(r.mean())
    deviations = ((r - r.mean()) ** 2).sum()
    expected += -0.5 * (n - 1) * np.log(2 * np.pi * w**2) - 0.5 * np.log(n) - deviations / (2 * w**2)
    assert groups.log_density(r, w, [[s]])[0] == pytest.approx(expected, rel=1e-13)


@given(st.integers(0, 2**32 - 1), st.integers(1, 30), st.lists(st.integers(1, 9), min_size=1, max_size=3))
@settings(max_examples=60, deadline=None)
def test_the_order_of_rows_and_columns_means_nothing(seed, rows, counts):
    rng = np.random.default_rng(seed)
    case = Case(rng, random_labels(rng, rows, counts), batch=2)
    order, turned = rng.permutation(rows), rng.permutation(len(counts))
    names = np.array(list(case.labels))[turned]
    other = CrossedGroups.of_labels({name: case.labels[name][order] for name in names})
    moved = case.residual[:, order], case.width[:, order], case.scales[:, turned]
    np.testing.assert_allclose(
        other.log_density(*moved), case.groups.log_density(*case.arguments), rtol=1e-11, atol=1e-11
    )
    np.testing.assert_allclose(
        other.log_density_pointwise(*moved),
        case.groups.log_density_pointwise(*case.arguments)[:, order],
        rtol=1e-8,
        atol=1e-9,
    )


@given(st.integers(0, 2**32 - 1), st.floats(0.0, 3.0), st.floats(0.0, 3.0))
@settings(max_examples=60, deadline=None)
def test_any_design_and_scale_is_the_dense_normal(seed, first, second):
    rng = np.random.default_rng(seed)
    case = Case(rng, random_labels(rng, 15, (5, 4)), batch=1)
    case.scales[0] = first, second
    found = case.groups.log_density(*case.arguments)[0]
    assert found == pytest.approx(case.dense_log_density(0), rel=1e-9)


def test_it_is_frozen_and_can_be_sent_to_another_process():
    rng = np.random.default_rng(0)
    case = Case(rng, random_labels(rng, 10, (3, 3)))
    before = case.groups.log_density(*case.arguments)
    copy = pickle.loads(pickle.dumps(case.groups))
    np.testing.assert_array_equal(copy.log_density(*case.arguments), before)
    with pytest.raises(AttributeError):
        case.groups.columns = ()


@pytest.mark.parametrize(
    ("labels", "words"),
    [
        ({}, "at least one column"),
        ({"a": np.array(["x"]), "b": np.array(["x", "y"])}, "group column 'b'"),
        ({"a": np.array([], dtype=str)}, "at least one"),
        ({"a": np.array([["x"]])}, "one label for each row"),
    ],
)
def test_labels_that_do_not_fit(labels, words):
    with pytest.raises(InputError, match=words):
        CrossedGroups.of_labels(labels)


def test_shapes_that_do_not_fit():
    groups = CrossedGroups.of_labels(balanced_labels(2, 3))
    good = np.zeros((2, 6)), 1.0, np.ones((2, 2))
    assert np.isfinite(groups.log_density(*good)).all()
    for bad in [
        (np.zeros(6), 1.0, np.ones((1, 2))),
        (good[0], np.ones(5), good[2]),
        (*good[:2], np.ones((2, 3))),
    ]:
        with pytest.raises(InputError, match="expected"):
            groups.log_density(*bad)
    for block in (np.zeros(5, dtype=int), np.full(6, -1), np.zeros(6)):
        with pytest.raises(InputError, match="6 whole numbers"):
            groups.log_density_left_out(*good, block)
    with pytest.raises(InputError, match="only of column0, column1"):
        groups.effects_of("other")
