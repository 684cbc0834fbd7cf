"""Statistics that know nothing of skin: priors, transforms, densities and likelihoods, noise families, group effects."""

from skinbayes.statistics.densities import LogDensity, LogLikelihood
from skinbayes.statistics.families import FAMILIES, Family
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.noise import NoiseFamily
from skinbayes.statistics.noise_families import NOISE_FAMILIES, noise_family, register_noise
from skinbayes.statistics.priors import Prior, make_prior
from skinbayes.statistics.transforms import Transform, VectorTransform, transform_for
from skinbayes.statistics.two_way import residual_scatter

__all__ = [
    "FAMILIES",
    "NOISE_FAMILIES",
    "CrossedGroups",
    "Family",
    "LogDensity",
    "LogLikelihood",
    "NoiseFamily",
    "Prior",
    "Transform",
    "VectorTransform",
    "make_prior",
    "noise_family",
    "register_noise",
    "residual_scatter",
    "transform_for",
]
