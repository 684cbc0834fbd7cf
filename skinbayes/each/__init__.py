"""One model fitted to many data sets, each by itself."""

from skinbayes.each.problems import problems_of_each
from skinbayes.each.result import EachFit, OneFit
from skinbayes.each.run import fit_each

__all__ = ["EachFit", "OneFit", "fit_each", "problems_of_each"]
