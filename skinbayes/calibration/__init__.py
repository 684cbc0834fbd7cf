"""Whether posteriors, intervals and evidences are right as often as they say: simulation-based calibration."""

from skinbayes.calibration.result import Calibration, OddsCalibration
from skinbayes.calibration.run import calibrate

__all__ = ["Calibration", "OddsCalibration", "calibrate"]
