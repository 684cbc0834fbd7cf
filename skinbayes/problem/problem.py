"""A model bound to its data, with all that can be asked of it."""

from __future__ import annotations

from dataclasses import dataclass

from skinbayes.problem.check import CheckReport, check_problem
from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.problem.target import PosteriorTarget


@dataclass(frozen=True)
class Problem(StatisticalModel):
    """A statistical model bound to its data; frozen.

    Made by :func:`skinbayes.load_problem` from a model file, or by :func:`skinbayes.build_problem` from values. Its attributes
    are those of :class:`~skinbayes.problem.bound.BoundModel`; densities and draws are those of
    :class:`~skinbayes.problem.statistical_model.StatisticalModel`.

    Examples
    --------
    >>> import skinbayes as sb
    >>> sb.load_problem("finger-null").names
    ('typical_friction_coefficient', 'noise_scale', 'group_scale[person]', 'group_scale[liquid]')
    """

    def check(self) -> CheckReport:
        """Look at the problem before sampling: priors, finite predictions, and what the data can tell apart, in words."""
        return check_problem(self)

    def target(self) -> PosteriorTarget:
        """The posterior as samplers see it: on the whole real space, with Jacobian."""
        return PosteriorTarget(self)
