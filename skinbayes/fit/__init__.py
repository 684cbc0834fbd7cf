"""Sampling a problem, and the result: draws and everything computed from them, in the ArviZ schema."""

from skinbayes.fit.fit import Fit
from skinbayes.fit.joint_fit import JointFit
from skinbayes.fit.run import sample
from skinbayes.fit.storage import load_fit, load_joint_fit

__all__ = ["Fit", "JointFit", "load_fit", "load_joint_fit", "sample"]
