"""Sampling a problem, and the result: draws and everything computed from them, in the ArviZ schema."""

from skinbayes.fit.fit import Fit
from skinbayes.fit.run import sample
from skinbayes.fit.storage import load_fit

__all__ = ["Fit", "load_fit", "sample"]
