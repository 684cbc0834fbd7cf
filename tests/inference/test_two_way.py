"""Analysis of variance against the closed formulas of balanced tables and against projections of unbalanced ones."""

import numpy as np
import pytest
from crossed_designs import balanced_labels, random_labels
from hypothesis import given, settings
from hypothesis import strategies as st

from skinbayes.errors import InputError
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.two_way import residual_scatter


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
    deviation, left = residual_scatter(table.ravel(), balanced_labels(a, b))
    assert left == (a - 1) * (b - 1)
    assert deviation == pytest.approx(np.sqrt(rest / ((a - 1) * (b - 1))), rel=1e-12)


def test_replicates_count_in_the_residual():
    """Three values in each of 2 by 4 cells: without interaction 24 − 1 − 1 − 3 degrees of freedom."""
    table = np.random.default_rng(5).normal(size=(2, 4, 3))
    labels = {name: labels for name, labels in balanced_labels(2, 4, 3).items() if name != "column2"}
    deviation, left = residual_scatter(table.ravel(), labels)
    rest = table - table.mean((1, 2))[:, None, None] - table.mean((0, 2))[:, None] + table.mean()
    assert left == 19
    assert deviation == pytest.approx(np.sqrt((rest**2).sum() / 19), rel=1e-12)


@given(st.integers(0, 2**32 - 1), st.integers(1, 40), st.lists(st.integers(1, 8), min_size=1, max_size=3))
@settings(max_examples=60, deadline=None)
def test_unbalanced_data_are_projections(seed, rows, counts):
    """Also repeated and missing cells, disconnected designs and columns that nest."""
    rng = np.random.default_rng(seed)
    labels = random_labels(rng, rows, counts)
    values = rng.normal(1.0, 2.0, rows)
    deviation, left = residual_scatter(values, labels)
    full, expected = residual_squares(values, labels, tuple(labels))
    assert left == expected
    if left:
        assert deviation == pytest.approx(np.sqrt(abs(full) / left), rel=1e-9, abs=1e-6)
    else:
        assert np.isnan(deviation)


def test_a_nested_column_costs_nothing_beyond_the_finer_one():
    ward, patient = np.repeat(["a", "b"], 6), np.repeat([f"p{i}" for i in range(4)], 3)
    values = np.random.default_rng(1).normal(size=12)
    both, left = residual_scatter(values, {"patient": patient, "ward": ward})
    assert left == 8
    assert both == pytest.approx(residual_scatter(values, {"patient": patient})[0], rel=1e-12)


def test_the_residual_is_the_noise_floor_of_group_effects():
    """With effects free to take any size the likelihood of the width is greatest at the residual standard deviation."""
    rng = np.random.default_rng(2)
    labels = balanced_labels(11, 15)
    groups = CrossedGroups.of_labels(labels)
    values = groups.at_rows(groups.draw_new_effects(rng, [[0.4, 0.7]]))[0] + rng.normal(0.0, 0.3, 165)
    floor, _ = residual_scatter(values, labels)
    width = np.linspace(0.5, 2.0, 301)[:, None] * floor
    scales = np.tile([[1e3, 1e3]], (301, 1)) * floor
    flat = groups.log_density(np.tile(values, (301, 1)), width, scales)
    # effects that cost no likelihood leave that of the residual with its degrees of freedom, as restricted likelihood does
    assert width[np.argmax(flat), 0] == pytest.approx(floor, rel=0.01)


def test_units_and_offsets_scale():
    rng = np.random.default_rng(3)
    labels = random_labels(rng, 30, (4, 5))
    values = rng.normal(size=30)
    plain, left = residual_scatter(values, labels)
    assert residual_scatter(1e-6 * values + 5.0, labels) == (pytest.approx(1e-6 * plain, rel=1e-6), left)


@pytest.mark.parametrize("values", [[1.0, 2.0], [1.0, 2.0, np.nan, 4.0], [[1.0, 2.0, 3.0, 4.0]]])
def test_values_that_do_not_fit(values):
    with pytest.raises(InputError, match="expected 4 finite numbers"):
        residual_scatter(values, balanced_labels(2, 2))


def test_equal_values_leave_nothing():
    assert residual_scatter(np.full(4, 3.0), balanced_labels(2, 2)) == (0.0, 1)
