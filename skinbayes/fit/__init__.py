"""Sampling a problem, and the result: draws and everything computed from them, in the ArviZ schema."""

from skinbayes.fit.fit import Fit
from skinbayes.fit.joint_fit import JointFit
from skinbayes.fit.run import sample
from skinbayes.fit.spectrum_fit import fit_spectrum
from skinbayes.fit.storage import load_fit, load_joint_fit

__all__ = ["Fit", "JointFit", "fit_spectrum", "load_fit", "load_joint_fit", "sample"]
