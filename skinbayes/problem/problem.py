"""A model bound to its data, with all that can be asked of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from skinbayes.problem.check import CheckReport, check_problem
from skinbayes.problem.model_text import model_files, write_model
from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.problem.summary import summary
from skinbayes.problem.target import PosteriorTarget


@dataclass(frozen=True, repr=False)
class Problem(StatisticalModel):
    """A statistical model bound to its data; frozen.

    Made by :func:`skinbayes.load_problem` from a model file, or by :func:`skinbayes.build_problem` from values. Its attributes
    are those of :class:`~skinbayes.problem.bound.BoundModel`; densities and draws are those of
    :class:`~skinbayes.problem.statistical_model.StatisticalModel`.

    Attributes
    ----------
    spec, forward, free, fixed, conditions, dataset, observations, input_spread, groups, tables, flow_curves, settings : see
        :class:`~skinbayes.problem.bound.BoundModel`
    tied, correlated, surface_prior, populations : see there too

    Examples
    --------
    Examples of methods go on from this one.

    >>> import numpy as np
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-null")
    >>> problem.names
    ('typical_friction_coefficient', 'noise_scale', 'group_scale[person]', 'group_scale[liquid]')
    """

    def __repr__(self) -> str:
        return summary(self)

    def check(self) -> CheckReport:
        """Look at the problem before sampling.

        Returns
        -------
        CheckReport
            Priors, finite predictions, and what the data can tell apart; ``sentences()`` says it in words.

        Examples
        --------
        >>> problem.check().to_dict()["model"]
        'finger-null'
        """
        return check_problem(self)

    def target(self) -> PosteriorTarget:
        """The posterior as samplers see it: on the whole real space, with Jacobian.

        Returns
        -------
        PosteriorTarget
            Log-density, prior transform and likelihood of ``(B, D)``.

        Examples
        --------
        >>> problem.target().log_density(np.zeros((2, 4))).shape
        (2,)
        """
        return PosteriorTarget(self)

    def to_toml(self, path: str | Path | None = None) -> str:
        """The model file of this problem.

        Parameters
        ----------
        path : where to write it; data, spectrum and flow curves that are in no file are written beside it. Without a path
            nothing is written

        Returns
        -------
        str
            the text; :func:`skinbayes.load_problem` makes the same problem of the file

        Raises
        ------
        InputError
            A file of that name is there already, or a prior that no model file can state.

        Examples
        --------
        >>> "[noise]" in problem.to_toml()
        True
        """
        if path is None:
            file = Path(f"{self.name}.toml")
            return model_files(self, file)[file]
        return write_model(self, Path(path))
