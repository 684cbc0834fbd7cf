"""The proposals an ensemble is moved with."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from skinbayes.arrays import FloatArray

WeightedMoves: TypeAlias = list[tuple[Any, float]]
"""emcee moves with their probabilities."""

MoveFactory: TypeAlias = Callable[[], WeightedMoves]
"""An importable function that builds moves; its qualified name is part of a stored run's fingerprint."""

Proposal: TypeAlias = Callable[[FloatArray, FloatArray, np.random.RandomState], tuple[FloatArray, FloatArray]]
"""Walkers to be moved, walkers that stay and a generator to proposals and Hastings factors."""

FREEDOM, WIDENING = 5.0, 1.1
"""Degrees of freedom of the Student distribution, and its squared scale over the covariance of the walkers."""

FLAT = 1e-7
"""Walkers whose extent across some direction is less than this fraction of a coordinate's count as flat."""


def default_moves() -> WeightedMoves:
    """Differential evolution (70 %) mixed with a kernel density of the other half of the ensemble (30 %).

    Differential evolution (ter Braak 2006, doi 10.1007/s11222-006-8769-1) is invariant under linear maps and
    works in any dimension a fit of this kind has. The kernel density is an independence proposal: with 128
    walkers it decorrelates an ensemble in a few steps up to about five dimensions and is of little use beyond
    ten. On two five-dimensional posteriors the mixture gave 0.04 to 0.06 effective draws per evaluation,
    differential evolution alone 0.013 to 0.021, emcee's stretch move with 32 walkers about 0.01.

    Two moves of emcee 3.1.6 must not be added: ``DESnookerMove`` does not leave the target invariant (variance
    of a unit Gaussian 0.79, 0.70 and 0.61 in 3, 5 and 10 dimensions), and ``GaussianMove`` with a full
    covariance shifts all walkers by the same vector. R-hat sees neither.

    Returns
    -------
    pairs of an emcee move and its probability
    """
    from emcee.moves import DEMove

    return [(DEMove(), 0.7), (_independence_move(kernel_density_proposal), 0.3)]


def few_walkers_moves() -> WeightedMoves:
    """Differential evolution (40 %), a Student distribution about the other half (40 %) and a kernel density of it (20 %).

    For targets that are expensive to evaluate, whose ensembles are small: 32 other walkers are too few for a kernel density in
    eight or ten dimensions, but their mean and covariance are known well enough. Where a posterior is bent, Student proposals
    leave walkers in its tips, which the other two bring back. Autocorrelation times, in steps:

    | posterior | these | default moves | Student 70 %, the rest differences | differences alone |
    |---|---|---|---|---|
    | a drying series, 9 parameters | 19 | 32 | 15 | over 40 |
    | eight rows against humidity, 7 parameters, bent | 43 | 73 | 57 | over 100 |

    Returns
    -------
    pairs of an emcee move and its probability
    """
    from emcee.moves import DEMove

    return [
        (DEMove(), 0.4),
        (_independence_move(student_proposal), 0.4),
        (_independence_move(kernel_density_proposal), 0.2),
    ]


def moves_for(few_walkers: bool) -> MoveFactory:
    """The moves of small ensembles, or of others."""
    return few_walkers_moves if few_walkers else default_moves


def _independence_move(propose: Proposal) -> Any:
    """An emcee move that proposes from a distribution learnt from the other half of the ensemble."""
    from emcee.moves import DEMove
    from emcee.moves.red_blue import RedBlueMove

    differences = DEMove()

    class IndependenceMove(RedBlueMove):
        """The distribution where the other half spans the space, differential evolution where it does not.

        The choice depends on the other half alone, which the move does not change, so detailed balance holds.
        """

        def get_proposal(self, sample: Any, complement: Any, random: Any) -> tuple[FloatArray, FloatArray]:
            try:
                return propose(sample, np.concatenate(complement), random)
            except np.linalg.LinAlgError:
                differences.setup(sample)
                proposal: tuple[FloatArray, FloatArray] = differences.get_proposal(sample, complement, random)
                return proposal

    return IndependenceMove()


def student_proposal(
    sample: FloatArray, complement: FloatArray, random: np.random.RandomState
) -> tuple[FloatArray, FloatArray]:
    """Propose draws from Student's distribution with the mean and, widened by a tenth, the covariance of other walkers.

    Parameters
    ----------
    sample : walkers to be moved, shape ``(n, D)``
    complement : walkers that stay, shape ``(m, D)``
    random : source of all randomness

    Returns
    -------
    proposed positions, shape ``(n, D)``, and the logarithm of the Hastings factor, shape ``(n,)``

    Raises
    ------
    numpy.linalg.LinAlgError
        If ``complement`` does not span the space.
    """
    mean, factor = complement.mean(axis=0), np.sqrt(WIDENING) * _root_of_covariance(complement)
    scale = np.sqrt(random.chisquare(FREEDOM, size=(len(sample), 1)) / FREEDOM)
    proposal = mean + random.standard_normal(sample.shape) / scale @ factor.T
    whiten = np.linalg.inv(factor).T

    def log_density(position: FloatArray) -> FloatArray:
        distance = np.square((position - mean) @ whiten).sum(axis=1)
        return np.asarray(-(FREEDOM + complement.shape[1]) / 2 * np.log1p(distance / FREEDOM))

    return proposal, log_density(sample) - log_density(proposal)


def _root_of_covariance(walkers: FloatArray) -> FloatArray:
    """Cholesky factor of the covariance of walkers, shape ``(D, D)``; LinAlgError if they do not span the space."""
    centred = walkers - walkers.mean(axis=0)
    covariance = centred.T @ centred / max(len(walkers) - 1, 1)
    factor = np.linalg.cholesky(covariance)
    if np.any(np.diag(factor) < FLAT * np.sqrt(np.diag(covariance))):
        raise np.linalg.LinAlgError("the walkers lie in a plane")
    return factor


def kernel_density_proposal(
    sample: FloatArray, complement: FloatArray, random: np.random.RandomState
) -> tuple[FloatArray, FloatArray]:
    """Propose draws from a Gaussian kernel density of other walkers (Scott's bandwidth).

    The density is the one of ``scipy.stats.gaussian_kde``, which emcee's own KDEMove uses. SciPy solves its
    small triangular systems with threaded LAPACK calls: 4.8 ms of CPU for 64 points in five dimensions when
    another process has the second core, against 0.3 ms for the whole proposal here.

    Parameters
    ----------
    sample : walkers to be moved, shape ``(n, D)``
    complement : walkers that stay, shape ``(m, D)``
    random : source of all randomness

    Returns
    -------
    proposed positions, shape ``(n, D)``, and the logarithm of the Hastings factor, shape ``(n,)``

    Raises
    ------
    numpy.linalg.LinAlgError
        If ``complement`` does not span the space.
    """
    count, dimension = complement.shape
    bandwidth = count ** (-1.0 / (dimension + 4))
    factor = _root_of_covariance(complement)
    whiten = np.linalg.inv(factor) / bandwidth
    centres = complement[random.randint(count, size=len(sample))]
    proposal = centres + random.standard_normal(sample.shape) @ (bandwidth * factor.T)
    kernels = complement @ whiten.T
    change = _log_kernel_sum(sample @ whiten.T, kernels) - _log_kernel_sum(proposal @ whiten.T, kernels)
    return proposal, change


def _log_kernel_sum(points: FloatArray, kernels: FloatArray) -> FloatArray:
    """Logarithm of the sum of unit Gaussian kernels at each point, up to a constant."""
    exponent = np.zeros((len(points), len(kernels)))
    for point, kernel in zip(points.T, kernels.T, strict=True):
        exponent -= 0.5 * np.square(point[:, np.newaxis] - kernel)
    largest = exponent.max(axis=1)
    total: FloatArray = largest + np.log(np.exp(exponent - largest[:, np.newaxis]).sum(axis=1))
    return total
