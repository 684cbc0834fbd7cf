"""Comparing models on the same data, by what they predict for data left out, and against yardsticks without theory."""

from skinbayes.comparison.models import ComparedModel, Comparison, compare
from skinbayes.comparison.noise_floor import NoiseFloor, noise_floor
from skinbayes.comparison.scores import FEW_ROWS, LeftOut, LeftOutLevel
from skinbayes.comparison.standings import Standing, Yardsticks
from skinbayes.comparison.weights import stacking_weights
from skinbayes.comparison.yardsticks import against_yardsticks

__all__ = ["FEW_ROWS", "ComparedModel", "Comparison", "LeftOut", "LeftOutLevel", "NoiseFloor", "Standing", "Yardsticks",
           "against_yardsticks", "compare", "noise_floor", "stacking_weights"]  # fmt: skip
