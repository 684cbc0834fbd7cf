"""Log-density of 165 rows with two crossed group effects of 11 and 15 levels: skinbayes against dense normal distributions.

Run with ``python benchmarks/groups.py [--json]``. Both sides start from the same residuals, widths and scales of 512 vectors.
The plain one builds the covariance of each vector from the incidence matrix and evaluates scipy.stats.multivariate_normal; the
tuned one factors the same matrices with scipy.linalg.cholesky. Errors are against the closed form of a balanced table.
"""

from __future__ import annotations

import numpy as np
from common import best_time, report
from scipy.linalg import cholesky, solve_triangular
from scipy.stats import multivariate_normal

from skinbayes.statistics.groups import CrossedGroups

VECTORS, LEVELS, DENSE_VECTORS = 512, (11, 15), 32


class Case:
    """A balanced table of one row in each cell; one width for all rows of a vector, as the closed form needs."""

    def __init__(self, seed: int = 1) -> None:
        rng = np.random.default_rng(seed)
        first, second = np.indices(LEVELS).reshape(2, -1)
        self.groups = CrossedGroups.of_labels({"first": first.astype(str), "second": second.astype(str)})
        self.incidence = np.concatenate(
            [place[:, None] == np.arange(n) for place, n in zip((first, second), LEVELS, strict=True)], axis=1
        ).astype(float)
        self.residual = rng.normal(0.0, 0.5, (VECTORS, len(first)))
        self.width = np.repeat(rng.uniform(0.2, 0.6, (VECTORS, 1)), len(first), axis=1)
        self.scales = rng.uniform(0.1, 1.0, (VECTORS, 2))

    def skinbayes(self) -> np.ndarray:
        """Log-density of all vectors."""
        return self.groups.log_density(self.residual, self.width, self.scales)

    def covariance(self, i: int) -> np.ndarray:
        """Covariance of the rows of one vector."""
        variance = np.repeat(self.scales[i] ** 2, LEVELS)
        return np.diag(self.width[i] ** 2) + (self.incidence * variance) @ self.incidence.T

    def plain(self) -> np.ndarray:
        """Log-density of the first vectors, multivariate normal by multivariate normal."""
        centre = np.zeros(len(self.incidence))
        return np.array(
            [
                multivariate_normal(centre, self.covariance(i)).logpdf(self.residual[i])
                for i in range(DENSE_VECTORS)
            ]
        )

    def tuned(self) -> np.ndarray:
        """Log-density of the first vectors from Cholesky factors of the dense covariances."""
        found = []
        for i in range(DENSE_VECTORS):
            factor = cholesky(self.covariance(i), lower=True, overwrite_a=True, check_finite=False)
            whitened = solve_triangular(factor, self.residual[i], lower=True, check_finite=False)
            logarithm = np.log(2 * np.pi) * len(whitened) / 2 + np.log(np.diag(factor)).sum()
            found.append(-0.5 * whitened @ whitened - logarithm)
        return np.array(found)

    def exact(self) -> np.ndarray:
        """Log-density from the four eigenvalues of the covariance of a balanced table."""
        a, b = LEVELS
        table = self.residual.reshape(VECTORS, a, b)
        mean = table.mean(axis=(1, 2))
        rows, columns = table.mean(axis=2) - mean[:, None], table.mean(axis=1) - mean[:, None]
        rest = table - mean[:, None, None] - rows[:, :, None] - columns[:, None, :]
        noise, first, second = self.width[:, 0] ** 2, b * self.scales[:, 0] ** 2, a * self.scales[:, 1] ** 2
        parts = (
            ((a - 1) * (b - 1), noise, (rest**2).sum(axis=(1, 2))),
            (a - 1, noise + first, b * (rows**2).sum(axis=1)),
            (b - 1, noise + second, a * (columns**2).sum(axis=1)),
            (1, noise + first + second, a * b * mean**2),
        )
        return sum(-0.5 * (n * np.log(2 * np.pi * value) + squares / value) for n, value, squares in parts)


def run() -> dict[str, float]:
    """Time all sides and compare their results with the closed form."""
    case = Case()
    exact = case.exact()
    plain, tuned = (best_time(f, 3) / DENSE_VECTORS * 1e6 for f in (case.plain, case.tuned))
    ours = best_time(case.skinbayes, 20) / VECTORS * 1e6
    arguments = (case.residual, case.width, case.scales)
    pointwise = best_time(lambda: case.groups.log_density_pointwise(*arguments), 5) / VECTORS * 1e6
    return {
        "vectors": VECTORS,
        "rows": len(case.incidence),
        "plain_us_per_vector": plain,
        "tuned_us_per_vector": tuned,
        "skinbayes_us_per_vector": ours,
        "skinbayes_pointwise_us_per_vector": pointwise,
        "ratio_to_plain": plain / ours,
        "ratio_to_tuned": tuned / ours,
        "plain_largest_error": float(np.max(np.abs(case.plain() - exact[:DENSE_VECTORS]))),
        "skinbayes_largest_error": float(np.max(np.abs(case.skinbayes() - exact))),
    }


LINES = (
    ("scipy.stats.multivariate_normal, us per vector", "plain_us_per_vector", ".0f"),
    ("dense Cholesky factors, us per vector", "tuned_us_per_vector", ".0f"),
    ("skinbayes, us per vector", "skinbayes_us_per_vector", ".1f"),
    ("skinbayes, each row given the others, us per vector", "skinbayes_pointwise_us_per_vector", ".1f"),
    ("times faster than multivariate_normal", "ratio_to_plain", ".0f"),
    ("times faster than dense Cholesky factors", "ratio_to_tuned", ".0f"),
    ("largest error of ln p of multivariate_normal", "plain_largest_error", ".1e"),
    ("largest error of ln p of skinbayes", "skinbayes_largest_error", ".1e"),
)

if __name__ == "__main__":
    report(__doc__, f"ln p of 165 rows with group effects of {LEVELS[0]} and {LEVELS[1]} levels", run, LINES)
