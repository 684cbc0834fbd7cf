"""Sampling of any target density: the seam to engines, ensembles of emcee, nested sampling. Knows nothing of skin."""

from skinbayes.sampling.chains import Chains
from skinbayes.sampling.draws import Draws
from skinbayes.sampling.engines import Engine, register_engine
from skinbayes.sampling.ensembles import SamplingInterrupted, run_ensembles
from skinbayes.sampling.nested_engine import NestedOptions
from skinbayes.sampling.options import EngineOptions, SamplerOptions
from skinbayes.sampling.progress import EnsembleProgress, PlainProgress
from skinbayes.sampling.stopping import StoppingReport
from skinbayes.sampling.store import SampleStore
from skinbayes.sampling.target import Target

__all__ = [
    "Chains",
    "Draws",
    "Engine",
    "EngineOptions",
    "EnsembleProgress",
    "NestedOptions",
    "PlainProgress",
    "SampleStore",
    "SamplerOptions",
    "SamplingInterrupted",
    "StoppingReport",
    "Target",
    "register_engine",
    "run_ensembles",
]
