"""Analysis of variance against the closed formulas of balanced tables and against projections of unbalanced ones."""

import numpy as np
import pytest
from crossed_designs import balanced_labels, random_labels
from hypothesis import given, settings
from hypothesis import strategies as st

from skinbayes.errors import InputError
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.two_way import crossed_analysis_of_variance


def residual_squares(values, labels, names):
    """Squares and degrees of freedom left by a constant and some columns, from the projector of the design's range."""
    parts = [np.ones((len(values), 1))]
    parts += [(labels[name][:, None] == np.unique(labels[name])).astype(float) for name in names]
    left, singular, _ = np.linalg.svd(np.concatenate(parts, axis=1), full_matrices=False)
    basis = left[:, singular > 1e-10 * singular[0]]
    return (values**2).sum() - ((basis.T @ values) ** 2).sum(), len(values) - basis.shape[1]


@pytest.mark.parametrize("shape", [(11, 15), (2, 2), (4, 3)])
def test_balanced_tables_have_closed_formulas(shape):
    a, b = shape
    table = np.random.default_rng(a).normal(2.0, 1.0, shape)
    rows, columns = table.mean(axis=1), table.mean(axis=0)
    rest = ((table - rows[:, None] - columns + table.mean()) ** 2).sum()
    found = crossed_analysis_of_variance(table.ravel(), balanced_labels(a, b))
    assert found.degrees_of_freedom == (a - 1) * (b - 1)
    assert found.column_degrees_of_freedom == {"column0": a - 1, "column1": b - 1}
    assert found.residual_standard_deviation == pytest.approx(np.sqrt(rest / ((a - 1) * (b - 1))), rel=1e-12)
    expected = {"column0": b * rows.var() * a, "column1": a * columns.var() * b}
    assert found.sequential_sum_of_squares == pytest.approx(expected, rel=1e-11)
    assert found.marginal_sum_of_squares == pytest.approx(expected, rel=1e-11)
    assert found.total_sum_of_squares == pytest.approx(table.var() * a * b, rel=1e-12)
    assert sum(found.sequential_fraction.values()) + found.residual_fraction == pytest.approx(1.0, rel=1e-12)
    fitted = (rows[:, None] + columns - table.mean()).ravel()
    np.testing.assert_allclose(found.fitted, fitted, rtol=1e-12, atol=1e-12)


def test_replicates_count_in_the_residual():
    """Three values in each of 2 by 4 cells: without interaction 24 − 1 − 1 − 3 degrees of freedom."""
    table = np.random.default_rng(5).normal(size=(2, 4, 3))
    labels = {name: labels for name, labels in balanced_labels(2, 4, 3).items() if name != "column2"}
    found = crossed_analysis_of_variance(table.ravel(), labels)
    rest = table - table.mean((1, 2))[:, None, None] - table.mean((0, 2))[:, None] + table.mean()
    assert found.degrees_of_freedom == 19
    assert found.residual_sum_of_squares == pytest.approx((rest**2).sum(), rel=1e-12)


@given(st.integers(0, 2**32 - 1), st.integers(1, 40), st.lists(st.integers(1, 8), min_size=1, max_size=3))
@settings(max_examples=60, deadline=None)
def test_unbalanced_data_are_projections(seed, rows, counts):
    """Also repeated and missing cells, disconnected designs and columns that nest."""
    rng = np.random.default_rng(seed)
    labels = random_labels(rng, rows, counts)
    values = rng.normal(1.0, 2.0, rows)
    found = crossed_analysis_of_variance(values, labels)
    names = tuple(labels)
    full, left = residual_squares(values, labels, names)
    tolerance = {"rel": 1e-9, "abs": 1e-9}
    assert found.degrees_of_freedom == left
    assert found.residual_sum_of_squares == pytest.approx(full, **tolerance)
    for i, name in enumerate(names):
        before, free_before = residual_squares(values, labels, names[:i])
        after, free_after = residual_squares(values, labels, names[: i + 1])
        without, free_without = residual_squares(values, labels, tuple(n for n in names if n != name))
        assert found.sequential_sum_of_squares[name] == pytest.approx(before - after, **tolerance)
        assert found.marginal_sum_of_squares[name] == pytest.approx(without - full, **tolerance)
        assert found.column_degrees_of_freedom[name] == free_before - free_after
        assert found.marginal_degrees_of_freedom[name] == free_without - left
        assert found.sequential_sum_of_squares[name] >= 0.0
    total = sum(found.sequential_sum_of_squares.values()) + found.residual_sum_of_squares
    assert total == pytest.approx(found.total_sum_of_squares, **tolerance)
    if left:
        assert found.residual_standard_deviation == pytest.approx(
            np.sqrt(abs(full) / left), rel=1e-9, abs=1e-6
        )
    else:
        assert np.isnan(found.residual_standard_deviation)


def test_a_nested_column_explains_nothing_beyond_the_finer_one():
    ward = np.repeat(["a", "b"], 6)
    patient = np.repeat([f"p{i}" for i in range(4)], 3)
    found = crossed_analysis_of_variance(
        np.random.default_rng(1).normal(size=12), {"patient": patient, "ward": ward}
    )
    assert found.column_degrees_of_freedom == {"patient": 3, "ward": 0}
    assert found.sequential_fraction["ward"] == pytest.approx(0.0, abs=1e-14)
    assert found.degrees_of_freedom == 8


def test_the_residual_is_the_noise_floor_of_group_effects():
    """With effects free to take any size the likelihood of the width is greatest at the residual standard deviation."""
    rng = np.random.default_rng(2)
    labels = balanced_labels(11, 15)
    groups = CrossedGroups.of_labels(labels)
    values = groups.at_rows(groups.draw_new_effects(rng, [[0.4, 0.7]]))[0] + rng.normal(0.0, 0.3, 165)
    floor = crossed_analysis_of_variance(values, labels).residual_standard_deviation
    width = np.linspace(0.5, 2.0, 301)[:, None] * floor
    scales = np.tile([[1e3, 1e3]], (301, 1)) * floor
    flat = groups.log_density(np.tile(values, (301, 1)), width, scales)
    # effects that cost no likelihood leave that of the residual with its degrees of freedom, as restricted likelihood does
    assert width[np.argmax(flat), 0] == pytest.approx(floor, rel=0.01)


def test_units_and_offsets_scale():
    rng = np.random.default_rng(3)
    labels = random_labels(rng, 30, (4, 5))
    values = rng.normal(size=30)
    plain = crossed_analysis_of_variance(values, labels)
    scaled = crossed_analysis_of_variance(1e-6 * values + 5.0, labels)
    assert scaled.residual_standard_deviation == pytest.approx(
        1e-6 * plain.residual_standard_deviation, rel=1e-6
    )
    assert scaled.marginal_fraction == pytest.approx(plain.marginal_fraction, rel=1e-6)


@pytest.mark.parametrize("values", [[1.0, 2.0], [1.0, 2.0, np.nan, 4.0], [[1.0, 2.0, 3.0, 4.0]]])
def test_values_that_do_not_fit(values):
    with pytest.raises(InputError, match="expected 4 finite numbers"):
        crossed_analysis_of_variance(values, balanced_labels(2, 2))


def test_equal_values_have_no_shares():
    found = crossed_analysis_of_variance(np.full(4, 3.0), balanced_labels(2, 2))
    assert found.residual_standard_deviation == 0.0
    assert np.isnan([*found.sequential_fraction.values(), found.residual_fraction]).all()
