"""Contact mechanics of skin: layered elasticity, Persson's contact area, yielding, gaps, and the Hertz sphere."""

from skinbayes.contact.area import persson_contact_area, relative_contact_area
from skinbayes.contact.correction import AREA_CORRECTION, corrected_stress_variance
from skinbayes.contact.elastoplastic import ContactArea, elastoplastic_contact_area
from skinbayes.contact.gaps import GapDistribution, gap_distribution
from skinbayes.contact.hertz import HertzSphere, sphere_contact
from skinbayes.contact.layered import (
    LayeredSkin,
    effective_modulus,
    reduced_modulus,
    surface_response,
    validate_skin,
)
from skinbayes.contact.separation import mean_separation
from skinbayes.contact.separation_inverse import pressure_at_separation
from skinbayes.contact.variance import stress_variance

__all__ = [
    "AREA_CORRECTION",
    "ContactArea",
    "GapDistribution",
    "HertzSphere",
    "LayeredSkin",
    "corrected_stress_variance",
    "effective_modulus",
    "elastoplastic_contact_area",
    "gap_distribution",
    "mean_separation",
    "persson_contact_area",
    "pressure_at_separation",
    "reduced_modulus",
    "relative_contact_area",
    "sphere_contact",
    "stress_variance",
    "surface_response",
    "validate_skin",
]
