"""Comparing models on the same data, by what they predict for data left out, and against baseline models without theory."""

from skinbayes.comparison.baselines import against_baselines
from skinbayes.comparison.cross_check import CrossCheck, cross_check
from skinbayes.comparison.models import ComparedModel, Comparison, compare
from skinbayes.comparison.noise_floor import NoiseFloor, noise_floor
from skinbayes.comparison.prior_widths import PriorWidths, WidthScan
from skinbayes.comparison.ranking import AgainstBaselines, RankedAgainst
from skinbayes.comparison.scores import FEW_ROWS, LeftOut, LeftOutLevel
from skinbayes.comparison.weights import stacking_weights

__all__ = [
    "FEW_ROWS",
    "AgainstBaselines",
    "ComparedModel",
    "Comparison",
    "CrossCheck",
    "LeftOut",
    "LeftOutLevel",
    "NoiseFloor",
    "PriorWidths",
    "RankedAgainst",
    "WidthScan",
    "against_baselines",
    "compare",
    "cross_check",
    "noise_floor",
    "stacking_weights",
]
