"""Ranks of true values in the results of many simulations of one model, and what they say."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import ndtr

from skinbayes.arrays import FloatArray
from skinbayes.calibration.simulation import LEVELS, RANKED_DRAWS, Simulated
from skinbayes.phrases import number
from skinbayes.statistics.counts import count_p_value
from skinbayes.statistics.uniformity import uniform_band

if TYPE_CHECKING:
    import pandas

LOG_LIKELIHOOD = "log_likelihood"
"""The quantity that is ranked beside the parameters: ln p(all data | θ)."""

REFERENCE_ERROR = 0.1
"""Largest standard error of an evidence from draws of the prior that another is compared with."""

SURPRISING = 0.05
"""Probability below which a calibrated pipeline is doubted."""


@dataclass(frozen=True, repr=False)
class RankedTruths:
    """What many simulations say about the calibration of one model.

    Attributes
    ----------
    name : of the model
    names : labels of its free parameters
    simulations : all of them, in their order
    seed : from which they were made

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> problem = sb.build_problem(
    ...     "constant", {"friction_coefficient [1]": [0.4, 0.5]},
    ...     parameters={"typical_friction_coefficient": {"uniform": [0, 1]}},
    ...     noise={"family": "gaussian", "noise_scale": 0.1},
    ... )  # fmt: skip
    >>> result = sb.calibrate(problem, simulations=2, ess=400)
    >>> result.quantities
    ('typical_friction_coefficient', 'log_likelihood')
    """

    name: str
    names: tuple[str, ...]
    simulations: tuple[Simulated, ...]
    seed: int

    def __repr__(self) -> str:
        return f"Calibration of '{self.name}': {self.sentence()}"

    @property
    def converged(self) -> bool:
        """True: the numbers of a calibration are final; fits that did not converge are counted in them."""
        return True

    @property
    def quantities(self) -> tuple[str, ...]:
        """What is ranked: the parameters, and the likelihood of all data."""
        return (*self.names, LOG_LIKELIHOOD)

    @property
    def failed(self) -> int:
        """Fits that did not converge or ended in an error."""
        return sum(not one.converged for one in self.simulations)

    @property
    def errors(self) -> dict[str, int]:
        """The errors that fits ended in, and how often each did."""
        return dict(Counter(one.fits[0].failure for one in self.simulations if one.fits[0].failure))

    def ranks(self, quantity: str, converged_only: bool = False) -> FloatArray:
        """Ranks of the truth, from 0 to 199, of all fits that ended with a result.

        Parameters
        ----------
        quantity : one of :attr:`quantities`
        converged_only : leave out fits that did not converge

        Returns
        -------
        ndarray
            Shape ``(n,)``.

        Examples
        --------
        >>> bool((result.ranks("log_likelihood") <= 199).all())
        True
        """
        place = self.quantities.index(quantity)
        return np.array([one.ranks[place] for one in self._ended(converged_only)], dtype=float)

    def levels(self, quantity: str, converged_only: bool = False) -> FloatArray:
        """Posterior probability of less than the truth, from the ranks.

        Parameters
        ----------
        quantity, converged_only : as :meth:`ranks` takes them

        Returns
        -------
        ndarray
            Shape ``(n,)``, between 0 and 1: uniform if the posterior is calibrated.

        Examples
        --------
        >>> bool(((0 < result.levels("log_likelihood")) & (result.levels("log_likelihood") < 1)).all())
        True
        """
        return (self.ranks(quantity, converged_only) + 0.5) / (RANKED_DRAWS + 1)

    def p_value(self, quantity: str, converged_only: bool = False) -> float:
        """Probability that the ranks of a calibrated posterior stray as far from uniform ones anywhere.

        Parameters
        ----------
        quantity, converged_only : as :meth:`ranks` takes them

        Returns
        -------
        float
            Nan without a single result. See ``skinbayes.statistics.uniformity``.

        Examples
        --------
        >>> 0.0 < result.p_value("log_likelihood") <= 1.0
        True
        """
        levels = self.levels(quantity, converged_only)
        return uniform_band(len(levels)).p_value(levels) if len(levels) else float("nan")

    def coverage(self, quantity: str, level: float) -> tuple[int, int, float]:
        """How many central intervals of the results hold the truth.

        Parameters
        ----------
        quantity : one of :attr:`names`
        level : probability of the interval, 0.5 or 0.9

        Returns
        -------
        tuple
            How many do, of how many, and the probability that the count of a calibrated posterior is as far from expected.

        Examples
        --------
        >>> result.coverage("typical_friction_coefficient", 0.9)[1]
        2
        """
        place, which = self.names.index(quantity), LEVELS.index(level)
        inside = [one.inside[which][place] for one in self._ended()]
        return sum(inside), len(inside), count_p_value(sum(inside), np.full(len(inside), level))

    def recovery(self, quantity: str) -> tuple[FloatArray, FloatArray]:
        """How well the truth was found.

        Parameters
        ----------
        quantity : one of :attr:`names`

        Returns
        -------
        tuple of ndarray
            Posterior mean less truth over the posterior standard deviation, and 1 less the ratio of posterior to prior
            variance, each ``(n,)``; both where the parameter has no bounds (as ln of what is positive).

        Examples
        --------
        >>> [values.shape for values in result.recovery("typical_friction_coefficient")]
        [(2,), (2,)]
        """
        place, ended = self.names.index(quantity), self._ended()
        return np.array([one.z_scores[place] for one in ended]), np.array(
            [one.contraction[place] for one in ended]
        )

    def evidence_scores(self) -> FloatArray:
        """Difference of ln Z to the mean likelihood of draws of the prior, over the standard errors of both.

        Returns
        -------
        ndarray
            Shape ``(n,)``: of fits that know ln Z, where that mean has a standard error of at most 0.1 of itself. Standard
            normal if ln Z and its error are right.

        Examples
        --------
        >>> result.evidence_scores().ndim
        1
        """
        pairs = [
            (*fit.log_evidence, *fit.reference)
            for fit in (one.fits[0] for one in self.simulations)
            if fit.log_evidence is not None and fit.reference is not None
            if fit.reference[1] <= REFERENCE_ERROR
        ]
        value, error, reference, its_error = np.array(pairs).reshape(-1, 4).T
        return np.asarray((value - reference) / np.hypot(error, its_error))

    def evidence_p_value(self) -> float:
        """Probability that scores of a right ln Z stray as far from normal ones; nan where none is known.

        Returns
        -------
        float
            See :meth:`evidence_scores`.

        Examples
        --------
        >>> bool(result.evidence_p_value() > 1e-4)
        True
        """
        scores = ndtr(self.evidence_scores())
        return uniform_band(len(scores)).p_value(scores) if len(scores) else float("nan")

    def summary(self) -> pandas.DataFrame:
        """Table of all quantities that are ranked.

        Returns
        -------
        pandas.DataFrame
            Index: quantity. Columns: ``p`` of the ranks, ``p_converged`` without fits that did not converge, ``coverage_50`` and
            ``coverage_90`` (shares that hold the truth), ``z_mean``, ``z_sd`` and ``contraction`` (mean); those of the
            likelihood of all data are nan.

        Examples
        --------
        >>> list(result.summary().index)
        ['typical_friction_coefficient', 'log_likelihood']
        """
        import pandas

        rows: dict[str, dict[str, float]] = {}
        for name in self.quantities:
            row = {"p": self.p_value(name), "p_converged": self.p_value(name, converged_only=True)}
            if name in self.names and self._ended():
                for level in LEVELS:
                    hits, count, _ = self.coverage(name, level)
                    row[f"coverage_{100 * level:.0f}"] = hits / count
                scores, contraction = self.recovery(name)
                row |= {"z_mean": scores.mean(), "z_sd": scores.std(), "contraction": contraction.mean()}
            rows[name] = row
        return pandas.DataFrame.from_dict(rows, orient="index")

    def worst(self, converged_only: bool = False) -> tuple[str, float, int]:
        """The most surprising test.

        Parameters
        ----------
        converged_only : leave out fits that did not converge

        Returns
        -------
        tuple
            What it is of, its p value, and how many tests there are: ranks of each quantity, and ln Z if it is known.

        Examples
        --------
        >>> result.worst()[2]
        3
        """
        found = {name: self.p_value(name, converged_only) for name in self.quantities}
        if len(self.evidence_scores()):
            found["ln Z"] = self.evidence_p_value()
        name = min(found, key=lambda key: found[key])
        return name, found[name], len(found)

    def passed(self, converged_only: bool = False) -> bool:
        """Whether nothing speaks against calibration.

        Parameters
        ----------
        converged_only : leave out fits that did not converge

        Returns
        -------
        bool
            The smallest p value times the number of tests is at least 0.05, so that one calibrated model in twenty is doubted.

        Examples
        --------
        >>> isinstance(result.passed(), bool)
        True
        """
        if not self._ended(converged_only):
            return False
        _, p, tests = self.worst(converged_only)
        return bool(min(1.0, p * tests) >= SURPRISING)

    def sentence(self) -> str:
        """The verdict in words.

        Returns
        -------
        str
            What was found, of how many, and what became of fits that failed.

        Examples
        --------
        >>> result.sentence().partition(":")[0]
        'Nothing speaks against calibration in 2 simulations'
        """
        total, ended = len(self.simulations), self._ended()
        if not ended:
            return f"None of {total} fits of simulated data ended with a result. {self._failures()}".strip()
        name, p, tests = self.worst()
        verdict = (
            f"Nothing speaks against calibration in {total} simulations: the smallest of {tests} p values is {number(p, 2)}, of "
            f"{name}"
            if self.passed()
            else f"Not calibrated: of {tests} p values of {total} simulations that of {name} is {number(p, 2)}"
        )
        hits = [self.coverage(one, 0.9)[0] for one in self.names]
        share = 100.0 * sum(hits) / (len(ended) * len(hits))
        covered = f"90 % intervals held {share:.0f} % of the true values"
        return f"{verdict}; {covered}. {self._failures()}".strip()

    def _failures(self) -> str:
        if not self.failed:
            return "All fits converged."
        broken = sum(self.errors.values())
        unfinished = self.failed - broken
        parts = []
        if unfinished:
            same = "the same" if self.passed(True) == self.passed() else "another"
            parts.append(
                f"{unfinished} did not converge and are counted in (without them the verdict is {same})"
            )
        if broken:
            parts.append(f"{broken} ended in an error and have no rank")
        return f"Of the fits {' and '.join(parts)}."

    def to_dict(self) -> dict[str, Any]:
        """The result as plain values.

        Returns
        -------
        dict
            ``simulations``, ``failed``, ``parameters`` (name to ``ranks``, ``p``, ``coverage_50``, …) and more.

        Examples
        --------
        >>> result.to_dict()["failed"]
        0
        """
        table = self.summary().to_dict(orient="index")

        def entry(name: str) -> dict[str, Any]:
            values = {str(key): float(value) for key, value in table[name].items() if value == value}
            return {"ranks": self.ranks(name).astype(int).tolist(), **values}

        scores = self.evidence_scores()
        return {
            "model": self.name,
            "simulations": len(self.simulations),
            "failed": self.failed,
            "not_converged": self.failed - sum(self.errors.values()),
            "errors": self.errors,
            "passed": self.passed(),
            "passed_converged": self.passed(converged_only=True),
            "sentence": self.sentence(),
            "seed": self.seed,
            "ranked_draws": RANKED_DRAWS,
            "parameters": {name: entry(name) for name in self.names},
            LOG_LIKELIHOOD: entry(LOG_LIKELIHOOD),
            "log_evidence": {
                "compared": len(scores),
                "z_mean": float(scores.mean()) if len(scores) else None,
                "z_sd": float(scores.std()) if len(scores) else None,
                "p": self.evidence_p_value() if len(scores) else None,
            },
        }

    def _ended(self, converged_only: bool = False) -> list[Simulated]:
        return [one for one in self.simulations if one.ranks and (one.converged or not converged_only)]
