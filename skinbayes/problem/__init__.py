"""Where physics, data and statistics meet: a model file bound to its data."""

from skinbayes.problem.load import load_problem
from skinbayes.problem.problem import Problem

__all__ = ["Problem", "load_problem"]
