"""The folder of a calibration."""

from __future__ import annotations

from skinbayes.calibration.simulation import Simulated
from skinbayes.fit.result_folder import Kind

SIMULATIONS = "simulations.jsonl"

CALIBRATION: Kind[Simulated] = Kind(
    word="calibration",
    manifest="calibration.json",
    lines=SIMULATIONS,
    version="skinbayes calibration 1",
    key=lambda simulated: simulated.number,
    to_dict=Simulated.to_dict,
    from_dict=Simulated.from_dict,
    again="simulated again",
)
