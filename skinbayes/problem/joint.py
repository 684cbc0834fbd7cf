"""Several experiments on one skin: problems that share parameters, as one problem."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from skinbayes.files.joint_model import EXPERIMENT, JointSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.problem.check import CheckReport
from skinbayes.problem.joint_check import check_joint
from skinbayes.problem.joint_densities import JointModel
from skinbayes.problem.joint_text import joint_summary, write_joint
from skinbayes.problem.problem import Problem
from skinbayes.problem.surface_prior import DEVIATE
from skinbayes.problem.target import PosteriorTarget


@dataclass(frozen=True, repr=False)
class JointProblem(JointModel):
    """Experiments on one skin that share parameters; frozen.

    Each experiment is a :class:`Problem` of its own, with its forward model, its data and its noise, and can be asked, checked
    and sampled alone. Given the parameters, data of different experiments are independent: ln p is the sum over experiments.
    Vectors ``theta`` hold the parameters of all of them, data stand experiment by experiment.

    Attributes
    ----------
    spec, free, fixed, tied, places, settings : see :class:`~skinbayes.problem.joint_densities.JointModel`
    experiments : the problem of each experiment by name

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> constant = {"forward": "constant", "noise": {"family": "gaussian", "noise_scale": 0.1}}
    >>> problem = sb.build_joint_problem(
    ...     {
    ...         "left": constant | {"data": {"friction_coefficient": [0.4, 0.5]}},
    ...         "right": constant | {"data": {"friction_coefficient": [0.6]}},
    ...     },
    ...     parameters={"typical_friction_coefficient": {"uniform": [0, 2]}},
    ... )
    >>> theta = problem.prior_medians()
    >>> problem.names, list(problem.experiments)
    (('typical_friction_coefficient',), ['left', 'right'])
    """

    experiments: Mapping[str, Problem]

    def __repr__(self) -> str:
        return joint_summary(self)

    def check(self) -> CheckReport:
        """Look at the problem before sampling.

        Returns
        -------
        CheckReport
            That of each experiment, and what all data together, and those of each experiment alone, can tell.

        Examples
        --------
        >>> problem.check().to_dict()["model"]
        'my-model'
        """
        return check_joint(self)

    def target(self) -> PosteriorTarget:
        """The posterior as samplers see it: on the whole real space, with Jacobian.

        Returns
        -------
        PosteriorTarget
            Log-density, prior transform and likelihood of ``(B, D)``.

        Examples
        --------
        >>> problem.target().log_density(np.zeros((2, 1))).shape
        (2,)
        """
        return PosteriorTarget(self)

    def to_toml(self, path: str | Path | None = None) -> str:
        """The model file of this problem.

        Parameters
        ----------
        path : where to write it; data and curves that are in no file are written beside it. Without a path nothing is written

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
        >>> "[experiments.left.noise]" in problem.to_toml()
        True
        """
        return write_joint(self, None if path is None else Path(path))


def joint_problem(
    spec: JointSpec, experiments: Mapping[str, Problem], settings: Mapping[str, str] | None = None
) -> JointProblem:
    """Put the problems of several experiments together: what they share comes first, then what each has of its own.

    Parameters
    ----------
    spec : what they share
    experiments : the problem of each experiment by name
    settings : values set over the model file
    """
    shared = spec.shared | {DEVIATE}  # the surface belongs to the skin

    def together(name: str, p: ParameterSpec) -> ParameterSpec:
        """A parameter of one experiment under its name among those of all."""
        root = p.name if p.same_as is None else p.same_as.partition("[")[0]
        if p.name in shared and root in shared:
            return p
        same_as = p.same_as if p.same_as is None or root in shared else _own(p.same_as, name)
        level = _own(p.label, name).partition("[")[2].removesuffix("]")
        return replace(p, by=EXPERIMENT, level=level, by_column=False, same_as=same_as)

    def all_of(kind: str) -> dict[str, ParameterSpec]:
        found = [together(name, p) for name, problem in experiments.items() for p in getattr(problem, kind)]
        ordered = [p for p in found if p.by != EXPERIMENT] + [p for p in found if p.by == EXPERIMENT]
        return {p.label: p for p in ordered}

    free = all_of("free")
    order = {label: place for place, label in enumerate(free)}
    places = {
        name: np.array([order[together(name, p).label] for p in problem.free], dtype=np.intp)
        for name, problem in experiments.items()
    }
    fixed, tied = tuple(all_of("fixed").values()), tuple(all_of("tied").values())
    return JointProblem(
        spec, dict(experiments), tuple(free.values()), fixed, tied, places, dict(settings or {})
    )


def _own(label: str, experiment: str) -> str:
    """Label of a parameter that one experiment has for itself: ``noise_scale[friction]``, ``group_scale[friction, person]``."""
    name, _, level = label.removesuffix("]").partition("[")
    return f"{name}[{experiment}, {level}]" if level else f"{name}[{experiment}]"
