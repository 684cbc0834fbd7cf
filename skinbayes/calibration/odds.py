"""Probabilities of two models in the results of many simulations, and what they say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit, ndtr, stdtr

from skinbayes.arrays import FloatArray
from skinbayes.calibration.ranks import SURPRISING
from skinbayes.calibration.simulation import Simulated
from skinbayes.phrases import number
from skinbayes.statistics.counts import count_p_value

BINS = (0.0, 0.05, 0.2, 0.5, 0.8, 0.95, 1.0)
"""Of the probability of the second model."""

TESTS = ("count", "size", "average")


@dataclass(frozen=True, repr=False)
class ModelOdds:
    """What many simulations say about the probabilities of two models of the same data, each as probable before.

    Attributes
    ----------
    models : their names
    simulations : all of them, in their order
    seed : from which they were made

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> def model(largest):
    ...     return sb.build_problem(
    ...         "constant", {"friction_coefficient [1]": [0.4, 0.5]}, name=f"up-to-{largest}",
    ...         parameters={"typical_friction_coefficient": {"uniform": [0, largest]}},
    ...         noise={"family": "gaussian", "noise_scale": 0.1},
    ...     )
    >>> result = sb.calibrate(model(1), model(4), simulations=2, ess=400)
    >>> result.models, result.failed
    (('up-to-1', 'up-to-4'), 0)
    """

    models: tuple[str, str]
    simulations: tuple[Simulated, ...]
    seed: int

    def __repr__(self) -> str:
        return f"Calibration of {' and '.join(self.models)}: {self.sentence()}"

    @property
    def converged(self) -> bool:
        """True: the numbers of a calibration are final; fits that did not converge are counted in them."""
        return True

    @property
    def failed(self) -> int:
        """Simulations of which a fit did not converge, ended in an error, or knows no evidence."""
        return sum(not one.converged or _log_odds(one) is None for one in self.simulations)

    def probabilities(self, converged_only: bool = False) -> tuple[FloatArray, NDArray[np.bool_]]:
        """What each simulation says of the second model, and whether that made the data.

        Parameters
        ----------
        converged_only : leave out simulations of which a fit did not converge

        Returns
        -------
        tuple of ndarray
            Posterior probability of the second model, and the truth, each ``(n,)``, where both fits know their evidence.

        Examples
        --------
        >>> [values.shape for values in result.probabilities()]
        [(2,), (2,)]
        """
        odds, second = self._odds(converged_only)
        return np.asarray(expit(odds)), second

    def bins(self) -> list[tuple[float, float, int, int, float]]:
        """Predicted probability against frequency.

        Returns
        -------
        list of tuple
            For each bin of the probability of the second model that has simulations: mean probability, frequency with which the
            second model made the data, how often that was, of how many, and the probability of a count as far from expected.

        Examples
        --------
        >>> sum(count for _, _, _, count, _ in result.bins())
        2
        """
        p, second = self.probabilities()
        place = np.clip(np.searchsorted(BINS, p, side="right") - 1, 0, len(BINS) - 2)
        found = []
        for bin_ in np.unique(place):
            here = place == bin_
            hits, count = int(second[here].sum()), int(here.sum())
            found.append((float(p[here].mean()), hits / count, hits, count, count_p_value(hits, p[here])))
        return found

    def p_values(self, converged_only: bool = False) -> dict[str, float]:
        """Three ways in which probabilities can be wrong.

        Parameters
        ----------
        converged_only : leave out simulations of which a fit did not converge

        Returns
        -------
        dict
            ``count``: the model preferred made the data as often as its probabilities add up to. ``size``: odds are neither too
            bold nor too shy, as what they gain in the direction of their own size is nil. ``average``: the mean probability
            over data of both models is ½, as it was before the data (Schad et al. 2022, doi 10.1037/met0000472). Nan without
            simulations.

        Examples
        --------
        >>> list(result.p_values())
        ['count', 'size', 'average']
        """
        odds, second = self._odds(converged_only)
        if len(odds) < 2:
            return dict.fromkeys(TESTS, float("nan"))
        preferred, right = expit(np.abs(odds)), (odds > 0) == second
        size = np.abs(odds)
        spread = np.sqrt((size**2 * preferred * (1 - preferred)).sum())
        gain = float((size * (right - preferred)).sum() / spread) if spread > 0 else 0.0
        p = expit(odds)
        error = p.std(ddof=1) / np.sqrt(len(p))
        away = float((p.mean() - 0.5) / error) if error > 0 else 0.0
        return {
            "count": count_p_value(int(right.sum()), preferred),
            "size": float(2 * ndtr(-abs(gain))),
            "average": float(2 * stdtr(len(p) - 1, -abs(away))),
        }

    def passed(self, converged_only: bool = False) -> bool:
        """Whether nothing speaks against calibration.

        Parameters
        ----------
        converged_only : leave out simulations of which a fit did not converge

        Returns
        -------
        bool
            The smallest p value times their number is at least 0.05.

        Examples
        --------
        >>> isinstance(result.passed(), bool)
        True
        """
        p = self.p_values(converged_only)
        return bool(min(p.values()) * len(p) >= SURPRISING)

    def sentence(self) -> str:
        """The verdict in words.

        Returns
        -------
        str
            What was found, of how many.

        Examples
        --------
        >>> "of the model preferred" in result.sentence()
        True
        """
        odds, second = self._odds(False)
        if len(odds) < 2:
            return f"Of {len(self.simulations)} simulations {len(odds)} have the evidence of both models; too few to say more."
        right, expected = int(((odds > 0) == second).sum()), float(expit(np.abs(odds)).sum())
        p = self.p_values()
        name = min(p, key=lambda key: p[key])
        start = (
            "Nothing speaks against the probabilities of the models"
            if self.passed()
            else "The probabilities of the models are wrong"
        )
        failed = (
            f" {self.failed} simulations have a fit that failed; without those that did not converge the verdict is "
            f"{'the same' if self.passed(True) == self.passed() else 'another'}."
            if self.failed
            else " All fits converged."
        )
        return (
            f"{start}: in {len(odds)} simulations the data were {right} times those of the model preferred, "
            f"where the probabilities add up to {number(expected)}; mean probability of {self.models[1]} "
            f"{number(float(expit(odds).mean()))}, where 0.5 is right; "
            f"smallest of {len(p)} p values {number(p[name], 2)} ({name}).{failed}"
        )

    def to_dict(self) -> dict[str, Any]:
        """The result as plain values.

        Returns
        -------
        dict
            ``models``, ``simulations``, ``failed``, ``probabilities`` of the second model with the truth, bins and p values.

        Examples
        --------
        >>> result.to_dict()["simulations"]
        2
        """
        p, second = self.probabilities()
        keys = ("probability", "frequency", "hits", "count", "p")
        return {
            "models": list(self.models),
            "simulations": len(self.simulations),
            "failed": self.failed,
            "passed": self.passed(),
            "passed_converged": self.passed(converged_only=True),
            "sentence": self.sentence(),
            "seed": self.seed,
            "p": self.p_values(),
            "mean_probability": float(p.mean()) if len(p) else None,
            "bins": [dict(zip(keys, entry, strict=True)) for entry in self.bins()] if len(p) else [],
            "probabilities": p.tolist(),
            "second_is_true": second.tolist(),
        }

    def _odds(self, converged_only: bool) -> tuple[FloatArray, NDArray[np.bool_]]:
        """ln of the odds of the second model, and whether it made the data."""
        known = [
            (odds, one.model == 1)
            for one in self.simulations
            if (odds := _log_odds(one)) is not None and (one.converged or not converged_only)
        ]
        ratio, second = np.array(known, dtype=float).reshape(-1, 2).T
        return ratio, second.astype(bool)


def _log_odds(one: Simulated) -> float | None:
    first, second = (fit.log_evidence for fit in one.fits)
    return None if first is None or second is None else second[0] - first[0]
