"""Bayesian inference of skin mechanics from friction data.

Physics (Persson contact mechanics of layered, rough, elastoplastic skin) becomes a likelihood; emcee samples it; the
answer is a posterior, a model comparison and a page that says what was learnt and what was not.

>>> import skinbayes as sb
>>> problem = sb.load_problem("forearm-glass")
>>> problem.names[0]
'frictional_shear_stress'
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from skinbayes.version import __version__

__all__ = ["Dataset", "Fit", "ForwardModel", "InputError", "JointFit", "JointProblem", "NoiseFamily", "Problem", "Quantity",
           "__version__", "build_joint_problem", "build_problem", "calibrate", "compare", "emulated", "fit_each",
           "fit_spectrum", "load_dataset", "load_fit", "load_joint_fit", "load_joint_problem", "load_problem",
           "problems_of_each", "reduce_recordings", "register_engine", "register_forward_model", "register_noise",
           "register_quantity", "sample"]  # fmt: skip

if TYPE_CHECKING:
    from skinbayes.calibration import calibrate
    from skinbayes.comparison import compare
    from skinbayes.each import fit_each, problems_of_each
    from skinbayes.errors import InputError
    from skinbayes.files.dataset import Dataset, load_dataset
    from skinbayes.files.reduced import reduce_recordings
    from skinbayes.fit import Fit, JointFit, fit_spectrum, load_fit, load_joint_fit, sample
    from skinbayes.forward import ForwardModel, emulated, register_forward_model
    from skinbayes.problem import (
        JointProblem,
        Problem,
        build_joint_problem,
        build_problem,
        load_joint_problem,
        load_problem,
    )
    from skinbayes.sampling import register_engine
    from skinbayes.statistics import NoiseFamily, register_noise
    from skinbayes.vocabulary import Quantity, register_quantity

_HOME = {
    "Dataset": "skinbayes.files.dataset",
    "Fit": "skinbayes.fit",
    "ForwardModel": "skinbayes.forward",
    "InputError": "skinbayes.errors",
    "JointFit": "skinbayes.fit",
    "JointProblem": "skinbayes.problem",
    "load_joint_fit": "skinbayes.fit",
    "Problem": "skinbayes.problem",
    "build_joint_problem": "skinbayes.problem",
    "load_joint_problem": "skinbayes.problem",
    "build_problem": "skinbayes.problem",
    "calibrate": "skinbayes.calibration",
    "compare": "skinbayes.comparison",
    "emulated": "skinbayes.forward",
    "fit_each": "skinbayes.each",
    "problems_of_each": "skinbayes.each",
    "fit_spectrum": "skinbayes.fit",
    "load_dataset": "skinbayes.files.dataset",
    "load_fit": "skinbayes.fit",
    "load_problem": "skinbayes.problem",
    "NoiseFamily": "skinbayes.statistics",
    "Quantity": "skinbayes.vocabulary",
    "register_forward_model": "skinbayes.forward",
    "register_engine": "skinbayes.sampling",
    "register_noise": "skinbayes.statistics",
    "reduce_recordings": "skinbayes.files.reduced",
    "register_quantity": "skinbayes.vocabulary",
    "sample": "skinbayes.fit",
}

_PHYSICS = ("contact", "friction", "lubrication", "roughness", "wetting")
"""Floors that are useful without inference."""


def __getattr__(name: str) -> Any:
    # names are imported when first used, so that `import skinbayes` and `skinbayes --help` stay quick
    if name in _HOME:
        return getattr(import_module(_HOME[name]), name)
    if name in _PHYSICS:
        return import_module(f"{__name__}.{name}")
    raise AttributeError(f"module 'skinbayes' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted(__all__)
