"""Where physics, data and statistics meet: a model bound to its data."""

from skinbayes.problem.build import build_problem
from skinbayes.problem.load import load_problem
from skinbayes.problem.problem import Problem

__all__ = ["Problem", "build_problem", "load_problem"]
