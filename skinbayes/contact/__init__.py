"""Contact mechanics of skin: layered elasticity, Persson's contact area, yielding, and the Hertz sphere."""

from skinbayes.contact.area import persson_contact_area, relative_contact_area
from skinbayes.contact.correction import AREA_CORRECTION, corrected_stress_variance
from skinbayes.contact.elastoplastic import ContactArea, elastoplastic_contact_area
from skinbayes.contact.hertz import HertzSphere, sphere_contact
from skinbayes.contact.layered import (
    LayeredSkin,
    effective_modulus,
    reduced_modulus,
    surface_response,
    validate_skin,
)
from skinbayes.contact.separation import mean_separation
from skinbayes.contact.variance import stress_variance

__all__ = [
    "AREA_CORRECTION",
    "ContactArea",
    "HertzSphere",
    "LayeredSkin",
    "corrected_stress_variance",
    "effective_modulus",
    "elastoplastic_contact_area",
    "mean_separation",
    "persson_contact_area",
    "reduced_modulus",
    "relative_contact_area",
    "sphere_contact",
    "stress_variance",
    "surface_response",
    "validate_skin",
]
