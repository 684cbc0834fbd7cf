"""The result of a fit of several experiments."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.arrays import ArrayLike
from skinbayes.atomic import write_atomically
from skinbayes.fit.fit import Fit
from skinbayes.fit.joint_groups import of_experiment
from skinbayes.fit.netcdf import result_image
from skinbayes.fit.result import JointResult

if TYPE_CHECKING:
    from skinbayes.fit.left_out import LeftOutExperiment
    from skinbayes.fit.prior_sensitivity import PriorSensitivity
    from skinbayes.problem import JointProblem


@dataclass(frozen=True, repr=False)
class JointFit(JointResult):
    """Posterior draws of the parameters of several experiments and everything computed from them.

    Attributes
    ----------
    groups, provenance : as those of a :class:`Fit`; groups of single experiments are called ``friction.posterior_predictive``
    problem : the problem, or None if the result was read from a file whose model or data are gone

    Examples
    --------
    Examples of methods go on from this one.

    >>> import numpy as np
    >>> import skinbayes as sb
    >>> constant = {"forward": "constant", "noise": {"family": "gaussian", "noise_scale": 0.1}}
    >>> problem = sb.build_joint_problem(
    ...     {
    ...         "left": constant | {"data": {"friction_coefficient": [0.4, 0.5]}},
    ...         "right": constant | {"data": {"friction_coefficient": [0.6]}},
    ...     },
    ...     parameters={"typical_friction_coefficient": {"uniform": [0, 2]}},
    ... )
    >>> fit = sb.JointFit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 100))
    >>> fit.names, list(fit.experiments)
    (('typical_friction_coefficient',), ['left', 'right'])
    """

    def __repr__(self) -> str:
        return f"JointFit of '{self.name}': {self.provenance['sampling']['verdict']}"

    @cached_property
    def experiments(self) -> dict[str, Fit]:
        """Each experiment as a fit: its data, its figures, its part of the parameters; the draws are those of all together."""
        return {
            name: Fit(
                *of_experiment(self.groups, self.provenance, name),
                None if self.problem is None else self.problem.experiments[name],
            )
            for name in self.provenance["experiments"]
        }

    @property
    def together(self) -> Fit:
        """The parameters of all experiments as a fit without a problem, for whatever asks about parameters alone."""
        return Fit(self.groups, self.provenance, None)

    def left_out(self, refit: bool = False) -> list[LeftOutExperiment]:
        """Whether the experiments agree: what all others say without each of them about the parameters that it shares.

        Parameters
        ----------
        refit : sample without an experiment where the draws cannot tell: as long as a fit, for each

        Returns
        -------
        list of LeftOutExperiment
            One for each experiment: ln p(its data | those of the others), quantiles of the shared parameters without and with
            it, and the ``pulls``: parameters whose median it takes out of the 90 % interval that they had without it.

        Examples
        --------
        >>> [one.experiment for one in fit.left_out()]
        ['left', 'right']
        """
        from skinbayes.fit.left_out import left_out_experiments

        return left_out_experiments(self, refit)

    def prior_sensitivity(
        self, refit: bool = False, progress: Callable[[int, int], None] | None = None
    ) -> PriorSensitivity:
        """What evidence and posterior owe to the priors, see :meth:`Fit.prior_sensitivity`.

        Parameters
        ----------
        refit : sample the experiments anew with the other priors where weights cannot tell
        progress : called with the number of changed priors done and their total

        Returns
        -------
        PriorSensitivity
            As of a :class:`Fit`.

        Raises
        ------
        InputError
            Model or data of the fit are not at hand any more.

        Examples
        --------
        >>> fit.prior_sensitivity().of(["typical_friction_coefficient"], 2.0).factor
        2.0
        """
        from skinbayes.fit.prior_sensitivity import prior_sensitivity

        return prior_sensitivity(self, refit, progress)

    @classmethod
    def from_draws(
        cls, problem: JointProblem, samples: Any, log_weights: ArrayLike | None = None, seed: int = 1
    ) -> JointFit:
        """The whole result from draws of any sampler.

        Parameters
        ----------
        problem : experiments with their data
        samples, log_weights, seed : as for :meth:`Fit.from_draws`

        Returns
        -------
        JointFit

        Raises
        ------
        InputError
            As :meth:`Fit.from_draws` does.

        Examples
        --------
        >>> fit.experiments["left"].groups["posterior_predictive"]["friction_coefficient"].shape
        (1, 100, 2)
        """
        from skinbayes.fit.given_draws import fit_parts

        return cls(*fit_parts(problem, samples, log_weights, seed), problem)

    def save(self, path: str | Path) -> Path:
        """Write the result as one netCDF file; it appears whole or not at all, and shows any damage.

        Parameters
        ----------
        path : the file

        Returns
        -------
        Path
            The file.

        Raises
        ------
        OSError
            It cannot be written.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     fit.save(pathlib.Path(folder) / "fit.nc").name
        'fit.nc'
        """
        write_atomically(Path(path), result_image(self.groups, self.provenance))
        return Path(path)
