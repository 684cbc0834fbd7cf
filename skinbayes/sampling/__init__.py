"""Ensemble sampling of any target density: starts, moves, stopping rule and store. Knows nothing of skin."""

from skinbayes.sampling.chains import Chains
from skinbayes.sampling.ensembles import SamplingInterrupted, run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.progress import Progress
from skinbayes.sampling.stopping import StoppingReport
from skinbayes.sampling.store import SampleStore
from skinbayes.sampling.target import Target

__all__ = [
    "Chains",
    "Progress",
    "SampleStore",
    "SamplerOptions",
    "SamplingInterrupted",
    "StoppingReport",
    "Target",
    "run_ensembles",
]
