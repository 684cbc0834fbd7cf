"""Where physics, data and statistics meet: a model bound to its data."""

from skinbayes.problem.build import build_problem
from skinbayes.problem.build_joint import build_joint_problem
from skinbayes.problem.joint import JointProblem
from skinbayes.problem.load import load_joint_problem, load_problem
from skinbayes.problem.problem import Problem

__all__ = [
    "JointProblem",
    "Problem",
    "build_joint_problem",
    "build_problem",
    "load_joint_problem",
    "load_problem",
]
