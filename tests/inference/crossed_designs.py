"""Random designs of crossed groups, and the dense matrices they stand for."""

from __future__ import annotations

import numpy as np
from scipy import stats

from skinbayes.statistics.groups import CrossedGroups


def random_labels(rng, rows, counts):
    """Labels of ``rows`` rows in columns of up to ``counts`` levels, unbalanced, cells repeated or missing."""
    return {
        f"column{c}": np.array([f"level{i}" for i in rng.integers(0, count, rows)])
        for c, count in enumerate(counts)
    }


def balanced_labels(*counts):
    """One row for each combination of levels."""
    places = np.indices(counts).reshape(len(counts), -1)
    return {
        f"column{c}": np.array([f"level{i}" for i in place], dtype=np.str_) for c, place in enumerate(places)
    }


class Case:
    """A design with residuals, widths and scales of a batch, and the same as dense matrices."""

    def __init__(self, rng, labels, batch=3, equal_widths=False):
        self.labels = labels
        self.groups = CrossedGroups.of_labels(labels)
        rows = self.groups.n_rows
        self.residual = rng.normal(0.0, 0.7, (batch, rows))
        self.width = rng.uniform(0.2, 0.6, (batch, 1 if equal_widths else rows))
        self.scales = rng.uniform(0.1, 1.0, (batch, len(labels)))

    @property
    def arguments(self):
        return self.residual, self.width, self.scales

    def incidence(self):
        """Z of shape (N, G), straight from the labels."""
        parts = []
        for column, levels in zip(self.groups.columns, self.groups.levels, strict=True):
            parts.append((self.labels[column][:, None] == np.array(levels)).astype(float))
        return np.concatenate(parts, axis=1)

    def prior_variance(self, b):
        return np.concatenate(
            [np.full(len(levels), s**2) for levels, s in zip(self.groups.levels, self.scales[b], strict=True)]
        )

    def covariance(self, b):
        """Σ of one vector."""
        incidence = self.incidence()
        width = np.broadcast_to(self.width[b], self.residual[b].shape)
        return np.diag(width**2) + incidence @ np.diag(self.prior_variance(b)) @ incidence.T

    def dense_log_density(self, b, rows=slice(None)):
        covariance = self.covariance(b)[rows][:, rows]
        return stats.multivariate_normal(np.zeros(len(covariance)), covariance).logpdf(self.residual[b][rows])

    def conditional_log_density(self, b, left_out):
        """ln p(r_left_out | rest) from the conditional normal distribution, written out."""
        covariance, residual = self.covariance(b), self.residual[b]
        rest = ~left_out
        gain = covariance[np.ix_(left_out, rest)] @ np.linalg.inv(covariance[np.ix_(rest, rest)])
        centre = gain @ residual[rest]
        spread = covariance[np.ix_(left_out, left_out)] - gain @ covariance[np.ix_(rest, left_out)]
        return stats.multivariate_normal(centre, spread).logpdf(residual[left_out])


def balanced_log_density(table, width, first, second):
    """ln p of tables ``(B, a, b)`` with one value in each cell, in closed form.

    Σ has four eigenvalues, on the spaces of the analysis of variance: interaction, rows, columns, mean.
    """
    a, b = table.shape[1:]
    mean = table.mean(axis=(1, 2))
    rows, columns = table.mean(axis=2) - mean[:, None], table.mean(axis=1) - mean[:, None]
    rest = table - mean[:, None, None] - rows[:, :, None] - columns[:, None, :]
    noise, first, second = width**2 + 0.0 * first, b * first**2, a * second**2
    parts = (
        ((a - 1) * (b - 1), noise, (rest**2).sum(axis=(1, 2))),
        (a - 1, noise + first, b * (rows**2).sum(axis=1)),
        (b - 1, noise + second, a * (columns**2).sum(axis=1)),
        (1, noise + first + second, a * b * mean**2),
    )
    return sum(-0.5 * (n * np.log(2 * np.pi * value) + squares / value) for n, value, squares in parts)
