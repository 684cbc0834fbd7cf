"""Statistics that know nothing of skin: priors, transforms, densities and likelihoods, noise families."""

from skinbayes.statistics.densities import LogDensity, LogLikelihood
from skinbayes.statistics.families import FAMILIES, Family
from skinbayes.statistics.noise import NOISE_FAMILIES, NoiseFamily, noise_family
from skinbayes.statistics.priors import Prior, make_prior
from skinbayes.statistics.transforms import Transform, VectorTransform, transform_for

__all__ = [
    "FAMILIES",
    "NOISE_FAMILIES",
    "Family",
    "LogDensity",
    "LogLikelihood",
    "NoiseFamily",
    "Prior",
    "Transform",
    "VectorTransform",
    "make_prior",
    "noise_family",
    "transform_for",
]
